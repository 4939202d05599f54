//! Known points looked for in every view that ought to show them: guided matching by the poses and points of
//! a first structure, and template alignment under the surface around a point.

use super::link::Links;
use super::solve::Found;
use super::surface::Surface;
use crate::correspond_refine::picture;
use image::GrayImage;
use nalgebra::{Point2, Point3};
use stereopsis::features::Template;
use stereopsis::geometry::camera::{Camera, Pose};
use stereopsis::imaging::Picture;
use stereopsis::motion::bundle::Observation;

/// Views in which a point is looked for at most: those whose rays are nearest to its first one's.
const MOST_VIEWS: usize = 10;
/// The cosine of the largest angle between two rays of a point.
const LEAST_COSINE: f64 = 0.5;
/// How far a place may lie from where the structure expects it, px.
const FARTHEST_PX: f32 = 2.0;
/// How alike the pixels have to be.
const LEAST_CORRELATION: f32 = 0.85;
/// Half the step by which the map between two views is differentiated, px.
const STEP_PX: f64 = 3.0;

/// A view that stands somewhere.
struct Standing<'a> {
    view: u16,
    pose: Pose<f64>,
    picture: Picture<'a>,
}

/// Where all views of a structure show its points: places of one reference view's pixels, to a small part of
/// a pixel. What is found nowhere anew keeps its old observations.
///
/// The reference of a point is the one of its views from which the others are seen at the least angles.
pub fn look_again(camera: &Camera<f64>, pictures: &[GrayImage], links: &Links, found: &Found) -> Links {
    let standing: Vec<_> = (0..)
        .zip(pictures.iter().zip(&found.poses))
        .filter_map(|(view, (image, pose))| {
            Some(Standing { view, pose: pose.ok()?, picture: picture(image)? })
        })
        .collect();
    let surfaces: Vec<_> = standing.iter().map(|s| surface(camera, s, links, found)).collect();
    let mut again = Links { points: links.points, ..Links::default() };
    for track in links.observations.chunk_by(|a, b| a.point == b.point) {
        let looked = track.first().and_then(|first| {
            let point = (*found.points.get(first.point as usize)?).ok()?;
            look_for(camera, &standing, &surfaces, track, &point)
        });
        match looked.filter(|looked| looked.len() >= 2) {
            Some(looked) => again.observations.extend(looked),
            None => again.observations.extend(track),
        }
    }
    again
}

/// What a view sees of the structure, as depths in its picture.
fn surface(camera: &Camera<f64>, standing: &Standing<'_>, links: &Links, found: &Found) -> Surface {
    let seen = links.observations.iter().filter(|observation| observation.view == standing.view);
    let depths = seen.filter_map(|observation| {
        let point = (*found.points.get(observation.point as usize)?).ok()?;
        let place = standing.pose.inverse_transform(&point);
        camera.project(&place).ok().map(|pixel| (pixel, place.z))
    });
    Surface::new(depths.collect())
}

/// The observations of one point, by the pixels of its reference view.
fn look_for(
    camera: &Camera<f64>,
    standing: &[Standing<'_>],
    surfaces: &[Surface],
    track: &[Observation<f64>],
    point: &Point3<f64>,
) -> Option<Vec<Observation<f64>>> {
    let ray = |at: usize| (point.coords - standing[at].pose.translation()).normalize();
    // Only what agrees with the point can be a reference.
    let agreeing: Vec<(usize, Observation<f64>)> = track
        .iter()
        .filter_map(|o| {
            let at = standing.iter().position(|s| s.view == o.view)?;
            let there = camera.project(&standing[at].pose.inverse_transform(point)).ok()?;
            ((there - o.pixel).norm() < f64::from(FARTHEST_PX)).then_some((at, *o))
        })
        .collect();
    let sum = |at: usize| agreeing.iter().map(|&(other, _)| ray(at).dot(&ray(other))).sum::<f64>();
    let &(at, reference) = agreeing.iter().max_by(|a, b| sum(a.0).total_cmp(&sum(b.0)))?;
    let mut others: Vec<(usize, f64)> = (0..standing.len())
        .filter(|&other| other != at)
        .map(|other| (other, ray(at).dot(&ray(other))))
        .filter(|&(_, cosine)| cosine > LEAST_COSINE)
        .collect();
    others.sort_by(|a, b| b.1.total_cmp(&a.1));
    let from = &standing[at];
    let template = Template::cut(&from.picture, reference.pixel.x as f32, reference.pixel.y as f32).ok()?;
    let depth = from.pose.inverse_transform(point).z;
    let slopes = [Some([0.0; 2]), surfaces[at].slope(&reference.pixel, depth)];
    let mut looked = vec![reference];
    for (other, _) in others.into_iter().take(MOST_VIEWS) {
        let to = &standing[other];
        let best = slopes.iter().flatten().filter_map(|slope| {
            let map = |offset: [f64; 2]| mapped(camera, from, to, &reference.pixel, depth, slope, offset);
            let start = map([0.0; 2])?;
            let column = |x: f64, y: f64| Some((map([x, y])? - map([-x, -y])?) / (2.0 * STEP_PX));
            let (right, down) = (column(STEP_PX, 0.0)?, column(0.0, STEP_PX)?);
            let warp = [[right.x as f32, down.x as f32], [right.y as f32, down.y as f32]];
            template.align(&to.picture, &warp, [start.x as f32, start.y as f32], FARTHEST_PX).ok()
        });
        let best = best.max_by(|a, b| a.correlation.total_cmp(&b.correlation));
        if let Some(best) = best.filter(|best| best.correlation >= LEAST_CORRELATION) {
            let pixel = Point2::new(f64::from(best.x_px), f64::from(best.y_px));
            looked.push(Observation { view: to.view, pixel, ..reference });
        }
    }
    looked.sort_by_key(|observation| observation.view);
    Some(looked)
}

/// Where `to` shows what `from` shows beside a pixel, of a surface whose inverse depth changes by `slope`
/// times its own a pixel.
fn mapped(
    camera: &Camera<f64>,
    from: &Standing<'_>,
    to: &Standing<'_>,
    pixel: &Point2<f64>,
    depth: f64,
    slope: &[f64; 2],
    [x, y]: [f64; 2],
) -> Option<Point2<f64>> {
    let ray = camera.unproject(&Point2::new(pixel.x + x, pixel.y + y)).ok()?;
    let inverse = (1.0 + slope[0] * x + slope[1] * y) / depth;
    let place = Point3::from(ray / (ray.z * inverse));
    camera.project(&to.pose.inverse_transform(&from.pose.transform(&place))).ok()
}
