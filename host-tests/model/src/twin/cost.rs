//! The cost of every disparity at every pixel, and its sum over the window.

use super::Method;
use super::census::census;
use super::smooth::Seen;
use stereopsis::matching::Config;

/// A number for every row, column and disparity.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) disparities: usize,
    values: Vec<u16>,
}

impl Volume {
    pub(super) fn filled(width: usize, height: usize, disparities: usize) -> Self {
        Self { width, height, disparities, values: vec![0; width * height * disparities] }
    }

    /// The values of all disparities at column x of row y.
    pub fn at(&self, x: usize, y: usize) -> &[u16] {
        let start = (y * self.width + x) * self.disparities;
        &self.values[start..start + self.disparities]
    }

    pub(super) fn at_mut(&mut self, x: usize, y: usize) -> &mut [u16] {
        let start = (y * self.width + x) * self.disparities;
        &mut self.values[start..start + self.disparities]
    }
}

/// How many census bits differ between (x, y) on the left and (x - m - d, y) on the right; left of the right
/// picture's edge, its first column stands in.
pub fn costs(neighbours: &[(isize, isize)], config: &Config, left: &Seen<'_>, right: &Seen<'_>) -> Volume {
    let (left_words, right_words) = (census(left, neighbours), census(right, neighbours));
    let smallest = usize::from(config.min_disparity);
    let left = left.picture;
    let mut volume = Volume::filled(left.width, left.height, usize::from(config.disparities));
    for y in 0..left.height {
        for x in 0..left.width {
            let word = left_words[y * left.width + x];
            for (d, cost) in volume.at_mut(x, y).iter_mut().enumerate() {
                let column = x.saturating_sub(smallest + d);
                *cost = (word ^ right_words[y * left.width + column]).count_ones() as u16;
            }
        }
    }
    volume
}

/// The sum over the part of the window that lies inside the picture: first along columns, of which only whole
/// units count, then along rows.
pub fn window_sums(scheme: &Method, unit: u16, costs: &Volume) -> Volume {
    let (width, height) = (costs.width, costs.height);
    let mut columns = Volume::filled(width, height, costs.disparities);
    for y in 0..height {
        for x in 0..width {
            for row in y.saturating_sub(scheme.radius_y)..height.min(y + scheme.radius_y + 1) {
                add(columns.at_mut(x, y), costs.at(x, row));
            }
            for sum in columns.at_mut(x, y) {
                *sum /= unit;
            }
        }
    }
    let mut sums = Volume::filled(width, height, costs.disparities);
    for y in 0..height {
        for x in 0..width {
            for column in x.saturating_sub(scheme.radius_x)..width.min(x + scheme.radius_x + 1) {
                add(sums.at_mut(x, y), columns.at(column, y));
            }
        }
    }
    sums
}

fn add(sum: &mut [u16], values: &[u16]) {
    for (s, v) in sum.iter_mut().zip(values) {
        *s += v;
    }
}

/// The same sums by the definition, one window after the other: slow, to hold [`window_sums`] to.
pub fn window_sums_plain(scheme: &Method, unit: u16, costs: &Volume) -> Volume {
    let (width, height) = (costs.width as isize, costs.height as isize);
    let (radius_x, radius_y) = (scheme.radius_x as isize, scheme.radius_y as isize);
    let mut sums = Volume::filled(costs.width, costs.height, costs.disparities);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        for column in (x - radius_x..=x + radius_x).filter(|column| (0..width).contains(column)) {
            for d in 0..costs.disparities {
                let rows = (y - radius_y..=y + radius_y).filter(|row| (0..height).contains(row));
                let bits: u16 = rows.map(|row| costs.at(column as usize, row as usize)[d]).sum();
                sums.at_mut(x as usize, y as usize)[d] += bits / unit;
            }
        }
    }
    sums
}
