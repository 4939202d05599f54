//! The live page's plan beside `stereo plan`.

use super::page::{LivePage, hold};
use super::program::run_said;
use crate::steps::Outcome;
use serde_json::json;
use std::path::Path;

/// Fields that are moved from where they stand at first, and what the plan says then.
const PLANS: [(&[(&str, f64)], &str); 5] = [
    (&[], "limit        none"),
    (&[("plan-accuracy", 1.0), ("plan-core", 4.0), ("plan-method", 4.0)], "limit        the accuracy: "),
    (&[("plan-nearest", 0.05), ("plan-ram", 64.0), ("plan-clock", 96.0)], "limit        the search: "),
    (
        &[("plan-lens-kind", 1.0), ("plan-lens", 2.1), ("plan-sensor", 2.88), ("plan-rate", 60.0)],
        "images of 320 x 240 px",
    ),
    (
        &[("plan-lens-kind", 2.0), ("plan-lens", 72.5), ("plan-columns", 641.0), ("plan-rows", 400.0)],
        "images of 641 x 400 px: 72.5 x ",
    ),
];

/// What the plan says is what the program says to the command line that the page gives, to the letter; what
/// cannot be planned is named, and the search is taken over.
pub fn it_is_that_of_the_program(page: &mut LivePage, stereo: &Path) -> Outcome {
    for (fields, part) in PLANS {
        page.browser.value("PLAN.forEach((field) => setValue(field, field.start)); tellPlan()")?;
        for &(name, value) in fields {
            page.set_number(name, value)?;
        }
        let (said, command) = (page.text("plan-says")?, page.text("plan-command")?);
        let program = run_said(stereo, &command, Path::new("."))?;
        hold(said == program, || format!("{command}: the page says\n{said}\nand not\n{program}"))?;
        hold(said.contains(part), || format!("{command}: '{part}' is not said:\n{said}"))?;
        println!("as {command}");
    }
    page.browser.value("PLAN.forEach((field) => setValue(field, field.start)); tellPlan()")?;
    page.press("plan-take")?;
    let search =
        page.browser.value("['disparities', 'min_disparity'].map((name) => state.settings[at(name)])")?;
    hold(search == json!([64, 1]), || format!("the search is {search}"))?;
    for (name, value, line) in [
        ("plan-farthest", 0.1, "the plan's nearest depth is not nearer than its farthest"),
        ("plan-columns", 15.0, "the plan's images must have 16 to 4096 columns and 1 to 4096 rows"),
        ("plan-baseline", -1.0, "the plan's baseline must be a number greater than zero"),
    ] {
        page.set_number(name, value)?;
        let said = page.text("plan-fault")?;
        hold(said == line, || format!("'{said}' is said, not '{line}'"))?;
        page.browser.value("PLAN.forEach((field) => setValue(field, field.start)); tellPlan()")?;
    }
    let said = page.text("plan-fault")?;
    hold(said.is_empty(), || format!("after all: {said}"))?;
    page.set("min_disparity", 0)
}
