//! The least sum of squares of re-projection errors.

use super::lens::{INNER, LensModel};
use super::normal::{Normal, OUTER};
use nalgebra::{DVector, Matrix2x3, Matrix3, Point2, Point3, Rotation3, Vector2, Vector3};

/// What a camera is made of, in the order of its parameters.
pub(super) type Inner = [f64; INNER];

/// From one frame to another: `P' = R P + t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outer {
    pub r: Matrix3<f64>,
    pub t: Vector3<f64>,
}

impl Outer {
    pub const fn new(r: Matrix3<f64>, t: Vector3<f64>) -> Self {
        Self { r, t }
    }

    fn apply(&self, p: &Vector3<f64>) -> Vector3<f64> {
        self.r * p + self.t
    }

    /// Turned by a small rotation, and moved.
    fn moved(&self, step: &[f64]) -> Self {
        let turn = Rotation3::new(Vector3::new(step[0], step[1], step[2]));
        let mut r = Rotation3::from_matrix_unchecked(turn.matrix() * self.r);
        r.renormalize();
        Self { r: r.into_inner(), t: self.t + Vector3::new(step[3], step[4], step[5]) }
    }
}

/// Corners of a board in a picture, and which they are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen<'a> {
    pub corners: &'a [Point2<f64>],
    pub numbers: &'a [usize],
}

impl<'a> Seen<'a> {
    /// Places on the board, and where they are in the picture.
    pub fn pairs(self, board: &'a [Point3<f64>]) -> impl Iterator<Item = (&'a Point3<f64>, &'a Point2<f64>)> {
        self.numbers.iter().filter_map(|&number| board.get(number)).zip(self.corners)
    }
}

/// One camera's corners of each view, or two cameras', with what is to be found.
#[derive(Clone, Debug)]
pub(super) struct Bundle<'a> {
    /// The board's corners; their unit is that of all lengths.
    pub board: &'a [Point3<f64>],
    /// What the lenses are.
    pub model: LensModel,
    /// For each camera what it sees of the board in each view.
    pub seen: Vec<Vec<Seen<'a>>>,
    /// Each camera.
    pub inner: Vec<Inner>,
    /// From the first camera to the second.
    pub beside: Outer,
    /// From the board to the first camera, of each view.
    pub views: Vec<Outer>,
    /// Which parameters of a camera are to be found; the others stay.
    pub free: [bool; INNER],
}

/// The most columns of a residual: of a camera, of the pose beside and of the view.
const MOST: usize = INNER + 2 * OUTER;

/// Sums over the corners of one picture.
struct Sums {
    matrix: [[f64; MOST]; MOST],
    vector: [f64; MOST],
    cost: f64,
}

impl Sums {
    fn add(&mut self, columns: &[Vector2<f64>], residual: &Vector2<f64>) {
        self.cost += residual.norm_squared();
        for (a, (row, sum)) in columns.iter().zip(self.matrix.iter_mut().zip(&mut self.vector)) {
            *sum += a.dot(residual);
            row.iter_mut().zip(columns).for_each(|(place, b)| *place += a.x * b.x + a.y * b.y);
        }
    }
}

/// A place in the picture, and its derivatives by the camera's parameters and by the point in the camera's
/// frame.
struct Projected {
    place: Vector2<f64>,
    by_inner: [Vector2<f64>; INNER],
    by_point: Matrix2x3<f64>,
}

/// Where a camera sees a point of its frame; `None` behind it.
fn project(model: LensModel, inner: &Inner, p: &Vector3<f64>) -> Option<Projected> {
    if p.z <= 1e-6 {
        return None;
    }
    let [fx, fy, cx, cy, coefficients @ ..] = *inner;
    let plane = Vector2::new(p.x / p.z, p.y / p.z);
    let (d, slope) = model.lens(coefficients).distort_with_derivative(&plane);
    let f = Vector2::new(fx, fy);
    let [a, b, c, e, g, h, i, j] = model.slopes(coefficients, &plane).map(|slope| slope.component_mul(&f));
    let by_inner =
        [Vector2::new(d.x, 0.0), Vector2::new(0.0, d.y), Vector2::x(), Vector2::y(), a, b, c, e, g, h, i, j];
    let by_z = 1.0 / p.z;
    let to_plane = Matrix2x3::new(by_z, 0.0, -plane.x * by_z, 0.0, by_z, -plane.y * by_z);
    let mut by_point = slope * to_plane;
    by_point.row_mut(0).scale_mut(fx);
    by_point.row_mut(1).scale_mut(fy);
    Some(Projected { place: Vector2::new(fx * d.x + cx, fy * d.y + cy), by_inner, by_point })
}

/// Derivatives of a point by the small turn of the vector that was turned, and by the way: two rows, six
/// columns.
fn by_outer(by_point: &Matrix2x3<f64>, turned: &Vector3<f64>) -> [Vector2<f64>; OUTER] {
    let by_turn = by_point * -turned.cross_matrix();
    std::array::from_fn(|i| if i < 3 { by_turn.column(i).into() } else { by_point.column(i - 3).into() })
}

impl Bundle<'_> {
    fn cameras(&self) -> usize {
        self.inner.len()
    }

    fn beside_at(&self) -> usize {
        self.cameras() * INNER
    }

    fn view_at(&self, view: usize) -> usize {
        self.beside_at() + if self.cameras() > 1 { OUTER } else { 0 } + view * OUTER
    }

    /// How many parameters there are, free or not.
    pub fn parameters(&self) -> usize {
        self.view_at(self.views.len())
    }

    /// Corner by corner what is seen less what is expected, px; `None` where a point is behind a camera.
    pub fn residuals(&self, camera: usize, view: usize) -> Option<Vec<Vector2<f64>>> {
        let (seen, pose) = (self.seen[camera][view], &self.views[view]);
        let residual = |(board, seen): (&Point3<f64>, &Point2<f64>)| {
            let mut point = pose.apply(&board.coords);
            if camera > 0 {
                point = self.beside.apply(&point);
            }
            Some(seen.coords - project(self.model, &self.inner[camera], &point)?.place)
        };
        seen.pairs(self.board).map(residual).collect()
    }

    /// The sum of squares, px^2; endless where a point is behind a camera.
    pub fn cost(&self) -> f64 {
        let all =
            (0..self.cameras()).flat_map(|camera| (0..self.views.len()).map(move |view| (camera, view)));
        let sums = all.map(|(camera, view)| {
            self.residuals(camera, view).map(|r| r.iter().map(Vector2::norm_squared).sum::<f64>())
        });
        let sum = sums.sum::<Option<f64>>().map(|sum| sum + self.bounds());
        sum.filter(|cost| cost.is_finite()).unwrap_or(f64::INFINITY)
    }

    /// What the coefficients count, px^2.
    fn bounds(&self) -> f64 {
        let of =
            |inner: &Inner| inner.iter().enumerate().map(|(i, x)| self.model.weight(i) * x * x).sum::<f64>();
        self.inner.iter().map(of).sum()
    }

    /// The normal equations at what is found so far.
    pub fn normal(&self) -> Option<Normal> {
        let shared = self.view_at(0);
        let mut normal = Normal::new(shared, self.views.len());
        for (camera, inner) in self.inner.iter().enumerate() {
            // The shared parameters that this camera's residuals have to do with.
            let mut places: Vec<usize> =
                (0..INNER).filter(|&i| self.free[i]).map(|i| camera * INNER + i).collect();
            if camera > 0 {
                places.extend(self.beside_at()..self.beside_at() + OUTER);
            }
            for view in 0..self.views.len() {
                let sums = self.sums(camera, inner, view)?;
                normal.cost += sums.cost;
                let own = places.len();
                for (a, &i) in places.iter().enumerate() {
                    normal.of_shared[i] += sums.vector[a];
                    for (b, &j) in places.iter().enumerate() {
                        normal.shared[(i, j)] += sums.matrix[a][b];
                    }
                    (0..OUTER).for_each(|b| normal.between[view][(b, i)] += sums.matrix[own + b][a]);
                }
                for a in 0..OUTER {
                    normal.of_own[view][a] += sums.vector[own + a];
                    (0..OUTER).for_each(|b| normal.own[view][(a, b)] += sums.matrix[own + a][own + b]);
                }
            }
        }
        normal.cost += self.bounds();
        for (camera, inner) in self.inner.iter().enumerate() {
            for (i, x) in inner.iter().enumerate().filter(|(i, _)| self.free[*i]) {
                normal.shared[(camera * INNER + i, camera * INNER + i)] += self.model.weight(i);
                normal.of_shared[camera * INNER + i] -= self.model.weight(i) * x;
            }
        }
        // What is not free stays.
        for i in 0..shared {
            if normal.shared[(i, i)] == 0.0 {
                normal.shared[(i, i)] = 1.0;
            }
        }
        normal.cost.is_finite().then_some(normal)
    }

    /// The sums over one picture, in columns: the camera's free parameters, the pose beside if it is the
    /// second camera, the view.
    fn sums(&self, camera: usize, inner: &Inner, view: usize) -> Option<Sums> {
        let pose = &self.views[view];
        let mut sums = Sums { matrix: [[0.0; MOST]; MOST], vector: [0.0; MOST], cost: 0.0 };
        let mut columns: Vec<Vector2<f64>> = Vec::with_capacity(MOST);
        for (board, seen) in self.seen[camera][view].pairs(self.board) {
            let turned = pose.r * board.coords;
            let first = turned + pose.t;
            let again = if camera == 0 { first } else { self.beside.r * first };
            let point = if camera == 0 { first } else { again + self.beside.t };
            let projected = project(self.model, inner, &point)?;
            columns.clear();
            columns
                .extend(projected.by_inner.iter().zip(self.free).filter(|(_, free)| *free).map(|(c, _)| *c));
            let mut by_first = projected.by_point;
            if camera > 0 {
                columns.extend(by_outer(&projected.by_point, &again));
                by_first *= self.beside.r;
            }
            columns.extend(by_outer(&by_first, &turned));
            sums.add(&columns, &(seen.coords - projected.place));
        }
        Some(sums)
    }

    fn moved(&self, step: &DVector<f64>) -> Self {
        let mut moved = self.clone();
        let step = step.as_slice();
        for (camera, inner) in moved.inner.iter_mut().enumerate() {
            inner.iter_mut().zip(&step[camera * INNER..]).for_each(|(p, s)| *p += s);
        }
        if self.cameras() > 1 {
            moved.beside = self.beside.moved(&step[self.beside_at()..]);
        }
        for (view, pose) in moved.views.iter_mut().enumerate() {
            *pose = pose.moved(&step[self.view_at(view)..]);
        }
        moved
    }

    /// Levenberg and Marquardt's method, at most `most` steps; returns the cost, px^2, endless if there is
    /// none.
    pub fn minimise(&mut self, most: usize) -> f64 {
        let mut damping = 1e-3;
        let Some(mut normal) = self.normal() else { return f64::INFINITY };
        for _ in 0..most {
            let next = normal.step(damping).map(|step| self.moved(&step));
            let is_camera = |bundle: &Self| bundle.inner.iter().all(|inner| inner[0] > 1.0 && inner[1] > 1.0);
            let better = next
                .filter(is_camera)
                .map(|next| (next.cost(), next))
                .filter(|(cost, _)| *cost < normal.cost);
            let Some((cost, next)) = better else {
                damping *= 8.0;
                if damping > 1e12 {
                    break;
                }
                continue;
            };
            let gained = (normal.cost - cost) / normal.cost.max(1e-300);
            *self = next;
            damping = (damping / 5.0).max(1e-12);
            if gained < 1e-12 {
                return cost;
            }
            match self.normal() {
                Some(new) => normal = new,
                None => return cost,
            }
        }
        normal.cost
    }
}
