//! Autofocus as values: it returns commands and takes events, and calls no hardware.

use super::ActuatorLimits;
use super::peak_search::{FocusSearch, FocusSearchStep};

/// What the caller is to do next.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum LensCommand {
    /// Move the lens, wait until it rests, then say [`LensEvent::Arrived`].
    Move(u16),
    /// Take a frame and measure its sharpness, then say [`LensEvent::Sharpness`].
    Measure,
    /// Nothing more: the lens stands where the region is sharpest.
    Focused(Focused),
    /// The search ends without knowing where the lens is in focus.
    Failed(AutofocusError),
}

/// What happened.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum LensEvent {
    /// The lens rests, at this position as far as is known: the one that was asked for where the hardware
    /// does not report its own. A lens that is off by less than half of a step, one of
    /// [`Autofocus::STEPS`] of its range, has arrived; one that is farther off is sent again.
    Arrived(u16),
    /// The command to move could not be given: the bus failed.
    MoveFailed,
    /// The sharpness of the region in a frame that was taken where the lens rests, in any unit that is
    /// proportional to it.
    Sharpness(u32),
    /// The frame was lost or is no good.
    FrameLost,
}

/// Where the lens ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Focused {
    /// The position of the largest sharpness.
    pub position: u16,
    /// Frames that were measured.
    pub frames: u8,
}

/// Why there is no focus.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum AutofocusError {
    /// The sharpness is the same everywhere: the region has no texture, or none in the lens's range.
    Untextured,
    /// The bus failed, the lens did not arrive, or frames were lost, more often in a row than
    /// [`Autofocus::RETRIES`].
    Hardware,
    /// The event does not answer the command.
    Unexpected,
    /// The limits leave no more than [`Autofocus::STEPS`] positions, so that a step is less than one.
    Range {
        /// How many would have been enough.
        needed: u16,
    },
}

error_text!(AutofocusError {
    Self::Untextured => "the region is equally sharp everywhere: it has no texture",
    Self::Hardware => "the lens or the camera failed too often",
    Self::Unexpected => "the event does not answer the command",
    Self::Range { needed } => "the lens must have {needed} positions at least",
});

/// Finds the sharpest position of a lens in [`FocusSearch::MOST_FRAMES`] frames, those that [`FocusSearch`]
/// asks for.
///
/// Every move is at most `most_move` positions; longer ones are made in several. Where there is backlash each
/// position is come to from below. A command that fails is given again, [`Self::RETRIES`] times in a row at
/// most.
///
/// ```
/// use stereopsis::focus::{ActuatorLimits, Autofocus, LensCommand, LensEvent};
/// let limits = ActuatorLimits { least: 0, most: 1023, backlash: 0 };
/// let (mut focus, mut command) = Autofocus::new(limits, 1023, 500);
/// let mut at = 500_i32;
/// let focused = loop {
///     let event = match command {
///         LensCommand::Move(position) => {
///             at = position.into();
///             LensEvent::Arrived(position)
///         }
///         // A lens that is sharpest at 333.
///         LensCommand::Measure => LensEvent::Sharpness((1e9 / (1e3 + f64::from(at - 333).powi(2))) as u32),
///         LensCommand::Focused(focused) => break focused,
///         LensCommand::Failed(error) => panic!("{error}"),
///     };
///     command = focus.event(event);
/// };
/// assert!(focused.position.abs_diff(333) <= 16 && focused.frames <= 12);
/// ```
#[derive(Clone, Debug)]
pub struct Autofocus {
    limits: ActuatorLimits,
    most_move: u16,
    /// Where the lens is, and where it is to be.
    at: u16,
    target: u16,
    /// Whether the target is to be come to from below, and the lens is not below yet.
    is_above: bool,
    failures: u8,
    search: FocusSearch,
    /// What was asked for last.
    asked: LensCommand,
    /// The end, once the search knows it.
    end: Option<Focused>,
}

impl Autofocus {
    /// Number of times in a row that a command which fails is given again: the failure after them ends it.
    pub const RETRIES: u8 = 3;
    /// The result is within one of so many steps of the range.
    pub const STEPS: u16 = FocusSearch::STEPS;

    /// Begins a search with a lens that is at `at`, and the first command.
    pub fn new(limits: ActuatorLimits, most_move: u16, at: u16) -> (Self, LensCommand) {
        let mut new = Self {
            limits,
            most_move: most_move.max(1),
            at,
            target: at,
            is_above: false,
            failures: 0,
            search: FocusSearch::new(limits.least, limits.most),
            asked: LensCommand::Failed(AutofocusError::Range { needed: Self::STEPS + 1 }),
            end: None,
        };
        if limits.most.saturating_sub(limits.least) >= Self::STEPS {
            new.next();
        }
        let command = new.asked;
        (new, command)
    }

    /// What to do after that.
    pub fn event(&mut self, event: LensEvent) -> LensCommand {
        match (self.asked, event) {
            (LensCommand::Focused(_) | LensCommand::Failed(_), _) => {}
            (LensCommand::Move(position), LensEvent::Arrived(at)) => {
                self.at = at;
                if at.abs_diff(position) <= self.most_off() {
                    // So near to where it was to be, it is there: the search tells no such places apart.
                    self.at = position;
                    self.failures = 0;
                    self.travel();
                } else {
                    // Steps were lost: the way is looked at anew from where the lens is.
                    self.fail();
                }
            }
            (LensCommand::Move(_), LensEvent::MoveFailed) | (LensCommand::Measure, LensEvent::FrameLost) => {
                self.fail()
            }
            (LensCommand::Measure, LensEvent::Sharpness(sharpness)) => {
                self.failures = 0;
                self.search.measured(self.target, sharpness);
                self.next();
            }
            _ => self.asked = LensCommand::Failed(AutofocusError::Unexpected),
        }
        self.asked
    }

    /// How far from where it was to be the lens may say that it is: less than half of the search's finest
    /// step.
    fn most_off(&self) -> u16 {
        (self.limits.most.saturating_sub(self.limits.least) / Self::STEPS).saturating_sub(1) / 2
    }

    /// Gives the last command again, or gives up.
    fn fail(&mut self) {
        self.failures += 1;
        if self.failures > Self::RETRIES {
            self.asked = LensCommand::Failed(AutofocusError::Hardware);
        } else if let LensCommand::Move(_) = self.asked {
            // The lens may have gone past the target, which is to be come to from below again.
            self.is_above |= self.limits.backlash > 0 && self.at > self.target;
            self.travel();
        }
    }

    /// Asks the search where to measure.
    fn next(&mut self) {
        match self.search.next() {
            FocusSearchStep::Measure(position) => self.set_out(position),
            FocusSearchStep::Best(position) => {
                self.end = Some(Focused { position, frames: self.search.frames() });
                self.set_out(position);
            }
            FocusSearchStep::Flat => self.asked = LensCommand::Failed(AutofocusError::Untextured),
        }
    }

    fn set_out(&mut self, position: u16) {
        self.target = position;
        self.is_above = self.limits.backlash > 0 && self.at > position;
        self.travel();
    }

    /// The next leg to the target; there, what was to be done there.
    fn travel(&mut self) {
        let below = self.target.saturating_sub(self.limits.backlash).max(self.limits.least);
        if self.is_above && self.at <= below {
            self.is_above = false;
        }
        let goal = if self.is_above { below } else { self.target };
        self.asked = if self.at == goal {
            self.end.map_or(LensCommand::Measure, LensCommand::Focused)
        } else if goal > self.at {
            LensCommand::Move(goal.min(self.at.saturating_add(self.most_move)))
        } else {
            LensCommand::Move(goal.max(self.at.saturating_sub(self.most_move)))
        };
    }
}
