//! Tests that are chosen by parts of their names: one that no test has would pass by running nothing.

use crate::steps::{Failure, Outcome, output_of, run as run_command};
use std::process::{Command, Stdio};

/// Runs tests by a command of cargo that ends with words for the tests themselves, once each of these parts
/// of names, which are put behind it, is that of a test.
pub fn run(tests: impl Fn() -> Command, names: &[&str]) -> Outcome {
    let mut list = tests();
    list.args(names).arg("--list").stderr(Stdio::inherit());
    held(&output_of(&mut list)?, names)?;
    run_command(tests().args(names))
}

/// Fails at the first of the names that no test of a list has.
fn held(list: &str, names: &[&str]) -> Outcome {
    let tests: Vec<_> = list.lines().filter_map(|line| line.strip_suffix(": test")).collect();
    match names.iter().find(|name| !tests.iter().any(|test| test.contains(*name))) {
        Some(name) => Err(Failure::new(format!("no test has \"{name}\" in its name"))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::held;

    #[test]
    fn a_name_without_a_test_is_named() {
        let list = "camera::queue::tests::wraps: test\nbenches::queue: benchmark\n\n1 test, 1 benchmark\n";
        assert!(held(list, &["camera::queue", "wraps"]).is_ok());
        assert!(held(list, &[]).is_ok());
        for name in ["benches", "1 test", "camera::wraps"] {
            let failure = held(list, &["wraps", name]).expect_err("no such test");
            assert_eq!(failure.to_string(), format!("no test has \"{name}\" in its name"));
        }
    }
}
