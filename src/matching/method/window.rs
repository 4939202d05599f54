//! The two methods whose costs are sums of Hamming distances over a window: their census and the window.

use super::denoise::denoise;
use super::{Costs, Frame, Method};
use crate::imaging::Noise;
use crate::matching::backend::{
    CODES_SHARE_A_BYTE, CensusWork, Isa, MethodParameters, TABLE_WORDS, TABLE_WORDS_OF_EIGHT,
    WindowParameters, WindowWork,
};
use crate::matching::memory::rings::{row as slot, row_mut};
use crate::matching::memory::winners::{Select, Unique};
use crate::matching::memory::workspace::ForWinners;
use crate::matching::memory::{Bytes, Rows5, WindowMemory};
use crate::units::PixelFlags;

/// Census rows that are held: those under the window and the one that leaves it, row `y` in slot `y % rows`.
const fn rows<S: WindowParameters>() -> usize {
    2 * S::RADIUS_Y + 2
}

/// Bytes that a pixel's two codes take: one, where no kernel wants more.
const fn code_bytes<S: WindowParameters>() -> usize {
    if CODES_SHARE_A_BYTE && S::BITS <= 4 { 1 } else { 2 }
}

/// Words for the tables of the kernel that has some.
const fn table_words<S: WindowParameters>() -> usize {
    if CODES_SHARE_A_BYTE { most_table_words::<S>() } else { 0 }
}

/// Words for the tables of any target: a matcher's bytes are given for all processors alike.
const fn most_table_words<S: WindowParameters>() -> usize {
    if S::BITS <= 4 { TABLE_WORDS } else { TABLE_WORDS_OF_EIGHT }
}

/// What the arithmetic relies on.
const fn check<S: WindowParameters>() {
    let column = S::BITS * (2 * S::RADIUS_Y + 1);
    assert!(
        column < 1 << S::COLUMN_BITS && S::COLUMN_BITS <= 8,
        "a column's sum must fit its bits, and a byte"
    );
    let window = (column >> S::COLUMN_SHIFT) * (2 * S::RADIUS_X + 1);
    assert!(window < u8::MAX as usize, "a window's sum must fit a byte, and be no 255");
}

/// [`Costs`] of a window.
macro_rules! window_costs {
    ($method:ty) => {
        const _: () = check::<$method>();

        impl Costs for $method {
            type Memory<const W: usize, const D: usize> = WindowMemory<
                { code_bytes::<$method>() },
                { rows::<$method>() },
                { table_words::<$method>() },
                W,
                D,
            >;
            const BYTES: Bytes =
                WindowMemory::<2, { rows::<$method>() }, { most_table_words::<$method>() }, 0, 0>::BYTES;

            #[inline(always)]
            fn enter(frame: &mut Frame<'_>, y: usize, lines: [&Rows5<'_>; 2]) {
                enter::<Self>(frame, y, lines);
            }

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

window_costs!(Fast);
window_costs!(Block);

/// Method `fast`: a 4-bit census (up, down, left, right at distance 2) summed over 9x7 pixels.
#[derive(Clone, Copy, Debug)]
pub struct Fast;

impl MethodParameters for Fast {
    const RADIUS_X: usize = 4;
    const RADIUS_Y: usize = 3;
}

impl Method for Fast {
    const SIGMA_PX: f32 = 0.15;
    const NAME: &'static str = "fast";
}

impl WindowParameters for Fast {
    const BITS: usize = 4;
    const COLUMN_BITS: usize = 5;
    const COLUMN_SHIFT: usize = 0;
}

/// Method `block`: an 8-bit census in 5x5 summed over 9x9 pixels, in quarters.
#[derive(Clone, Copy, Debug)]
pub struct Block;

impl MethodParameters for Block {
    const RADIUS_X: usize = 4;
    const RADIUS_Y: usize = 4;
}

impl Method for Block {
    const SIGMA_PX: f32 = 0.15;
    const NAME: &'static str = "block";
}

impl WindowParameters for Block {
    const BITS: usize = 8;
    const COLUMN_BITS: usize = 7;
    const COLUMN_SHIFT: usize = 2;
}

/// Turns the lines around row `y` into its codes.
fn enter<S: WindowParameters>(frame: &mut Frame<'_>, y: usize, lines: [&Rows5<'_>; 2]) {
    let row = row_mut(frame.codes, y % rows::<S>(), code_bytes::<S>() * frame.width);
    let mut smoothed = [[&[][..]; 5]; 2];
    let workspace;
    let lines = if frame.config.noise == Noise::None {
        workspace = frame.workspace.costs();
        lines
    } else {
        // Codes look at three rows of the five.
        let places;
        (places, workspace) = frame.workspace.smoothed_lines(frame.width);
        denoise(lines, &mut smoothed, 2, places);
        smoothed.each_ref()
    };
    let min_disparity = usize::from(frame.config.min_disparity);
    frame.backend.census::<S>(CensusWork { lines, min_disparity, workspace, codes: row });
}

/// Moves the window; without a `row`, costs are only gathered.
#[inline(always)]
fn select<S: WindowParameters, const MOST: usize>(
    frame: &mut Frame<'_>,
    bottom: usize,
    lines: Option<[&Rows5<'_>; 2]>,
    row: Option<usize>,
) {
    if lines.is_none() && row.is_none() {
        return;
    }
    let (width, config) = (frame.width, frame.config);
    let leaves = bottom.checked_sub(2 * S::RADIUS_Y + 1);
    let codes = |y: usize| slot(frame.codes, y % rows::<S>(), code_bytes::<S>() * width);
    let (workspace, select) = match row {
        Some(row) => {
            let flags = frame.flags.row_mut(row);
            frame.backend.fill_bytes(flags, PixelFlags::CLEAR.bits());
            let ForWinners { winners, margins, workspace } =
                frame.workspace.for_winners(config.needs_margins());
            let unique = Unique::new(config.checks.uniqueness_percent, flags, margins);
            (workspace, Some(Select { disparities: usize::from(config.disparities), winners, unique }))
        }
        None => (frame.workspace.costs(), None),
    };
    let work = WindowWork {
        width,
        stride: frame.stride,
        min_disparity: usize::from(config.min_disparity),
        enter: lines.map(|_| codes(bottom)),
        leave: leaves.map(codes),
        columns: frame.columns,
        workspace,
    };
    frame.backend.window::<S, MOST>(work, select);
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;

    struct Any<const RADIUS: usize, const BITS: usize, const COLUMN_BITS: usize, const SHIFT: usize>;

    impl<const RADIUS: usize, const BITS: usize, const COLUMN_BITS: usize, const SHIFT: usize>
        MethodParameters for Any<RADIUS, BITS, COLUMN_BITS, SHIFT>
    {
        const RADIUS_X: usize = RADIUS;
        const RADIUS_Y: usize = RADIUS - 1;
    }

    impl<const RADIUS: usize, const BITS: usize, const COLUMN_BITS: usize, const SHIFT: usize>
        WindowParameters for Any<RADIUS, BITS, COLUMN_BITS, SHIFT>
    {
        const BITS: usize = BITS;
        const COLUMN_BITS: usize = COLUMN_BITS;
        const COLUMN_SHIFT: usize = SHIFT;
    }

    fn is_refused<S: WindowParameters>() -> bool {
        std::panic::catch_unwind(check::<S>).is_err()
    }

    #[test]
    fn what_the_arithmetic_relies_on_is_checked() {
        assert!(!is_refused::<Fast>() && !is_refused::<Block>());
        // Three rows of five bits: 15, in four bits, and 5 x 15 in a window.
        assert!(!is_refused::<Any<2, 5, 4, 0>>());
        assert!(is_refused::<Any<2, 5, 3, 0>>());
        assert!(is_refused::<Any<2, 6, 4, 0>>());
        assert!(is_refused::<Any<2, 5, 9, 0>>());
        // 50 in a column: 5 x 50 fits a byte, 5 x 51 is the number that no sum may be.
        assert!(!is_refused::<Any<2, 16, 8, 0>>());
        assert!(is_refused::<Any<2, 17, 8, 0>>());
        // Half of 100, and of 102.
        assert!(!is_refused::<Any<2, 33, 8, 1>>());
        assert!(is_refused::<Any<2, 34, 8, 1>>());
    }

    #[test]
    fn rows_and_tables_are_those_of_the_window() {
        assert_eq!((rows::<Fast>(), rows::<Block>()), (8, 10));
        assert_eq!(most_table_words::<Fast>(), TABLE_WORDS);
        assert_eq!(most_table_words::<Block>(), TABLE_WORDS_OF_EIGHT);
        let (bytes, tables) = if CODES_SHARE_A_BYTE { (1, TABLE_WORDS) } else { (2, 0) };
        assert_eq!((code_bytes::<Fast>(), table_words::<Fast>()), (bytes, tables));
        let tables = if CODES_SHARE_A_BYTE { TABLE_WORDS_OF_EIGHT } else { 0 };
        assert_eq!((code_bytes::<Block>(), table_words::<Block>()), (2, tables));
    }
}
