//! A trajectory drawn as lines and text: from above, and from the side.

use super::run::Trajectory;
use std::fmt::Write;
use stereopsis::geometry::Pose;

/// Sides of a view and its margin, px of the drawing.
const SIDE: f64 = 480.0;
const MARGIN: f64 = 50.0;

/// The trajectory as SVG: X to the right and Z up, as from above, and Y down over Z, as from the side; with a truth drawn behind
/// it. A dot is a frame of which the pose is not fully known. `unit` names the unit of length.
pub fn svg(trajectory: &Trajectory, truth: Option<&[Pose<f64>]>, unit: &str) -> String {
    let width = 2.0 * SIDE + 3.0 * MARGIN;
    let height = SIDE + 2.0 * MARGIN;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         font-size=\"13\"><rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    let above = |p: &Pose<f64>| [p.translation().x, -p.translation().z];
    let beside = |p: &Pose<f64>| [p.translation().z, p.translation().y];
    view(&mut svg, trajectory, truth, above, MARGIN, &format!("from above: X right, Z up, {unit}"));
    view(&mut svg, trajectory, truth, beside, SIDE + 2.0 * MARGIN, &format!("from the side: Z right, Y down, {unit}"));
    svg.push_str("</svg>\n");
    svg
}

/// One view, in a square whose left edge is at `left`.
fn view(
    svg: &mut String,
    trajectory: &Trajectory,
    truth: Option<&[Pose<f64>]>,
    of: impl Fn(&Pose<f64>) -> [f64; 2],
    left: f64,
    title: &str,
) {
    let (mut least, mut most) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for pose in trajectory.poses.iter().chain(truth.unwrap_or_default()) {
        for (axis, x) in of(pose).into_iter().enumerate() {
            least[axis] = least[axis].min(x);
            most[axis] = most[axis].max(x);
        }
    }
    let extent = (most[0] - least[0]).max(most[1] - least[1]).max(1e-9);
    let middle = [0, 1].map(|axis| (least[axis] + most[axis]) / 2.0);
    let at = |pose: &Pose<f64>| {
        let [x, y] = of(pose);
        let place = |x: f64, middle: f64| SIDE * (0.5 + 0.95 * (x - middle) / extent);
        (left + place(x, middle[0]), MARGIN + place(y, middle[1]))
    };
    let _ = writeln!(
        svg,
        "<text x=\"{left}\" y=\"{}\">{title}</text><rect x=\"{left}\" y=\"{MARGIN}\" width=\"{SIDE}\" height=\"{SIDE}\" \
         fill=\"none\" stroke=\"#ccc\"/>",
        MARGIN - 12.0
    );
    let mut line = |poses: &[Pose<f64>], colour: &str, thick: f64| {
        let points: Vec<String> = poses.iter().map(at).map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{thick}\"/>",
            points.join(" ")
        );
    };
    line(truth.unwrap_or_default(), "#bbb", 4.0);
    line(&trajectory.poses, "#06c", 1.5);
    for (pose, step) in trajectory.poses.iter().zip(&trajectory.steps) {
        if !step.state.is_known() {
            let (x, y) = at(pose);
            let _ = writeln!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3\" fill=\"#c30\"/>");
        }
    }
    // A bar of a round length, about a quarter of the view.
    let quarter = extent / 4.0;
    let power = 10.0_f64.powf(quarter.log10().floor());
    let bar = [5.0, 2.0, 1.0].into_iter().find(|n| n * power <= quarter).unwrap_or(1.0) * power;
    let (x, y) = (left + 10.0, MARGIN + SIDE - 12.0);
    let _ = writeln!(
        svg,
        "<path d=\"M{x} {y}h{:.2}\" stroke=\"black\" stroke-width=\"2\"/><text x=\"{x}\" y=\"{}\">{bar}</text>",
        SIDE * 0.95 * bar / extent,
        y - 6.0
    );
}
