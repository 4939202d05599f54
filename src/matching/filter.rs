//! Operating points of the methods, and configurations made of them.

use super::config::{Checks, Config};
use super::method::Method;
use crate::imaging::Noise;

/// An operating point: how many answers, and how sure. What it is made of depends on the method.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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

    /// The checks of this operating point for the method `S`, with cameras that have so much noise.
    pub const fn checks<S: Method>(self, noise: Noise) -> Checks {
        match (self, noise) {
            (Self::Dense, _) => Checks::DENSE,
            (Self::Default, Noise::None) => S::DEFAULT,
            (Self::Default, Noise::Low) => S::DEFAULT_IN_NOISE[0],
            (Self::Default, Noise::High) => S::DEFAULT_IN_NOISE[1],
            (Self::Strict, _) => S::STRICT,
        }
    }
}

impl Config {
    /// A search from disparity 0 with the default checks and the penalties of the method `M`, without
    /// confidences, for cameras with little noise.
    ///
    /// ```
    /// use stereopsis::matching::{Config, Method, Sgm};
    /// let config = Config::for_method::<Sgm>(320, 240, 64);
    /// assert_eq!((config.checks, config.penalties), (Sgm::DEFAULT, Sgm::PENALTIES));
    /// ```
    pub const fn for_method<M: Method>(width: u16, height: u16, disparities: u16) -> Self {
        Self { width, height, disparities, ..Self::UNSET }.with_filter::<M>(Filter::Default)
    }

    /// This search with the checks of an operating point of the method `M`, and its penalties: those for
    /// cameras that have as much [noise](Self::noise) as it says so far.
    ///
    /// ```
    /// use stereopsis::{imaging::Noise, matching::{Config, Filter, Sgm}};
    /// let config = Config { noise: Noise::High, ..Config::for_method::<Sgm>(320, 240, 64) };
    /// let config = config.with_filter::<Sgm>(Filter::Default);
    /// assert_eq!(config.checks.uniqueness_percent, Some(12));
    /// ```
    pub const fn with_filter<M: Method>(self, filter: Filter) -> Self {
        let penalties = match self.noise {
            Noise::None => M::PENALTIES,
            Noise::Low | Noise::High => M::PENALTIES_IN_NOISE,
        };
        Self { checks: filter.checks::<M>(self.noise), penalties, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::method::{Fast, Sgm};
    use crate::matching::penalties::Penalties;

    #[test]
    fn each_filter_has_its_name_and_its_checks() {
        assert_eq!(Filter::ALL.map(Filter::name), ["dense", "default", "strict"]);
        for noise in Noise::ALL {
            assert_eq!(Filter::Dense.checks::<Sgm>(noise), Checks::DENSE);
            assert_eq!(Filter::Strict.checks::<Sgm>(noise), Sgm::STRICT);
            assert_eq!(Filter::Default.checks::<Fast>(noise), Checks::DEFAULT);
        }
        let [low, high] = Sgm::DEFAULT_IN_NOISE;
        assert_eq!(
            [Noise::None, Noise::Low, Noise::High].map(|noise| Filter::Default.checks::<Sgm>(noise)),
            [Sgm::DEFAULT, low, high]
        );
    }

    #[test]
    fn a_configuration_of_a_method_has_the_size_and_what_the_method_asks_for() {
        let config = Config::for_method::<Sgm>(320, 240, 64);
        assert_eq!((config.width, config.height, config.disparities), (320, 240, 64));
        assert_eq!((config.checks, config.penalties), (Sgm::DEFAULT, Penalties::DEFAULT));
        let in_noise = Config { noise: Noise::High, ..config }.with_filter::<Sgm>(Filter::Strict);
        assert_eq!((in_noise.checks, in_noise.penalties), (Sgm::STRICT, Sgm::PENALTIES_IN_NOISE));
        assert_eq!((in_noise.width, in_noise.height, in_noise.noise), (320, 240, Noise::High));
    }
}
