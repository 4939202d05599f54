//! How sure an answer is.

use super::Answers;
use stereopsis::matching::Config;
use stereopsis::units::{Disparity, PixelFlags};

/// Refuses the answers that are less sure than asked for.
pub(super) fn refuse_unsure(config: &Config, map: &mut Answers) {
    for i in 0..map.confidence.len() {
        if map.disparity[i].is_some() && map.confidence[i] < config.min_confidence {
            (map.disparity[i], map.sigma_px[i], map.confidence[i]) = (Disparity::NONE, None, 0);
            map.flags[i] = map.flags[i].without(PixelFlags::FILLED).union(PixelFlags::AMBIGUOUS);
        }
    }
}

/// The confidence of every pixel of the `map`, of the margins of the winners, and of the answers around:
/// those `before` median and speckle filter, in rows above those `after`. The answer itself is that after the
/// median.
pub(super) fn confidences(
    config: &Config,
    margins: &[u16],
    before: &[Disparity],
    [answers, after]: [&[Disparity]; 2],
    map: &Answers,
) -> Vec<u8> {
    let (width, height) = (usize::from(config.width), usize::from(config.height));
    let confidence = |(x, y): (usize, usize)| {
        let here = y * width + x;
        if map.disparity[here].is_none() {
            return 0;
        }
        if map.flags[here].contains(PixelFlags::FILLED) {
            return 1;
        }
        let (mut beside, mut column) = (Vec::new(), Vec::new());
        for off in [4, 8] {
            if x >= off {
                beside.push(before[here - off]);
            }
            if x + off < width {
                beside.push(before[here + off]);
            }
        }
        for off in [2, 4] {
            if y >= off {
                column.push(after[here - off * width]);
            }
            // No row below the image bears an answer out.
            column.push(if y + off < height { before[here + off * width] } else { Disparity::NONE });
        }
        let agreement = |others: Vec<Disparity>| {
            let most = others.into_iter().map(|other| answers[here].distance(other).unwrap_or(4 * 40)).max();
            40u16.saturating_sub(most.unwrap_or(0) / 4)
        };
        (margins[here].min(127) + agreement(beside) + agreement(column)).max(1) as u8
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(confidence).collect()
}
