//! Places found again by their pixels.

use image::GrayImage;
use stereopsis::features::{Template, TemplateError};
use stereopsis::imaging::Picture;

/// A smooth picture without a repetition, moved, scaled, and in another light.
fn picture(right: f64, down: f64, scale: f64, light: (f64, f64)) -> GrayImage {
    GrayImage::from_fn(80, 60, |x, y| {
        let (x, y) = ((f64::from(x) - 40.0 - right) / scale, (f64::from(y) - 30.0 - down) / scale);
        let value =
            (x * 0.55).sin() * 40.0 + (y * 0.43 + x * 0.11).cos() * 35.0 + (x * y * 0.02).sin() * 20.0;
        image::Luma([(light.0 * value + light.1).round().clamp(0.0, 255.0) as u8])
    })
}

fn view(picture: &GrayImage) -> Picture<'_> {
    Picture::new(picture.as_raw(), 80, 60).expect("a picture")
}

#[test]
fn a_small_part_of_a_pixel() {
    let first = picture(0.0, 0.0, 1.0, (1.0, 120.0));
    let template = Template::cut(&view(&first), 40.3, 29.6).expect("inside");
    for (right, down, scale, light) in [
        (0.0, 0.0, 1.0, (1.0, 120.0)),
        (0.4, -0.7, 1.0, (1.0, 120.0)),
        (1.3, 0.9, 1.0, (0.7, 100.0)),
        (-1.6, 0.2, 1.2, (1.1, 130.0)),
    ] {
        let second = picture(right, down, scale, light);
        let truth = [40.0 + right + 0.3 * scale, 30.0 + down - 0.4 * scale];
        let warp = [[scale as f32, 0.0], [0.0, scale as f32]];
        let found = template.align(&view(&second), &warp, [40.3, 29.6], 4.0).expect("it is there");
        let off = (f64::from(found.x_px) - truth[0]).hypot(f64::from(found.y_px) - truth[1]);
        // Interpolation of rounded pixels costs some hundredths.
        assert!(off < 0.05 && found.correlation > 0.98, "{off} {found:?}");
    }
}

#[test]
fn what_holds_nothing_is_not_found() {
    let flat = GrayImage::from_pixel(80, 60, image::Luma([90]));
    let template = Template::cut(&view(&flat), 40.0, 30.0).expect("inside");
    let upright = [[1.0, 0.0], [0.0, 1.0]];
    assert_eq!(template.align(&view(&flat), &upright, [40.0, 30.0], 4.0), Err(TemplateError::Untextured));
    // Along an edge it could be anywhere.
    let edge = GrayImage::from_fn(80, 60, |x, _| image::Luma([if x < 40 { 20 } else { 200 }]));
    let template = Template::cut(&view(&edge), 40.0, 30.0).expect("inside");
    assert_eq!(template.align(&view(&edge), &upright, [40.0, 30.0], 4.0), Err(TemplateError::Untextured));
    // Pixels that are all the same, with corners in the margin of one, which slopes alone see.
    let framed = GrayImage::from_fn(80, 60, |x, y| {
        let inside = x.abs_diff(40) < 6 && y.abs_diff(30) < 6;
        image::Luma([if inside { 90 } else { (x * 7 + y * 13) as u8 }])
    });
    let template = Template::cut(&view(&framed), 40.0, 30.0).expect("inside");
    let rich = GrayImage::from_fn(80, 60, |x, y| image::Luma([(x * x + 3 * y * y) as u8]));
    assert_eq!(template.align(&view(&rich), &upright, [40.0, 30.0], 4.0), Err(TemplateError::Untextured));
    assert!(Template::cut(&view(&edge), 5.4, 30.0).is_err());
    assert!(Template::cut(&view(&edge), 5.6, 30.0).is_ok());
    assert!(Template::cut(&view(&edge), 40.0, 53.6).is_err());
    assert!(Template::cut(&view(&edge), f32::NAN, 30.0).is_err());
}

/// Every column's correlation coefficient, by its definition.
fn naive(first: &GrayImage, second: &GrayImage, (x, y): (usize, usize), column: usize) -> f64 {
    let patch = |picture: &GrayImage, x: usize, y: usize| -> Vec<f64> {
        let at =
            |i: usize| f64::from(picture.get_pixel((x + i % 11 - 5) as u32, (y + i / 11 - 5) as u32).0[0]);
        (0..121).map(at).collect()
    };
    let (a, b) = (patch(first, x, y), patch(second, column, y));
    let mean = |v: &[f64]| v.iter().sum::<f64>() / 121.0;
    let (ma, mb) = (mean(&a), mean(&b));
    let sum = |f: &dyn Fn(f64, f64) -> f64| a.iter().zip(&b).map(|(a, b)| f(a - ma, b - mb)).sum::<f64>();
    sum(&|a, b| a * b) / (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt()
}

#[test]
fn along_a_row_as_by_definition() {
    let (first, second) = (picture(0.0, 0.0, 1.0, (1.0, 120.0)), picture(-9.0, 0.0, 1.0, (0.8, 90.0)));
    for (x, y) in [(40, 30), (30, 12), (20, 40)] {
        let template = Template::cut(&view(&first), x as f32, y as f32).expect("inside");
        let found = template.match_row(&view(&second), y, 0, 79).expect("columns");
        let all: Vec<(usize, f64)> = (5..=74).map(|c| (c, naive(&first, &second, (x, y), c))).collect();
        let best = all.iter().fold(all[0], |best, &one| if one.1 > best.1 { one } else { best });
        assert_eq!(found.x_px, best.0 as f32);
        assert!((f64::from(found.correlation) - best.1).abs() < 1e-5);
        let apart = all.iter().filter(|(c, _)| c.abs_diff(best.0) >= 3).map(|one| one.1);
        let elsewhere = apart.fold(-1.0_f64, f64::max);
        assert!((f64::from(found.elsewhere) - elsewhere).abs() < 1e-5, "{} {elsewhere}", found.elsewhere);
    }
    let template = Template::cut(&view(&first), 40.0, 30.0).expect("inside");
    assert_eq!(template.match_row(&view(&second), 30, 0, 4), Err(TemplateError::Edge));
    assert_eq!(template.match_row(&view(&second), 57, 0, 79), Err(TemplateError::Edge));
}
