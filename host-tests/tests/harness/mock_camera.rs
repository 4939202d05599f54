//! The mock camera against every format, depth and fault of an image file.

use image::{DynamicImage, GrayImage, ImageFormat, Luma, Rgb, RgbaImage};
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use stereopsis::camera::{CameraError, CameraPair, LineSource, PixelFormat, StereoSource};
use stereopsis::imaging::GreyLines;
use stereopsis_host::mock::{MockCamera, MockError};

const FORMATS: [(ImageFormat, &str); 6] = [
    (ImageFormat::Png, "png"),
    (ImageFormat::Jpeg, "jpg"),
    (ImageFormat::Pnm, "pnm"),
    (ImageFormat::Tiff, "tiff"),
    (ImageFormat::Bmp, "bmp"),
    (ImageFormat::WebP, "webp"),
];

struct Files(tempfile::TempDir);

impl Files {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn put(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.path().join(name);
        fs::write(&path, bytes).expect("a file in the temporary folder");
        path
    }
}

fn encode(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).expect("an image that the format can hold");
    bytes.into_inner()
}

/// 8-bit samples with detail everywhere.
fn sample(x: u32, y: u32, channel: u32) -> u8 {
    (x * 7 + y * 13 + channel * 50 + (x * y) % 11) as u8
}

fn grey() -> GrayImage {
    GrayImage::from_fn(37, 23, |x, y| Luma([sample(x, y, 0)]))
}

fn frame(camera: &mut MockCamera) -> Vec<u8> {
    let format = camera.format();
    let mut bytes = vec![0; format.line_bytes() * usize::from(format.height)];
    camera.start_frame().expect("a file never fails");
    for (row, line) in bytes.chunks_exact_mut(format.line_bytes()).enumerate() {
        assert_eq!(camera.next_line(line).expect("a line is left").row, row as u16);
    }
    bytes
}

#[test]
fn every_kind_of_samples_comes_out_as_it_is_stored() {
    let files = Files::new();
    let deep = |x: u32, y: u32, c: u32| u16::from(sample(x, y, c)) * 257;
    let kinds: [(DynamicImage, PixelFormat, bool); 8] = [
        (grey().into(), PixelFormat::Grey8, false),
        (DynamicImage::ImageLumaA8(DynamicImage::from(grey()).into_luma_alpha8()), PixelFormat::Grey8, true),
        (DynamicImage::from(grey()).into_rgb8().into(), PixelFormat::Rgb8, false),
        (
            RgbaImage::from_fn(37, 23, |x, y| image::Rgba([0, 1, 2, 3].map(|c| sample(x, y, c)))).into(),
            PixelFormat::Rgb8,
            true,
        ),
        (
            DynamicImage::ImageLuma16(image::ImageBuffer::from_fn(37, 23, |x, y| Luma([deep(x, y, 0)]))),
            PixelFormat::Grey16 { bits: 16 },
            false,
        ),
        (
            DynamicImage::ImageLumaA16(image::ImageBuffer::from_fn(37, 23, |x, y| {
                image::LumaA([deep(x, y, 0), deep(x, y, 1)])
            })),
            PixelFormat::Grey16 { bits: 16 },
            true,
        ),
        (
            DynamicImage::ImageRgb16(image::ImageBuffer::from_fn(37, 23, |x, y| {
                Rgb([0, 1, 2].map(|c| deep(x, y, c)))
            })),
            PixelFormat::Rgb16 { bits: 16 },
            false,
        ),
        (
            DynamicImage::ImageRgba16(image::ImageBuffer::from_fn(37, 23, |x, y| {
                image::Rgba([0, 1, 2, 3].map(|c| deep(x, y, c)))
            })),
            PixelFormat::Rgb16 { bits: 16 },
            true,
        ),
    ];
    for (image, pixel, alpha) in kinds {
        for (format, _) in FORMATS {
            let mut encoded = Cursor::new(Vec::new());
            // A format that cannot hold these samples is out of the question; JPEG changes them.
            if format == ImageFormat::Jpeg || image.write_to(&mut encoded, format).is_err() {
                assert!(format != ImageFormat::Png, "PNG holds every kind");
                continue;
            }
            let is_deep = matches!(pixel, PixelFormat::Grey16 { .. } | PixelFormat::Rgb16 { .. });
            if is_deep && matches!(format, ImageFormat::Bmp | ImageFormat::WebP) {
                continue;
            }
            // The name says nothing: the content does.
            let path = files.put("picture", encoded.get_ref());
            let mut camera = MockCamera::open(&path).unwrap_or_else(|e| panic!("{pixel:?} {format:?}: {e}"));
            // These hold grey samples as colours.
            let in_colours = matches!(format, ImageFormat::Bmp | ImageFormat::WebP);
            let pixel = if in_colours && pixel == PixelFormat::Grey8 { PixelFormat::Rgb8 } else { pixel };
            assert_eq!(camera.format().pixel, pixel, "{format:?}");
            // Grey with alpha is written to BMP without it.
            assert!(camera.had_alpha() == alpha || format == ImageFormat::Bmp, "{format:?}");
            let expected: Vec<u8> = match pixel {
                PixelFormat::Grey8 => image.to_luma8().into_raw(),
                PixelFormat::Rgb8 => image.to_rgb8().into_raw(),
                PixelFormat::Grey16 { .. } => {
                    image.to_luma16().iter().flat_map(|s| s.to_le_bytes()).collect()
                }
                _ => image.to_rgb16().iter().flat_map(|s| s.to_le_bytes()).collect(),
            };
            assert_eq!(frame(&mut camera), expected, "{pixel:?} {format:?}");
            assert_eq!(camera.picture(), image.to_rgb8(), "{pixel:?} {format:?}");
        }
    }
}

#[test]
fn a_jpeg_is_nearly_what_was_stored() {
    let files = Files::new();
    let smooth = GrayImage::from_fn(64, 48, |x, y| Luma([(2 * x + y) as u8]));
    let path = files.put("a.jpg", &encode(&smooth.clone().into(), ImageFormat::Jpeg));
    let bytes = frame(&mut MockCamera::open(path).expect("a JPEG"));
    assert!(bytes.iter().zip(smooth.as_raw()).all(|(a, b)| a.abs_diff(*b) <= 8));
}

#[test]
fn samples_of_a_sensor_keep_their_bits_and_a_pair_shares_them() {
    let files = Files::new();
    let with_largest = |name: &str, largest: u16| {
        let image = image::ImageBuffer::from_fn(20, 4, |x, _| Luma([if x == 7 { largest } else { 3 }]));
        files.put(name, &encode(&DynamicImage::ImageLuma16(image), ImageFormat::Png))
    };
    let pixel = |path: &Path| MockCamera::open(path).expect("a PNG").format().pixel;
    let (ten, twelve) = (with_largest("10", 1023), with_largest("12", 1024 * 3));
    assert_eq!(pixel(&ten), PixelFormat::Grey16 { bits: 10 });
    assert_eq!(pixel(&twelve), PixelFormat::Grey16 { bits: 12 });
    assert_eq!(pixel(&with_largest("8", 9)), PixelFormat::Grey16 { bits: 8 });
    assert_eq!(pixel(&with_largest("16", 65535)), PixelFormat::Grey16 { bits: 16 });
    let (left, right) = MockCamera::open_pair(&ten, &twelve).expect("a pair of one size");
    assert_eq!(left.format().pixel, PixelFormat::Grey16 { bits: 12 });
    assert_eq!(left.format(), right.format());
    assert_eq!(left.picture().get_pixel(7, 0).0, [(1023u16 >> 4) as u8; 3]);
}

#[test]
fn a_grey_and_a_colour_image_make_a_pair_of_equal_lines() {
    let files = Files::new();
    let left = files.put("l", &encode(&grey().into(), ImageFormat::Pnm));
    let same_in_colour = DynamicImage::from(grey()).into_rgb16();
    let right = files.put("r", &encode(&same_in_colour.into(), ImageFormat::Png));
    let (l, r) = MockCamera::open_pair(left, right).expect("one size");
    let adapt = |camera| GreyLines::<_, { 4096 * 6 }>::new(camera).expect("room for the longest line");
    let mut pair = CameraPair::new(adapt(l), adapt(r), 0).expect("both are grey");
    pair.start_frame().expect("a file never fails");
    let (mut a, mut b) = ([0; 37], [0; 37]);
    for y in 0..23 {
        pair.next_lines(&mut a, &mut b).expect("a row is left");
        assert_eq!(a, b, "row {y}");
        assert_eq!(a.as_slice(), &grey().as_raw()[y * 37..][..37]);
    }
}

#[test]
fn the_video_has_no_end_and_lines_follow_the_contract() {
    let files = Files::new();
    let mut camera =
        MockCamera::open(files.put("a", &encode(&grey().into(), ImageFormat::Png))).expect("a PNG");
    let mut line = [0; 40];
    assert_eq!(camera.next_line(&mut line), Err(CameraError::NoLineLeft), "no frame was started");
    for sequence in 0..3 {
        assert_eq!(camera.start_frame().map(|start| start.sequence), Ok(sequence));
        assert_eq!(camera.next_line(&mut line[..36]), Err(CameraError::BufferTooShort { needed: 37 }));
        for row in 0..23 {
            assert_eq!(camera.next_line(&mut line).map(|start| start.row), Ok(row));
        }
        assert_eq!(line[37..], [0; 3], "what is behind the line stays");
        assert_eq!(camera.next_line(&mut line), Err(CameraError::NoLineLeft));
    }
}

#[test]
fn half_a_file_is_an_error_wherever_it_ends() {
    let files = Files::new();
    let image = DynamicImage::from(grey());
    for (format, name) in FORMATS {
        let whole = encode(&image, format);
        MockCamera::open(files.put(name, &whole)).expect("the whole file");
        // All of the header, then every fifth byte, and the last ones.
        let (header, end) = (whole.len().min(64), whole.len().saturating_sub(16));
        for length in (1..header).chain((header..end).step_by(5)).chain(end.max(header)..whole.len()) {
            let path = files.put(name, &whole[..length]);
            let error =
                MockCamera::open(&path).expect_err(&format!("{format:?}: {length} of {} bytes", whole.len()));
            let text = error.to_string();
            assert!(text.contains(name) && !text.contains('\n'), "{text}");
            let late = length > whole.len() / 2 && format != ImageFormat::Tiff;
            assert!(
                !late || matches!(error, MockError::Truncated { .. }),
                "{length} of {}: {text}",
                whole.len()
            );
        }
    }
}

#[test]
fn a_jpeg_with_a_thumbnail_in_its_metadata_ends_with_its_own_end() {
    let files = Files::new();
    let mut whole = encode(&grey().into(), ImageFormat::Jpeg);
    // An application segment that holds a JPEG of its own, end mark included.
    let inside = encode(&GrayImage::new(8, 8).into(), ImageFormat::Jpeg);
    let mut segment = vec![0xff, 0xe1];
    segment.extend((inside.len() as u16 + 2).to_be_bytes());
    segment.extend(&inside);
    whole.splice(2..2, segment);
    MockCamera::open(files.put("thumb.jpg", &whole)).expect("the whole file");
    let cut = files.put("cut.jpg", &whole[..whole.len() - 40]);
    assert!(matches!(MockCamera::open(cut), Err(MockError::Truncated { .. })));
}

#[test]
fn damage_anywhere_is_survived() {
    let files = Files::new();
    for (format, name) in FORMATS {
        let whole = encode(&grey().into(), format);
        let step = (whole.len() / 120).max(1);
        for at in (0..whole.len()).step_by(step) {
            let mut damaged = whole.clone();
            damaged[at] ^= 0x5a;
            // Some damage is a picture of other brightness; none is a panic, and no error has a second line.
            if let Err(error) = MockCamera::open(files.put(name, &damaged)) {
                assert!(error.to_string().contains(name), "{error}");
            }
        }
    }
}

#[test]
fn what_is_no_image_is_named() {
    let files = Files::new();
    let open = |path: &Path| MockCamera::open(path).expect_err("no image");
    assert!(matches!(open(&files.0.path().join("missing.png")), MockError::Read { .. }));
    assert!(matches!(open(files.0.path()), MockError::NotAFile { .. }));
    assert!(matches!(open(&files.put("empty.png", b"")), MockError::Empty { .. }));
    assert!(matches!(open(&files.put("text.png", b"this is text")), MockError::NotAnImage { .. }));
    assert!(matches!(
        open(&files.put("claims", b"P5 5000 10 255\n")),
        MockError::TooLarge { width: 5000, .. }
    ));
    assert!(matches!(open(&files.put("zero", b"P5 0 10 255\n")), MockError::ZeroSize { .. }));
    let mut huge = encode(&grey().into(), ImageFormat::Png);
    huge[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    assert!(matches!(
        open(&files.put("huge.png", &huge)),
        MockError::Corrupt { .. } | MockError::TooLarge { .. }
    ));
    let wide = GrayImage::new(4097, 16);
    assert!(matches!(
        open(&files.put("w", &encode(&wide.into(), ImageFormat::Png))),
        MockError::TooLarge { .. }
    ));
    let float = DynamicImage::ImageRgb32F(image::ImageBuffer::new(4, 4));
    assert!(matches!(
        open(&files.put("f.tiff", &encode(&float, ImageFormat::Tiff))),
        MockError::Samples { .. }
    ));
    MockCamera::open(files.put("most", &encode(&GrayImage::new(4096, 16).into(), ImageFormat::Png)))
        .expect("4096");
}

#[test]
fn two_sizes_are_no_pair() {
    let files = Files::new();
    let left = files.put("l.png", &encode(&GrayImage::new(20, 10).into(), ImageFormat::Png));
    let right = files.put("r.png", &encode(&GrayImage::new(20, 11).into(), ImageFormat::Png));
    let text = MockCamera::open_pair(&left, &right).expect_err("two sizes").to_string();
    assert!(text.contains("l.png is 20 x 10") && text.contains("r.png is 20 x 11"), "{text}");
}
