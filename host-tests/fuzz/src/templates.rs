//! Templates and pictures at any place.

use crate::case::{self, number};
use arbitrary::{Result, Unstructured};
use stereopsis::features::Template;
use stereopsis::imaging::Picture;

/// A place that is found is a number, near where it was looked for, and as alike as can be at most.
pub fn stay_in_the_picture(u: &mut Unstructured<'_>) -> Result<()> {
    let (width, height) = (u.int_in_range(1..=60_u32)?, u.int_in_range(1..=40_u32)?);
    let (first, second) = case::pair(u, width, height)?;
    let view = |image| Picture::new(image, width as u16, height as u16).expect("as many pixels");
    let (first, second) = (view(first.as_raw()), view(second.as_raw()));
    let mut place = |most: u32| -> Result<f32> {
        if u.ratio(1, 4)? { Ok(number(u)? as f32) } else { Ok(u.int_in_range(0..=most * 16)? as f32 / 16.0) }
    };
    let (x, y, start) = (place(width)?, place(height)?, [place(width)?, place(height)?]);
    if let Some(grey) = first.sample(x, y) {
        assert!((0.0..=255.0).contains(&grey), "{grey} at {x}, {y}");
    }
    let Ok(template) = Template::cut(&first, x, y) else { return Ok(()) };
    let mut entry = || -> Result<f32> {
        if u.ratio(1, 4)? { Ok(number(u)? as f32) } else { Ok(f32::from(u.arbitrary::<i8>()?) / 64.0) }
    };
    let warp = [[entry()?, entry()?], [entry()?, entry()?]];
    let far = number(u)? as f32;
    if let Ok(found) = template.align(&second, &warp, start, far) {
        let off = (found.x_px - start[0]).hypot(found.y_px - start[1]);
        assert!(off <= far.max(0.0) * 1.001 && found.correlation.abs() <= 1.001, "{found:?} {start:?} {far}");
    }
    let (row, least, most) = (u.arbitrary::<u8>()?, u.arbitrary::<u8>()?, u.arbitrary()?);
    if let Ok(found) = template.match_row(&second, row.into(), least.into(), most) {
        assert!((0.0..width as f32).contains(&found.x_px), "{found:?}");
        assert!(found.correlation.abs() <= 1.001, "{found:?}");
    }
    Ok(())
}
