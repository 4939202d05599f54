//! OpenCV on the scenes that `stereo eval` matches.

use super::table::{Beside, Evaluated, Scenes};
use crate::failure::Failure;
use image::GrayImage;
use std::path::Path;
use stereopsis_host::eval::{Measures, OpenCv, OpenCvScene, Scene};
use tempfile::TempDir;

/// OpenCV, and the images that it is to match.
pub struct Rival {
    opencv: OpenCv,
    folder: TempDir,
    /// How many disparities are searched in each scene, and from which on.
    searches: Vec<[u16; 2]>,
}

impl Rival {
    /// The OpenCV of a Python.
    pub fn new(python: &Path) -> Result<Self, Failure> {
        let opencv = OpenCv::of(python).map_err(|e| {
            let advice =
                "install it (pip install numpy opencv-python-headless), or name a Python that has it";
            Failure::new(format!("--opencv {e}; {advice}"))
        })?;
        Ok(Self { opencv, folder: tempfile::tempdir()?, searches: Vec::new() })
    }

    /// Takes the next scene's images, as the matcher here gets them but for exposures.
    pub fn take(&mut self, pair: [&GrayImage; 2], search: [u16; 2]) -> Result<(), Failure> {
        for (image, side) in pair.into_iter().zip(["left", "right"]) {
            image.save(self.folder.path().join(format!("{}-{side}.pgm", self.searches.len())))?;
        }
        self.searches.push(search);
        Ok(())
    }

    /// Each of OpenCV's matchers on the scenes that were taken, in their order.
    pub fn evaluated(&self, scenes: &[Scene]) -> Result<Vec<Beside>, Failure> {
        let names: Vec<_> = (0..self.searches.len()).map(|place| place.to_string()).collect();
        let searched = names.iter().zip(&self.searches);
        let searched = searched.map(|(name, &search)| OpenCvScene { name, search });
        self.opencv.run(self.folder.path(), &searched.collect::<Vec<_>>())?;
        let evaluated = |matcher: &str, scene: &Scene, name: &str| {
            let (truth, found) = (scene.read_truth()?, OpenCv::answers(self.folder.path(), name, matcher)?);
            let measures = Measures::of(&found.values, &truth, None).unwrap_or_default();
            Ok(Evaluated { scene: scene.name.clone(), disparities: None, time_ms: None, measures })
        };
        let beside = |matcher: &str| {
            let of = scenes.iter().zip(&names).map(|(scene, name)| evaluated(matcher, scene, name));
            Ok(Beside {
                program: format!("OpenCV {} {matcher}", self.opencv.version),
                settings: OpenCv::PARAMETERS,
                scenes: Scenes::new(of.collect::<Result<_, Failure>>()?),
            })
        };
        OpenCv::MATCHERS.into_iter().map(beside).collect()
    }
}
