//! A bundle adjustment problem with its workspace, for a `static`.

use super::adjust::{Adjustment, BundleConfig, BundleReport, adjust};
use super::covariance::{CovarianceError, Covariances};
use super::gauge::Gauge;
use super::loss::Loss;
use super::problem::{BundleError, Observation, Problem};
use super::view::View;
use super::workspace::{BundleWorkspace, BundleWorkspaceView};
use crate::geometry::Real;
use core::ops::ControlFlow;
use nalgebra::{Point2, Point3};

/// A problem of up to so many views, points and observations, and all that adjusting it takes, for a
/// `static`: all zeros at first.
///
/// Views come first, then each point with its observations. With `CameraView<f32>`, 2 views, 128 points and
/// 256 observations are 8 KB.
///
/// ```
/// use nalgebra::{Matrix3, Point2, Point3, Vector3};
/// use stereopsis::geometry::camera::{Camera, Pose};
/// use stereopsis::motion::bundle::{BundleConfig, CameraView, Gauge, View, Window};
///
/// let camera = Camera::new(500.0, 500.0, 320.0, 240.0)?;
/// let pose = |x, z| Pose::new(Matrix3::identity(), Vector3::new(x, 0.0, z));
/// let at = |x, z| pose(x, z).map(|pose| CameraView { camera, pose });
/// let views = [at(0.0, 0.0)?, at(0.5, 0.1)?];
/// let mut window = Window::<CameraView<f64>, f64, 6, 2, 8, 16>::new();
/// window.add_view(views[0])?;
/// // Where the second one is thought to be: 2 cm beside the truth.
/// window.add_view(at(0.5, 0.12)?)?;
/// let near = [(-1.0, 0.5, 4.0), (1.0, -0.5, 5.0), (0.3, 0.8, 3.0)];
/// for (x, y, z) in near.into_iter().chain([(-0.6, -0.9, 6.0), (0.1, 0.2, 4.5), (0.9, 0.7, 7.0)]) {
///     let point = Point3::new(x, y, z);
///     window.add_point(point)?;
///     for (view, at) in (0..).zip(&views) {
///         window.add_observation(view, 0, at.project(0, &point)?)?;
///     }
/// }
/// // The first view is the frame; the half metre between the two is known.
/// let report = window.adjust(BundleConfig::new(Gauge::Baseline { held: 0, other: 1 }))?;
/// assert!(report.cost < 1e-9, "{report:?}");
/// let direction = window.views()[1].pose().translation().normalize();
/// assert!((direction - Vector3::new(0.5, 0.0, 0.1).normalize()).norm() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Window<
    V,
    T: Real,
    const N: usize,
    const VIEWS: usize,
    const POINTS: usize,
    const OBSERVATIONS: usize,
> {
    views: [V; VIEWS],
    points: [Point3<T>; POINTS],
    observations: [Observation<T>; OBSERVATIONS],
    /// Views, points and observations in use.
    counts: [usize; 3],
    workspace: BundleWorkspace<V, T, N, VIEWS, POINTS>,
}

/// Why something has no place in a window.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum WindowError {
    /// There are as many views as it holds; so many are needed.
    Views(usize),
    /// There are as many points as it holds; so many are needed.
    Points(usize),
    /// There are as many observations as it holds; so many are needed.
    Observations(usize),
    /// The observation's view has not been added.
    NoView,
    /// No point has been added that could be seen.
    NoPoint,
}

error_text!(WindowError {
    Self::Views(needed) => "the window needs room for {needed} views",
    Self::Points(needed) => "the window needs room for {needed} points",
    Self::Observations(needed) => "the window needs room for {needed} observations",
    Self::NoView => "the observation's view has not been added",
    Self::NoPoint => "a point must be added before its observations",
});

impl<V, T, const N: usize, const VIEWS: usize, const POINTS: usize, const OBSERVATIONS: usize>
    Window<V, T, N, VIEWS, POINTS, OBSERVATIONS>
where
    V: View<T, N>,
    T: Real,
{
    /// Empty.
    pub const fn new() -> Self {
        const { assert!(VIEWS > 0 && VIEWS <= 1 << 16, "a window holds 1 to 65536 views") };
        const { assert!(POINTS > 0 && OBSERVATIONS > 0, "a window holds points and observations") };
        let origin = Point3::new(T::ZERO, T::ZERO, T::ZERO);
        Self {
            views: [V::EMPTY; VIEWS],
            points: [origin; POINTS],
            observations: [Observation::EMPTY; OBSERVATIONS],
            counts: [0; 3],
            workspace: BundleWorkspace::EMPTY,
        }
    }

    /// Takes everything out.
    pub fn clear(&mut self) {
        self.counts = [0; 3];
    }

    /// Adds a view; its number.
    pub fn add_view(&mut self, view: V) -> Result<u16, WindowError> {
        let [views, ..] = &mut self.counts;
        *self.views.get_mut(*views).ok_or(WindowError::Views(*views + 1))? = view;
        *views += 1;
        // VIEWS is within 16 bits.
        Ok((*views - 1) as u16)
    }

    /// Adds a point, a guess of where it is in the world; its number.
    pub fn add_point(&mut self, point: Point3<T>) -> Result<usize, WindowError> {
        let [_, points, _] = &mut self.counts;
        *self.points.get_mut(*points).ok_or(WindowError::Points(*points + 1))? = point;
        *points += 1;
        Ok(*points - 1)
    }

    /// Adds where a view sees the point that was added last, px; `eye` is 1 for the second camera of a rig.
    pub fn add_observation(&mut self, view: u16, eye: u16, pixel: Point2<T>) -> Result<(), WindowError> {
        let [views, points, observations] = &mut self.counts;
        let point = points.checked_sub(1).ok_or(WindowError::NoPoint)? as u32;
        if usize::from(view) >= *views {
            return Err(WindowError::NoView);
        }
        *self.observations.get_mut(*observations).ok_or(WindowError::Observations(*observations + 1))? =
            Observation { point, view, eye, pixel };
        *observations += 1;
        Ok(())
    }

    /// The views, as far as they have been adjusted.
    pub fn views(&self) -> &[V] {
        self.views.get(..self.counts[0]).unwrap_or(&[])
    }

    /// The points.
    pub fn points(&self) -> &[Point3<T>] {
        self.points.get(..self.counts[1]).unwrap_or(&[])
    }

    /// The observations.
    pub fn observations(&self) -> &[Observation<T>] {
        self.observations.get(..self.counts[2]).unwrap_or(&[])
    }

    /// What is adjusted, and the memory for it.
    fn parts(&mut self) -> (Problem<'_, V, T>, BundleWorkspaceView<'_, V, T, N>) {
        let [views, points, observations] = self.counts;
        let problem = Problem {
            views: self.views.get_mut(..views).unwrap_or(&mut []),
            points: self.points.get_mut(..points).unwrap_or(&mut []),
            observations: self.observations.get(..observations).unwrap_or(&[]),
        };
        (problem, self.workspace.as_mut_view())
    }

    /// Adjusts until there is a reason to stop.
    pub fn adjust(&mut self, config: BundleConfig<T>) -> Result<BundleReport<T>, BundleError> {
        let (mut problem, mut workspace) = self.parts();
        adjust(&mut problem, &mut workspace, config)
    }

    /// Begins an adjustment that is done a step at a time, beside other work.
    pub fn start(&mut self, config: BundleConfig<T>) -> Result<Adjustment<T>, BundleError> {
        let (problem, mut workspace) = self.parts();
        Adjustment::start(&problem, &mut workspace, config)
    }

    /// A step of an adjustment that [`Self::start`] began; nothing may have been added since.
    pub fn iterate(&mut self, adjustment: &mut Adjustment<T>) -> ControlFlow<super::StopReason> {
        let (mut problem, mut workspace) = self.parts();
        adjustment.iterate(&mut problem, &mut workspace)
    }

    /// How sure views and points are, where every coordinate of an observation has a deviation of `sigma_px`.
    pub fn covariances(
        &mut self,
        gauge: Gauge,
        loss: Loss<T>,
        sigma_px: T,
    ) -> Result<Covariances<'_, V, T, N>, CovarianceError> {
        let (problem, workspace) = self.parts();
        Covariances::new(problem, workspace, gauge, loss, sigma_px)
    }
}

impl<V, T, const N: usize, const VIEWS: usize, const POINTS: usize, const OBSERVATIONS: usize> Default
    for Window<V, T, N, VIEWS, POINTS, OBSERVATIONS>
where
    V: View<T, N>,
    T: Real,
{
    fn default() -> Self {
        Self::new()
    }
}
