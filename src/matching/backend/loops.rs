//! Loops that the compiler leaves as they are written, and functions that it compiles once.

use crate::matching::memory::views::{Plain, view, view_mut};
use crate::units::Disparity;

/// Whether this is a microcontroller with vectors, of which the compiler makes use.
pub(in crate::matching) const HAS_VECTORS: bool = cfg!(any(stereopsis_vectors, stereopsis_rvv));

/// Whether the compiler is kept from writing loops out, as on all 32-bit cores. A desktop looks at many
/// pixels at once instead.
pub(in crate::matching) const KEEPS_LOOPS: bool = cfg!(not(stereopsis_simd));

/// In the body of a loop: on 32-bit cores the loop is neither unrolled nor turned into vectors. Where a row's
/// work is little, that would take more flash than it saves instructions.
///
/// It is no instruction, but what is in memory is read anew in each round: what does not change belongs in a
/// variable.
#[inline(always)]
pub(in crate::matching) fn keep_loop() {
    if KEEPS_LOOPS {
        core::hint::black_box(());
    }
}

/// In the body of a loop: [`keep_loop`] on cores without vectors.
#[inline(always)]
pub(in crate::matching) fn keep_scalar_loop() {
    if !HAS_VECTORS {
        keep_loop();
    }
}

/// A slice as it is. On 32-bit cores the compiler does not know its length: it writes no loop over it out.
#[inline(always)]
pub(in crate::matching) fn keep_length<T>(slice: &[T]) -> &[T] {
    if KEEPS_LOOPS { core::hint::black_box(slice) } else { slice }
}

/// Fills a row, 16 numbers at a time: on 32-bit cores in a fraction of the instructions of the compiler's own
/// routine.
#[inline(always)]
pub(in crate::matching) fn fill_row<T: Copy>(row: &mut [T], number: T) {
    let (groups, rest) = row.as_chunks_mut::<16>();
    for group in groups {
        keep_loop();
        *group = [number; 16];
    }
    for one in rest {
        keep_loop();
        *one = number;
    }
}

/// Copies a row to another one of its length.
#[inline(always)]
pub(in crate::matching) fn copy_row<T: Plain>(from: &[T], to: &mut [T]) {
    debug_assert_eq!(from.len(), to.len(), "copied to a row of another length");
    copy_all(view(from), view_mut(to));
}

/// Functions that are part of their caller where that is compiled with a kernel's vectors, and elsewhere are
/// compiled once, for all methods and numbers of disparities.
macro_rules! once_without_vectors {
    ($($function:item)*) => {$(
        #[cfg_attr(stereopsis_simd, inline(always))]
        #[cfg_attr(not(stereopsis_simd), inline(never))]
        $function
    )*};
}
pub(in crate::matching) use once_without_vectors;

/// Makes every byte of a row's numbers the same one. On 32-bit cores the compiler's own routines take a
/// kilobyte of flash.
#[inline(always)]
pub(in crate::matching) fn fill_bytes<T: Plain>(row: &mut [T], byte: u8) {
    fill_all(view_mut(row), byte);
}

/// Each byte of no answer.
pub(in crate::matching) const NO_ANSWER: u8 = Disparity::NONE.raw().to_le_bytes()[0];
const _: () = assert!(Disparity::NONE.raw() == u16::from_le_bytes([NO_ANSWER; 2]));

/// Leaves no answer in a row.
#[inline(always)]
pub(in crate::matching) fn empty_row(answers: &mut [Disparity]) {
    fill_bytes(answers, NO_ANSWER);
}

once_without_vectors! {
    fn fill_all(bytes: &mut [u8], byte: u8) {
        fill_row(bytes, byte);
    }

    fn copy_all(from: &[u8], to: &mut [u8]) {
        let (groups, rest) = to.as_chunks_mut::<4>();
        let (from, from_rest) = from.as_chunks();
        for (to, from) in groups.iter_mut().zip(from) {
            keep_loop();
            *to = *from;
        }
        for (to, from) in rest.iter_mut().zip(from_rest) {
            keep_loop();
            *to = *from;
        }
    }
}
