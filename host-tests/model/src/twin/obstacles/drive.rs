//! A decision from all columns of a corridor.

use super::beside::{Beside, Side};
use super::stixels::Column;
use super::{Found, Kind, Line, Scene, counts};
use stereopsis::obstacles::{BlindReason, Decision, DriveConfig, GroundSource, StixelKind};

/// What was decided, and what it rests on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Decided {
    /// What to do.
    pub decision: Decision,
    /// What is nearest in the corridor of this frame.
    pub nearest: StixelKind,
    /// Time until the vehicle is there, ms.
    pub contact_ms: Option<i128>,
    /// Way that the vehicle needs to stand, mm.
    pub stopping_mm: i128,
}

/// A vehicle with all that its corridor has shown.
#[derive(Clone, Debug)]
pub struct Driver {
    config: DriveConfig,
    shown: Vec<Option<i128>>,
    beside: [Beside; 2],
}

/// A surface in the corridor.
#[derive(Clone, Copy)]
struct Ahead {
    surely_mm: i128,
    kind: StixelKind,
}

/// What ends a column's sight of the ground without being a surface: depths between which it stands, and
/// whether it is lower than an obstacle.
#[derive(Clone, Copy)]
struct Hides {
    from_mm: i128,
    to_mm: i128,
    is_low: bool,
}

impl Driver {
    /// A vehicle that has seen nothing yet.
    pub fn new(config: DriveConfig) -> Self {
        Self { config, shown: Vec::new(), beside: [Beside::default(); 2] }
    }

    /// What a frame means at a speed, mm/s.
    pub fn decide(&mut self, scene: &Scene<'_>, found: &Found, speed: i128) -> Decided {
        let DriveConfig { margin_mm, reaction_ms, brake_mm_s2, .. } = self.config;
        let brake = i128::from(brake_mm_s2).max(1);
        let way =
            i128::from(margin_mm) + speed * i128::from(reaction_ms) / 1000 + speed * speed / (2 * brake);
        let stopping_mm = way.min(65_535);
        let corridor = Corridor {
            scene,
            found,
            half_mm: i128::from(self.config.corridor_mm / 2),
            needed_mm: (2 * stopping_mm).min(65_535),
        };
        let ahead = corridor.ahead();
        let nearest = ahead.map_or(StixelKind::Nothing, |ahead| ahead.kind);
        if let Some(reason) = found.blind {
            return Decided { decision: Decision::Blind(reason), nearest, contact_ms: None, stopping_mm };
        }
        self.shown.push(ahead.map(|ahead| ahead.surely_mm));
        let leaving = self.leaving(scene, found, speed);
        let held = counts(&self.shown, self.config.hysteresis);
        let held = [held, leaving].into_iter().flatten().min();
        let contact_ms = held.filter(|_| speed > 0).map(|mm| 1000 * mm / speed);
        let soon = contact_ms.is_some_and(|ms| ms <= i128::from(self.config.slow_ms));
        let is_lost = scene.config.ground != GroundSource::Absent && found.ground.is_none();
        let slow = |mm: Option<i128>| mm.filter(|&mm| mm <= corridor.needed_mm);
        let whole = |mm: i128| mm as u16;
        let decision = if let Some(mm) = held.filter(|&mm| mm <= stopping_mm || leaving.is_some()) {
            Decision::Stop(whole(mm))
        } else if is_lost {
            Decision::Blind(BlindReason::NoGround)
        } else if !corridor.is_seen() || corridor.hidden().is_some_and(|mm| held.is_none_or(|held| mm < held))
        {
            Decision::Blind(BlindReason::Unseen)
        } else if let Some(mm) =
            held.filter(|_| soon).or(slow(held)).or(slow(self.shown[self.shown.len() - 1]))
        {
            Decision::Slow(whole(mm))
        } else {
            Decision::Clear
        };
        Decided { decision, nearest, contact_ms, stopping_mm }
    }

    /// The nearest that left the picture at a side, or is about to.
    fn leaving(&mut self, scene: &Scene<'_>, found: &Found, speed: i128) -> Option<i128> {
        let in_a_row = self.shown.iter().rev().take_while(|at| at.is_some()).count().min(255);
        for (is_right, beside) in [false, true].into_iter().zip(&mut self.beside) {
            let way_mm = (speed * i128::from(self.config.reaction_ms) / 1000).min(65_535);
            let half_mm = i128::from(self.config.corridor_mm / 2);
            let side = Side { scene, found, is_right, half_mm, way_mm };
            beside.take(&side, in_a_row, self.config.hysteresis);
        }
        self.beside.iter().filter_map(Beside::mm).min()
    }
}

/// A frame's corridor.
struct Corridor<'a> {
    scene: &'a Scene<'a>,
    found: &'a Found,
    half_mm: i128,
    needed_mm: i128,
}

impl Corridor<'_> {
    fn columns(&self) -> usize {
        self.scene.size()[0]
    }

    /// Whether what column `x` shows at a depth is in the corridor; the column nearest to the optical axis
    /// always is.
    fn is_inside(&self, x: usize, mm: i128) -> bool {
        let across = |x: usize, mm: i128| (mm * self.scene.right(x) / self.scene.focal_16ths).abs();
        let middle = (0..self.columns()).min_by_key(|&x| (across(x, 65_535), x));
        across(x, mm) <= self.half_mm || Some(x) == middle
    }

    /// Depth of a column's surface, mm.
    fn depth_mm(&self, x: usize) -> i128 {
        self.found.columns[x].found.as_ref().map_or(65_535, |found| self.scene.depth_mm(found.parallax))
    }

    /// The nearest surface in the corridor, less two deviations; of equals the left one.
    fn ahead(&self) -> Option<Ahead> {
        let surface = |x: usize| {
            let found = self.found.columns[x].found.as_ref()?;
            let (depth, parallax) = (self.depth_mm(x), found.parallax);
            let sigma = ((depth * found.sigma + parallax / 2) / parallax).min(65_535);
            let surely_mm = (depth - (2 * sigma).min(65_535)).max(0);
            let kind = if found.kind == Kind::Drop { StixelKind::Drop } else { StixelKind::Obstacle };
            self.is_inside(x, surely_mm).then_some(Ahead { surely_mm, kind })
        };
        (0..self.columns()).filter_map(surface).min_by_key(|ahead| ahead.surely_mm)
    }

    /// Whether the sight of the ground ends in a column at its surface.
    fn ends_at_surface(&self, x: usize) -> bool {
        let standing = &self.found.columns[x];
        standing.found.as_ref().is_some_and(|found| standing.seen <= found.base + 3)
    }

    /// Whether at most an eighth of the corridor's columns see nothing.
    fn is_seen(&self) -> bool {
        let inside: Vec<_> = (0..self.columns()).filter(|&x| self.is_inside(x, self.needed_mm)).collect();
        let sees = |x: usize| {
            let standing = &self.found.columns[x];
            let at = |line: Line| line.at(self.scene.halves(standing.seen), self.scene.right(x));
            let seen_mm = self.found.ground.map_or(65_535, |line| self.scene.depth_mm(at(line)));
            let sees_ground = standing.seen < self.scene.size()[1] && seen_mm >= self.needed_mm;
            let is_near = standing.found.is_some() && self.depth_mm(x) <= self.needed_mm;
            sees_ground || is_near || self.ends_at_surface(x) || self.hides(x).is_some()
        };
        let beside = self.beside();
        let unseen = inside.iter().filter(|&&x| !sees(x)).count() + beside;
        let columns = inside.len() + beside;
        columns > 0 && 8 * unseen <= columns
    }

    /// How many columns the corridor would have beside the picture; more than eight times those of the
    /// picture are not counted.
    fn beside(&self) -> usize {
        let (scene, most) = (self.scene, 10 * self.columns() as i128);
        if self.needed_mm == 0 {
            return 0;
        }
        let width = 16 * i128::from(scene.config.cell_width);
        let is_inside = |right: i128| (self.needed_mm * right / scene.focal_16ths).abs() <= self.half_mm;
        let left = (1..most).take_while(|k| is_inside((scene.right(0) - k * width).min(0)));
        let last = scene.right(self.columns() - 1);
        left.count() + (1..most).take_while(|k| is_inside((last + k * width).max(0))).count()
    }

    /// Depth of the nearest in the corridor that is neither ground nor a surface, mm: what is lower than an
    /// obstacle does not count where more than 18 px side by side end the sight of the ground.
    fn hidden(&self) -> Option<i128> {
        let ends: Vec<_> = (0..self.columns())
            .map(|x| self.hides(x).filter(|h| h.from_mm < self.needed_mm && self.is_inside(x, h.from_mm)))
            .collect();
        let mut hidden = Vec::new();
        for run in ends.split(|end| end.is_none()) {
            let is_narrow = run.len() * usize::from(self.scene.config.cell_width) <= 18;
            let counts = run.iter().flatten().filter(|hides| is_narrow || !hides.is_low);
            hidden.extend(counts.map(|hides| hides.to_mm));
        }
        hidden.into_iter().min()
    }

    /// What ends a column's sight of the ground: the first answer of three rows above it, if that is not its
    /// surface.
    fn hides(&self, x: usize) -> Option<Hides> {
        let (scene, standing, line) = (self.scene, &self.found.columns[x], self.found.ground?);
        let column = Column::new(scene, &self.found.cells, Some(line), x);
        let answers = &column.parallaxes;
        let (row, parallax) = (standing.seen.saturating_sub(3)..standing.seen)
            .rev()
            .find_map(|row| Some((row, answers[row]?)))?;
        let is_of_it = standing
            .found
            .as_ref()
            .is_some_and(|found| found.kind == Kind::Drop || parallax <= found.parallax + 32);
        if is_of_it && self.ends_at_surface(x) {
            return None;
        }
        let left = |number: i128| {
            let obstacle = i128::from(scene.config.obstacle_mm);
            number * (line.height_mm - obstacle).max(0) / line.height_mm
        };
        // Parallaxes of what is as far as has to be seen, and of the ground that an obstacle there hides.
        let needed = scene.millimetre_steps.checked_div(self.needed_mm).unwrap_or(i128::MAX);
        let needed_ground = left(needed.clamp(0, 65_535));
        let ground = |row: usize| line.at(scene.halves(row), scene.right(x));
        let at = ground(row);
        let own = if at >= 2 * scene.farthest() { parallax } else { at };
        if at <= needed_ground && own <= needed {
            return Some(Hides { from_mm: 65_535, to_mm: 65_535, is_low: true });
        }
        let above: Vec<_> = (0..=row).rev().take_while(|&row| ground(row) > needed_ground).collect();
        let is_ground = |&row: &usize| answers[row].is_none_or(|p| column.may_be_ground(&line, row, p));
        let has_gap = above.windows(3).any(|rows| rows.iter().all(|&row| answers[row].is_none()));
        let (own_mm, ground_mm) = (scene.depth_mm(own), scene.depth_mm(at));
        Some(Hides {
            from_mm: own_mm.min(left(ground_mm)),
            to_mm: own_mm.min(ground_mm),
            is_low: above.iter().all(is_ground) && !has_gap,
        })
    }
}
