//! What the page's scripts look at: colours, names, the figures of `stereo plan`, and pictures.

use crate::colour::{FLAG_COLOURS, diverging, viridis};
use crate::plan::{CORES, Tables};
use crate::run::MethodName;
use crate::scene::Scene;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{DynamicImage, ImageFormat, RgbImage};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::io::{self, Cursor};
use stereopsis::geometry::camera::{ImageSize, RectifiedRig};
use stereopsis::matching::{Config, Row};
use stereopsis::units::PixelFlags;

/// The columns of the ramp of colours.
const RAMP: u16 = 9;
/// Disparities are searched in multiples of this.
const STEP: u16 = 16;

/// A pair that the page begins with.
pub struct Given<'a> {
    /// The names of both pictures.
    pub names: [&'a str; 2],
    /// The pictures.
    pub pictures: [&'a RgbImage; 2],
    /// The cameras, where they are known.
    pub rig: Option<RectifiedRig>,
    /// How many whole disparities are searched at first.
    pub disparities: u16,
}

#[derive(Serialize)]
struct Picture<'a> {
    name: &'a str,
    url: String,
}

/// All of it as JSON that can stand in a script.
pub(super) fn json(given: Option<&Given<'_>>) -> io::Result<String> {
    let scene = Scene::demo();
    let (left, right) = scene.render();
    let pictures = [left, right].map(|grey| DynamicImage::from(grey).into_rgb8());
    let scene = Given {
        names: ["left.png", "right.png"],
        pictures: pictures.each_ref(),
        rig: Some(scene.rig()),
        disparities: scene.disparities(),
    };
    let mut data = looks();
    let more = json!({
        "cores": CORES,
        "ram": of_methods(|method| json!(ram(method))),
        "work": work(),
        "scene": scene.json()?,
        "given": given.map(Given::json).transpose()?,
    });
    data.extend(more.as_object().cloned().unwrap_or_default());
    Ok(in_script(data))
}

/// Data as JSON that can stand in a script: no text of it ends that.
pub fn in_script(data: Map<String, Value>) -> String {
    Value::Object(data).to_string().replace('<', "\\u003c")
}

/// The colours and names that every page's views have.
pub fn looks() -> Map<String, Value> {
    let flags = PixelFlags::NAMES.iter().zip(FLAG_COLOURS);
    let flags: Vec<_> = flags
        .map(|((flag, name), colour)| json!({ "name": name, "bit": flag.bits(), "colour": colour.0 }))
        .collect();
    let ramp = (0..RAMP).map(|step| viridis(f32::from(step) / f32::from(RAMP - 1)).0);
    let errors = [-1.0, 0.0, 1.0].map(|t| diverging(t).0);
    Map::from_iter([
        ("ramp".into(), json!(ramp.collect::<Vec<_>>())),
        ("flags".into(), json!(flags)),
        ("most_confidence".into(), json!(Row::MOST_CONFIDENCE)),
        ("errors".into(), json!(errors)),
    ])
}

impl Given<'_> {
    fn json(&self) -> io::Result<Value> {
        let picture = |side: usize| {
            let mut png = Cursor::new(Vec::new());
            let colours = DynamicImage::from(self.pictures[side].clone());
            let is_grey = self.pictures[side].pixels().all(|p| p[0] == p[1] && p[1] == p[2]);
            // A grey picture takes a third as one.
            let picture = if is_grey { DynamicImage::from(colours.into_luma8()) } else { colours };
            picture.write_to(&mut png, ImageFormat::Png).map_err(io::Error::other)?;
            let url = format!("data:image/png;base64,{}", STANDARD.encode(png.into_inner()));
            Ok::<_, io::Error>(Picture { name: self.names[side], url })
        };
        Ok(json!({
            "left": picture(0)?,
            "right": picture(1)?,
            "rig": self.rig.as_ref().map_or(json!({}), cameras),
            "disparities": self.disparities,
        }))
    }
}

/// What the scripts know of cameras.
pub fn cameras(rig: &RectifiedRig) -> Value {
    let (column, row) = rig.principal_point();
    let exact = |value: f32| rounded(f64::from(value));
    json!({
        "focal_px": exact(rig.focal_px()),
        "baseline_mm": rounded(f64::from(rig.baseline_m()) * 1000.0),
        "offset_px": exact(rig.disparity_offset_px()),
        "centre_px": [exact(column), exact(row)],
    })
}

/// Seven digits, which is what an `f32` has.
fn rounded(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}

fn of_methods(value: impl Fn(MethodName) -> Value) -> Value {
    Value::Object(
        MethodName::ALL.into_iter().map(|method| (method.name().to_owned(), value(method))).collect(),
    )
}

/// What a pipeline's bytes are made of: for each pixel of a row and candidate, each pixel of a row, each
/// candidate, all, and for rows of no whole words.
fn ram(method: MethodName) -> [i64; 5] {
    const COLUMNS: [u16; 2] = [256, 512];
    const LANES: [u16; 2] = [16, 32];
    let bytes = |width, lanes| method.pipeline_bytes(width, lanes) as i64;
    let [[a, b], [c, d]] = COLUMNS.map(|width| LANES.map(|lanes| bytes(width, lanes)));
    let (columns, lanes) = (i64::from(COLUMNS[1] - COLUMNS[0]), i64::from(LANES[1] - LANES[0]));
    let product = (d - c - b + a) / (columns * lanes);
    let per_column = (c - a) / columns - product * i64::from(LANES[0]);
    let per_lane = (b - a) / lanes - product * i64::from(COLUMNS[0]);
    let fixed = a
        - product * i64::from(COLUMNS[0]) * i64::from(LANES[0])
        - per_column * i64::from(COLUMNS[0])
        - per_lane * i64::from(LANES[0]);
    // One column more than whole words.
    let padding = bytes(COLUMNS[0] + 1, LANES[0]) - a - per_column - product * i64::from(LANES[0]);
    [product, per_column, per_lane, fixed, padding]
}

/// Instructions for a pixel, by core and method, at 16 disparities, 32 and so on.
fn work() -> Value {
    let tables = Tables::read();
    // The work of a frame is that of its pixels.
    let one = ImageSize { width: 100, height: 100 };
    let each = |core: &'static str| {
        of_methods(|method| {
            let counts = (1..=Config::MOST_DISPARITIES / STEP).map(|steps| {
                let work = tables.work(core, 1.0, method, one, steps * STEP);
                work.map(|work| rounded(work.instructions / 1e4))
            });
            json!(counts.collect::<Vec<_>>())
        })
    };
    Value::Object(CORES.into_iter().map(|(core, _)| (core.to_owned(), each(core))).collect::<Map<_, _>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_of_any_size_are_the_pipelines() {
        for method in MethodName::ALL {
            let [product, per_column, per_lane, fixed, padding] = ram(method);
            for (width, disparities) in [(160, 32), (320, 64), (640, 64), (641, 128), (643, 128), (1280, 256)]
            {
                let (columns, lanes) = (i64::from(width), i64::from(disparities));
                let fixed = fixed + if columns % 4 == 0 { 0 } else { padding };
                let bytes = product * columns * lanes + per_column * columns + per_lane * lanes + fixed;
                assert_eq!(bytes, method.pipeline_bytes(width, disparities) as i64, "{method} {width}");
            }
        }
    }

    #[test]
    fn a_name_does_not_end_the_script() {
        let picture = RgbImage::new(2, 2);
        let names = ["</script>.png", "b.png"];
        let given = Given { names, pictures: [&picture, &picture], rig: None, disparities: 16 };
        let text = json(Some(&given)).expect("it is written");
        assert!(!text.contains('<') && text.contains("\\u003c/script>.png"));
        let read: Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(read["given"]["left"]["name"], names[0]);
        assert_eq!(read["cores"][2][0], "m4");
    }
}
