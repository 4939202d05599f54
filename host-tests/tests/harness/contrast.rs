//! Pairs of few grey levels.

use super::pair::check;
use image::GrayImage;
use stereopsis_host::pair::PairFault;
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
