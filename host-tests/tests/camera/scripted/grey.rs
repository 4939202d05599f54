//! Any pixel format as grey.

use super::{Camera, LineFault, SMALL, camera};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::camera::{CameraError, CameraPair, LineFormat, LineSource, PixelFormat, StereoSource};
use stereopsis::imaging::GreyLines;
use stereopsis::matching::{Block, Config};
use stereopsis::pipeline::Pipeline;
use stereopsis::units::Disparity;
use stereopsis_host::scene::SceneCamera;
use stereopsis_host::scene::pattern::Pattern;

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 200,
        rng_seed: RngSeed::Fixed(7),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Grey lines against the formula over whole numbers, for all formats, and against the weights of BT.601.
    #[test]
    fn grey_is_the_formula(samples in proptest::collection::vec(any::<u16>(), 24), bits in 8u8..=16) {
        let masked: Vec<u16> = samples.iter().map(|s| s & (u16::MAX >> (16 - bits))).collect();
        let bytes = |samples: &[u16]| -> Vec<u8> { samples.iter().flat_map(|s| s.to_le_bytes()).collect() };
        let eight: Vec<u8> = masked.iter().map(|s| (s / (1 << (bits - 8))) as u8).collect();
        let low: Vec<u8> = samples.iter().map(|s| *s as u8).collect();
        let luma = |rgb: &[u8]| {
            let weights = [4899, 9617, 1868];
            ((rgb.iter().zip(weights).map(|(&c, w)| u32::from(c) * w).sum::<u32>() + 8192) / 16384) as u8
        };

        prop_assert_eq!(grey_line(PixelFormat::Grey8, low.clone()), low.clone());
        prop_assert_eq!(grey_line(PixelFormat::Grey16 { bits }, bytes(&masked)), eight.clone());
        let colour = grey_line(PixelFormat::Rgb8, low.clone());
        prop_assert_eq!(&colour, &low.chunks(3).map(luma).collect::<Vec<_>>());
        let deep = grey_line(PixelFormat::Rgb16 { bits }, bytes(&masked));
        prop_assert_eq!(deep, eight.chunks(3).map(luma).collect::<Vec<_>>());
        for (grey, rgb) in colour.iter().zip(low.chunks(3)) {
            let [r, g, b] = [rgb[0], rgb[1], rgb[2]].map(f64::from);
            prop_assert!((f64::from(*grey) - (0.299 * r + 0.587 * g + 0.114 * b)).abs() <= 0.52);
        }
    }
}

/// One line of raw bytes through [`GreyLines`].
fn grey_line(pixel: PixelFormat, raw: Vec<u8>) -> Vec<u8> {
    let width = raw.len() / pixel.bytes_per_pixel();
    let format = LineFormat { width: width as u16, height: 1, pixel };
    let mut lines = GreyLines::<_, 192>::new(camera(format, raw)).expect("192 bytes are enough");
    assert_eq!(lines.format(), LineFormat { pixel: PixelFormat::Grey8, ..format });
    assert_eq!(lines.start_frame().expect("the camera works").exposure_us, 7);
    let mut grey = vec![0xa5; width + 3];
    assert_eq!(lines.next_line(&mut grey).expect("the camera works").row, 0);
    assert_eq!(grey.split_off(width), [0xa5; 3], "the rest of the buffer is left alone");
    grey
}

#[test]
fn equal_red_green_and_blue_are_that_grey() {
    let all: Vec<u8> = (0..=255).collect();
    for part in all.chunks(32) {
        let rgb = part.iter().flat_map(|&v| [v; 3]).collect();
        assert_eq!(grey_line(PixelFormat::Rgb8, rgb), part);
    }
}

#[test]
fn a_sample_with_more_bits_than_it_said_saturates() {
    let raw = [1023_u16, 1024, 4095, 65535, 1019, 3].iter().flat_map(|s| s.to_le_bytes()).collect();
    assert_eq!(grey_line(PixelFormat::Grey16 { bits: 10 }, raw), [255, 255, 255, 255, 254, 0]);
}

#[test]
fn grey_lines_say_what_they_lack() {
    let format = LineFormat { pixel: PixelFormat::Rgb8, ..SMALL };
    let source = || camera(format, (0..36).collect());
    let refused = GreyLines::<_, 11>::new(source()).expect_err("a raw line has 12 bytes");
    assert_eq!(refused, CameraError::BufferTooShort { needed: 12 });
    let mut lines =
        GreyLines::<_, 12>::new(Camera { fault: Some(1), ..source() }).expect("12 bytes are enough");
    assert_eq!(lines.next_line(&mut [0; 4]), Err(CameraError::NoLineLeft));
    lines.start_frame().expect("the camera works");
    assert_eq!(lines.next_line(&mut [0; 3]), Err(CameraError::BufferTooShort { needed: 4 }));
    assert!(lines.next_line(&mut [0; 4]).is_ok(), "the line that did not fit was not taken");
    assert_eq!(lines.next_line(&mut [0; 4]), Err(CameraError::Hardware(LineFault(1))));
    assert_eq!(lines.release().starts, 1);
}

#[test]
fn colour_cameras_see_what_grey_cameras_see() {
    let (left, right) = Pattern::Shifted { most: 10, noise_grey: 2.0 }.pair(64, 20, 1);
    let colour = |image: &image::GrayImage| {
        let format = LineFormat { width: 64, height: 20, pixel: PixelFormat::Rgb8 };
        let source = camera(format, image.as_raw().iter().flat_map(|&v| [v; 3]).collect());
        GreyLines::<_, 192>::new(source).expect("192 bytes are enough")
    };
    let mut in_colour = CameraPair::new(colour(&left), colour(&right), 0).expect("the formats are equal");
    let mut in_grey = SceneCamera::new(left.clone(), right.clone());
    let (a, b) = (disparities(&mut in_colour), disparities(&mut in_grey));
    assert_eq!(a, b);
    assert!(a.iter().any(|d| d.is_some()));
}

fn disparities(source: &mut impl StereoSource) -> Vec<Disparity> {
    let mut pipeline = Box::new(Pipeline::<Block, 64, 16>::new());
    pipeline.start(&Config::for_method::<Block>(64, 20, 16)).expect("the configuration fits");
    pipeline.begin_frame(source).unwrap_or_else(|_| panic!("the camera works"));
    let mut all = Vec::new();
    while let Some(row) = pipeline.next_row(source).unwrap_or_else(|_| panic!("the camera works")) {
        all.extend_from_slice(row.disparities());
    }
    all
}
