//! Whether the frames of a folder are a focus stack, and which of them are out of order or spoiled.
//!
//! From frame to frame the sharpness of every part of the picture changes little, and over the stack it rises
//! to one peak and falls again. A frame that is far from both of its neighbours, which are near to each
//! other, stands in the wrong place or shows something else, and so does the first or last one that is far
//! from its neighbour, which is near to the next; where sharpness rises and falls over and over again, the
//! camera moved and not its lens.

use image::GrayImage;

/// The sharpness of the parts of a frame, in octaves.
#[derive(Clone, PartialEq, Debug)]
pub struct Look(Vec<f64>);

/// Parts across the shorter side of a frame, and the least side of one, px.
const PARTS: u32 = 10;
const LEAST_SIDE: u32 = 8;
/// A frame is left out if its neighbours are nearer to each other than it is to them, by so many times, and
/// if it is so many usual steps from them.
const FARTHER: f64 = 2.7;
const STEPS: f64 = 4.0;
/// How many times as far the sharpness of a part goes up and down as one rise and one fall would: those of
/// stacks 1.0, with whatever noise, of drives 2.3 and more.
const RESTLESS: f64 = 1.7;
/// Changes of a part that count, octaves.
const LEAST_RISE: f64 = 0.3;
/// What goes up and down by less than twice that share of a part's rise, or by so many octaves, is noise.
const PLAY: f64 = 0.125;
const LEAST_PLAY: f64 = 0.075;
/// Of how many parts one has to change for anything to be said.
const TELLING: usize = 4;
/// Of how many frames one may be left out.
const MOST_OUT: usize = 5;

/// What the frames of a folder are.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Order {
    /// A stack, but for those frames, counted from 0, which is usually none.
    Stack(Vec<usize>),
    /// No stack.
    None,
}

impl Look {
    /// That of a frame. Brightness is divided out.
    pub fn new(frame: &GrayImage) -> Self {
        let (width, height) = frame.dimensions();
        let side = (width.min(height) / PARTS).max(LEAST_SIDE);
        let (columns, rows) = ((width / side).max(1), (height / side).max(1));
        let at = |x: u32, y: u32| i32::from(frame.get_pixel(x, y).0[0]);
        let mut sums = vec![0_u64; (columns * rows) as usize];
        for y in 1..height.saturating_sub(1) {
            for x in 1..width.saturating_sub(1) {
                let (column, row) = (x / side, y / side);
                if column < columns && row < rows {
                    let twice = 2 * at(x, y);
                    let across = (twice - at(x - 1, y) - at(x + 1, y)).unsigned_abs();
                    let down = (twice - at(x, y - 1) - at(x, y + 1)).unsigned_abs();
                    sums[(row * columns + column) as usize] += u64::from(across + down);
                }
            }
        }
        let pixels = frame.as_raw();
        let mean = pixels.iter().map(|&p| f64::from(p)).sum::<f64>() / pixels.len().max(1) as f64;
        let area = f64::from(side * side);
        Self(sums.iter().map(|&sum| ((sum as f64 / area + 0.5) / (mean + 1.0)).log2()).collect())
    }

    fn distance(&self, other: &Self) -> f64 {
        self.0.iter().zip(&other.0).map(|(a, b)| (a - b).abs()).sum::<f64>() / self.0.len() as f64
    }
}

/// How often the sharpness of most parts rises and falls, in one rise and one fall; `None` where hardly any
/// part changes.
pub fn restlessness(looks: &[Look]) -> Option<f64> {
    let parts = looks.first()?.0.len();
    let all: Vec<f64> = (0..parts).filter_map(|part| unrest(looks.iter(), part)).collect();
    if TELLING * all.len() < parts { None } else { median(all) }
}

/// What the frames with these looks are. Of fewer than six nothing can be said: they count as a stack.
pub fn order(looks: &[Look]) -> Order {
    let n = looks.len();
    if n < 6 {
        return Order::Stack(Vec::new());
    }
    let steps: Vec<f64> = looks.windows(2).map(|pair| pair[0].distance(&pair[1])).collect();
    let usual = median(steps.clone()).unwrap_or(0.0);
    let is_off = |&k: &usize| {
        let off = steps[k - 1] + steps[k];
        off > FARTHER * looks[k - 1].distance(&looks[k + 1]) && off > STEPS * usual
    };
    let is_stray = |step: f64, beside: &[f64]| {
        step > STEPS * usual && beside.iter().all(|beside| step > FARTHER * beside)
    };
    let first = is_stray(steps[0], &steps[1..3]).then_some(0);
    let last = is_stray(steps[n - 2], &steps[n - 4..n - 2]).then_some(n - 1);
    let out: Vec<usize> = first.into_iter().chain((1..n - 1).filter(is_off)).chain(last).collect();
    let kept: Vec<Look> =
        looks.iter().enumerate().filter(|(k, _)| !out.contains(k)).map(|(_, look)| look.clone()).collect();
    let is_restless = restlessness(&kept).is_some_and(|restless| restless > RESTLESS);
    if out.len() * MOST_OUT > n || is_restless {
        return Order::None;
    }
    Order::Stack(out)
}

/// How far the sharpness of a part goes up and down, in one rise to its most and one fall from it; `None`
/// where it hardly changes. Against noise means of three frames are followed with some play, as by a loose
/// coupling: what goes to and fro within it does not count.
fn unrest<'a>(looks: impl Iterator<Item = &'a Look>, part: usize) -> Option<f64> {
    let values: Vec<f64> = looks.map(|look| look.0[part]).collect();
    let smooth: Vec<f64> = values.windows(3).map(|three| three.iter().sum::<f64>() / 3.0).collect();
    let (least, most) =
        smooth.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)));
    if most - least <= LEAST_RISE {
        return None;
    }
    let play = (PLAY * (most - least)).max(LEAST_PLAY);
    let first = *smooth.first()?;
    let (mut at, mut highest, mut lowest, mut way) = (first, first, first, 0.0);
    for value in smooth {
        let next = at.clamp(value - play, value + play);
        way += (next - at).abs();
        (at, highest, lowest) = (next, highest.max(next), lowest.min(next));
    }
    let rise = (2.0 * highest - first - at).max(highest - lowest);
    (rise > 0.0).then(|| way / rise)
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
