//! Whether a frame is to be trusted, by counting what is missing of it.

use super::Scene;
use stereopsis::obstacles::BlindReason;
use stereopsis::units::PixelFlags;

/// Why a frame is not to be trusted: its cameras, its rows, its cells.
pub fn blind(scene: &Scene<'_>, cells: &[Option<i128>]) -> Option<BlindReason> {
    let pixels = scene.size()[0] * usize::from(scene.config.cell_width);
    let is_lost = |y: usize| {
        let row = &scene.flags[y * scene.width..][..pixels];
        !scene.came[y] || row.iter().any(|flags| flags.contains(PixelFlags::DAMAGED))
    };
    let lost = (0..scene.height).filter(|&y| is_lost(y)).count();
    let answered = cells.iter().flatten().count();
    let [most_lost, least_answered] = [scene.config.most_lost, scene.config.least_answered].map(usize::from);
    if scene.cameras.is_some() {
        scene.cameras
    } else if 100 * lost > most_lost * scene.height {
        Some(BlindReason::RowsLost)
    } else if 100 * answered < least_answered * cells.len() {
        Some(BlindReason::FewAnswers)
    } else {
        None
    }
}
