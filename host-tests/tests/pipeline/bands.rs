//! Bands of a frame: they cover it, overlap as far as their rows need, and no other split has a band of fewer
//! lines at most. That their rows are those of one pipeline is in `tests/matching/threads.rs`.

use stereopsis::matching::{Block, Checks, Config, Fast};
use stereopsis::pipeline::{Band, Pipeline};

const LATENCY: u16 = Pipeline::<Block, 160, 32>::LATENCY as u16;

fn config(height: u16, checks: Checks) -> Config {
    Config { checks, ..Config::for_method::<Block>(160, height, 32) }
}

fn rows_and_lines(height: u16, checks: Checks, most: u16) -> Vec<[u16; 4]> {
    let bands = Band::split::<Block>(&config(height, checks), most);
    bands.map(|b| [b.rows().start, b.rows().end, b.lines().start, b.lines().end]).collect()
}

#[test]
fn bands_have_equally_many_lines() {
    // 34 lines above and 10 below.
    assert_eq!(rows_and_lines(120, Checks::DEFAULT, 1), [[0, 120, 0, 120]]);
    assert_eq!(rows_and_lines(120, Checks::DEFAULT, 2), [[0, 72, 0, 82], [72, 120, 38, 120]]);
    assert_eq!(
        rows_and_lines(120, Checks::DEFAULT, 3),
        [[0, 60, 0, 70], [60, 86, 26, 96], [86, 120, 52, 120]]
    );
    // 10 above and 10 below.
    assert_eq!(rows_and_lines(120, Checks::DENSE, 2), [[0, 60, 0, 70], [60, 120, 50, 120]]);
    // Nothing to share: any second band would take all lines, too.
    assert_eq!(rows_and_lines(12, Checks::DEFAULT, 2), [[0, 12, 0, 12]]);
    assert_eq!(rows_and_lines(1, Checks::DEFAULT, 7), [[0, 1, 0, 1]]);
    assert_eq!(rows_and_lines(120, Checks::DEFAULT, 0), [[0, 120, 0, 120]], "no bands are one");
}

/// The fewest lines that the largest of `most` bands can have, by trying all first bands.
fn fewest(height: u16, above: u16, most: u16, from: u16, known: &mut Vec<Option<u16>>) -> u16 {
    let first = from.saturating_sub(above);
    let at = usize::from(most) * usize::from(height) + usize::from(from);
    if let Some(lines) = known[at] {
        return lines;
    }
    let mut least = height - first;
    if most > 1 {
        for to in from + 1..height {
            let this = height.min(to + LATENCY) - first;
            if this < least {
                least = least.min(this.max(fewest(height, above, most - 1, to, known)));
            }
        }
    }
    known[at] = Some(least);
    least
}

#[test]
fn no_other_split_is_better() {
    let narrow = Checks { speckle_pixels: 3, median: true, ..Checks::DEFAULT };
    for checks in [Checks::DENSE, Checks::DEFAULT, narrow] {
        let above = LATENCY + u16::from(checks.median) + u16::from(checks.speckle_pixels);
        for height in [1, 2, 9, 11, 30, 47, 61, 100, 120, 137] {
            for most in 1..6 {
                let bands: Vec<Band> = Band::split::<Block>(&config(height, checks), most).collect();
                assert!(!bands.is_empty() && bands.len() <= usize::from(most));
                let mut next = 0;
                for band in &bands {
                    let (rows, lines) = (band.rows(), band.lines());
                    assert_eq!(rows.start, next, "rows follow each other");
                    assert!(rows.end > rows.start);
                    assert_eq!(lines.start, rows.start.saturating_sub(above));
                    assert!(lines.end == height || lines.end == rows.end + LATENCY);
                    assert_eq!(band.config(&config(height, checks)).height, lines.end - lines.start);
                    let given: Vec<u16> = (0..lines.end - lines.start).filter_map(|y| band.row(y)).collect();
                    assert!(given.into_iter().eq(rows.clone()));
                    next = rows.end;
                }
                assert_eq!(next, height, "the whole frame");
                let most_lines = bands.iter().map(|band| band.lines().len()).max();
                let mut known = vec![None; usize::from(most + 1) * usize::from(height)];
                let fewest = fewest(height, above, most, 0, &mut known);
                assert_eq!(most_lines, Some(fewest.into()), "{height} rows, {most} bands, {above} above");
            }
        }
    }
}

#[test]
fn bands_of_the_tallest_frame() {
    let whole = Config { height: u16::MAX, ..Config::for_method::<Fast>(160, 120, 32) };
    let bands: Vec<Band> = Band::split::<Fast>(&whole, 64).collect();
    assert_eq!(bands.len(), 64);
    assert_eq!(bands.last().map(|band| band.rows().end), Some(u16::MAX));
    assert_eq!(Band::split::<Fast>(&Config { height: 0, ..whole }, 2).count(), 0);
}
