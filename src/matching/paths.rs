//! The methods whose costs are sums along paths: semi-global matching (Hirschmüller 2008) on lines as they
//! come.
//!
//! A row's costs are averaged with those of the rows above it and of the one below, each half as much as the
//! next; or, at the price of two more bytes for every pixel and disparity, with those above and of the two
//! below as far as no edge of the left image is crossed. Then paths bring together what the pixels of a
//! surface have in common: from the left, from the right, and from above. No frame is kept, and no path comes
//! from below: that path measured least, and it would take the frame.

use super::confidence;
use super::config::Checks;
use super::kernels::{
    COLUMNS_OFF, EdgeWork, Guide, PathWork, Room, Select, Unique, Volumes, Winner, bytes_mut, halves_mut,
    winners_mut,
};
use super::memory::{AfterRow, Bytes, Memory, Parts, first};
use super::penalties::Penalties;
use super::quiet::{gradient_shift, quiet};
use super::row::slot;
use super::scheme::{Around, Lines, Scheme};
use super::speckle::BAND;
use super::stages::{Stages, slot_mut};
use crate::imaging::{Noise, smooth};
use crate::units::PixelFlags;

/// A method along paths.
pub trait Along: Scheme {
    /// Whether a pixel's gradient is compared with all between a candidate and halfway to those beside it
    /// (one of the two halves of Birchfield & Tomasi 1998), or just with the candidate's.
    const BETWEEN_PIXELS: bool;
    /// Whether a row's costs are averaged with those around it within edges: where brightness changes
    /// [much](Penalties::edges) down a column, another surface may begin.
    const WITHIN_EDGES: bool;
    /// Rows below that a row's costs are averaged with.
    const ROWS_BELOW: usize = if Self::WITHIN_EDGES { 2 } else { 1 };
    /// Bytes that are kept for every candidate.
    const VOLUMES: usize = if Self::WITHIN_EDGES { 5 } else { 3 };
}

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

impl Along for Sgm {
    const BETWEEN_PIXELS: bool = true;
    const WITHIN_EDGES: bool = false;
}

impl Along for SgmLean {
    const BETWEEN_PIXELS: bool = false;
    const WITHIN_EDGES: bool = false;
}

impl Along for SgmEdge {
    const BETWEEN_PIXELS: bool = true;
    const WITHIN_EDGES: bool = true;
}

/// [`Scheme`] and [`Lines`] of a method along paths.
macro_rules! along_paths {
    ($method:ty, $name:literal, $penalties:expr) => {
        const _: () = assert!(
            $penalties.check().is_ok() && $penalties.in_noise().check().is_ok(),
            "the default is a good choice"
        );

        impl Scheme for $method {
            const RADIUS_X: usize = 4;
            const RADIUS_Y: usize = <Self as Along>::ROWS_BELOW;
            const SIGMA_PX: f32 = 0.15;
            const STEP: u8 = STEP;
            const SMOOTH_DOWN: bool = true;
            const DEFAULT: Checks = DEFAULT;
            const DEFAULT_IN_NOISE: [Checks; 2] = DEFAULT_IN_NOISE;
            const STRICT: Checks = STRICT;
            const PENALTIES: Penalties = $penalties;
            const PENALTIES_IN_NOISE: Penalties = $penalties.in_noise();
            const NAME: &'static str = $name;
        }

        impl Lines for $method {
            type Memory<const W: usize, const D: usize> =
                PathMemory<{ guides::<$method>() }, { <$method as Along>::VOLUMES }, W, D>;
            const BYTES: Bytes =
                PathMemory::<{ guides::<$method>() }, { <$method as Along>::VOLUMES }, 0, 0>::BYTES;

            #[inline(always)]
            fn enter(_: &mut Stages<'_, Self>, _: usize, _: [&Around<'_>; 2]) {}

            // For the reason that `Kernel::row` is inlined.
            #[inline(always)]
            fn select(
                stages: &mut Stages<'_, Self>,
                bottom: usize,
                lines: Option<[&Around<'_>; 2]>,
                row: Option<usize>,
            ) {
                stages.select_along(bottom, lines, row);
            }

            fn step(stages: Stages<'_, Self>, y: usize, lines: Option<[&Around<'_>; 2]>) {
                stages.step(y, lines);
            }
        }
    };
}

/// Rows of the left image that are held: the one whose winners are due, the one above it and those below that
/// are in.
const fn guides<S: Along>() -> usize {
    S::ROWS_BELOW + 1
}

/// What measured best.
const STEP: u8 = 12;
/// Costs along paths leave small gaps inside of surfaces, which are filled.
const DEFAULT: Checks =
    Checks { smoothing_radius: 8, speckle_pixels: 20, fill_pixels: 16, ..Checks::DEFAULT };
/// Noise makes wrong answers whose cost others come near to, and that few others agree with.
const DEFAULT_IN_NOISE: [Checks; 2] = [
    Checks { uniqueness_percent: Some(5), ..DEFAULT },
    Checks { uniqueness_percent: Some(12), speckle_pixels: 60, ..DEFAULT },
];
/// They are least sure where another disparity costs little more; texture says less than that, for paths
/// bridge what has none.
const STRICT: Checks = Checks {
    uniqueness_percent: Some(30),
    speckle_pixels: 20,
    median: true,
    fill_pixels: 8,
    ..Checks::DEFAULT
};
/// Costs of more rows are surer, so that smaller jumps will do.
const WITHIN_EDGES: Penalties = Penalties { jump: [80, 40, 20], ..Penalties::DEFAULT };

along_paths!(Sgm, "sgm", Penalties::DEFAULT);
along_paths!(SgmLean, "sgm-lean", Penalties::DEFAULT);
along_paths!(SgmEdge, "sgm-edge", WITHIN_EDGES);

/// The memory of a method along paths.
pub struct PathMemory<const GUIDES: usize, const VOLUMES: usize, const W: usize, const D: usize> {
    /// The left image's last rows, row `y` in slot `y % GUIDES`.
    guides: [[u8; W]; GUIDES],
    /// Costs, paths from above, sums; within edges also the average of the rows above and the costs of the
    /// row below.
    volumes: Volumes<VOLUMES, W, D>,
    /// Room for the features of a row; when they are done with, for its winners.
    room: Room<W, D>,
}

impl<const GUIDES: usize, const VOLUMES: usize> PathMemory<GUIDES, VOLUMES, 0, 0> {
    pub const BYTES: Bytes = Bytes {
        fixed: 0,
        per_pixel: GUIDES + Room::<0, 0>::PER_PIXEL,
        per_candidate: VOLUMES,
        per_disparity: COLUMNS_OFF + Room::<0, 0>::PER_DISPARITY,
    };
}

impl<const GUIDES: usize, const VOLUMES: usize, const W: usize, const D: usize> Memory
    for PathMemory<GUIDES, VOLUMES, W, D>
{
    const EMPTY: Self = Self { guides: [[0; W]; GUIDES], volumes: Volumes::ZERO, room: Room::ZERO };

    fn parts(&mut self, width: usize) -> Parts<'_> {
        Parts {
            codes: first(self.guides.as_flattened_mut(), GUIDES * width),
            columns: self.volumes.flat(),
            winners: &mut [],
            right: &mut [],
            lengths: &mut [],
            scratch: self.room.words(),
        }
    }

    fn column_bytes(width: usize, stride: usize) -> usize {
        (VOLUMES * width + COLUMNS_OFF) * stride
    }

    // The winners are the first in the room.
    fn after_winners(&self, width: usize) -> &[u8] {
        self.room.bytes().get(..width).unwrap_or(&[])
    }

    // What the right columns keep stands behind the winners, two bytes for each.
    fn after_row(&mut self, width: usize) -> AfterRow<'_> {
        let room = bytes_mut(self.room.words());
        let (winners, masks) = room.split_at_mut_checked(size_of::<Winner>() * width).unwrap_or_default();
        let (left, right) = first(masks, 2 * width).split_at_mut_checked(width).unwrap_or_default();
        AfterRow { confidences: first(winners, width), masks: [left, right] }
    }
}

impl<'a, S: Along> Stages<'a, S> {
    /// Adds row `bottom` to the costs of the row above it, and selects the winners of that one.
    #[inline(always)]
    fn select_along(&mut self, bottom: usize, lines: Option<[&Around<'_>; 2]>, row: Option<usize>) {
        let (width, stride, config) = (self.width, self.stride, self.config);
        let (costs, rest) = self.columns.split_at_mut_checked(width * stride).unwrap_or_default();
        let (top, rest) = rest.split_at_mut_checked((width + COLUMNS_OFF) * stride).unwrap_or_default();
        let (sums, rest) = rest.split_at_mut_checked(width * stride).unwrap_or_default();
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
        };
        let guide = |y: usize| slot(self.codes, y % guides::<S>(), width);
        let has_noise = config.noise != Noise::None;
        // Where sums will be, ten smoothed lines have room: a column has sixteen sums at least.
        let smoothed;
        let seen = match lines {
            Some(lines) if has_noise => {
                smoothed = quiet(lines, &[0, 1, 2, 3, 4], sums.chunks_exact_mut(width.max(1)));
                Some(smoothed.each_ref())
            }
            lines => lines,
        };
        if let Some(lines) = seen {
            self.kernel.enter::<S>(&mut work, bottom == 0, lines, bytes_mut(self.scratch));
        }
        if S::WITHIN_EDGES {
            let (above, below) = rest.split_at_mut_checked(width * stride).unwrap_or_default();
            let inside = |y: &usize| *y < usize::from(config.height);
            let [here, next] = [2, 1].map(|up| bottom.checked_sub(up).filter(inside).map(guide));
            let guides = [here, next, seen.map(|[left, _]| left[2])];
            self.kernel.within_edges(&mut work, EdgeWork { guides, above, below });
        }
        // The features are done with, and the smoothed lines.
        work.sums = sums;
        let room = core::mem::take(&mut self.scratch);
        let (winners, room) = room.split_at_mut_checked(width).unwrap_or_default();
        let (right, room) = room.split_at_mut_checked(width.div_ceil(2)).unwrap_or_default();
        let (lengths, room) = room.split_at_mut_checked(width.div_ceil(2)).unwrap_or_default();
        self.winners = winners_mut(winners);
        self.right = first(halves_mut(right), width);
        self.support.lengths = first(halves_mut(lengths), width);
        self.scratch = room;
        if let Some(row) = row {
            let flags = slot_mut(self.flags, row % BAND, width);
            flags.fill(PixelFlags::CLEAR);
            let guide = Guide {
                here: guide(row),
                above: row.checked_sub(1).map(guide),
                #[cfg(any(stereopsis_dsp, stereopsis_vectors))]
                row,
            };
            let select = Select {
                disparities: work.disparities,
                winners: self.winners,
                unique: Unique::new(
                    config.checks.uniqueness_percent,
                    flags,
                    confidence::margins(config, self.support.lengths),
                ),
            };
            self.kernel.select(work, guide, select);
        }
        if let Some([left, _]) = lines {
            let kept = slot_mut(self.codes, bottom % guides::<S>(), width);
            if has_noise {
                smooth(left, 2, kept);
            } else if let Some(line) = left[2].get(..kept.len()) {
                kept.copy_from_slice(line);
            }
        }
    }
}
