//! How rows that do not agree are told: by a turn, by another focal length, or by both.

use image::{GrayImage, Luma, imageops};
use stereopsis::geometry::camera::ImageSize;
use stereopsis_host::pair::PairMatches;
use stereopsis_host::rows::Rows;
use stereopsis_host::scene::{HardScene, Scene};

/// A picture turned about its middle by so many degrees, `scale` times as large, and moved down by so many
/// pixels.
fn moved(picture: &GrayImage, degrees: f32, scale: f32, down: f32) -> GrayImage {
    let (w, h) = picture.dimensions();
    let (cx, cy) = ((w - 1) as f32 / 2.0, (h - 1) as f32 / 2.0);
    let (sin, cos) = degrees.to_radians().sin_cos();
    GrayImage::from_fn(w, h, |x, y| {
        let [x, y] = [(x as f32 - cx) / scale, (y as f32 - down - cy) / scale];
        let at = (cx + cos * x + sin * y, cy + cos * y - sin * x);
        imageops::interpolate_bilinear(picture, at.0, at.1).unwrap_or(Luma([0]))
    })
}

fn rows(left: &GrayImage, right: &GrayImage) -> Rows {
    let matches = PairMatches::find([left, right], None).expect("features");
    let size = ImageSize { width: left.width() as u16, height: left.height() as u16 };
    Rows::measure(&matches, size, None).expect("matches")
}

#[test]
fn a_larger_image_is_told_from_one_that_is_turned() {
    for (left, right) in [Scene::demo().render(), HardScene::street(1.0, 3).scene.render()] {
        assert_eq!(rows(&left, &right).warning(), None);
        for scale in [0.98_f32, 0.99, 1.01, 1.02, 1.06] {
            let found = rows(&left, &moved(&right, 0.0, scale, 0.0));
            assert!((found.scale - f64::from(scale)).abs() < 1e-3, "{scale}: {found:?}");
            // The mean square of a row is a twelfth of the height's square.
            let error = f64::from((scale - 1.0).abs()) * f64::from(left.height()) / 12.0_f64.sqrt();
            assert!((found.error_px - error).abs() < 0.15 * error, "{scale}: {error} {found:?}");
            let size = if scale > 1.0 { "% larger than" } else { "% smaller than" };
            let said = found.warning().unwrap_or_default();
            assert!(said.contains(size) && !said.contains("roll"), "{scale}: {said}");
        }
        for degrees in [-0.5, 0.3, 1.0] {
            let found = rows(&left, &moved(&right, degrees, 1.0, 0.0));
            assert!((found.roll_deg - f64::from(degrees)).abs() < 0.05 && found.scale == 1.0, "{found:?}");
        }
        // Both at once, and lower.
        let found = rows(&left, &moved(&right, 0.5, 1.01, 2.0));
        assert!((found.scale - 1.01).abs() < 1e-3 && (found.roll_deg - 0.5).abs() < 0.05, "{found:?}");
        let said = found.warning().unwrap_or_default();
        assert!(
            said.contains("1.0 % larger") && said.contains("lower") && said.contains("roll +0.5"),
            "{said}"
        );
    }
}
