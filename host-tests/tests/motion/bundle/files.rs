//! Problems in BAL's format, through a file and the core.

use super::scene::{radial, scene};
use stereopsis::motion::bundle::{BundleConfig, Gauge, Loss, StopReason};
use stereopsis_host::bal::{BalFault, BalProblem, read_problem};

/// The problem of a scene that has been disturbed.
fn problem() -> BalProblem {
    let truth = scene((0..5).map(radial).collect(), 40, 1, 0.5, |view, point| (view + point) % 4 != 0);
    let start = truth.disturbed(0, 0.005, 0.02);
    let mut observations = start.observations;
    // In an order of the file's own.
    observations.sort_by_key(|observation| (observation.view, observation.point));
    BalProblem::new(start.views, start.points, &observations)
}

#[test]
fn files_come_back_and_costs_with_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("problem.txt");
    let write = |problem: &BalProblem| {
        let mut text = Vec::new();
        problem.write(&mut text).expect("to memory");
        std::fs::write(&path, &text).expect("a file");
        String::from_utf8(text).expect("text")
    };
    let text = write(&problem());
    let observations: Vec<&str> = text.lines().skip(1).take(150).collect();
    assert!(
        observations.is_sorted_by_key(|line| line.split(' ').next().map(str::to_owned)),
        "as it was given"
    );
    let read = read_problem(&path).expect("a problem");
    assert!((read.cost(&Loss::Squares) / problem().cost(&Loss::Squares) - 1.0).abs() < 1e-9);
    let mut running = read.start(&BundleConfig::new(Gauge::Free)).expect("memory");
    while running.iterate().is_continue() {}
    let report = running.report();
    // chi^2 / 2 of 300 numbers less 45 + 120 unknowns, and seven that are free, at a variance of 1/4: 17.8
    // with a deviation of 2.1.
    assert!((report.cost - 17.8).abs() < 4.0 * 2.1 && report.stop == StopReason::Cost, "{report:?}");
    assert!((running.problem().cost(&Loss::Squares) - report.cost).abs() < 1e-9 * report.cost);
    write(running.problem());
    let again = read_problem(&path).expect("a problem");
    assert!((again.cost(&Loss::Squares) - report.cost).abs() < 1e-9 * report.cost);
    assert!(running.bytes() > 150 * 32);
}

#[test]
fn a_point_in_the_plane_of_a_centre_is_named() {
    let mut problem = problem();
    let at =
        problem.observations.iter().position(|observation| observation.point == 7).expect("an observation");
    let centre = *problem.views[usize::from(problem.observations[at].view)].pose.translation();
    problem.points[7] = centre.into();
    let fault = problem.start(&BundleConfig::new(Gauge::Free)).err();
    assert!(matches!(fault, Some(BalFault::NotSeen(_))), "{fault:?}");
}
