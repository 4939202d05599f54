//! A row of codes from right to left.

use crate::matching::backend::loops::keep_loop;
use crate::matching::memory::slices::{part, part_mut};
use core::arch::asm;

/// The bytes of a row from `last` back, of each the bits of a mask, of which some are inverted; before the
/// row its first stands for them, and where there is no row, 0. 20 instructions for sixteen.
#[inline(never)]
pub(in super::super) fn reverse(row: &[u8], last: i32, mask: u32, inverted: u32, out: &mut [u32]) {
    let begin = part(row, ..((last + 1).max(0) as usize).min(row.len()));
    let count = (begin.len() / 16).min(out.len() / 4);
    let rest = part(begin, ..begin.len() - 16 * count);
    if count > 0 {
        // SAFETY: of sixteen bytes `count` times, the last ones first, as many words are made: the row has so
        // many, and `out`.
        unsafe {
            asm!(
                "2:",
                "ldr {d}, [{row}, #-4]",
                "ldr {c}, [{row}, #-8]",
                "ldr {b}, [{row}, #-12]",
                "ldr {a}, [{row}, #-16]!",
                "and {d}, {d}, {mask}",
                "and {c}, {c}, {mask}",
                "and {b}, {b}, {mask}",
                "and {a}, {a}, {mask}",
                "eor {d}, {d}, {inverted}",
                "eor {c}, {c}, {inverted}",
                "eor {b}, {b}, {inverted}",
                "eor {a}, {a}, {inverted}",
                "rev {d}, {d}",
                "rev {c}, {c}",
                "rev {b}, {b}",
                "rev {a}, {a}",
                "strd {d}, {c}, [{out}], #8",
                "strd {b}, {a}, [{out}], #8",
                "subs {count}, {count}, #1",
                "bne 2b",
                row = inout(reg) begin.as_ptr_range().end => _,
                out = inout(reg) out.as_mut_ptr() => _,
                count = inout(reg) count => _,
                mask = in(reg) mask, inverted = in(reg) inverted,
                a = out(reg) _, b = out(reg) _, c = out(reg) _, d = out(reg) _,
                options(nostack),
            );
        }
    }
    let (rest, words) = rest.split_at_checked(rest.len() % 4).unwrap_or_default();
    let words = words.as_chunks::<4>().0;
    let masked = |bytes: u32| bytes & mask ^ inverted;
    let before = u32::from(row.first().copied().unwrap_or(0)) * 0x0101_0101;
    let out = part_mut(out, 4 * count..);
    for (out, word) in out.iter_mut().zip(words.iter().rev()) {
        keep_loop();
        *out = masked(u32::from_be_bytes(*word));
    }
    let out = part_mut(out, words.len()..);
    if let Some((next, out)) = out.split_first_mut() {
        *next = masked(rest.iter().fold(before, |word, &byte| word << 8 | u32::from(byte)));
        let before = masked(before);
        for out in out {
            keep_loop();
            *out = before;
        }
    }
}
