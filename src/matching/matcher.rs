//! A matcher: its memory, and one row after another through the stages.

use super::backend::{Backend, Isa, SMOOTH_MARGIN, columns_begin};
use super::capacity::{Capacity, Supported};
use super::config::{Config, ConfigError};
use super::error::MatchError;
use super::kernel::{Kernel, KernelError};
use super::memory::rings::{BAND, HISTORY, LOOK_AHEAD, Ring, row, row_mut};
use super::memory::workspace::Finished;
use super::memory::{Memory, Parts, Rows5};
use super::method::{Frame, Method};
use super::row::Row;
use super::stages::{self, mask};
use super::state_bytes::state_bytes;
#[cfg(feature = "trace")]
use super::trace::StageTrace;
use crate::matching::memory::slices::part_mut;
use crate::matching::memory::views::view_mut;
use crate::units::{Disparity, PixelFlags};

/// Disparities for lines up to `W` pixels and `D` disparities, in memory of its own and of fixed size.
///
/// Each line goes in with the two above it and the two below, and its row comes out [`Matcher::DELAY`] lines
/// later.
/// [`Pipeline`](crate::pipeline::Pipeline) feeds it from a camera.
///
/// `D` is a multiple of 16, at most 256, and `W` at least `D`; another choice does not compile.
pub struct Matcher<S: Method, const W: usize, const D: usize> {
    pub(super) memory: S::Memory<W, D>,
    texture: [u16; W],
    textured: [u8; W],
    edges: [u8; W],
    blocks: InWords<[u8; W]>,
    band: [[Disparity; W]; BAND],
    band_flags: [[PixelFlags; W]; BAND],
    support: [u16; W],
    finished: [[Disparity; W]; HISTORY],
    config: Config,
    backend: Backend,
    /// The backend of the next frame, once one is chosen.
    next_backend: Backend,
    backend_chosen: bool,
    /// Where a frame's columns begin in their room, the same from line to line wherever the matcher is moved
    /// to.
    columns_begin: u8,
    /// Lines taken, counting on below the image.
    pub(super) taken: usize,
}

/// What begins where a word may stand.
#[repr(align(4))]
struct InWords<T>(T);

impl<S: Method, const W: usize, const D: usize> Matcher<S, W, D> {
    /// How many lines after its own a row comes out: the rows that the method looks down, and those that the
    /// speckle filter waits for.
    pub const DELAY: usize = S::RADIUS_Y + LOOK_AHEAD;

    const CHECKED: () = {
        assert!(W >= D, "W must be at least D");
        assert!(W <= u16::MAX as usize, "W must be at most 65535");
        assert!(
            3 * D >= 2 * SMOOTH_MARGIN + size_of::<u32>(),
            "the workspace must hold a row of answers and what is around it"
        );
        assert!(size_of::<Self>() <= state_bytes::<S>(W, D), "state_bytes must cover the state");
    };

    /// A matcher that waits for [`Self::start`]. Every byte of it is zero: a static of it takes RAM and no
    /// flash.
    pub const fn new() -> Self
    where
        Capacity<D>: Supported,
    {
        const { Self::CHECKED };
        Self {
            memory: S::Memory::EMPTY,
            texture: [0; W],
            textured: [0; W],
            edges: [0; W],
            blocks: InWords([0; W]),
            band: [[Disparity::ZERO; W]; BAND],
            band_flags: [[PixelFlags::CLEAR; W]; BAND],
            support: [0; W],
            finished: [[Disparity::ZERO; W]; HISTORY],
            config: Config::UNSET,
            backend: Backend::FIRST,
            next_backend: Backend::FIRST,
            backend_chosen: false,
            columns_begin: 0,
            taken: 0,
        }
    }

    /// Checks what is asked for and gets ready for the first frame, with the fastest kernel of this processor
    /// unless [`Self::set_kernel`] chose one.
    pub fn start(&mut self, config: &Config) -> Result<(), ConfigError> {
        config.check(W, D)?;
        self.config = Config { confidence: config.confidence || config.min_confidence > 0, ..*config };
        if !self.backend_chosen {
            (self.next_backend, self.backend_chosen) = (Backend::detect(), true);
        }
        self.begin_frame();
        Ok(())
    }

    /// Chooses the kernel from the next frame on: within a frame kernels keep their own form of what they
    /// have seen. Every kernel gives the same bits.
    ///
    /// Fails where the processor does not run it, and leaves the kernel as it is.
    pub fn set_kernel(&mut self, kernel: Kernel) -> Result<(), KernelError> {
        let backend = Backend::of(kernel).ok_or(KernelError::Unavailable(kernel))?;
        (self.next_backend, self.backend_chosen) = (backend, true);
        Ok(())
    }

    /// The kernel in use, once started.
    pub fn kernel(&self) -> Kernel {
        self.backend.kernel()
    }

    /// The configuration that [`Self::start`] took, with `confidence` set where `min_confidence` needs it;
    /// all zero before.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Starts a new frame: the next line pushed is row 0, and rows of an unfinished frame are lost.
    pub fn begin_frame(&mut self) {
        self.taken = 0;
        self.backend = self.next_backend;
        let (width, stride) = self.size();
        let columns = self.memory.parts(width).columns;
        self.columns_begin = columns_begin(columns, S::Memory::<W, D>::column_bytes(width, stride));
        stages::begin(self.frame());
    }

    /// Takes the next row with the two lines above and below it in both cameras. [`MatchError::FrameDone`]
    /// after the last line; an error changes nothing.
    pub fn push(&mut self, left: &[&[u8]; 5], right: &[&[u8]; 5]) -> Result<(), MatchError> {
        self.step(Some([left, right]))
    }

    /// Goes on below the image's last row, until the last results are out. Before the last row went in, and
    /// after the last result, it is [`MatchError::FrameDone`].
    pub fn flush(&mut self) -> Result<(), MatchError> {
        self.step(None)
    }

    /// The row that the last [`Self::push`] or [`Self::flush`] completed; `None` for the first
    /// [`Self::DELAY`] of a frame.
    pub fn row(&self) -> Option<Row<'_>> {
        let width = usize::from(self.config.width);
        let index = self.taken.checked_sub(Self::DELAY + 1)?;
        let flags = row(self.band_flags.as_flattened(), index % BAND, width);
        Some(Row {
            index,
            width,
            height: usize::from(self.config.height),
            flags,
            finished: self.finished.as_flattened(),
            band: self.band.as_flattened(),
            sigma_px: S::SIGMA_PX,
            confidences: if self.config.confidence { self.memory.confidences(width) } else { &[] },
        })
    }

    /// Takes the answers of the row that came out last away where one of the cameras did not see.
    ///
    /// `valid` is given the row and two masks to write, of the left and of the right image's pixels: 1 for
    /// one that was seen, 0 for another. It says whether it wrote them; without, everything was seen. An
    /// answer stays whose pixel was seen, and in the right image the pixel nearest to its partner. Else
    /// there is none, of [`PixelFlags::OUTSIDE`] alone; [`PixelFlags::DAMAGED`] stays.
    // Nothing is left of it where the source has no mask.
    #[inline]
    pub fn mask(&mut self, valid: impl FnOnce(u16, [&mut [u8]; 2]) -> bool) {
        let Some((row, [left, right])) = self.last_row() else { return };
        if valid(row.index, [&mut *left, &mut *right]) {
            row.take_away(left, right);
        }
    }

    /// Flags every pixel of the row that came out last as [`PixelFlags::DAMAGED`]; its answers go unless
    /// `keeps_answers`.
    pub(crate) fn mark_damaged(&mut self, keeps_answers: bool) {
        if let Some((row, _)) = self.last_row() {
            row.mark_damaged(keeps_answers);
        }
    }

    /// The row that came out last, and places for the masks of both images.
    fn last_row(&mut self) -> Option<(mask::Masked<'_>, [&mut [u8]; 2])> {
        let width = usize::from(self.config.width).min(W);
        let index = self.taken.checked_sub(Self::DELAY + 1)?;
        let Finished { confidences, withheld, masks } = self.memory.finished(width).finished();
        let row = mask::Masked {
            index: index as u16,
            answers: row_mut(self.finished.as_flattened_mut(), index % HISTORY, width),
            flags: row_mut(self.band_flags.as_flattened_mut(), index % BAND, width),
            confidences: if self.config.confidence { confidences } else { &mut [] },
            withheld: if self.config.min_confidence > 0 { withheld } else { &mut [] },
        };
        Some((row, masks))
    }

    fn step(&mut self, lines: Option<[&Rows5<'_>; 2]>) -> Result<(), MatchError> {
        let y = self.take(lines)?;
        S::step_for(D)(self.frame(), y, lines);
        Ok(())
    }

    /// Takes the next row as [`Self::push`] does, or what comes below the last one as [`Self::flush`] does,
    /// and shows `trace` the rows that stages make of it.
    #[cfg(feature = "trace")]
    pub fn step_traced(
        &mut self,
        lines: Option<[&[&[u8]; 5]; 2]>,
        trace: &mut dyn StageTrace,
    ) -> Result<(), MatchError> {
        let y = self.take(lines)?;
        S::step_for(D)(Frame { trace: Some(trace), ..self.frame() }, y, lines);
        Ok(())
    }

    /// Counts the next row, if it is due and its lines are long enough, and gives its number.
    #[inline(always)]
    fn take(&mut self, lines: Option<[&Rows5<'_>; 2]>) -> Result<usize, MatchError> {
        let height = usize::from(self.config.height);
        if height == 0 {
            return Err(MatchError::NotStarted);
        }
        let y = self.taken;
        if S::EXTERNAL_WINNERS {
            return Err(MatchError::Winners { needed: usize::from(self.config.width) });
        }
        if y >= height + Self::DELAY || lines.is_some() != (y < height) {
            return Err(MatchError::FrameDone);
        }
        let needed = usize::from(self.config.width);
        if lines.is_some_and(|[l, r]| l.iter().chain(r).any(|line| line.len() < needed)) {
            return Err(MatchError::LineTooShort { needed });
        }
        self.taken += 1;
        Ok(y)
    }

    /// The width of a frame, and how many candidates of a column the kernel works on.
    fn size(&self) -> (usize, usize) {
        let disparities = usize::from(self.config.disparities);
        (usize::from(self.config.width).min(W), self.backend.candidates(disparities, D))
    }

    /// The memory as slices of the frame's real size: what follows is compiled once for each method.
    // In flash once.
    #[inline(never)]
    pub(super) fn frame(&mut self) -> Frame<'_> {
        let (width, stride) = self.size();
        let Parts { codes, columns, workspace } = self.memory.parts(width);
        let columns = part_mut(columns, usize::from(self.columns_begin)..);
        let columns = part_mut(columns, ..S::Memory::<W, D>::column_bytes(width, stride));
        Frame {
            width,
            stride,
            backend: self.backend,
            config: &self.config,
            codes,
            columns,
            workspace,
            texture: part_mut(&mut self.texture, ..width),
            textured: part_mut(&mut self.textured, ..width),
            edges: part_mut(&mut self.edges, ..width),
            blocks: view_mut(&mut self.blocks.0),
            support: part_mut(&mut self.support, ..width),
            band: Ring::new(self.band.as_flattened_mut(), width),
            flags: Ring::new(self.band_flags.as_flattened_mut(), width),
            finished: Ring::new(self.finished.as_flattened_mut(), width),
            #[cfg(feature = "trace")]
            trace: None,
        }
    }
}

impl<S: Method, const W: usize, const D: usize> Default for Matcher<S, W, D>
where
    Capacity<D>: Supported,
{
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::super::state_bytes::{FIXED_BYTES, PADDING_BYTES};
    use super::*;
    use crate::matching::method::{External, Fast, Sgm, SgmEdge, SgmLean};

    /// How many bytes more are given than a matcher takes.
    fn spare<S: Method, const W: usize, const D: usize>() -> Option<usize> {
        state_bytes::<S>(W, D).checked_sub(size_of::<Matcher<S, W, D>>())
    }

    #[test]
    fn the_bytes_that_are_given_are_those_of_the_state_and_few_more() {
        let spares = [
            spare::<Sgm, 16, 16>(),
            spare::<Sgm, 332, 48>(),
            spare::<Sgm, 333, 48>(),
            spare::<SgmEdge, 1281, 128>(),
            spare::<SgmEdge, 1242, 128>(),
            spare::<SgmLean, 320, 64>(),
            spare::<SgmEdge, 700, 256>(),
            spare::<External<Sgm>, 320, 64>(),
        ];
        let is_little =
            |spare: &Option<usize>| spare.is_some_and(|spare| spare <= FIXED_BYTES + PADDING_BYTES);
        assert!(spares.iter().all(is_little), "{spares:?}");
    }

    #[test]
    fn sizes_are_rounded_up_to_what_there_is_a_matcher_for() {
        assert_eq!(state_bytes::<Sgm>(100, 17), state_bytes::<Sgm>(100, 32));
        assert_eq!(state_bytes::<Sgm>(10, 32), state_bytes::<Sgm>(32, 32));
        assert!(state_bytes::<Sgm>(33, 32) > state_bytes::<Sgm>(32, 32));
    }

    #[test]
    fn lines_may_begin_anywhere_in_memory() {
        let memory: [[u8; 16]; 2] = [[3; 16], [200; 16]].map(|line| {
            let mut byte = 0;
            line.map(|grey: u8| {
                byte += 1;
                grey.wrapping_mul(byte)
            })
        });
        let mut matcher = Matcher::<Fast, 16, 16>::new();
        for (kernel, width) in
            Kernel::available().flat_map(|kernel| (1..=9).map(move |width| (kernel, width)))
        {
            let mut first = None;
            for place in 0..4 {
                // The same line, moved on by a byte each time.
                let mut moved = [[0u8; 16]; 2];
                for (moved, line) in moved.iter_mut().zip(&memory) {
                    moved[place..place + width].copy_from_slice(&line[..width]);
                }
                let [left, right] = moved.each_ref().map(|line| [&line[place..place + width]; 5]);
                matcher.set_kernel(kernel).expect("an available kernel");
                matcher.start(&Config::for_method::<Fast>(width as u16, 1, 16)).expect("it fits");
                matcher.push(&left, &right).expect("a line");
                (1..=Matcher::<Fast, 16, 16>::DELAY).for_each(|_| matcher.flush().expect("a row is due"));
                let mut row = [Disparity::NONE; 9];
                row[..width].copy_from_slice(matcher.row().expect("it is out").disparities());
                assert_eq!(*first.get_or_insert(row), row, "{} {width} {place}", kernel.name());
            }
        }
    }
}
