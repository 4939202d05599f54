//! The odometry on the sequences of the folder in `STEREO_DATA`.
//!
//! `cargo xtask test` runs them when `STEREO_DATA` is set.

use std::path::PathBuf;
use stereopsis::motion::odometry::State;
use stereopsis_host::calibration::Cameras;
use stereopsis_host::odometry::error::{Alignment, align, ate, drift, rpe};
use stereopsis_host::odometry::poses;
use stereopsis_host::odometry::run::{Rig, RunConfig, run};
use stereopsis_host::odometry::sequence::Sequence;

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn a_street_of_kitti_with_one_camera() {
    let data = std::env::var_os("STEREO_DATA").expect("set STEREO_DATA to the folder that holds odometry/");
    let folder = PathBuf::from(data).join("odometry/kitti_mono_1");
    let sequence = Sequence::open(&folder).expect("a sequence");
    let truth = poses::read(&folder.join("poses.txt")).expect("poses").poses;
    let camera = Cameras::open_first(&[folder.join("calib.txt")]).expect("a camera");
    let frames = (0..sequence.len()).map(|i| sequence.frame(i));
    let found = run(&Rig::Mono(camera), frames, RunConfig::default(), |_| ()).expect("a trajectory");
    assert!(found.steps.iter().skip(1).all(|step| step.state == State::Tracked));

    let scale = align(&found.poses, &truth, Alignment::Similar).expect("places").scale;
    let error = ate(&found.poses, &truth, Alignment::Similar).expect("places");
    let steps = rpe(&found.poses, &truth, 1, scale).expect("steps");
    // From the first frame to the tenth the truth turns evenly by 0.83 degrees that the pictures do not:
    // OpenCV (SIFT, USAC, the essential matrix from frame to frame) is as far off it, and 0.02 degrees
    // from what is found here. Over 5, 10, 20 and 50 m OpenCV is 0.0196, 0.0140, 0.0093 and 0.0111 deg/m
    // off with that beginning, and 0.0055, 0.0038 and 0.0025 without it. An adjustment of all frames at
    // once (54 780 sights of SIFT features, SciPy, from the poses found here) ends at 0.0190, 0.0135, 0.0090
    // and 0.0105 with a median residual of 0.14 px, which is 0.31 px at the truth's poses. So it is compared
    // behind them, too.
    let after = drift(&found.poses[10..], &truth[10..], 20.0, scale).expect("ways");
    let all = drift(&found.poses, &truth, 20.0, scale).expect("ways");
    let [rotation, all_rotation] = [after, all].map(|d| d.rotation_rad.to_degrees());
    let worst = steps.worst_direction_rad.to_degrees();
    println!(
        "ATE {error:.3} m, {rotation:.4} deg/m over 20 m ({all_rotation:.4} with the beginning), directions \
         {worst:.2} deg"
    );
    assert!(error < 0.1, "{error} m");
    assert!(worst < 3.0, "{worst} deg");
    assert!(rotation < 0.004 && all_rotation < 0.01, "{rotation} {all_rotation} deg/m");
    for length in [5.0, 10.0] {
        let after =
            drift(&found.poses[10..], &truth[10..], length, scale).expect("ways").rotation_rad.to_degrees();
        assert!(after < 0.008, "{after} deg/m over {length} m");
    }
}
