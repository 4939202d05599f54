//! Median filter of a focus map.

use super::{FocusPeak, NoFocus};

/// The median of the answers' positions in windows of 5 by 5 cells, a row of cells from the five around it: a
/// cell whose noise was taken for a peak gets its neighbours' answer. A cell without an answer stays so, and
/// one keeps its own deviation and confidence. Of an even number of answers the lower one of the middle
/// counts. Edges stay in place, for a median invents no value between two surfaces.
///
/// The caller repeats the nearest row where there is none; columns outside are left out.
pub fn median_row(rows: [&[Result<FocusPeak, NoFocus>]; 5], out: &mut [Result<FocusPeak, NoFocus>]) {
    let [_, _, middle, _, _] = rows;
    for (x, (own, out)) in middle.iter().zip(out).enumerate() {
        *out = own.map(|own| {
            let mut values = [u32::MAX; 25];
            let mut count = 0;
            for row in rows {
                let near = row.iter().take(x + 3).skip(x.saturating_sub(2)).flatten();
                for (peak, place) in near.zip(values.iter_mut().skip(count)) {
                    *place = peak.position_q8;
                    count += 1;
                }
            }
            let middle = count.saturating_sub(1) / 2;
            let (_, median, _) = values.select_nth_unstable(middle);
            FocusPeak { position_q8: *median, ..own }
        });
    }
}
