//! Pairs of few grey levels.

use super::pair::check;
use image::GrayImage;
use stereopsis_host::pair::{PairFault, PairMatches};
use stereopsis_host::scene::{HardScene, Scene};

/// A picture with a share of its contrast, above a grey level.
fn faint(picture: &GrayImage, share: f64, above: u8) -> GrayImage {
    let mut faint = picture.clone();
    faint.iter_mut().for_each(|grey| *grey = above + (f64::from(*grey) * share).round() as u8);
    faint
}

#[test]
fn little_contrast_is_named_and_hides_no_fault() {
    for (left, right) in [Scene::demo().render(), HardScene::street(1.0, 3).scene.render()] {
        for (share, above, cure) in
            [(0.1, 0, "expose longer"), (0.05, 0, "expose longer"), (0.1, 120, "fogged")]
        {
            let [left, right] = [&left, &right].map(|picture| faint(picture, share, above));
            let found = check(&left, &right, 64);
            assert!(
                found.fault.is_none() && found.grey_levels.iter().all(|&levels| levels < 40),
                "{found:?}"
            );
            let said = found.warnings.iter().find(|said| said.starts_with("the images have little contrast"));
            assert!(said.is_some_and(|said| said.contains(cure)), "{found:?}");
            assert_eq!(check(&right, &left, 64).fault, Some(PairFault::Swapped), "{share} {above}");
        }
        let found = check(&left, &right, 64);
        assert!(!found.warnings.iter().any(|said| said.contains("contrast")), "{found:?}");
    }
}

#[test]
fn a_border_that_a_mask_leaves_out_is_no_contrast() {
    let (left, right) = Scene::demo().render();
    let (width, height) = left.dimensions();
    let is_border = |x: u32| x < width / 10;
    let [left, right] = [&left, &right].map(|picture| {
        let mut picture = faint(picture, 0.05, 0);
        picture
            .enumerate_pixels_mut()
            .filter(|(x, ..)| is_border(*x))
            .for_each(|(.., pixel)| pixel.0[0] = 255);
        picture
    });
    let shown = GrayImage::from_fn(width, height, |x, _| image::Luma([if is_border(x) { 0 } else { 255 }]));
    let count = |valid| PairMatches::find([&left, &right], valid).map_or(0, |found| found.count());
    let (masked, all) = (count(Some([&shown; 2])), count(None));
    assert!(masked > 100 && all < masked / 2, "{masked} of {all}");
}
