//! Where the images of `match` come from: two files, a picture of both cameras, many of them, or raw frames.

use crate::failure::Failure;
use crate::image_files::{self, is_pattern};
use crate::input::Pair;
use clap::Args;
use image::{DynamicImage, GrayImage};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use stereopsis_host::limits::{self, IMAGE_SIDE};
use stereopsis_host::mock::MockCamera;

#[derive(Clone, Debug, Args)]
pub struct SourceArgs {
    /// The left image; of many pairs a pattern in quotes, as 'left*.png', or a folder
    #[arg(long, value_name = "FILE", required_unless_present = "side_by_side")]
    left: Option<PathBuf>,
    /// The right image, or those
    #[arg(long, value_name = "FILE", required_unless_present = "side_by_side")]
    right: Option<PathBuf>,
    /// In place of --left and --right: a picture with the left camera's image in its left half and the right
    /// one's in its right half, a pattern in quotes, or a folder; with --raw a file of frames, or - for
    /// standard input
    #[arg(long, value_name = "FILE", conflicts_with_all = ["left", "right"])]
    side_by_side: Option<PathBuf>,
    /// Columns and rows, of both halves together, of raw frames of 8-bit grey pixels, one after another, as
    /// ffmpeg writes them with -f rawvideo -pix_fmt gray
    #[arg(long, value_name = "COLUMNSxROWS", requires = "side_by_side", value_parser = raw_size,
        conflicts_with_all = ["left", "right"])]
    raw: Option<[u32; 2]>,
}

/// Columns of the narrowest raw frame.
const LEAST_COLUMNS: u32 = 32;

fn raw_size(text: &str) -> Result<[u32; 2], String> {
    let most = u32::from(IMAGE_SIDE);
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    let fits = |[w, h]: &[u32; 2]| {
        (LEAST_COLUMNS..=most).contains(w) && w.is_multiple_of(2) && (1..=most).contains(h)
    };
    sides.filter(fits).ok_or_else(|| {
        format!(
            "columns and rows are needed, as 1280x480: an even number of columns from {LEAST_COLUMNS} to \
             {most}, and at most {most} rows"
        )
    })
}

/// What is matched.
pub enum Sources {
    /// One pair.
    One(Input),
    /// Several, in their order.
    Many(Vec<Input>),
    /// Raw frames, as long as there are some.
    Raw(RawFrames),
}

/// A pair that can be opened.
#[derive(Clone, Debug)]
pub enum Input {
    /// Two images.
    Files([PathBuf; 2]),
    /// Both in one picture.
    SideBySide(PathBuf),
    /// A raw frame, and where it came from.
    Raw { frame: GrayImage, path: PathBuf },
}

impl SourceArgs {
    /// What is matched; `notes` is told what is left out.
    pub fn open(&self, notes: &mut Vec<String>) -> Result<Sources, Failure> {
        let both = (&self.left, &self.right, &self.side_by_side);
        let (left, right) = match both {
            (_, _, Some(path)) => return self.side_by_side(path),
            (Some(left), Some(right), None) => (left, right),
            _ => return Err(Failure::usage("--left, --right: are missing; give both, or --side-by-side")),
        };
        let are_folders = left.is_dir() && right.is_dir();
        if !are_folders && !is_pattern(left) && !is_pattern(right) {
            return Ok(Sources::One(Input::Files([left.clone(), right.clone()])));
        }
        let [left, right] = [left, right].map(|path| [path.to_string_lossy().into_owned()]);
        let pairs = image_files::pairs(&left, &right, notes)?;
        Ok(Sources::Many(pairs.into_iter().map(Input::Files).collect()))
    }

    fn side_by_side(&self, path: &Path) -> Result<Sources, Failure> {
        let is_standard_input = path.as_os_str() == "-";
        if let Some(size) = self.raw {
            let failed = |e: io::Error| Failure::new(format!("{}: cannot be read ({e})", path.display()));
            let from: Box<dyn Read> = if is_standard_input {
                Box::new(io::stdin())
            } else {
                Box::new(File::open(path).map_err(failed)?)
            };
            let path = if is_standard_input { "standard input".into() } else { path.to_owned() };
            return Ok(Sources::Raw(RawFrames { from, size, path, frames: 0 }));
        }
        if is_standard_input {
            return Err(Failure::usage("--side-by-side -: --raw is missing; give the size of its frames"));
        }
        if !path.is_dir() && !is_pattern(path) {
            return Ok(Sources::One(Input::SideBySide(path.to_owned())));
        }
        let files = image_files::files("--side-by-side", &[path.to_string_lossy().into_owned()])?;
        Ok(Sources::Many(files.into_iter().map(Input::SideBySide).collect()))
    }
}

impl Input {
    /// The pair.
    pub fn open(&self) -> Result<Pair, Failure> {
        let (camera, path) = match self {
            Self::Files([left, right]) => return Pair::open(left, right),
            Self::SideBySide(path) => (MockCamera::open(path)?, path),
            Self::Raw { frame, path } => {
                let camera = MockCamera::from_image(DynamicImage::ImageLuma8(frame.clone()));
                (camera.ok_or_else(|| Failure::new(format!("{}: is no frame", path.display())))?, path)
            }
        };
        let halves = camera.halves();
        let (left, right) = halves.ok_or_else(|| {
            Failure::new(format!(
                "{}: has an odd number of columns; two images side by side have an even one",
                path.display()
            ))
        })?;
        Pair::new([left, right], [path, path], vec![path.clone()])
    }

    /// The bytes that it is made of: of files their content.
    pub fn bytes(&self) -> Result<Vec<u8>, Failure> {
        let read = |path: &PathBuf| {
            limits::read(path, limits::IMAGE_BYTES)
                .map_err(|e| Failure::new(format!("{}: cannot be read ({e})", path.display())))
        };
        match self {
            Self::Files([left, right]) => Ok([read(left)?, read(right)?].concat()),
            Self::SideBySide(path) => read(path),
            Self::Raw { frame, .. } => Ok(frame.to_vec()),
        }
    }

    /// The names of its files.
    pub fn name(&self) -> String {
        let name = |path: &Path| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        match self {
            Self::Files([left, right]) => format!("{} {}", name(left), name(right)),
            Self::SideBySide(path) | Self::Raw { path, .. } => name(path),
        }
    }
}

/// Raw frames, one after another.
pub struct RawFrames {
    from: Box<dyn Read>,
    size: [u32; 2],
    path: PathBuf,
    frames: usize,
}

impl RawFrames {
    /// The next frame; `None` after the last one.
    fn read(&mut self) -> Result<Option<Input>, Failure> {
        let [width, height] = self.size;
        let wanted = width as usize * height as usize;
        let mut bytes = Vec::with_capacity(wanted);
        let path = self.path.display();
        let read = (&mut self.from).take(wanted as u64).read_to_end(&mut bytes);
        read.map_err(|e| Failure::new(format!("{path}: cannot be read ({e})")))?;
        self.frames += 1;
        match bytes.len() {
            0 if self.frames == 1 => Err(Failure::new(format!(
                "{path}: holds no frame; {wanted} bytes are needed for each of {width} x {height} grey pixels"
            ))),
            0 => Ok(None),
            found if found < wanted => Err(Failure::new(format!(
                "{path}: ends after {found} of {wanted} bytes of frame {}; is --raw {width}x{height} the \
                 size of its frames, and are they 8-bit grey?",
                self.frames
            ))),
            _ => {
                let path = PathBuf::from(format!("{path}, frame {}", self.frames));
                Ok(GrayImage::from_raw(width, height, bytes).map(|frame| Input::Raw { frame, path }))
            }
        }
    }
}

impl Iterator for RawFrames {
    type Item = Result<Input, Failure>;

    fn next(&mut self) -> Option<Self::Item> {
        self.read().transpose()
    }
}
