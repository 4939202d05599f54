//! An image file as lines in their native pixel format.

use super::MockError;
use super::integrity::{self, Integrity};
use crate::limits::{DECODER_BYTES, IMAGE_SIDE};
use image::error::{ImageError, LimitErrorKind};
use image::metadata::Orientation;
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::Path;
use stereopsis::camera::{LineFormat, PixelFormat};

/// The longest file that is read: an uncompressed image of the largest size, RGBA with 16 bits, as ASCII PPM.
const MOST_FILE_BYTES: u64 = crate::limits::IMAGE_BYTES;

/// A decoded file.
pub(super) struct Picture {
    /// Size and pixel layout.
    pub format: LineFormat,
    /// All lines, one after the other, in that layout.
    pub bytes: Vec<u8>,
    /// Whether the file had an alpha channel, which is dropped.
    pub had_alpha: bool,
}

/// Reads and decodes a whole file.
pub(super) fn read(path: &Path) -> Result<Picture, MockError> {
    let file = load(path)?;
    let guess = image::guess_format(&file).ok().and_then(|format| Some((format, name(format)?)));
    let Some((format, name)) = guess else { return Err(MockError::NotAnImage { path: path.into() }) };
    let corrupt =
        |reason: &str| MockError::Corrupt { path: path.into(), format: name, reason: reason.into() };
    let whole = match format {
        ImageFormat::Png => integrity::png(&file),
        ImageFormat::Jpeg => integrity::jpeg(&file),
        ImageFormat::WebP => integrity::webp(&file),
        // Their decoders read every byte that a picture needs, and say when one is missing.
        _ => Integrity::Whole,
    };
    let failed = |error: ImageError| match error {
        ImageError::IoError(e) if e.kind() == io::ErrorKind::UnexpectedEof => {
            MockError::Truncated { path: path.into(), format: name }
        }
        ImageError::Unsupported(e) => MockError::Samples { path: path.into(), found: e.to_string() },
        e => corrupt(&e.to_string()),
    };

    let mut reader = ImageReader::with_format(Cursor::new(&file), format);
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(DECODER_BYTES);
    reader.limits(limits);
    let mut decoder = match reader.into_decoder() {
        Ok(decoder) => decoder,
        Err(_) if whole == Integrity::Truncated => {
            return Err(MockError::Truncated { path: path.into(), format: name });
        }
        Err(e) => return Err(failed(e)),
    };
    // The header's size is checked before a byte is allocated for the picture.
    let (width, height) = decoder.dimensions();
    if width == 0 || height == 0 {
        return Err(MockError::ZeroSize { path: path.into(), width, height });
    }
    if width > u32::from(IMAGE_SIDE) || height > u32::from(IMAGE_SIDE) {
        return Err(MockError::TooLarge { path: path.into(), width, height });
    }
    match whole {
        Integrity::Whole => {}
        Integrity::Truncated => return Err(MockError::Truncated { path: path.into(), format: name }),
        Integrity::Corrupt(reason) => return Err(corrupt(reason)),
    }
    // A file that says nothing of its orientation, or nothing that can be read, is upright.
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    match DynamicImage::from_decoder(decoder) {
        Ok(mut image) => {
            image.apply_orientation(orientation);
            let samples = || MockError::Samples { path: path.into(), found: "floating point".into() };
            lines(image).ok_or_else(samples)
        }
        Err(ImageError::Limits(e)) if e.kind() == LimitErrorKind::InsufficientMemory => {
            Err(corrupt("it asks for more memory than its picture can need"))
        }
        Err(e) => Err(failed(e)),
    }
}

/// Whether a file's header says that its samples have 16 bits; no picture is decoded.
pub(super) fn is_deep(path: &Path) -> bool {
    let color = || {
        let found = std::fs::metadata(path).ok()?;
        if !found.is_file() || found.len() > MOST_FILE_BYTES {
            return None;
        }
        let mut reader = ImageReader::open(path).ok()?.with_guessed_format().ok()?;
        // The others have 8 bits.
        if !matches!(reader.format()?, ImageFormat::Png | ImageFormat::Pnm | ImageFormat::Tiff) {
            return None;
        }
        let mut limits = Limits::no_limits();
        limits.max_alloc = Some(DECODER_BYTES);
        reader.limits(limits);
        Some(reader.into_decoder().ok()?.color_type())
    };
    matches!(color(), Some(ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16))
}

/// The file's bytes; a device or an endless pipe is not followed.
fn load(path: &Path) -> Result<Vec<u8>, MockError> {
    let read = |source| MockError::Read { path: path.into(), source };
    let found = std::fs::metadata(path).map_err(read)?;
    if !found.is_file() {
        return Err(MockError::NotAFile { path: path.into() });
    }
    // Nothing is read of what is too long; a file may grow while it is read.
    if found.len() > MOST_FILE_BYTES {
        return Err(MockError::FileTooLong { path: path.into(), most: MOST_FILE_BYTES });
    }
    let mut bytes = Vec::new();
    File::open(path).map_err(read)?.take(MOST_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(read)?;
    if bytes.is_empty() {
        return Err(MockError::Empty { path: path.into() });
    }
    if bytes.len() as u64 > MOST_FILE_BYTES {
        return Err(MockError::FileTooLong { path: path.into(), most: MOST_FILE_BYTES });
    }
    Ok(bytes)
}

/// The name of a format that is read.
fn name(format: ImageFormat) -> Option<&'static str> {
    match format {
        ImageFormat::Png => Some("PNG"),
        ImageFormat::Jpeg => Some("JPEG"),
        ImageFormat::Pnm => Some("PNM"),
        ImageFormat::Tiff => Some("TIFF"),
        ImageFormat::Bmp => Some("BMP"),
        ImageFormat::WebP => Some("WebP"),
        _ => None,
    }
}

/// The lines of a decoded image, alpha dropped; `None` for samples that are not whole numbers.
pub(super) fn lines(image: DynamicImage) -> Option<Picture> {
    let (width, height) = (u16::try_from(image.width()).ok()?, u16::try_from(image.height()).ok()?);
    let had_alpha = image.color().has_alpha();
    let (pixel, bytes) = match image {
        DynamicImage::ImageLuma8(_) | DynamicImage::ImageLumaA8(_) => {
            (PixelFormat::Grey8, image.into_luma8().into_raw())
        }
        DynamicImage::ImageRgb8(_) | DynamicImage::ImageRgba8(_) => {
            (PixelFormat::Rgb8, image.into_rgb8().into_raw())
        }
        DynamicImage::ImageLuma16(_) | DynamicImage::ImageLumaA16(_) => {
            let samples = image.into_luma16().into_raw();
            (PixelFormat::Grey16 { bits: significant_bits(&samples) }, low_byte_first(&samples))
        }
        DynamicImage::ImageRgb16(_) | DynamicImage::ImageRgba16(_) => {
            let samples = image.into_rgb16().into_raw();
            (PixelFormat::Rgb16 { bits: significant_bits(&samples) }, low_byte_first(&samples))
        }
        _ => return None,
    };
    Some(Picture { format: LineFormat { width, height, pixel }, bytes, had_alpha })
}

/// The bit length of the largest sample, at least 8: sensors with 10 or 12 bits store their samples in 16.
fn significant_bits(samples: &[u16]) -> u8 {
    let largest = samples.iter().copied().max().unwrap_or(0);
    // At most 16: the cast loses nothing.
    (u16::BITS - largest.leading_zeros()).max(8) as u8
}

fn low_byte_first(samples: &[u16]) -> Vec<u8> {
    samples.iter().flat_map(|sample| sample.to_le_bytes()).collect()
}
