//! The census of `fast`, [`crate::imaging::census_plus4`], and of `block`, [`crate::imaging::census_ring8`].
#![allow(unsafe_code)]

use super::rows::fill;
use crate::matching::memory::Rows5;
use core::arch::asm;

/// How far a code looks.
const REACH: usize = 2;

/// The codes of the row at the centre of five. `room` holds that row and two pixels beside it on both sides.
#[inline(never)]
pub fn census_plus4(rows: &Rows5<'_>, room: &mut [u8], out: &mut [u8]) {
    let &[above, _, centre, _, below] = rows;
    let width = out.len();
    let Some(centre) = centre.get(..width) else { return };
    // Columns outside are the nearest one inside.
    let Some((before, more)) = room.split_at_mut_checked(REACH) else { return };
    let Some((inside, after)) = more.split_at_mut_checked(width) else { return };
    let Some(after) = after.first_chunk_mut::<REACH>() else { return };
    fill(before, centre.first().copied().unwrap_or(0));
    fill(after, centre.last().copied().unwrap_or(0));
    for (inside, &pixel) in inside.iter_mut().zip(centre) {
        *inside = pixel;
    }
    compare(above, room, below, out);
}

/// [`census_plus4`] with the centre row in `centre`, from [`REACH`] columns before the first. Sixteen
/// instructions for 16 pixels.
#[inline(never)]
fn compare(above: &[u8], centre: &[u8], below: &[u8], out: &mut [u8]) {
    let count = out.len();
    if count == 0 || above.len() < count || below.len() < count || centre.len() < count + 2 * REACH {
        return;
    }
    // SAFETY: `count` bytes are read of `above` and `below` and written of `out`, and of `centre` up to
    // `REACH` more on both sides, as asked for above: the loop is one for so many lanes of bytes.
    unsafe {
        asm!(
            "dlstp.8 lr, {count}",
            "2:",
            "vldrb.u8 q0, [{centre}], #16",
            "vmov.i8 q1, #0",
            "vldrb.u8 q2, [{above}], #16",
            "vpt.u8 hi, q0, q2",
            "vaddt.i8 q1, q1, {first}",
            "vldrb.u8 q2, [{centre}, #-18]",
            "vpt.u8 hi, q0, q2",
            "vaddt.i8 q1, q1, {second}",
            "vldrb.u8 q2, [{centre}, #-14]",
            "vpt.u8 hi, q0, q2",
            "vaddt.i8 q1, q1, {third}",
            "vldrb.u8 q2, [{below}], #16",
            "vpt.u8 hi, q0, q2",
            "vaddt.i8 q1, q1, {fourth}",
            "vstrb.8 q1, [{out}], #16",
            "letp lr, 2b",
            count = in(reg) count, centre = inout(reg) centre.as_ptr().add(REACH) => _,
            above = inout(reg) above.as_ptr() => _, below = inout(reg) below.as_ptr() => _,
            out = inout(reg) out.as_mut_ptr() => _,
            first = in(reg) 1, second = in(reg) 2, third = in(reg) 4, fourth = in(reg) 8,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, options(nostack),
        );
    }
}

/// Columns of a row's piece at one side of the image: two pixels, and what their codes look at.
const SIDE: usize = 2 + 2 * REACH;

/// The codes of eight bits of the row at the centre of five.
#[inline(never)]
pub fn census_ring8(rows: &Rows5<'_>, out: &mut [u8]) {
    let width = out.len();
    let &[above, _, centre, _, below] = rows;
    let [Some(above), Some(centre), Some(below)] = [above, centre, below].map(|row| row.get(..width)) else {
        return;
    };
    let rows = [above, centre, below];
    if width < 2 * REACH {
        return narrow(rows, out);
    }
    let Some(inside) = width.checked_sub(REACH).and_then(|end| out.get_mut(REACH..end)) else { return };
    compare_around(rows, inside);
    // The pixels at both sides in one vector, from pieces of rows in which columns outside stand as well.
    let pieces = rows.map(|row| {
        let mut piece = [0; 2 * SIDE];
        let (left, right) = piece.split_at_mut(SIDE);
        if let (Some(first), Some(last)) = (row.first_chunk::<4>(), row.last_chunk::<4>()) {
            let ([a, b, c, d], [e, f, g, h]) = (*first, *last);
            left.copy_from_slice(&[a, a, a, b, c, d]);
            right.copy_from_slice(&[e, f, g, h, h, h]);
        }
        piece
    });
    let mut codes = [0; 2 * SIDE - 2 * REACH];
    compare_around(pieces.each_ref().map(|piece| &piece[..]), &mut codes);
    let [first, second, .., before, last] = codes;
    if let [a, b, .., c, d] = out {
        (*a, *b, *c, *d) = (first, second, before, last);
    }
}

/// [`census_ring8`] of rows of one to three pixels.
fn narrow(rows: [&[u8]; 3], out: &mut [u8]) {
    let last = out.len().saturating_sub(1);
    let pieces = rows.map(|row| {
        let column = |x: usize| row.get(x.saturating_sub(REACH).min(last)).copied().unwrap_or(0);
        core::array::from_fn::<u8, { 4 * REACH }, _>(column)
    });
    compare_around(pieces.each_ref().map(|piece| &piece[..]), out);
}

/// [`census_ring8`] of rows that begin [`REACH`] columns before the first code and end as many after the
/// last. 28 instructions for 16 pixels.
#[inline(never)]
fn compare_around([above, centre, below]: [&[u8]; 3], out: &mut [u8]) {
    let count = out.len();
    let needed = count + 2 * REACH;
    if count == 0 || above.len() < needed || centre.len() < needed || below.len() < needed {
        return;
    }
    // SAFETY: `count` bytes are written of `out`, and up to `2 * REACH` more read of each row, as asked for
    // above: the loop is one for so many lanes of bytes.
    unsafe {
        asm!(
            ".irp bit, 3, 4, 5, 6, 7",
            "vmov.i8 q\\bit, #1 << \\bit",
            ".endr",
            "dlstp.8 lr, {count}",
            "2:",
            "vldrb.u8 q0, [{centre}, #2]",
            "vmov.i8 q1, #0",
            "vldrb.u8 q2, [{above}, #2]",
            "vpt.u8 hi, q0, q2",
            "vaddt.i8 q1, q1, {bit1}",
            "vldrb.u8 q2, [{above}, #4]",
            "vpt.u8 hi, q0, q2",
            "vaddt.i8 q1, q1, {bit2}",
            "vldrb.u8 q2, [{above}], #16",
            "vpt.u8 hi, q0, q2",
            "vaddt.i8 q1, q1, {bit0}",
            "vldrb.u8 q2, [{centre}, #4]",
            "vpt.u8 hi, q0, q2",
            "vorrt q1, q1, q4",
            "vldrb.u8 q2, [{centre}], #16",
            "vpt.u8 hi, q0, q2",
            "vorrt q1, q1, q3",
            "vldrb.u8 q2, [{below}, #2]",
            "vpt.u8 hi, q0, q2",
            "vorrt q1, q1, q6",
            "vldrb.u8 q2, [{below}, #4]",
            "vpt.u8 hi, q0, q2",
            "vorrt q1, q1, q7",
            "vldrb.u8 q2, [{below}], #16",
            "vpt.u8 hi, q0, q2",
            "vorrt q1, q1, q5",
            "vstrb.8 q1, [{out}], #16",
            "letp lr, 2b",
            count = in(reg) count, above = inout(reg) above.as_ptr() => _,
            centre = inout(reg) centre.as_ptr() => _, below = inout(reg) below.as_ptr() => _,
            out = inout(reg) out.as_mut_ptr() => _, bit0 = in(reg) 1, bit1 = in(reg) 2, bit2 = in(reg) 4,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _, out("q5") _,
            out("q6") _, out("q7") _, options(nostack),
        );
    }
}
