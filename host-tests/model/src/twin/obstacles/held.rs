//! What counts of all frames so far, from their whole history.

use super::Sector;
use stereopsis::obstacles::{Hysteresis, SectorState};

/// The distance that counts after the last of these frames, each of which shows one or none.
///
/// An obstacle is believed in from the end of a run of `confirm` frames on that show it, until the end of a
/// run of more than `release` frames that do not; 255 is for ever.
pub fn counts(shown: &[Option<i128>], rule: Hysteresis) -> Option<i128> {
    let mut believed = None;
    for now in 0..shown.len() {
        let run = shown[..=now].iter().rev().take_while(|at| at.is_some() == shown[now].is_some()).count();
        believed = match shown[now] {
            Some(mm) if believed.is_some() || run >= usize::from(rule.confirm) => Some(mm),
            Some(_) => None,
            None if run > usize::from(rule.release) && rule.release < u8::MAX => None,
            None => believed,
        };
    }
    believed
}

/// The sectors that count after the last of these frames.
///
/// A surface that is not believed in makes its sector blind; a free sector with one that is believed in shows
/// that surface as it was seen last.
pub fn free_space(frames: &[Vec<Sector>], rule: Hysteresis) -> Vec<Sector> {
    let count = frames.last().map_or(0, Vec::len);
    let one = |index: usize| {
        let shows = |sector: &Sector| matches!(sector.state, SectorState::Obstacle | SectorState::Drop);
        let shown: Vec<_> = frames
            .iter()
            .map(|sectors| Some(sectors[index].depth_mm).filter(|_| shows(&sectors[index])))
            .collect();
        let (mut kept, mut surface) = (frames[0][index], frames[0][index]);
        for (now, sectors) in frames.iter().enumerate() {
            let sector = sectors[index];
            if shows(&sector) {
                surface = sector;
            }
            kept = match (sector.state, counts(&shown[..=now], rule)) {
                (SectorState::Free, Some(_)) => surface,
                (_, None) if shows(&sector) => Sector { state: SectorState::Blind, ..sector },
                _ => sector,
            };
        }
        kept
    };
    (0..count).map(one).collect()
}
