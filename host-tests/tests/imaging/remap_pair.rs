//! Two cameras' raw lines, rectified in step and matched in the same loop.

use super::remap::{QVGA, SLOTS, Table, camera, noise, rectified};
use image::GrayImage;
use stereopsis::camera::{
    CameraError, CameraPair, ErrorType, FrameStart, LineFormat, LineSource, LineStart, StereoSource,
};
use stereopsis::geometry::{camera::ImageSize, rectify::Crop};
use stereopsis::imaging::{
    RectifiedPair, RectifiedPairError, Remap, RemapError, RemapPair, RemapPairError, RemapTable,
};
use stereopsis::matching::Config;
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::mock::MockCamera;
use stereopsis_host::rectify::{RemapCapacity, rectify, with_rectified};
use stereopsis_host::run::{MemoryPair, MethodName, RunOptions, run};
use stereopsis_host::twin::remap as twin;

/// A pair of cameras on noise, rectified line by line, as the matcher would take it.
#[test]
fn a_pair_is_taken_in_step() {
    let left = camera(QVGA, 300.0, [-0.1, 0.02, 0.0, 0.0, 0.0]);
    let right = camera(QVGA, 310.0, [-0.12, 0.02, 0.0, 0.0, 0.0]);
    let both = rectified(QVGA, [left, right], [0.02, 0.01, 0.02], Crop::Alpha(1.0));
    let raw = [noise(QVGA, 8), noise(QVGA, 9)];
    let tables = both.warps().map(|warp| Table::new(&warp).expect("a table"));
    let source = || {
        let [left, right] = raw.clone().map(|raw| MockCamera::from_image(raw.into()).expect("an image"));
        CameraPair::new(left, right, 7).expect("of one size")
    };
    let remaps = || tables.clone().map(|table| Remap::<320, 40, SLOTS>::new(table).expect("enough rows"));
    // Set where they stand, they are what they are when they are made.
    let mut set = Box::new(RemapPair::<320, 40, SLOTS>::empty());
    set.set(&both).expect("enough rows");
    let [left, right] = remaps();
    let mut made = Box::new(RemapPair::new(left, right));
    assert_eq!(format!("{set:?}"), format!("{made:?}"));
    let mut pair = RectifiedPair::new(source(), &mut set).expect("enough rows for both");
    assert_eq!((pair.max_row_skew_us(), pair.format()), (7, source().format()), "as the cameras say");
    let expected = [twin::remap(&tables[0], &raw[0]), twin::remap(&tables[1], &raw[1])];
    for frame in 0..2 {
        assert_eq!(pair.start_frame().expect("a frame").sequence, frame);
        for row in 0..QVGA.height {
            let mut lines = [[0; 320]; 2];
            let [left, right] = &mut lines;
            assert_eq!(pair.next_lines(left, right).expect("a row").row, row);
            let here = usize::from(row) * 320..usize::from(row + 1) * 320;
            for camera in 0..2 {
                assert_eq!(lines[camera][..], expected[camera].0.as_raw()[here.clone()], "row {row}");
                assert_eq!(pair.valid()[camera], &expected[camera].1[here.clone()], "row {row}");
                let mut mask = [9; 320];
                tables[camera].mask(row, &mut mask);
                assert_eq!(mask[..], expected[camera].1[here.clone()]);
            }
            let mut masks = [[9; 320]; 2];
            assert!(pair.mask(row, masks.each_mut().map(|mask| &mut mask[..])));
            for (mask, (_, valid)) in masks.iter().zip(&expected) {
                assert_eq!(mask[..], valid[here.clone()]);
            }
        }
    }
    // What it says that it takes is enough, and one line fewer is refused.
    let (lines, taken) = (set.lines_needed(), RemapCapacity::of(&both).expect("remaps"));
    let slots = tables.iter().map(Table::slots_taken).max().expect("two");
    assert_eq!(taken, RemapCapacity { width: 320, lines, slots });
    assert_eq!(taken.to_string(), "RemapPair<320, 19, 263>");
    let exact = Box::new(RemapPair::<320, 19, 263>::empty());
    assert!(size_of_val(&*exact) <= taken.bytes() + 256);
    let takes = |mut pair: Box<RemapPair<320, 19, 263>>| {
        pair.set(&both).map_err(|e| e.to_string())?;
        RectifiedPair::new(source(), &mut pair).map(|_| ()).map_err(|e| e.to_string())
    };
    assert_eq!(takes(exact), Ok(()));
    let mut short = Box::new(RemapPair::<320, 18, 263>::empty());
    let refused = match short.set(&both) {
        Err(refused) => Err(RectifiedPairError::Remap(refused)),
        Ok(()) => RectifiedPair::new(source(), &mut short).map(|_| ()),
    };
    assert_eq!(refused, Err(RectifiedPairError::Remap(RemapError::Lines { needed: lines })));
    assert!(RemapPair::<320, 19, 262>::empty().set(&both).is_err());
    assert!(slots <= RemapTable::<0>::most_slots(QVGA));
    // Each alone needs fewer rows than both in step.
    let most = tables.iter().map(Table::rows).max().expect("two");
    assert!(usize::from(most) < 39);
    let small =
        MockCamera::from_image(noise(ImageSize { width: 64, height: 240 }, 1).into()).expect("an image");
    let format = small.format();
    let small = CameraPair::new(small.clone(), small, 0).expect("of one size");
    let refused = RectifiedPair::new(small, &mut made).map(|_| ());
    let refused = refused.expect_err("of another size");
    assert_eq!(refused, RectifiedPairError::Raw(format));
    assert!(refused.to_string().starts_with("raw frames of 64x240 px are not those of the remap"));
    let of_remap = RectifiedPairError::<std::fmt::Error>::Remap(RemapError::Lines { needed: 9 });
    assert_eq!(of_remap.to_string(), RemapError::Lines { needed: 9 }.to_string());
    assert_eq!(RemapPairError::Lines { needed: 9 }.to_string(), of_remap.to_string());
    let of_source = RectifiedPairError::Source(std::fmt::Error);
    assert_eq!(of_source.to_string(), std::fmt::Error.to_string());
    assert!(RemapPairError::Sizes.to_string().contains("different sizes"));
}

/// Raw lines through remap, census and matching in one loop: what rectified pictures give, without the
/// answers that have not been seen by both cameras.
#[test]
fn nothing_that_was_not_seen_becomes_an_answer() {
    let size = ImageSize { width: 160, height: 64 };
    let lens = |k1: f64| camera(size, 150.0, [k1, 0.02, 0.0, 0.0, 0.0]);
    let both = rectified(size, [lens(-0.2), lens(-0.15)], [0.02, -0.01, 0.03], Crop::Alpha(1.0));
    // The right camera sees all six px farther left.
    let left = noise(size, 11);
    let right = GrayImage::from_fn(160, 64, |x, y| *left.get_pixel((x + 6).min(159), y));
    let raw = || MemoryPair::new(160, left.to_vec(), right.to_vec()).expect("a pair");
    let whole = rectify(&both, raw()).expect("rectified");
    let [valid_left, valid_right] = whole.valid.each_ref().map(|mask| mask.as_raw());
    let outside = valid_left.iter().filter(|&&seen| seen == 0).count();
    assert!(outside > 500, "{outside}");
    for (method, threads) in [
        (MethodName::Fast, 1),
        (MethodName::Fast, 3),
        (MethodName::Block, 1),
        (MethodName::Sgm, 1),
        (MethodName::SgmLean, 2),
        (MethodName::SgmEdge, 1),
    ] {
        let config = method.config(160, 64, 32);
        let config = Config { confidence: true, ..config };
        let options = RunOptions { threads, ..method.into() };
        let found =
            with_rectified(&both, raw(), |source| run(options, &config, source, |_| ()).expect("a map").map);
        let found = found.expect("remaps");
        assert!(found.answers() > 300, "{method}: {}", found.answers());
        let pictures = whole.pictures.each_ref().map(|picture| picture.to_vec());
        let [left, right] = pictures;
        let mut pair = MemoryPair::new(160, left, right).expect("a pair");
        let plain = run(options, &config, &mut pair, |_| ()).expect("a map").map;
        let mut lost = 0;
        for (i, (&d, &flags)) in plain.disparity.iter().zip(&plain.flags).enumerate() {
            let (x, row) = (i % 160, i / 160 * 160);
            let partner = d.to_f32().map(|d| x as i32 - (d + 0.5).floor() as i32);
            let is_seen = |column: i32| column >= 0 && valid_right[row + column as usize] != 0;
            let is_lost = valid_left[i] == 0 || partner.is_some_and(|column| !is_seen(column));
            lost += usize::from(is_lost && d.is_some());
            if is_lost {
                let (none, outside) = (Disparity::NONE, PixelFlags::OUTSIDE);
                assert!(
                    (found.flags[i].contains(outside) && found.disparity[i] == none) || valid_left[i] != 0
                );
            }
            // Along paths an answer that is gone draws none of those below it.
            if matches!(method, MethodName::Fast | MethodName::Block) {
                let expected = if is_lost { (Disparity::NONE, PixelFlags::OUTSIDE) } else { (d, flags) };
                assert_eq!((found.disparity[i], found.flags[i]), expected, "{method}, {x}, {}", row / 160);
            }
            let d = found.disparity[i];
            let partner = d.to_f32().map(|d| x as i32 - (d + 0.5).floor() as i32);
            assert!(partner.is_none_or(|column| valid_left[i] != 0 && is_seen(column)), "{method}");
            assert_eq!(found.confidence[i] == 0, d.is_none(), "{method}");
        }
        assert!(lost > 20, "{method}: {lost}");
    }
}

/// A source that has nothing yet before every frame and line.
struct Pausing<S>(S, bool);

impl<S: StereoSource> Pausing<S> {
    fn pause(&mut self) -> Result<(), CameraError<S::Error>> {
        self.1 = !self.1;
        if self.1 { Err(CameraError::WouldBlock) } else { Ok(()) }
    }
}

impl<S: ErrorType> ErrorType for Pausing<S> {
    type Error = S::Error;
}

impl<S: StereoSource> StereoSource for Pausing<S> {
    fn format(&self) -> LineFormat {
        self.0.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        self.0.max_row_skew_us()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<S::Error>> {
        self.pause()?;
        self.0.start_frame()
    }

    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Result<LineStart, CameraError<S::Error>> {
        self.pause()?;
        self.0.next_lines(left, right)
    }
}

/// A source that does not block may stand below: a call is repeated, and goes on where it was.
#[test]
fn a_pair_goes_on_where_its_source_had_nothing_yet() {
    let lens = camera(QVGA, 300.0, [-0.1, 0.02, 0.0, 0.0, 0.0]);
    let both = rectified(QVGA, [lens, lens], [0.02, 0.01, 0.02], Crop::Alpha(1.0));
    let raw = [noise(QVGA, 8), noise(QVGA, 9)];
    let expected = both.warps().map(|warp| Table::new(&warp).expect("a table"));
    let expected = [0, 1].map(|camera| twin::remap(&expected[camera], &raw[camera]).0);
    let [left, right] = raw.map(GrayImage::into_raw);
    let source = Pausing(MemoryPair::new(320, left, right).expect("of one size"), false);
    let mut remaps = Box::new(RemapPair::<320, 40, SLOTS>::empty());
    remaps.set(&both).expect("enough rows");
    let mut pair = RectifiedPair::new(source, &mut remaps).expect("enough rows for both");
    let mut pauses = 0;
    while pair.start_frame() == Err(CameraError::WouldBlock) {
        pauses += 1;
    }
    for row in 0..QVGA.height {
        let [mut left, mut right] = [[0; 320]; 2];
        let start = loop {
            match pair.next_lines(&mut left, &mut right) {
                Err(CameraError::WouldBlock) => pauses += 1,
                start => break start.expect("a row"),
            }
        };
        assert_eq!(start.row, row);
        let here = usize::from(row) * 320..usize::from(row + 1) * 320;
        assert_eq!(
            [&left[..], &right[..]],
            expected.each_ref().map(|e| &e.as_raw()[here.clone()]),
            "row {row}"
        );
    }
    assert!(pauses > 200, "{pauses}");
}
