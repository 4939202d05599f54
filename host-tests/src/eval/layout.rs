//! Folders of scenes, as the public benchmarks have them, told apart by what is in them.
//!
//! | layout | truth | mask | images |
//! | --- | --- | --- | --- |
//! | Middlebury 2014 | `SCENE/disp0.pfm` | `SCENE/mask0nocc.png` | `SCENE/im0.png`, `im1.png` |
//! | ETH3D | `SCENE/disp0GT.pfm` | `SCENE/mask0nocc.png` | the same |
//! | KITTI 2015 | `disp_occ_0/000000_10.png` | | `image_2/000000_10.png`, `image_3` |
//! | KITTI 2012 | `disp_occ/000000_10.png` | | `colored_0/000000_10.png`, `colored_1` |
//! | this repository's | `SCENE/gt.png`, `meta.json` | `SCENE/nonocc.png` | `SCENE/left.png`, `right.png` |
//! | `stereo demo`'s | `SCENE/true_disparity.pfm` | | the same |

use super::{DisparityFile, EvalError, Truth};
use crate::calibration::Calibration;
use crate::real;
use alphanumeric_sort::sort_path_slice;
use std::fs;
use std::path::{Path, PathBuf};
use stereopsis::matching::Config;

/// A scene with a truth.
#[derive(Clone, PartialEq, Debug)]
pub struct Scene {
    /// The scene's name: that of its folder, or of its images.
    pub name: String,
    /// The two images.
    pub images: [PathBuf; 2],
    /// The truth.
    pub truth: PathBuf,
    /// What is seen by both cameras, where a file says it.
    pub mask: Option<PathBuf>,
    /// The search that is recommended, where a file says it.
    pub disparities: Option<u16>,
    /// Columns on the left that are not scored.
    pub first_column: u16,
    /// Whether the scene is the folder that was named, not one in it.
    pub(super) is_folder: bool,
}

/// Where KITTI has the truth, and the images of the left and of the right camera.
const KITTI: [(&str, &[[&str; 2]]); 4] = [
    ("disp_occ_0", &[["image_2", "image_3"]]),
    ("disp_noc_0", &[["image_2", "image_3"]]),
    ("disp_occ", &[["colored_0", "colored_1"], ["image_0", "image_1"]]),
    ("disp_noc", &[["colored_0", "colored_1"], ["image_0", "image_1"]]),
];
/// The truth in a scene's folder, the images and the mask beside it.
const FOLDERS: [(&str, [&str; 2], &str); 4] = [
    ("disp0.pfm", ["im0.png", "im1.png"], "mask0nocc.png"),
    ("disp0GT.pfm", ["im0.png", "im1.png"], "mask0nocc.png"),
    ("gt.png", ["left.png", "right.png"], "nonocc.png"),
    ("true_disparity.pfm", ["left.png", "right.png"], "nonocc.png"),
];

impl Scene {
    /// The scenes in a folder, in the order of their names.
    pub fn all(folder: &Path) -> Result<Vec<Self>, EvalError> {
        let found = kitti(folder)?;
        if !found.is_empty() {
            return Ok(found);
        }
        if let Some(scene) = one(folder)? {
            return Ok(vec![Self { is_folder: true, ..scene }]);
        }
        let mut found = Vec::new();
        for path in entries(folder)? {
            found.extend(one(&path)?);
        }
        if found.is_empty() { Err(Self::none(folder)?) } else { Ok(found) }
    }

    /// Says that a folder holds no scenes, and which of its folders do.
    fn none(folder: &Path) -> Result<EvalError, EvalError> {
        let mut holding = Vec::new();
        for path in entries(folder)?.into_iter().filter(|path| path.is_dir()) {
            // What cannot be read holds none.
            let mut inside = entries(&path).unwrap_or_default().into_iter();
            if kitti(&path).is_ok_and(|found| !found.is_empty())
                || inside.any(|path| matches!(one(&path), Ok(Some(_))))
            {
                holding.extend(path.file_name().map(|name| name.to_string_lossy().into_owned()));
            }
        }
        let what = "a scene is a folder with disp0.pfm (Middlebury), disp0GT.pfm (ETH3D) or gt.png and \
                    meta.json, or a file in disp_occ_0 (KITTI)";
        let what = match holding.len() {
            0 => format!("holds no scene with a truth; {what}"),
            _ => format!("holds no scene with a truth, but in {}: name that folder", holding.join(", ")),
        };
        Ok(EvalError::new(folder, what))
    }

    /// What is known of it.
    pub fn read_truth(&self) -> Result<Truth, EvalError> {
        Truth::read(&self.truth, &DisparityFile::KITTI, self.mask.as_deref(), self.first_column)
    }
}

/// What is in a folder, in the order of the names.
pub(super) fn entries(folder: &Path) -> Result<Vec<PathBuf>, EvalError> {
    let failed = |e: std::io::Error| EvalError::new(folder, format!("cannot be read ({e})"));
    let entries = fs::read_dir(folder).map_err(failed)?;
    let mut paths = entries.map(|entry| Ok(entry.map_err(failed)?.path())).collect::<Result<Vec<_>, _>>()?;
    sort_path_slice(&mut paths);
    Ok(paths)
}

/// The scenes of KITTI.
fn kitti(folder: &Path) -> Result<Vec<Scene>, EvalError> {
    let Some((name, cameras)) = KITTI.iter().find(|(name, _)| folder.join(name).is_dir()) else {
        return Ok(Vec::new());
    };
    let cameras = cameras.iter().find(|pair| folder.join(pair[0]).is_dir()).unwrap_or(&cameras[0]);
    let files = entries(&folder.join(name))?;
    let scene = |truth: &PathBuf| {
        let file = truth.file_name()?;
        Some(Scene {
            name: truth.file_stem()?.to_str()?.to_owned(),
            images: cameras.map(|camera| folder.join(camera).join(file)),
            truth: truth.clone(),
            mask: None,
            disparities: None,
            first_column: 0,
            is_folder: false,
        })
    };
    let is_png = |path: &&PathBuf| path.extension().is_some_and(|end| end == "png");
    Ok(files.iter().filter(is_png).filter_map(scene).collect())
}

/// The scene in a folder, if it is one.
fn one(folder: &Path) -> Result<Option<Scene>, EvalError> {
    let Some((truth, images, mask)) = FOLDERS.iter().find(|(truth, ..)| folder.join(truth).is_file()) else {
        return Ok(None);
    };
    let is_own = *truth == "gt.png";
    let stated = if is_own {
        let meta = folder.join("meta.json");
        Some(real::disparities(&meta).map_err(|e| EvalError::new(folder, e.to_string()))?)
    } else {
        let calibration = Calibration::open(folder.join("calib.txt"), &folder.join(images[0])).ok();
        calibration.and_then(|calibration| calibration.disparities)
    };
    let [fewest, most] = [Config::FEWEST_DISPARITIES, Config::MOST_DISPARITIES];
    let mask = folder.join(mask);
    let named = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    Ok(Some(Scene {
        name: named.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        images: images.map(|image| folder.join(image)),
        truth: folder.join(truth),
        mask: mask.is_file().then_some(mask),
        disparities: stated.map(|n| n.clamp(fewest, most)),
        // Left of it the search does not fit the right image, as in `real`.
        first_column: if is_own { stated.unwrap_or(0) } else { 0 },
        is_folder: false,
    }))
}
