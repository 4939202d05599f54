//! Rows of a camera with faults beside those of a camera without.

use crate::case;
use arbitrary::{Result, Unstructured};
use stereopsis::matching::{Block, Config, Fast, Method, Row, Sgm};
use stereopsis::pipeline::{Guarded, Pipeline};
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::fault::{Fault, Faulty};
use stereopsis_model::scene::SceneCamera;

const WIDTH: usize = 32;
const DISPARITIES: usize = 16;

/// Disparities, flags and confidences of a row.
type Kept = (Vec<Disparity>, Vec<PixelFlags>, Vec<u8>);

fn kept(row: &Row<'_>) -> Kept {
    (row.disparities().to_vec(), row.flags().to_vec(), row.confidences().to_vec())
}

/// Whatever faults a camera has, a row that is not flagged as damaged is the clean frame's.
pub fn flags_what_a_fault_touches(u: &mut Unstructured<'_>) -> Result<()> {
    match u.int_in_range(0..=2)? {
        0 => held::<Fast>(u),
        1 => held::<Block>(u),
        _ => held::<Sgm>(u),
    }
}

fn held<S: Method>(u: &mut Unstructured<'_>) -> Result<()> {
    let config = case::config(u, [WIDTH as u16, 24], DISPARITIES as u16)?;
    let (left, right) = case::pair(u, config.width.into(), config.height.into())?;
    let camera = SceneCamera::new(left, right);
    let Some(clean) = clean::<S>(&config, camera.clone()) else { return Ok(()) };
    let mut faults = Vec::new();
    for fault in Fault::ALL {
        if u.arbitrary()? {
            faults.push(fault);
        }
    }
    let rate = f64::from(u.arbitrary::<u8>()?) / 256.0;
    let mut source = Faulty::new(camera, &faults, rate, u.arbitrary()?);
    let mut guarded = Box::new(Guarded::<S, WIDTH, DISPARITIES>::new());
    guarded.start(&config).expect("the pipeline took it");
    for _ in 0..u.int_in_range(1..=4)? {
        if guarded.begin_frame(&mut source).is_err() {
            continue;
        }
        let mut due = 0;
        while let Ok(Some(row)) = guarded.next_row(&mut source) {
            assert_eq!(usize::from(row.index()), due, "rows come in order");
            let is_damaged = row.flags().iter().any(|flags| flags.contains(PixelFlags::DAMAGED));
            assert!(is_damaged || kept(&row) == clean[due], "row {due}: {:?}", source.record());
            due += 1;
        }
        assert!(due <= clean.len(), "{due} rows");
    }
    Ok(())
}

/// The rows without a fault, where the configuration is one.
fn clean<S: Method>(config: &Config, mut camera: SceneCamera) -> Option<Vec<Kept>> {
    let mut pipeline = Box::new(Pipeline::<S, WIDTH, DISPARITIES>::new());
    pipeline.start(config).ok()?;
    pipeline.begin_frame(&mut camera).ok()?;
    let mut rows = Vec::new();
    while let Some(row) = pipeline.next_row(&mut camera).expect("no fault") {
        rows.push(kept(&row));
    }
    Some(rows)
}
