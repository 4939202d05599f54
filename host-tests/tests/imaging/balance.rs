//! Pairs whose cameras are exposed otherwise.

use image::{GrayImage, Luma};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineStart, PixelFormat, StereoSource,
};
use stereopsis::imaging::{Balance, BalancedPair, Histogram};
use stereopsis_host::run::MemoryPair;
use stereopsis_host::scene::Scene;
use stereopsis_host::twin::balance::balance;

fn histogram(picture: &GrayImage) -> Histogram {
    let mut histogram = Histogram::new();
    let width = picture.width().max(1) as usize;
    picture.as_raw().chunks(width).enumerate().for_each(|(row, line)| histogram.line(row, line));
    histogram
}

fn exposed(picture: &GrayImage, gain: f64, offset: f64) -> GrayImage {
    let mut picture = picture.clone();
    for Luma([grey]) in picture.pixels_mut() {
        *grey = (gain * f64::from(*grey) + offset).round().clamp(0.0, 255.0) as u8;
    }
    picture
}

fn frame(source: &mut impl StereoSource) -> [GrayImage; 2] {
    let format = source.format();
    let size = (u32::from(format.width), u32::from(format.height));
    let [mut left, mut right] = [(); 2].map(|()| GrayImage::new(size.0, size.1));
    assert!(source.start_frame().is_ok());
    let width = size.0 as usize;
    for (left, right) in left.chunks_exact_mut(width).zip(right.chunks_exact_mut(width)) {
        assert!(source.next_lines(left, right).is_ok());
    }
    [left, right]
}

fn any_picture() -> impl Strategy<Value = GrayImage> {
    // Uniform grey levels of any range, an empty one too.
    (1_u32..40, 1_u32..40, any::<u8>(), any::<u8>(), any::<u64>()).prop_map(|(width, height, a, b, seed)| {
        let mut random = stereopsis_host::scene::Random::new(seed);
        let (least, most) = (u32::from(a.min(b)), u32::from(a.max(b)));
        GrayImage::from_fn(width, height, |_, _| {
            Luma([(least + u32::from(random.byte()) * (most - least) / 255) as u8])
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 200,
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn the_twin_says_the_same(left in any_picture(), right in any_picture()) {
        let of_core = Balance::between(&histogram(&left), &histogram(&right));
        let of_twin = balance([&left, &right]);
        // Where the twin's floats stand on a half or on a whole number, they may round to the other side.
        prop_assert!(of_core.gain_256ths.abs_diff(of_twin.gain_256ths) <= 1, "{of_core:?}, twin {of_twin:?}");
        let most = 256 * u32::from(of_core.gain_256ths.abs_diff(of_twin.gain_256ths)) + 1;
        prop_assert!(of_core.offset_256ths.abs_diff(of_twin.offset_256ths) <= most,
            "{of_core:?}, twin {of_twin:?}");
    }

    #[test]
    fn lines_are_what_the_equation_says(gain in 128_u16..=512, offset in -200_000_i32..200_000) {
        let mut line: Vec<u8> = (0..=255).collect();
        Balance { gain_256ths: gain, offset_256ths: offset }.line(&mut line);
        for (grey, balanced) in (0..=255).map(f64::from).zip(line) {
            let exact = (f64::from(gain) * grey + f64::from(offset)) / 256.0;
            prop_assert_eq!(f64::from(balanced), (exact + 0.5).floor().clamp(0.0, 255.0));
        }
    }
}

#[test]
fn any_balance_can_be_applied() {
    for (gain_256ths, offset_256ths) in
        [(0, i32::MIN), (u16::MAX, i32::MAX), (u16::MAX, i32::MIN), (0, i32::MAX)]
    {
        let mut line = [0, 1, 128, 255];
        Balance { gain_256ths, offset_256ths }.line(&mut line);
        assert!([[0; 4], [255; 4]].contains(&line), "{line:?}");
    }
}

#[test]
fn the_second_frame_is_balanced_and_cameras_alike_are_left() {
    let (left, right) = Scene::small(320, 240).render();
    let source =
        |right: &GrayImage| MemoryPair::new(320, left.to_vec(), right.to_vec()).expect("two pictures");
    let mut alike = BalancedPair::new(source(&right));
    for _ in 0..3 {
        assert_eq!(frame(&mut alike), [left.clone(), right.clone()]);
    }
    for (gain, offset) in [(1.2, 15.0), (0.7, 0.0), (1.0, 30.0)] {
        let other = exposed(&right, gain, offset);
        let mut pair = BalancedPair::new(source(&other));
        assert_eq!(frame(&mut pair), [left.clone(), other.clone()], "the first frame is as it came");
        let second = frame(&mut pair);
        assert_eq!(second[0], left);
        let apart =
            |a: &GrayImage| a.iter().zip(right.iter()).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>();
        assert!(apart(&second[1]) < 0.25 * apart(&other), "x {gain} + {offset}: {:?}", pair.balance());
        assert_eq!(frame(&mut pair), second, "it is the lines as they came that count");
    }
}

/// A pair of pictures as another source would give it: of some other format, with masks.
struct Other {
    pair: MemoryPair,
    pixel: PixelFormat,
}

impl ErrorType for Other {
    type Error = <MemoryPair as ErrorType>::Error;
}

impl StereoSource for Other {
    fn format(&self) -> LineFormat {
        LineFormat { pixel: self.pixel, ..self.pair.format() }
    }

    fn max_row_skew_us(&self) -> u32 {
        9
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        self.pair.start_frame()
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>> {
        self.pair.next_lines(left, right)
    }

    fn mask(&self, row: u16, masks: [&mut [u8]; 2]) -> bool {
        masks.into_iter().for_each(|mask| mask.fill(row as u8));
        true
    }
}

#[test]
fn a_balanced_pair_says_what_its_source_says() {
    let (left, right) = Scene::small(320, 240).render();
    let darker = exposed(&right, 0.6, 0.0);
    for (pixel, is_balanced) in [(PixelFormat::Grey8, true), (PixelFormat::Bayer8, false)] {
        let pair = MemoryPair::new(320, left.to_vec(), darker.to_vec()).expect("two pictures");
        let mut balanced = BalancedPair::new(Other { pair, pixel });
        assert_eq!((balanced.format().pixel, balanced.max_row_skew_us()), (pixel, 9));
        let mut masks = [[0; 4]; 2];
        assert!(balanced.mask(7, masks.each_mut().map(|mask| &mut mask[..])));
        assert_eq!(masks, [[7; 4]; 2]);
        // Grey lines alone are balanced.
        frame(&mut balanced);
        assert_eq!(frame(&mut balanced)[1] != darker, is_balanced);
        assert_eq!(balanced.balance() != Balance::NONE, is_balanced);
        assert_eq!(balanced.release().pixel, pixel);
    }
}
