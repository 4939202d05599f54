//! Lost lines where a camera did not see.

use super::*;

#[test]
fn a_row_that_rests_on_a_lost_line_says_so_where_a_camera_did_not_see() {
    let pair = pair(60, 80);
    let config = Config::for_method::<Fast>(60, 80, 16);
    let mut guard = Box::new(Guard::new());
    guard.start(&config).expect("the configuration is valid");
    guard.begin().expect("it is started");
    let mut rows: Vec<Kept> = Vec::new();
    let mut keep = |guard: &mut Guard| {
        guard.mask(|_, [left, right]| {
            left.fill(1);
            right.fill(1);
            left[20..40].fill(0);
            true
        });
        rows.extend(guard.row().map(Kept::from));
    };
    for (y, (left, right)) in lines(&pair).enumerate() {
        let row = if y == 9 { guard.push_lost(LineFault::Torn) } else { guard.push(left, right) };
        if row.expect("a line of the frame").is_some() {
            keep(&mut guard);
        }
    }
    while guard.flush().expect("all lines are in").is_some() {
        keep(&mut guard);
    }
    let last = 9 + guard.reach_down();
    assert_eq!(rows.len(), 80);
    assert!(last < 79, "a row without the flag is left");
    for (y, row) in rows.iter().enumerate() {
        let is_damaged = (9usize.saturating_sub(Any::<Fast>::LATENCY)..=last).contains(&y);
        let unseen = PixelFlags::OUTSIDE.union(PixelFlags::DAMAGED.when(is_damaged));
        assert_eq!(row.flags[20..40], [unseen; 20], "row {y}");
        assert!(row.flags.iter().all(|flags| flags.contains(PixelFlags::DAMAGED) == is_damaged), "row {y}");
    }
}
