//! Sliding-window bundle adjustment of the last views.

use super::config::OdometryRig;
use super::observed::ObservedPoint;
use crate::geometry::{Real, camera::Pose};
use crate::motion::bundle::{
    BundleConfig, BundleError, BundleReport, Gauge, Loss, RectifiedView, View, Window,
};
use heapless::Vec;
use nalgebra::{Point2, Point3};

/// The last `VIEWS` views at most, with up to `POINTS` of the points that they saw.
///
/// An odometry says of each frame what is known when it comes. What comes after it says more: here the last
/// views and points are adjusted together with each new one ([`bundle`](crate::motion::bundle)), and
/// [`Self::poses`] are better than the steps that were reported. It stands beside the odometry, which costs
/// nothing more without it.
#[derive(Debug)]
pub struct Refinement<T: Real, const VIEWS: usize, const POINTS: usize, const OBSERVATIONS: usize> {
    config: RefinementConfig<T>,
    /// The rig at the origin, when there is one.
    view: Vec<RectifiedView<T>, 1>,
    /// Where the views stand in the frame of the oldest.
    poses: Vec<Pose<T>, VIEWS>,
    rows: [Row<T, VIEWS>; POINTS],
    /// Where the row of the point with this place in the odometry's memory is, if it still has one.
    places: [u16; POINTS],
    /// The row of each point that is adjusted.
    owners: Vec<u16, POINTS>,
    window: Window<RectifiedView<T>, T, 6, VIEWS, POINTS, OBSERVATIONS>,
}

/// How views are refined.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RefinementConfig<T> {
    /// Views that are adjusted together, two at least, up to the capacity.
    pub views: usize,
    /// How many of them, the oldest ones, are held where they are, one at least.
    pub held: usize,
    /// From this residual on an observation counts less (Huber's loss), px.
    pub width_px: T,
    /// Steps at most.
    pub most_iterations: u32,
}

impl<T: Real> RefinementConfig<T> {
    /// A window of `views` views whose oldest is held; its loss is of 0.1 px, its steps five.
    pub fn new(views: usize) -> Self {
        Self { views, held: 1, width_px: T::of(0.1), most_iterations: 5 }
    }
}

/// A point and where the views see it.
#[derive(Clone, Copy, Debug)]
struct Row<T: Real, const VIEWS: usize> {
    name: (u16, u16),
    /// In the frame of the oldest view.
    point: Point3<T>,
    /// Column, row and disparity, px.
    observations: [[T; 3]; VIEWS],
    /// Bit by bit the views that see it, and those with a disparity.
    seen: u16,
    deep: u16,
}

/// What was seen has to be so near to where the point is before it is adjusted, px.
const OFF_PX: f64 = 8.0;
/// Points that a view has in common with those before it; with fewer it is the first one again.
const COMMON: usize = 16;
/// Points are not farther away than so many units: what is at infinity has no coordinates.
const FAR: f64 = 1e4;

impl<T: Real, const VIEWS: usize> Row<T, VIEWS> {
    const EMPTY: Self = {
        let o = T::ZERO;
        Self { name: (0, 0), point: Point3::new(o, o, o), observations: [[o; 3]; VIEWS], seen: 0, deep: 0 }
    };

    /// What a view's eye sees, if it does.
    fn observation(&self, view: usize, eye: u16) -> Option<Point2<T>> {
        let [u, v, d] = *self.observations.get(view)?;
        let (mask, pixel) =
            if eye == 0 { (self.seen, Point2::new(u, v)) } else { (self.deep, Point2::new(d, T::ZERO)) };
        (mask >> view & 1 == 1).then_some(pixel)
    }
}

impl<T: Real, const VIEWS: usize, const POINTS: usize, const OBSERVATIONS: usize>
    Refinement<T, VIEWS, POINTS, OBSERVATIONS>
{
    /// Empty: waits for [`Self::start`].
    pub const fn new() -> Self {
        const { assert!(VIEWS >= 2 && VIEWS <= 16, "2 to 16 views are adjusted together") };
        const { assert!(POINTS <= u16::MAX as usize, "points are told by 16 bits") };
        Self {
            config: RefinementConfig { views: 0, held: 0, width_px: T::ZERO, most_iterations: 0 },
            view: Vec::new(),
            poses: Vec::new(),
            rows: [Row::EMPTY; POINTS],
            places: [0; POINTS],
            owners: Vec::new(),
            window: Window::new(),
        }
    }

    /// Begins with a rig, without a view.
    pub fn start(&mut self, rig: &OdometryRig<T>, config: RefinementConfig<T>) {
        self.view.clear();
        let _ = self.view.push(RectifiedView {
            camera: rig.camera,
            baseline: rig.baseline(),
            pose: Pose::identity(),
        });
        self.config = config;
        self.clear();
    }

    /// Forgets all views.
    pub fn clear(&mut self) {
        self.poses.clear();
        self.rows.iter_mut().for_each(|row| row.seen = 0);
    }

    /// Where the views stand in the frame of the oldest, the oldest first: P = R P' + t.
    pub fn poses(&self) -> &[Pose<T>] {
        &self.poses
    }

    /// Takes the next view, which stands at about `motion` from the last one, and adjusts; `None` of a first
    /// view, or of one that has fewer than 16 points in common with those before it and so begins anew.
    ///
    /// The work is bounded: `POINTS` times what is seen, and the iterations.
    pub fn push(
        &mut self,
        motion: &Pose<T>,
        seen: impl Iterator<Item = ObservedPoint<T>>,
    ) -> Result<Option<BundleReport<T>>, BundleError> {
        if self.poses.len() >= self.config.views.clamp(2, VIEWS) {
            self.drop_oldest();
        }
        let pose = self.poses.last().map_or_else(Pose::identity, |last| last.then(motion));
        let view = self.poses.len();
        // There is room: the oldest has gone.
        let _ = self.poses.push(pose);
        let (mut common, mut free) = (0, 0);
        for point in seen {
            common += usize::from(self.note(view, &pose, &point, &mut free));
        }
        if view == 0 {
            return Ok(None);
        }
        if common < COMMON {
            self.only_last(&pose);
            return Ok(None);
        }
        self.adjust().map(Some)
    }

    /// The second view becomes the frame.
    fn drop_oldest(&mut self) {
        let Some(&base) = self.poses.get(1) else { return };
        let back = base.inverse();
        let mut poses = Vec::new();
        let _ = poses.push(Pose::identity());
        for pose in self.poses.iter().skip(2) {
            let _ = poses.push(back.then(pose).orthonormal());
        }
        self.poses = poses;
        for row in self.rows.iter_mut().filter(|row| row.seen != 0) {
            row.point = base.inverse_transform(&row.point);
            (row.seen, row.deep) = (row.seen >> 1, row.deep >> 1);
            row.observations.rotate_left(1);
        }
    }

    /// The last view becomes the first one.
    fn only_last(&mut self, pose: &Pose<T>) {
        let last = self.poses.len().saturating_sub(1);
        self.poses.clear();
        let _ = self.poses.push(Pose::identity());
        for row in &mut self.rows {
            (row.seen, row.deep) = (row.seen >> last & 1, row.deep >> last & 1);
            row.point = pose.inverse_transform(&row.point);
            row.observations.rotate_left(last.min(VIEWS));
        }
    }

    /// The row of a point, if it has one.
    fn row_of(&self, name: (u16, u16)) -> Option<usize> {
        let is_its = |row: &Row<T, VIEWS>| row.seen != 0 && row.name == name;
        match self.places.get(usize::from(name.0)) {
            Some(&place) => self.rows.get(usize::from(place)).filter(|row| is_its(row)).map(|_| place.into()),
            // The odometry has more points than there are rows.
            None => self.rows.iter().position(is_its),
        }
    }

    /// Keeps a view's observation of a point, if there is room, and says whether the point was seen before.
    /// All rows before `free` are taken.
    fn note(&mut self, view: usize, pose: &Pose<T>, point: &ObservedPoint<T>, free: &mut usize) -> bool {
        let known = self.row_of(point.name);
        if known.is_none() {
            *free += self.rows.iter().skip(*free).take_while(|row| row.seen != 0).count();
            if let Some(place) = self.places.get_mut(usize::from(point.name.0)) {
                // POINTS is within 16 bits.
                *place = *free as u16;
            }
        }
        let Some(row) = self.rows.get_mut(known.unwrap_or(*free)) else { return false };
        if known.is_none() {
            (row.name, row.deep) = (point.name, 0);
        }
        // The odometry's depth is better than none; once it was adjusted it has its own.
        if row.seen.count_ones() < 2 {
            let depth = T::ONE / point.inverse.z.max(T::of(1.0 / FAR));
            let own = Point3::new(point.inverse.x * depth, point.inverse.y * depth, depth);
            row.point = pose.transform(&own);
        }
        if let Some(observation) = row.observations.get_mut(view) {
            *observation = [point.pixel.x, point.pixel.y, point.disparity_px.unwrap_or(T::ZERO)];
            row.seen |= 1 << view;
            row.deep |= u16::from(point.disparity_px.is_some()) << view;
        }
        known.is_some()
    }

    fn adjust(&mut self) -> Result<BundleReport<T>, BundleError> {
        let Some(rig) = self.view.first() else { return Err(BundleError::Empty) };
        self.window.clear();
        self.owners.clear();
        for pose in &self.poses {
            let _ = self.window.add_view(rig.with_pose(*pose));
        }
        let most = T::of(OFF_PX * OFF_PX);
        let mut has_unit = false;
        for (number, row) in (0_u16..).zip(&self.rows) {
            let near = |pose: &Pose<T>, eye: u16, observation: &Point2<T>| {
                let expected = rig.with_pose(*pose).project(eye, &row.point);
                expected.is_ok_and(|expected| (expected - observation).norm_squared() < most)
            };
            let good = |view: usize, pose: &Pose<T>, eye: u16| {
                row.observation(view, eye).filter(|observation| near(pose, eye, observation))
            };
            let views = || self.poses.iter().enumerate();
            // Two observations without a disparity agree with nearly any motion, also with one of the point's
            // own.
            let enough = if row.deep != 0 { 2 } else { self.poses.len().min(3) };
            if views().filter(|&(view, pose)| good(view, pose, 0).is_some()).count() < enough {
                continue;
            }
            if self.window.add_point(row.point).is_err() {
                break;
            }
            let _ = self.owners.push(number);
            for (view, pose) in views() {
                for eye in 0..2 {
                    let Some(observation) = good(view, pose, eye) else { continue };
                    has_unit |= eye == 1;
                    let _ = self.window.add_observation(view as u16, eye, observation);
                }
            }
        }
        let views = self.poses.len() as u16;
        let held = (self.config.held as u16).clamp(1, views - 1);
        let gauge = if has_unit || held > 1 {
            Gauge::Views(0..held)
        } else {
            // Of one camera a distance is held as well, if one of the views adjusted before has moved.
            let before = self.poses.get(..self.poses.len().saturating_sub(1).max(2)).unwrap_or(&[]);
            Gauge::longest_baseline(before).unwrap_or(Gauge::Views(0..views - 1))
        };
        let config = BundleConfig {
            loss: Loss::Huber(self.config.width_px),
            most_iterations: self.config.most_iterations,
            cost_tolerance: T::of(1e-4),
            ..BundleConfig::new(gauge)
        };
        let report = self.window.adjust(config)?;
        for (pose, view) in self.poses.iter_mut().zip(self.window.views()) {
            *pose = *view.pose();
        }
        for (&owner, point) in self.owners.iter().zip(self.window.points()) {
            if let Some(row) = self.rows.get_mut(usize::from(owner)) {
                row.point = *point;
            }
        }
        Ok(report)
    }
}

impl<T: Real, const VIEWS: usize, const POINTS: usize, const OBSERVATIONS: usize> Default
    for Refinement<T, VIEWS, POINTS, OBSERVATIONS>
{
    fn default() -> Self {
        Self::new()
    }
}
