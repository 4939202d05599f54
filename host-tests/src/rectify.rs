//! Pictures through the core's remap.

use crate::run::MemoryPair;
use image::{GrayImage, RgbImage};
use std::fmt;
use stereopsis::camera::{CameraError, StereoSource};
use stereopsis::geometry::{Real, rectify::Rectification};
use stereopsis::imaging::{
    RectifiedPair, RectifiedPairError, Remap, RemapError, RemapPair, RemapTable, RemapTableError,
};

/// Capacities for the largest pictures: columns, lines held at once, slots of the table.
const WIDTH: usize = 4096;
const LINES: usize = 1025;
const SLOTS: usize = 300_000;
/// The fewest lines that a remap may have.
const FEWEST_LINES: usize = 3;
/// The remaps are made and moved on the stack.
const STACK: usize = 256 << 20;

/// A pair of pictures, rectified.
#[derive(Clone, PartialEq, Debug)]
pub struct RectifiedPictures {
    /// Left and right.
    pub pictures: [GrayImage; 2],
    /// 255 where the raw pictures were seen, 0 elsewhere.
    pub valid: [GrayImage; 2],
    /// Raw rows that the left and the right remap need at once.
    pub rows: [u16; 2],
    /// The side of a cell of the tables' lattices, px.
    pub cells: [u16; 2],
}

/// Why pictures were not rectified.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RectifyPicturesError {
    /// A warp has no table.
    #[error("the {0} image cannot be remapped: {1}")]
    Table(&'static str, RemapTableError),
    /// A remap refused.
    #[error("the {0} image cannot be remapped: {1}")]
    Remap(&'static str, RemapError),
    /// The source or the pair failed.
    #[error("{0}")]
    Pair(String),
    /// The system gave no thread.
    #[error("no thread for the remap: {0}")]
    Thread(std::io::Error),
}

/// A source of rectified lines over one of raw lines, with room for the largest pictures.
pub type RectifiedSource<'a, S> = RectifiedPair<'a, S, WIDTH, LINES, SLOTS>;

/// Does something with rectified lines over a source of raw ones.
pub fn with_rectified<S, T>(
    rectification: &Rectification<f64>,
    source: S,
    work: impl FnOnce(&mut RectifiedSource<'_, S>) -> T + Send,
) -> Result<T, RectifyPicturesError>
where
    S: StereoSource + Send,
    S::Error: std::fmt::Display,
    T: Send,
{
    std::thread::scope(|scope| {
        let builder = std::thread::Builder::new().stack_size(STACK);
        let in_thread = || {
            let mut remaps = remaps(rectification)?;
            let pair = RectifiedPair::new(source, &mut remaps);
            Ok(work(&mut pair.map_err(|e| RectifyPicturesError::Pair(e.to_string()))?))
        };
        let thread = builder.spawn_scoped(scope, in_thread).map_err(RectifyPicturesError::Thread)?;
        thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// Takes a frame of a source of raw lines and rectifies it line by line, as a microcontroller does.
pub fn rectify<S>(
    rectification: &Rectification<f64>,
    source: S,
) -> Result<RectifiedPictures, RectifyPicturesError>
where
    S: StereoSource + Send,
    S::Error: std::fmt::Display,
{
    with_rectified(rectification, source, frame)?
}

/// Rectifies two colour pictures of one size, channel by channel.
pub fn rectify_colours(
    rectification: &Rectification<f64>,
    left: &RgbImage,
    right: &RgbImage,
) -> Result<(RgbImage, RgbImage), RectifyPicturesError> {
    let size = rectification.size();
    let (mut new_left, mut new_right) = (
        RgbImage::new(size.width.into(), size.height.into()),
        RgbImage::new(size.width.into(), size.height.into()),
    );
    for channel in 0..3 {
        let of = |picture: &RgbImage| picture.pixels().map(|pixel| pixel.0[channel]).collect();
        let width = u16::try_from(left.width()).unwrap_or(u16::MAX);
        let pair = MemoryPair::new(width, of(left), of(right))
            .ok_or_else(|| RectifyPicturesError::Pair("the images differ in size".into()))?;
        let [of_left, of_right] = rectify(rectification, pair)?.pictures;
        for (to, from) in [(&mut new_left, of_left), (&mut new_right, of_right)] {
            to.pixels_mut().zip(from.pixels()).for_each(|(to, from)| to.0[channel] = from.0[0]);
        }
    }
    Ok((new_left, new_right))
}

/// What a firmware's remaps take; shown as the type to write.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct RemapCapacity {
    /// Columns of the raw and the rectified images.
    pub width: usize,
    /// Raw lines of each camera that are held at once, and the copy of one.
    pub lines: usize,
    /// Slots of the larger table.
    pub slots: usize,
}

impl RemapCapacity {
    /// The least that a rectification takes.
    pub fn of<T: Real>(rectification: &Rectification<T>) -> Result<Self, RectifyPicturesError> {
        std::thread::scope(|scope| {
            let in_thread = || {
                let pair = remaps(rectification)?;
                let tables = pair.remaps().map(|remap| remap.table());
                let sizes = tables.iter().flat_map(|table| [table.size().width, table.raw_size().width]);
                let width = sizes.max().unwrap_or(0).into();
                let slots = tables.map(RemapTable::slots_taken).into_iter().max().unwrap_or(0);
                // A band of fewer lines is refused by the type.
                Ok(Self { width, lines: pair.lines_needed().max(FEWEST_LINES), slots })
            };
            let builder = std::thread::Builder::new().stack_size(STACK);
            let thread = builder.spawn_scoped(scope, in_thread).map_err(RectifyPicturesError::Thread)?;
            thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        })
    }

    /// What two capacities take.
    pub fn max(self, other: Self) -> Self {
        Self {
            width: self.width.max(other.width),
            lines: self.lines.max(other.lines),
            slots: self.slots.max(other.slots),
        }
    }

    /// Bytes of the remaps and their masks, but for a few words.
    pub const fn bytes(self) -> usize {
        2 * (self.width * (self.lines + 1) + 8 * self.slots)
    }
}

impl fmt::Display for RemapCapacity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RemapPair<{}, {}, {}>", self.width, self.lines, self.slots)
    }
}

/// The remaps of both cameras.
fn remaps<T: Real>(
    rectification: &Rectification<T>,
) -> Result<Box<RemapPair<WIDTH, LINES, SLOTS>>, RectifyPicturesError> {
    let [first, second] = rectification.warps();
    let remap = |side, warp| {
        let table = RemapTable::<SLOTS>::new(warp).map_err(|e| RectifyPicturesError::Table(side, e))?;
        Remap::<WIDTH, LINES, SLOTS>::new(table).map_err(|e| RectifyPicturesError::Remap(side, e))
    };
    Ok(Box::new(RemapPair::new(remap("left", first)?, remap("right", second)?)))
}

fn frame<S>(pair: &mut RectifiedSource<'_, S>) -> Result<RectifiedPictures, RectifyPicturesError>
where
    S: StereoSource,
    S::Error: std::fmt::Display,
{
    let tables = pair.remaps().map(|remap| remap.table());
    let (rows, cells) = (tables.map(RemapTable::rows), tables.map(|table| 1 << table.shift()));
    let format = pair.format();
    let blank = || GrayImage::new(format.width.into(), format.height.into());
    let mut result =
        RectifiedPictures { pictures: [blank(), blank()], valid: [blank(), blank()], rows, cells };
    let stopped = |e: CameraError<RectifiedPairError<S::Error>>| {
        RectifyPicturesError::Pair(match e {
            CameraError::Hardware(e) => e.to_string(),
            other => format!("{other:?}"),
        })
    };
    pair.start_frame().map_err(stopped)?;
    let width = usize::from(format.width);
    let ([left, right], [valid_left, valid_right]) = (&mut result.pictures, &mut result.valid);
    let lines = left.chunks_exact_mut(width).zip(right.chunks_exact_mut(width));
    let masks = valid_left.chunks_exact_mut(width).zip(valid_right.chunks_exact_mut(width));
    for ((left, right), masks) in lines.zip(masks) {
        pair.next_lines(left, right).map_err(stopped)?;
        for (to, valid) in [masks.0, masks.1].into_iter().zip(pair.valid()) {
            to.iter_mut().zip(valid).for_each(|(to, &valid)| *to = valid * 255);
        }
    }
    Ok(result)
}
