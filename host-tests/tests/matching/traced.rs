//! The rows that a matcher shows of its stages, beside the naive twins' on every kernel.

use stereopsis::imaging::LineWindow;
use stereopsis::matching::{
    Block, Config, Fast, Filter, Kernel, Matcher, Method, Sgm, SgmEdge, SgmLean, StageTrace, TracedStage,
    WinnerRecord,
};
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::run::MethodName;
use stereopsis_host::scene::pattern::Pattern;
use stereopsis_host::twin::stages::Stages;

const WIDTH: usize = 70;
const HEIGHT: usize = 30;
const DISPARITIES: u16 = 24;

/// The rows of each stage as they were shown.
#[derive(Default)]
struct Shown {
    winners: Vec<WinnerRecord>,
    subpixel: Vec<Disparity>,
    subpixel_flags: Vec<PixelFlags>,
    smoothed: Vec<Disparity>,
    checked: Vec<Disparity>,
    checked_flags: Vec<PixelFlags>,
}

impl StageTrace for Shown {
    fn winner(&mut self, row: usize, column: usize, winner: WinnerRecord) {
        // Left of the smallest disparity there is no winner.
        let place = row * WIDTH + column;
        assert!(place >= self.winners.len(), "winners come in order");
        self.winners.resize_with(place, || WinnerRecord::ZERO);
        self.winners.push(winner);
    }

    fn row(&mut self, stage: TracedStage, row: usize, answers: &[Disparity], flags: &[PixelFlags]) {
        let (to, to_flags) = match stage {
            TracedStage::Subpixel => (&mut self.subpixel, Some(&mut self.subpixel_flags)),
            TracedStage::Smoothed => (&mut self.smoothed, None),
            TracedStage::Checked => (&mut self.checked, Some(&mut self.checked_flags)),
        };
        assert_eq!(to.len(), row * WIDTH, "rows of {stage:?} come in order");
        to.extend_from_slice(answers);
        if let Some(to_flags) = to_flags {
            to_flags.extend_from_slice(flags);
        }
    }
}

/// A frame on one kernel.
fn shown<S: Method>(kernel: Kernel, config: &Config, left: &[u8], right: &[u8]) -> Shown {
    let mut matcher = Box::new(Matcher::<S, 80, 32>::new());
    matcher.set_kernel(kernel).expect("an available kernel");
    matcher.start(config).expect("a configuration that fits");
    let mut windows = [LineWindow::<WIDTH>::new(), LineWindow::new()];
    windows.iter_mut().for_each(|window| window.begin(WIDTH));
    let mut shown = Shown::default();
    for y in 0..HEIGHT + Matcher::<S, 80, 32>::DELAY {
        for (window, picture) in windows.iter_mut().zip([left, right]) {
            while window.count() < HEIGHT.min(y + 3) {
                let line = window.count() * WIDTH;
                window.next_line().copy_from_slice(&picture[line..line + WIDTH]);
                window.accept();
            }
        }
        let [left, right] = windows.each_ref().map(|window| window.around(y));
        matcher.step_traced((y < HEIGHT).then_some([&left, &right]), &mut shown).expect("a row that is due");
    }
    shown
}

#[test]
fn a_search_may_begin_beyond_the_row() {
    fn check<S: Method>(method: MethodName) {
        let picture = Pattern::Noise.pair(WIDTH as u32, HEIGHT as u32, 4).0;
        for min_disparity in [WIDTH as u16 - 1, WIDTH as u16, WIDTH as u16 + 9] {
            let config = Config { min_disparity, ..method.config(WIDTH as u16, HEIGHT as u16, DISPARITIES) };
            let twin = Stages::of(&method.twin(), &config, &picture, &picture);
            for kernel in Kernel::available() {
                let shown = shown::<S>(kernel, &config, picture.as_raw(), picture.as_raw());
                let what = format!("{} {} {min_disparity}", method.name(), kernel.name());
                assert_eq!(shown.winners.is_empty(), usize::from(min_disparity) >= WIDTH, "{what}: winners");
                assert!(shown.subpixel == twin.subpixel, "{what}: subpixel");
                assert!(shown.subpixel_flags == twin.flags, "{what}: flags");
                assert!(shown.checked == twin.checked.0, "{what}: checked");
                assert!(shown.checked_flags == twin.checked.1, "{what}: checked flags");
            }
        }
    }
    check::<Fast>(MethodName::Fast);
    check::<Sgm>(MethodName::Sgm);
    check::<SgmEdge>(MethodName::SgmEdge);
}

fn check<S: Method>(method: MethodName) {
    let (left, right) = Pattern::Shifted { most: 12, noise_grey: 2.0 }.pair(WIDTH as u32, HEIGHT as u32, 8);
    for (filter, confidence) in Filter::ALL.into_iter().flat_map(|filter| [(filter, false), (filter, true)]) {
        let min_disparity = if confidence { 3 } else { 0 };
        let search =
            Config { confidence, min_disparity, ..method.config(WIDTH as u16, HEIGHT as u16, DISPARITIES) };
        let config = method.with_filter(filter, search);
        let twin = Stages::of(&method.twin(), &config, &left, &right);
        for kernel in Kernel::available() {
            let shown = shown::<S>(kernel, &config, left.as_raw(), right.as_raw());
            let what = format!("{} {} {}", method.name(), filter.name(), kernel.name());
            let winners = twin.winners.iter().enumerate().map(|(i, winner)| match i % WIDTH {
                column if column < min_disparity.into() => WinnerRecord::ZERO,
                _ => winner.with_second(u8::MAX).sealed((i / WIDTH) as u16),
            });
            assert!(winners.eq(shown.winners), "{what}: winners");
            assert!(shown.subpixel == twin.subpixel, "{what}: subpixel");
            assert!(shown.subpixel_flags == twin.flags, "{what}: flags");
            assert!(shown.smoothed == twin.smoothed, "{what}: smoothed");
            assert!(shown.checked == twin.checked.0, "{what}: checked");
            assert!(shown.checked_flags == twin.checked.1, "{what}: checked flags");
        }
    }
}

#[test]
fn rows_that_stages_show_are_those_of_the_twin() {
    check::<Fast>(MethodName::Fast);
    check::<Block>(MethodName::Block);
    check::<SgmLean>(MethodName::SgmLean);
    check::<Sgm>(MethodName::Sgm);
    check::<SgmEdge>(MethodName::SgmEdge);
}
