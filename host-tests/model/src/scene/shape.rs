//! The bodies that a scene is made of.

use super::texture::Texture;
use nalgebra::{Point2, Point3, Rotation3, Vector3};
use stereopsis::geometry::camera::Pose;

/// A body in its own coordinates, metres: the origin is its middle.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// The plane z = 0 without end.
    Plane,
    /// The part of the plane z = 0 with |x| and |y| up to these.
    Rectangle {
        /// Half the extent in x.
        half_width: f64,
        /// Half the extent in y.
        half_height: f64,
    },
    /// A box with its edges along the axes.
    Cuboid {
        /// Half of its three edges.
        half: Vector3<f64>,
    },
    /// A ball.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A round bar along y, closed at both ends.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Half its length.
        half_height: f64,
    },
}

impl Shape {
    /// The smallest t > `nearest` for which `from + t along` lies on the surface.
    pub fn meet(&self, from: &Point3<f64>, along: &Vector3<f64>, nearest: f64) -> Option<f64> {
        let beyond = |t: f64| (t > nearest).then_some(t);
        match *self {
            Self::Plane => beyond(-from.z / along.z),
            Self::Rectangle { half_width, half_height } => beyond(-from.z / along.z).filter(|&t| {
                (from.x + t * along.x).abs() <= half_width && (from.y + t * along.y).abs() <= half_height
            }),
            Self::Cuboid { half } => {
                let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
                for axis in 0..3 {
                    let (a, b) =
                        ((-half[axis] - from[axis]) / along[axis], (half[axis] - from[axis]) / along[axis]);
                    enter = enter.max(a.min(b));
                    leave = leave.min(a.max(b));
                }
                if enter > leave { None } else { beyond(enter).or(beyond(leave)) }
            }
            Self::Sphere { radius } => {
                let (t0, t1) = roots(
                    along.norm_squared(),
                    along.dot(&from.coords),
                    from.coords.norm_squared() - radius * radius,
                )?;
                beyond(t0).or(beyond(t1))
            }
            Self::Cylinder { radius, half_height } => {
                let (t0, t1) = roots(
                    along.x * along.x + along.z * along.z,
                    along.x * from.x + along.z * from.z,
                    from.x * from.x + from.z * from.z - radius * radius,
                )?;
                let (a, b) = ((-half_height - from.y) / along.y, (half_height - from.y) / along.y);
                let (enter, leave) = (t0.max(a.min(b)), t1.min(a.max(b)));
                if enter > leave { None } else { beyond(enter).or(beyond(leave)) }
            }
        }
    }

    /// The outward direction, of length 1, at the point `p` of the surface.
    pub fn normal(&self, p: &Point3<f64>) -> Vector3<f64> {
        match *self {
            Self::Plane | Self::Rectangle { .. } => Vector3::z(),
            Self::Cuboid { half } => {
                let axis = p.coords.component_div(&half).iamax();
                let mut normal = Vector3::zeros();
                normal[axis] = p[axis].signum();
                normal
            }
            Self::Sphere { .. } => p.coords.normalize(),
            Self::Cylinder { radius, half_height } => {
                // The point is on an end if it is nearer to it than to the side.
                let side = (p.x * p.x + p.z * p.z).sqrt();
                if half_height - p.y.abs() < radius - side {
                    Vector3::y() * p.y.signum()
                } else {
                    Vector3::new(p.x, 0.0, p.z).normalize()
                }
            }
        }
    }

    /// Half of the box around the body; `None` for a body without end.
    fn half_extent(&self) -> Option<Vector3<f64>> {
        match *self {
            Self::Plane => None,
            Self::Rectangle { half_width, half_height } => Some(Vector3::new(half_width, half_height, 0.0)),
            Self::Cuboid { half } => Some(half),
            Self::Sphere { radius } => Some(Vector3::repeat(radius)),
            Self::Cylinder { radius, half_height } => Some(Vector3::new(radius, half_height, radius)),
        }
    }
}

/// The two t with a t^2 + 2 b t + c = 0, the smaller first.
fn roots(a: f64, b: f64, c: f64) -> Option<(f64, f64)> {
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    Some(((-b - root) / a, (-b + root) / a))
}

/// A body with its texture, put into the left camera's frame (X right, Y down, Z forward, metres).
#[derive(Clone, Debug)]
pub struct Object {
    /// The body.
    pub shape: Shape,
    /// Its brightness, over its own coordinates.
    pub texture: Texture,
    /// Its middle.
    pub position: Point3<f64>,
    /// Turns its axes into the camera's.
    pub rotation: Rotation3<f64>,
    /// Share of the lamp's light that is mirrored where the surface faces half-way between lamp and eye; 0
    /// for a Lambertian surface.
    pub gloss: f64,
}

impl Object {
    /// A body at `position` with its axes along the camera's.
    pub fn new(shape: Shape, texture: Texture, position: Point3<f64>) -> Self {
        Self { shape, texture, position, rotation: Rotation3::identity(), gloss: 0.0 }
    }

    /// The same body with a highlight: each camera sees it at another place of the surface.
    pub fn glossy(self, gloss: f64) -> Self {
        Self { gloss, ..self }
    }

    /// The same body turned.
    pub fn turned(self, rotation: Rotation3<f64>) -> Self {
        Self { rotation, ..self }
    }

    /// The same body where a pose carries it.
    pub fn carried(self, pose: &Pose<f64>) -> Self {
        let turn = Rotation3::from_matrix_unchecked(*pose.rotation());
        Self { position: pose.transform(&self.position), rotation: turn * self.rotation, ..self }
    }

    /// The plane through `point` at right angles to `normal`.
    pub fn plane(point: Point3<f64>, normal: Vector3<f64>, texture: Texture) -> Self {
        let rotation = Rotation3::rotation_between(&Vector3::z(), &normal)
            .unwrap_or_else(|| Rotation3::from_axis_angle(&Vector3::x_axis(), core::f64::consts::PI));
        Self::new(Shape::Plane, texture, point).turned(rotation)
    }

    /// A point of the camera's frame in the body's coordinates.
    pub fn to_local(&self, p: &Point3<f64>) -> Point3<f64> {
        self.rotation.inverse_transform_vector(&(p - self.position)).into()
    }

    /// The rectangle of the picture (least and greatest column and row) outside of which a pin-hole camera at
    /// `eye` does not see the body: the whole plane where the body has no end or reaches behind the camera,
    /// and nothing where all of it is there.
    pub(super) fn picture_bounds(
        &self,
        eye: &Point3<f64>,
        focal_px: f64,
        centre: Point2<f64>,
    ) -> [Point2<f64>; 2] {
        let everywhere =
            [Point2::new(f64::NEG_INFINITY, f64::NEG_INFINITY), Point2::new(f64::INFINITY, f64::INFINITY)];
        let Some(half) = self.shape.half_extent() else { return everywhere };
        let corners: [Vector3<f64>; 8] = std::array::from_fn(|corner| {
            let sign = |bit: u32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let corner = half.component_mul(&Vector3::new(sign(0), sign(1), sign(2)));
            self.position + self.rotation * corner - eye
        });
        let nowhere = [everywhere[1], everywhere[0]];
        match corners.iter().filter(|seen| seen.z <= 1e-3).count() {
            0 => (),
            8 => return nowhere,
            _ => return everywhere,
        }
        let [mut least, mut greatest] = nowhere;
        for seen in corners {
            let pixel = centre + seen.xy() * (focal_px / seen.z);
            least = least.inf(&pixel);
            greatest = greatest.sup(&pixel);
        }
        [least, greatest]
    }

    /// The square of the radius of a ball around the body's middle that holds it; `None` for a body without
    /// end.
    pub(super) fn reach_squared(&self) -> Option<f64> {
        self.shape.half_extent().map(|half| half.norm_squared())
    }
}
