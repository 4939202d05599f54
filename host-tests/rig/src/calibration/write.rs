//! Rigs as files of other programs.

use nalgebra::Matrix3;
use std::fmt::Write;
use stereopsis::geometry::camera::{Camera, Lens, StereoRig};

/// A rig as OpenCV's FileStorage writes it, in YAML: K1, D1, K2, D2, R, T, E and F with `P' = R P + T` and
/// `p'^T F p = 0`, as `stereoCalibrate` gives them. T is in metres, which `length_unit` says. `notes` become
/// comments.
pub fn write_opencv(rig: &StereoRig<f64>, notes: &[String]) -> String {
    let size = rig.sizes()[0];
    let mut text = String::from("%YAML:1.0\n---\n");
    text += &comments("#", notes);
    let _ = writeln!(text, "image_width: {}\nimage_height: {}", size.width, size.height);
    for (n, camera) in (1..).zip(rig.cameras()) {
        text += &matrix(&format!("K{n}"), 3, &rows(&camera.matrix()));
        let lens = match camera.lens() {
            Lens::BrownConrady(lens) => match lens.to_opencv() {
                [k1, k2, p1, p2, k3, 0.0, 0.0, 0.0] => vec![k1, k2, p1, p2, k3],
                all => all.to_vec(),
            },
            Lens::Fisheye(lens) => lens.to_opencv().to_vec(),
            other => unreachable!("a lens of another model: {other:?}"),
        };
        text += &matrix(&format!("D{n}"), 1, &lens);
    }
    if rig.cameras().iter().any(|camera| matches!(camera.lens(), Lens::Fisheye(_))) {
        text += "distortion_model: \"fisheye\"\n";
    }
    let (r, t) = rig.pose().to_opencv();
    let cross = t.cross_matrix() * r;
    let [k1, k2] = rig.cameras().each_ref().map(Camera::inverse_matrix);
    let f = k2.transpose() * cross * k1;
    text += &matrix("R", 3, &rows(&r));
    text += "# the unit of T, and of the baseline: metres\nlength_unit: \"m\"\n";
    text += &matrix("T", 3, t.as_slice());
    text += &matrix("E", 3, &rows(&cross));
    text += &matrix("F", 3, &rows(&(f / f.norm())));
    text
}

/// A rig's record as a constant of Rust: `StereoRig::from_record(&STEREO_RIG)` reads it.
pub fn write_rust(rig: &StereoRig<f64>, notes: &[String]) -> String {
    let record = rig.to_record();
    let mut text = comments("//", notes);
    let _ = writeln!(text, "// Read by stereopsis::geometry::camera::StereoRig::from_record.");
    let _ = writeln!(text, "#[rustfmt::skip]\npub const STEREO_RIG: [u8; {}] = [", record.len());
    text + &bytes(&record) + "];\n"
}

/// A rig's record as an array of C.
pub fn write_c(rig: &StereoRig<f64>, notes: &[String]) -> String {
    let record = rig.to_record();
    let mut text = comments("//", notes);
    let _ = writeln!(text, "#ifndef STEREO_RIG_H\n#define STEREO_RIG_H\n\n#include <stdint.h>\n");
    let _ = writeln!(text, "#define STEREO_RIG_BYTES {}\n", record.len());
    let _ = writeln!(text, "static const uint8_t stereo_rig[STEREO_RIG_BYTES] = {{");
    text + &bytes(&record) + "};\n\n#endif\n"
}

fn comments(sign: &str, notes: &[String]) -> String {
    notes.iter().map(|note| format!("{sign} {}\n", note.replace('\n', " "))).collect()
}

/// Sixteen bytes a line.
fn bytes(record: &[u8]) -> String {
    let line = |line: &[u8]| {
        let bytes: Vec<_> = line.iter().map(|byte| format!("0x{byte:02x}")).collect();
        format!("    {},\n", bytes.join(", "))
    };
    record.chunks(16).map(line).collect()
}

fn rows(m: &Matrix3<f64>) -> Vec<f64> {
    m.transpose().as_slice().to_vec()
}

/// A matrix, row by row.
fn matrix(name: &str, rows: usize, numbers: &[f64]) -> String {
    let columns = numbers.len() / rows;
    // The shortest text that is the same number again; OpenCV wants a point or an exponent.
    let numbers: Vec<_> = numbers.iter().map(|x| format!("{x:?}")).collect();
    let lines: Vec<_> = numbers.chunks(columns.max(3)).map(|row| row.join(", ")).collect();
    format!(
        "{name}: !!opencv-matrix\n   rows: {rows}\n   cols: {columns}\n   dt: d\n   data: [ {} ]\n",
        lines.join(",\n       ")
    )
}
