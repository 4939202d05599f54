//! What is wrong with a pair is found, and nothing where nothing is.

use image::{GrayImage, imageops};
use stereopsis_host::pair::{PairCheck, PairFault, PairMatches, fault, search};
use stereopsis_host::run::MethodName;
use stereopsis_host::scene::{HardScene, Scene};

/// What is found of two pictures and a search.
fn check(left: &GrayImage, right: &GrayImage, disparities: u16) -> PairCheck {
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
