//! What is wrong with a pair is found, and nothing where nothing is.

use image::{GrayImage, imageops};
use stereopsis_host::pair::{PairCheck, PairFault, PairMatches, fault, search};
use stereopsis_host::run::MethodName;
use stereopsis_host::scene::{HardScene, Random, Scene};

/// What is found of two pictures and a search.
pub fn check(left: &GrayImage, right: &GrayImage, disparities: u16) -> PairCheck {
    let matches = PairMatches::find([left, right], None).expect("features");
    let config = MethodName::Block.config(left.width() as u16, left.height() as u16, disparities);
    PairCheck::new([left, right], None, &matches, fault([left, right], &matches), &config)
}

/// A square of a picture, which may be turned by 90 degrees and keep its size.
fn square(picture: &GrayImage) -> GrayImage {
    let side = picture.width().min(picture.height());
    imageops::crop_imm(picture, 0, 0, side, side).to_image()
}

#[test]
fn a_pair_without_faults_has_none() {
    let scene = Scene::demo();
    let (left, right) = scene.render();
    let found = check(&left, &right, scene.disparities());
    assert_eq!(found.fault, None, "{found:?}");
    assert!(found.beyond_search < 0.02, "{found:?}");
}

#[test]
fn each_fault_is_found() {
    let (left, right) = Scene::demo().render();
    let turned = [&left, &right].map(imageops::rotate90);
    // The left camera's picture again, a grey level off here and there.
    let noisy = GrayImage::from_fn(left.width(), left.height(), |x, y| {
        image::Luma([left.get_pixel(x, y).0[0].saturating_add(u8::from((7 * x + 3 * y) % 5 == 0))])
    });
    let lower =
        GrayImage::from_fn(right.width(), right.height(), |x, y| *right.get_pixel(x, y.saturating_sub(30)));
    let flat = GrayImage::from_pixel(left.width(), left.height(), image::Luma([99]));
    // Tiles of eight pixels in another order: the texture of the scene, and nothing of the scene.
    let (width, height) = right.dimensions();
    let other = GrayImage::from_fn(width, height, |x, y| {
        *right.get_pixel((x ^ 24).min(width - 1), (y ^ 24).min(height - 1))
    });
    for (first, second, fault) in [
        (&right, &left, Some(PairFault::Swapped)),
        (&left, &left, Some(PairFault::Same)),
        (&left, &noisy, Some(PairFault::Still)),
        (&turned[0], &turned[1], Some(PairFault::BothOnTheirSides)),
        (&left, &imageops::rotate180(&right), Some(PairFault::RightUpsideDown)),
        (&square(&left), &imageops::rotate90(&square(&right)), Some(PairFault::RightOnItsSide)),
        (&left, &imageops::flip_horizontal(&right), Some(PairFault::RightMirrored)),
        (&left, &imageops::flip_vertical(&right), Some(PairFault::RightMirrored)),
        (&left, &lower, Some(PairFault::RowsApart)),
        (&left, &other, Some(PairFault::TwoScenes)),
        // Where nothing is to be seen nothing is said.
        (&left, &flat, None),
    ] {
        let found = check(first, second, 64);
        assert_eq!(found.fault, fault, "{found:?}");
    }
}

#[test]
fn faults_are_found_where_all_is_far() {
    // Of a street most disparities are under the rows that partners may be apart.
    let (left, right) = HardScene::street(1.0, 3).scene.render();
    let turned = [&left, &right].map(imageops::rotate90);
    for (first, second, fault) in [
        (&left, &right, None),
        (&turned[0], &turned[1], Some(PairFault::BothOnTheirSides)),
        (&left, &imageops::flip_horizontal(&right), Some(PairFault::RightMirrored)),
        (&left, &imageops::rotate180(&right), Some(PairFault::RightUpsideDown)),
    ] {
        let found = check(first, second, 64);
        assert_eq!(found.fault, fault, "{found:?}");
    }
}

#[test]
fn a_search_that_is_too_short_has_a_cure() {
    let scene = Scene::demo();
    let (left, right) = scene.render();
    let short = check(&left, &right, 16);
    assert!(short.beyond_search > 0.2, "{short:?}");
    let [first, count] = short.search.expect("a search");
    let cure = format!("give --min-disparity {first} --disparities {count}");
    assert!(short.warnings.iter().any(|warning| warning.ends_with(&cure)), "{short:?}");
    let truth = scene.truth();
    let seen = truth.disparity.iter().zip(&truth.depth_m).filter(|(_, depth)| depth.is_finite());
    let inside = f32::from(first)..f32::from(first + count);
    let (held, all) =
        seen.fold((0, 0), |(held, all), (d, _)| (held + usize::from(inside.contains(d)), all + 1));
    assert!(held as f64 > 0.995 * all as f64, "{held} of {all} are within {first} + {count}");
    let matches = PairMatches::find([&left, &right], None).expect("features");
    assert_eq!(search([&left, &right], &matches), Some([first, count]));
}

#[test]
fn what_a_picture_lacks_is_measured() {
    let (left, right) = Scene::demo().render();
    let (width, height) = left.dimensions();
    let found = check(&left, &right, 64);
    assert!(found.untextured < 0.2 && found.over_exposed < 0.05 && found.under_exposed < 0.05, "{found:?}");
    let view = found.out_of_view.expect("features");
    assert!((0.01..0.2).contains(&view), "{found:?}");
    // Two fifths of it white, and a fifth black.
    let painted = |picture: &GrayImage| {
        GrayImage::from_fn(width, height, |x, y| match 5 * y / height {
            0 | 1 => image::Luma([255]),
            2 => image::Luma([0]),
            _ => *picture.get_pixel(x, y),
        })
    };
    let found = check(&painted(&left), &painted(&right), 64);
    assert!((found.over_exposed - 0.4).abs() < 0.05 && (found.under_exposed - 0.2).abs() < 0.05, "{found:?}");
    assert!((0.5..0.7).contains(&found.untextured), "{found:?}");
    assert!(found.warnings.iter().any(|warning| warning.ends_with("expose them shorter")), "{found:?}");
    // A mask takes what is white and black out of the account.
    let shown = GrayImage::from_fn(width, height, |_, y| image::Luma([255 * u8::from(5 * y / height > 2)]));
    let (left, right) = (painted(&left), painted(&right));
    let matches = PairMatches::find([&left, &right], Some([&shown; 2])).expect("features");
    let config = MethodName::Block.config(width as u16, height as u16, 64);
    let fault = fault([&left, &right], &matches);
    let found = PairCheck::new([&left, &right], Some([&shown; 2]), &matches, fault, &config);
    assert!(found.over_exposed < 0.05 && found.under_exposed < 0.05 && found.untextured < 0.2, "{found:?}");
}

#[test]
fn a_camera_that_sees_less_than_the_other_one_is_named() {
    let (left, right) = Scene::demo().render();
    let height = left.height();
    let warnings = |left: &GrayImage, right: &GrayImage| check(left, right, 64).warnings.join("; ");
    assert_eq!(warnings(&left, &right), "");
    // The lower half of one image hidden: behind something dark, and behind something that is not.
    let hidden = |picture: &GrayImage, by: u8| {
        GrayImage::from_fn(picture.width(), height, |x, y| {
            if 2 * y < height { *picture.get_pixel(x, y) } else { image::Luma([by + (x % 7 == y % 5) as u8]) }
        })
    };
    let dark = warnings(&left, &hidden(&right, 0));
    assert!(dark.starts_with("50 % of the right image is black, where nothing can be matched; "), "{dark}");
    let dark = warnings(&hidden(&left, 0), &right);
    assert!(dark.starts_with("50 % of the left image is black"), "{dark}");
    let both = warnings(&hidden(&left, 0), &hidden(&right, 0));
    assert!(both.starts_with("50 % of the images are black"), "{both}");
    for (left, right, side) in [(&left, &hidden(&right, 70), "right"), (&hidden(&left, 70), &right, "left")] {
        let found = check(left, right, 64);
        let lost = [found.lost_texture, found.lost_texture_right];
        assert!(
            found.warnings.join("").contains(&format!("see whether the {side} camera is covered")),
            "{found:?}"
        );
        let [seen, hidden] = if side == "right" { lost } else { [lost[1], lost[0]] };
        assert!(seen < 0.05 && (0.4..0.5).contains(&hidden), "{found:?}");
    }
}

/// A picture with noise of a deviation.
fn with_noise(picture: &GrayImage, sigma: f64, random: &mut Random) -> GrayImage {
    let mut noisy = picture.clone();
    for pixel in noisy.iter_mut() {
        *pixel = (f64::from(*pixel) + sigma * random.gauss()).round().clamp(0.0, 255.0) as u8;
    }
    noisy
}

#[test]
fn noise_is_no_texture() {
    let (left, right) = Scene::demo().render();
    let height = right.height();
    let grey = image::Luma([40]);
    let covered = GrayImage::from_pixel(right.width(), height, grey);
    let half =
        GrayImage::from_fn(
            right.width(),
            height,
            |x, y| {
                if 2 * y < height { *right.get_pixel(x, y) } else { grey }
            },
        );
    let mut random = Random::new(7);
    for sigma in [1.0, 2.0, 5.0] {
        let [left, right, covered, half] =
            [&left, &right, &covered, &half].map(|picture| with_noise(picture, sigma, &mut random));
        let found = check(&left, &right, 64);
        assert_eq!((found.warnings.len(), found.fault), (0, None), "{sigma}: {found:?}");
        for (picture, share) in [(&covered, 0.95..=1.0), (&half, 0.45..=0.75)] {
            let found = check(&left, picture, 64);
            assert!(share.contains(&found.untextured_right), "{sigma}: {found:?}");
            assert!(
                found.warnings.iter().any(|line| line.contains("see whether the right camera")),
                "{sigma}: {found:?}"
            );
        }
    }
}

#[test]
fn cameras_that_see_nothing_are_not_one_camera() {
    for grey in [0, 90, 255] {
        let blank = GrayImage::from_pixel(320, 240, image::Luma([grey]));
        assert_eq!(check(&blank, &blank.clone(), 64).fault, None);
    }
}

#[test]
fn something_near_before_what_is_far_is_a_pair() {
    // The left picture again, a thing 30 px to the left in it.
    let (far, _) = Scene::demo().render();
    let (thing, _) = HardScene::street(1.0, 3).scene.render();
    let thing = imageops::crop_imm(&thing, 60, 60, 200, 160).to_image();
    let with_thing = |x: i64| {
        let mut picture = far.clone();
        imageops::replace(&mut picture, &thing, x, 200);
        picture
    };
    let mut random = Random::new(3);
    let [left, right] = [230, 200].map(|x| with_noise(&with_thing(x), 1.0, &mut random));
    let matches = PairMatches::find([&left, &right], None).expect("features");
    assert_eq!(fault([&left, &right], &matches), None);
    assert_eq!(check(&right, &left, 64).fault, Some(PairFault::Swapped));
    let found = check(&left, &right, 16);
    assert!(found.warnings.iter().any(|line| line.contains("lie beyond disparities 0 to 15")), "{found:?}");
}

#[test]
fn a_left_image_that_is_turned_is_told() {
    let (left, right) = Scene::demo().render();
    for (left, right, fault) in [
        (&imageops::rotate180(&left), &right, PairFault::LeftUpsideDown),
        (&imageops::flip_horizontal(&left), &right, PairFault::LeftMirrored),
        (&imageops::rotate90(&square(&left)), &square(&right), PairFault::LeftOnItsSide),
    ] {
        let found = check(left, right, 64);
        assert_eq!(found.fault, Some(fault), "{found:?}");
    }
}

#[test]
fn a_pair_that_stands_a_little_too_low_is_not_turned() {
    for (left, right) in [Scene::demo().render(), HardScene::street(1.0, 3).scene.render()] {
        for rows in [14, 40] {
            let (width, height) = (left.width(), left.height() - rows);
            let part =
                |picture: &GrayImage, from| imageops::crop_imm(picture, 0, from, width, height).to_image();
            let found = check(&part(&left, rows), &part(&right, 0), 64);
            assert_eq!(found.fault, Some(PairFault::RowsApart), "{rows}: {found:?}");
        }
    }
}

#[test]
fn a_scene_with_less_texture_is_another_scene() {
    let (street, _) = HardScene::street(1.0, 3).scene.render();
    let (_, right) = HardScene::white_room(1.0, 4).scene.render();
    let room = imageops::resize(&right, street.width(), street.height(), imageops::Triangle);
    for (left, right) in [(&street, &room), (&room, &street)] {
        let found = check(left, right, 64);
        assert_eq!(found.fault, Some(PairFault::TwoScenes), "{found:?}");
    }
}

#[test]
fn dots_on_black_are_texture() {
    let mut random = Random::new(9);
    let (mut left, mut right) = (GrayImage::new(640, 480), GrayImage::new(640, 480));
    for _ in 0..6000 {
        let [x, y] = [600.0, 476.0].map(|side| 2 + (random.unit() * side) as u32);
        let grey = image::Luma([(120.0 + 130.0 * random.unit()) as u8]);
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            left.put_pixel(x + 20 + dx, y + dy, grey);
            right.put_pixel(x + dx, y + dy, grey);
        }
    }
    let found = check(&left, &right, 64);
    assert!(found.under_exposed > 0.5 && found.warnings.is_empty(), "{found:?}");
}

#[test]
fn what_lies_before_every_search_is_said() {
    // The right image's columns stand 20 px too far to the right: what is far has negative disparities.
    let (left, right) = Scene::demo().render();
    let shifted =
        GrayImage::from_fn(right.width(), right.height(), |x, y| *right.get_pixel(x.saturating_sub(20), y));
    let found = check(&left, &shifted, 64);
    assert_eq!(found.fault, None, "{found:?}");
    assert!(found.warnings[0].contains("have disparities below 0"), "{found:?}");
}

#[test]
fn a_larger_picture_is_not_a_turned_one() {
    let (left, right) = HardScene::street(1.0, 3).scene.render();
    let (width, height) = right.dimensions();
    let larger = imageops::resize(&right, width * 11 / 10, height * 11 / 10, imageops::Triangle);
    let larger = imageops::crop_imm(&larger, width / 20, height / 20, width, height).to_image();
    let found = check(&left, &larger, 64);
    assert!(matches!(found.fault, None | Some(PairFault::TwoScenes)), "{found:?}");
}
