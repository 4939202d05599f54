//! The census of `fast`: [`crate::imaging::census_plus4`].
#![allow(unsafe_code)]

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
    before.fill(centre.first().copied().unwrap_or(0));
    after.fill(centre.last().copied().unwrap_or(0));
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
