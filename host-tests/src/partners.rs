//! Which images of two cameras belong together, by their names.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The last number in a file's name.
pub fn number(path: &Path) -> Option<u64> {
    let name = path.file_stem()?.to_str()?;
    let tail = name.trim_end_matches(|c: char| !c.is_ascii_digit());
    tail.rsplit(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
}

/// Images by the last number in their names, where some have one and no two the same.
pub fn numbered(paths: &[PathBuf]) -> Option<BTreeMap<u64, PathBuf>> {
    let found: BTreeMap<_, _> = paths.iter().filter_map(|path| Some((number(path)?, path.clone()))).collect();
    // Some may have none, but no two the same.
    let count = paths.iter().filter(|path| number(path).is_some()).count();
    (found.len() == count && count > 0).then_some(found)
}

/// The first image that has no partner on the other side, and whether it is a left one: by their names, where
/// one is on both sides, else by the last numbers in them, where all have one. `None` too where names do not
/// say which belong together.
pub fn alone<'a>(left: &'a [PathBuf], right: &'a [PathBuf]) -> Option<(&'a Path, bool)> {
    let are_numbered =
        [left, right].iter().all(|side| numbered(side).is_some_and(|all| all.len() == side.len()));
    let by_name = without(left, right, Path::file_stem);
    by_name.or_else(|| without(left, right, number).filter(|_| are_numbered)).flatten()
}

/// The right images that belong to the left ones, in the order of those: by their names where all are on both
/// sides, else by the last numbers in them; in their own order where names do not say which belong together.
pub fn partners_of(left: &[PathBuf], right: Vec<PathBuf>) -> Vec<PathBuf> {
    let found = by_key(left, &right, Path::file_stem).or_else(|| by_key(left, &right, number));
    found.unwrap_or(right)
}

/// The right images with the keys of the left ones; `None` where not every key is once on both sides.
fn by_key<'a, K: Ord>(
    left: &'a [PathBuf],
    right: &'a [PathBuf],
    key: impl Fn(&'a Path) -> Option<K>,
) -> Option<Vec<PathBuf>> {
    let mut of_right: BTreeMap<K, &PathBuf> =
        right.iter().filter_map(|path| Some((key(path)?, path))).collect();
    // Each is taken once.
    let found: Vec<_> =
        left.iter().map(|path| of_right.remove(&key(path)?).cloned()).collect::<Option<_>>()?;
    (found.len() == right.len()).then_some(found)
}

/// The first image whose key the other side has not; `None` outside where no key is on both sides.
fn without<'a, K: Ord>(
    left: &'a [PathBuf],
    right: &'a [PathBuf],
    key: impl Fn(&'a Path) -> Option<K>,
) -> Option<Option<(&'a Path, bool)>> {
    let [of_left, of_right] =
        [left, right].map(|side| side.iter().filter_map(|path| key(path)).collect::<BTreeSet<_>>());
    if of_left.is_disjoint(&of_right) {
        return None;
    }
    let lone = |side: &'a [PathBuf], others: &BTreeSet<K>| {
        side.iter().find(|path| key(path).is_none_or(|key| !others.contains(&key)))
    };
    let of_one = lone(left, &of_right).map(|path| (path.as_path(), true));
    Some(of_one.or_else(|| lone(right, &of_left).map(|path| (path.as_path(), false))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(names: &[&str]) -> Vec<PathBuf> {
        names.iter().map(PathBuf::from).collect()
    }

    fn lone(left: &[&str], right: &[&str]) -> Option<(String, bool)> {
        let (left, right) = (paths(left), paths(right));
        alone(&left, &right).map(|(path, is_left)| (path.display().to_string(), is_left))
    }

    #[test]
    fn partners_are_told_by_names_and_numbers_before_their_order() {
        let ordered = |left: &[&str], right: &[&str]| {
            let found = partners_of(&paths(left), paths(right));
            found.iter().map(|path| path.display().to_string()).collect::<Vec<_>>()
        };
        assert_eq!(ordered(&["x9_2.png", "x10_1.png"], &["r_1.png", "r_2.png"]), ["r_2.png", "r_1.png"]);
        // Whole names say more than numbers in them.
        assert_eq!(ordered(&["a_2.png", "b_2.png"], &["b_2.jpg", "a_2.jpg"]), ["a_2.jpg", "b_2.jpg"]);
        // Names that say nothing: none on both sides, one twice, and one without a number.
        assert_eq!(ordered(&["l_1.png", "l_2.png"], &["r_5.png", "r_6.png"]), ["r_5.png", "r_6.png"]);
        assert_eq!(ordered(&["l_2.png", "l_1.png"], &["r_1.png", "s_1.png"]), ["r_1.png", "s_1.png"]);
        assert_eq!(ordered(&["l_2.png", "l.png"], &["r_1.png", "r_2.png"]), ["r_1.png", "r_2.png"]);
    }

    #[test]
    fn what_has_no_partner_is_named() {
        let found = |name: &str, is_left| Some((name.to_owned(), is_left));
        assert_eq!(lone(&["1.png", "2.png"], &["1.png", "3.png"]), found("2.png", true));
        assert_eq!(lone(&["1.png"], &["1.jpg", "3.png"]), found("3.png", false));
        assert_eq!(lone(&["L_1.png", "L_2.png"], &["R_2.png", "R_3.png"]), found("L_1.png", true));
        assert_eq!(lone(&["L_1.png", "L_2.png"], &["R_1.png", "R_2.png"]), None);
        // Names that say nothing: one without a number, a number twice, and none on both sides.
        assert_eq!(lone(&["L_1.png", "L.png"], &["R_1.png", "R_2.png"]), None);
        assert_eq!(lone(&["L_1.png", "M_1.png"], &["R_1.png", "R_2.png"]), None);
        assert_eq!(lone(&["L_1.png"], &["R_2.png"]), None);
    }
}
