//! A camera that flies: without a ground a column is free where it has answers from edge to edge.

use super::support::{Map, rig};
use stereopsis::obstacles::{
    BlindReason, Decision, DriveConfig, DriveRule, GroundSource, ObstacleConfig, SectorState,
};

/// Without a ground all that is seen is 40 m away, in some of the rows: what stands in the others, straight
/// ahead or at the height of a wing, may be near.
#[test]
fn what_is_not_seen_in_flight_is_not_free() {
    let decided = |is_seen: &dyn Fn(f64) -> bool| {
        let far = Map::of(rig(), [160, 120], |_, v| is_seen(v).then_some(0.325));
        let config = ObstacleConfig { ground: GroundSource::Absent, ..ObstacleConfig::default() };
        let mut finder = far.finder(&config);
        far.rows(&mut finder, |_| true);
        assert_eq!(finder.finish(), Ok(()));
        let view = finder.as_mut_view();
        let free = (0..view.sectors()).filter(|&i| view.sector(i).state == SectorState::Free).count();
        (DriveRule::new(DriveConfig::default()).decide(&view, 300).decision, free)
    };
    let unseen = (Decision::Blind(BlindReason::Unseen), 0);
    assert_eq!(decided(&|v| v < 15.0), unseen, "the uppermost rows alone");
    assert_eq!(decided(&|v| v >= 60.0), unseen, "the lower half alone");
    assert_eq!(decided(&|v| v < 105.0), unseen, "all but the lowest rows");
    assert_eq!(decided(&|v| !(50.0..65.0).contains(&v)), unseen, "three rows of cells are a gap");
    let free = (Decision::Clear, 16);
    assert_eq!(decided(&|v| !(50.0..60.0).contains(&v)), free, "two are none");
    assert_eq!(decided(&|v| (10.0..110.0).contains(&v)), free, "nor are two at an edge");
}
