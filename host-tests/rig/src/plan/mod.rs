//! What a rig of two cameras can tell, and what it takes, before it is built.
//!
//! In: a [`Rig`] and what is [`Wanted`] of it. Out: a [`Plan`]: the search, the depths with their deviations,
//! the field that both cameras see, memory and an estimate of the work on each core, what limits it, and what
//! to change.
//!
//! * `measured`: the figures of firmware. `work`: the estimate from them.
//! * `advice`: what limits, and what would help. `words`: the plan as text. [`describe_search`]: the same
//!   words of a rig that is there, whose search is given.

mod advice;
mod measured;
mod words;
mod work;

pub use words::describe_search;
pub use work::{CORES, Tables, Work};

use crate::calibration::Reach;
use crate::method::MethodName;
use serde::Serialize;
use stereopsis::geometry::camera::ImageSize;
use stereopsis::matching::Config;

/// Two cameras side by side, rectified.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Rig {
    /// The distance between the cameras, m.
    pub baseline_m: f64,
    /// Their focal length, px.
    pub focal_px: f64,
    /// What is added to a disparity before it divides, px: 0 where the principal points agree.
    pub offset_px: f64,
    /// Columns of their images.
    pub width: u16,
    /// Rows.
    pub height: u16,
}

/// What is wanted of a rig; by default nothing.
#[derive(Clone, PartialEq, Debug, Default, Serialize)]
pub struct Wanted {
    /// The nearest depth, m.
    pub nearest_m: f64,
    /// The farthest, m.
    pub farthest_m: f64,
    /// The deviation of a depth there, at most, as a share of it.
    pub accuracy: f64,
    /// Frames in a second, at least.
    pub frames_per_s: Option<f64>,
    /// Bytes of RAM, at most.
    pub ram_bytes: Option<usize>,
    /// The cores and their clocks, MHz.
    pub cores: Vec<(&'static str, f64)>,
    /// The methods.
    pub methods: Vec<&'static str>,
}

/// The search of a plan. Names are those of `match`'s options.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
pub struct Search {
    /// How many whole disparities.
    pub disparities: u16,
    /// The smallest one, px.
    pub min_disparity: u16,
    /// How many disparities the wanted range takes, in steps of 16; more than the others where they are not
    /// to be had.
    pub needed: u32,
}

/// A depth and how well it is told.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Depth {
    /// The depth, m.
    pub depth_m: f64,
    /// Its disparity, px.
    pub disparity_px: f64,
    /// Its standard deviation, m.
    pub sigma_m: f64,
    /// The share of the image's columns that both cameras see at this depth.
    pub overlap: f64,
    /// How wide that is, m.
    pub overlap_m: f64,
}

/// What a rig can tell and what it takes. Names are those of `stereo plan --json`.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Plan {
    /// The rig.
    pub rig: Rig,
    /// What is wanted of it.
    pub wanted: Wanted,
    /// The horizontal and the vertical field of view of one camera, degrees.
    pub field_of_view_deg: [f64; 2],
    /// The search.
    pub search: Search,
    /// The standard deviation of a disparity that is reckoned with, px: that of the methods away from depth
    /// edges.
    pub sigma_px: f64,
    /// The nearest depth that is told, m.
    pub nearest_m: f64,
    /// The depth up to which the wanted accuracy is had, m.
    pub reach_m: f64,
    /// The depth beyond which nothing is told, m; absent where the search reaches infinity.
    pub end_m: Option<f64>,
    /// Depths of the wanted range.
    pub depths: Vec<Depth>,
    /// What each method takes on each core: estimates.
    pub work: Vec<Work>,
    /// What is wanted and not had, in words; nothing where all is.
    pub limits: Vec<String>,
    /// What would help, in words.
    pub changes: Vec<String>,
}

impl Rig {
    /// Focal length x baseline, px m.
    fn fb_px_m(&self) -> f64 {
        self.focal_px * self.baseline_m
    }

    /// The disparity of a depth, px.
    fn disparity_px(&self, depth_m: f64) -> f64 {
        self.fb_px_m() / depth_m - self.offset_px
    }

    /// The angle that so many pixels about the centre span, degrees.
    fn angle_deg(&self, pixels: u16) -> f64 {
        2.0 * (f64::from(pixels) / 2.0 / self.focal_px).atan().to_degrees()
    }

    /// The most disparities that can be searched.
    fn most_disparities(&self) -> u16 {
        self.width.min(Config::MOST_DISPARITIES) / STEP * STEP
    }
}

/// Disparities are searched in multiples of this.
const STEP: u16 = 16;
/// Whole disparities beyond the ends of the range: an answer at the largest one is refused, and one at the
/// smallest has nothing on its other side.
const MARGIN_PX: f64 = 1.0;

impl Search {
    /// The search for a range of depths. What rounding adds is spent on the far side, down to infinity.
    pub fn of(rig: &Rig, nearest_m: f64, farthest_m: f64) -> Self {
        let first = (rig.disparity_px(farthest_m).floor() - MARGIN_PX).max(0.0);
        let last = rig.disparity_px(nearest_m).ceil() + MARGIN_PX;
        let steps = ((last - first + 1.0) / f64::from(STEP)).ceil().clamp(1.0, 1e6);
        let needed = steps as u32 * u32::from(STEP);
        let disparities = u16::try_from(needed).unwrap_or(u16::MAX).min(rig.most_disparities());
        let min = if needed == u32::from(disparities) { last + 1.0 - f64::from(disparities) } else { first };
        let most = rig.width.min(Config::END).saturating_sub(disparities);
        Self { disparities, min_disparity: min.clamp(0.0, f64::from(most)) as u16, needed }
    }

    /// The depth beyond which nothing is told, m; `None` where that is beyond all.
    fn end_m(&self, rig: &Rig) -> Option<f64> {
        let parallax = f64::from(self.min_disparity) + rig.offset_px;
        (parallax > 0.0).then(|| rig.fb_px_m() / parallax)
    }

    /// The depths that it tells.
    fn reach(&self, rig: &Rig) -> Reach {
        let Self { disparities, min_disparity, .. } = *self;
        let (fb_px_m, sigma_px) = (rig.fb_px_m(), Reach::SIGMA_PX);
        Reach { fb_px_m, offset_px: rig.offset_px, min_disparity, disparities, sigma_px }
    }
}

impl Plan {
    /// The plan of a rig whose sides are those of an image that can be matched.
    pub fn new(rig: Rig, wanted: Wanted) -> Self {
        let search = Search::of(&rig, wanted.nearest_m, wanted.farthest_m);
        let reach = search.reach(&rig);
        let told = distances(wanted.nearest_m, wanted.farthest_m).into_iter().filter(|z| reach.tells(*z));
        let depths = told.map(|depth_m| Depth::of(&rig, &reach, depth_m)).collect();
        let size = ImageSize { width: rig.width, height: rig.height };
        let tables = Tables::read();
        let methods: Vec<MethodName> = wanted.methods.iter().filter_map(|name| name.parse().ok()).collect();
        let each = wanted.cores.iter().flat_map(|core| methods.iter().map(move |method| (core, *method)));
        let work = each.filter_map(|(&(core, clock_mhz), method)| {
            tables.work(core, clock_mhz, method, size, search.disparities)
        });
        let mut plan = Self {
            field_of_view_deg: [rig.angle_deg(rig.width), rig.angle_deg(rig.height)],
            search,
            sigma_px: reach.sigma_px,
            nearest_m: reach.nearest_m().unwrap_or(f64::INFINITY),
            reach_m: reach.within_m(wanted.accuracy),
            end_m: search.end_m(&rig),
            depths,
            work: work.collect(),
            limits: Vec::new(),
            changes: Vec::new(),
            rig,
            wanted,
        };
        (plan.limits, plan.changes) = advice::of(&plan, &tables);
        plan
    }
}

impl Depth {
    fn of(rig: &Rig, reach: &Reach, depth_m: f64) -> Self {
        let disparity_px = reach.disparity_px(depth_m);
        let columns = (f64::from(rig.width) - disparity_px).max(0.0);
        Self {
            depth_m,
            disparity_px,
            sigma_m: reach.sigma_m(depth_m),
            overlap: columns / f64::from(rig.width),
            overlap_m: columns * depth_m / rig.focal_px,
        }
    }
}

/// Both ends of a range, and 1, 2 and 5 times the powers of ten between them.
fn distances(nearest_m: f64, farthest_m: f64) -> Vec<f64> {
    let powers = (-4..6).flat_map(|power| [1.0, 2.0, 5.0].map(|n: f64| n * 10f64.powi(power)));
    // An end's neighbour would say the same.
    let between = powers.filter(|z| (1.1 * nearest_m..=farthest_m / 1.1).contains(z));
    [nearest_m].into_iter().chain(between).chain([farthest_m]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 500 px x 0.1 m = 50 px m.
    const RIG: Rig = Rig { baseline_m: 0.1, focal_px: 500.0, offset_px: 0.0, width: 640, height: 480 };

    #[test]
    fn a_search_covers_the_range() {
        // 50 px at 1 m, and 1 px more on that side; 16 disparities less would end at 48.
        let whole = Search { disparities: 64, min_disparity: 0, needed: 64 };
        assert_eq!(Search::of(&RIG, 1.0, 50.0), whole);
        // 20 px at 2.5 m to 10 px at 5 m, from 9 to 21 px: a step of 16 that ends with the last.
        let part = Search { disparities: 16, min_disparity: 6, needed: 16 };
        assert_eq!(Search::of(&RIG, 2.5, 5.0), part);
        // 500 px at 0.1 m.
        let most = Search { disparities: 256, min_disparity: 0, needed: 512 };
        assert_eq!(Search::of(&RIG, 0.1, 50.0), most);
        // 50 px of parallax at 1 m are 40 px of disparity with an offset of 10.
        let offset = Search::of(&Rig { offset_px: 10.0, ..RIG }, 1.0, 2.5);
        assert_eq!(offset, Search { disparities: 48, min_disparity: 0, needed: 48 });
        // No more than the image is wide.
        assert_eq!(Search::of(&Rig { width: 40, ..RIG }, 0.5, 50.0).disparities, 32);
    }

    #[test]
    fn the_cameras_see_less_of_what_is_near() {
        let reach = Search::of(&RIG, 1.0, 50.0).reach(&RIG);
        let near = Depth::of(&RIG, &reach, 1.0);
        assert_eq!((near.disparity_px, near.overlap_m), (50.0, 1.18));
        assert!((near.overlap - 590.0 / 640.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_beyond_the_end_of_a_search_is_named() {
        // 50 px m and an offset of 10 px: 5 m is at a disparity of 0, and 20 m 7.5 px below.
        let rig = Rig { offset_px: 10.0, ..RIG };
        let plan = |rig: Rig, farthest_m: f64| {
            Plan::new(rig, Wanted { nearest_m: 1.0, farthest_m, accuracy: 1.0, ..Wanted::default() })
        };
        let beyond = plan(rig, 20.0);
        assert_eq!(beyond.end_m, Some(5.0));
        let limit = "the search: 20 m is at a disparity of -7.5 px, below 0; nothing is told beyond 5.00 m";
        assert_eq!(beyond.limits[0], limit);
        assert_eq!(beyond.changes[0], "images with the same principal point would reach infinity");
        for sound in [plan(rig, 5.0), plan(RIG, 20.0)] {
            assert!(sound.limits.iter().all(|limit| !limit.contains("below 0")), "{:?}", sound.limits);
        }
    }

    #[test]
    fn distances_end_with_the_range() {
        assert_eq!(distances(0.3, 5.2), [0.3, 0.5, 1.0, 2.0, 5.2]);
    }
}
