//! What `stereo eval` prints: scenes and their mean, ours and those of other programs, in one table.

use crate::failure::Failure;
use serde::Serialize;
use std::fmt::Write;
use stereopsis_host::command_line::one_line;
use stereopsis_host::eval::Measures;

/// How right a scene is. Names are those of `--json`.
#[derive(Serialize)]
pub struct Evaluated {
    pub scene: String,
    /// What was searched, and how long the matching took, where it was done here.
    pub disparities: Option<u16>,
    pub time_ms: Option<f64>,
    #[serde(flatten)]
    pub measures: Measures,
}

/// How right many scenes are.
#[derive(Serialize)]
pub struct Scenes {
    scenes: Vec<Evaluated>,
    mean: Measures,
}

impl Scenes {
    /// With their mean.
    pub fn new(scenes: Vec<Evaluated>) -> Self {
        let measures: Vec<_> = scenes.iter().map(|scene| scene.measures).collect();
        Self { mean: Measures::mean(&measures), scenes }
    }
}

/// How right another program is.
#[derive(Serialize)]
pub struct Beside {
    /// The program, and the settings that it has.
    pub program: String,
    pub settings: &'static str,
    #[serde(flatten)]
    pub scenes: Scenes,
}

/// What is printed.
#[derive(Serialize)]
pub struct Evaluation {
    #[serde(flatten)]
    pub own: Scenes,
    /// How the images were made worse, where they were.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub altered: Option<String>,
    /// Other programs on the same scenes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub beside: Vec<Beside>,
}

/// The columns of a table: names, digits behind the point, and values; shares are in percent.
type Column = (&'static str, usize, fn(&Measures) -> Option<f64>);

const COLUMNS: [Column; 11] = [
    ("density", 2, |m| Some(100.0 * m.score.density)),
    ("bad0.5", 2, |m| Some(100.0 * m.bad05)),
    ("bad1", 2, |m| Some(100.0 * m.bad1)),
    ("bad2", 2, |m| Some(100.0 * m.score.bad2)),
    ("bad4", 2, |m| Some(100.0 * m.bad4)),
    ("D1", 2, |m| Some(100.0 * m.d1)),
    ("missed", 2, |m| Some(100.0 * m.score.missed)),
    ("EPE,px", 3, |m| Some(m.epe_px)),
    ("unsure", 2, |m| m.confidence_from_oracle.map(|share| 100.0 * share)),
    ("occluded", 2, |m| m.occluded.map(|score| 100.0 * score.density)),
    ("occ-bad2", 2, |m| m.occluded.map(|score| 100.0 * score.bad2)),
];

impl Evaluation {
    /// The scenes and their mean by name, each with the cells of all columns; then those of other programs.
    fn rows(&self) -> impl Iterator<Item = (String, Vec<String>)> {
        let others = self.beside.iter().map(|beside| (format!("{}: ", beside.program), &beside.scenes));
        [(String::new(), &self.own)].into_iter().chain(others).flat_map(|(program, of)| {
            let scenes = of.scenes.iter().map(|scene| (scene.scene.as_str(), &scene.measures));
            scenes.chain([("mean", &of.mean)]).map(move |(name, measures)| {
                let cell = |&(_, digits, of): &Column| of(measures).map(|value| format!("{value:.digits$}"));
                let cells = COLUMNS.iter().map(|column| cell(column).unwrap_or_default());
                (format!("{program}{name}"), cells.collect())
            })
        })
    }

    /// For people.
    pub fn table(&self) -> String {
        let longest = self.rows().map(|(name, _)| one_line(&name).chars().count()).max().unwrap_or(0).max(5);
        let mut text = format!("{:<longest$}", "scene");
        for (name, ..) in COLUMNS {
            let _ = write!(text, "{name:>9}");
        }
        for (name, cells) in self.rows() {
            let _ = write!(text, "\n{:<longest$}", one_line(&name));
            for cell in cells {
                let _ = write!(text, "{cell:>9}");
            }
        }
        text += "\nin percent: bad and D1 of the answers, missed of the scored pixels (no answer, or over 2 \
                 px off), unsure of the\nway from the best order of the answers to a random one; occluded: \
                 pixels that only the left camera\nsees and that have an answer, occ-bad2 of these answers\n";
        if let Some(altered) = &self.altered {
            let _ = writeln!(text, "images altered: {altered}");
        }
        if let Some(beside) = self.beside.first() {
            let _ = writeln!(text, "{}", beside.settings.replace("; ", ";\n"));
        }
        text
    }

    /// For programs.
    pub fn csv(&self) -> Result<Vec<u8>, Failure> {
        let mut table = csv::Writer::from_writer(Vec::new());
        table.write_record(["scene"].into_iter().chain(COLUMNS.map(|(name, ..)| name)))?;
        for (name, cells) in self.rows() {
            table.write_record([name].into_iter().chain(cells))?;
        }
        table.into_inner().map_err(|e| Failure::new(e.to_string()))
    }
}
