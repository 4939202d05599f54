//! Results of scenes in a folder: by the scenes' names, or numbered, as `stereo match` writes those of many
//! pairs.

use super::layout::entries;
use super::{EvalError, Scene};
use crate::limits;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// What a result is called in its scene's folder.
const OWN: [&str; 4] = ["disparity.pfm", "disp0.pfm", "disp0GT.pfm", "disparity.png"];
/// The folder of the results that KITTI's benchmark takes.
const KITTI: &str = "disp_0";
/// The confidence beside a result.
const CONFIDENCE: &str = "confidence.png";
/// What `stereo match` writes of a pair: its result, and what it was matched from.
const MATCHED: [&str; 2] = ["disparity.pfm", "summary.json"];

/// A folder of results.
pub struct Results {
    folder: PathBuf,
    numbered: Vec<Numbered>,
}

/// A result of `stereo match` in a folder that has a number for a name.
struct Numbered {
    folder: PathBuf,
    /// The left image as it was named, and where it is, if it is there.
    image: PathBuf,
    found: Option<PathBuf>,
}

impl Results {
    /// The results of a folder; those that are numbered say themselves what they are of.
    pub fn open(folder: &Path) -> Result<Self, EvalError> {
        if folder.is_file() {
            let what =
                "is a file; a folder of scenes has a folder of results, and a file has the truth's file";
            return Err(EvalError::new(folder, what));
        }
        let mut numbered = Vec::new();
        for path in entries(folder)? {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let is_number = name.len() >= 6 && name.bytes().all(|byte| byte.is_ascii_digit());
            if is_number && MATCHED.iter().all(|name| path.join(name).is_file()) {
                let image = left_image(&path.join(MATCHED[1]))?;
                numbered.push(Numbered { found: image.canonicalize().ok(), image, folder: path });
            }
        }
        Ok(Self { folder: folder.to_owned(), numbered })
    }

    /// A scene's result, and its confidence where there is one beside it.
    pub fn of(&self, scene: &Scene) -> Result<(PathBuf, Option<PathBuf>), EvalError> {
        let found = match self.numbered_of(scene)? {
            Some(found) => found,
            None => self.named(scene)?,
        };
        let sure = found.with_file_name(CONFIDENCE);
        // In a folder of all results it is that of none of them.
        let is_its_own = OWN.iter().any(|name| found.ends_with(name)) && sure.is_file();
        Ok((found, is_its_own.then_some(sure)))
    }

    /// The numbered result of a scene, of which there may be one: of its own left image, or of one that lies
    /// in a folder of its name, or has its name.
    fn numbered_of(&self, scene: &Scene) -> Result<Option<PathBuf>, EvalError> {
        let own = scene.images[0].canonicalize().ok();
        let is_own = |result: &Numbered| own.is_some() && result.found == own;
        let is_named = |Numbered { image, .. }: &Numbered| {
            let names = [image.file_stem(), image.parent().and_then(Path::file_name)];
            names.into_iter().flatten().any(|name| name == scene.name.as_str())
        };
        let folders = |is: &dyn Fn(&Numbered) -> bool| {
            let found = self.numbered.iter().filter(|result| is(result));
            found.map(|result| &result.folder).collect::<Vec<_>>()
        };
        let mut found = folders(&is_own);
        if found.is_empty() {
            found = folders(&is_named);
        }
        if let [one, other, ..] = found[..] {
            let [one, other] = [one, other].map(|path| path.display());
            let what = format!("holds two results for {}, {one} and {other}; give one of them", scene.name);
            return Err(EvalError::new(&self.folder, what));
        }
        Ok(found.first().map(|folder| folder.join(MATCHED[0])))
    }

    /// The result that lies where its scene's name says.
    fn named(&self, scene: &Scene) -> Result<PathBuf, EvalError> {
        let folder = &self.folder;
        let name = &scene.name;
        let own = if scene.is_folder { folder.clone() } else { folder.join(name) };
        let by_name = ["pfm", "png"].map(|end| folder.join(format!("{name}.{end}")));
        let of_kitti = folder.join(KITTI).join(format!("{name}.png"));
        let is_numbered = self.numbered.iter().any(|result| result.folder == own);
        let in_own = OWN.iter().filter(|_| !is_numbered).map(|file| own.join(file));
        let mut places = in_own.chain(by_name).chain([of_kitti]);
        // The truth itself is no result.
        places.find(|path| path.is_file() && *path != scene.truth).ok_or_else(|| {
            let of = match self.numbered.len() {
                0 => String::new(),
                count => format!(", and none of its {count} numbered results is of that scene's images"),
            };
            let what = format!(
                "holds no result for {name}; it is looked for as {name}/disparity.pfm, {name}/disp0.pfm, \
                 {name}.pfm, {name}.png and {KITTI}/{name}.png{of}"
            );
            EvalError::new(folder, what)
        })
    }
}

/// The left image of a run, which its summary names first.
fn left_image(summary: &Path) -> Result<PathBuf, EvalError> {
    let failed = |e: &dyn std::fmt::Display| EvalError::new(summary, format!("cannot be read ({e})"));
    let bytes = limits::read(summary, limits::CALIBRATION_BYTES).map_err(|e| failed(&e))?;
    let said: Value = serde_json::from_slice(&bytes).map_err(|e| failed(&e))?;
    let name = said["inputs"][0].as_str().ok_or_else(|| failed(&"it names no inputs"))?;
    Ok(name.into())
}
