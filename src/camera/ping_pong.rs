//! Ping-pong buffering: the halves of a circular DMA buffer.

use super::LineFault;

/// One half of a circular DMA buffer.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Half {
    /// First half, complete at the half-transfer interrupt.
    #[default]
    First,
    /// Second half, complete at the transfer-complete interrupt.
    Second,
}

impl Half {
    /// Returns the other half.
    pub const fn other(self) -> Self {
        match self {
            Self::First => Self::Second,
            Self::Second => Self::First,
        }
    }
}

/// Copies lines out of a circular DMA buffer of two lines, and detects missed and torn ones.
///
/// ```text
/// DMA        first   │ second  │ first   │ second  │ ...
/// interrupt          ^ half    ^ whole   ^ half
/// copied             first ──┐ second ──┐
///                            must be done before the DMA is back in that half
/// ```
///
/// The interrupt of a half calls [`Self::take`], which copies the line into a slot of
/// [`LineSlots`](super::LineSlots). The DMA does not wait: its position after the copy shows whether it has
/// come back into that half.
#[derive(Clone, Copy, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PingPong {
    due: Half,
    missed: u32,
    torn: u32,
    /// Missed lines before torn ones, which are told with the next line.
    untold: u32,
}

impl PingPong {
    /// Creates the state before a transfer's first half.
    pub const fn new() -> Self {
        Self { due: Half::First, missed: 0, torn: 0, untold: 0 }
    }

    /// Restarts with the first half of a new transfer.
    pub fn restart(&mut self) {
        (self.due, self.untold) = (Half::First, 0);
    }

    /// Copies the half that is `done` into `line`, as many bytes as both have, and returns how many lines
    /// were missed since the last one that was returned: 0 unless an interrupt was lost. Torn lines are not
    /// among them.
    ///
    /// `writing` is called after the copy and returns the half that the DMA is in, by its remaining count:
    /// `if ndtr > length / 2 { Half::First } else { Half::Second }`. Where that is the copied half, the copy
    /// mixes two lines: [`LineFault::Torn`].
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
        self.untold = self.untold.saturating_add(missed);
        if writing() == done {
            self.torn = self.torn.saturating_add(1);
            return Err(LineFault::Torn);
        }
        Ok(core::mem::take(&mut self.untold))
    }

    /// Number of lines whose interrupt was lost.
    pub fn missed(&self) -> u32 {
        self.missed
    }

    /// Number of lines that the DMA overwrote while they were copied.
    pub fn torn(&self) -> u32 {
        self.torn
    }
}
