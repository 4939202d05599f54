//! The methods whose costs are sums along paths: semi-global matching (Hirschmüller 2008) on lines as they
//! come.
//!
//! A row's costs are averaged with those of the rows above it and of the one below, each half as much as the
//! next; or, at the price of two more bytes for every pixel and disparity, with those above and of the two
//! below as far as no edge of the left image is crossed. Then paths bring together what the pixels of a
//! surface have in common: from the left, from the right, and from above. No frame is kept, and no path comes
//! from below: that path measured least, and it would take the frame.

use super::denoise::{denoise, gradient_shift};
use super::{Costs, Frame, Method};
use crate::imaging::{Noise, smooth};
use crate::matching::backend::loops::{copy_row, once_without_vectors};
use crate::matching::backend::{CostWork, EdgeWork, Guide, Isa, MethodParameters, PathWork, SgmParameters};
use crate::matching::config::Checks;
use crate::matching::memory::layout::{COLUMNS_OFF, PathWorkspace, Volumes};
use crate::matching::memory::rings::{row as slot, row_mut};
use crate::matching::memory::slices::{chunks_mut, part, part_mut, split_mut};
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::{Select, Unique};
use crate::matching::memory::workspace::{ForWinners, RowWorkspace};
use crate::matching::memory::{Bytes, Memory, Parts, Rows5};
use crate::matching::penalties::Penalties;
use crate::units::{Disparity, PixelFlags};

/// Method `sgm`: gradients, brightness and a wide census along three paths; gradients are compared between
/// pixels.
#[derive(Clone, Copy, Debug)]
pub struct Sgm;

/// Method `sgm-lean`: as [`Sgm`], with gradients compared at pixels only.
#[derive(Clone, Copy, Debug)]
pub struct SgmLean;

/// Method `sgm-edge`: as [`Sgm`], with costs averaged down the columns as far as no edge is crossed.
#[derive(Clone, Copy, Debug)]
pub struct SgmEdge;

impl SgmParameters for Sgm {
    const BETWEEN_PIXELS: bool = true;
    const WITHIN_EDGES: bool = false;
}

impl SgmParameters for SgmLean {
    const BETWEEN_PIXELS: bool = false;
    const WITHIN_EDGES: bool = false;
}

impl SgmParameters for SgmEdge {
    const BETWEEN_PIXELS: bool = true;
    const WITHIN_EDGES: bool = true;
}

const _: () = assert!(
    Penalties::DEFAULT.check().is_ok() && Penalties::DEFAULT.in_noise().check().is_ok(),
    "the default is a good choice"
);

/// What a method along paths is, but for its [`SgmParameters`].
macro_rules! along_paths {
    ($method:ty, $name:literal) => {
        impl MethodParameters for $method {
            const RADIUS_X: usize = 4;
            const RADIUS_Y: usize = <Self as SgmParameters>::ROWS_BELOW;
            const SLANT_COST: u8 = SLANT_COST;
            const ALONG_PATHS: bool = true;
        }

        impl Method for $method {
            const SIGMA_PX: f32 = 0.15;
            const VERTICAL_FILTER: bool = true;
            const DEFAULT: Checks = DEFAULT;
            const DEFAULT_IN_NOISE: [Checks; 2] = DEFAULT_IN_NOISE;
            const STRICT: Checks = STRICT;
            const PENALTIES_IN_NOISE: Penalties = Penalties::DEFAULT.in_noise();
            const NAME: &'static str = $name;
        }

        impl Costs for $method {
            type Memory<const W: usize, const D: usize> =
                PathMemory<{ guides::<$method>() }, { <$method as SgmParameters>::VOLUMES }, W, D>;
            const BYTES: Bytes =
                PathMemory::<{ guides::<$method>() }, { <$method as SgmParameters>::VOLUMES }, 0, 0>::BYTES;

            #[inline(always)]
            fn enter(_: &mut Frame<'_>, _: usize, _: [&Rows5<'_>; 2]) {}

            // Inlined for the reason that `Isa::window` is.
            #[inline(always)]
            fn select<const MOST: usize>(
                frame: &mut Frame<'_>,
                bottom: usize,
                lines: Option<[&Rows5<'_>; 2]>,
                row: Option<usize>,
            ) {
                select::<Self, MOST>(frame, bottom, lines, row);
            }
        }
    };
}

/// Rows of the left image that are held: the one whose winners are due, the one above it and those below that
/// are in.
const fn guides<S: SgmParameters>() -> usize {
    S::ROWS_BELOW + 1
}

/// What measured best.
const SLANT_COST: u8 = 12;
/// Costs along paths leave gaps inside of surfaces, which are filled, and carry near surfaces on over places
/// that say nothing, where they are refused.
const DEFAULT: Checks = Checks {
    left_right_px: Some(2),
    smoothing_radius: 8,
    speckle_pixels: 16,
    speckle_run: 15,
    fattening_slope: Disparity::ONE_PIXEL,
    open_run: 5,
    refuse_repeats: true,
    fill_pixels: 48,
    fill_step: Disparity::from_raw(4 * Disparity::ONE),
    ..Checks::DEFAULT
};
/// Noise makes wrong answers whose cost others come near to, and that few others agree with. It also hides
/// faint texture: more than a sky is open then, and open places are not asked for more.
const IN_NOISE: Checks = Checks { open_run: 0, fill_pixels: 32, ..DEFAULT };
const DEFAULT_IN_NOISE: [Checks; 2] = [
    Checks { uniqueness_percent: Some(5), speckle_pixels: 20, ..IN_NOISE },
    Checks { uniqueness_percent: Some(12), speckle_pixels: 30, ..IN_NOISE },
];
/// Checks that refuse most where another disparity costs little more; texture says less than that, for paths
/// bridge what has none. Where the image is open it takes more than that.
const STRICT: Checks = Checks {
    uniqueness_percent: Some(14),
    open_margin: 52,
    refuse_repeats: true,
    speckle_pixels: 36,
    speckle_run: 15,
    fattening_slope: Disparity::from_raw(16),
    median: true,
    fill_pixels: 16,
    fill_step: Disparity::from_raw(2 * Disparity::ONE),
    ..Checks::DEFAULT
};

along_paths!(Sgm, "sgm");
along_paths!(SgmLean, "sgm-lean");
along_paths!(SgmEdge, "sgm-edge");

/// The memory of a method along paths.
pub struct PathMemory<const GUIDES: usize, const VOLUMES: usize, const W: usize, const D: usize> {
    /// The left image's last rows, row `y` in slot `y % GUIDES`.
    guides: [[u8; W]; GUIDES],
    /// Costs, paths from above, sums; within edges also the average of the rows above and the costs of the
    /// row below.
    volumes: Volumes<VOLUMES, W, D>,
    /// The features of a row; when they are done with, its winners.
    workspace: PathWorkspace<W, D>,
}

impl<const GUIDES: usize, const VOLUMES: usize> PathMemory<GUIDES, VOLUMES, 0, 0> {
    pub const BYTES: Bytes = Bytes {
        fixed: 0,
        per_pixel: GUIDES + PathWorkspace::<0, 0>::PER_PIXEL,
        per_candidate: VOLUMES,
        per_disparity: COLUMNS_OFF + PathWorkspace::<0, 0>::PER_DISPARITY,
    };
}

impl<const GUIDES: usize, const VOLUMES: usize, const W: usize, const D: usize> Memory
    for PathMemory<GUIDES, VOLUMES, W, D>
{
    const EMPTY: Self =
        Self { guides: [[0; W]; GUIDES], volumes: Volumes::ZERO, workspace: PathWorkspace::ZERO };

    fn parts(&mut self, width: usize) -> Parts<'_> {
        Parts {
            codes: part_mut(self.guides.as_flattened_mut(), ..GUIDES * width),
            columns: self.volumes.flat(),
            workspace: RowWorkspace::of_rest(self.workspace.words()),
        }
    }

    fn column_bytes(width: usize, stride: usize) -> usize {
        (VOLUMES * width + COLUMNS_OFF) * stride
    }

    // The winners are the first in the workspace.
    fn confidences(&self, width: usize) -> &[u8] {
        part(self.workspace.bytes(), ..width)
    }

    fn finished(&mut self, width: usize) -> RowWorkspace<'_> {
        let mut workspace = self.parts(width).workspace;
        workspace.divide(width);
        workspace
    }
}

once_without_vectors! {
    /// Line `y` of the left image, one of the last ones.
    fn guide<S: SgmParameters>(lines: &[u8], y: usize, width: usize) -> &[u8] {
        slot(lines, y % guides::<S>(), width)
    }
}

/// Adds row `bottom` to the costs and selects the winners of `row`, `ROWS_BELOW` rows above it.
#[inline(always)]
fn select<S: SgmParameters, const MOST: usize>(
    frame: &mut Frame<'_>,
    bottom: usize,
    lines: Option<[&Rows5<'_>; 2]>,
    row: Option<usize>,
) {
    let (width, stride, config) = (frame.width, frame.stride, frame.config);
    let (costs, rest) = split_mut(frame.columns, width * stride);
    let (top, rest) = split_mut(rest, (width + COLUMNS_OFF) * stride);
    let (sums, rest) = split_mut(rest, width * stride);
    let mut work = PathWork {
        width,
        stride,
        disparities: usize::from(config.disparities),
        min_disparity: usize::from(config.min_disparity),
        penalties: &config.penalties,
        gradient_shift: gradient_shift(config.noise),
        costs,
        top,
        sums: &mut [],
        workspace: &mut [],
    };
    let guide = |y: usize| guide::<S>(frame.codes, y, width);
    let has_noise = config.noise != Noise::None;
    let mut smoothed = [[&[][..]; 5]; 2];
    let seen = lines.map(|lines| {
        if !has_noise {
            return lines;
        }
        // Where sums will be, ten smoothed lines have room: a column has sixteen sums at least.
        denoise(lines, &mut smoothed, 1, chunks_mut(sums, width));
        smoothed.each_ref()
    });
    if let Some(lines) = seen {
        let workspace = view_mut::<u32, u8>(frame.workspace.costs());
        frame.backend.sgm_cost::<S, MOST>(&mut work, CostWork { is_first: bottom == 0, lines, workspace });
    }
    let here = row.map_or(&[][..], guide);
    if S::WITHIN_EDGES {
        let (above, below) = split_mut(rest, width * stride);
        let inside = |y: &usize| *y < usize::from(config.height);
        let next = bottom.checked_sub(1).filter(inside).map_or(&[][..], guide);
        let guides = [here, next, seen.map_or(&[][..], |[left, _]| left[2])];
        frame.backend.sgm_within_edges::<MOST>(&mut work, EdgeWork { guides, above, below });
    }
    // The features are done with, and the smoothed lines.
    work.sums = sums;
    frame.workspace.divide(width);
    if let Some(row) = row {
        let flags = frame.flags.row_mut(row);
        frame.backend.fill_bytes(flags, PixelFlags::CLEAR.bits());
        let guide = Guide { here, above: row.checked_sub(1).map(guide), row };
        let ForWinners { winners, margins, workspace } = frame.workspace.for_winners(config.needs_margins());
        work.workspace = workspace;
        let unique = Unique::new(config.checks.uniqueness_percent, flags, margins);
        let select = Select { disparities: work.disparities, winners, unique };
        // Where no pixel has a candidate there are no costs.
        if work.min_disparity < width {
            frame.backend.sgm_select::<MOST>(&mut work, guide, select);
        }
    }
    if let Some([left, _]) = lines {
        let kept = row_mut(frame.codes, bottom % guides::<S>(), width);
        if has_noise {
            smooth(left, 2, kept);
        } else if let Some(line) = left[2].get(..kept.len()) {
            copy_row(line, kept);
        }
    }
}
