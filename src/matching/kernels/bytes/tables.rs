//! What every left code costs against the right codes of a row.
//!
//! A code of four bits is one of sixteen: so few that the costs of all of them are made once a row, in order of the right
//! pixels. The candidates of a left pixel are then a piece of its code's line. From code to code, in an order in which one
//! bit changes at a time (Gray's), every cost changes by one: an addition for eight of them.
//!
//! ```text
//! place p   of the reversed row: right pixel p in the low half of a byte, p + apart in the high one
//! ```

use super::bytes_of;

/// Bytes of a code's line.
pub(super) const LINE: usize = 96;
/// Codes of four bits.
const CODES: usize = 16;

/// A one in every half of a byte.
const ONE: u32 = 0x1111_1111;

/// The lines of all codes, half a byte a cost.
pub(super) type Table = [[u32; LINE / 4]; CODES];

/// Makes all costs the same one.
pub(super) fn fill(table: &mut Table, cost: u32) {
    table.as_flattened_mut().fill(cost * ONE);
}

/// Makes the costs of so many pixels, the last one first, with candidates `apart` apart in both halves of a byte: against a
/// reversed row whose right codes are the high halves of its bytes; or with `LEFT` what the costs leave of four.
#[inline(never)]
pub(super) fn make<const LEFT: bool>(table: &mut Table, row: &[u8], apart: usize, pixels: usize) {
    let far = row.get(apart..).unwrap_or(&[]).as_chunks::<4>().0;
    let words = row.as_chunks::<4>().0.iter().zip(far).take((pixels + apart).div_ceil(4)).enumerate();
    for (word, (&near, &far)) in words {
        let right = u32::from_le_bytes(near) >> 4 & 0x0f0f_0f0f | u32::from_le_bytes(far) & 0xf0f0_f0f0;
        // Against the opposite code all bits differ that do not.
        put(table, word, if LEFT { !right } else { right });
    }
}

/// The costs of all codes against eight right ones: 44 instructions.
#[inline(always)]
fn put(table: &mut Table, word: usize, right: u32) {
    let bits: [u32; 4] = core::array::from_fn(|bit| right >> bit & ONE);
    let more = bits.map(|bits| ONE.wrapping_sub(2 * bits));
    let mut costs = bits.iter().sum::<u32>();
    let word = word % (LINE / 4);
    table[0][word] = costs;
    // The next code differs in one bit, which it has or has not.
    macro_rules! next {
        ($(($code:literal $change:ident $bit:literal))*) => {
            $(
                costs = costs.$change(more[$bit]);
                table[$code][word] = costs;
            )*
        };
    }
    next! {
        (1 wrapping_add 0) (3 wrapping_add 1) (2 wrapping_sub 0) (6 wrapping_add 2)
        (7 wrapping_add 0) (5 wrapping_sub 1) (4 wrapping_sub 0) (12 wrapping_add 3)
        (13 wrapping_add 0) (15 wrapping_add 1) (14 wrapping_sub 0) (10 wrapping_sub 2)
        (11 wrapping_add 0) (9 wrapping_sub 1) (8 wrapping_sub 0)
    }
}

/// The costs of a code from a place on.
#[inline(always)]
pub(super) fn costs(table: &Table, code: u8, place: usize, count: usize) -> &[u8] {
    let line = table.get(usize::from(code)).map_or(&[][..], |line| bytes_of(line));
    line.get(place..).and_then(|line| line.get(..count)).unwrap_or(&[])
}
