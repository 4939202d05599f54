//! What cannot be done ends with status 1, one line that names the culprit, and nothing left behind.

use super::support::{Bench, HEIGHT, WIDTH, calibration, encode, pair, program, stereo, text};
use image::{GrayImage, ImageFormat};

const FORMATS: [(ImageFormat, &str); 6] = [
    (ImageFormat::Png, "png"),
    (ImageFormat::Jpeg, "jpg"),
    (ImageFormat::Pnm, "pgm"),
    (ImageFormat::Tiff, "tiff"),
    (ImageFormat::Bmp, "bmp"),
    (ImageFormat::WebP, "webp"),
];

#[test]
fn bad_images() {
    let bench = Bench::new();
    let mut files =
        vec![bench.path("missing.png"), bench.put("empty.png", b""), bench.put("text.jpg", b"no picture")];
    for (format, extension) in FORMATS {
        let whole = encode(&pair().0, format);
        for (part, of) in [(1, 100), (1, 2), (9, 10), (99, 100)] {
            let name = format!("cut{part}of{of}.{extension}");
            files.push(bench.put(&name, &whole[..(whole.len() * part / of).max(3)]));
        }
        let mut corrupt = whole.clone();
        // Behind the first bytes, by which the format is known.
        corrupt[6..60].fill(0xee);
        files.push(bench.put(&format!("corrupt.{extension}"), &corrupt));
    }
    files.push(bench.put("claims.pgm", b"P5\n5000 10\n255\n"));
    files.push(bench.put("zero.pgm", b"P5\n0 10\n255\n"));
    files.push(bench.put("wide.pgm", &encode(&GrayImage::new(4097, 16), ImageFormat::Pnm)));
    files.push(bench.put("high.png", &encode(&GrayImage::new(16, 4097), ImageFormat::Png)));
    files.push(bench.put("other size.png", &encode(&GrayImage::new(WIDTH, HEIGHT + 1), ImageFormat::Png)));
    for file in files {
        let (path, name) = (file.display().to_string(), file.file_name().expect("a name").to_string_lossy());
        bench.refused(&bench.arguments(&[("--left", &path)]), &name);
        bench.refused(&bench.arguments(&[("--right", &path)]), &name);
        let mut arguments = bench.arguments(&[("--left", &path)]);
        arguments[0] = "bench".into();
        let out = arguments.iter().position(|a| a == "--out").expect("an option");
        arguments.drain(out..out + 2);
        bench.refused(&arguments, &name);
    }
    bench.refused(&bench.arguments(&[("--left", &bench.path("").display().to_string())]), "is not a file");
}

#[test]
fn images_without_their_options() {
    let bench = Bench::new();
    bench
        .refused(&["match", "l.png", "r.png"], "'l.png' found; see --help; images follow --left and --right");
    bench.refused(&["match", "--disparities", "64"], "--left <FILE>");
    // No image is meant.
    for args in [["match", "--lift"], ["doctor", "l.png"]] {
        let said = text(&stereo(args).stderr);
        assert!(said.contains(args[1]) && !said.contains("images follow"), "{said}");
    }
}

#[test]
fn bad_ranges() {
    let bench = Bench::new();
    for bad in ["0", "15", "257", "300", "-5", "65552", "64.5", "many", ""] {
        bench.refused(&bench.arguments(&[("--disparities", bad)]), "--disparities");
    }
    bench.refused(&bench.arguments(&[("--disparities", "97")]), "--disparities 97");
    for bad in ["-1", "x", "70000", "65"] {
        bench.refused(&bench.arguments(&[("--min-disparity", bad)]), "--min-disparity");
    }
    bench.matched(&[("--disparities", "96")]);
    // Two thirds of the columns have no candidate then, which is said.
    let run = stereo(bench.arguments(&[("--min-disparity", "64")]));
    assert!(run.status.success() && text(&run.stderr).contains("% outside"), "{}", text(&run.stderr));
    let narrow =
        bench.put("narrow.png", &encode(&GrayImage::new(15, 8), ImageFormat::Png)).display().to_string();
    let arguments = bench.arguments(&[("--left", &narrow), ("--right", &narrow), ("--disparities", "16")]);
    bench.refused(&arguments, "15 px wide");
}

#[test]
fn bad_options() {
    let bench = Bench::new();
    for method in ["best", "", "FAST"] {
        bench.refused(&bench.arguments(&[("--method", method)]), "--method");
    }
    bench.refused(&bench.arguments(&[("--method", "sgm-full")]), "fast, block, sgm-lean, sgm and sgm-edge");
    bench.refused(&bench.arguments(&[("--filter", "soft")]), "dense, default and strict");
    bench.refused(&bench.arguments(&[("--noise", "2")]), "auto, none, low or high");
    bench.refused(&bench.arguments(&[("--balance", "half")]), "auto or none");
    for threads in ["0", "65", "-1", "two", ""] {
        bench.refused(&bench.arguments(&[("--threads", threads)]), "--threads");
    }
    bench.refused(&bench.arguments(&[("--kernel", "abacus")]), "--kernel");
    let run = program()
        .args(bench.arguments(&[]))
        .env("STEREO_KERNEL", "abacus")
        .output()
        .expect("the program starts");
    bench.is_refusal(&run, "STEREO_KERNEL", "a kernel in the environment");
    bench.refused(&bench.arguments(&[("--colour", "red")]), "--colour");
    for option in ["--left", "--right", "--disparities", "--out"] {
        let mut arguments = bench.arguments(&[]);
        let at = arguments.iter().position(|a| a == option).expect("an option");
        arguments.drain(at..at + 2);
        bench.refused(&arguments, option);
        arguments.insert(at, option.into());
        bench.refused(&arguments, option);
    }
    bench.refused(
        &["bench", "--left", "a", "--right", "b", "--disparities", "64", "--repeat", "0"],
        "--repeat",
    );
    bench.refused(&["calib"], "subcommand");
    bench.refused(
        &["sharpen"],
        "the commands are demo, plan, match, eval, bench, calibrate, calib, rectify, features, focus, \
         fundamental, pose, bundle, odometry, structure, walk, record, replay, dump, view, doctor, \
         completions and man",
    );
    bench.refused(&bench.arguments(&[("--left", "two\nlines.png")]), "two\\nlines.png");
}

#[test]
fn bad_calibrations() {
    let bench = Bench::new();
    let good = calibration(WIDTH, HEIGHT);
    let without = |key: &str| good.lines().filter(|l| !l.starts_with(key)).collect::<Vec<_>>().join("\n");
    let cases = [
        (without("baseline"), "baseline"),
        (without("cam0"), "cam0"),
        (without("cam1"), "cam1"),
        (good.replace("baseline=200", "baseline=inf"), "baseline"),
        (good.replace("baseline=200", "baseline=0"), "baseline"),
        (good.replace("baseline=200", "baseline=-1"), "baseline"),
        (good.replace("baseline=200", "baseline=1e30"), "is not likely"),
        (good.replace("cam1=[100", "cam1=[nan"), "cam1"),
        (good.replace("cam0=[100 0", "cam0=[100 x"), "'x' is not a number"),
        (good.replace("[100", "[0"), "cam0"),
        (String::new(), "empty"),
        (calibration(WIDTH + 1, HEIGHT), "width says 97"),
        (calibration(WIDTH, HEIGHT * 2), "height says 96"),
        ("P0: 1 2 3\nP1: 1 2 3\n".into(), "P0"),
    ];
    for (content, culprit) in cases {
        let file = bench.put("calib.txt", content.as_bytes()).display().to_string();
        bench.refused(&bench.arguments(&[("--calib", &file)]), culprit);
        bench.refused(&bench.arguments(&[("--calib", &file)]), "calib.txt");
    }
    let garbage: Vec<u8> = (0..=255).cycle().take(4000).collect();
    let file = bench.put("garbage.txt", &garbage).display().to_string();
    bench.refused(&bench.arguments(&[("--calib", &file)]), "garbage.txt");
    let missing = bench.path("none.txt").display().to_string();
    bench.refused(&bench.arguments(&[("--calib", &missing)]), "none.txt");
}

#[test]
fn help_and_version_are_no_errors() {
    for arguments in [&["--help"][..], &["match", "--help"], &["bench", "-h"], &["demo", "--help"], &["help"]]
    {
        let run = stereo(arguments);
        assert!(run.status.success() && run.stderr.is_empty(), "{arguments:?}");
        assert!(text(&run.stdout).contains("Usage: stereo"), "{arguments:?}");
    }
    assert!(text(&stereo(["match", "--help"]).stdout).contains("Example:\n  stereo match --left"));
    assert!(text(&stereo(["--version"]).stdout).starts_with("stereo 0."));
}
