//! Result files that appear together or not at all.
//!
//! Files are written into a hidden folder inside the target and renamed when the last one is complete and on
//! the disk. Whatever fails before that leaves the target as it was: files of an earlier run stay, folders
//! made for this run go.
//!
//! A result takes the place of a regular file or of none: [`check_place`].

mod error;
mod moves;

pub use error::OutputError;

use crate::unfinished::{Unfinished, as_a_whole};
use moves::Moves;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use tempfile::TempDir;

/// The files that a run reads, wherever links lead: no result takes the place of one.
static INPUTS: OnceLock<Vec<PathBuf>> = OnceLock::new();

/// Says which files the program reads, once: [`check_place`] refuses their places for results.
pub fn protect(inputs: impl IntoIterator<Item = PathBuf>) {
    let both = |path: PathBuf| [in_folder(&path), path.canonicalize().ok()];
    // A second list would be of the same command line.
    let _ = INPUTS.set(inputs.into_iter().flat_map(both).flatten().collect());
}

/// A place by the one name of its folder.
fn in_folder(path: &Path) -> Option<PathBuf> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(folder.canonicalize().ok()?.join(path.file_name()?))
}

/// Whether a result can take a place: of a regular file that is no input of the run, or of none. A symbolic
/// link to a file, or to nothing, is replaced; what it points to stays. Folders are refused where they are
/// met, and so are the names of the system, as `/dev/stdout`, whatever stands behind them.
pub fn check_place(place: &Path) -> Result<(), OutputError> {
    if INPUTS.get().is_some_and(|inputs| in_folder(place).is_some_and(|place| inputs.contains(&place))) {
        return Err(OutputError::Input { path: place.into() });
    }
    let names = [in_folder(place), fs::read_link(place).ok()];
    if names.iter().flatten().any(|name| is_of_the_system(name)) {
        return Err(OutputError::NotAFile { path: place.into() });
    }
    let is_link = fs::symlink_metadata(place).is_ok_and(|found| found.is_symlink());
    match fs::metadata(place) {
        Ok(found) if !found.is_file() && (is_link || !found.is_dir()) => {
            Err(OutputError::NotAFile { path: place.into() })
        }
        _ => Ok(()),
    }
}

/// Whether a name is one of a device or of an open file.
fn is_of_the_system(name: &Path) -> bool {
    name.starts_with("/proc") || name.parent() == Some(Path::new("/dev"))
}

/// What the name of the folder of unfinished files begins with.
const UNFINISHED: &str = ".stereo-unfinished-";
/// The file in it that is locked while its run lasts.
const LOCK: &str = "lock";
/// Its name before it is locked: no other run takes the folder for abandoned by then.
const OPEN_LOCK: &str = "lock.new";
/// How many files the disk is asked for at a time.
const SYNCING: usize = 16;

/// Removes what interrupted runs left in a folder. What cannot be removed stays: it is in nobody's way.
fn remove_abandoned(target: &Path) {
    for entry in fs::read_dir(target).into_iter().flatten().flatten() {
        let is_unfinished = entry.file_name().to_string_lossy().starts_with(UNFINISHED);
        if is_unfinished && is_abandoned(&entry.path().join(LOCK)) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

/// Whether nobody holds a lock that was made.
fn is_abandoned(lock: &Path) -> bool {
    File::options().write(true).open(lock).is_ok_and(|lock| lock.try_lock().is_ok())
}

/// Results on their way into a folder. Dropped without [`Staging::commit`], it leaves nothing behind.
#[derive(Debug)]
pub struct Staging {
    // In order of dropping: the files first, then the folders made for them.
    files: TempDir,
    /// Locked as long as this run writes its files.
    _lock: File,
    target: PathBuf,
    names: Vec<String>,
    made: MadeFolders,
    _unfinished: Unfinished,
}

impl Staging {
    /// Makes the target folder, with its parents, where it is missing, and checks that files can be made in
    /// it.
    pub fn new(target: &Path) -> Result<Self, OutputError> {
        let make = || {
            let made = MadeFolders::up_to(target)?;
            remove_abandoned(target);
            let failed = |source| OutputError::Folder { path: target.into(), source };
            let files = tempfile::Builder::new().prefix(UNFINISHED).tempdir_in(target);
            let files = files.map_err(|e| failed(plain(e)))?;
            let open = files.path().join(OPEN_LOCK);
            let lock = File::create(&open).map_err(failed)?;
            lock.lock().map_err(failed)?;
            fs::rename(open, files.path().join(LOCK)).map_err(failed)?;
            Ok((files, lock, made))
        };
        let ((files, lock, made), unfinished) =
            Unfinished::begin(make, |(files, _, made)| (files.path().into(), made.outermost_first.clone()))?;
        let (target, names) = (target.into(), Vec::new());
        Ok(Self { files, _lock: lock, target, names, made, _unfinished: unfinished })
    }

    /// Whether results could be written into `target`; leaves nothing behind. For asking before long work.
    pub fn probe(target: &Path) -> Result<(), OutputError> {
        Self::new(target).map(drop)
    }

    /// Writes one file. `content` is given a buffered writer.
    pub fn write(
        &mut self,
        name: &str,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        check_place(&self.target.join(name))?;
        let failed = |source| OutputError::File { path: self.target.join(name), source };
        let mut out = BufWriter::new(File::create(self.files.path().join(name)).map_err(failed)?);
        content(&mut out).map_err(failed)?;
        out.into_inner().map_err(|e| failed(e.into_error()))?;
        self.names.push(name.to_owned());
        Ok(())
    }

    /// The files that are written, with their lengths in bytes.
    pub fn lengths(&self) -> Result<BTreeMap<String, u64>, OutputError> {
        let one = |name: &String| {
            let failed = |source| OutputError::File { path: self.target.join(name), source };
            Ok((name.clone(), fs::metadata(self.files.path().join(name)).map_err(failed)?.len()))
        };
        self.names.iter().map(one).collect()
    }

    /// Waits until the disk has all files, several at a time.
    fn sync(&self) -> Result<(), OutputError> {
        let one = |name: &String| {
            // A disk that fills up may say so as late as here.
            let synced = File::open(self.files.path().join(name)).and_then(|file| file.sync_all());
            synced.map_err(|source| OutputError::File { path: self.target.join(name), source })
        };
        let share = self.names.len().div_ceil(SYNCING).max(1);
        std::thread::scope(|scope| {
            let shares =
                self.names.chunks(share).map(|names| scope.spawn(move || names.iter().try_for_each(one)));
            let running: Vec<_> = shares.collect();
            let panicked = || {
                let source = io::Error::other("it is not known whether its files are on the disk");
                Err(OutputError::Folder { path: self.target.clone(), source })
            };
            running.into_iter().try_for_each(|share| share.join().unwrap_or_else(|_| panicked()))
        })
    }

    /// Moves all files to their places, once they are on the disk. `stale` are names that an earlier run may
    /// have written and this one did not: they go, so that the folder holds one run's results.
    pub fn commit(self, stale: &[&str]) -> Result<(), OutputError> {
        self.sync()?;
        as_a_whole(|| self.put_all(stale).map(Moves::keep))?;
        self.made.keep();
        Ok(())
    }

    /// Moves the files of several folders to their places, once all are on the disk: of all folders, or of
    /// none.
    pub fn commit_all(all: Vec<Self>) -> Result<(), OutputError> {
        all.iter().try_for_each(Self::sync)?;
        as_a_whole(|| {
            let moved: Vec<Moves> = all.iter().map(|one| one.put_all(&[])).collect::<Result<_, _>>()?;
            moved.into_iter().for_each(Moves::keep);
            Ok(())
        })?;
        all.into_iter().for_each(|one| one.made.keep());
        Ok(())
    }

    /// Moves all files to their places, or none; they go back when the moves are dropped.
    fn put_all(&self, stale: &[&str]) -> Result<Moves, OutputError> {
        let mut moves = Moves::default();
        let old = self.files.path().join("old");
        fs::create_dir(&old).map_err(|source| OutputError::Folder { path: self.target.clone(), source })?;
        let gone = stale.iter().copied().filter(|name| !self.names.iter().any(|n| n == name));
        for name in self.names.iter().map(String::as_str).chain(gone) {
            let place = self.target.join(name);
            let failed = |source| OutputError::File { path: place.clone(), source };
            check_place(&place)?;
            match fs::symlink_metadata(&place) {
                Ok(found) if found.is_dir() => {
                    return Err(failed(io::Error::from(io::ErrorKind::IsADirectory)));
                }
                Ok(_) => moves.rename(&place, &old.join(name)).map_err(failed)?,
                Err(_) => {}
            }
            if self.names.iter().any(|n| n == name) {
                moves.rename(&self.files.path().join(name), &place).map_err(failed)?;
            }
        }
        Ok(moves)
    }
}

/// Folders that were made for the results, removed when dropped as long as they are empty.
#[derive(Debug)]
struct MadeFolders {
    outermost_first: Vec<PathBuf>,
}

impl MadeFolders {
    fn up_to(target: &Path) -> Result<Self, OutputError> {
        let mut made = Self { outermost_first: Vec::new() };
        let missing: Vec<&Path> = target
            .ancestors()
            .take_while(|folder| !folder.as_os_str().is_empty() && fs::symlink_metadata(folder).is_err())
            .collect();
        for folder in missing.into_iter().rev() {
            match fs::create_dir(folder) {
                Ok(()) => made.outermost_first.push(folder.into()),
                // Made by another program meanwhile, or the path goes through '..'.
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
                Err(source) => return Err(OutputError::Folder { path: target.into(), source }),
            }
        }
        match fs::metadata(target) {
            Ok(found) if found.is_dir() => Ok(made),
            Ok(_) => Err(OutputError::NotAFolder { path: target.into() }),
            Err(source) => Err(OutputError::Folder { path: target.into(), source }),
        }
    }

    fn keep(mut self) {
        self.outermost_first.clear();
    }
}

impl Drop for MadeFolders {
    fn drop(&mut self) {
        for folder in self.outermost_first.drain(..).rev() {
            // Not empty: somebody else put something there, and it stays.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// The operating system's error without the path that `tempfile` adds.
fn plain(error: io::Error) -> io::Error {
    error
        .get_ref()
        .and_then(|e| e.source()?.downcast_ref::<io::Error>())
        .and_then(io::Error::raw_os_error)
        .map_or_else(|| io::Error::from(error.kind()), io::Error::from_raw_os_error)
}
