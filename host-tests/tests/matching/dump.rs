//! The rows that are dumped: the last stage is what the core gives, and each one follows from the one before.

use image::GrayImage;
use stereopsis::imaging::{census_plus4, census_ring8, census_wide8};
use stereopsis::matching::{Config, Filter};
use stereopsis_host::dump::{Dump, Stage};
use stereopsis_host::run::{MemoryPair, MethodName, run};
use stereopsis_host::scene::pattern::Pattern;
use stereopsis_host::twin::stages::Stages;

const SIZE: (u16, u16) = (70, 30);

fn pair() -> (GrayImage, GrayImage) {
    Pattern::Shifted { most: 12, noise_grey: 2.0 }.pair(u32::from(SIZE.0), u32::from(SIZE.1), 8)
}

fn check(method: MethodName, census: fn(&[&[u8]; 5], &mut [u8])) {
    let (left, right) = pair();
    for filter in Filter::ALL {
        let search = Config { confidence: true, ..method.config(SIZE.0, SIZE.1, 24) };
        let config = method.with_filter(filter, search);
        let stages = Stages::of(&method.twin(), &config, &left, &right);
        let mut camera =
            MemoryPair::new(SIZE.0, left.as_raw().clone(), right.as_raw().clone()).expect("one size");
        let core = run(method, &config, &mut camera, |_| ()).expect("a source that cannot fail").map;
        let (width, height) = (usize::from(SIZE.0), usize::from(SIZE.1));
        for y in 0..height {
            let row = y * width..(y + 1) * width;
            let flags = core.flags[row.clone()].iter().zip(&core.confidence[row.clone()]);
            let bytes: Vec<u8> = core.disparity[row.clone()]
                .iter()
                .zip(flags)
                .flat_map(|(d, (flags, &confidence))| {
                    let [low, high] = d.raw().to_le_bytes();
                    [low, high, flags.bits(), confidence]
                })
                .collect();
            assert!(Stage::Final.row(&stages, y) == bytes, "{} {} row {y}", method.name(), filter.name());
            // The first stage against the core's own function.
            let line = |off: isize| {
                let y = (y as isize + off).clamp(0, height as isize - 1) as usize;
                &left.as_raw()[y * width..(y + 1) * width]
            };
            let mut codes = vec![0; width];
            census(&[-2, -1, 0, 1, 2].map(line), &mut codes);
            assert_eq!(Stage::Census.row(&stages, y)[..width], codes, "{} row {y}", method.name());
        }
    }
}

#[test]
fn the_last_stage_is_what_the_core_gives() {
    check(MethodName::Fast, census_plus4);
    check(MethodName::Block, census_ring8);
    check(MethodName::SgmLean, census_wide8);
    check(MethodName::Sgm, census_wide8);
    check(MethodName::SgmEdge, census_wide8);
}

#[test]
fn rows_are_bytes_and_the_same_as_text() {
    let (left, right) = pair();
    let method = MethodName::Block;
    let config = method.config(SIZE.0, SIZE.1, 24);
    let stages = Stages::of(&method.twin(), &config, &left, &right);
    for stage in Stage::ALL {
        let dump = Dump::new(stage, &stages, 4..7);
        let (mut bytes, mut text) = (Vec::new(), Vec::new());
        dump.write(&mut bytes).expect("memory takes all");
        dump.write_mem(&mut text).expect("memory takes all");
        let manifest = dump.manifest(&config, method.name());
        assert_eq!(bytes.len(), 3 * manifest.elements_per_row * manifest.element_bytes, "{}", stage.name());
        assert_eq!(manifest.crc32, crc32fast::hash(&bytes));
        let row = bytes.len() / 3;
        assert_eq!(manifest.row_crc32, [0, 1, 2].map(|i| crc32fast::hash(&bytes[i * row..(i + 1) * row])));
        let text = String::from_utf8(text).expect("hexadecimal numbers");
        let mut read = Vec::new();
        for line in text.lines().filter(|line| !line.starts_with("//")) {
            assert_eq!(line.len(), 2 * manifest.element_bytes);
            let value = u64::from_str_radix(line, 16).expect("a number");
            read.extend_from_slice(&value.to_le_bytes()[..manifest.element_bytes]);
        }
        assert!(read == bytes, "{}", stage.name());
        assert_eq!(text.lines().filter(|line| line.starts_with("// row ")).count(), 3);
    }
}
