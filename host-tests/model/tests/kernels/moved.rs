//! A matcher that changes its place between two lines of a frame.

use super::Twin;
use super::frames::LIVE;
use stereopsis::matching::{Block, Config, Fast, Matcher, Sgm};

/// Where a matcher stands: the two places are eight bytes apart, seen from the lines of a cache.
#[repr(C, align(64))]
struct Place<const BEFORE: usize, M> {
    before: [u64; BEFORE],
    matcher: Option<M>,
}

impl<const BEFORE: usize, M> Place<BEFORE, M> {
    fn new(matcher: Option<M>) -> Self {
        Self { before: [0; BEFORE], matcher }
    }
}

fn moved_within_a_frame<S: Twin>() {
    type Size<S> = Matcher<S, 96, 64>;
    let (width, height) = (90, 24);
    let (left, right) = LIVE.pair(width, height, 5);
    let around = |picture: &image::GrayImage, y: usize| {
        [-2, -1, 0, 1, 2].map(|off| {
            let y = y.saturating_add_signed(off).min(height as usize - 1);
            picture.as_raw()[y * width as usize..][..width as usize].to_vec()
        })
    };
    let rows = |moves: bool| {
        let config = Config::for_method::<Block>(width as u16, height as u16, 32);
        let mut one = Box::new(Place::<0, Size<S>>::new(Some(Matcher::new())));
        let mut other = Box::new(Place::<1, Size<S>>::new(None));
        one.matcher.as_mut().expect("it begins there").start(&config).expect("a valid configuration");
        let mut rows: Vec<Vec<u16>> = Vec::new();
        for y in 0..height as usize + Size::<S>::DELAY {
            let matcher = one.matcher.as_mut().or(other.matcher.as_mut()).expect("it stands somewhere");
            if y < height as usize {
                let (left, right) = (around(&left, y), around(&right, y));
                let [left, right] = [&left, &right].map(|lines| lines.each_ref().map(|line| line.as_slice()));
                matcher.push(&left, &right).expect("a line");
            } else {
                matcher.flush().expect("a row is due");
            }
            rows.extend(matcher.row().map(|row| row.disparities().iter().map(|d| d.raw()).collect()));
            if moves {
                core::mem::swap(&mut one.matcher, &mut other.matcher);
            }
        }
        assert_eq!((one.before, other.before), ([], [0]));
        rows
    };
    assert_eq!(rows(true), rows(false));
    assert_eq!(rows(true).len(), height as usize);
}

#[test]
fn a_matcher_may_be_moved_between_lines() {
    moved_within_a_frame::<Fast>();
    moved_within_a_frame::<Sgm>();
}
