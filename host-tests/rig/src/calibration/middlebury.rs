//! `calib.txt` of the Middlebury stereo pages, 2014 and later: `key=value` lines, lengths in pixels and
//! millimetres.

use super::{Calibration, Fault, Intrinsics, PIXEL_TOLERANCE, numbers, rig};
use std::path::PathBuf;
use stereopsis::geometry::camera::RectifiedRig;

const KEYS: [&str; 7] = ["cam0", "cam1", "doffs", "baseline", "width", "height", "ndisp"];

/// A key with its line's number, from 1, and what stands behind the equals sign.
struct Entry<'a> {
    key: &'a str,
    line: usize,
    value: &'a str,
}

/// Whether a line sets one of the format's keys.
pub(super) fn is_one(text: &str) -> bool {
    entries(text).next().is_some()
}

fn entries(text: &str) -> impl Iterator<Item = Entry<'_>> {
    text.lines().zip(1..).filter_map(|(content, line)| {
        let (key, value) = content.split_once('=')?;
        let (key, value) = (key.trim(), value.trim());
        KEYS.contains(&key).then_some(Entry { key, line, value })
    })
}

/// A rig in this format, for pictures of `width` x `height` and a search of `disparities`.
pub fn write_middlebury(rig: &RectifiedRig, width: u16, height: u16, disparities: u16) -> String {
    let (f, (cx, cy)) = (rig.focal_px(), rig.principal_point());
    let doffs = rig.disparity_offset_px();
    format!(
        "cam0=[{f} 0 {cx}; 0 {f} {cy}; 0 0 1]\ncam1=[{f} 0 {}; 0 {f} {cy}; 0 0 \
         1]\ndoffs={doffs}\nbaseline={}\nwidth={width}\nheight={height}\nndisp={disparities}\n",
        cx + doffs,
        rig.baseline_m() * 1000.0
    )
}

pub(super) fn read(text: &str) -> Result<Calibration, Fault> {
    let find = |wanted: &str| find(text, wanted);
    let need = |key: &str, form| find(key)?.ok_or_else(|| Fault::Missing(key.into(), form));

    let cam0 = camera(&need("cam0", "cam0=[f 0 cx; 0 f cy; 0 0 1]")?)?;
    let cam1 = camera(&need("cam1", "cam1=[f 0 cx; 0 f cy; 0 0 1]")?)?;
    let baseline = need("baseline", "baseline=<millimetres>")?;
    let [baseline_mm] = numbers(baseline.key, baseline.line, baseline.value)?;
    if let Some(entry) = find("doffs")? {
        // The offset follows from the principal points: the key says it again.
        let [doffs] = numbers(entry.key, entry.line, entry.value)?;
        let between = cam1.cx - cam0.cx;
        if (doffs - between).abs() > PIXEL_TOLERANCE {
            return Err(Fault::Offset { doffs, between });
        }
    }
    let size = |key| find(key)?.map(|entry| whole(&entry)).transpose();
    Ok(Calibration {
        path: PathBuf::new(),
        format: "Middlebury",
        rig: rig(cam0, cam1, "baseline", baseline_mm / 1000.0)?,
        width: size("width")?,
        height: size("height")?,
        disparities: size("ndisp")?,
    })
}

/// The one line of a key, if there is one.
fn find<'a>(text: &'a str, wanted: &str) -> Result<Option<Entry<'a>>, Fault> {
    let mut found = entries(text).filter(|entry| entry.key == wanted);
    match (found.next(), found.next()) {
        (_, Some(second)) => Err(Fault::Twice { key: wanted.into(), line: second.line }),
        (first, None) => Ok(first),
    }
}

/// fx, skew, cx, fy, cy of both cameras, with their keys.
pub(super) fn matrices(text: &str) -> Result<[(String, [f64; 5]); 2], Fault> {
    let of = |key: &str| {
        let entry =
            find(text, key)?.ok_or_else(|| Fault::Missing(key.into(), "[fx 0 cx; 0 fy cy; 0 0 1]"))?;
        let [fx, skew, cx, _, fy, cy, _, _, _] = numbers(entry.key, entry.line, &inside(&entry))?;
        Ok((key.to_owned(), [fx, skew, cx, fy, cy]))
    };
    Ok([of("cam0")?, of("cam1")?])
}

/// `[fx 0 cx; 0 fy cy; 0 0 1]`.
fn camera<'a>(entry: &Entry<'a>) -> Result<Intrinsics<'a>, Fault> {
    let [fx, _, cx, _, fy, cy, last @ ..] = numbers::<9>(entry.key, entry.line, &inside(entry))?;
    if last != [0.0, 0.0, 1.0] {
        let problem = "its last row has to be 0 0 1, as in [f 0 cx; 0 f cy; 0 0 1]";
        return Err(Fault::Key { key: entry.key.into(), problem: problem.into() });
    }
    Ok(Intrinsics { key: entry.key, fx, fy, cx, cy })
}

/// The numbers between the brackets.
fn inside(entry: &Entry) -> String {
    entry.value.trim_start_matches('[').trim_end_matches(']').replace([';', ','], " ")
}

fn whole(entry: &Entry) -> Result<u16, Fault> {
    entry.value.parse().ok().filter(|&size| size > 0).ok_or_else(|| Fault::NotASize {
        key: entry.key.into(),
        line: entry.line,
        found: entry.value.into(),
    })
}
