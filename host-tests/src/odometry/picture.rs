//! A trajectory drawn as lines and text: from above, and from the side.

use super::trajectory::Trajectory;
use nalgebra::Vector3;
use std::fmt::Write;
use stereopsis::geometry::camera::Pose;

/// Sides of a view and its margin, px of the drawing.
const SIDE: f64 = 480.0;
const MARGIN: f64 = 50.0;
/// Colours of the way, of the true one, of frames whose pose is not fully known, and of points.
const FOUND: &str = "#06c";
const TRUTH: &str = "#bbb";
const UNKNOWN: &str = "#c30";
const POINT: &str = "#999";

/// The trajectory as SVG: X to the right and Z up, as from above, and Y down over Z, as from the side; with a
/// truth drawn behind it, a grid of round lengths, and what is what below. A dot is a frame of which the pose
/// is not fully known. `unit` names the unit of length.
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
    legend(&mut svg, drawn, SIDE + MARGIN + 28.0);
    svg.push_str("</svg>\n");
    svg
}

/// What each line and dot is, one beside the other at height `y`.
fn legend(svg: &mut String, drawn: &Drawn<'_>, y: f64) {
    let line = |x: f64, colour: &str, thick: f64| {
        format!("<path d=\"M{x} {y}h24\" stroke=\"{colour}\" stroke-width=\"{thick}\"/>")
    };
    let dot = |x: f64, colour: &str, radius: f64| {
        format!("<circle cx=\"{}\" cy=\"{y}\" r=\"{radius}\" fill=\"{colour}\"/>", x + 12.0)
    };
    type Sign<'a> = Box<dyn Fn(f64) -> String + 'a>;
    let all: [(bool, &str, Sign<'_>); 4] = [
        (true, "found", Box::new(|x| line(x, FOUND, 1.5))),
        (!drawn.truth.is_empty(), "truth", Box::new(|x| line(x, TRUTH, 4.0))),
        (!drawn.unknown.is_empty(), "lost, or not fully known", Box::new(|x| dot(x, UNKNOWN, 3.0))),
        (!drawn.points.is_empty(), "points", Box::new(|x| dot(x, POINT, 2.0))),
    ];
    let mut x = MARGIN;
    for (_, text, sign) in all.iter().filter(|(is_there, ..)| *is_there) {
        let _ = writeln!(svg, "{}<text x=\"{}\" y=\"{}\">{text}</text>", sign(x), x + 32.0, y + 4.0);
        x += 60.0 + 7.0 * text.len() as f64;
    }
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
    // Lines of a round length apart, about a quarter of the view.
    let quarter = extent / 4.0;
    let power = 10.0_f64.powf(quarter.log10().floor());
    let step = [5.0, 2.0, 1.0].into_iter().find(|n| n * power <= quarter).unwrap_or(1.0) * power;
    let shown = extent / 0.95 / 2.0;
    let mut grid = String::new();
    for (axis, corner) in [left, MARGIN].into_iter().enumerate() {
        let first = ((middle[axis] - shown) / step).ceil();
        for k in 0..((middle[axis] + shown) / step - first + 1.0).max(0.0) as usize {
            let off = (first + k as f64) * step - middle[axis];
            let place = corner + SIDE * (0.5 + 0.95 * off / extent);
            let _ = match axis {
                0 => write!(grid, "M{place:.2} {MARGIN}v{SIDE}"),
                _ => write!(grid, "M{left} {place:.2}h{SIDE}"),
            };
        }
    }
    let _ = writeln!(svg, "<path d=\"{grid}\" stroke=\"#eee\"/>");
    for place in &near {
        let (x, y) = at(place);
        let _ = writeln!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"1\" fill=\"{POINT}\"/>");
    }
    let mut line = |places: &[Vector3<f64>], colour: &str, thick: f64| {
        let points: Vec<String> = places.iter().map(at).map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{thick}\"/>",
            points.join(" ")
        );
    };
    line(&truth, TRUTH, 4.0);
    line(&poses, FOUND, 1.5);
    if !drawn.points.is_empty() {
        for place in &poses {
            let (x, y) = at(place);
            let _ = writeln!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"4\" fill=\"{FOUND}\"/>");
        }
    }
    for &frame in drawn.unknown {
        let (x, y) = at(&poses[frame]);
        let _ = writeln!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3\" fill=\"{UNKNOWN}\"/>");
    }
    // A bar as long as the lines are apart.
    let (x, y) = (left + 10.0, MARGIN + SIDE - 12.0);
    let _ = writeln!(
        svg,
        "<path d=\"M{x} {y}h{:.2}\" stroke=\"black\" stroke-width=\"2\"/><text x=\"{x}\" \
         y=\"{}\">{step}</text>",
        SIDE * 0.95 * step / extent,
        y - 6.0
    );
}
