//! Automatic exposure: one exposure and gain for both cameras of a pair.

use super::histogram::Histogram;
use crate::camera::{ExposureControl, GainSteps};

/// Exposure and gain for both sensors.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ExposureCommand {
    /// Exposure, microseconds.
    pub exposure_us: u32,
    /// Gain in sixteenths.
    pub gain_16ths: u16,
}

/// Limits of exposure and gain, and the steps in which a sensor sets them.
///
/// The controller reckons with what it asks for, so that a sensor that sets something else makes it swing.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ExposureLimits {
    /// Shortest exposure, microseconds; at least 1, if the longest is.
    pub least_us: u32,
    /// Longest exposure, microseconds.
    pub most_us: u32,
    /// Largest gain in sixteenths; 16 is no gain.
    pub most_gain_16ths: u16,
    /// Step of the exposure, microseconds: the time of a line of most sensors, rounded up. With 0 or 1 any
    /// exposure can be set.
    pub exposure_step_us: u32,
    /// Steps of the gain.
    pub gain_steps: GainSteps,
}

impl ExposureLimits {
    /// Limits and steps of a sensor as it is configured: its lines and frames say how long it can expose.
    pub fn of_sensor<S: ExposureControl + ?Sized>(sensor: &S) -> Self {
        let (least_us, most_us) = sensor.exposure_limits_us();
        Self {
            least_us,
            most_us,
            most_gain_16ths: sensor.most_gain_16ths(),
            exposure_step_us: sensor.exposure_step_us(),
            gain_steps: sensor.gain_steps(),
        }
    }

    /// An exposure down to whole steps, within the limits, microseconds.
    const fn whole_us(&self, exposure_us: u64) -> u32 {
        let step = if self.exposure_step_us == 0 { 1 } else { self.exposure_step_us as u64 };
        let whole = exposure_us - exposure_us % step;
        if exposure_us >= self.most_us as u64 {
            self.most_us
        } else if whole <= self.least_us as u64 {
            self.least_us
        } else {
            whole as u32
        }
    }
}

/// Controller of one exposure for both cameras of a pair, from the histograms of their frames.
///
/// The brighter camera counts, so that neither saturates. The controlled variable is `light = exposure x
/// gain`, with the exposure raised to its limit before the gain, and both in the sensor's steps: a gain in
/// sixteenths makes up what whole steps of the exposure leave, and the exposure is shortened by what the next
/// doubling of a gain is too much. With mean grey `m`, `light <- light x
/// clamp(TARGET / m, 1/2, 2)`; where more than [`AutoExposure::MOST_SATURATED`] per mille of the pixels are
/// saturated, the light decreases by a quarter to a half; it is not raised so far that they would be so
/// again.
///
/// After a change, [`AutoExposure::DELAY`] frames are ignored, as sensors apply settings late. Within
/// [`AutoExposure::DEAD_BAND`] of the target nothing changes. A linear response therefore reaches the band in
/// as many steps as the light has doublings, and stays. Where the sensor's steps are wider than the band the
/// setting below the target stays.
///
/// The caller passes the resulting [`ExposureCommand`] to both sensors
/// ([`ExposureControl`]).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AutoExposure {
    limits: ExposureLimits,
    current: ExposureCommand,
    /// Number of frames to ignore.
    waiting: u8,
}

impl AutoExposure {
    /// Target of the mean, grey levels.
    pub const TARGET: u16 = 100;
    /// Deviation from the target that is tolerated, grey levels.
    pub const DEAD_BAND: u16 = 12;
    /// Number of frames that do not show a change yet.
    pub const DELAY: u8 = 2;
    /// Largest share of saturated pixels, per mille.
    pub const MOST_SATURATED: u16 = 100;

    /// Starts with the middle of the exposures and no gain. Contradictory limits are put in order. No
    /// command leaves them: where no exposure is allowed, each is 0.
    pub const fn new(limits: ExposureLimits) -> Self {
        let least_us = if limits.least_us == 0 && limits.most_us > 0 { 1 } else { limits.least_us };
        let most_us = if limits.most_us < least_us { least_us } else { limits.most_us };
        let most_gain_16ths = if limits.most_gain_16ths < 16 { 16 } else { limits.most_gain_16ths };
        let most_gain_16ths = match limits.gain_steps {
            GainSteps::Sixteenths => most_gain_16ths,
            GainSteps::Doublings => 1 << most_gain_16ths.ilog2(),
        };
        let limits = ExposureLimits { least_us, most_us, most_gain_16ths, ..limits };
        let middle_us = least_us + (most_us - least_us) / 2;
        let current = ExposureCommand { exposure_us: limits.whole_us(middle_us as u64), gain_16ths: 16 };
        Self { limits, current, waiting: 0 }
    }

    /// Returns the current setting.
    pub fn current(&self) -> ExposureCommand {
        self.current
    }

    /// Takes a frame's histograms, left and right, and returns the new setting if it changes.
    pub fn frame(&mut self, histograms: [&Histogram; 2]) -> Option<ExposureCommand> {
        if let Some(left) = self.waiting.checked_sub(1) {
            self.waiting = left;
            return None;
        }
        let [left, right] = histograms;
        let brighter = if left.mean_16ths() < right.mean_16ths() { right } else { left };
        if brighter.count() == 0 {
            return None;
        }
        let (mean, target) = (u64::from(brighter.mean_16ths().max(1)), u64::from(16 * Self::TARGET));
        let is_saturated = left.saturated_per_mille().max(right.saturated_per_mille()) > Self::MOST_SATURATED;
        if !is_saturated && mean.abs_diff(target) <= u64::from(16 * Self::DEAD_BAND) {
            return None;
        }
        // 16ths of a microsecond at no gain.
        let light = u64::from(self.current.exposure_us) * u64::from(self.current.gain_16ths);
        let most = if is_saturated { light - light / 4 } else { room(light, left).min(room(light, right)) };
        let wanted = (light * target / mean).clamp(light / 2, most);
        let next = self.split(wanted);
        // What is brightest leaves so little room that it would be taken again and again.
        let is_full = wanted > light && wanted - light <= light / 16;
        if next == self.current || is_full {
            return None;
        }
        (self.current, self.waiting) = (next, Self::DELAY);
        Some(next)
    }

    /// Splits light into exposure and gain, the exposure as long as its limit and both in the sensor's steps.
    fn split(&self, light: u64) -> ExposureCommand {
        let limits = &self.limits;
        let most_gain = u64::from(limits.most_gain_16ths);
        // More light than is asked for may be nearer than less. It is taken if it ends well within the dead
        // band: only beyond the band is it left again, so that noise makes no swing.
        let most = light * u64::from(Self::TARGET + Self::DEAD_BAND / 2) / u64::from(Self::TARGET);
        let is_nearer = |less: u64, more: u64| more <= most && less + more < 2 * light;
        let (exposure_us, gain) = match limits.gain_steps {
            GainSteps::Sixteenths => {
                let exposure_us = limits.whole_us(light / 16);
                (exposure_us, light.checked_div(exposure_us.into()).unwrap_or(16).clamp(16, most_gain))
            }
            GainSteps::Doublings => {
                let least_gain = light.div_ceil(u64::from(limits.most_us.max(1)));
                let gain = least_gain.clamp(16, most_gain).next_power_of_two();
                let exposure_us = limits.whole_us(light / gain.max(16));
                // The shortest exposure with this gain may be more than the longest one with half of it and
                // than what is asked for: what it saturates would be left and come back again and again.
                let less = u64::from(limits.most_us) * (gain / 2);
                let more = u64::from(exposure_us) * gain;
                if gain > 16 && more > light && !is_nearer(less, more) {
                    (limits.most_us, gain / 2)
                } else {
                    (exposure_us, gain)
                }
            }
        };
        // Where no gain makes up what whole steps leave, one step more may be nearer.
        let is_short = gain == most_gain || limits.gain_steps == GainSteps::Doublings;
        let longer_us = limits.whole_us(u64::from(exposure_us) + u64::from(limits.exposure_step_us.max(1)));
        let (shorter, longer) = (u64::from(exposure_us) * gain, u64::from(longer_us) * gain);
        let takes_longer = is_short && is_nearer(shorter, longer);
        let exposure_us = if takes_longer { longer_us } else { exposure_us };
        ExposureCommand { exposure_us, gain_16ths: gain as u16 }
    }
}

/// To how much light a frame's light can be raised, at most to twice as much, before more pixels than are
/// allowed come near to saturation: a lamp or a window that was saturated would be so again.
fn room(light: u64, seen: &Histogram) -> u64 {
    const NEAR: u64 = 240;
    let most = u64::from(seen.count()) * u64::from(AutoExposure::MOST_SATURATED) / 1000;
    let mut brighter = 0;
    for (bin, &pixels) in seen.bins().iter().enumerate().rev() {
        brighter += u64::from(pixels);
        if brighter > most {
            let brightest = 16 * bin as u64 + 15;
            return (light * NEAR / brightest).clamp(light, light * 2);
        }
    }
    light * 2
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: ExposureLimits = ExposureLimits {
        least_us: 100,
        most_us: 10_100,
        most_gain_16ths: 64,
        exposure_step_us: 1,
        gain_steps: GainSteps::Sixteenths,
    };

    /// A histogram of pixels, so many of each grey level.
    fn of(levels: &[(u8, usize)]) -> Histogram {
        let mut histogram = Histogram::new();
        for &(grey, count) in levels {
            (0..count).for_each(|_| histogram.line(0, &[grey]));
        }
        histogram
    }

    /// What a fresh controller says of a frame: the light in microseconds at no gain.
    fn light(left: &[(u8, usize)], right: &[(u8, usize)]) -> Option<u32> {
        let mut auto = AutoExposure::new(LIMITS);
        let command = auto.frame([&of(left), &of(right)]);
        assert_eq!(auto.current(), command.unwrap_or(AutoExposure::new(LIMITS).current()));
        command.map(|command| command.exposure_us * u32::from(command.gain_16ths) / 16)
    }

    /// What it says of two frames alike.
    fn both(levels: &[(u8, usize)]) -> Option<u32> {
        light(levels, levels)
    }

    #[test]
    fn it_begins_in_the_middle() {
        let command = AutoExposure::new(LIMITS).current();
        assert_eq!(command, ExposureCommand { exposure_us: 5100, gain_16ths: 16 });
    }

    #[test]
    fn light_is_what_brings_the_mean_to_the_target() {
        // From 5100 us on, by 100 / mean.
        assert_eq!(both(&[(80, 1)]), Some(5100 * 100 / 80));
        assert_eq!(both(&[(150, 1)]), Some(5100 * 100 / 150));
        assert_eq!(both(&[(40, 1), (110, 1)]), Some(5100 * 100 / 75));
        // A half at least, of what is bright without being saturated.
        assert_eq!(both(&[(252, 1)]), Some(2550));
    }

    #[test]
    fn near_the_target_nothing_changes() {
        for (sum, changes) in
            [(87 * 16 + 15, true), (88 * 16, false), (112 * 16, false), (112 * 16 + 1, true)]
        {
            // Sixteen pixels with that sum.
            let (each, more) = ((sum / 16) as u8, sum % 16);
            assert_eq!(both(&[(each, 16 - more), (each + 1, more)]).is_some(), changes, "{sum}");
        }
        assert_eq!(both(&[]), None);
    }

    #[test]
    fn the_brighter_camera_counts() {
        for (left, right) in [(60, 125), (125, 60)] {
            assert_eq!(light(&[(left, 1)], &[(right, 1)]), Some(5100 * 100 / 125));
        }
        // Of an empty frame nothing is known.
        assert_eq!(light(&[(125, 1)], &[]), Some(5100 * 100 / 125));
    }

    #[test]
    fn more_than_a_tenth_saturated_takes_a_quarter_to_a_half() {
        // The mean is on the target: 253 or more are saturated.
        let saturated = |count: usize| [(83, 1000 - count), (253, count)];
        assert_eq!([both(&saturated(100)), both(&saturated(101))], [None, Some(5100 * 3 / 4)]);
        // Either camera's count.
        assert_eq!(light(&saturated(101), &[(100, 1)]), Some(5100 * 3 / 4));
        assert_eq!(light(&[(100, 1)], &saturated(101)), Some(5100 * 3 / 4));
        // A brighter picture loses what brings it to the target, down to a half.
        assert_eq!(both(&[(120, 800), (255, 200)]), Some(5100 * 100 / 147));
        assert_eq!(both(&[(255, 1)]), Some(2550));
    }

    #[test]
    fn two_frames_pass_before_a_change_shows() {
        let mut auto = AutoExposure::new(LIMITS);
        let dark = of(&[(80, 1)]);
        let changes = [(); 7].map(|()| auto.frame([&dark, &dark]).is_some());
        assert_eq!(changes, [true, false, false, true, false, false, true]);
    }

    #[test]
    fn the_exposure_is_raised_before_the_gain() {
        let mut auto = AutoExposure::new(LIMITS);
        let (dark, bright) = (of(&[(50, 1)]), of(&[(200, 1)]));
        let mut run = |histogram: &Histogram| {
            let command = (0..3).find_map(|_| auto.frame([histogram, histogram]));
            command.map(|command| (command.exposure_us, command.gain_16ths))
        };
        // Twice as much each time, to the limits of both.
        let raised = [(); 4].map(|()| run(&dark));
        assert_eq!(raised, [Some((10_100, 16)), Some((10_100, 32)), Some((10_100, 64)), None]);
        let lowered = [(); 10].map(|()| run(&bright));
        let exposures = [10_100, 10_100, 5050, 2525, 1262, 631, 315, 157, 100];
        let gains = [32, 16, 16, 16, 16, 16, 16, 16, 16];
        for (at, found) in lowered.into_iter().enumerate() {
            assert_eq!(found, exposures.get(at).map(|&exposure_us| (exposure_us, gains[at])), "{at}");
        }
    }

    /// What a sensor of these limits is set to once it is at rest, and the mean then, for a scene of so many
    /// grey levels in a millisecond.
    fn rest(limits: ExposureLimits, grey_per_ms: u32) -> (ExposureCommand, u32) {
        let mut auto = AutoExposure::new(limits);
        let mut quiet = 0;
        for _ in 0..100 {
            let ExposureCommand { exposure_us, gain_16ths } = auto.current();
            let mean = (grey_per_ms * exposure_us / 1000 * u32::from(gain_16ths) / 16).min(255);
            let seen = of(&[(mean as u8, 16)]);
            quiet = if auto.frame([&seen, &seen]).is_some() { 0 } else { quiet + 1 };
            if quiet > 20 {
                return (auto.current(), mean);
            }
        }
        panic!("it swings: {limits:?} under {grey_per_ms}");
    }

    #[test]
    fn steps_of_the_exposure_are_whole_and_the_gain_makes_up_the_rest() {
        let limits = ExposureLimits { least_us: 32, most_us: 16_000, exposure_step_us: 32, ..LIMITS };
        // A step is worth 70: two would be 140.
        let (command, mean) = rest(limits, 2200);
        assert_eq!((command.exposure_us, mean), (32, 96));
        assert!((20..=24).contains(&command.gain_16ths), "{command:?}");
        // Without a gain it stays at the step below, but for one that is nearly enough.
        let alone = ExposureLimits { most_gain_16ths: 16, ..limits };
        assert_eq!(rest(alone, 2200), (ExposureCommand { exposure_us: 32, gain_16ths: 16 }, 70));
        assert_eq!(rest(alone, 1600), (ExposureCommand { exposure_us: 64, gain_16ths: 16 }, 102));
        for grey_per_ms in (10..8000).step_by(7) {
            for limits in [limits, alone] {
                let ExposureCommand { exposure_us, .. } = rest(limits, grey_per_ms).0;
                assert!(exposure_us.is_multiple_of(32), "{exposure_us}");
            }
        }
    }

    #[test]
    fn a_gain_of_doublings_goes_up_and_shortens_the_exposure() {
        let limits = ExposureLimits {
            least_us: 200,
            most_us: 10_000,
            most_gain_16ths: 200,
            exposure_step_us: 100,
            gain_steps: GainSteps::Doublings,
        };
        // 70 at the longest exposure: some seven tenths of it at twice the gain.
        let (command, mean) = rest(limits, 7);
        assert_eq!(command.gain_16ths, 32, "{command:?}");
        assert!((6800..=7400).contains(&command.exposure_us) && (95..=105).contains(&mean), "{command:?}");
        // The largest doubling is eightfold.
        assert_eq!(rest(limits, 1).0, ExposureCommand { exposure_us: 10_000, gain_16ths: 128 });
        for grey_per_ms in 1..1000 {
            let ExposureCommand { exposure_us, gain_16ths } = rest(limits, grey_per_ms).0;
            assert!(gain_16ths.is_power_of_two() && exposure_us.is_multiple_of(100));
        }
    }

    #[test]
    fn a_window_is_not_saturated_again_and_again() {
        // A fifth of the picture is so many times as bright as the rest.
        for times in [2, 3, 5, 8, 16] {
            let mut auto = AutoExposure::new(LIMITS);
            let mut changes = [0; 2];
            for frame in 0..200 {
                let ExposureCommand { exposure_us, gain_16ths } = auto.current();
                let light = exposure_us * u32::from(gain_16ths) / 16;
                let [rest, window] = [1, times].map(|times| (light * times / 40).min(255) as u8);
                let seen = of(&[(rest, 12), (window, 3)]);
                changes[frame / 100] += usize::from(auto.frame([&seen, &seen]).is_some());
                assert!(frame < 100 || window < Histogram::SATURATED, "{times}");
            }
            assert_eq!(changes[1], 0, "{times}: it swings");
        }
    }

    /// Longest exposures that are less than twice the shortest.
    const NARROW: ExposureLimits = ExposureLimits {
        least_us: 180,
        most_us: 319,
        most_gain_16ths: 212,
        gain_steps: GainSteps::Doublings,
        ..LIMITS
    };

    #[test]
    fn a_gap_between_two_doublings_is_no_way_up() {
        let auto = AutoExposure::new(NARROW);
        for light in (16 * 180)..(128 * 319) {
            let command = auto.split(light);
            let set = u64::from(command.exposure_us) * u64::from(command.gain_16ths);
            assert!(100 * set <= 106 * light, "{light}: {command:?}");
            assert!((180..=319).contains(&command.exposure_us), "{light}: {command:?}");
            // No more is left than what the gap is wide: 2 * 180 beside 319.
            assert!(set * 360 + 360 * 128 >= light * 319, "{light}: {command:?}");
        }
    }

    #[test]
    fn a_lamp_beside_the_dark_comes_to_rest_between_two_doublings() {
        let mut auto = AutoExposure::new(NARROW);
        let mut settings = [auto.current(); 3];
        let mut last = 0;
        for frame in 0..200 {
            let light = f64::from(settings[0].exposure_us) * f64::from(settings[0].gain_16ths) / 16.0;
            let grey = |share: f64| (share * light).min(255.0) as u8;
            let seen = |gain: f64| {
                of(&[(grey(0.0197 * gain), 39), (grey(0.715 * gain), 28), (grey(0.0234 * gain), 11)])
            };
            let changed = auto.frame([&seen(1.0), &seen(0.91)]).is_some();
            settings = [settings[1], settings[2], auto.current()];
            last = if changed { frame } else { last };
        }
        assert!(last < 50, "it still changes in frame {last}");
    }
}
