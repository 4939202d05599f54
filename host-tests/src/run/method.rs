//! The methods of this build, by name.

use super::Host;
use std::fmt;
use std::str::FromStr;
use stereopsis::matching::{Block, Fast, Scheme, state_bytes};

/// A matching method.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Method {
    /// [`Fast`]: 4-bit census, 9x7 window.
    Fast,
    /// [`Block`]: 8-bit census, 9x9 window.
    Block,
}

impl Method {
    /// The methods of this build.
    pub const ALL: [Self; 2] = [Self::Fast, Self::Block];

    /// The name on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fast => Fast::NAME,
            Self::Block => Block::NAME,
        }
    }

    /// Bytes of state that firmware holds for lines of `width` and that many disparities.
    pub const fn state_bytes(self, width: u16, disparities: u16) -> usize {
        match self {
            Self::Fast => state_bytes::<Fast>(width as usize, disparities as usize),
            Self::Block => state_bytes::<Block>(width as usize, disparities as usize),
        }
    }

    /// How many lines after its own a row of disparities comes out.
    pub const fn latency_lines(self) -> usize {
        match self {
            Self::Fast => Host::<Fast>::LATENCY,
            Self::Block => Host::<Block>::LATENCY,
        }
    }

    /// Standard deviation of an answer away from depth edges, px.
    pub const fn sigma_px(self) -> f32 {
        match self {
            Self::Fast => Fast::SIGMA_PX,
            Self::Block => Block::SIGMA_PX,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The name is of no method of this build.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("the methods of this build are fast and block")]
pub struct UnknownMethod;

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        Self::ALL.into_iter().find(|method| method.name() == name).ok_or(UnknownMethod)
    }
}
