//! What grows, and how far, while the rest stays.

use std::fmt;
use stereopsis_host::run::MethodName;

/// What grows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Grows {
    /// Pixels in a line.
    Width,
    /// Lines of a frame.
    Height,
    /// Disparities that are searched.
    Disparities,
}

impl fmt::Display for Grows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Width => "width",
            Self::Height => "height",
            Self::Disparities => "disparities",
        })
    }
}

/// A frame's size.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Size {
    pub width: u16,
    pub height: u16,
    pub disparities: u16,
}

impl Size {
    /// Disparities of pixels in a frame.
    pub fn evaluations(self) -> u64 {
        u64::from(self.width) * u64::from(self.height) * u64::from(self.disparities)
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}, {}", self.width, self.height, self.disparities)
    }
}

/// What grows, from the least to the most.
pub type Series = (Grows, Vec<Size>);

/// All series. What does not grow has the second-smallest of its own series.
pub fn series(widths: &[u16], heights: &[u16], disparities: &[u16]) -> [Series; 3] {
    let second = |of: &[u16]| of.get(1).copied().unwrap_or(1);
    let size = Size { width: second(widths), height: second(heights), disparities: second(disparities) };
    // All searches fit the line.
    let wide = Size { width: widths.last().copied().unwrap_or(1), ..size };
    [
        (Grows::Width, widths.iter().map(|&width| Size { width, ..size }).collect()),
        (Grows::Height, heights.iter().map(|&height| Size { height, ..size }).collect()),
        (Grows::Disparities, disparities.iter().map(|&disparities| Size { disparities, ..wide }).collect()),
    ]
}

/// The costs at all sizes of a method on a core or kernel, in the order of the sizes.
pub struct Column {
    /// The core or the kernel.
    pub on: String,
    pub method: MethodName,
    pub costs: Vec<f64>,
}
