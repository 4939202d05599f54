//! Matching beside its twin.

use crate::case;
use arbitrary::{Result, Unstructured};
use stereopsis::matching::{Block, Fast, Sgm, SgmEdge, SgmLean};
use stereopsis::pipeline::Pipeline;
use stereopsis_model::held::{Twin, compare};

/// The capacity of the pipelines.
const WIDTH: usize = 128;
const DISPARITIES: usize = 96;

/// Every kernel gives the twin's rows to the bit for whatever `start` accepts.
pub fn equals_its_twin(u: &mut Unstructured<'_>) -> Result<()> {
    match u.int_in_range(0..=4)? {
        0 => held::<Fast>(u),
        1 => held::<Block>(u),
        2 => held::<SgmLean>(u),
        3 => held::<Sgm>(u),
        _ => held::<SgmEdge>(u),
    }
}

fn held<S: Twin>(u: &mut Unstructured<'_>) -> Result<()> {
    // Now and then more than there is room for.
    let config = case::config(u, [WIDTH as u16 + 1, 18], DISPARITIES as u16 + 1)?;
    let pair = case::pair(u, config.width.into(), config.height.into())?;
    let mut pipeline = Box::new(Pipeline::<S, WIDTH, DISPARITIES>::new());
    if pipeline.start(&config).is_ok() {
        compare(&mut pipeline, &config, &pair).unwrap_or_else(|difference| panic!("{difference}"));
    }
    Ok(())
}
