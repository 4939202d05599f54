//! The cost of every disparity at every pixel, and its sum along paths.

use super::Picture;
use super::census::{WIDE8, census};
use super::cost::Volume;
use super::smooth::Seen;
use stereopsis::matching::{Config, Penalties};

/// A number for every pixel of a picture, whose edge goes on for ever outside of it.
struct Numbers {
    width: usize,
    height: usize,
    values: Vec<i32>,
}

impl Numbers {
    fn of(picture: &Picture<'_>, number: impl Fn(isize, isize) -> i32) -> Self {
        let (width, height) = (picture.width, picture.height);
        let places = (0..height as isize).flat_map(|y| (0..width as isize).map(move |x| (x, y)));
        Self { width, height, values: places.map(|(x, y)| number(x, y)).collect() }
    }

    fn at(&self, x: isize, y: isize) -> i32 {
        let x = x.clamp(0, self.width as isize - 1) as usize;
        let y = y.clamp(0, self.height as isize - 1) as usize;
        self.values[y * self.width + x]
    }

    /// The range of each number and of those halfway to its neighbours in the row, in the order of `values`.
    fn ranges(&self) -> Vec<(i32, i32)> {
        let places = (0..self.height as isize).flat_map(|y| (0..self.width as isize).map(move |x| (x, y)));
        places.map(|(x, y)| self.range(x, y)).collect()
    }

    /// That of the number at column `x` of row `y`.
    fn range(&self, x: isize, y: isize) -> (i32, i32) {
        let here = self.at(x, y);
        let halfway = [(self.at(x - 1, y) + here) / 2, (here + self.at(x + 1, y)) / 2];
        (here.min(halfway[0]).min(halfway[1]), here.max(halfway[0]).max(halfway[1]))
    }
}

/// What a picture's pixels look like.
struct Looks {
    along: Numbers,
    across: Numbers,
    brightness: Numbers,
    census: Vec<u32>,
}

impl Looks {
    fn of(seen: &Seen<'_>, penalties: &Penalties) -> Self {
        let at = |x, y, off| i32::from(seen.at(x, y, off));
        let most = i32::from(penalties.gradient);
        let cut = |gradient: i32| (gradient >> seen.gradient_shift()).clamp(-most, most) + most;
        let along = |x, y| {
            let difference = |off| at(x + 1, y, off) - at(x - 1, y, off);
            cut(difference(-1) + 2 * difference(0) + difference(1))
        };
        let across = |x, y| {
            let difference = |x| at(x, y, 1) - at(x, y, -1);
            cut(difference(x - 1) + 2 * difference(x) + difference(x + 1))
        };
        Self {
            along: Numbers::of(&seen.picture, along),
            across: Numbers::of(&seen.picture, across),
            brightness: Numbers::of(&seen.picture, |x, y| at(x, y, 0) / 2),
            census: census(seen, &WIDE8),
        }
    }
}

/// How far a number is outside of a range.
fn apart_from((least, greatest): (i32, i32), number: i32) -> i32 {
    (number - greatest).max(least - number).max(0)
}

/// How little (x, y) on the left looks like (x - m - d, y) on the right; left of the right picture's edge,
/// its first column stands in.
pub fn costs(between_pixels: bool, config: &Config, left: &Seen<'_>, right: &Seen<'_>) -> Volume {
    let penalties = &config.penalties;
    let (left, right) = (Looks::of(left, penalties), Looks::of(right, penalties));
    let (width, height) = (left.along.width, left.along.height);
    let between = right.along.ranges();
    let mut volume = Volume::filled(width, height, usize::from(config.disparities));
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        for (d, cost) in volume.at_mut(x, y).iter_mut().enumerate() {
            let other = x.saturating_sub(usize::from(config.min_disparity) + d);
            let (here, there) = (y * width + x, y * width + other);
            let apart = |a: &Numbers, b: &Numbers| (a.values[here] - b.values[there]).abs();
            let along = if between_pixels {
                apart_from(between[there], left.along.values[here])
            } else {
                apart(&left.along, &right.along)
            };
            let bits = (left.census[here] ^ right.census[there]).count_ones() as i32;
            let rest =
                apart(&left.across, &right.across) + apart(&left.brightness, &right.brightness) / 4 + bits;
            let sum = 2 * along + rest;
            *cost = sum.min(i32::from(penalties.cost)) as u16;
        }
    }
    volume
}

/// What a path says to the pixel it goes to: what each disparity costs there.
fn message(path: &[u16], (step, jump): (u16, u16)) -> Vec<u16> {
    let least = *path.iter().min().expect("a disparity");
    let stepped = |d: Option<usize>| d.and_then(|d| path.get(d)).map_or(u16::MAX, |&cost| cost + step);
    let at = |d: usize| {
        let beside = stepped(d.checked_sub(1)).min(stepped(Some(d + 1)));
        path[d].min(beside).min(least + jump) - least
    };
    (0..path.len()).map(at).collect()
}

fn add(a: &[u16], b: &[u16]) -> Vec<u16> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

fn average(a: &[u16], b: &[u16]) -> Vec<u16> {
    a.iter().zip(b).map(|(a, b)| (a + b) / 2).collect()
}

/// The costs of each row with those of the rows above and of the one below, each as much as all that come
/// before it; before the first there is nothing.
pub fn averaged_down(costs: &Volume) -> Volume {
    let mut averaged = costs.clone();
    let mut sums = vec![vec![0; costs.disparities]; costs.width];
    let mut add_row = |y: usize| {
        for (x, sum) in sums.iter_mut().enumerate() {
            if y < costs.height {
                *sum = add(sum, costs.at(x, y)).iter().map(|twice| twice.div_ceil(2)).collect();
            }
            if y > 0 {
                averaged.at_mut(x, y - 1).copy_from_slice(sum);
            }
        }
    };
    (0..=costs.height).for_each(&mut add_row);
    averaged
}

/// The costs of each pixel with those of its column as far as the brightness does not change much from row to
/// row: half of the row's and those above, each as much as all above it, and half of two rows below.
pub fn averaged_within_edges(config: &Config, costs: &Volume, left: &Picture<'_>) -> Volume {
    let rounded_up =
        |a: &[u16], b: &[u16]| -> Vec<u16> { add(a, b).iter().map(|twice| twice.div_ceil(2)).collect() };
    let mut averaged = costs.clone();
    for x in 0..costs.width {
        let bright = |y: usize| left.at(x as isize, y as isize);
        let goes_on_below =
            |y: usize| y + 1 < costs.height && bright(y).abs_diff(bright(y + 1)) < config.penalties.edges[1];
        let mut above: Option<Vec<u16>> = None;
        for y in 0..costs.height {
            let row = costs.at(x, y);
            let with_above = above.map_or_else(|| row.to_vec(), |above| rounded_up(&above, row));
            let below = match (y..y + 2).take_while(|&y| goes_on_below(y)).count() {
                0 => None,
                1 => Some(costs.at(x, y + 1).to_vec()),
                _ => Some(rounded_up(costs.at(x, y + 1), costs.at(x, y + 2))),
            };
            let all = below.map_or_else(|| with_above.clone(), |below| rounded_up(&with_above, &below));
            averaged.at_mut(x, y).copy_from_slice(&all);
            above = goes_on_below(y).then_some(with_above);
        }
    }
    averaged
}

/// The sums of three paths into every pixel, none over 255.
pub fn path_sums(config: &Config, costs: &Volume, left: &Picture<'_>) -> Volume {
    let penalties = &config.penalties;
    let (width, height) = (costs.width, costs.height);
    let change = |(x, y): (usize, usize), (from_x, from_y): (usize, usize)| {
        let bright = |x: usize, y: usize| left.at(x as isize, y as isize);
        let change = bright(x, y).abs_diff(bright(from_x, from_y));
        let [little, more, much] = penalties.jump.map(u16::from);
        let [step, small_step] = penalties.step.map(u16::from);
        if change < penalties.edges[0] {
            (step, little)
        } else if change < penalties.edges[1] {
            (small_step, more)
        } else {
            (small_step, much)
        }
    };
    let mut sums = costs.clone();
    let mut above: Vec<Vec<u16>> = Vec::new();
    for y in 0..height {
        let along = |columns: &mut dyn Iterator<Item = usize>| {
            let mut paths = vec![Vec::new(); width];
            let mut from: Option<usize> = None;
            for x in columns {
                paths[x] = match from {
                    Some(from) => add(costs.at(x, y), &message(&paths[from], change((x, y), (from, y)))),
                    None => costs.at(x, y).to_vec(),
                };
                from = Some(x);
            }
            paths
        };
        let from_left = along(&mut (0..width));
        let from_right = along(&mut (0..width).rev());
        let from_above = |x: usize| {
            if y == 0 {
                return vec![0; costs.disparities];
            }
            let path = average(&above[x.saturating_sub(2)], &above[(x + 2).min(width - 1)]);
            message(&path, change((x, y), (x, y - 1)))
        };
        above = (0..width).map(|x| add(costs.at(x, y), &from_above(x))).collect();
        for x in 0..width {
            let sum = add(&add(&from_left[x], &from_right[x]), &above[x]);
            for (to, sum) in sums.at_mut(x, y).iter_mut().zip(sum) {
                *to = sum.min(255);
            }
        }
    }
    sums
}
