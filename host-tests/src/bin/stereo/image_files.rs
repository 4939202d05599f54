//! The images that patterns name, and which of two cameras belong together.

use crate::failure::Failure;
use alphanumeric_sort::sort_path_slice;
use std::path::{Path, PathBuf};
use stereopsis_host::focus::stack::images;
use stereopsis_host::partners::{number, numbered};

/// Left and right images by the last number in their names; by their order where names have none.
pub fn pairs(
    left: &[String],
    right: &[String],
    notes: &mut Vec<String>,
) -> Result<Vec<[PathBuf; 2]>, Failure> {
    let (left, right) = (files("--left", left)?, files("--right", right)?);
    if let (Some(mut of_left), Some(mut of_right)) = (numbered(&left), numbered(&right))
        && of_left.keys().any(|key| of_right.contains_key(key))
    {
        let alone = |path: &PathBuf| format!("{} has no partner; it is left out", path.display());
        notes.extend(left.iter().chain(&right).filter(|path| number(path).is_none()).map(alone));
        notes.extend(
            of_left.iter().filter(|(key, _)| !of_right.contains_key(key)).map(|(_, path)| alone(path)),
        );
        notes.extend(
            of_right.iter().filter(|(key, _)| !of_left.contains_key(key)).map(|(_, path)| alone(path)),
        );
        let keys: Vec<_> = of_left.keys().copied().collect();
        let pair = |key: u64| Some([of_left.remove(&key)?, of_right.remove(&key)?]);
        return Ok(keys.into_iter().filter_map(pair).collect());
    }
    if left.len() != right.len() {
        return Err(Failure::new(format!(
            "--left and --right: {} and {} images; as many of both are needed, or numbers in their names \
             that say which belong together",
            left.len(),
            right.len()
        )));
    }
    Ok(left.into_iter().zip(right).map(|(left, right)| [left, right]).collect())
}

/// Whether a name is no file's, and stands for several.
pub fn is_pattern(path: &Path) -> bool {
    !path.exists() && path.to_string_lossy().contains(['*', '?', '['])
}

/// The first two neighbours between which files seem to be missing: their numbers are farther apart than most
/// are. `None` where there are none, or files have no numbers.
pub fn gap(files: &[&Path]) -> Option<[PathBuf; 2]> {
    let numbers: Vec<u64> = files.iter().map(|file| number(file)).collect::<Option<_>>()?;
    let steps: Vec<u64> = numbers.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).collect();
    let mut sorted = steps.clone();
    sorted.sort_unstable();
    // Time stamps are not quite as far apart as each other.
    let most = sorted.get(sorted.len() / 2)?.saturating_mul(3) / 2;
    let place = steps.iter().position(|&step| step > most)?;
    Some([files[place].to_owned(), files[place + 1].to_owned()])
}

/// The files that patterns and folders name, in the order of their names, numbers by their value.
pub fn files(option: &str, patterns: &[String]) -> Result<Vec<PathBuf>, Failure> {
    let mut found = Vec::new();
    for pattern in patterns {
        // A name with brackets in it may be a file's.
        if Path::new(pattern).is_file() {
            found.push(pattern.into());
            continue;
        }
        if Path::new(pattern).is_dir() {
            let inside = images(Path::new(pattern));
            let inside = inside.map_err(|e| Failure::new(format!("{option} {pattern}: {e}")))?;
            if inside.is_empty() {
                return Err(Failure::new(format!("{option} {pattern}: holds no image")));
            }
            found.extend(inside);
            continue;
        }
        let paths = glob::glob(pattern).map_err(|e| Failure::new(format!("{option} {pattern}: {e}")))?;
        let before = found.len();
        for path in paths {
            found.push(path?);
        }
        if found.len() == before {
            return Err(Failure::new(format!(
                "{option} {pattern}: there is no such file; name the images, as 'left*.png', or their folder"
            )));
        }
    }
    sort_path_slice(&mut found);
    found.dedup();
    Ok(found)
}
