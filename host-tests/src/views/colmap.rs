//! A structure as COLMAP's text model: cameras.txt, images.txt, points3D.txt (Schoenberger & Frahm 2016).

use super::link::Links;
use super::solve::Found;
use nalgebra::{Point3, Rotation3, UnitQuaternion};
use std::io::{self, Write};
use stereopsis::geometry::camera::{Camera, ImageSize, Lens, Pose};
use stereopsis::motion::bundle::Observation;

/// Pixel centres are at halves there, at integers here.
const CENTRE: f64 = 0.5;

/// What a model is written of: a structure in the frame of its first view.
pub struct Model<'a> {
    camera: &'a Camera<f64>,
    size: ImageSize,
    names: &'a [String],
    poses: Vec<Option<Pose<f64>>>,
    points: Vec<(u32, Point3<f64>)>,
    /// What agrees with the points, with how far it is off, px.
    kept: Vec<(Observation<f64>, f64)>,
}

impl<'a> Model<'a> {
    /// A structure's views, points and what agrees with them within the threshold.
    pub fn new(
        (camera, size): (&'a Camera<f64>, ImageSize),
        names: &'a [String],
        links: &Links,
        found: &Found,
        threshold_px: f64,
    ) -> Self {
        let (poses, points) = (found.beside_first(), found.known());
        let off = |observation: &Observation<f64>| {
            let pose = (*poses.get(usize::from(observation.view))?)?;
            let at = points.binary_search_by_key(&observation.point, |point| point.0).ok()?;
            let seen = camera.project(&pose.inverse_transform(&points[at].1)).ok()?;
            Some((seen - observation.pixel).norm()).filter(|&off| off <= threshold_px)
        };
        let kept = links.observations.iter().filter_map(|o| Some((*o, off(o)?))).collect();
        Self { camera, size, names, poses, points, kept }
    }

    /// How many points each view sees where they are; `None` of one that stands nowhere.
    pub fn sights(&self) -> Vec<Option<usize>> {
        let count = |view| self.kept.iter().filter(|(o, _)| usize::from(o.view) == view).count();
        self.poses.iter().enumerate().map(|(view, pose)| pose.map(|_| count(view))).collect()
    }

    /// The one camera, by the model of COLMAP's that has its lens.
    pub fn cameras(&self, out: &mut dyn Write) -> io::Result<()> {
        let (fx, fy) = self.camera.focal_px();
        let (cx, cy) = self.camera.principal_point();
        let (model, lens): (_, Vec<f64>) = match self.camera.lens() {
            lens if lens.is_none() => ("PINHOLE", Vec::new()),
            Lens::Fisheye(fisheye) => ("OPENCV_FISHEYE", fisheye.to_opencv().to_vec()),
            Lens::BrownConrady(lens) => match lens.to_opencv() {
                [k1, k2, p1, p2, 0.0, 0.0, 0.0, 0.0] => ("OPENCV", vec![k1, k2, p1, p2]),
                all => ("FULL_OPENCV", all.to_vec()),
            },
            _ => return Err(io::Error::other("the lens has no model there")),
        };
        writeln!(out, "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]")?;
        let ImageSize { width, height } = self.size;
        write!(out, "1 {model} {width} {height}")?;
        for value in [fx, fy, cx + CENTRE, cy + CENTRE].into_iter().chain(lens) {
            write!(out, " {value}")?;
        }
        writeln!(out)
    }

    /// Every view that stands somewhere, and below it what it sees of the points.
    pub fn images(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then POINTS2D[] as X Y POINT3D_ID")?;
        for (view, (name, pose)) in self.names.iter().zip(&self.poses).enumerate() {
            let Some(pose) = pose else { continue };
            let (rotation, t) = pose.to_opencv();
            let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
            let (w, v) = (q.w, q.imag());
            let [x, y, z, tx, ty, tz] = [v.x, v.y, v.z, t.x, t.y, t.z].map(|x| x + 0.0);
            writeln!(out, "{} {w} {x} {y} {z} {tx} {ty} {tz} 1 {name}", view + 1)?;
            let own = self.kept.iter().filter(|(o, _)| usize::from(o.view) == view);
            let own: Vec<String> = own
                .map(|(o, _)| format!("{:.4} {:.4} {}", o.pixel.x + CENTRE, o.pixel.y + CENTRE, o.point + 1))
                .collect();
            writeln!(out, "{}", own.join(" "))?;
        }
        Ok(())
    }

    /// Every point with its colour, its mean residual, and which images see it at which place of their lists.
    pub fn points(&self, out: &mut dyn Write, colour: impl Fn(u32) -> [u8; 3]) -> io::Result<()> {
        writeln!(out, "# POINT3D_ID X Y Z R G B ERROR TRACK[] as IMAGE_ID POINT2D_IDX")?;
        let mut places = vec![0_usize; self.poses.len()];
        let mut kept = self.kept.iter().peekable();
        for &(number, point) in &self.points {
            let (mut track, mut sum, mut count) = (String::new(), 0.0, 0.0);
            while let Some((observation, off)) = kept.next_if(|(o, _)| o.point <= number) {
                let place = &mut places[usize::from(observation.view)];
                track += &format!(" {} {place}", observation.view + 1);
                (*place, sum, count) = (*place + 1, sum + off, count + 1.0);
            }
            let [r, g, b] = colour(number);
            let mean = if count > 0.0 { sum / count } else { 0.0 };
            let (x, y, z) = (point.x, point.y, point.z);
            writeln!(out, "{} {x} {y} {z} {r} {g} {b} {mean:.4}{track}", number + 1)?;
        }
        Ok(())
    }
}
