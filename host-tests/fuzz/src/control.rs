//! Searches and loops that move hardware.

use arbitrary::{Result, Unstructured};
use stereopsis::camera::GainSteps;
use stereopsis::focus::{ActuatorLimits, Autofocus, FocusSearch, FocusSearchStep, LensCommand, LensEvent};
use stereopsis::imaging::{AutoExposure, ExposureLimits, Histogram};

/// What is commanded is within the limits, whatever the hardware says, and every search ends.
pub fn stays_in_its_limits(u: &mut Unstructured<'_>) -> Result<()> {
    match u.int_in_range(0..=2)? {
        0 => search(u),
        1 => autofocus(u),
        _ => exposure(u),
    }
}

fn search(u: &mut Unstructured<'_>) -> Result<()> {
    let (a, b): (u16, u16) = (u.arbitrary()?, u.arbitrary()?);
    let mut search = FocusSearch::new(a, b);
    for _ in 0..=FocusSearch::MOST_FRAMES {
        if let FocusSearchStep::Measure(at) | FocusSearchStep::Best(at) = search.next() {
            assert!((a.min(b)..=a.max(b)).contains(&at), "{at} of {a} to {b}");
            search.measured(if u.ratio(1, 4)? { u.arbitrary()? } else { at }, u.arbitrary()?);
        }
    }
    assert!(!matches!(search.next(), FocusSearchStep::Measure(_)), "it ends");
    Ok(())
}

fn autofocus(u: &mut Unstructured<'_>) -> Result<()> {
    let limits = ActuatorLimits { least: u.arbitrary()?, most: u.arbitrary()?, backlash: u.arbitrary()? };
    let (least, most) = (limits.least.min(limits.most), limits.least.max(limits.most));
    let (mut focus, mut command) = Autofocus::new(limits, u.arbitrary()?, u.arbitrary()?);
    // The longest way is one position at a time; bytes end long before.
    while !u.is_empty() {
        let event = match command {
            LensCommand::Focused(found) => {
                assert!((least..=most).contains(&found.position), "{found:?} of {limits:?}");
                return Ok(());
            }
            LensCommand::Failed(_) => return Ok(()),
            LensCommand::Move(at) => LensEvent::Arrived(if u.ratio(1, 8)? { u.arbitrary()? } else { at }),
            LensCommand::Measure => LensEvent::Sharpness(u.arbitrary()?),
        };
        let failures = [LensEvent::MoveFailed, LensEvent::FrameLost];
        command = focus.event(if u.ratio(1, 16)? { *u.choose(&failures)? } else { event });
    }
    Ok(())
}

fn exposure(u: &mut Unstructured<'_>) -> Result<()> {
    let gain_steps = if u.arbitrary()? { GainSteps::Doublings } else { GainSteps::Sixteenths };
    let limits = ExposureLimits {
        least_us: u.arbitrary()?,
        most_us: u.arbitrary()?,
        most_gain_16ths: u.arbitrary()?,
        exposure_step_us: u.arbitrary()?,
        gain_steps,
    };
    let mut auto = AutoExposure::new(limits);
    let (least, most) = (limits.least_us, limits.most_us.max(limits.least_us));
    let mut histograms = [Histogram::new(), Histogram::new()];
    for _ in 0..u.int_in_range(1..=20)? {
        for histogram in &mut histograms {
            histogram.begin();
            for row in 0..u.int_in_range(0..=4)? {
                histogram.line(row, &u.arbitrary::<[u8; 16]>()?);
            }
        }
        let command = auto.frame([&histograms[0], &histograms[1]]).unwrap_or_else(|| auto.current());
        assert!((least..=most).contains(&command.exposure_us), "{command:?} {limits:?}");
        assert!(
            (16..=limits.most_gain_16ths.max(16)).contains(&command.gain_16ths),
            "{command:?} {limits:?}"
        );
        let is_doubling = gain_steps == GainSteps::Sixteenths || command.gain_16ths.is_power_of_two();
        assert!(is_doubling, "{command:?} {limits:?}");
    }
    Ok(())
}
