//! What a run has not finished, taken away where somebody interrupts it.

use std::fs;
use std::path::PathBuf;
use std::process;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// The status of a program that was interrupted, as shells have it.
const INTERRUPTED: i32 = 130;
/// How often a folder is removed into which another thread writes.
const TIMES: usize = 50;

/// Folders of files that are being written, and those that were made for each, the outermost first.
static ALL: Mutex<Vec<(PathBuf, Vec<PathBuf>)>> = Mutex::new(Vec::new());

fn all() -> MutexGuard<'static, Vec<(PathBuf, Vec<PathBuf>)>> {
    ALL.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A folder of files that are being written, until it is dropped.
#[derive(Debug)]
pub(crate) struct Unfinished(PathBuf);

impl Unfinished {
    /// Makes a folder that files are written into from now on, and `made` of it: the folder, and those that
    /// were made for it. An interruption waits until it knows them.
    pub fn begin<T, E>(
        make: impl FnOnce() -> Result<T, E>,
        made: impl FnOnce(&T) -> (PathBuf, Vec<PathBuf>),
    ) -> Result<(T, Self), E> {
        let mut all = all();
        let begun = make()?;
        let (files, folders) = made(&begun);
        all.push((files.clone(), folders));
        Ok((begun, Self(files)))
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        all().retain(|(files, _)| *files != self.0);
    }
}

/// Does what is not to be left half done: an interruption waits for it.
pub(crate) fn as_a_whole<T>(work: impl FnOnce() -> T) -> T {
    let _all = all();
    work()
}

/// From now on an interruption (Ctrl-C, or a request to end) removes what is not finished, and ends the
/// program with status 130. Where somebody decides already what one does, as `nohup` does, that stays.
pub fn remove_when_interrupted() {
    let _ = ctrlc::try_set_handler(|| {
        // Held to the end: nothing more gets its place.
        let all = all();
        // The newest first: its folder may stand in one that was made before.
        for (files, made) in all.iter().rev() {
            for _ in 0..TIMES {
                let _ = fs::remove_dir_all(files);
                if !files.exists() {
                    break;
                }
                thread::sleep(Duration::from_millis(10));
            }
            for folder in made.iter().rev() {
                // Not empty: somebody else put something there, and it stays.
                let _ = fs::remove_dir(folder);
            }
        }
        process::exit(INTERRUPTED);
    });
}
