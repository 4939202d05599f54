//! What pictures lack: texture, and light that is neither too much nor too little.

use super::changes::Changes;
use image::GrayImage;

/// The share of the other picture's texture that a picture may lack before that is said. It is up to .12 in
/// the real pairs that the tests know, as they are and with noise of 2 and 5 grey levels, and from .29 on
/// where half of one of their images is covered.
const LOST_TEXTURE: f64 = 0.25;
/// The share of a picture that has to have texture for the other one to lack it.
const LEAST_TEXTURE: f64 = 0.1;

/// The share of a picture that has texture, at most, where its camera may be covered or out of focus: up to
/// .33 in 382 such images, from .41 on in 210 pairs of different scenes.
const HARDLY_TEXTURED: f64 = 0.35;

/// Shares of a picture, of what is shown of it.
pub(super) struct Lacks {
    /// Around those pixels nothing changes along the row by more than noise.
    pub untextured: f64,
    /// Those are white: 254 and more.
    pub over_exposed: f64,
    /// Those are black: 1 and less.
    pub under_exposed: f64,
    /// Those are white, and nothing changes around them.
    pub white: f64,
    /// Those are black, and nothing changes around them.
    pub black: f64,
    /// The share of the whole picture that shows nothing.
    pub masked: f64,
    /// The mean grey level.
    pub mean: f64,
    /// Of each row, [`Self::untextured`].
    rows: Vec<f64>,
}

impl Lacks {
    /// Of a picture, which shows nothing where `valid` is 0.
    pub fn of(picture: &GrayImage, valid: Option<&GrayImage>) -> Self {
        let (width, height) = picture.dimensions();
        let changes = Changes::of(picture);
        let mut rows = Vec::with_capacity(height as usize);
        let (mut shown, mut flat, mut grey) = (0u64, 0u64, 0u64);
        let [mut over, mut under, mut white, mut black] = [0u64; 4];
        for y in 0..height {
            let (mut shown_here, mut flat_here) = (0u64, 0u64);
            for x in (0..width).filter(|&x| valid.is_none_or(|valid| valid.get_pixel(x, y).0[0] != 0)) {
                let (pixel, is_flat) = (picture.get_pixel(x, y).0[0], changes.is_flat(x, y));
                let [is_white, is_black] = [pixel >= 254, pixel <= 1];
                shown_here += 1;
                flat_here += u64::from(is_flat);
                grey += u64::from(pixel);
                over += u64::from(is_white);
                under += u64::from(is_black);
                white += u64::from(is_white && is_flat);
                black += u64::from(is_black && is_flat);
            }
            (shown, flat) = (shown + shown_here, flat + flat_here);
            rows.push(flat_here as f64 / shown_here.max(1) as f64);
        }
        let of_shown = |count: u64| count as f64 / shown.max(1) as f64;
        Self {
            untextured: of_shown(flat),
            over_exposed: of_shown(over),
            under_exposed: of_shown(under),
            white: of_shown(white),
            black: of_shown(black),
            masked: 1.0 - shown as f64 / (f64::from(width) * f64::from(height)),
            mean: of_shown(grey),
            rows,
        }
    }

    /// The share of this picture that lacks the texture that the other one has in the same rows.
    pub fn lost(&self, other: &Self) -> f64 {
        let more = self.rows.iter().zip(&other.rows).map(|(row, other)| (row - other).max(0.0));
        more.sum::<f64>() / self.rows.len().max(1) as f64
    }

    /// Which of the left and the right picture lacks much of the other one's texture, if one does.
    pub fn less_textured(lacks: &[Self; 2]) -> Option<usize> {
        let [left, right] = lacks;
        let share = |of: &Self, other: &Self| {
            let textured = other.textured();
            if textured > LEAST_TEXTURE { of.lost(other) / textured } else { 0.0 }
        };
        let shares = [share(left, right), share(right, left)];
        let most = usize::from(shares[1] >= shares[0]);
        (shares[most] > LOST_TEXTURE).then_some(most)
    }

    /// Whether one of the pictures lacks much of the other one's texture and has hardly any of its own.
    pub fn hardly_textured(lacks: &[Self; 2]) -> bool {
        Self::less_textured(lacks).is_some_and(|side| lacks[side].textured() < HARDLY_TEXTURED)
    }

    /// The share of the picture that has texture, with the same weight of all rows.
    fn textured(&self) -> f64 {
        1.0 - self.rows.iter().sum::<f64>() / self.rows.len().max(1) as f64
    }
}
