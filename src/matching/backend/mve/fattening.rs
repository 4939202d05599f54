//! Answers refused that spread from a near surface, eight pixels at a time, as `portable/fattening.rs` does.
//!
//! A bound is a minimum over the answers before a pixel, each raised by the slope for every pixel between, as
//! far back as no edge is crossed. In a vector it is made in three steps, over one, two and four lanes; a
//! lane's neighbour is in memory, from which the vector is read again two bytes or more off. From one vector
//! to the next a number is carried. Half-words hold bounds up to the number of no answer, and that bounds
//! nothing.
#![allow(unsafe_code)]

use crate::matching::backend::work::FatteningWork;
use crate::units::{Disparity, PixelFlags};
use core::arch::asm;
use core::mem::MaybeUninit;

/// Pixels in a vector.
const LANES: usize = 8;
/// What both directions need.
#[repr(C)]
struct Room {
    /// Bounds, with none before and after, and edges, likewise.
    beside: [MaybeUninit<[u16; LANES]>; 6],
    /// What a bound is raised by from one vector into the next.
    ramp: [u16; LANES],
    tolerance: [u16; LANES],
}

impl Room {
    /// With what a bound is raised by, over one pixel and over each lane's number of them.
    fn new(slope: u32, lanes: [u32; LANES]) -> Self {
        let ramp = lanes.map(|lanes| raised(slope, lanes) as u16);
        let tolerance = [FatteningWork::TOLERANCE; LANES];
        Self { beside: [MaybeUninit::uninit(); 6], ramp, tolerance }
    }

    /// No bounds and no edges before the first pixels. The compiler would call its own routines for it, which
    /// would be there for this alone.
    #[inline(never)]
    fn begin(&mut self) {
        // SAFETY: six vectors are written, which are the room's first.
        unsafe {
            asm!(
                "vmov.i8 q0, #255",
                "vstrh.16 q0, [{room}], #16",
                "vstrh.16 q0, [{room}], #16",
                "vstrh.16 q0, [{room}], #16",
                "vmov.i8 q0, #0",
                "vstrh.16 q0, [{room}], #16",
                "vstrh.16 q0, [{room}], #16",
                "vstrh.16 q0, [{room}]",
                room = inout(reg) core::ptr::from_mut(self) => _, out("q0") _, options(nostack),
            );
        }
    }

    /// The middle of the bounds, by a pointer to all of it: that of the edges is 48 bytes further, the ramp
    /// 80 and the tolerance 96.
    fn middle(&mut self) -> *mut u16 {
        core::ptr::from_mut(self).cast::<u16>().wrapping_add(LANES)
    }
}

/// The slope over so many pixels, as far as a half-word holds it.
fn raised(slope: u32, pixels: u32) -> u32 {
    (slope * pixels).min(u16::MAX.into())
}

/// A step of a bound, over lanes that are `$by` bytes to the side where `$side` is the sign, to the edges in
/// `$edges`; then the edges over twice as many, in `q2`.
macro_rules! step {
    ($side:literal, $by:literal, $raised:literal, $edges:literal) => {
        concat!(
            "vstrh.16 q3, [{room}]
         vldrh.u16 q4, [{room}, #",
            $side,
            $by,
            "]
         vqadd.u16 q4, q4, ",
            $raised,
            "
         vorr q4, q4, ",
            $edges,
            "
         vmin.u16 q3, q3, q4
         vstrh.16 ",
            $edges,
            ", [{room}, #48]
         vldrh.u16 q4, [{room}, #48 ",
            $side,
            $by,
            "]
         vorr q2, q4, ",
            $edges
        )
    };
}

/// [`Isa::refuse_fattening`](crate::matching::backend::Isa::refuse_fattening): 13 instructions for a pixel.
#[inline(never)]
pub(super) fn refuse(work: FatteningWork<'_>) {
    let FatteningWork { answers, flags, edges, row, slope } = work;
    let count = answers.len();
    if count == 0 || flags.len() < count || edges.len() < count {
        return;
    }
    // What brings a row's bit to a half-word's highest.
    let up = row.leading_zeros() + 8;
    mark_to_right(answers, edges, up, slope.raw().into());
    refuse_to_left(answers, flags, edges, up, slope.raw().into());
}

/// Marks the answers that are beyond the bound of those on their left: 45 instructions for eight pixels.
#[inline(never)]
fn mark_to_right(answers: &[Disparity], edges: &mut [u8], up: u32, slope: u32) {
    let count = answers.len();
    if count == 0 || edges.len() < count {
        return;
    }
    let mut room = Room::new(slope, [1, 2, 3, 4, 5, 6, 7, 8]);
    room.begin();
    // SAFETY: `count` answers are read, and as many edges read and written: the loop is one for so many lanes
    // of half-words. The room is read and written up to eight bytes beside the middle of its bounds and of
    // its edges.
    unsafe {
        asm!(
            "vldrh.u16 q6, [{room}, #80]",
            "vmov.i16 q7, #{refused}",
            "dlstp.16 lr, {carry}",
            "mov {carry}, {none}",
            "2:",
            "vldrh.u16 q0, [{answers}], #16",
            "vldrb.u16 q1, [r0]",
            "vmov q5, q1",
            "vshl.s16 q5, {up}",
            "vshr.s16 q5, q5, #15",
            "vqadd.u16 q3, q0, {tolerance}",
            step!("-", "2", "{one}", "q5"),
            step!("-", "4", "{two}", "q2"),
            step!("-", "8", "{four}", "q2"),
            "vdup.16 q4, {carry}",
            "vqadd.u16 q4, q4, q6",
            "vorr q4, q4, q2",
            "vmin.u16 q3, q3, q4",
            // The bound at each is that behind the one before it.
            "strh {carry}, [{before}]",
            "vstrh.16 q3, [{room}]",
            "vldrh.u16 q4, [{room}, #-2]",
            "strh {none}, [{before}]",
            "vorr q4, q4, q5",
            "vpt.u16 hi, q0, q4",
            "vorrt q1, q1, q7",
            "vstrb.16 q1, [r0], #8",
            "vmov.u16 {carry}, q3[7]",
            "letp lr, 2b",
            room = in(reg) room.middle(), before = in(reg) room.middle().wrapping_sub(1),
            answers = inout(reg) answers.as_ptr() => _, inout("r0") edges.as_mut_ptr() => _,
            up = in(reg) up, tolerance = in(reg) u32::from(FatteningWork::TOLERANCE),
            one = in(reg) slope, two = in(reg) raised(slope, 2), four = in(reg) raised(slope, 4),
            carry = inout(reg) count => _, none = in(reg) u32::from(u16::MAX),
            refused = const FatteningWork::REFUSED, out("lr") _, out("q0") _, out("q1") _, out("q2") _,
            out("q3") _, out("q4") _, out("q5") _, out("q6") _, out("q7") _, options(nostack),
        );
    }
}

/// Refuses those that are marked, and those that are beyond the bound of the answers on their right, which it
/// goes by from the last vector to the first: 60 instructions for eight pixels.
#[inline(never)]
fn refuse_to_left(answers: &mut [Disparity], flags: &mut [PixelFlags], edges: &[u8], up: u32, slope: u32) {
    let count = answers.len();
    if count == 0 || flags.len() < count || edges.len() < count {
        return;
    }
    let groups = count.div_ceil(LANES);
    let last = (groups - 1) * LANES;
    let mut room = Room::new(slope, [8, 7, 6, 5, 4, 3, 2, 1]);
    room.begin();
    // SAFETY: of each row `count` numbers are read, and of the first two written: of the last vector as many
    // lanes as are left. The room is read and written up to eight bytes beside the middle of its bounds and
    // of its edges.
    unsafe {
        asm!(
            "vldrh.u16 q6, [{room}, #80]",
            "vldrh.u16 q7, [{room}, #96]",
            "dls lr, {carry}",
            "mov {carry}, {none}",
            "2:",
            "vctp.16 {lanes}",
            "vpstt",
            "vldrht.u16 q0, [{answers}]",
            "vldrbt.u16 q1, [r0], #-8",
            // Lanes behind the last one bound nothing.
            "vmov.i8 q4, #255",
            "vpsel q3, q0, q4",
            "vmov q5, q1",
            "vshl.s16 q5, {up}",
            "vshr.s16 q5, q5, #15",
            "vqadd.u16 q3, q3, q7",
            "vorr q3, q3, q5",
            step!("+", "2", "{one}", "q5"),
            step!("+", "4", "{two}", "q2"),
            step!("+", "8", "{four}", "q2"),
            "vdup.16 q4, {carry}",
            "vqadd.u16 q4, q4, q6",
            "vorr q4, q4, q2",
            "vmin.u16 q3, q3, q4",
            "strh {carry}, [{room}, #16]",
            "vstrh.16 q3, [{room}]",
            "vldrh.u16 q4, [{room}, #2]",
            "strh {none}, [{room}, #16]",
            "vshl.i16 q1, q1, #8",
            "vshr.s16 q1, q1, #15",
            "vpt.u16 hi, q0, q4",
            "vdupt.16 q1, {none}",
            // What has no answer is not refused.
            "vbic q4, q1, q0",
            "vorr q0, q0, q1",
            "vctp.16 {lanes}",
            "vpstttt",
            "vstrht.16 q0, [{answers}], #-16",
            "vldrbt.u16 q5, [r1]",
            "vcmpt.i16 ne, q4, zr",
            "vorrt.i16 q5, #{untextured}",
            "vpst",
            "vstrbt.16 q5, [r1]",
            "sub r1, r1, #8",
            "add {lanes}, {lanes}, #8",
            "vmov.u16 {carry}, q3[0]",
            "le lr, 2b",
            room = in(reg) room.middle(), answers = inout(reg) answers.as_mut_ptr().add(last) => _,
            inout("r0") edges.as_ptr().add(last) => _, inout("r1") flags.as_mut_ptr().add(last) => _,
            up = in(reg) up, one = in(reg) slope, two = in(reg) raised(slope, 2),
            four = in(reg) raised(slope, 4), carry = inout(reg) groups => _,
            none = in(reg) u32::from(u16::MAX), lanes = inout(reg) count - last => _,
            untextured = const PixelFlags::UNTEXTURED.bits(), out("lr") _, out("q0") _, out("q1") _,
            out("q2") _, out("q3") _, out("q4") _, out("q5") _, out("q6") _, out("q7") _, options(nostack),
        );
    }
}
