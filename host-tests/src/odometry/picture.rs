//! A trajectory drawn as lines and text: from above, and from the side.

use super::trajectory::Trajectory;
use crate::live::COLOURS;
use nalgebra::Vector3;
use std::fmt::Write;
use stereopsis::geometry::camera::Pose;

/// Sides of a view and its margin, px of the drawing.
const SIDE: f64 = 480.0;
const MARGIN: f64 = 50.0;
/// Lines of a grid, at most.
const MOST_LINES: u8 = 16;

/// The trajectory as SVG: X to the right and Z up, as from above, and Y down over Z, as from the side; with a
/// truth drawn behind it. A dot is a frame of which the pose is not fully known. `unit` names the unit of
/// length.
pub fn svg(trajectory: &Trajectory, truth: Option<&[Pose<f64>]>, unit: &str) -> String {
    let steps = trajectory.steps.iter().enumerate();
    let unknown: Vec<_> = steps.filter(|(_, step)| !step.state.is_known()).map(|(frame, _)| frame).collect();
    let poses = &trajectory.poses;
    page(&Drawn { poses, unknown: &unknown, points: &[], truth: truth.unwrap_or_default() }, unit)
}

/// The style, after the colours that every page has.
const STYLE: &str = "text { fill: var(--fore); font: 13px system-ui, sans-serif; } .quiet { fill: \
                     var(--quiet); } .back { fill: var(--back); } .card { fill: var(--card); stroke: \
                     var(--line); } .grid { stroke: var(--line); } .found { fill: none; stroke: \
                     var(--accent); stroke-width: 2; } .truth { fill: none; stroke: var(--quiet); \
                     stroke-opacity: .6; stroke-width: 5; } .view { fill: var(--accent); } .lost { fill: \
                     var(--wrong); } .point { fill: var(--quiet); }";

/// Both views, with what their lines and dots mean below.
fn page(drawn: &Drawn<'_>, unit: &str) -> String {
    let width = 2.0 * SIDE + 3.0 * MARGIN;
    let height = SIDE + 2.0 * MARGIN;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" role=\"img\" \
         aria-label=\"The way from above and from the side\"><style>{COLOURS}{STYLE}</style><rect \
         class=\"back\" width=\"{width}\" height=\"{height}\"/>\n"
    );
    let above = |p: &Vector3<f64>| [p.x, -p.z];
    let beside = |p: &Vector3<f64>| [p.z, p.y];
    // The unit may be a sentence.
    let unit = if unit.len() > 20 { "no known unit" } else { unit };
    view(&mut svg, drawn, (above, -1.0), MARGIN, &format!("from above: X right, Z up, {unit}"));
    let title = format!("from the side: Z right, Y down, {unit}");
    view(&mut svg, drawn, (beside, 1.0), SIDE + 2.0 * MARGIN, &title);
    legend(&mut svg, drawn);
    svg.push_str("</svg>\n");
    svg
}

/// What lines and dots mean, as far as there are any.
fn legend(svg: &mut String, drawn: &Drawn<'_>) {
    let y = SIDE + 1.6 * MARGIN;
    let line = |class: &str| format!("<path class=\"{class}\" d=\"M0 0h24\"/>");
    let dot = |class: &str, radius: u8| format!("<circle class=\"{class}\" cx=\"12\" r=\"{radius}\"/>");
    let (is_of_views, has_lost) = (!drawn.points.is_empty(), !drawn.unknown.is_empty());
    let all = [
        (!is_of_views, line("found"), "found"),
        (!drawn.truth.is_empty(), line("truth"), "truth"),
        (has_lost, dot("lost", 3), "lost, or not fully known"),
        (is_of_views, dot("view", 4), "views, in their order"),
        (is_of_views, dot("point", 1), "points"),
    ];
    let mut x = MARGIN;
    for (_, mark, name) in all.into_iter().filter(|(is_there, _, _)| *is_there) {
        let _ = writeln!(
            svg,
            "<g transform=\"translate({x} {y})\">{mark}<text x=\"32\" y=\"4\">{name}</text></g>"
        );
        x += 56.0 + 7.5 * name.len() as f64;
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
fn view(
    svg: &mut String,
    drawn: &Drawn<'_>,
    (of, down): (impl Fn(&Vector3<f64>) -> [f64; 2], f64),
    left: f64,
    title: &str,
) {
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
        "<text x=\"{left}\" y=\"{}\">{title}</text><rect class=\"card\" x=\"{left}\" y=\"{MARGIN}\" \
         width=\"{SIDE}\" height=\"{SIDE}\"/>",
        MARGIN - 12.0
    );
    grid(svg, left, middle, extent, down);
    for place in &near {
        let (x, y) = at(place);
        let _ = writeln!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"1\" class=\"point\"/>");
    }
    let mut line = |places: &[Vector3<f64>], class: &str| {
        let points: Vec<String> = places.iter().map(at).map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
        let _ = writeln!(svg, "<polyline class=\"{class}\" points=\"{}\"/>", points.join(" "));
    };
    line(&truth, "truth");
    line(&poses, "found");
    if !drawn.points.is_empty() {
        for place in &poses {
            let (x, y) = at(place);
            let _ = writeln!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"4\" class=\"view\"/>");
        }
    }
    for &frame in drawn.unknown {
        let (x, y) = at(&poses[frame]);
        let _ = writeln!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3\" class=\"lost\"/>");
    }
}

/// Lines at round lengths, four to ten of them, which are written at the lower and the left edge. `down` is 1
/// where what is drawn downward is written as it is, -1 where it is turned round.
fn grid(svg: &mut String, left: f64, middle: [f64; 2], extent: f64, down: f64) {
    let quarter = extent / 4.0;
    let power = 10.0_f64.powf(quarter.log10().floor());
    let step = [5.0, 2.0, 1.0].into_iter().find(|n| n * power <= quarter).unwrap_or(1.0) * power;
    let half = extent / 2.0 / 0.95;
    for (axis, from) in [left, MARGIN].into_iter().enumerate() {
        let first = ((middle[axis] - half) / step).ceil();
        let places = (0..MOST_LINES).map(|n| (first + f64::from(n)) * step);
        for place in places.take_while(|place| *place <= middle[axis] + half) {
            let at = from + SIDE * (0.5 + 0.95 * (place - middle[axis]) / extent);
            // No minus before zero.
            let length = if axis == 0 { place } else { down * place } + 0.0;
            let length = if step < 1.0 { format!("{length:.3}") } else { format!("{length}") };
            let _ = if axis == 0 {
                writeln!(
                    svg,
                    "<path class=\"grid\" d=\"M{at:.2} {MARGIN}v{SIDE}\"/><text class=\"quiet\" \
                     x=\"{at:.2}\" y=\"{}\" text-anchor=\"middle\">{length}</text>",
                    MARGIN + SIDE + 15.0
                )
            } else {
                writeln!(
                    svg,
                    "<path class=\"grid\" d=\"M{left} {at:.2}h{SIDE}\"/><text class=\"quiet\" x=\"{}\" \
                     y=\"{:.2}\" text-anchor=\"end\">{length}</text>",
                    left - 5.0,
                    at + 4.0
                )
            };
        }
    }
}
