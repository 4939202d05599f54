//! Boards in pictures.

use super::{CLOSE_STANDS, SIZE, STANDS, markers, pattern, rig, stand};
use image::{GrayImage, Luma, imageops};
use nalgebra::{Point2, Point3};
use stereopsis::geometry::camera::Camera;
use stereopsis_host::calibrate::board::{Board, BoardError, Pattern, find, find_marked};
use stereopsis_host::calibrate::scene::BoardCamera;
use stereopsis_host::scene::Random;

/// The root mean square and the largest of the distances between corners.
fn apart(found: &[Point2<f64>], truth: &[Point2<f64>]) -> (f64, f64) {
    let all: Vec<f64> = found.iter().zip(truth).map(|(a, b)| (a - b).norm()).collect();
    let mean = all.iter().map(|d| d * d).sum::<f64>() / all.len() as f64;
    (mean.sqrt(), all.into_iter().fold(0.0, f64::max))
}

/// The corners in the order that the board is found in: of the two ways round, by its colours.
fn as_found(pattern: Pattern, mut truth: Vec<Point2<f64>>, board: &Board) -> Vec<Point2<f64>> {
    if (truth[0] - board.corners[0]).norm() > (truth[pattern.corners() - 1] - board.corners[0]).norm() {
        truth.reverse();
    }
    truth
}

#[test]
fn boards_are_found_through_a_strong_lens() {
    let pattern = pattern(9, 6);
    let cameras = BoardCamera::pair(&rig());
    let mut random = Random::new(3);
    let mut ways_round = Vec::new();
    for (axis, place) in STANDS {
        let stands = stand(pattern, axis, place, 0.03);
        for (camera, board) in cameras.iter().zip(&stands) {
            let truth = camera.corners(pattern, board).expect("all in the image");
            let picture = camera.picture(pattern, board, 2.0, &mut random);
            let found = find(&picture, pattern, None).unwrap_or_else(|e| panic!("{axis:?} {place:?}: {e}"));
            let way = truth[0] == as_found(pattern, truth.clone(), &found)[0];
            ways_round.push(way);
            let (mean, most) = apart(&found.corners, &as_found(pattern, truth, &found));
            assert!(mean < 0.18 && most < 0.45, "{axis:?} {place:?}: {mean} {most}");
        }
    }
    // Black and white say which corner is the first, however the board is turned.
    assert!(ways_round.iter().all(|way| *way == ways_round[0]), "{ways_round:?}");
}

#[test]
fn boards_are_found_when_blurred_small_large_or_cut() {
    let pattern = pattern(7, 5);
    let camera = BoardCamera::new(rig().cameras()[0], SIZE);
    let mut random = Random::new(4);
    for (axis, place, blur, scale) in [
        ([0.2, 0.3, 0.1], [0.0, 0.0, 8.0], 2.0, 1),
        ([0.2, -0.3, 0.1], [0.1, 0.1, 7.0], 3.0, 1),
        ([0.1, 0.2, -0.5], [0.0, 0.1, 20.0], 0.5, 1),
        ([0.3, 0.1, 0.3], [-0.05, 0.0, 6.5], 0.5, 4),
        // The board's white margin is cut off by the image's border.
        ([0.0, 0.0, 0.0], [-0.42, -0.25, 6.5], 0.5, 1),
    ] {
        let [board, _] = stand(pattern, axis, place, 0.03);
        let truth = camera.corners(pattern, &board).expect("all in the image");
        let picture = camera.picture(pattern, &board, 1.0, &mut random);
        let picture = imageops::blur(&picture, blur);
        let (w, h) = (u32::from(SIZE.width) * scale, u32::from(SIZE.height) * scale);
        let picture = imageops::resize(&picture, w, h, imageops::FilterType::Triangle);
        let found =
            find(&picture, pattern, None).unwrap_or_else(|e| panic!("{axis:?} {place:?} {blur}: {e}"));
        let scale = f64::from(scale);
        let truth =
            truth.iter().map(|p| Point2::from(p.coords.add_scalar(0.5) * scale).map(|x| x - 0.5)).collect();
        let (mean, most) = apart(&found.corners, &as_found(pattern, truth, &found));
        assert!(mean < 0.22 * scale && most < 0.6 * scale, "{axis:?} {place:?} {blur}: {mean} {most}");
    }
}

/// Noise makes edges that lead to no corner of the board: none of these stays in its grid.
#[test]
fn boards_are_found_blurred_in_noise() {
    let pattern = pattern(9, 6);
    let camera = BoardCamera::new(Camera::new(165.0, 166.0, 158.0, 121.0).expect("a camera"), SIZE);
    for seed in 1..4 {
        let mut random = Random::new(seed);
        for (axis, [x, y, z]) in STANDS {
            let [board, _] = stand(pattern, axis, [x, y, 0.9 * z], 0.03);
            // Some reach over the border.
            let Some(truth) = camera.corners(pattern, &board) else { continue };
            let mut picture = imageops::blur(&camera.picture(pattern, &board, 0.0, &mut random), 2.0);
            for Luma([grey]) in picture.pixels_mut() {
                *grey = (f64::from(*grey) + 12.0 * random.gauss()).round().clamp(0.0, 255.0) as u8;
            }
            let found = find(&picture, pattern, None).unwrap_or_else(|e| panic!("{seed} {axis:?}: {e}"));
            let (mean, most) = apart(&found.corners, &as_found(pattern, truth, &found));
            assert!(mean < 0.8 && most < 1.8, "{seed} {axis:?}: {mean} {most}");
        }
    }
}

#[test]
fn what_is_not_there_is_not_found() {
    let camera = BoardCamera::new(rig().cameras()[0], SIZE);
    let mut random = Random::new(5);
    let [board, _] = stand(pattern(9, 6), [0.2, 0.3, 0.1], [0.0, 0.0, 9.0], 0.03);
    let picture = camera.picture(pattern(9, 6), &board, 1.0, &mut random);
    assert!(find(&picture, pattern(9, 6), None).is_ok());
    assert!(find(&picture, pattern(6, 9), None).is_ok(), "the other way round");
    let larger = find(&picture, pattern(8, 5), None);
    assert!(matches!(larger, Err(BoardError::Larger { columns: 6.., rows: 6.. })), "{larger:?}");
    let smaller = find(&picture, pattern(10, 7), None);
    assert!(matches!(smaller, Err(BoardError::NotFound { most: 54.., .. })), "{smaller:?}");
    // A corner that is covered.
    let mut covered = picture.clone();
    let [x, y] = camera.corners(pattern(9, 6), &board).expect("corners")[0].into();
    let near = |px: u32, py: u32| (f64::from(px) - x).hypot(f64::from(py) - y) < 9.0;
    covered.enumerate_pixels_mut().filter(|(x, y, _)| near(*x, *y)).for_each(|(_, _, p)| *p = Luma([110]));
    assert!(matches!(find(&covered, pattern(9, 6), None), Err(BoardError::NotFound { .. })));
    let noise = GrayImage::from_fn(320, 240, |_, _| Luma([random.below(256) as u8]));
    let plain = GrayImage::new(320, 240);
    for picture in [noise, plain, GrayImage::new(1, 1), GrayImage::new(700, 2)] {
        assert!(matches!(find(&picture, pattern(9, 6), None), Err(BoardError::NotFound { .. })));
    }
}

/// Of a board that looks the same both ways round, the right picture's order is the left one's.
#[test]
fn an_ambiguous_board_is_reported_alike_in_both_pictures() {
    let pattern = pattern(6, 6);
    assert!(pattern.is_ambiguous());
    let cameras = BoardCamera::pair(&rig());
    let mut random = Random::new(6);
    for roll in [0.0, 0.78, 0.8, 1.56, 1.58, 2.4, 3.1, -2.0, -0.79] {
        let stands = stand(pattern, [0.1, 0.2, roll], [0.0, 0.0, 9.0], 0.03);
        let pictures = [0, 1].map(|i| cameras[i].picture(pattern, &stands[i], 1.0, &mut random));
        let left = find(&pictures[0], pattern, None).expect("a board");
        let right = find(&pictures[1], pattern, Some(&left)).expect("a board");
        let truth = [0, 1].map(|i| cameras[i].corners(pattern, &stands[i]).expect("corners"));
        let which = |board: &Board, truth: &[Point2<f64>]| {
            truth.iter().position(|p| (p - board.corners[0]).norm() < 1.0)
        };
        let first = which(&left, &truth[0]);
        assert!(first.is_some() && first == which(&right, &truth[1]), "{roll}: {first:?}");
    }
}

/// Boards that reach over the border, in all turns, with markers of all sizes of bits.
#[test]
fn parts_of_boards_with_markers_are_found() {
    let cameras = BoardCamera::pair(&rig());
    let mut random = Random::new(8);
    let (mut parts, mut corners, mut visible) = (0, 0, 0);
    for (name, share) in [("4x4_50", 0.75), ("5x5_100", 0.8), ("dict_6x6_250", 0.8)] {
        let (pattern, markers) = (pattern(7, 5), markers(name, share));
        for (axis, place) in CLOSE_STANDS {
            let stands = stand(pattern, axis, place, 0.03);
            for (i, (camera, board)) in cameras.iter().zip(&stands).enumerate() {
                let picture = camera.marked_picture(pattern, Some(&markers), board, 2.0, &mut random);
                let found = find_marked(&picture, pattern, &markers)
                    .unwrap_or_else(|e| panic!("{name} {axis:?} {place:?}: {e}"));
                let places: Vec<_> = pattern.places().collect();
                let truth = |p: &Point2<f64>| {
                    let seen = board.transform(&Point3::new(p.x, p.y, 0.0));
                    rig().cameras()[i].project(&seen).expect("in front")
                };
                for (corner, &number) in found.corners.iter().zip(&found.numbers) {
                    let off = (corner - truth(&places[number])).norm();
                    assert!(off < 0.5, "{name} {axis:?} {place:?}: {number} is {off} off");
                }
                assert!(found.numbers.is_sorted());
                let inside = |p: &Point2<f64>| (4.0..315.0).contains(&p.x) && (4.0..235.0).contains(&p.y);
                let seen = places.iter().filter(|p| inside(&truth(p))).count();
                (corners, visible) = (corners + found.numbers.len(), visible + seen);
                parts += usize::from(found.numbers.len() < pattern.corners());
            }
        }
    }
    assert!(parts >= 15 && 10 * corners >= 9 * visible, "{parts} parts, {corners} of {visible} corners");
}

#[test]
fn markers_that_do_not_agree_are_no_board() {
    let camera = BoardCamera::new(rig().cameras()[0], SIZE);
    let mut random = Random::new(9);
    let (pattern, own) = (pattern(7, 5), markers("4x4_50", 0.75));
    let [board, _] = stand(pattern, [0.2, 0.3, 0.1], [0.0, 0.0, 5.0], 0.03);
    let marked = camera.marked_picture(pattern, Some(&own), &board, 1.0, &mut random);
    let plain = camera.picture(pattern, &board, 1.0, &mut random);
    let none = GrayImage::new(320, 240);
    assert!(find_marked(&marked, pattern, &own).is_ok());
    for (picture, markers) in [
        (&marked, markers("5x5_100", 0.75)),
        (&plain, own.clone()),
        (&none, own.clone()),
        (&GrayImage::new(1, 1), own.clone()),
    ] {
        let found = find_marked(picture, pattern, &markers);
        assert!(matches!(found, Err(BoardError::NoMarkers { .. })), "{found:?}");
    }
    // The numbers of a board with other squares do not agree either.
    let other = find_marked(&marked, super::pattern(8, 5), &own);
    assert!(matches!(other, Err(BoardError::NoMarkers { most: 8.. })), "{other:?}");
}
