//! Winners become answers with flags: the left-right check, the fraction of a pixel, and what refuses an
//! answer.
//!
//! Each column of the right image keeps the cheapest of the left pixels that chose it; in the methods along
//! paths what the two pixels differ by counts as well. A left pixel whose disparity is far from what its
//! partner kept was beaten there: it is occluded or wrong. Nothing is searched a second time, and on real
//! pairs the check refuses fewer right answers than one against the right image's own winners. The work is
//! the same for every row.

use crate::imaging::Noise;
use crate::matching::backend::loops::{empty_row, fill_bytes, keep_loop, keep_scalar_loop};
use crate::matching::backend::{AnswerWork, Isa, Rules, answer_records};
use crate::matching::config::Config;
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::{part, part_mut, split_mut};
use crate::matching::memory::views::view;
use crate::matching::memory::workspace::ForAnswers;
use crate::matching::method::{Frame, Method};
use crate::units::{Disparity, PixelFlags};

/// Turns the winners of `newest` into answers, none of those that the checks contradict, and says why: flags
/// that are set already stay.
pub(super) fn make_answers<S: Method>(frame: &mut Frame<'_>, newest: usize, lines: Option<[&Rows5<'_>; 2]>) {
    let (answers, flags) = (frame.band.row_mut(newest), frame.flags.row_mut(newest));
    let config = frame.config;
    let checks = &config.checks;
    let rules = Rules {
        min_disparity: config.min_disparity,
        ceiling: (config.disparities - 1) as u8,
        // Where nothing is checked, nothing is over the tolerance.
        tolerance: checks.left_right_px.unwrap_or(u8::MAX),
        flat: PixelFlags::UNTEXTURED.when(checks.refuse_flat),
        refused: PixelFlags::UNTEXTURED
            .union(PixelFlags::AMBIGUOUS)
            .union(PixelFlags::MISMATCH)
            .union(PixelFlags::CEILING.when(checks.refuse_ceiling)),
    };
    // Left of here no pixel has a candidate.
    let width = answers.len();
    let begin = usize::from(config.min_disparity).min(width);
    let (outside, answers) = split_mut(answers, begin);
    empty_row(outside);
    let (outside, flags) = split_mut(flags, begin);
    fill_bytes(outside, PixelFlags::OUTSIDE.bits());
    let rules = &rules;
    if S::EXTERNAL_WINNERS {
        answer_records::<S>(part(view(frame.codes), begin..), rules, answers, flags);
    } else {
        let ForAnswers { winners, right, workspace } = frame.workspace.for_answers();
        let (answers, flags) = (&mut *answers, &mut *flags);
        let pixels = compared::<S>(config, lines, begin, width);
        let work = AnswerWork { winners, right, workspace, begin, pixels, rules, answers, flags };
        frame.backend.left_right::<S>(work);
    }
    flag_first_column::<S>(config, answers, flags);
}

/// Of a method that compares the pixels of an offer, the left image's row from column `begin` on, and as much
/// of the right one's: that of the row whose answers are made. Below the image nothing is in.
pub(super) fn compared<'a, S: Method>(
    config: &Config,
    lines: Option<[&Rows5<'a>; 2]>,
    begin: usize,
    width: usize,
) -> Option<[&'a [u8]; 2]> {
    let lines = lines.filter(|_| S::ALONG_PATHS && config.noise == Noise::None)?;
    let [left, right] = lines.map(|lines| lines.get(2usize.wrapping_sub(S::RADIUS_Y)).copied());
    Some([part(left?, begin..width), part(right?, ..width - begin)])
}

/// Flags the answers whose partner is the first column of the right image: of the candidates inside that
/// image theirs is the last. Most of them stand for what the right camera does not see.
fn flag_first_column<S: Method>(config: &Config, answers: &mut [Disparity], flags: &mut [PixelFlags]) {
    // Farther right the last candidate lies inside the image. At an end there is no fraction of a pixel.
    let columns = usize::from(config.disparities).min(answers.len());
    let mut end = u32::from(Disparity::from_pixels(config.min_disparity).raw());
    let refused = 0u16.wrapping_sub(u16::from(config.checks.refuse_ceiling));
    for (answer, flags) in part_mut(answers, ..columns).iter_mut().zip(flags) {
        // In vectors only where the rest of a row takes little: they are 150 bytes more of flash.
        if S::ALONG_PATHS {
            keep_loop();
        }
        keep_scalar_loop();
        if u32::from(answer.raw()) == end {
            *flags = flags.union(PixelFlags::CEILING);
            *answer = Disparity::from_raw(answer.raw() | refused);
        }
        end += u32::from(Disparity::ONE);
    }
}
