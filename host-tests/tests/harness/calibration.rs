//! Calibration files of both formats, good and bad.

use std::fs;
use std::path::Path;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis_host::calibration::{Calibration, CalibrationError, Fault, write_middlebury};

const MIDDLEBURY: &str = "cam0=[999.421 0 294.182; 0 999.421 252.932; 0 0 1]
cam1=[999.421 0 326.96; 0 999.421 252.932; 0 0 1]
doffs=32.778
baseline=193.001
width=741
height=497
ndisp=70
isint=0
vmin=7
dyavg=0.23
";

const KITTI: &str = "P0: 7.0e+02 0 6.0e+02 0 0 7.0e+02 1.8e+02 0 0 0 1 0
P1: 7.0e+02 0 6.0e+02 -3.75e+02 0 7.0e+02 1.8e+02 0 0 0 1 0
P2: 7.2e+02 0 6.1e+02 4.5e+01 0 7.2e+02 1.8e+02 2.1e-01 0 0 1 2.7e-03
P3: 7.2e+02 0 6.1e+02 -3.39e+02 0 7.2e+02 1.8e+02 2.1e+00 0 0 1 2.7e-03
Tr: 1 0 0 0 0 1 0 0 0 0 1 0
";

fn open_for(text: impl AsRef<[u8]>, left: &str) -> Result<Calibration, CalibrationError> {
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    fs::write(file.path(), text).expect("room for a few bytes");
    let result = Calibration::open(file.path(), Path::new(left));
    if let Err(error) = &result {
        let text = error.to_string();
        let name = file.path().file_name().expect("a name").to_string_lossy().into_owned();
        assert!(text.contains(&name) && !text.contains('\n'), "{text}");
    }
    result
}

fn fault(text: impl AsRef<[u8]>) -> Fault {
    open_for(text, "left.png").expect_err("a bad file").fault
}

fn near(a: f32, b: f32) {
    assert!((a - b).abs() <= 1e-5 * b.abs(), "{a} is not {b}");
}

#[test]
fn middlebury_is_in_millimetres() {
    let c = open_for(MIDDLEBURY, "im0.png").expect("as published");
    assert_eq!((c.format, c.width, c.height, c.disparities), ("Middlebury", Some(741), Some(497), Some(70)));
    near(c.rig.focal_px(), 999.421);
    near(c.rig.baseline_m(), 0.193001);
    near(c.rig.disparity_offset_px(), 32.778);
    near(c.rig.principal_point().1, 252.932);
    assert!(c.check_size(741, 497).is_ok());
    let text = c.check_size(740, 497).expect_err("another width").to_string();
    assert!(text.contains("width") && text.contains("741") && text.contains("740"), "{text}");
    let without = MIDDLEBURY.replace("width=741\n", "").replace("doffs=32.778\n", "").replace('\n', "\r\n");
    let c = open_for(without, "im0.png").expect("sizes and doffs are optional, line ends are any");
    assert!(c.check_size(5, 497).is_ok() && c.check_size(5, 5).is_err());
}

#[test]
fn kitti_chooses_the_pair_by_the_left_image() {
    let colour = open_for(KITTI, "training/image_2/000000_10.png").expect("four matrices");
    assert_eq!((colour.format, colour.width), ("KITTI", None));
    near(colour.rig.focal_px(), 720.0);
    near(colour.rig.baseline_m(), 384.0 / 720.0);
    for folder in ["image_0", "image_1", "image_00/data", "image_01/data"] {
        let grey = open_for(KITTI, &format!("00/{folder}/000000.png")).expect("four matrices");
        near(grey.rig.baseline_m(), 375.0 / 700.0);
    }
    let labels = KITTI.replace("P0:", "P_rect_00:").replace("P1:", "P_rect_01:").replace("P2:", "P_rect_02:");
    let labels = labels.replace("P3:", "P_rect_03:");
    let raw = open_for(&labels, "left.png").expect("the raw data's labels");
    near(raw.rig.baseline_m(), 384.0 / 720.0);
    let sized = labels + "S_00: 1392 512\nS_rect_00: 100 50\nS_rect_02: 1.242000e+03 3.750000e+02\n";
    let sized = open_for(sized, "left.png").expect("the raw data's sizes");
    assert_eq!((sized.width, sized.height), (Some(1242), Some(375)));
    assert!(sized.check_size(1242, 375).is_ok() && sized.check_size(1224, 370).is_err());
    let two: String = KITTI.lines().take(2).map(|line| format!("{line}\n")).collect();
    near(open_for(&two, "left.png").expect("grey cameras alone").rig.baseline_m(), 375.0 / 700.0);
    let bare = two.replace("P0: ", "").replace("P1: ", "");
    near(open_for(bare, "left.png").expect("no labels").rig.baseline_m(), 375.0 / 700.0);
}

/// As the sequences of Karlsruhe have it: cameras 1 and 2, before and after rectification, and cropped.
const KARLSRUHE: &str = "c_dist: 1.000000e+01\nroi: 10 1353 60 450\n\
    K1: 9.0e+02 0 6.9e+02 0 9.0e+02 2.5e+02 0 0 1\nD1: -.36 .16 0 0 0\nR1: 1 0 0 0 1 0 0 0 1\n\
    K2: 9.1e+02 0 6.8e+02 0 9.1e+02 2.4e+02 0 0 1\nD2: -.36 .16 0 0 0\nR2: 1 0 0 0 1 0 0 0 1\n\
    R: 1 0 0 0 1 0 0 0 1\nT: -.57 0 0\n\
    P1: 8.0e+02 0 6.9e+02 0 0 8.0e+02 2.6e+02 0 0 0 1 0\n\
    P1_roi: 8.0e+02 0 6.8e+02 0 0 8.0e+02 2.0e+02 0 0 0 1 0\n\
    P2: 8.0e+02 0 6.9e+02 -4.56e+02 0 8.0e+02 2.6e+02 0 0 0 1 0\n\
    P2_roi: 8.0e+02 0 6.8e+02 -4.56e+02 0 8.0e+02 2.0e+02 0 0 0 1 0\n";

#[test]
fn karlsruhe_counts_from_one_and_shows_a_region() {
    let cropped = open_for(KARLSRUHE, "I1_000000.png").expect("as published");
    assert_eq!(cropped.format, "Karlsruhe");
    near(cropped.rig.baseline_m(), 0.57);
    near(cropped.rig.principal_point().0, 680.0);
    near(cropped.rig.principal_point().1, 200.0);
    let whole: String = KARLSRUHE.lines().filter(|l| !l.contains("_roi")).map(|l| format!("{l}\n")).collect();
    near(open_for(whole, "I1_000000.png").expect("without a region").rig.principal_point().1, 260.0);
    let one: String =
        KARLSRUHE.lines().filter(|l| !l.starts_with("P2_roi")).map(|l| format!("{l}\n")).collect();
    assert!(matches!(fault(one), Fault::Missing(key, _) if key == "P2_roi"));
}

#[test]
fn what_is_no_calibration_is_said() {
    assert!(matches!(fault(""), Fault::Empty));
    assert!(matches!(fault(" \n\n"), Fault::Empty));
    assert!(matches!(fault([0x89, b'P', 0, 1, 2]), Fault::NotText));
    assert!(matches!(fault([0xff, 0xfe, b'a']), Fault::NotText));
    assert!(matches!(fault(vec![b' '; (1 << 20) + 1]), Fault::NotText));
    assert!(matches!(fault("%YAML:1.0\nM1: !!opencv-matrix\n"), Fault::Missing(key, _) if key == "D1"));
    let missing = Calibration::open("no/such/calib.txt", Path::new("l.png")).expect_err("no file");
    assert!(matches!(missing.fault, Fault::Read(_)) && missing.to_string().starts_with("no/such/calib.txt"));
}

#[test]
fn a_missing_key_is_named() {
    for key in ["cam0", "cam1", "baseline"] {
        let text: String =
            MIDDLEBURY.lines().filter(|l| !l.starts_with(key)).map(|l| format!("{l}\n")).collect();
        let Fault::Missing(missing, _) = fault(text) else { panic!("{key} is not reported") };
        assert_eq!(missing, key);
    }
    let one: String = KITTI.lines().filter(|l| !l.starts_with("P3")).map(|l| format!("{l}\n")).collect();
    assert!(matches!(fault(one), Fault::Missing(key, _) if key == "P3"));
}

#[test]
fn a_bad_number_is_named_with_its_line() {
    let bad = |from: &str, to: &str| fault(MIDDLEBURY.replace(from, to));
    assert!(matches!(bad("193.001", "wide"), Fault::NotANumber { key, line: 4, found } if key == "baseline"
            && found == "wide"));
    assert!(matches!(bad("193.001", "inf"), Fault::NotFinite { key, .. } if key == "baseline"));
    assert!(
        matches!(bad("doffs=32.778", "doffs=nan"), Fault::NotFinite { key, line: 3, .. } if key == "doffs")
    );
    assert!(matches!(bad("999.421 0 294", "1e300 0 294"), Fault::NotFinite { key, .. } if key == "cam0"));
    assert!(matches!(bad("0 0 1]\ncam1", "0 0]\ncam1"),
            Fault::Count { key, found: 8, needed: 9, .. } if key == "cam0"));
    assert!(matches!(bad("193.001", ""), Fault::Count { key, found: 0, .. } if key == "baseline"));
    assert!(matches!(bad("width=741", "width=0"), Fault::NotASize { key, line: 5, .. } if key == "width"));
    assert!(matches!(bad("height=497", "height=-1"), Fault::NotASize { .. }));
    assert!(matches!(bad("isint=0", "baseline=1"), Fault::Twice { line: 8, .. }));
    let short = fault(KITTI.replace("P2: 7.2e+02 0", "P2: 7.2e+02"));
    assert!(matches!(short, Fault::Count { key, line: 3, found: 11, needed: 12 } if key == "P2"));
}

#[test]
fn cameras_that_are_no_rectified_pair_are_refused() {
    let bad = |from: &str, to: &str| fault(MIDDLEBURY.replace(from, to));
    assert!(matches!(bad("193.001", "0"), Fault::Baseline { .. }));
    assert!(matches!(bad("193.001", "-193"), Fault::Baseline { .. }));
    assert!(matches!(bad("999.421", "0"), Fault::FocalLength { .. }));
    assert!(matches!(bad("999.421", "-999.421"), Fault::FocalLength { .. }));
    assert!(matches!(bad("cam1=[999.421", "cam1=[900"), Fault::FocalLengths { .. }));
    let other = bad("cam1=[999.421 0 326.96; 0 999.421", "cam1=[900 0 326.96; 0 900");
    assert!(matches!(other, Fault::FocalLengths { keys, .. } if keys == "cam0 and cam1"));
    assert!(matches!(bad("252.932; 0 0 1]\ndoffs", "250; 0 0 1]\ndoffs"), Fault::Rows { .. }));
    assert!(matches!(bad("doffs=32.778", "doffs=0"), Fault::Offset { .. }));
    let mut swapped: Vec<&str> = KITTI.lines().take(2).collect();
    swapped.reverse();
    let bare = swapped.join("\n").replace("P0: ", "").replace("P1: ", "");
    assert!(matches!(fault(bare), Fault::Baseline { .. }), "the right camera stands first");
    assert!(matches!(fault(KITTI.replace("7.2e+02", "0")), Fault::FocalLength { .. }));
}

#[test]
fn what_is_written_reads_back() {
    let rig = RectifiedRig::with_offset(511.3, 0.0812, 319.5, 239.5, 331.25).expect("a rig");
    let read = open_for(write_middlebury(&rig, 640, 480, 64), "left.png").expect("the format of its reader");
    near(read.rig.focal_px(), rig.focal_px());
    near(read.rig.baseline_m(), rig.baseline_m());
    near(read.rig.disparity_offset_px(), rig.disparity_offset_px());
    assert_eq!(read.rig.principal_point(), rig.principal_point());
    assert_eq!((read.width, read.height, read.disparities), (Some(640), Some(480), Some(64)));
}

/// The rectified cameras that OpenCV's, ROS's and our own files speak of.
#[test]
fn rectified_cameras_of_other_programs() {
    let yaml = "%YAML:1.0\n---\nR: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [-60, 0, 0]\n";
    let matrix = |key: &str, columns: u8, data: &str| {
        let head = format!(
            "{key}: !!opencv-matrix\n   rows: {}\n   cols: {columns}\n   dt: d\n",
            if columns == 3 { 3 } else { columns }
        );
        format!("{head}   data: [ {data} ]\n")
    };
    let p1 = matrix("P1", 4, "500., 0., 320., 0., 0., 500., 240., 0., 0., 0., 1., 0.");
    let p2 = matrix("P2", 4, "500., 0., 330., -30000., 0., 500., 240., 0., 0., 0., 1., 0.");
    let q = matrix(
        "Q",
        4,
        "1., 0., 0., -320., 0., 1., 0., -240., 0., 0., 0., 500., 0., 0., 0.016666666666666666, \
         0.16666666666666666",
    );
    let ros = |shift: &str, cx: &str| {
        format!(
            "image_width: 640\ncamera_matrix: {{data: [510, 0, 300, 0, 510, 220, 0, 0, \
             1]}}\nprojection_matrix: {{data: [500, 0, {cx}, {shift}, 0, 500, 240, 0, 0, 0, 1, 0]}}\n"
        )
    };
    let ours = "{\"axis\": \"horizontal\", \"focal_px\": 500, \"q\": [[1, 0, 0, -320], [0, 1, 0, -240], [0, \
                0, 0, 500], [0, 0, 16.666666666666668, 166.66666666666666]]}";
    let mounted = "K1: [500, 0, 320, 0, 500, 240, 0, 0, 1]\nD1: [0, 0, 0, 0, 0]\nK2: [500, 0, 330, 0, 500, \
                   240, 0, 0, 1]\nD2: [0, 0, 0, 0, 0]\nR: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [-60, 0, 0]\n";
    let of = |texts: &[&str], unit_m: f64| {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let paths: Vec<_> = (0..texts.len()).map(|i| folder.path().join(format!("file{i}"))).collect();
        for (path, text) in paths.iter().zip(texts) {
            fs::write(path, text).expect("room for a few bytes");
        }
        Calibration::open_all(&paths, Path::new("left.png"), Some(unit_m)).map_err(|e| e.to_string())
    };
    for (texts, unit_m) in [
        (vec![format!("{yaml}{p1}{p2}")], 1e-3),
        (vec![format!("{yaml}{q}")], 1e-3),
        (vec![ros("0", "320"), ros("-30", "330")], 1.0),
        (vec![ros("-30", "330"), ros("0", "320")], 1.0),
        (vec![ours.to_owned()], 1.0),
        (vec![mounted.to_owned()], 1e-3),
    ] {
        let texts: Vec<_> = texts.iter().map(String::as_str).collect();
        let rig = of(&texts, unit_m).expect(texts[0]).rig;
        near(rig.focal_px(), 500.0);
        near(rig.baseline_m(), 0.06);
        near(rig.principal_point().0, 320.0);
        near(rig.disparity_offset_px(), 10.0);
    }
    for (text, said) in [
        (mounted.replace("R: [1, 0, 0, 0, 1, 0", "R: [0.8, 0.6, 0, -0.6, 0.8, 0"), "--rectify"),
        (mounted.replace("D2: [0", "D2: [0.1"), "--rectify"),
        (format!("{yaml}{p1}{p2}"), "--unit mm"),
        (
            format!("{yaml}{p1}{}", p2.replace("-30000., 0., 500., 240., 0.", "0., 0., 500., 240., -30.")),
            "below each other",
        ),
        (format!("{yaml}{p1}{}", p2.replace("-30000.", "30000.")), "with the right camera on the right"),
        (format!("{yaml}{p1}{}", p2.replace("-30000.", ".Nan")), "P2: a number is not finite"),
        (format!("{yaml}{}", q.replace("500.", "nan")), "Q: a number is not finite"),
        (format!("{yaml}{}", q.replace("1., 0., 0., -320.", "1., 0., 0.5, -320.")), "is no Q"),
        (format!("{yaml}["), "not well-formed"),
        (ros("0", "320"), "--calib a second time"),
    ] {
        let error = of(&[&text], 1.0).expect_err(said);
        assert!(error.contains(said) && !error.contains('\n'), "{said}: {error}");
    }
}
