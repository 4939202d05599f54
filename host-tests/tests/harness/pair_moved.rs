//! Pairs of which two things are wrong.

use super::pair::check;
use image::{GrayImage, imageops};
use stereopsis_host::pair::PairFault;
use stereopsis_host::scene::{HardScene, Scene};

/// A picture without so many of its rows.
fn without(picture: &GrayImage, above: u32, below: u32) -> GrayImage {
    let height = picture.height() - above - below;
    imageops::crop_imm(picture, 0, above, picture.width(), height).to_image()
}

#[test]
fn swapped_cameras_are_told_behind_rows_that_are_apart() {
    for (left, right) in [Scene::demo().render(), HardScene::street(1.0, 3).scene.render()] {
        for rows in [20, 40] {
            let (above, below) = (without(&left, rows, 0), without(&right, 0, rows));
            for (left, right, fault) in
                [(&above, &below, PairFault::RowsApart), (&below, &above, PairFault::Swapped)]
            {
                let found = check(left, right, 64);
                assert_eq!(found.fault, Some(fault), "{rows}: {found:?}");
            }
        }
    }
}
