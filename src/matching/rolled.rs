//! Loops that stay as they are written.

/// In the body of a loop: on 32-bit cores it is neither unrolled nor turned into vectors. Where a row's work
/// is little, that would take more flash than it saves instructions.
///
/// It is no instruction, but what is in memory is read anew with each turn: what does not change belongs in a
/// variable.
#[inline(always)]
pub(super) fn rolled() {
    #[cfg(target_pointer_width = "32")]
    core::hint::black_box(());
}

/// The same, but where there are vectors for it.
#[inline(always)]
pub(super) fn rolled_if_scalar() {
    #[cfg(not(stereopsis_vectors))]
    rolled();
}
