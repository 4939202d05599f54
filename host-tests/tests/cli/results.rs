//! The files of the contract, decoded and compared with what the library says in this process.

use super::support::{Bench, FAR, HEIGHT, NEAR, WIDTH, calibration, encode, pair, program, stereo, text};
use image::{DynamicImage, ImageFormat};
use serde_json::Value;
use std::fs;
use std::path::Path;
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::imaging::Noise;
use stereopsis::matching::{Config, Filter, Kernel};
use stereopsis::units::PixelFlags;
use stereopsis_host::map::DisparityMap;
use stereopsis_host::pfm::{self, FloatMap};
use stereopsis_host::run::{MemoryPair, MethodName, NoiseChoice, run};

/// What the library says of the pair.
fn in_process(method: MethodName, filter: Filter, noise: NoiseChoice) -> DisparityMap {
    let (left, right) = pair();
    let mut camera = MemoryPair::new(WIDTH as u16, left.into_raw(), right.into_raw()).expect("one size");
    let (noise, _) = noise.level(&mut camera).expect("a source that cannot fail");
    let search = Config { confidence: true, noise, ..method.config(WIDTH as u16, HEIGHT as u16, 32) };
    let config = method.with_filter(filter, search);
    run(method, &config, &mut camera, |_| {}).expect("a source that cannot fail").map
}

fn float_map(path: &Path) -> FloatMap {
    let file = fs::read(path).expect("a result");
    assert!(file.starts_with(b"Pf\n96 48\n-1.0\n"), "{}", path.display());
    pfm::read(&mut file.as_slice()).expect("a float map")
}

fn picture(path: &Path) -> DynamicImage {
    image::open(path).expect("a picture")
}

pub fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).expect("a result")).expect("JSON")
}

#[test]
fn every_kernel_and_number_of_threads_writes_the_same() {
    let bench = Bench::new();
    let out = bench.path("out");
    // So few rows are no three bands of `block`.
    for (method, threads) in [("fast", 3), ("block", 2)] {
        bench.matched(&[("--method", method)]);
        let [expected, flags] =
            ["disparity.pfm", "flags.png"].map(|file| fs::read(out.join(file)).expect("a result"));
        let bands = stereo(bench.arguments(&[("--method", method), ("--threads", "3")]));
        assert!(bands.status.success(), "{}", text(&bands.stderr));
        assert!(
            fs::read(out.join("disparity.pfm")).expect("a result") == expected,
            "{method} in three threads"
        );
        assert!(fs::read(out.join("flags.png")).expect("a result") == flags, "{method} in three threads");
        let page = fs::read_to_string(out.join("report.html")).expect("the page");
        assert!(
            page.contains(&format!(" ms</b>for the frame, {threads} threads</li>")),
            "{method}: {threads}"
        );
        for kernel in Kernel::available().map(Kernel::name) {
            let by_option = stereo(bench.arguments(&[("--method", method), ("--kernel", kernel)]));
            let by_variable = program()
                .args(bench.arguments(&[("--method", method)]))
                .env("STEREO_KERNEL", kernel)
                .output();
            for run in [by_option, by_variable.expect("the program starts")] {
                assert!(run.status.success(), "{kernel}: {}", text(&run.stderr));
                assert_eq!(json(&out.join("summary.json"))["kernel"], kernel);
                assert!(
                    fs::read(out.join("disparity.pfm")).expect("a result") == expected,
                    "{method} on {kernel}"
                );
                assert!(fs::read(out.join("flags.png")).expect("a result") == flags, "{method} on {kernel}");
            }
        }
    }
}

#[test]
fn the_files_hold_what_the_library_says() {
    let bench = Bench::new();
    let out = bench.path("out");
    for method in MethodName::ALL {
        for filter in Filter::ALL {
            let map = in_process(method, filter, NoiseChoice::Auto);
            let (name, filter) = (method.name(), filter.name());
            bench.matched(&[("--method", name), ("--filter", filter)]);
            assert_eq!(float_map(&out.join("disparity.pfm")).values, map.pixels(), "{name} {filter}");

            let DynamicImage::ImageLuma16(samples) = picture(&out.join("disparity.png")) else {
                panic!("16-bit grey")
            };
            for (sample, px) in samples.iter().zip(map.pixels()) {
                let expected = if px.is_finite() { (px * 256.0).clamp(1.0, 65535.0) } else { 0.0 };
                assert_eq!(f32::from(*sample), expected);
            }
            let DynamicImage::ImageLuma8(flags) = picture(&out.join("flags.png")) else {
                panic!("8-bit grey")
            };
            assert!(flags.iter().zip(&map.flags).all(|(byte, flags)| *byte == flags.bits()));
            let DynamicImage::ImageLuma8(sure) = picture(&out.join("confidence.png")) else {
                panic!("8-bit grey")
            };
            assert!(sure.as_raw() == &map.confidence);
            assert!(map.confidence.iter().zip(&map.disparity).all(|(c, d)| (*c > 0) == d.is_some()));
            let DynamicImage::ImageRgb8(colours) = picture(&out.join("disparity_colour.png")) else {
                panic!("colour")
            };
            assert!(colours.pixels().zip(&map.disparity).all(|(c, d)| (c.0 == [0; 3]) == d.is_none()));

            let summary = json(&out.join("summary.json"));
            assert_eq!((summary["method"].as_str(), summary["filter"].as_str()), (Some(name), Some(filter)));
            assert_eq!(summary["answers"], map.answers());
            let surest = map.confidence.iter().max().map(|&c| f64::from(c));
            assert_eq!(summary["confidence"]["max"].as_f64(), surest);
            assert_eq!(summary["flags"]["mismatch"], map.flagged(PixelFlags::MISMATCH));
            assert_eq!(summary["state_bytes"], method.state_bytes(WIDTH as u16, 32));
            assert_eq!(summary["latency_lines"], method.latency_lines());
            assert_eq!(
                [&summary["width"], &summary["height"], &summary["disparities"]],
                [WIDTH, HEIGHT, 32].map(Value::from).each_ref()
            );
            assert!(summary["depth"].is_null() && summary["time_ms"].as_f64().is_some_and(|ms| ms > 0.0));
        }
    }
}

#[test]
fn noise_is_measured_or_given() {
    let bench = Bench::new();
    let summary = || json(&bench.path("out/summary.json"));
    let mut maps = Vec::new();
    for noise in Noise::ALL {
        bench.matched(&[("--method", "sgm"), ("--noise", noise.name())]);
        let map = float_map(&bench.path("out/disparity.pfm")).values;
        let expected = in_process(MethodName::Sgm, Filter::Default, NoiseChoice::Given(noise));
        assert_eq!(map, expected.pixels(), "{noise:?}");
        assert_eq!(summary()["noise"], noise.name());
        assert!(summary()["noise_sigma"].is_null());
        maps.push(map);
    }
    assert!(maps[0] != maps[1] && maps[1] != maps[2]);
    // Every pixel of the picture is chosen by chance.
    bench.matched(&[("--method", "sgm")]);
    assert_eq!(summary()["noise"], "high");
    assert!(summary()["noise_sigma"].as_f64().is_some_and(|sigma| sigma > 10.0));
    assert_eq!(float_map(&bench.path("out/disparity.pfm")).values, maps[2]);
}

#[test]
fn unsure_answers_are_refused() {
    let bench = Bench::new();
    let confidences = |least: &str| {
        bench.matched(&[("--method", "block"), ("--min-confidence", least)]);
        picture(&bench.path("out/confidence.png")).into_luma8().into_raw()
    };
    let (all, sure) = (confidences("0"), confidences("100"));
    assert!(all.iter().any(|&c| (1..100).contains(&c)) && all.iter().any(|&c| c >= 100));
    assert!(all.iter().zip(&sure).all(|(&all, &sure)| sure == if all < 100 { 0 } else { all }));
    for bad in ["208", "-1", "x"] {
        let refused = stereo(bench.arguments(&[("--min-confidence", bad)]));
        let said = text(&refused.stderr);
        assert!(!refused.status.success() && said.contains("from 0 to 207"), "{said}");
    }
}

#[test]
fn exposures_are_balanced_where_they_differ() {
    let bench = Bench::new();
    let right = bench.path("bright.png").display().to_string();
    let mut picture = pair().1;
    picture.iter_mut().for_each(|grey| *grey = (*grey / 2).saturating_add(80));
    picture.save(&right).expect("a picture");
    let balance = || json(&bench.path("out/summary.json"))["balance"].take();
    let answers = |options: &[(&str, &str)]| {
        let all = [&[("--right", right.as_str()), ("--noise", "none")][..], options].concat();
        let told = text(&bench.matched(&all).stdout);
        (told, fs::read(bench.path("out/disparity.pfm")).expect("a result"))
    };
    let (told, balanced) = answers(&[("--method", "sgm")]);
    let number = |name: &str| balance()[name].as_f64().expect("a number");
    let [gain, offset] = ["gain", "offset"].map(number);
    assert!((gain - 2.0).abs() < 0.1 && (offset + 160.0).abs() < 10.0, "{gain}, {offset}");
    assert!(
        told.contains(&format!("exposure     right image x {gain:.2} {offset:+.1} grey levels")),
        "{told}"
    );
    let (told_without, as_it_comes) = answers(&[("--method", "sgm"), ("--balance", "none")]);
    assert!(!told_without.contains("exposure") && balance().is_null() && balanced != as_it_comes);
    // A census does not ask how bright a pixel is.
    let (told, _) = answers(&[("--method", "block")]);
    assert!(!told.contains("exposure") && balance().is_null());
    let alike = bench.matched(&[("--method", "sgm")]);
    assert!(!text(&alike.stdout).contains("exposure") && balance().is_null(), "the pair as it is");
}

#[test]
fn the_answers_are_those_of_the_pictures() {
    let bench = Bench::new();
    bench.matched(&[]);
    let map = float_map(&bench.path("out/disparity.pfm"));
    let at = |x: usize, y: usize| map.values[y * WIDTH as usize + x];
    assert!((at(55, 24) - NEAR as f32).abs() < 0.5, "{}", at(55, 24));
    // The row from the top, not from the bottom: the square is lower than row 4.
    assert!((at(55, 4) - FAR as f32).abs() < 0.5, "{}", at(55, 4));
    assert_eq!(at(2, 4), f32::INFINITY, "no candidate lies inside the right image");
}

#[test]
fn a_calibration_adds_depth_in_metres_and_millimetres_and_a_cloud() {
    let bench = Bench::new();
    let calib = bench.put("calib.txt", calibration(WIDTH, HEIGHT).as_bytes()).display().to_string();
    bench.matched(&[("--calib", &calib)]);
    let out = bench.path("out");
    let rig = RectifiedRig::with_offset(100.0, 0.2, 47.5, 23.5, 48.5).expect("a rig");
    let scale = DepthScale::new(&rig).expect("in range");
    let map = in_process(MethodName::Sgm, Filter::Default, NoiseChoice::Auto);
    let depth = float_map(&out.join("depth.pfm"));
    assert_eq!(depth.values, map.depth_m(&scale));
    let DynamicImage::ImageLuma16(millimetres) = picture(&out.join("depth.png")) else {
        panic!("16-bit grey")
    };
    for (mm, m) in millimetres.iter().zip(&depth.values) {
        let nearest_mm = if m.is_finite() { (m * 1000.0).min(65535.0) } else { 0.0 };
        assert!((f32::from(*mm) - nearest_mm).abs() <= 1.0, "{mm} mm, {m} m");
    }
    let summary = json(&out.join("summary.json"));
    let farthest_m = summary["depth"]["farthest_m"].as_f64().expect("a depth") as f32;
    let points = depth.values.iter().filter(|m| **m <= farthest_m).count();
    assert_eq!(summary["depth"]["cloud_left_out"], map.answers() - points);
    let clamped = depth.values.iter().filter(|m| m.is_finite() && **m > 65.535).count();
    assert!(summary["depth"]["png_clamped"].as_u64() >= Some(clamped as u64), "{clamped} are too far");
    let cloud = fs::read(out.join("cloud.ply")).expect("a cloud");
    let body = cloud.windows(11).position(|w| w == b"end_header\n").expect("a header") + 11;
    let header = text(&cloud[..body]);
    assert!(header.starts_with("ply\nformat binary_little_endian 1.0\n"), "{header}");
    assert!(header.contains(&format!("element vertex {points}\n")), "{header}");
    assert_eq!(cloud.len() - body, points * 15);
    let first = depth.values.iter().find(|z| **z <= farthest_m).expect("an answer");
    assert_eq!(cloud[body + 8..body + 12], first.to_le_bytes(), "Z of the first point");
    assert_eq!(summary["depth"]["baseline_m"].as_f64().map(|b| b as f32), Some(0.2));
    assert!(summary["depth"]["nearest_m"].as_f64() < summary["depth"]["farthest_m"].as_f64());
}

#[test]
fn every_image_format_gives_the_same_answers() {
    let bench = Bench::new();
    bench.matched(&[]);
    let expected = float_map(&bench.path("out/disparity.pfm"));
    let (left, right) = pair();
    let colour = DynamicImage::from(right.clone()).into_rgb16();
    let mut bytes = std::io::Cursor::new(Vec::new());
    DynamicImage::from(colour).write_to(&mut bytes, ImageFormat::Tiff).expect("16-bit colour TIFF");
    let r = bench.put("right.tiff", bytes.get_ref()).display().to_string();
    let l = bench.put("left.pgm", &encode(&left, ImageFormat::Pnm)).display().to_string();
    bench.matched(&[("--left", &l), ("--right", &r)]);
    assert_eq!(float_map(&bench.path("out/disparity.pfm")), expected);
    let l = bench.put("left.bmp", &encode(&left, ImageFormat::Bmp)).display().to_string();
    let r = bench.put("right.webp", &encode(&right, ImageFormat::WebP)).display().to_string();
    bench.matched(&[("--left", &l), ("--right", &r)]);
    assert_eq!(float_map(&bench.path("out/disparity.pfm")), expected);
}

#[test]
fn the_report_asks_for_nothing_and_escapes_names() {
    let bench = Bench::new();
    let odd = bench.put("a<b>&c.png", &encode(&pair().0, ImageFormat::Png)).display().to_string();
    bench.matched(&[("--left", &odd)]);
    let report = fs::read_to_string(bench.path("out/report.html")).expect("UTF-8");
    assert!(report.contains("a&lt;b&gt;&amp;c.png") && !report.contains("<b>&c"));
    assert_eq!(report.matches("src=\"data:image/png;base64,").count(), report.matches("<img").count());
    for outside in ["http:", "https:", "src=\"//", "<link", "url(//", "@import"] {
        assert!(!report.contains(outside), "{outside}");
    }
    assert!(report.ends_with("</body></html>\n"));
}
