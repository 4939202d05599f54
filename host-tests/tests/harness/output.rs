//! Results in several folders appear in all of them or in none.

use std::fs;
use std::path::Path;
use stereopsis_host::output::Staging;

fn staged(folder: &Path, name: &str, content: &[u8]) -> Staging {
    let mut staging = Staging::new(folder).expect("a folder");
    staging.write(name, |out| out.write_all(content)).expect("room");
    staging
}

#[test]
fn results_in_two_folders_appear_together_or_not_at_all() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [first, second, new] = ["first", "second", "new"].map(|name| folder.path().join(name));
    fs::create_dir_all(&first).expect("a folder");
    fs::write(first.join("a.txt"), b"old").expect("room");
    let all =
        vec![staged(&first, "a.txt", b"a"), staged(&new, "c.txt", b"c"), staged(&second, "b.txt", b"b")];
    // A folder takes the place of the last one meanwhile.
    fs::create_dir_all(second.join("b.txt")).expect("a folder");
    let error = Staging::commit_all(all).expect_err("a folder is in the way").to_string();
    assert!(error.contains("b.txt"), "{error}");
    assert_eq!(fs::read(first.join("a.txt")).expect("the old one"), b"old");
    assert!(!new.exists() && fs::read_dir(&first).expect("a folder").count() == 1);

    fs::remove_dir(second.join("b.txt")).expect("a folder");
    let all = vec![staged(&first, "a.txt", b"a"), staged(&second, "b.txt", b"b")];
    Staging::commit_all(all).expect("both");
    assert_eq!(fs::read(first.join("a.txt")).expect("a file"), b"a");
    assert_eq!(fs::read(second.join("b.txt")).expect("a file"), b"b");
    assert_eq!(fs::read_dir(&second).expect("a folder").count(), 1);
}

#[test]
fn the_lock_has_its_name_once_it_is_held() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let _first = staged(folder.path(), "a.txt", b"a");
    let inside =
        fs::read_dir(folder.path()).expect("a folder").next().expect("files").expect("an entry").path();
    let lock = fs::File::options().write(true).open(inside.join("lock")).expect("the lock");
    assert!(lock.try_lock().is_err() && !inside.join("lock.new").exists());
    // Another run leaves it alone.
    drop(staged(folder.path(), "b.txt", b"b"));
    assert!(inside.join("a.txt").is_file());
    // So it does where the run has not got as far as the lock.
    let begun = folder.path().join(".stereo-unfinished-begun");
    fs::create_dir(&begun).expect("a folder");
    fs::write(begun.join("lock.new"), b"").expect("room");
    drop(staged(folder.path(), "b.txt", b"b"));
    assert!(begun.is_dir());
}
