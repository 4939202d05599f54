//! Records of rigs: what is read is written again to the bit, and extreme numbers are refused by name.

use nalgebra::{Matrix3, Rotation3, Vector3};
use stereopsis::geometry::camera::{
    Camera, Fisheye, ImageSize, Pose, PoseError, RecordError, StereoRig, StereoRigError,
};
use stereopsis_host::scene::Random;

type Record = [u8; StereoRig::<f64>::RECORD_BYTES];

/// Where R and t stand: behind the head and two cameras of thirteen numbers.
const ROTATION: usize = 20 + 8 * 26;
const TRANSLATION: usize = ROTATION + 8 * 9;

fn rig(random: &mut Random) -> StereoRig<f64> {
    let camera = Camera::new(500.0, 490.0, 320.0 + random.unit(), 240.0).expect("a camera");
    let turn = Rotation3::from_euler_angles(random.gauss(), random.gauss(), random.gauss()).into_inner();
    let pose = Pose::new(turn, Vector3::new(0.1, random.gauss() * 1e-3, 0.0)).expect("a pose");
    StereoRig::new([camera; 2], pose, [ImageSize { width: 640, height: 480 }; 2]).expect("a rig")
}

/// The record with its checksum, CRC-32/ISO-HDLC, made right.
fn sealed(mut record: Record) -> Record {
    let (body, checksum) = record.split_last_chunk_mut::<4>().expect("a record");
    let mut crc = u32::MAX;
    for byte in body {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
        }
    }
    *checksum = (!crc).to_le_bytes();
    record
}

fn number(record: &Record, at: usize) -> f64 {
    f64::from_le_bytes(record[at..at + 8].try_into().expect("eight bytes"))
}

fn put(record: &mut Record, at: usize, value: f64) {
    record[at..at + 8].copy_from_slice(&value.to_le_bytes());
}

#[test]
fn what_is_read_is_written_again() {
    let random = &mut Random::new(11);
    for case in 0..2000 {
        let rig = rig(random);
        let mut record = rig.to_record();
        assert_eq!(StereoRig::from_record(&record), Ok(rig), "{case}");
        // Another program's rotation is off by its own rounding.
        for i in 0..9 {
            let off = [0.0, 1e-16, 1e-11, 1e-8][case % 4] * (2.0 * random.unit() - 1.0);
            let at = ROTATION + 8 * i;
            let value = number(&record, at) + off;
            put(&mut record, at, value);
        }
        let record = sealed(record);
        let read = StereoRig::<f64>::from_record(&record).expect("a record");
        assert_eq!(read.to_record(), record, "{case}");
        // In single precision what is read is written again from there on.
        let single = StereoRig::<f32>::from_record(&record).expect("a record");
        assert_eq!(StereoRig::<f32>::from_record(&single.to_record()), Ok(single), "{case}");
        let double = StereoRig::<f64>::from_record(&single.to_record()).expect("a record");
        assert_eq!(double.to_record(), single.to_record(), "{case}");
    }
}

/// A pose that was composed many times is off from a rotation by what each product rounds: a rig of it is
/// read again.
#[test]
fn rigs_of_composed_poses_are_read_again() {
    let camera = Camera::new(500.0_f32, 490.0, 320.0, 240.0).expect("a camera");
    let turn = *Rotation3::from_euler_angles(0.3, -0.2, 0.5).matrix();
    let step = Pose::new(turn, Vector3::new(0.1, 0.02, 0.0)).expect("a pose");
    let (mut pose, mut most) = (step, 0.0_f32);
    for case in 0..300 {
        let off = (pose.rotation().transpose() * pose.rotation() - Matrix3::identity()).amax();
        most = most.max(off);
        let rig = StereoRig::new([camera; 2], pose, [ImageSize { width: 640, height: 480 }; 2]);
        let rig = rig.expect("a rig");
        assert_eq!(StereoRig::from_record(&rig.to_record()), Ok(rig), "{case}: {off}");
        pose = pose.then(&step);
    }
    assert!(most > 2e-6 && most < 2e-4, "{most}");
}

#[test]
fn extreme_numbers_are_refused_by_name() {
    let record = rig(&mut Random::new(12)).to_record();
    let with = |at: usize, value: f64| {
        let mut record = record;
        put(&mut record, at, value);
        StereoRig::<f64>::from_record(&sealed(record)).map(|_| ())
    };
    let pose = |error| Err(RecordError::Rig(StereoRigError::Pose(error)));
    for far in [-1e308, 1e200, f64::INFINITY, f64::NAN] {
        assert_eq!(with(TRANSLATION, far), pose(PoseError::NotFinite), "{far}");
    }
    assert_eq!(with(TRANSLATION, 1e7), Err(RecordError::Rig(StereoRigError::Baseline)));
    for off in [1e-3, 2.0, 1e30, 1e308, -1e308] {
        let moved = number(&record, ROTATION) + off;
        assert_eq!(with(ROTATION, moved), pose(PoseError::NotARotation), "{off}");
    }
    let far = Pose::new(Matrix3::identity(), Vector3::new(1e200, 0.0, 0.0));
    assert_eq!(far, Err(PoseError::NotFinite));
}

/// Calibrations are written to four decimals: the nearest rotation to such numbers is held.
#[test]
fn rotations_of_four_decimals_are_poses() {
    let mut random = Random::new(14);
    let mut number = || 2.0 * random.unit() - 1.0;
    for case in 0..20_000 {
        let axis = Vector3::new(number(), number(), number());
        let exact = *Rotation3::from_scaled_axis(axis * 4.0).matrix();
        let given = exact.map(|n| (n * 1e4).round() / 1e4);
        let pose = Pose::new(given, Vector3::zeros()).expect("a rotation");
        assert!((pose.rotation() - exact).amax() < 2e-4, "{case}: {given}");
        let off = (pose.rotation().transpose() * pose.rotation() - Matrix3::identity()).amax();
        assert!(off < 1e-12, "{case}: {off}");
        assert!(Pose::new(given.cast::<f32>(), Vector3::zeros()).is_ok(), "{case}: {given}");
    }
    // What is farther off than rounding to four decimals makes it is refused.
    let skewed = Matrix3::new(1.0, 3e-4, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    assert_eq!(Pose::new(skewed, Vector3::zeros()), Err(PoseError::NotARotation));
}

/// A fisheye lens has four coefficients: a record with more of them is none that was written.
#[test]
fn coefficients_that_a_lens_has_not_are_refused() {
    let rig = rig(&mut Random::new(13));
    let lens = Fisheye::from_opencv([0.1, 0.01, 0.0, 0.0]);
    let cameras = rig.cameras().map(|camera| camera.with_distortion(lens).expect("a lens"));
    let rig = StereoRig::new(cameras, *rig.pose(), rig.sizes()).expect("a rig");
    let mut record = rig.to_record();
    assert_eq!(StereoRig::from_record(&record), Ok(rig));
    put(&mut record, 20 + 8 * 9, 0.5);
    let found = StereoRig::<f64>::from_record(&sealed(record));
    assert_eq!(found, Err(RecordError::Lens { found: 1 }));
    assert!(found.is_err_and(|error| error.to_string().contains("more coefficients")));
}
