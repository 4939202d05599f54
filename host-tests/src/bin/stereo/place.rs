//! Where results of a name go, and pairs of them that appear together.

use crate::failure::Failure;
use crate::files::png;
use image::RgbImage;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use stereopsis_host::output::Staging;

/// A result's folder and its name there.
pub struct Place {
    folder: PathBuf,
    name: String,
}

impl Place {
    /// Where the option wants its file; refused before any work where none can be made.
    pub fn of(option: &str, path: &Path) -> Result<Self, Failure> {
        let no_file = || Failure::new(format!("{option}: '{}' is not the name of a file", path.display()));
        let name = path.file_name().and_then(|name| name.to_str()).ok_or_else(no_file)?.to_owned();
        if path.is_dir() {
            return Err(no_file());
        }
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
            _ => PathBuf::from("."),
        };
        Staging::probe(&folder)?;
        // One folder has one spelling, so that two options that mean one file are seen to; a new one keeps its own.
        let folder = folder.canonicalize().unwrap_or(folder);
        Ok(Self { folder, name })
    }

    /// The places of a result and of its picture, which is another file.
    pub fn with_picture(out: &Path, picture: Option<&Path>) -> Result<(Self, Option<Self>), Failure> {
        let place = Self::of("--out", out)?;
        let picture = picture.map(|path| Self::of("--picture", path)).transpose()?;
        if picture.as_ref().is_some_and(|picture| picture.is(&place)) {
            return Err(Failure::new(format!("--picture: {} is the file of --out; name another", out.display())));
        }
        Ok((place, picture))
    }

    /// Whether both are one file.
    pub fn is(&self, other: &Self) -> bool {
        self.folder == other.folder && self.name == other.name
    }

    /// Writes the result and its picture.
    pub fn write(
        &self,
        result: impl FnOnce(&mut dyn Write) -> io::Result<()>,
        picture: Option<(&Self, RgbImage)>,
    ) -> Result<(), Failure> {
        self.write_both(result, picture.map(|(place, drawn)| (place, move |out: &mut dyn Write| png(out, &drawn))))
    }

    /// Writes the result and another file. Both are complete and on the disk before either moves to its place.
    pub fn write_both(
        &self,
        result: impl FnOnce(&mut dyn Write) -> io::Result<()>,
        second: Option<(&Self, impl FnOnce(&mut dyn Write) -> io::Result<()>)>,
    ) -> Result<(), Failure> {
        let mut staging = Staging::new(&self.folder)?;
        staging.write(&self.name, |out| result(out))?;
        let mut elsewhere = None;
        if let Some((place, content)) = second {
            let one_folder = place.folder == self.folder;
            let to = if one_folder { &mut staging } else { elsewhere.insert(Staging::new(&place.folder)?) };
            to.write(&place.name, |out| content(out))?;
        }
        if let Some(elsewhere) = elsewhere {
            elsewhere.commit(&[])?;
        }
        Ok(staging.commit(&[])?)
    }
}
