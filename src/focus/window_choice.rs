//! Choice of a window by its noise (Lepski 1990): the narrowest in which noise moves the peak little.

use super::{FocusPeak, NoFocus};

/// Noise that the narrowest window may leave, 1/256 frame: a fifth of a frame.
const MOST: u32 = 51;
/// Deviations that the answer of a wider window may be away from that of the one before it.
const DEVIATIONS: u32 = 2;

/// The answer of one cell among those of windows of several sizes, the narrowest first: that of the first
/// window in which noise moves the peak by less than a fifth of a frame, and by twice as much for each wider
/// one, which averages more of the surface. Without one, it is the answer of the widest window that has any;
/// `answers` that is empty is [`NoFocus::Untextured`].
///
/// From the third on, a window counts only as far as its answer is within two deviations of the one before:
/// where it is farther away than noise explains, the surface is too steep for it. The narrowest one, of few
/// pixels, is less sure than it says, and holds none back.
///
/// ```
/// use stereopsis::focus::{FocusPeak, NoFocus, narrowest_steady};
/// let answer = |position_q8, noise_q8| {
///     Ok(FocusPeak { position_q8, sigma_q8: noise_q8, noise_q8, confidence: 200 })
/// };
/// assert_eq!(narrowest_steady(&[answer(256, 20), answer(300, 10)]), answer(256, 20));
/// assert_eq!(narrowest_steady(&[answer(256, 60), answer(300, 30)]), answer(300, 30));
/// assert_eq!(narrowest_steady(&[answer(256, 60), Err(NoFocus::Broad)]), answer(256, 60));
/// let (second, far) = (answer(256, 110), answer(480, 10));
/// assert_eq!(narrowest_steady(&[answer(250, 300), second, answer(470, 10)]), answer(470, 10));
/// assert_eq!(narrowest_steady(&[answer(250, 300), second, far]), second);
/// ```
pub fn narrowest_steady(answers: &[Result<FocusPeak, NoFocus>]) -> Result<FocusPeak, NoFocus> {
    let mut most = MOST;
    let mut widest = Err(NoFocus::Untextured);
    for (index, &answer) in answers.iter().enumerate() {
        match (answer, widest) {
            (Ok(peak), Ok(FocusPeak { position_q8, noise_q8, .. }))
                if index >= 2
                    && peak.position_q8.abs_diff(position_q8) > noise_q8.saturating_mul(DEVIATIONS) => {}
            (Ok(peak), _) if peak.noise_q8 < most => return answer,
            (Err(_), Ok(_)) => {}
            _ => widest = answer,
        }
        most = most.saturating_mul(2);
    }
    widest
}
