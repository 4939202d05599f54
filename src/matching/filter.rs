//! Operating points of the methods.

use super::config::Checks;
use super::scheme::Scheme;
use crate::imaging::Noise;

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

    /// What it is for a method, with cameras that have so much noise.
    pub const fn checks<S: Scheme>(self, noise: Noise) -> Checks {
        match (self, noise) {
            (Self::Dense, _) => Checks::DENSE,
            (Self::Default, Noise::None) => S::DEFAULT,
            (Self::Default, Noise::Low) => S::DEFAULT_IN_NOISE[0],
            (Self::Default, Noise::High) => S::DEFAULT_IN_NOISE[1],
            (Self::Strict, _) => S::STRICT,
        }
    }
}
