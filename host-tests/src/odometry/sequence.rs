//! The frames of a folder: `left` and `right`, in the order of their names.

use crate::focus::stack::{StackError, images, read};
use crate::mock::significant_bits;
use crate::partners::{alone, partners_of};
use image::GrayImage;
use std::io;
use std::path::{Path, PathBuf};

/// Folders that hold the pictures of a camera and of the one beside it.
const FOLDERS: [[&str; 2]; 3] = [["left", "right"], ["image_0", "image_1"], ["image_2", "image_3"]];

/// The files of a sequence.
#[derive(Clone, Debug)]
pub struct Sequence {
    left: Vec<PathBuf>,
    /// None of one camera.
    right: Vec<PathBuf>,
    size: (u32, u32),
    is_grey: bool,
    /// Significant bits of all frames with 16 bits a sample.
    bits: Option<u8>,
}

/// Why a folder is no sequence: one line that names the file and what would be right.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SequenceError {
    /// A folder cannot be read.
    #[error("{}: cannot be read ({source}); give a folder with the frames in left and right, or in left \
        alone", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// There is nothing to compare.
    #[error("{}: has {found} images; a sequence has two frames or more", path.display())]
    Count {
        /// The folder.
        path: PathBuf,
        /// How many images there are.
        found: usize,
    },
    /// A frame of one camera has no partner.
    #[error("{}: has no partner in {}; every left image needs a right one", path.display(), other.display())]
    Partner {
        /// The image.
        path: PathBuf,
        /// Where its partner should be.
        other: PathBuf,
    },
    /// The folders differ in the number of images.
    #[error("{}: has {left} images and {} has {right}; every left image needs a right \
        one", path.display(), other.display())]
    Counts {
        /// The left folder.
        path: PathBuf,
        /// Its images.
        left: usize,
        /// The right folder.
        other: PathBuf,
        /// Its images.
        right: usize,
    },
    /// An image cannot be read.
    #[error(transparent)]
    Image(#[from] StackError),
    /// An image differs in size.
    #[error("{}: is {} x {} and {} is {} x {}; all frames must have one \
        size", path.display(), size.0, size.1, first.display(), first_size.0, first_size.1)]
    Size {
        /// The image.
        path: PathBuf,
        /// Its columns and rows.
        size: (u32, u32),
        /// The first one.
        first: PathBuf,
        /// Its columns and rows.
        first_size: (u32, u32),
    },
}

impl Sequence {
    /// The sequence in a folder: `left` and `right`, or `left` alone for one camera; also KITTI's `image_0`
    /// and `image_1`, `image_2` and `image_3`, or one camera's images in the folder itself. Read are
    /// the first frame and all those with 16 bits a sample, of which one number of bits is significant.
    pub fn open(folder: &Path) -> Result<Self, SequenceError> {
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |source| SequenceError::Folder { path, source }
        };
        std::fs::read_dir(folder).map_err(failed(folder))?;
        let named = FOLDERS.iter().map(|names| names.map(|name| folder.join(name)));
        let both = named.clone().find(|[left, _]| left.is_dir());
        let ([left_folder, right_folder], beside) = match both {
            Some(both) => (both, true),
            None => ([folder.to_owned(), folder.join("right")], false),
        };
        let left = images(&left_folder).map_err(failed(&left_folder))?;
        let has_right = right_folder.is_dir();
        if !beside && (has_right || left.is_empty()) {
            // There is a right camera without a left one, or nothing at all.
            let source = io::Error::from(io::ErrorKind::NotFound);
            return Err(SequenceError::Folder { path: folder.join("left"), source });
        }
        let mut right =
            if has_right { images(&right_folder).map_err(failed(&right_folder))? } else { Vec::new() };
        if left.len() < 2 {
            return Err(SequenceError::Count { path: left_folder, found: left.len() });
        }
        if has_right {
            partners(&left, &right, &left_folder, &right_folder)?;
            right = partners_of(&left, right);
        }
        let first = read(&left[0], None)?;
        let is_grey = first.colours.pixels().all(|p| p.0[0] == p.0[1] && p.0[1] == p.0[2]);
        let bits = significant_bits(left.iter().chain(&right));
        Ok(Self { left, right, size: first.grey.dimensions(), is_grey, bits })
    }

    /// How many frames there are, two at least.
    pub fn len(&self) -> usize {
        self.left.len()
    }

    /// Whether there is none, which is never so.
    pub fn is_empty(&self) -> bool {
        self.left.is_empty()
    }

    /// Whether there is a right camera.
    pub fn is_stereo(&self) -> bool {
        !self.right.is_empty()
    }

    /// Columns and rows of all frames.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Whether the first picture has no colours.
    pub fn is_grey(&self) -> bool {
        self.is_grey
    }

    /// The left file of a frame, counted from 0.
    pub fn file(&self, index: usize) -> &Path {
        &self.left[index]
    }

    /// Reads a frame, counted from 0: the left picture and, of two cameras, the right one.
    ///
    /// # Panics
    ///
    /// When there is no such frame.
    pub fn frame(&self, index: usize) -> Result<(GrayImage, Option<GrayImage>), SequenceError> {
        let picture = |path: &PathBuf| -> Result<GrayImage, SequenceError> {
            let grey = read(path, self.bits)?.grey;
            if grey.dimensions() != self.size {
                let (size, first) = (grey.dimensions(), self.left[0].clone());
                return Err(SequenceError::Size { path: path.clone(), size, first, first_size: self.size });
            }
            Ok(grey)
        };
        let right = self.right.get(index).map(picture).transpose()?;
        Ok((picture(&self.left[index])?, right))
    }
}

/// The names of a folder's images that are a number and nothing else; none where there is no folder.
pub fn numbered(folder: &Path) -> Vec<String> {
    let names = images(folder).unwrap_or_default().into_iter();
    let names = names.filter_map(|path| path.file_name()?.to_str().map(str::to_owned));
    names
        .filter(|name| name.strip_suffix(".png").is_some_and(|stem| stem.bytes().all(|b| b.is_ascii_digit())))
        .collect()
}

/// Whether both cameras have the same frames, by their names; or, where names do not say so, as many.
fn partners(left: &[PathBuf], right: &[PathBuf], folder: &Path, other: &Path) -> Result<(), SequenceError> {
    if let Some((path, is_left)) = alone(left, right) {
        let (path, other) = (path.to_owned(), if is_left { other } else { folder }.to_owned());
        return Err(SequenceError::Partner { path, other });
    }
    if left.len() != right.len() {
        let (path, other) = (folder.to_owned(), other.to_owned());
        return Err(SequenceError::Counts { path, left: left.len(), other, right: right.len() });
    }
    Ok(())
}
