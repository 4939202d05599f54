//! One pair through the pipeline, its exposures balanced and its noise measured first where that is asked
//! for.

use crate::failure::Failure;
use crate::input;
use crate::progress::Progress;
use crate::shared::{BalanceArgs, MethodArgs};
use std::fmt::Display;
use stereopsis::camera::StereoSource;
use stereopsis::imaging::{Balance, BalancedPair, NoiseMeter};
use stereopsis::matching::Config;
use stereopsis_host::run::{self, Outcome, measure_noise};

/// What came of the matching.
pub struct Matched {
    pub config: Config,
    pub meter: Option<NoiseMeter>,
    pub balance: Balance,
    pub outcome: Outcome,
}

/// Matches a pair with a search.
pub fn matched<C: StereoSource<Error: Display>>(
    method: &MethodArgs,
    balance: &BalanceArgs,
    config: Config,
    source: &mut C,
) -> Result<Matched, Failure> {
    if !balance.is_for(method.method) {
        return as_it_comes(method, config, source);
    }
    let mut balanced = BalancedPair::new(source);
    // The first frame shows the exposures.
    measure_noise(&mut balanced).map_err(|e| Failure::new(e.to_string()))?;
    let matched = as_it_comes(method, config, &mut balanced)?;
    Ok(Matched { balance: balanced.balance(), ..matched })
}

fn as_it_comes<C: StereoSource<Error: Display>>(
    method: &MethodArgs,
    config: Config,
    source: &mut C,
) -> Result<Matched, Failure> {
    let (config, meter) = input::with_noise(method, config, source)?;
    let progress = Progress::over(&config);
    let outcome = run::run(method.run_options(), &config, source, |rows| progress.rows(rows));
    let outcome = outcome.map_err(|e| Failure::new(e.to_string()))?;
    Ok(Matched { config, meter, balance: Balance::NONE, outcome })
}
