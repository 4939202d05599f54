//! Winners from outside, through the functions for C: the rows are those of the method's own matcher.

use super::*;
use stereopsis::ffi::{CWinner, STEREOPSIS_NOISE_NONE, winners_bytes};
use stereopsis::matching::{External, Fast, Filter, Sgm, SgmEdge, SgmLean, WinnerRecord};
use stereopsis::units::PixelFlags;
use stereopsis_host::twin;
use stereopsis_host::twin::stages::Stages;

type C<S> = Instance<S, WIDTH, DISPARITIES>;

/// The records of a frame as C has them.
fn winners(twin: &twin::Method, config: &matching::Config) -> Vec<CWinner> {
    let (left, right) =
        Pattern::Shifted { most: 12, noise_grey: 4.0 }.pair(config.width.into(), config.height.into(), 5);
    let records = Stages::of(twin, config, &left, &right).winners;
    let winner = |record: WinnerRecord| {
        let [below, cost, above, disparity, kept, second, row, check] = record.bytes();
        CWinner { below, cost, above, disparity, kept, second, row, check }
    };
    records.into_iter().map(winner).collect()
}

/// The rows of winners through the functions for C; the winners of some rows are left out.
fn rows_of_winners<S: Method>(
    config: &CConfig,
    left: &[Vec<u8>],
    winners: &[CWinner],
    lost: &[u16],
) -> Vec<Found>
where
    External<S>: Method,
{
    let width = usize::from(config.width);
    let mut memory = vec![0xA5A5_A5A5_A5A5_A5A5_u64; C::<S>::winners_size().div_ceil(8)];
    let (mut handle, mut found, mut row) = (null_mut(), Vec::new(), NO_ROW);
    let (mut needs_lines, mut needs_second) = (7, 7);
    // SAFETY: the memory outlives the handle, lines and winners have their length, and rows are read before
    // the next call.
    unsafe {
        let length = size_of_val(&memory[..]);
        let status = C::<S>::winners_init(memory.as_mut_ptr().cast(), length, &raw mut handle);
        assert_eq!(status, Status::Ok);
        let status = C::<S>::winners_start(handle, config, &raw mut needs_lines, &raw mut needs_second);
        assert_eq!(status, Status::Ok);
        assert_eq!(needs_second == 1, config.confidence == 1 || config.uniqueness_percent >= 0);
        assert_eq!(C::<S>::winners_begin_frame(handle), Status::Ok);
        let mut lines = left.iter();
        loop {
            let mut due = u16::MAX;
            let row_of_winners = match C::<S>::winners_due(handle, &raw mut due) {
                Status::Ok if lost.contains(&due) => null(),
                Status::Ok => winners[usize::from(due) * width..][..width].as_ptr(),
                status => {
                    assert_eq!((status, due), (Status::NoRowYet, u16::MAX));
                    null()
                }
            };
            let line = lines.next().map(|line| if needs_lines == 1 { line.as_ptr() } else { null() });
            let line = line.map(|line| (line, width));
            match C::<S>::winners_take(handle, line, row_of_winners, width, &raw mut row) {
                Status::Ok => {}
                Status::NoRowYet => {
                    assert!(row == NO_ROW);
                    continue;
                }
                Status::FrameDone => break,
                wrong => panic!("{wrong:?}"),
            }
            let mut sigma_px = vec![0.0; width];
            assert_eq!(C::<S>::winners_sigma_px(handle, sigma_px.as_mut_ptr(), width), Status::Ok);
            found.push(Found::of(&row, sigma_px));
        }
        assert_eq!(C::<S>::winners_deinit(handle), Status::Ok);
    }
    found
}

/// The same rows from winners and from pictures, with the checks of a filter.
fn compare<S: Method>(twin: &twin::Method)
where
    External<S>: Method,
{
    assert!(C::<S>::winners_size() <= winners_bytes(WIDTH, DISPARITIES), "{}", S::NAME);
    for (width, height, filter, min_disparity) in [
        (96, 30, Filter::Default, 0),
        (60, 12, Filter::Strict, 3),
        (37, 1, Filter::Default, 0),
        (9, 5, Filter::Dense, 0),
    ] {
        let asked = matching::Config {
            confidence: width > 60,
            min_disparity,
            ..matching::Config::for_method::<S>(width, height, 32)
        };
        let asked = asked.with_filter::<S>(filter);
        let mut config = MaybeUninit::uninit();
        // SAFETY: the pointer is to memory for a configuration, all of which is filled.
        let config = unsafe {
            let preset = filter as i32;
            let status = stereopsis::ffi::config_default::<S>(width, height, 32, preset, config.as_mut_ptr());
            assert_eq!(status, Status::Ok);
            config.assume_init()
        };
        let config = CConfig { confidence: (width > 60).into(), min_disparity, ..config };
        assert_eq!(config.noise, STEREOPSIS_NOISE_NONE);
        let lines = lines(width, height);
        let winners = winners(twin, &asked);
        let own = rows::<S>(&asked, &lines);
        let found = rows_of_winners::<S>(&config, &lines[0], &winners, &[]);
        assert_eq!(found.len(), usize::from(height));
        assert!(found == own, "{} {width}x{height} {filter:?}", S::NAME);
        // A row whose winners are lost has no answers.
        let lost = rows_of_winners::<S>(&config, &lines[0], &winners, &[height / 2]);
        let row = &lost[usize::from(height / 2)];
        assert!(row.disparities.iter().all(|&d| d == u16::MAX));
        assert!(row.flags.iter().all(|flags| flags & PixelFlags::DAMAGED.bits() != 0));
        let before = usize::from(height / 2).saturating_sub(4);
        assert!(lost[..before] == own[..before], "{} {width}x{height}", S::NAME);
    }
}

#[test]
fn rows_of_winners_are_the_methods_own() {
    compare::<Fast>(&twin::Method::FAST);
    compare::<Block>(&twin::Method::BLOCK);
    compare::<SgmLean>(&twin::Method::SGM_LEAN);
    compare::<Sgm>(&twin::Method::SGM);
    compare::<SgmEdge>(&twin::Method::SGM_EDGE);
}

#[test]
fn winners_are_sealed_as_records() {
    let mut winner =
        CWinner { below: 34, cost: 30, above: 41, disparity: 12, kept: 12, second: 90, row: 0, check: 0 };
    // SAFETY: it is one winner.
    assert_eq!(unsafe { stereopsis_winners_seal(&raw mut winner, 1, 263) }, Status::Ok);
    let sealed = WinnerRecord::new(12, 30, [34, 41]).with_second(90).sealed(263).bytes();
    assert_eq!([winner.row, winner.check], [sealed[6], sealed[7]]);
}
