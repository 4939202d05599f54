//! Corners with whole coordinates.

use super::Pattern;
use super::corners::{self, Corner};
use super::level::Level;
use super::links::Links;
use nalgebra::Point2;
use std::collections::{BTreeMap, VecDeque};

/// Steps along the four edges of a corner, clockwise on the screen.
const STEPS: [(i32, i32); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// A corner of a grid: where it is, and which of the corner's edges points along the grid's first axis.
#[derive(Clone, Copy, Debug)]
struct Node {
    place: Point2<f64>,
    /// Whether it is bright behind (clockwise of) the edge along the first axis.
    is_bright: bool,
}

/// Corners that belong together, by column and row.
#[derive(Clone, Debug, Default)]
pub(super) struct Grid {
    nodes: BTreeMap<(i32, i32), Node>,
}

/// Corners of the pattern, row by row, and whether it is bright behind the first edge of the first one.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub columns: usize,
    pub rows: usize,
    pub places: Vec<Point2<f64>>,
    pub is_bright: bool,
}

/// All grids, the largest first.
pub(super) fn grids(corners: &[Corner], links: &Links) -> Vec<Grid> {
    let mut is_taken = vec![false; corners.len()];
    let mut grids = Vec::new();
    for first in 0..corners.len() {
        if is_taken[first] || links[first].iter().flatten().count() < 2 {
            continue;
        }
        let grid = grow(corners, links, first, &mut is_taken);
        if grid.len() >= 6 {
            grids.push(grid);
        }
    }
    grids.sort_by_key(|grid| std::cmp::Reverse(grid.len()));
    grids
}

/// From link to link.
fn grow(corners: &[Corner], links: &Links, first: usize, is_taken: &mut [bool]) -> Grid {
    let mut grid = Grid::default();
    let mut waiting = VecDeque::from([(first, 0, (0, 0))]);
    is_taken[first] = true;
    while let Some((i, along, at)) = waiting.pop_front() {
        grid.nodes.insert(at, Node { place: corners[i].place, is_bright: along % 2 == 0 });
        for (edge, link) in links[i].iter().enumerate() {
            let Some((j, back)) = *link else { continue };
            let step = (edge + 4 - along) % 4;
            let next = (at.0 + STEPS[step].0, at.1 + STEPS[step].1);
            if is_taken[j] || grid.nodes.contains_key(&next) || waiting.iter().any(|w| w.2 == next) {
                continue;
            }
            is_taken[j] = true;
            // The edge that leads back points along the opposite step.
            waiting.push_back((j, (back + 4 - (step + 2) % 4) % 4, next));
        }
    }
    grid
}

impl Grid {
    /// How many corners it has.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Takes corners out that are not where those beside them expect them, the worst first, as an edge that
    /// noise made may lead to.
    pub fn prune(&mut self) {
        let worst = |grid: &Self| {
            let off = grid.nodes.keys().map(|&at| (grid.off(at), at));
            off.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(off, _)| *off > 0.2)
        };
        while let Some((_, at)) = worst(self) {
            self.nodes.remove(&at);
        }
    }

    /// Prunes closer: near the border of a picture, or of the board, a corner of a marker may stand for one
    /// that is not seen.
    pub fn prune_marked(&mut self) {
        self.prune();
        // Once more, all at a time: one that is wrong would take those beside it along.
        let off: Vec<_> = self.nodes.keys().copied().filter(|&at| self.off(at) > 0.15).collect();
        for at in off {
            self.nodes.remove(&at);
        }
    }

    /// How far a corner is from where those beside it expect it, the least of all ways to tell, in steps:
    /// half way between two, or as far behind two as these are apart.
    fn off(&self, at: (i32, i32)) -> f64 {
        let place = |step: (i32, i32), k: i32| {
            self.nodes.get(&(at.0 + k * step.0, at.1 + k * step.1)).map(|node| node.place)
        };
        let Some(here) = place((0, 0), 1) else { return 0.0 };
        let ways = STEPS.iter().filter_map(|&step| {
            let (next, before) = (place(step, 1)?, place(step, -1));
            let (expected, long) = match (before, place(step, 2)) {
                (Some(before), _) => (next + (before - next) / 2.0, (before - next).norm() / 2.0),
                (None, Some(second)) => (next + (next - second), (next - second).norm()),
                (None, None) => return None,
            };
            Some((here - expected).norm() / long)
        });
        ways.reduce(f64::min).unwrap_or(f64::INFINITY)
    }

    /// Where its corners are, by column and row.
    pub fn places(&self) -> impl Iterator<Item = ((i32, i32), Point2<f64>)> {
        self.nodes.iter().map(|(at, node)| (*at, node.place))
    }

    /// Its squares with all four corners, by their first one: these clockwise from it.
    pub fn squares(&self) -> impl Iterator<Item = ((i32, i32), [Point2<f64>; 4])> {
        self.nodes.keys().filter_map(|&(x, y)| {
            let at = |i, j| self.nodes.get(&(x + i, y + j)).map(|node| node.place);
            Some(((x, y), [at(0, 0)?, at(1, 0)?, at(1, 1)?, at(0, 1)?]))
        })
    }

    /// Puts corners in that links missed: where those beside them expect one, and one is seen.
    pub fn complete(&mut self, level: &Level, corners: &[Corner]) {
        for _ in 0..4 {
            let mut found = Vec::new();
            let beside = self.nodes.keys().flat_map(|at| STEPS.map(|step| (at.0 + step.0, at.1 + step.1)));
            let gaps: std::collections::BTreeSet<_> =
                beside.filter(|at| !self.nodes.contains_key(at)).collect();
            for at in gaps {
                let Some((expected, spacing, is_bright)) = self.expected(at) else { continue };
                let near = corners.iter().map(|c| c.place).filter(|p| (p - expected).norm() < 0.25 * spacing);
                let nearest = near.min_by(|a, b| (a - expected).norm().total_cmp(&(b - expected).norm()));
                // Within the grid a weak corner will do.
                let is_within =
                    STEPS.iter().filter(|s| self.nodes.contains_key(&(at.0 + s.0, at.1 + s.1))).count() >= 3;
                let weak = || level.saddle(&expected, 0.2 * spacing).filter(|_| is_within);
                let Some(place) = nearest.or_else(weak) else { continue };
                let is_free = self.nodes.values().all(|node| (node.place - place).norm() > 0.4 * spacing);
                let looks_right =
                    corners::look(level, place).is_some_and(|corner| self.fits(at, &corner, is_bright));
                if is_free && (looks_right || is_within) {
                    found.push((at, Node { place, is_bright }));
                }
            }
            if found.is_empty() {
                break;
            }
            self.nodes.extend(found);
        }
    }

    /// Where a corner is expected, of three in a row beside it on one side, or of those on both; with their
    /// spacing.
    fn expected(&self, at: (i32, i32)) -> Option<(Point2<f64>, f64, bool)> {
        let node = |step: (i32, i32), k: i32| self.nodes.get(&(at.0 + k * step.0, at.1 + k * step.1));
        let mut places = Vec::new();
        for step in STEPS {
            if let (Some(a), Some(b)) = (node(step, 1), node(step, -1)) {
                places.push((
                    a.place + (b.place - a.place) / 2.0,
                    (b.place - a.place).norm() / 2.0,
                    !a.is_bright,
                ));
            } else if let (Some(a), Some(b), Some(c)) = (node(step, 1), node(step, 2), node(step, 3)) {
                // The steps change evenly.
                let (first, second) = (a.place - b.place, b.place - c.place);
                places.push((a.place + first + (first - second) * 0.8, first.norm(), !a.is_bright));
            }
        }
        let count = places.len() as f64;
        let (_, spacing, is_bright) = *places.first()?;
        let sum = places.iter().fold(nalgebra::Vector2::zeros(), |sum, (place, ..)| sum + place.coords);
        Some((Point2::from(sum / count), spacing, is_bright))
    }

    /// Whether a corner's edges point to the corners beside it, with bright and dark as they are there.
    fn fits(&self, at: (i32, i32), corner: &Corner, is_bright: bool) -> bool {
        STEPS.iter().enumerate().all(|(i, step)| {
            let Some(node) = self.nodes.get(&(at.0 + step.0, at.1 + step.1)) else { return true };
            let way = (node.place - corner.place).normalize();
            let parity = (i + usize::from(!is_bright)) % 2;
            (0..4).any(|edge| edge % 2 == parity && corner.edges[edge].dot(&way) > 0.85)
        })
    }

    /// The block of the pattern's size, either way round; or `Err` of the size of a grid that has room for
    /// several, or of nothing.
    pub fn block(&self, pattern: Pattern) -> Result<Block, Option<(usize, usize)>> {
        let (c, r) = (pattern.columns() as i32, pattern.rows() as i32);
        let mut ways = vec![(c, r)];
        if c != r {
            ways.push((r, c));
        }
        let mut found = Vec::new();
        for (columns, rows) in ways {
            for &(x, y) in self.nodes.keys() {
                let mut block = (0..rows).flat_map(|j| (0..columns).map(move |i| (x + i, y + j)));
                if block.all(|at| self.nodes.contains_key(&at)) {
                    found.push((x, y, columns, rows));
                }
            }
        }
        match found.as_slice() {
            [] => Err(None),
            [(x, y, columns, rows)] => {
                let block = (0..*rows).flat_map(|j| (0..*columns).map(move |i| (x + i, y + j)));
                let places = block.map(|at| self.nodes[&at].place).collect();
                let is_bright = self.nodes[&(*x, *y)].is_bright;
                Ok(Block { columns: *columns as usize, rows: *rows as usize, places, is_bright })
            }
            _ => Err(Some(self.size())),
        }
    }

    /// Corners along the grid and down it.
    fn size(&self) -> (usize, usize) {
        let range = |of: fn(&(i32, i32)) -> i32| {
            let all = || self.nodes.keys().map(of);
            (all().max().unwrap_or(0) - all().min().unwrap_or(0) + 1) as usize
        };
        (range(|at| at.0), range(|at| at.1))
    }

    /// The columns and rows of the board, of whatever size that is: those of the largest block without a gap,
    /// if at most a quarter of the corners stands beside it, such as those of the board's edge.
    pub fn board_size(&self) -> Option<(usize, usize)> {
        let heights = |x: i32, y: i32| (0..).take_while(|j| self.nodes.contains_key(&(x, y + j))).count();
        let blocks = self.nodes.keys().flat_map(|&(x, y)| {
            let mut rows = usize::MAX;
            (1..).map_while(move |columns| {
                rows = rows.min(heights(x + columns - 1, y));
                (rows > 0).then_some((columns as usize, rows))
            })
        });
        let (columns, rows) = blocks.max_by_key(|(columns, rows)| columns * rows)?;
        let is_board = columns.min(rows) >= 3 && columns * rows >= 12;
        (is_board && 4 * columns * rows >= 3 * self.len()).then_some((columns, rows))
    }
}
