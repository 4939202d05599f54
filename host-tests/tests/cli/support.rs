//! Running the program, and pictures to run it on.

use image::{DynamicImage, GrayImage, ImageFormat, Luma};
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub const WIDTH: u32 = 96;
pub const HEIGHT: u32 = 48;
/// Disparity of the background and of the square before it, px.
pub const FAR: u32 = 5;
pub const NEAR: u32 = 12;

/// The built program, without what the caller's environment asks of it.
pub fn program() -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_stereo"));
    program.env_remove("STEREO_KERNEL");
    program
}

/// Runs the program to its end.
pub fn stereo<S: AsRef<OsStr>>(args: impl IntoIterator<Item = S>) -> Output {
    program().args(args).output().expect("the program starts")
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A folder with a pair, `left.png` and `right.png`, gone at the end of the test.
pub struct Bench(tempfile::TempDir);

impl Bench {
    pub fn new() -> Self {
        let bench = Self(tempfile::tempdir().expect("a temporary folder"));
        let (left, right) = pair();
        bench.put("left.png", &encode(&left, ImageFormat::Png));
        bench.put("right.png", &encode(&right, ImageFormat::Png));
        bench
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn put(&self, name: &str, bytes: &[u8]) -> PathBuf {
        fs::write(self.path(name), bytes).expect("a file in the temporary folder");
        self.path(name)
    }

    /// All files below the folder with their content; folders have none.
    pub fn everything(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut found = BTreeMap::new();
        let mut folders = vec![self.0.path().to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(&folder).expect("a readable folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    found.insert(path.clone(), Vec::new());
                    folders.push(path);
                } else {
                    found.insert(path.clone(), fs::read(&path).expect("a readable file"));
                }
            }
        }
        found
    }

    /// The arguments of `match` on the pair, with results in `out`; `change` replaces values of options or
    /// adds some.
    pub fn arguments(&self, change: &[(&str, &str)]) -> Vec<String> {
        let file = |name| self.path(name).display().to_string();
        let mut options = BTreeMap::from([
            ("--left", file("left.png")),
            ("--right", file("right.png")),
            ("--disparities", "32".to_owned()),
            ("--out", file("out")),
        ]);
        options.extend(change.iter().map(|(option, value)| (*option, (*value).to_owned())));
        let options = options.into_iter().flat_map(|(option, value)| [option.to_owned(), value]);
        ["match".to_owned()].into_iter().chain(options).collect()
    }

    /// Runs `match` on the pair and expects results.
    pub fn matched(&self, change: &[(&str, &str)]) -> Output {
        let run = stereo(self.arguments(change));
        assert!(run.status.success() && run.stderr.is_empty(), "{change:?}: {}", text(&run.stderr));
        run
    }

    /// Runs the program and expects status 1, or 2 for a wrong command line, one line that names the culprit,
    /// and no trace in the folder.
    pub fn refused<S: AsRef<OsStr> + std::fmt::Debug>(&self, args: &[S], culprit: &str) {
        let before = self.everything();
        let run = stereo(args);
        self.is_refusal(&run, culprit, &format!("{args:?}"));
        assert!(before == self.everything(), "{args:?} left something behind or changed something");
    }

    pub fn is_refusal(&self, run: &Output, culprit: &str, what: &str) {
        let said = text(&run.stderr);
        // What is wrong with the command line is named in these words; all else is wrong with what it names.
        let is_usage = [
            "for '--",
            "for '<",
            "see --help",
            "the commands are",
            "requires a subcommand",
            "cannot be used with",
            "is missing; give",
            "is missing; the search",
            "are missing; give",
            "which is missing",
            "more than twice",
            "is given twice",
            "give --loss huber too",
            "give --format tum too",
            "give --rectify too",
            "give --calib too",
            "distances need a calibration",
            "give one, or one setting",
            "name another\n",
            "of the side of a square",
            "is not nearer than",
        ];
        let status = if is_usage.iter().any(|words| said.contains(words)) { 2 } else { 1 };
        assert_eq!(run.status.code(), Some(status), "{what}: {said}");
        assert_eq!(said.lines().count(), 1, "{what}: {said}");
        assert!(said.starts_with("stereo: ") && said.ends_with('\n'), "{what}: {said}");
        assert!(said.contains(culprit), "{what}: '{culprit}' is not named in: {said}");
        assert!(run.stdout.is_empty(), "{what}: {}", text(&run.stdout));
    }
}

/// A textured background with a square before it, as two grey pictures.
pub fn pair() -> (GrayImage, GrayImage) {
    let texture = |x: i64, y: u32| {
        let mut bits =
            (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ u64::from(y).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 29)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (bits >> 40) as u8
    };
    let near = |x: u32, y: u32| (40..70).contains(&x) && (12..36).contains(&y);
    let left = GrayImage::from_fn(WIDTH, HEIGHT, |x, y| {
        let d = if near(x, y) { NEAR } else { FAR };
        Luma([texture(i64::from(x) - i64::from(d), y)])
    });
    let right = GrayImage::from_fn(WIDTH, HEIGHT, |x, y| Luma([texture(i64::from(x), y)]));
    (left, right)
}

pub fn encode(image: &GrayImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    DynamicImage::from(image.clone()).write_to(&mut bytes, format).expect("a grey image");
    bytes.into_inner()
}

/// A Middlebury calibration of the pair: 100 px, 200 mm.
pub fn calibration(width: u32, height: u32) -> String {
    format!(
        "cam0=[100 0 47.5; 0 100 23.5; 0 0 1]\ncam1=[100 0 48.5; 0 100 23.5; 0 0 \
         1]\ndoffs=1\nbaseline=200\nwidth={width}\nheight={height}\nndisp=32\n"
    )
}

/// The names of the files in a folder, in order.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a readable folder");
    let mut names: Vec<String> =
        entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
