//! Choice of a window by its noise (Lepski 1990): the narrowest in which noise moves the peak little.

use super::{FocusPeak, NoFocus};

/// Noise that the narrowest window may leave, 1/256 frame: a fifth of a frame.
const MOST: u32 = 51;

/// The answer of one cell among those of windows of several sizes, the narrowest first: that of the first
/// window in which noise moves the peak by less than a fifth of a frame, in the second by two fifths, and so
/// on, for each wider one averages more of the surface. Without one, it is the answer of the widest window
/// that has any; `answers` that is empty is [`NoFocus::Untextured`].
///
/// ```
/// use stereopsis::focus::{FocusPeak, NoFocus, narrowest_steady};
/// let answer = |position_q8, noise_q8| {
///     Ok(FocusPeak { position_q8, sigma_q8: noise_q8, noise_q8, confidence: 200 })
/// };
/// assert_eq!(narrowest_steady(&[answer(256, 20), answer(300, 10)]), answer(256, 20));
/// assert_eq!(narrowest_steady(&[answer(256, 60), answer(300, 30)]), answer(300, 30));
/// assert_eq!(narrowest_steady(&[answer(256, 60), Err(NoFocus::Broad)]), answer(256, 60));
/// ```
pub fn narrowest_steady(answers: &[Result<FocusPeak, NoFocus>]) -> Result<FocusPeak, NoFocus> {
    let mut most = MOST;
    let mut widest = Err(NoFocus::Untextured);
    for &answer in answers {
        match answer {
            Ok(peak) if peak.noise_q8 < most => return answer,
            Err(_) if widest.is_ok() => {}
            _ => widest = answer,
        }
        most = most.saturating_mul(2);
    }
    widest
}
