//! All methods on a rendered scene of 320x240 with 64 disparities: `cargo bench -p stereopsis-host`.

use criterion::{BenchmarkId, Criterion, Throughput};
use std::process::ExitCode;
use stereopsis::camera::StereoSource;
use stereopsis::matching::{Block, Config, Fast, Method, Sgm, SgmEdge, SgmLean};
use stereopsis::pipeline::Pipeline;
use stereopsis_host::run::MemoryPair;
use stereopsis_host::scene::Scene;

const WIDTH: u16 = 320;
const HEIGHT: u16 = 240;
const DISPARITIES: u16 = 64;

type Sized<S> = Pipeline<S, { WIDTH as usize }, { DISPARITIES as usize }>;

/// One frame through a pipeline of just this size, as firmware holds it.
fn frame<S: Method>(pipeline: &mut Sized<S>, camera: &mut impl StereoSource) -> usize {
    let mut answers = 0;
    if pipeline.begin_frame(camera).is_ok() {
        while let Ok(Some(row)) = pipeline.next_row(camera) {
            answers += row.disparities().iter().filter(|d| d.is_some()).count();
        }
    }
    answers
}

fn method<S: Method>(criterion: &mut Criterion, camera: &mut MemoryPair) -> Result<(), String> {
    let mut pipeline = Box::new(Sized::<S>::new());
    pipeline.start(&Config::for_method::<Block>(WIDTH, HEIGHT, DISPARITIES)).map_err(|e| e.to_string())?;
    if frame(&mut pipeline, camera) == 0 {
        return Err(format!("{}: no answers: there is nothing to time", S::NAME));
    }
    let mut group = criterion.benchmark_group("matching");
    let evaluations = u64::from(WIDTH) * u64::from(HEIGHT) * u64::from(DISPARITIES);
    group.throughput(Throughput::Elements(evaluations));
    let name = BenchmarkId::new(S::NAME, pipeline.kernel().name());
    group.bench_function(name, |bencher| bencher.iter(|| frame(&mut pipeline, camera)));
    group.finish();
    Ok(())
}

fn main() -> ExitCode {
    let mut criterion = Criterion::default().configure_from_args();
    let (left, right) = Scene::small(WIDTH, HEIGHT).render();
    let Some(mut camera) = MemoryPair::new(WIDTH, left.into_raw(), right.into_raw()) else {
        return ExitCode::FAILURE;
    };
    let done = method::<Fast>(&mut criterion, &mut camera)
        .and_then(|()| method::<Block>(&mut criterion, &mut camera))
        .and_then(|()| method::<SgmLean>(&mut criterion, &mut camera))
        .and_then(|()| method::<Sgm>(&mut criterion, &mut camera))
        .and_then(|()| method::<SgmEdge>(&mut criterion, &mut camera));
    criterion.final_summary();
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
