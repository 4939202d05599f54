//! What comes out of the geometry is finite and keeps what its type promises, whatever goes in: numbers over
//! all exponents, where squares, products and quotients go beyond what `f32` and `f64` hold.

use nalgebra::{Matrix3, Matrix3x4, Point2, Point3, Vector3};
use stereopsis::geometry::Real;
use stereopsis::geometry::absolute::{Landmark, Projection, p3p};
use stereopsis::geometry::camera::{
    Camera, Distortion, Fisheye, ImageSize, Lens, Pose, RectifiedRig, StereoRig, StereoRigError,
};
use stereopsis::geometry::two_view::RelativePose;
use stereopsis_host::scene::Random;

/// Cases of each kind.
const CASES: u64 = 20_000;

/// Numbers by chance: of sane sizes, of any exponent, and some that are no numbers.
struct Numbers {
    random: Random,
    /// The largest exponent in use.
    reach: i32,
    is_wild: bool,
}

impl Numbers {
    /// One of three kinds in turn: any exponents, one exponent for a whole case, now and then infinity.
    fn new<T: Real>(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let most = if T::EPSILON.to_f64() > 1e-10 { 128 } else { 1024 };
        let reach = if seed.is_multiple_of(2) { most } else { 1 + random.below(most as usize) as i32 };
        Self { random, reach, is_wild: seed % 16 == 15 }
    }

    fn next<T: Real>(&mut self) -> T {
        let sign = if self.random.bits() & 1 == 0 { 1.0 } else { -1.0 };
        let part = 1.0 + self.random.unit();
        match self.random.below(16) {
            0 => T::ZERO,
            1 if self.is_wild => T::of(f64::NAN),
            2 if self.is_wild => T::of(f64::INFINITY * sign),
            3..=5 => T::of(sign * self.random.unit() * 1000.0),
            // About the largest of the case: all of one exponent.
            6..=8 => T::of(sign * part * 2.0_f64.powi(self.reach - 2)),
            9 => T::of(sign * part * 2.0_f64.powi(-self.reach + 2)),
            _ => {
                let exponent = self.random.below(2 * self.reach as usize) as i32 - self.reach;
                T::of(sign * part * 2.0_f64.powi(exponent))
            }
        }
    }

    /// A number that is sane in one case of two.
    fn half_sane<T: Real>(&mut self, centre: f64, spread: f64) -> T {
        if self.random.below(2) == 0 {
            T::of(centre + spread * (2.0 * self.random.unit() - 1.0))
        } else {
            self.next()
        }
    }

    fn vector<T: Real>(&mut self) -> Vector3<T> {
        Vector3::new(self.next(), self.next(), self.next())
    }

    fn pixel<T: Real>(&mut self) -> Point2<T> {
        Point2::new(self.half_sane(300.0, 300.0), self.half_sane(300.0, 300.0))
    }

    /// A point before a camera, or anywhere.
    fn point<T: Real>(&mut self) -> Point3<T> {
        Point3::new(self.half_sane(0.0, 3.0), self.half_sane(0.0, 3.0), self.half_sane(5.0, 4.0))
    }

    fn matrix<T: Real>(&mut self) -> Matrix3<T> {
        Matrix3::from_fn(|_, _| self.next())
    }

    /// Any camera that there is: with extreme numbers, with or without a lens.
    fn camera<T: Real>(&mut self) -> Camera<T> {
        loop {
            let focal = |n: &mut Self| T::of(10.0_f64.powf(n.random.unit() * 9.0 - 3.0));
            let sane = self.random.below(2) == 0;
            let (fx, fy) = if sane { (T::of(500.0), T::of(490.0)) } else { (focal(self), focal(self)) };
            let (cx, cy) = (self.half_sane(320.0, 9.0), self.half_sane(240.0, 9.0));
            let skew = if sane { T::ZERO } else { self.next() };
            let mut k = || self.half_sane::<T>(0.0, 0.4);
            let lens: Lens<T> = match (k)().to_f64().to_bits() % 3 {
                0 => Lens::NONE,
                1 => Distortion::from_opencv_rational([k(), k(), k(), k(), k(), k(), k(), k()]).into(),
                _ => Fisheye::from_opencv([k(), k(), k(), k()]).into(),
            };
            let camera = Camera::new(fx, fy, cx, cy).and_then(|c| c.with_skew(skew));
            if let Ok(camera) = camera.and_then(|c| c.with_distortion(lens)) {
                return camera;
            }
        }
    }

    /// Any pose that there is.
    fn pose<T: Real>(&mut self) -> Pose<T> {
        let axis = Vector3::new(self.random.gauss(), self.random.gauss(), self.random.gauss());
        let turn = nalgebra::Rotation3::from_scaled_axis(axis * self.random.unit()).into_inner();
        let turn = turn.map(T::of);
        loop {
            if let Ok(pose) = Pose::new(turn, self.vector()) {
                assert!(is_pose(&pose));
                return pose;
            }
        }
    }
}

fn finite<T: Real>(numbers: &[T]) -> bool {
    numbers.iter().all(|x| x.is_finite())
}

fn is_rotation<T: Real>(r: &Matrix3<T>) -> bool {
    finite(r.as_slice())
        && (r.transpose() * r - Matrix3::identity()).amax() < T::of(1e-3)
        && r.determinant() > T::ZERO
}

fn is_pose<T: Real>(pose: &Pose<T>) -> bool {
    is_rotation(pose.rotation()) && pose.translation().norm().is_finite() && {
        let back = pose.inverse();
        is_rotation(back.rotation()) && finite(back.translation().as_slice())
    }
}

fn is_unit<T: Real>(v: &Vector3<T>) -> bool {
    (v.norm() - T::ONE).abs() < T::of(1e-3)
}

/// Runs a check of both types over all cases.
macro_rules! check {
    ($name:ident, $check:ident) => {
        #[test]
        fn $name() {
            let (mut single, mut double) = (0_u32, 0_u32);
            for seed in 0..CASES {
                single += u32::from($check::<f32>(&mut Numbers::new::<f32>(seed), seed));
                double += u32::from($check::<f64>(&mut Numbers::new::<f64>(seed), seed));
            }
            // Cases with an answer there must be, or nothing was checked.
            assert!(single > 20 && double > 20, "{single} and {double} answers");
        }
    };
}

mod views;

fn camera_is_sound<T: Real>(n: &mut Numbers, seed: u64) -> bool {
    if let Ok(camera) = Camera::<T>::from_matrix(&n.matrix()) {
        assert!(finite(camera.matrix().as_slice()) && finite(camera.inverse_matrix().as_slice()), "{seed}");
    }
    let camera = n.camera::<T>();
    let (point, pixel) = (n.point(), n.pixel());
    assert!(finite(camera.inverse_matrix().as_slice()), "{seed}");
    let seen = camera.project(&point);
    if let Ok(seen) = seen {
        assert!(finite(seen.coords.as_slice()), "{seed}: {camera:?} {point} {seen}");
    }
    if let Ok(ray) = camera.unproject(&pixel) {
        assert!(finite(ray.as_slice()), "{seed}: {camera:?} {pixel} {ray}");
    }
    if let Ok(place) = camera.undistort(&pixel) {
        assert!(finite(place.coords.as_slice()), "{seed}: {camera:?} {pixel} {place}");
    }
    seen.is_ok()
}
check!(cameras_see_places_that_are_numbers, camera_is_sound);

fn pose_is_sound<T: Real>(n: &mut Numbers, seed: u64) -> bool {
    if let Ok(pose) = Pose::<T>::new(n.matrix(), n.vector()) {
        assert!(is_pose(&pose), "{seed}: {pose:?}");
    }
    let pose = n.pose::<T>();
    let camera = Camera::new(T::of(500.0), T::of(500.0), T::of(320.0), T::of(240.0)).expect("a camera");
    let size = ImageSize { width: 640, height: 480 };
    let rig = StereoRig::new([camera; 2], pose, [size; 2]);
    match rig {
        Ok(rig) => assert!(rig.baseline_m() >= T::of(1e-6) && rig.baseline_m() <= T::of(1e6), "{seed}"),
        Err(StereoRigError::NoBaseline) => assert_eq!(pose.translation().amax(), T::ZERO, "{seed}"),
        Err(error) => assert_eq!(error, StereoRigError::Baseline, "{seed}"),
    }
    if let Some(relative) = RelativePose::of(&pose) {
        assert!(is_rotation(relative.rotation()) && is_unit(&relative.direction().into_inner()), "{seed}");
        if let Ok(pose) = relative.with_baseline(n.next()) {
            assert!(is_pose(&pose), "{seed}");
        }
        if let Ok(pose) = relative.with_length(&n.point(), &n.point(), n.next()) {
            assert!(is_pose(&pose), "{seed}");
        }
    }
    rig.is_ok()
}
check!(poses_are_rigid_motions, pose_is_sound);

#[test]
fn rectified_rigs_have_depths_that_are_numbers() {
    let mut answers = 0;
    for seed in 0..CASES {
        let n = &mut Numbers::new::<f32>(seed);
        let [f, b, cx, cy, cx2] =
            [n.next::<f32>().abs(), n.next::<f32>().abs(), n.next(), n.next(), n.next()];
        let Ok(rig) = RectifiedRig::with_offset(f, b, cx, cy, cx2) else { continue };
        assert!(rig.disparity_offset_px().is_finite(), "{seed}");
        let (u, v, d) = (n.next(), n.next(), n.next());
        if let Some(depth) = rig.depth_m(d) {
            assert!(depth.is_finite() && depth >= 0.0, "{seed}: {rig:?} {d} {depth}");
            answers += 1;
        }
        if let Some(point) = rig.reproject(u, v, d) {
            assert!(finite(point.coords.as_slice()), "{seed}: {rig:?} {u} {v} {d} {point}");
        }
    }
    assert!(answers > 100);
}

fn p3p_is_sound<T: Real>(n: &mut Numbers, seed: u64) -> bool {
    let points: [Point3<T>; 3] = core::array::from_fn(|_| n.point());
    let by = n.next::<T>();
    let points = points.map(|p| if seed.is_multiple_of(3) { p * by } else { p });
    let rays =
        if seed.is_multiple_of(2) { points.map(|p| p.coords) } else { core::array::from_fn(|_| n.vector()) };
    let Ok(found) = p3p(&rays, &points) else { return false };
    assert!(!found.as_slice().is_empty());
    assert!(found.as_slice().iter().all(is_pose), "{seed}: {rays:?} {points:?} {found:?}");
    true
}
check!(poses_of_three_points_are_rigid_motions, p3p_is_sound);

fn projection_is_sound<T: Real>(n: &mut Numbers, seed: u64) -> bool {
    let matrix = Matrix3x4::from_fn(|_, _| n.next::<T>());
    let landmarks: Vec<_> = (0..8).map(|_| Landmark { world: n.point::<T>(), pixel: n.pixel() }).collect();
    for found in [Projection::from_matrix(&matrix), Projection::from_landmarks(&landmarks)] {
        let Ok(found) = found else { continue };
        assert!(finite(found.matrix().as_slice()), "{seed}: {found:?}");
        if let Some(pixel) = found.project(&n.point()) {
            assert!(finite(pixel.coords.as_slice()), "{seed}: {found:?}");
        }
        if let Ok((camera, pose)) = found.decompose() {
            assert!(finite(camera.matrix().as_slice()) && is_pose(&pose), "{seed}: {found:?}");
        }
    }
    Projection::from_matrix(&matrix).is_ok()
}
check!(camera_matrices_are_numbers, projection_is_sound);
