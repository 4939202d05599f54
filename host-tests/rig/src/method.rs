//! The methods of this build, by name.

use std::fmt;
use std::str::FromStr;
use stereopsis::matching::{Config, Filter, Matcher, Method, state_bytes};
use stereopsis::pipeline::Pipeline;
use stereopsis_model::twin;

/// A matching method.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum MethodName {
    /// [`Fast`](stereopsis::matching::Fast): 4-bit census, 9x7 window.
    Fast,
    /// [`Block`](stereopsis::matching::Block): 8-bit census, 9x9 window.
    Block,
    /// [`SgmLean`](stereopsis::matching::SgmLean): gradients, brightness and census along paths.
    SgmLean,
    /// [`Sgm`](stereopsis::matching::Sgm): the same, compared between pixels too.
    Sgm,
    /// [`SgmEdge`](stereopsis::matching::SgmEdge): the same, averaged down the columns within edges.
    SgmEdge,
}

/// Does something with the core's type of a method, by the name it is given.
#[macro_export]
macro_rules! with_method {
    ($method:expr, $type:ident => $work:expr) => {
        match $method {
            $crate::method::MethodName::Fast => {
                type $type = stereopsis::matching::Fast;
                $work
            }
            $crate::method::MethodName::Block => {
                type $type = stereopsis::matching::Block;
                $work
            }
            $crate::method::MethodName::SgmLean => {
                type $type = stereopsis::matching::SgmLean;
                $work
            }
            $crate::method::MethodName::Sgm => {
                type $type = stereopsis::matching::Sgm;
                $work
            }
            $crate::method::MethodName::SgmEdge => {
                type $type = stereopsis::matching::SgmEdge;
                $work
            }
        }
    };
}

impl MethodName {
    /// The methods of this build.
    pub const ALL: [Self; 5] = [Self::Fast, Self::Block, Self::SgmLean, Self::Sgm, Self::SgmEdge];

    /// The name on the command line and in files.
    pub const fn name(self) -> &'static str {
        with_method!(self, S => S::NAME)
    }

    /// The naive twin of the method.
    pub const fn twin(self) -> twin::Method {
        match self {
            Self::Fast => twin::Method::FAST,
            Self::Block => twin::Method::BLOCK,
            Self::SgmLean => twin::Method::SGM_LEAN,
            Self::Sgm => twin::Method::SGM,
            Self::SgmEdge => twin::Method::SGM_EDGE,
        }
    }

    /// Bytes of state that firmware holds for lines of `width` and that many disparities.
    pub const fn state_bytes(self, width: u16, disparities: u16) -> usize {
        with_method!(self, S => state_bytes::<S>(width as usize, disparities as usize))
    }

    /// Bytes of a pipeline: the matcher's state, at most, and the lines of both cameras that it holds.
    pub const fn pipeline_bytes(self, width: u16, disparities: u16) -> usize {
        self.state_bytes(width, disparities) + with_method!(self, S => lines_bytes::<S>(width as usize))
    }

    /// A search from disparity 0 with the method's default checks and penalties.
    pub const fn config(self, width: u16, height: u16, disparities: u16) -> Config {
        with_method!(self, S => Config::for_method::<S>(width, height, disparities))
    }

    /// A search with the checks of an operating point of the method, and with its penalties.
    pub const fn with_filter(self, filter: Filter, search: Config) -> Config {
        with_method!(self, S => search.with_filter::<S>(filter))
    }

    /// Whether a frame in bands is that of one pipeline to the bit: a window reaches so far and no farther, a
    /// path reaches from the frame's first row.
    pub const fn is_exact_in_bands(self) -> bool {
        matches!(self, Self::Fast | Self::Block)
    }

    /// Whether pixels are compared by their brightness, so that another exposure of one camera counts; a
    /// census asks which one of two is darker.
    pub const fn compares_brightness(self) -> bool {
        matches!(self, Self::SgmLean | Self::Sgm | Self::SgmEdge)
    }

    /// How many lines after its own a row of disparities comes out.
    pub const fn latency_lines(self) -> usize {
        with_method!(self, S => Pipeline::<S, 320, 64>::LATENCY)
    }

    /// Standard deviation of an answer away from depth edges, px.
    pub const fn sigma_px(self) -> f32 {
        with_method!(self, S => S::SIGMA_PX)
    }
}

/// Bytes of a pointer that are reckoned with, on a machine with shorter ones too: the figure is the same
/// everywhere.
const POINTER_BYTES: usize = 8;

/// What a pipeline holds beside its matcher: so many bytes for each column, and some words.
const fn lines_bytes<S: Method>(width: usize) -> usize {
    let narrow = size_of::<Pipeline<S, 320, 64>>() - size_of::<Matcher<S, 320, 64>>();
    let wide = size_of::<Pipeline<S, 640, 64>>() - size_of::<Matcher<S, 640, 64>>();
    let per_column = (wide - narrow) / 320;
    (narrow - 320 * per_column) / size_of::<usize>() * POINTER_BYTES + width * per_column
}

impl fmt::Display for MethodName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The name is of no method of this build.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("the methods of this build are fast, block, sgm-lean, sgm and sgm-edge")]
pub struct UnknownMethod;

impl FromStr for MethodName {
    type Err = UnknownMethod;

    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        Self::ALL.into_iter().find(|method| method.name() == name).ok_or(UnknownMethod)
    }
}
