//! Operating points of the methods.

use super::config::Checks;
use super::scheme::Scheme;

/// An operating point: how many answers, and how sure. What it is made of depends on the method.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Filter {
    /// Every pixel with a candidate gets an answer.
    Dense,
    /// Most answers, few of them wrong.
    Default,
    /// Sure answers: fewer, and wrong only rarely.
    Strict,
}

impl Filter {
    /// All of them, from the most answers to the surest.
    pub const ALL: [Self; 3] = [Self::Dense, Self::Default, Self::Strict];

    /// The name, as the programs spell it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dense => "dense",
            Self::Default => "default",
            Self::Strict => "strict",
        }
    }

    /// What it is for a method.
    pub const fn checks<S: Scheme>(self) -> Checks {
        match self {
            Self::Dense => Checks::DENSE,
            Self::Default => S::DEFAULT,
            Self::Strict => S::STRICT,
        }
    }
}
