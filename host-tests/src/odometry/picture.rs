//! A trajectory drawn as lines and text: from above, and from the side.

use super::trajectory::Trajectory;
use nalgebra::Vector3;
use std::fmt::Write;
use stereopsis::geometry::camera::Pose;

/// Sides of a view and its margin, px of the drawing.
const SIDE: f64 = 480.0;
const MARGIN: f64 = 50.0;

/// The trajectory as SVG: X to the right and Z up, as from above, and Y down over Z, as from the side; with a
/// truth drawn behind it. A dot is a frame of which the pose is not fully known. `unit` names the unit of
/// length.
pub fn svg(trajectory: &Trajectory, truth: Option<&[Pose<f64>]>, unit: &str) -> String {
    let steps = trajectory.steps.iter().enumerate();
    let unknown: Vec<_> = steps.filter(|(_, step)| !step.state.is_known()).map(|(frame, _)| frame).collect();
    let poses = &trajectory.poses;
    page(&Drawn { poses, unknown: &unknown, points: &[], truth: truth.unwrap_or_default() }, unit)
}

/// Both views.
fn page(drawn: &Drawn<'_>, unit: &str) -> String {
    let width = 2.0 * SIDE + 3.0 * MARGIN;
    let height = SIDE + 2.0 * MARGIN;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\" font-size=\"13\"><rect width=\"{width}\" height=\"{height}\" \
         fill=\"white\"/>\n"
    );
    let above = |p: &Vector3<f64>| [p.x, -p.z];
    let beside = |p: &Vector3<f64>| [p.z, p.y];
    // The unit may be a sentence.
    let unit = if unit.len() > 20 { "no known unit" } else { unit };
    view(&mut svg, drawn, above, MARGIN, &format!("from above: X right, Z up, {unit}"));
    view(&mut svg, drawn, beside, SIDE + 2.0 * MARGIN, &format!("from the side: Z right, Y down, {unit}"));
    svg.push_str("</svg>\n");
    svg
}

/// Views drawn the same way, with the points that they saw.
pub fn svg_of(poses: &[Pose<f64>], points: &[Vector3<f64>], unit: &str) -> String {
    page(&Drawn { poses, unknown: &[], points, truth: &[] }, unit)
}

/// What is drawn.
struct Drawn<'a> {
    poses: &'a [Pose<f64>],
    /// Frames whose pose is not fully known.
    unknown: &'a [usize],
    points: &'a [Vector3<f64>],
    truth: &'a [Pose<f64>],
}

/// One view, in a square whose left edge is at `left`.
fn view(svg: &mut String, drawn: &Drawn<'_>, of: impl Fn(&Vector3<f64>) -> [f64; 2], left: f64, title: &str) {
    let places = |poses: &[Pose<f64>]| poses.iter().map(|pose| *pose.translation()).collect::<Vec<_>>();
    let (poses, truth) = (places(drawn.poses), places(drawn.truth));
    let mut shown = [poses.clone(), truth.clone()].concat();
    // Of the points those that are not the farthest tenth.
    let mut near: Vec<_> = drawn.points.to_vec();
    near.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    near.truncate(near.len() * 9 / 10);
    shown.extend(&near);
    let (mut least, mut most) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for place in &shown {
        for (axis, x) in of(place).into_iter().enumerate() {
            least[axis] = least[axis].min(x);
            most[axis] = most[axis].max(x);
        }
    }
    let extent = (most[0] - least[0]).max(most[1] - least[1]).max(1e-9);
    let middle = [0, 1].map(|axis| (least[axis] + most[axis]) / 2.0);
    let at = |place: &Vector3<f64>| {
        let [x, y] = of(place);
        let along = |x: f64, middle: f64| SIDE * (0.5 + 0.95 * (x - middle) / extent);
        (left + along(x, middle[0]), MARGIN + along(y, middle[1]))
    };
    let _ = writeln!(
        svg,
        "<text x=\"{left}\" y=\"{}\">{title}</text><rect x=\"{left}\" y=\"{MARGIN}\" width=\"{SIDE}\" \
         height=\"{SIDE}\" fill=\"none\" stroke=\"#ccc\"/>",
        MARGIN - 12.0
    );
    for place in &near {
        let (x, y) = at(place);
        let _ = writeln!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"1\" fill=\"#999\"/>");
    }
    let mut line = |places: &[Vector3<f64>], colour: &str, thick: f64| {
        let points: Vec<String> = places.iter().map(at).map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{thick}\"/>",
            points.join(" ")
        );
    };
    line(&truth, "#bbb", 4.0);
    line(&poses, "#06c", 1.5);
    if !drawn.points.is_empty() {
        for place in &poses {
            let (x, y) = at(place);
            let _ = writeln!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"4\" fill=\"#06c\"/>");
        }
    }
    for &frame in drawn.unknown {
        let (x, y) = at(&poses[frame]);
        let _ = writeln!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3\" fill=\"#c30\"/>");
    }
    // A bar of a round length, about a quarter of the view.
    let quarter = extent / 4.0;
    let power = 10.0_f64.powf(quarter.log10().floor());
    let bar = [5.0, 2.0, 1.0].into_iter().find(|n| n * power <= quarter).unwrap_or(1.0) * power;
    let (x, y) = (left + 10.0, MARGIN + SIDE - 12.0);
    let _ = writeln!(
        svg,
        "<path d=\"M{x} {y}h{:.2}\" stroke=\"black\" stroke-width=\"2\"/><text x=\"{x}\" \
         y=\"{}\">{bar}</text>",
        SIDE * 0.95 * bar / extent,
        y - 6.0
    );
}
