//! Camera models, two-view geometry, absolute pose, robust estimation and rectification, without pixels.
//!
//! In: calibrated numbers, and correspondences that somebody found. Out: types that have checked them once,
//! so that nobody after them has to. All of it is generic over [`Real`], `f32` or `f64`, but for
//! [`RectifiedRig`], which is `f32`; on fixed-size nalgebra types, bounded in time and without allocation.
//!
//! The modules stand in the order of use: each one uses only what stands above it.
//!
//! | module | in | out |
//! | --- | --- | --- |
//! | `linear` | small matrices, equations | factors, null vectors, rotations, least squares |
//! | [`camera`] | calibrated numbers | [`Camera`], [`Lens`], [`Pose`], [`StereoRig`], [`RectifiedRig`] |
//! | [`two_view`] | [`Correspondence`]s | [`Fundamental`], [`Essential`], [`Homography`], [`TwoViews`] |
//! | [`absolute`] | [`Landmark`]s | the camera's pose: [`p3p()`], [`Projection`] by the DLT |
//! | [`robust`] | both with outliers | [`robust_fundamental`], [`robust_resection`] (PnP) |
//! | [`rectify`] | a rig, or matches alone | [`Rectification`], [`Warp`], [`RowMeter`] |
//! | [`known_shape`] | one picture | [`Sighting`], [`SquareMark`], [`VanishingPoint`], [`ManhattanFrame`] |
//!
//! What comes out is finite, whatever goes in: an `Ok` or a `Some` holds no infinity and nothing that is not
//! a number, and keeps what its type promises (a rotation is one, a direction has length one, a depth is in
//! front). Where a number would go beyond what `T` holds, some 1e19 where it is squared in `f32` and 1e154 in
//! `f64`, the answer is an error or `None`.
//!
//! R and t carry a point of camera 2 into camera 1, `P = R P' + t`, and `p^T F p' = 0`; what OpenCV writes
//! the other way round is converted by functions that say so.
//!
//! # The lecture's equations
//!
//! Where the equations of Stanford's AA273, lecture 6 (Pavone 2018), are computed, in the lecture's order.
//! Each has a worked number in the tests.
//!
//! | equation | computed by |
//! | --- | --- |
//! | `p ~ M P`, `M = K [R^T \| -R^T t]` | [`Projection::new`], [`Projection::project`] |
//! | `Z = f S / s`, an object of known size | [`Sighting::of_length`] |
//! | `z = b f / (p_u - p'_u)`, rays of a rectified pair | [`RectifiedRig::depth_m`] |
//! | 6.2: least `d(p, M P)^2 + d(p', M' P)^2` | [`TwoViews::optimal`], [`Triangulated::residual_px`] |
//! | `p . [t x (R p')] = 0`, three vectors in the epipolar plane | [`Essential::residual`] |
//! | `[a]x b = a x b` | `linear::skew` |
//! | `E = [t]x R`, `p^T E p' = 0` | [`Essential::from_pose`], [`Essential::residual`] |
//! | `E` has the singular values `(s, s, 0)` | [`Essential::nearest`] |
//! | `F = K^-T E K'^-1`, `p^T F p' = 0` | [`Fundamental::from_essential`], [`Fundamental::residual`] |
//! | `l = F p'`, `l' = F^T p` | [`Fundamental::line_in_first`], [`Fundamental::line_in_second`] |
//! | `F^T e = 0`, `F e' = 0` | [`Fundamental::epipole_in_first`], [`Fundamental::epipole_in_second`] |
//! | least `\|W f\|` with `\|f\| = 1`, normalised | [`eight_point()`] |
//! | the nearest matrix of rank 2, `U diag(s1, s2, 0) V^T` | [`Fundamental::from_matrix`] |
//! | `E = K^T F K'` and its four poses | [`Essential::from_fundamental`], [`Essential::poses`] |
//! | rows of a rectified pair: `F ~ [0 0 0; 0 0 -1; 0 1 0]` | [`Fundamental::from_cameras`] of such a pair |
//! | disparity to a point, `P ~ Q (u v d 1)^T` | [`RectifiedRig::reproject`] |
//!
//! [`Camera`]: camera::Camera
//! [`Correspondence`]: two_view::Correspondence
//! [`Essential`]: two_view::Essential
//! [`Essential::from_fundamental`]: two_view::Essential::from_fundamental
//! [`Essential::from_pose`]: two_view::Essential::from_pose
//! [`Essential::nearest`]: two_view::Essential::nearest
//! [`Essential::poses`]: two_view::Essential::poses
//! [`Essential::residual`]: two_view::Essential::residual
//! [`Fundamental`]: two_view::Fundamental
//! [`Fundamental::epipole_in_first`]: two_view::Fundamental::epipole_in_first
//! [`Fundamental::epipole_in_second`]: two_view::Fundamental::epipole_in_second
//! [`Fundamental::from_cameras`]: two_view::Fundamental::from_cameras
//! [`Fundamental::from_essential`]: two_view::Fundamental::from_essential
//! [`Fundamental::from_matrix`]: two_view::Fundamental::from_matrix
//! [`Fundamental::line_in_first`]: two_view::Fundamental::line_in_first
//! [`Fundamental::line_in_second`]: two_view::Fundamental::line_in_second
//! [`Fundamental::residual`]: two_view::Fundamental::residual
//! [`Homography`]: two_view::Homography
//! [`Landmark`]: absolute::Landmark
//! [`Lens`]: camera::Lens
//! [`ManhattanFrame`]: known_shape::ManhattanFrame
//! [`Pose`]: camera::Pose
//! [`Projection`]: absolute::Projection
//! [`Projection::new`]: absolute::Projection::new
//! [`Projection::project`]: absolute::Projection::project
//! [`Rectification`]: rectify::Rectification
//! [`RectifiedRig`]: camera::RectifiedRig
//! [`RectifiedRig::depth_m`]: camera::RectifiedRig::depth_m
//! [`RectifiedRig::reproject`]: camera::RectifiedRig::reproject
//! [`RowMeter`]: rectify::RowMeter
//! [`Sighting`]: known_shape::Sighting
//! [`Sighting::of_length`]: known_shape::Sighting::of_length
//! [`SquareMark`]: known_shape::SquareMark
//! [`StereoRig`]: camera::StereoRig
//! [`Triangulated::residual_px`]: two_view::Triangulated::residual_px
//! [`TwoViews`]: two_view::TwoViews
//! [`TwoViews::optimal`]: two_view::TwoViews::optimal
//! [`VanishingPoint`]: known_shape::VanishingPoint
//! [`Warp`]: rectify::Warp
//! [`eight_point()`]: two_view::eight_point()
//! [`p3p()`]: absolute::p3p()
//! [`robust_fundamental`]: robust::robust_fundamental
//! [`robust_resection`]: robust::robust_resection

#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "`!(a > b)` refuses what is not a number together with what is too small"
)]

mod real;
pub(crate) mod linear;
pub mod camera;
pub mod two_view;
pub mod absolute;
pub mod robust;
pub mod rectify;
pub mod known_shape;

pub use real::Real;
