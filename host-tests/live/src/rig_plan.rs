//! `stereo plan` of what the page's fields say.

use serde::{Deserialize, Serialize};
use stereopsis::matching::Config;
use stereopsis_rig::method::MethodName;
use stereopsis_rig::plan::{CORES, Plan, Rig, Wanted};

/// What the page asks for. Names are those of its fields.
#[derive(Debug, Deserialize)]
struct Asked {
    baseline_mm: f64,
    focal_px: f64,
    columns: u16,
    rows: u16,
    nearest_m: f64,
    farthest_m: f64,
    accuracy_percent: f64,
    frame_rate: Option<f64>,
    ram_kb: Option<f64>,
    clock_mhz: Option<f64>,
    /// Names; all of them where none is given.
    core: Option<String>,
    method: Option<String>,
}

/// What the page shows.
#[derive(Debug, Serialize)]
struct Answer {
    /// The lines of `stereo plan`.
    text: String,
    /// The search, for the page's sliders.
    disparities: u16,
    min_disparity: u16,
}

/// The plan of what is asked for, both as JSON. A line says what is wrong.
pub fn answer(asked: &[u8]) -> Result<String, String> {
    let asked: Asked = serde_json::from_slice(asked).map_err(|e| format!("the plan: {e}"))?;
    asked.check()?;
    let clock = |(core, mhz)| (core, asked.clock_mhz.unwrap_or(mhz));
    let cores = CORES.into_iter().filter(|(core, _)| asked.core.as_deref().is_none_or(|only| only == *core));
    let methods = MethodName::ALL.into_iter().map(MethodName::name);
    let methods = methods.filter(|method| asked.method.as_deref().is_none_or(|only| only == *method));
    let wanted = Wanted {
        nearest_m: asked.nearest_m,
        farthest_m: asked.farthest_m,
        accuracy: asked.accuracy_percent / 100.0,
        frames_per_s: asked.frame_rate,
        ram_bytes: asked.ram_kb.map(|kb| (kb * 1024.0) as usize),
        cores: cores.map(clock).collect(),
        methods: methods.collect(),
    };
    let rig = Rig {
        baseline_m: asked.baseline_mm / 1000.0,
        focal_px: asked.focal_px,
        offset_px: 0.0,
        width: asked.columns,
        height: asked.rows,
    };
    let plan = Plan::new(rig, wanted);
    let answer = Answer {
        text: plan.describe(),
        disparities: plan.search.disparities,
        min_disparity: plan.search.min_disparity,
    };
    serde_json::to_string(&answer).map_err(|e| e.to_string())
}

impl Asked {
    /// What `stereo plan` refuses.
    fn check(&self) -> Result<(), String> {
        let lengths = [
            ("baseline", Some(self.baseline_mm)),
            ("focal length", Some(self.focal_px)),
            ("nearest depth", Some(self.nearest_m)),
            ("farthest depth", Some(self.farthest_m)),
            ("frames a second", self.frame_rate),
            ("RAM", self.ram_kb),
            ("clock", self.clock_mhz),
        ];
        let is_length = |value: f64| (1e-6..=1e9).contains(&value);
        if let Some((name, _)) =
            lengths.iter().find(|(_, value)| value.is_some_and(|value| !is_length(value)))
        {
            return Err(format!("the plan's {name} must be a number greater than zero"));
        }
        if !(0.01..=100.0).contains(&self.accuracy_percent) {
            return Err("the plan's accuracy must be from 0.01 to 100 %".into());
        }
        let least = Config::FEWEST_DISPARITIES;
        let most = u16::try_from(crate::session::MOST_WIDTH).unwrap_or(u16::MAX);
        if !(least..=most).contains(&self.columns) || !(1..=most).contains(&self.rows) {
            return Err(format!(
                "the plan's images must have {least} to {most} columns and 1 to {most} rows"
            ));
        }
        if self.nearest_m >= self.farthest_m {
            return Err("the plan's nearest depth is not nearer than its farthest".into());
        }
        Ok(())
    }
}
