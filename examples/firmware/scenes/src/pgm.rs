//! The header of a binary PGM picture with 8 bits a pixel, byte by byte.

/// Why a file's beginning is no header of such a picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum HeaderError {
    /// It does not begin with `P5` and a blank.
    NotPgm,
    /// The width is missing or no whole number.
    Width,
    /// The height is missing or no whole number.
    Height,
    /// A side is 0 or over [`MOST_PIXELS`].
    Size {
        /// Pixels in a line.
        width: u32,
        /// Lines.
        height: u32,
    },
    /// The largest value is missing or no whole number.
    Largest,
    /// The largest value is not 255.
    Depth {
        /// What it is.
        largest: u32,
    },
    /// The header goes on for over [`LONGEST`] bytes.
    TooLong,
    /// The file ends within the header.
    Ends,
}

/// The most pixels of a side.
pub const MOST_PIXELS: u32 = 4096;
/// The longest header with its comments, bytes.
pub const LONGEST: u16 = 4096;
/// More than any number of a header that makes sense: numbers are read this far.
const MOST: u32 = 1_000_000;

/// Width and height from the header; the pixels begin with the byte after it.
///
/// `next` gives the file's bytes one by one, `None` at the file's end.
///
/// # Errors
/// What of the header is wrong, or what `next` says when reading fails.
pub fn header<E: From<HeaderError>>(next: impl FnMut() -> Result<Option<u8>, E>) -> Result<(u16, u16), E> {
    let mut bytes = Bytes { next, left: LONGEST };
    if bytes.take()? != b'P' || bytes.take()? != b'5' || !bytes.take()?.is_ascii_whitespace() {
        return Err(HeaderError::NotPgm.into());
    }
    let width = bytes.number(HeaderError::Width)?;
    let height = bytes.number(HeaderError::Height)?;
    let largest = bytes.number(HeaderError::Largest)?;
    let side = |pixels: u32| u16::try_from(pixels).ok().filter(|_| (1..=MOST_PIXELS).contains(&pixels));
    let (Some(columns), Some(rows)) = (side(width), side(height)) else {
        return Err(HeaderError::Size { width, height }.into());
    };
    if largest != 255 {
        return Err(HeaderError::Depth { largest }.into());
    }
    Ok((columns, rows))
}

/// The header's bytes, counted.
struct Bytes<F> {
    next: F,
    left: u16,
}

impl<E: From<HeaderError>, F: FnMut() -> Result<Option<u8>, E>> Bytes<F> {
    fn take(&mut self) -> Result<u8, E> {
        self.left = self.left.checked_sub(1).ok_or(HeaderError::TooLong)?;
        (self.next)()?.ok_or_else(|| HeaderError::Ends.into())
    }

    /// A number after blanks and comments, with the one blank that ends it.
    fn number(&mut self, otherwise: HeaderError) -> Result<u32, E> {
        let mut byte = self.take()?;
        while byte == b'#' || byte.is_ascii_whitespace() {
            // A comment goes on to the end of its line.
            while byte == b'#' && self.take()? != b'\n' {}
            byte = self.take()?;
        }
        let mut number = 0;
        loop {
            if !byte.is_ascii_digit() {
                return Err(otherwise.into());
            }
            number = (number * 10 + u32::from(byte - b'0')).min(MOST);
            byte = self.take()?;
            if byte.is_ascii_whitespace() {
                return Ok(number);
            }
        }
    }
}
