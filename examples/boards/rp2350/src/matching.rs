//! The task of a core: the rows of its band, and their nearest distance.

use board_matchers::two_cores::Matching;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use embassy_time::{Duration, with_timeout};

/// A frame that takes longer has stopped.
const NO_FRAME: Duration = Duration::from_millis(200);

/// What a core has of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Which core.
    pub core: usize,
    /// The frame.
    pub sequence: u32,
    /// The nearest answer of the band, millimetres; `u16::MAX` without one.
    pub nearest_mm: u16,
    /// Lines that were replaced.
    pub lost_lines: u16,
}

/// What the cores have seen.
pub static SEEN: Channel<CriticalSectionRawMutex, Seen, 4> = Channel::new();

/// Matches a band, frame by frame.
#[embassy_executor::task(pool_size = 2)]
pub async fn run(matching: Matching) -> ! {
    let Matching { core, band, rows, mut cameras, mut lines, scale } = matching;
    loop {
        let begun = with_timeout(NO_FRAME, rows.begin_frame_async(&mut cameras, &mut lines)).await;
        let Ok(Ok(frame)) = begun else { continue };
        let mut nearest_mm = u16::MAX;
        // A dead camera and a broken frame end it; what was seen by then is told.
        while let Ok(Ok(Some(row))) =
            with_timeout(NO_FRAME, rows.next_row_async(&mut cameras, &mut lines)).await
        {
            // The rows of the overlap are the other core's.
            if band.row(row.index()).is_some() {
                let depths = row.disparities().iter().map(|&d| scale.millimetres(d).0);
                nearest_mm = depths.filter(|&mm| mm > 0).fold(nearest_mm, u16::min); // 0 is no answer.
            }
        }
        let lost_lines = rows.lost_lines();
        SEEN.send(Seen { core, sequence: frame.sequence, nearest_mm, lost_lines }).await;
    }
}
