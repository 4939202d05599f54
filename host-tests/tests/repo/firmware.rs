//! The parts of the firmware example that know no hardware, compiled for the host.
//!
//! `cargo xtask firmware` runs the whole of it in QEMU and compares every bit with the host.

use firmware_scenes::pgm::{self, HeaderError, LONGEST};
use firmware_scenes::scene::{Scene, SceneCamera};
use stereopsis::camera::StereoSource;
use stereopsis::matching::{Block, Config};
use stereopsis::pipeline::Pipeline;
use stereopsis::units::Disparity;
use stereopsis_host::map::DisparityMap;
use stereopsis_host::run::{MethodName, run};

/// The sizes that the firmware is measured at, with their disparities.
const SIZES: [(u16, u16, u16); 3] = [(96, 64, 16), (160, 120, 32), (320, 240, 64)];

fn disparities_of(scene: Scene, disparities: u16) -> DisparityMap {
    let config = Config::for_method::<Block>(scene.width, scene.height, disparities);
    run(MethodName::Block, &config, &mut SceneCamera::new(scene), |_| ()).expect("a frame").map
}

#[test]
fn the_scene_is_matched_at_every_size() {
    for (width, height, disparities) in SIZES {
        let scene = Scene { width, height };
        let map = disparities_of(scene, disparities);
        let truth = |u: i32, v: i32| {
            if scene.on_board(u, v) {
                Disparity::from_pixels(scene.board_disparity())
            } else {
                // 1/16 px to the type's steps.
                Disparity::from_raw(scene.floor_disparity(v) as u16 * (Disparity::ONE / 16))
            }
        };
        let at = |i: usize| ((i % map.width) as i32, (i / map.width) as i32);
        let errors =
            map.disparity.iter().enumerate().filter_map(|(i, d)| d.distance(truth(at(i).0, at(i).1)));
        let (answers, right) = (map.answers(), errors.filter(|&error| error <= Disparity::ONE).count());
        let pixels = map.width * map.height;
        assert!(answers * 10 >= pixels * 8, "{width}x{height}: {answers} answers for {pixels} pixels");
        assert!(right * 100 >= answers * 95, "{width}x{height}: {right} of {answers} answers are right");
    }
}

#[test]
fn every_frame_of_the_scene_is_the_same() {
    let mut camera = SceneCamera::new(Scene { width: 160, height: 120 });
    let config = Config::for_method::<Block>(160, 120, 32);
    let first = run(MethodName::Fast, &config, &mut camera, |_| ()).expect("a frame").map;
    let second = run(MethodName::Fast, &config, &mut camera, |_| ()).expect("another").map;
    assert_eq!(first.disparity, second.disparity);
    assert_eq!(camera.start_frame().expect("a third").sequence, 3);
}

/// The number of memory.x that stands before what it is for.
fn budget(what: &str) -> usize {
    let lines = include_str!("../../../memory.x").lines().filter(|line| line.contains(what));
    let mut numbers = lines.filter_map(|line| line.split_whitespace().find_map(|word| word.parse().ok()));
    numbers.next().unwrap_or_else(|| panic!("memory.x has no number for {what}"))
}

#[test]
fn the_budget_in_memory_x_adds_up() {
    let pipeline = size_of::<Pipeline<stereopsis::matching::Block, 320, 64>>();
    let [pipeline_budget, camera, stack, application] =
        ["the pipeline", "the camera", "the stack", "the application"].map(budget);
    // Whole kilobytes, so that a small change of the matcher is none of the budget.
    let expected = pipeline.next_multiple_of(1024);
    let left = budget("in all").saturating_sub(expected + camera + stack);
    assert!(
        (pipeline_budget, application) == (expected, left),
        "the pipeline takes {pipeline} bytes: write {expected} for it in memory.x, and {left} for the \
         application"
    );
    assert_eq!(budget("in all"), 64 * 1024);
    assert_eq!(budget("the program"), 64 * 1024);
    assert_eq!(include_str!("../../../memory.x").matches("_length : 64K").count(), 2);
}

/// Header or error of a file with these bytes.
fn header(bytes: &[u8]) -> Result<(u16, u16), HeaderError> {
    let mut bytes = bytes.iter().copied();
    pgm::header(|| Ok(bytes.next()))
}

#[test]
fn headers_are_read() {
    assert_eq!(header(b"P5\n3 2\n255\nabcdef"), Ok((3, 2)));
    assert_eq!(header(b"P5 # a comment\n#another\n 4096\t1 # one more\n255 "), Ok((4096, 1)));
    let mut bytes = b"P5 7 8 255\nxy".iter().copied();
    assert_eq!(pgm::header::<HeaderError>(|| Ok(bytes.next())), Ok((7, 8)));
    assert_eq!(bytes.next(), Some(b'x'), "the pixels begin with the byte after the header");
}

#[test]
fn malformed_headers_are_named() {
    use HeaderError::{Depth, Ends, Height, Largest, NotPgm, Size, TooLong, Width};
    assert_eq!(header(b"P2\n3 2\n255\n"), Err(NotPgm));
    assert_eq!(header(b"\x89PNG"), Err(NotPgm));
    assert_eq!(header(b"P53 2 255\n"), Err(NotPgm));
    assert_eq!(header(b"P5 x 2 255\n"), Err(Width));
    assert_eq!(header(b"P5 -3 2 255\n"), Err(Width));
    assert_eq!(header(b"P5 3 2x 255\n"), Err(Height));
    assert_eq!(header(b"P5 3 2 max\n"), Err(Largest));
    assert_eq!(header(b"P5 0 2 255\n"), Err(Size { width: 0, height: 2 }));
    assert_eq!(header(b"P5 3 4097 255\n"), Err(Size { width: 3, height: 4097 }));
    assert_eq!(header(b"P5 99999999999999999999 2 255\n"), Err(Size { width: 1_000_000, height: 2 }));
    assert_eq!(header(b"P5 3 2 65535\n"), Err(Depth { largest: 65535 }));
    assert_eq!(header(b"P5 3 2 127\n"), Err(Depth { largest: 127 }));
    assert_eq!(header(b"P5 3 2 255"), Err(Ends));
    assert_eq!(header(b""), Err(Ends));
    let comment = [b"P5 #".as_slice(), &vec![b'-'; usize::from(LONGEST)]].concat();
    assert_eq!(header(&comment), Err(TooLong));
}
