//! Template alignment: inverse compositional Lucas-Kanade (Baker & Matthews 2004).

#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "`!(a > b)` refuses what is not a number together with what is too small"
)]

use super::inner_product::{centre, dot};
use crate::imaging::Picture;
use nalgebra::ComplexField;

/// Pixels that are compared to either side of the middle one, and one more for their slopes.
const REACH: usize = 5;
const SIDE: usize = 2 * REACH + 1;
const OUTER: usize = SIDE + 2;
const COUNT: usize = SIDE * SIDE;
/// Steps of the alignment at most.
const STEPS: usize = 10;
/// A step that is no more, px.
const LITTLE: f32 = 0.01;

/// The 11 x 11 pixels around a place of a picture, with a margin of one.
#[derive(Clone, Copy, Debug)]
pub struct Template {
    pixels: [[u8; OUTER]; OUTER],
    /// How far the place lies to the right of the middle pixel's centre and below, px.
    part: [f32; 2],
}

/// A template's pixels without their mean, and their slopes to the right and down without theirs.
struct Shape {
    values: [f32; COUNT],
    slopes: [[f32; COUNT]; 2],
}

/// Where a template was found.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TemplateMatch {
    /// The column of its place, px.
    pub x_px: f32,
    /// The row, px.
    pub y_px: f32,
    /// How alike the pixels are, whatever their brightness and contrast: the correlation coefficient, 1 at
    /// most, at the place before the last step.
    pub correlation: f32,
}

/// Where a template fits along a row.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RowMatch {
    /// The column of its place, to whole steps from it, px.
    pub x_px: f32,
    /// The correlation coefficient there.
    pub correlation: f32,
    /// The largest one three columns away and farther.
    pub elsewhere: f32,
}

/// Why a template could not be cut or found.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TemplateError {
    /// The place is too near the edge of the picture, or outside of it.
    Edge,
    /// The pixels hold no corner: along an edge or on an even surface the place could be anywhere.
    Untextured,
    /// The alignment went farther from its start than was allowed.
    TooFar,
}

error_text!(TemplateError {
    Self::Edge => "the place is too near the edge of the picture",
    Self::Untextured => "the pixels hold no corner",
    Self::TooFar => "the alignment went too far from its start",
});

/// The sum of pixels, and that of their squares.
fn sums(pixels: impl Iterator<Item = i16>) -> (i32, i32) {
    pixels.map(i32::from).map(|pixel| (pixel, pixel * pixel)).fold((0, 0), plus)
}

fn plus(a: (i32, i32), b: (i32, i32)) -> (i32, i32) {
    (a.0 + b.0, a.1 + b.1)
}

impl Template {
    /// Pixels to either side that a template needs.
    pub const MARGIN: usize = REACH + 1;
    /// The warp of pixels that are neither turned nor scaled.
    pub const UPRIGHT: [[f32; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];
    /// Nothing: finds nothing.
    pub const NONE: Self = Self { pixels: [[0; OUTER]; OUTER], part: [0.0; 2] };

    /// Cuts the pixels around a place out of a picture; refused next to the picture's edge.
    pub fn cut(picture: &Picture<'_>, x_px: f32, y_px: f32) -> Result<Self, TemplateError> {
        let (x, y) = (x_px + 0.5, y_px + 0.5);
        if !(x >= Self::MARGIN as f32 && y >= Self::MARGIN as f32) {
            return Err(TemplateError::Edge);
        }
        let (column, row) = (x as usize, y as usize);
        let mut template = Self { part: [x_px - column as f32, y_px - row as f32], ..Self::NONE };
        for (line, row) in template.pixels.iter_mut().zip(row - Self::MARGIN..) {
            // By its length: a copy of two that may differ leaves a panic.
            let run = picture.run(column - Self::MARGIN, row, OUTER).and_then(<[u8]>::first_chunk);
            *line = *run.ok_or(TemplateError::Edge)?;
        }
        Ok(template)
    }

    /// Aligns the template with another picture: the place with the least squared differences, brightness and
    /// contrast apart, from `start` on. `warp` carries offsets in the template's picture into the other one,
    /// px.
    ///
    /// The inverse compositional algorithm (Baker & Matthews 2004): Gauss-Newton with the template's
    /// gradients, at most ten steps. Refused where the pixels hold no corner, at the picture's edge, and more
    /// than `farthest_px` from the start; a negative or NaN `farthest_px` counts as 0. After ten steps the
    /// last place is returned, converged or not, with the correlation before the last step.
    pub fn align(
        &self,
        picture: &Picture<'_>,
        warp: &[[f32; 2]; 2],
        start: [f32; 2],
        farthest_px: f32,
    ) -> Result<TemplateMatch, TemplateError> {
        let Shape { values, slopes: [right, down] } = self.shape();
        let own = dot(&values, &values);
        let (xx, xy, yy) = (dot(&right, &right), dot(&right, &down), dot(&down, &down));
        let determinant = xx * yy - xy * xy;
        // Along an edge it could be anywhere. Slopes see a pixel more to each side: all inside may be equal.
        if !(own > 0.0 && determinant > 1e-3 * (xx + yy) * (xx + yy)) {
            return Err(TemplateError::Untextured);
        }
        let (own_right, own_down) = (dot(&values, &right), dot(&values, &down));
        let [mut x, mut y] = start;
        let mut correlation = -1.0;
        for _ in 0..STEPS {
            let mut seen = [0.0; COUNT];
            self.look(picture, warp, [x, y], &mut seen).ok_or(TemplateError::Edge)?;
            let (cross, other) = (dot(&seen, &values), dot(&seen, &seen));
            if !(other > 0.0) {
                return Err(TemplateError::Untextured);
            }
            correlation = cross / ComplexField::sqrt(own * other);
            let gain = cross / other;
            let (a, b) = (gain * dot(&seen, &right) - own_right, gain * dot(&seen, &down) - own_down);
            let (right, down) = ((yy * a - xy * b) / determinant, (xx * b - xy * a) / determinant);
            // It is the template that should move: the picture's place moves back.
            x -= warp[0][0] * right + warp[0][1] * down;
            y -= warp[1][0] * right + warp[1][1] * down;
            let (dx, dy) = (x - start[0], y - start[1]);
            if !(dx * dx + dy * dy <= farthest_px.max(0.0) * farthest_px.max(0.0)) {
                return Err(TemplateError::TooFar);
            }
            if right.abs().max(down.abs()) < LITTLE {
                break;
            }
        }
        Ok(TemplateMatch { x_px: x, y_px: y, correlation })
    }

    /// The column of `row` from `least` to `most` at which the template correlates best with the other
    /// picture, unwarped and to whole pixels; refused where no column is far enough from the picture's
    /// edge.
    // Apart, for it takes as much stack as what calls it.
    #[inline(never)]
    pub fn match_row(
        &self,
        picture: &Picture<'_>,
        row: usize,
        least: usize,
        most: usize,
    ) -> Result<RowMatch, TemplateError> {
        let mut own = [[0_i16; SIDE]; SIDE];
        for (to, line) in own.iter_mut().zip(self.pixels.iter().skip(1)) {
            for (to, &pixel) in to.iter_mut().zip(line.iter().skip(1)) {
                *to = pixel.into();
            }
        }
        let (sum, squares) = sums(own.as_flattened().iter().copied());
        let n = COUNT as i32;
        let own_spread = (n * squares - sum * sum) as f32;
        let (least, most) =
            (least.max(REACH), most.min(picture.width().checked_sub(REACH + 1).ok_or(TemplateError::Edge)?));
        let first_row = row.checked_sub(REACH).ok_or(TemplateError::Edge)?;
        let mut lines = [&[0_u8; 0][..]; SIDE];
        for (line, row) in lines.iter_mut().zip(first_row..) {
            *line = picture.run(0, row, picture.width()).ok_or(TemplateError::Edge)?;
        }
        let column_sums =
            |x: usize| sums(lines.iter().map(|line| line.get(x).map_or(0, |&pixel| pixel.into())));
        // The window's sums move with it: without the column on its right, which is still to come.
        let mut others = (least - REACH..least.saturating_add(REACH)).map(column_sums).fold((0, 0), plus);
        let mut correlation = |column: usize| {
            let (other, other_squares) = plus(others, column_sums(column + REACH));
            let (left, left_squares) = column_sums(column - REACH);
            others = (other - left, other_squares - left_squares);
            let mut cross = 0;
            for (line, own) in lines.iter().zip(&own) {
                let run = line.get(column - REACH..).and_then(|run| run.first_chunk::<SIDE>());
                for (&pixel, &own) in run.unwrap_or(&[0; SIDE]).iter().zip(own) {
                    cross += i32::from(i16::from(pixel)) * i32::from(own);
                }
            }
            let spread = (n * other_squares - other * other) as f32;
            let product = own_spread * spread;
            if product > 0.0 { (n * cross - sum * other) as f32 / ComplexField::sqrt(product) } else { -1.0 }
        };
        // The largest, and the largest of what is three columns away from it: of a stretch that is before it,
        // and one behind.
        let (mut best, mut best_column, mut elsewhere) = (-1.0_f32, None, -1.0_f32);
        let mut before = [-1.0_f32; 2];
        let mut far_before = -1.0_f32;
        for column in least..=most {
            let here = correlation(column);
            if best_column.is_none() || here > best {
                (best, best_column, elsewhere) = (here, Some(column), far_before);
            } else if best_column.is_some_and(|best: usize| column - best >= 3) {
                elsewhere = elsewhere.max(here);
            }
            // What will be three columns away from the next one.
            let [oldest, last] = before;
            far_before = far_before.max(oldest);
            before = [last, here];
        }
        let found = best_column.map(|column| RowMatch {
            x_px: column as f32 + self.part[0],
            correlation: best,
            elsewhere,
        });
        found.ok_or(TemplateError::Edge)
    }

    /// The pixels and their slopes.
    #[inline(never)]
    fn shape(&self) -> Shape {
        let mut shape = Shape { values: [0.0; COUNT], slopes: [[0.0; COUNT]; 2] };
        let Shape { values, slopes: [right, down] } = &mut shape;
        let lines =
            values.chunks_exact_mut(SIDE).zip(right.chunks_exact_mut(SIDE).zip(down.chunks_exact_mut(SIDE)));
        for (rows, (values, (rights, downs))) in self.pixels.windows(3).zip(lines) {
            let [above, here, below] = rows else { continue };
            let half = |a: u8, b: u8| (f32::from(b) - f32::from(a)) * 0.5;
            let places = values.iter_mut().zip(rights.iter_mut().zip(downs));
            let columns = here.windows(3).zip(above.iter().skip(1).zip(below.iter().skip(1)));
            for ((value, (right, down)), (around, (&above, &below))) in places.zip(columns) {
                let &[before, pixel, after] = around else { continue };
                *value = pixel.into();
                *right = half(before, after);
                *down = half(above, below);
            }
        }
        centre(values);
        centre(right);
        centre(down);
        shape
    }

    /// The picture's brightness where the template's pixels come to lie, without its mean; `None` where one
    /// is outside.
    fn look(
        &self,
        picture: &Picture<'_>,
        warp: &[[f32; 2]; 2],
        [x, y]: [f32; 2],
        out: &mut [f32; COUNT],
    ) -> Option<()> {
        let [right, down] = self.part;
        let from_middle = |i: usize, part: f32| i as f32 - REACH as f32 - part;
        if *warp == Self::UPRIGHT {
            let [column, row] = [from_middle(0, right) + x, from_middle(0, down) + y];
            picture.sample_square::<SIDE>(column, row, out)?;
        } else {
            let ([a, b], [c, d]) = (warp[0], warp[1]);
            let (i, j) = (from_middle(0, right), from_middle(0, down));
            let start = [x + a * i + b * j, y + c * i + d * j];
            picture.sample_parallelogram::<SIDE>(start, [a, c], [b, d], out)?;
        }
        centre(out);
        Some(())
    }
}
