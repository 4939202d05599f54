//! The halves of a circular DMA buffer.

use super::LineFault;

/// A half of a DMA buffer.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Half {
    /// Filled first; the half-transfer interrupt tells.
    #[default]
    First,
    /// Filled second; the transfer-complete interrupt tells.
    Second,
}

impl Half {
    /// The other one.
    pub const fn other(self) -> Self {
        match self {
            Self::First => Self::Second,
            Self::Second => Self::First,
        }
    }
}

/// Takes lines out of a circular DMA buffer of two lines, and knows when one was missed or torn.
///
/// ```text
/// DMA        first   │ second  │ first   │ second  │ ...
/// interrupt          ^ half    ^ whole   ^ half
/// copied             first ──┐ second ──┐
///                            must be done before the DMA is back in that half
/// ```
///
/// The interrupt of a half calls [`Self::take`], which copies the line into a slot of
/// [`LineSlots`](super::LineSlots). The DMA does not wait: after the copy its position tells whether it has
/// come back into the half meanwhile.
#[derive(Clone, Copy, Default, Debug)]
pub struct PingPong {
    due: Half,
    missed: u32,
    torn: u32,
}

impl PingPong {
    /// Before the first half of a transfer.
    pub const fn new() -> Self {
        Self { due: Half::First, missed: 0, torn: 0 }
    }

    /// The transfer begins anew, with its first half.
    pub fn restart(&mut self) {
        self.due = Half::First;
    }

    /// Copies the half that is `done` into `line`, as many bytes as both have. `writing` is asked afterwards
    /// which half the DMA is in: it is compared by its remaining count, as in `if ndtr > length / 2 {
    /// Half::First } else { Half::Second }`.
    ///
    /// [`LineFault::Torn`]: the DMA is in the half that was copied; what was copied is of two lines. Lines that were missed
    /// before this one come as [`Self::take`]'s number: it is 0 unless an interrupt was lost.
    pub fn take(
        &mut self,
        done: Half,
        bytes: &[u8],
        line: &mut [u8],
        writing: impl FnOnce() -> Half,
    ) -> Result<u32, LineFault> {
        // One interrupt lost: the other half came once. More than one cannot be told here; time stamps do.
        let missed = u32::from(done != self.due);
        self.missed = self.missed.saturating_add(missed);
        self.due = done.other();
        line.iter_mut().zip(bytes).for_each(|(to, &from)| *to = from);
        if writing() == done {
            self.torn = self.torn.saturating_add(1);
            return Err(LineFault::Torn);
        }
        Ok(missed)
    }

    /// Lines whose interrupt was lost.
    pub fn missed(&self) -> u32 {
        self.missed
    }

    /// Lines that the DMA came back into while they were copied.
    pub fn torn(&self) -> u32 {
        self.torn
    }
}
