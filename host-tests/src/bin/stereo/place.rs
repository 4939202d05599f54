//! Where results of a name go, and pairs of them that appear together.

use crate::failure::Failure;
use image::codecs::png::PngEncoder;
use image::{EncodableLayout, ImageBuffer, ImageError, Pixel, PixelWithColorType, RgbImage};
use serde::Serialize;
use std::ffi::OsStr;
use std::io::{self, Write};
use std::ops::Deref;
use std::path::{Path, PathBuf};
use stereopsis_host::output::{Staging, check_place};

/// What writes a file.
pub type Content<'a> = Box<dyn FnOnce(&mut dyn Write) -> io::Result<()> + 'a>;

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
        // One folder has one spelling, so that two options that mean one file are seen to; a new one keeps
        // its own.
        let folder = folder.canonicalize().unwrap_or(folder);
        check_place(&folder.join(&name))?;
        Ok(Self { folder, name })
    }

    /// The place of YAML, refused where its name says that it is JSON or XML, in which OpenCV writes, too.
    pub fn of_yaml(option: &str, path: &Path) -> Result<Self, Failure> {
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        if ending == "json" || ending == "xml" {
            let path = path.display();
            return Err(Failure::new(format!("{option} {path}: the file is YAML; give it a name in .yml")));
        }
        Self::of(option, path)
    }

    /// The places of a result and of its picture, which is another file.
    pub fn with_picture(out: &Path, picture: Option<&Path>) -> Result<(Self, Option<Self>), Failure> {
        let place = Self::of("--out", out)?;
        let picture = picture.map(|path| Self::of("--picture", path)).transpose()?;
        if picture.as_ref().is_some_and(|picture| picture.is(&place)) {
            return Err(Failure::usage(format!(
                "--picture: {} is the file of --out; name another",
                out.display()
            )));
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
        let drawn = |drawn: RgbImage| Box::new(move |out: &mut dyn Write| png(out, &drawn)) as Content<'_>;
        self.write_all(result, picture.map(|(place, picture)| (place, drawn(picture))).into_iter().collect())
    }

    /// Writes the result and other files. All are complete and on the disk before any moves to its place.
    pub fn write_all(
        &self,
        result: impl FnOnce(&mut dyn Write) -> io::Result<()>,
        others: Vec<(&Self, Content<'_>)>,
    ) -> Result<(), Failure> {
        let mut staging = Staging::new(&self.folder)?;
        staging.write(&self.name, |out| result(out))?;
        let mut elsewhere: Vec<(&Path, Staging)> = Vec::new();
        for (place, content) in others {
            let to = if place.folder == self.folder {
                &mut staging
            } else if let Some(at) = elsewhere.iter().position(|(folder, _)| *folder == place.folder) {
                &mut elsewhere[at].1
            } else {
                elsewhere.push((&place.folder, Staging::new(&place.folder)?));
                let last = elsewhere.len() - 1;
                &mut elsewhere[last].1
            };
            to.write(&place.name, |out| content(out))?;
        }
        let elsewhere = elsewhere.into_iter().map(|(_, staging)| staging);
        Ok(Staging::commit_all(elsewhere.chain([staging]).collect())?)
    }
}

/// Writes one file, whole or not at all: `value` as JSON.
pub fn json_file(path: &Path, value: &impl Serialize) -> Result<(), Failure> {
    let no_file =
        || Failure::new(format!("--out {}: is not a file; name a file for the result", path.display()));
    let name = path.file_name().and_then(OsStr::to_str).filter(|_| !path.is_dir()).ok_or_else(no_file)?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut staging = Staging::new(folder)?;
    staging.write(name, |out| json(out, value))?;
    Ok(staging.commit(&[])?)
}

/// A picture as PNG.
pub fn png<P, C>(out: &mut dyn Write, picture: &ImageBuffer<P, C>) -> io::Result<()>
where
    P: Pixel + PixelWithColorType,
    [P::Subpixel]: EncodableLayout,
    C: Deref<Target = [P::Subpixel]>,
{
    picture.write_with_encoder(PngEncoder::new(out)).map_err(|error| match error {
        ImageError::IoError(e) => e,
        e => io::Error::other(e),
    })
}

/// A value as JSON.
pub fn json(out: &mut dyn Write, value: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, value)?;
    out.write_all(b"\n")
}
