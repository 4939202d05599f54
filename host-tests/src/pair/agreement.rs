//! Which matches agree with each other: right ones do, and wrong ones are strewn over the picture.

use nalgebra::{Point2, Vector3};
use stereopsis::geometry::{
    camera::Camera,
    rectify::{RowAlignment, RowMeter},
    two_view::Correspondence,
};

/// With fewer matches nothing is said.
pub(super) const FEWEST: usize = 16;
/// How many others a disparity has near it, to be one of a surface: of twenty wrong ones over both directions
/// of a picture's width one in a thousand has as many.
const OTHERS: usize = 4;
/// How many others a match has that are near it in both place and disparity, to be one of a thing that is
/// seen alone.
const OTHERS_THERE: usize = 7;
/// How far apart the rows of partners are at most where they agree, px.
const SAME_ROW_PX: f64 = 1.0;
/// How far apart they are where all that is asked is whether they agree at all, px: by chance a quarter of
/// those that are at most 12 px apart are.
const ABOUT_SAME_ROW_PX: f64 = 3.0;

/// How far apart the disparities of one surface are, px.
fn reach(width: u32) -> f64 {
    (f64::from(width) / 64.0).max(4.0)
}

/// Those of some disparities in ascending order that others are near to, in pictures that are so wide.
pub(super) fn on_surfaces(sorted: &[f64], width: u32) -> Vec<f64> {
    let reach = reach(width);
    let near = |d: f64| {
        sorted.partition_point(|&other| other <= d + reach)
            - sorted.partition_point(|&other| other < d - reach)
    };
    sorted.iter().copied().filter(|&d| near(d) > OTHERS).collect()
}

/// The disparities, in ascending order, of those of some matches that others are near to in disparity and in
/// place: within an eighth of the width.
pub(super) fn of_things(matches: &[Correspondence<f64>], width: u32) -> Vec<f64> {
    let disparity = |s: &Correspondence<f64>| s.first.x - s.second.x;
    let is_near = |a: &Correspondence<f64>, b: &Correspondence<f64>| {
        (disparity(a) - disparity(b)).abs() <= reach(width)
            && (a.first - b.first).amax() <= f64::from(width) / 8.0
    };
    let near = |a: &Correspondence<f64>| matches.iter().filter(|b| is_near(a, b)).count();
    let mut found: Vec<_> = matches.iter().filter(|a| near(a) > OTHERS_THERE).map(disparity).collect();
    found.sort_by(f64::total_cmp);
    found
}

/// How many other matches each one is compared with at most.
const MOST_OTHERS: usize = 4000;

/// Whether at least a quarter of the matches around each one, within an eighth of the width of the rectified
/// pictures, agree with it in disparity, and one of them does.
pub fn agree_around(matches: &[Correspondence<f64>], width: u32) -> Vec<bool> {
    let disparity = |s: &Correspondence<f64>| s.first.x - s.second.x;
    let others = || matches.iter().step_by(matches.len().div_ceil(MOST_OTHERS).max(1));
    let agrees = |s: &Correspondence<f64>| {
        let beside = others().filter(|other| (other.first - s.first).amax() <= f64::from(width) / 8.0);
        let (mut all, mut agreeing) = (0, 0);
        for other in beside {
            all += 1;
            agreeing += u32::from((disparity(other) - disparity(s)).abs() <= reach(width));
        }
        // The match is one of both.
        agreeing > 1 && 4 * agreeing >= all
    };
    matches.iter().map(agrees).collect()
}

/// How rows of matches lie, by the small turn of the right camera that explains most of them.
#[derive(Clone, Copy, Debug)]
pub struct RowFit {
    /// The turn.
    pub alignment: RowAlignment<f64>,
    /// How many times as large as the left picture the right one is.
    pub scale: f64,
    /// The share of the matches whose rows are then the same, up to a pixel.
    pub agreeing: f64,
    /// The share of those whose rows are then about the same.
    about: f64,
    /// The share of those whose rows are the same as they are.
    unturned: f64,
    /// By what share more the right picture is larger, as what is left over of rows says, and its deviation.
    larger: [f64; 2],
    /// How many matches there are.
    pub matches: usize,
}

impl RowFit {
    /// Of matches in about the same rows, of pictures by a camera. `None` where there are too few.
    pub fn of(matches: &[Correspondence<f64>], camera: &Camera<f64>) -> Option<Self> {
        Self::at_scale(matches, camera, 1.0)
    }

    /// The fit of the same matches with the scale of the right picture that they say: of up to a tenth larger
    /// or smaller one that clearly more agree with, as exactly as what is left over of their rows tells.
    pub fn with_scale(&self, matches: &[Correspondence<f64>], camera: &Camera<f64>) -> Option<Self> {
        let scales = (-10..=10).map(|step| 1.0 + 0.01 * f64::from(step));
        let fits = scales.filter_map(|scale| Self::at_scale(matches, camera, scale));
        let most = fits.max_by(|a, b| a.agreeing.total_cmp(&b.agreeing));
        let begin = most.filter(|most| most.is_gain(most.agreeing - self.agreeing)).unwrap_or(*self);
        let again = |fit: Self, _| Self::at_scale(matches, camera, fit.scale * (1.0 + fit.larger[0]));
        (0..3).try_fold(begin, again)
    }

    /// The root mean square of what the scale does to the rows of a picture that is so high, px, and its
    /// deviation.
    pub fn by_scale_px(&self, height: u16) -> [f64; 2] {
        // The mean square of a row is a twelfth of the height's square.
        [(self.scale - 1.0).abs(), self.larger[1]].map(|share| share * f64::from(height) / 12.0_f64.sqrt())
    }

    fn at_scale(matches: &[Correspondence<f64>], camera: &Camera<f64>, scale: f64) -> Option<Self> {
        let ((_, fy), (cx, cy)) = (camera.focal_px(), camera.principal_point());
        let middle = Point2::new(cx, cy);
        let of_one_size = |s: &Correspondence<f64>| Correspondence {
            first: s.first,
            second: middle + (s.second - middle) / scale,
        };
        let matches: Vec<_> = matches.iter().map(of_one_size).collect();
        let mut meter = RowMeter::new();
        meter.add(camera, &matches).ok()?;
        let alignment = meter.alignment().ok()?;
        let turn = Vector3::from(alignment.rotation_rad);
        let left_over = |s: &Correspondence<f64>| {
            let there = camera.unproject(&s.second).ok();
            // What is seen at P + w x P is to be at P.
            let back = there.map(|there| there - turn.cross(&there)).filter(|back| back.z > 0.0);
            back.map_or(f64::INFINITY, |back| fy * back.y / back.z + cy - s.first.y)
        };
        let left_over: Vec<_> = matches.iter().map(left_over).collect();
        let share =
            |px: f64| left_over.iter().filter(|off| off.abs() <= px).count() as f64 / matches.len() as f64;
        let larger = slope(matches.iter().map(|s| s.first.y - cy).zip(left_over.iter().copied()));
        let (agreeing, about) = (share(SAME_ROW_PX), share(ABOUT_SAME_ROW_PX));
        let is_unturned = |s: &&Correspondence<f64>| (s.second.y - s.first.y).abs() <= SAME_ROW_PX;
        let unturned = matches.iter().filter(is_unturned).count() as f64 / matches.len() as f64;
        Some(Self { alignment, scale, agreeing, about, unturned, larger, matches: matches.len() })
    }

    /// Whether matches agree on the turn: over half of them by two deviations of such a share, or by as many
    /// as say anything more than without it. Where most are wrong, any turn explains some.
    pub fn is_agreed(&self) -> bool {
        self.is_of_most() || self.is_gain(self.agreeing - self.unturned)
    }

    /// Whether over half of the matches agree on the turn.
    pub fn is_of_most(&self) -> bool {
        self.is_most(self.agreeing)
    }

    fn is_gain(&self, share: f64) -> bool {
        share * self.matches as f64 >= FEWEST as f64
    }

    /// Whether most have about the same rows.
    pub(super) fn is_about_agreed(&self) -> bool {
        self.is_most(self.about)
    }

    fn is_most(&self, share: f64) -> bool {
        share > 0.5 + 1.0 / (self.matches as f64).sqrt()
    }
}

/// The slope through zero of some numbers over their places, and its deviation: what is off by over a pixel
/// counts little (Geman & McClure 1987).
fn slope(numbers: impl Iterator<Item = (f64, f64)>) -> [f64; 2] {
    let [mut weights, mut squares, mut products, mut off] = [0.0; 4];
    for (at, number) in numbers.filter(|(_, number)| number.is_finite()) {
        let near = 1.0 / (1.0 + (number / SAME_ROW_PX).powi(2));
        let weight = near * near;
        weights += weight;
        squares += weight * at * at;
        products += weight * at * number;
        off += weight * number * number;
    }
    if squares > 0.0 { [products / squares, (off / weights / squares).sqrt()] } else { [0.0; 2] }
}
