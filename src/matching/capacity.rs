//! The numbers of disparities that a matcher can have room for, checked when the program is compiled.

/// Capacity of a matcher for `D` disparities.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Capacity<const D: usize>;

/// Numbers of disparities that there are matchers for: the multiples of 16 from 16 to 256.
///
/// ```compile_fail,E0277
/// use stereopsis::matching::{Block, Matcher};
/// let matcher = Matcher::<Block, 160, 40>::new();
/// ```
#[diagnostic::on_unimplemented(
    message = "there is no matcher for this number of disparities",
    label = "D must be a multiple of 16, from 16 to 256"
)]
pub trait Supported: sealed::Sealed {}

mod sealed {
    /// Keeps other crates from implementing [`Supported`](super::Supported).
    pub trait Sealed {}
}

macro_rules! supported {
    ($($disparities:literal)*) => {$(
        impl sealed::Sealed for Capacity<$disparities> {}
        impl Supported for Capacity<$disparities> {}
    )*};
}
supported! { 16 32 48 64 80 96 112 128 144 160 176 192 208 224 240 256 }
