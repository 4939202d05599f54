//! One camera's first two views.

use super::config::OdometryRig;
use super::engine::{FEWEST, Odometry};
use super::frame::Frame;
use super::inverse_depth::PointObservation;
use super::pose_estimate::{Free, PointMatch, Problem, Solved};
use super::step::{State, Step};
use super::track::UPRIGHT;
use super::tracking::ALIKE;
use crate::geometry::linear::covariance6;
use crate::geometry::{
    Real,
    camera::{Camera, Pose},
    robust::{RobustConfig, RobustError, robust_fundamental},
    two_view::{Correspondence, Essential, Homography},
};
use heapless::Vec;
use nalgebra::{Matrix6, Point2, Vector3};

/// The threshold of the fundamental matrix, px.
const THRESHOLD_PX: f64 = 1.5;
/// How far points have to be off where a turn puts them, px, in the mean, before a step is looked for.
const PARALLAX_PX: f64 = 3.0;
/// The share that has to agree with the two views, and to be in front of both.
const AGREE: f64 = 0.6;
/// The most that is left of a turn's observations, squared deviations.
const MOST_SCALE: f64 = 1.4;
/// The share of the points that have to be left in view; below it the first view is another one.
const LEFT: f64 = 0.4;
/// Inverse depths that are expected, in baselines, and their deviation.
const USUAL: f64 = 0.1;

impl<T: Real, const N: usize> Odometry<T, N> {
    pub(super) fn initialize(&mut self, rig: &OdometryRig<T>, frame: &Frame<'_>) -> Step<T> {
        let points = self.points();
        let sigma = T::of(self.config.sigma_px.into()) / rig.focal();
        // Inverse depths of nothing until there is a unit: a turn alone moves the points.
        for track in self.tracks.iter_mut().filter(|track| track.used) {
            track.point = super::engine::at_infinity(&track.point, sigma);
        }
        let told = self.reported_pose;
        self.recognise(rig, frame.features, &told, self.config.far_px);
        self.pair_in_picture(rig, frame, sigma);
        let found = self.matches.len();
        let problem = Problem { matches: &self.matches, baseline: T::ZERO };
        let turned = problem.solve(told, Free::Rotation);
        let enough = T::count(points) * T::of(LEFT);
        let shown = Step { points, found, ..Step::none(State::Waiting) };
        if found < 2 * FEWEST {
            return self.again(rig, frame, shown);
        }
        let still = problem.solve(told, Free::Nothing);
        let scale = (turned.squares / T::count(turned.numbers.saturating_sub(3).max(1))).max(T::of(0.05));
        // A wall that is passed moves nearly as by a turn: what is left has to be noise.
        let of_turn = T::count(turned.kept) >= T::count(found) * T::of(0.85) && scale < T::of(MOST_SCALE);
        let step = if of_turn {
            let no_turn = (still.cost - turned.cost) / scale < T::of(21.0);
            let state = if no_turn && scale < T::of(2.0) { State::Stationary } else { State::RotationOnly };
            self.report_rotation(
                if state == State::Stationary { told } else { turned.pose },
                &turned,
                state,
                shown,
            )
        } else {
            let wide = Problem { matches: &self.matches, baseline: T::ZERO };
            if let Some(pose) =
                two_views::<T, N>(rig, &wide, &turned.pose, self.config.seed, &mut self.inliers)
            {
                return self.begun(rig, frame, &pose, sigma, shown);
            }
            shown
        };
        if T::count(found) < enough {
            return self.again(rig, frame, step);
        }
        step
    }

    /// A turn that is known, since the last frame.
    fn report_rotation(
        &mut self,
        pose: Pose<T>,
        solved: &Solved<T>,
        state: State,
        shown: Step<T>,
    ) -> Step<T> {
        let motion = self.reported_pose.inverse().then(&pose);
        self.reported_pose = pose;
        let mut of_turn = Matrix6::identity() * T::of(1e12);
        let all = covariance6(&solved.information);
        of_turn.fixed_view_mut::<3, 3>(0, 0).copy_from(&all.fixed_view::<3, 3>(0, 0));
        if state == State::Stationary {
            of_turn = all;
        }
        let residual = (solved.squares / T::count(solved.numbers.max(1))).sqrt();
        Step { motion, covariance: of_turn, state, inliers: solved.kept, residual, ..shown }
    }

    /// Finds each recognised point by its pixels.
    fn pair_in_picture(&mut self, rig: &OdometryRig<T>, frame: &Frame<'_>, sigma: T) {
        self.matches.clear();
        for (owner, track) in (0_u16..).zip(self.tracks.iter_mut()) {
            let Some(at) = track.now.filter(|_| track.used) else { continue };
            let aligned =
                track.template.align(&frame.left, &UPRIGHT, at, 3.0).ok().filter(|a| a.correlation > ALIKE);
            let now = aligned.map_or(at, |a| [a.x_px, a.y_px]);
            track.now = Some(now);
            let Ok(observation) =
                rig.camera.unproject(&Point2::new(T::of(now[0].into()), T::of(now[1].into())))
            else {
                continue;
            };
            // A corner is three times as far off as what its pixels say.
            let sigma = if aligned.is_some() { sigma } else { sigma * T::of(3.0) };
            let observation = PointObservation { at: observation, in_right: false, sigma };
            let _ = self.matches.push(PointMatch { point: track.point, observation, owner });
        }
    }

    /// The unit of length is the way to this frame.
    fn begun(
        &mut self,
        rig: &OdometryRig<T>,
        frame: &Frame<'_>,
        pose: &Pose<T>,
        sigma: T,
        shown: Step<T>,
    ) -> Step<T> {
        for point_match in self.matches.iter_mut() {
            let observation = Vector3::new(point_match.point.at.x, point_match.point.at.y, T::ONE);
            point_match.point = super::engine::unknown(observation, T::of(USUAL), sigma);
            point_match.point.covariance.m33 *= T::of(9.0);
            if let Some(track) = self.tracks.get_mut(usize::from(point_match.owner)) {
                track.point = point_match.point;
            }
        }
        // Points that were not found have no depth.
        for (number, track) in (0_u16..).zip(self.tracks.iter_mut()) {
            track.used = track.used && self.matches.iter().any(|p| p.owner == number);
        }
        let judged =
            |matches: &[PointMatch<T>]| Problem { matches, baseline: T::ZERO }.solve(*pose, Free::Nothing);
        let solved = judged(&self.matches);
        let motion = self.reported_pose.inverse().then(pose);
        self.carry(rig, frame, &solved, &Matrix6::zeros());
        // The pose by the points that it has given a depth.
        for point_match in self.matches.iter_mut() {
            if let Some(point) = point_match.point.updated(pose, &point_match.observation, T::ZERO) {
                point_match.point = point;
            }
        }
        let solved = judged(&self.matches);
        self.begun = true;
        self.reported_pose = Pose::identity();
        self.velocity = Some(*pose);
        self.add_new_points(rig, frame);
        let covariance = covariance6(&solved.information);
        let residual = (solved.squares / T::count(solved.numbers.max(1))).sqrt();
        Step { motion, covariance, state: State::Tracked, inliers: solved.kept, residual, ..shown }
    }

    /// This view becomes the first one.
    fn again(&mut self, rig: &OdometryRig<T>, frame: &Frame<'_>, step: Step<T>) -> Step<T> {
        self.tracks.iter_mut().for_each(|track| track.used = false);
        self.reported_pose = Pose::identity();
        self.add_new_points(rig, frame);
        let state = if step.state == State::Waiting { State::Restarted } else { step.state };
        Step { points: self.points(), state, ..step }
    }
}

/// The pose of the second view in units of the baseline, if it is sure.
fn two_views<T: Real, const N: usize>(
    rig: &OdometryRig<T>,
    problem: &Problem<'_, T>,
    turn: &Pose<T>,
    seed: u64,
    inliers: &mut [bool],
) -> Option<Pose<T>> {
    let focal = rig.focal();
    let pinhole = Camera::new(focal, focal, T::ZERO, T::ZERO).ok()?;
    let mut seen: Vec<Correspondence<T>, N> = Vec::new();
    let mut off = T::ZERO;
    for point_match in problem.matches {
        let (a, b) = (point_match.point.at * focal, point_match.observation.at * focal);
        let _ = seen.push(Correspondence::new(a.x, a.y, b.x, b.y));
        if let Some(moved) = point_match.point.moved(turn) {
            off += ((moved.at - point_match.observation.at).xy() * focal).norm().min(T::of(20.0));
        }
    }
    if off < T::count(seen.len()) * T::of(PARALLAX_PX) {
        return None;
    }
    let config = RobustConfig { seed, most_samples: 2000, ..RobustConfig::new(T::of(THRESHOLD_PX)) };
    let found = robust_fundamental(&seen, &config, inliers);
    let kept = || seen.iter().zip(inliers.iter()).filter(|&(_, &inlier)| inlier).map(|(s, _)| *s);
    let agreeing = T::count(kept().count());
    if agreeing < T::count(seen.len()) * T::of(AGREE) {
        return None;
    }
    let essential = match found {
        Ok(found) => Essential::from_fundamental(&found.fundamental, &pinhole, &pinhole).ok()?,
        Err(RobustError::Plane) => {
            let mut on_plane: Vec<Correspondence<T>, N> = Vec::new();
            kept().for_each(|s| on_plane.push(s).unwrap_or(()));
            let homography = Homography::from_correspondences(&on_plane).ok()?;
            let motions = homography.recover_motions(kept(), &pinhole, &pinhole).ok()?;
            // Two motions may have all points in front: only one that is alone is sure.
            let [(first, votes), (_, others)] = motions.first_chunk::<2>().copied()?;
            if votes == others {
                return None;
            }
            Essential::from_pose(&first.relative_pose()?.in_baselines()).ok()?
        }
        Err(_) => return None,
    };
    let refined = essential.refined(&seen, &pinhole, &pinhole, T::of(THRESHOLD_PX)).ok()?;
    let recovered = refined.recover_pose(kept(), &pinhole, &pinhole).ok()?;
    let front = T::count(recovered.in_front);
    (front >= T::count(recovered.voters) * T::of(0.8) && front >= agreeing * T::of(0.5))
        .then(|| recovered.pose.in_baselines())
}
