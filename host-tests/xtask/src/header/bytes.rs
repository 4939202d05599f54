//! Macros that say how many bytes of memory a matcher and the rest take, by what the crate says of itself.

use crate::steps::{Failure, Outcome};
use stereopsis::ffi::{
    detector_bytes, focus_bytes, line_queue_bytes, memory_bytes, obstacles_bytes, odometry_bytes,
    rectifier_bytes, winners_bytes,
};
use stereopsis::matching::{Block, Fast, Method, Sgm, SgmEdge, SgmLean};

/// All macros, one below the other.
pub fn macros() -> Outcome<String> {
    let all = [
        bytes_macro::<Fast>()?,
        bytes_macro::<Block>()?,
        bytes_macro::<SgmLean>()?,
        bytes_macro::<Sgm>()?,
        bytes_macro::<SgmEdge>()?,
        winners_macro()?,
        rectifier_macro()?,
        line_queue_macro()?,
        detector_macro(),
        focus_macro(),
        odometry_macro(),
        obstacles_macro(),
    ];
    Ok(all.join("\n"))
}

/// How many bytes a method takes, as a macro.
fn bytes_macro<S: Method>() -> Outcome<String> {
    let name = S::NAME.to_uppercase().replace('-', "_");
    product_macro(&name, &format!("a matcher of method {}", S::NAME), memory_bytes::<S>)
}

/// How many bytes the second half of a matcher takes, as a macro.
fn winners_macro() -> Outcome<String> {
    product_macro("WINNERS", "the second half of a matcher", winners_bytes)
}

/// A number of bytes as a macro: `a + b width + c disparities + d width disparities`, by trying.
fn product_macro(name: &str, what: &str, most: fn(usize, usize) -> usize) -> Outcome<String> {
    let bytes = |width: usize, disparities: usize| most(width, disparities) as i64;
    let [w, d, step_w, step_d] = [256, 16, 256, 16];
    let (by_w, by_d) = (bytes(512, 16) - bytes(256, 16), bytes(256, 32) - bytes(256, 16));
    let both = (bytes(512, 32) - bytes(256, 16) - by_w - by_d) / (step_w * step_d);
    let (by_w, by_d) = (by_w / step_w - both * d, by_d / step_d - both * w);
    let fixed = bytes(256, 16) - by_w * w - by_d * d - both * w * d;
    for (width, disparities) in [(16, 16), (160, 32), (320, 64), (333, 240), (640, 128), (4096, 256)] {
        let (w, d) = (width as i64, disparities as i64);
        if fixed + by_w * w + by_d * d + both * w * d != bytes(width, disparities) {
            return Err(Failure::new(format!("{what}: no sum of products at {width}x{disparities}")));
        }
    }
    Ok(format!(
        "/**\n * Bytes that are enough for {what}, on any target. `disparities` is a \
         multiple of 16, and\n * `width` at least as large, as the library was built with.\n */\n#define \
         STEREOPSIS_{name}_BYTES(width, disparities) \\\n  ((size_t){fixed} + (size_t){by_w} * (width) + \
         (size_t){by_d} * (disparities) + \\\n   (size_t){both} * (width) * (disparities))\n"
    ))
}

/// The macro of a rectifier's bytes.
const RECTIFIER_BYTES: &str = "/**
 * Bytes that are enough for a rectifier, on any target, with the library's longest line, the rows of its
 * largest rectified image, and the raw lines of each camera that it holds.
 */
#define STEREOPSIS_RECTIFIER_BYTES(width, height, lines) \\
  ((size_t)80 + (size_t)(lines) + (size_t)2 * (width) * ((size_t)(lines) + 1) + \\
   (size_t)16 * ((((size_t)(width) + 15) / 16 + 3) * (((size_t)(height) + 15) / 16 + 3) + \\
                 ((size_t)(height) + 1) / 2))
";

/// The macro of a line queue's bytes.
const LINE_QUEUE_BYTES: &str = "/**
 * Bytes that are enough for a queue of `slots` lines of `line_bytes` bytes, on any target.
 */
#define STEREOPSIS_LINE_QUEUE_BYTES(line_bytes, slots) \\
  ((size_t)48 + (size_t)(slots) * (((size_t)(line_bytes) + 7) / 8 * 8 + 32))
";

/// How many bytes a line queue takes, as a macro.
fn line_queue_macro() -> Outcome<String> {
    for (line_bytes, slots) in [(1_usize, 2), (160, 4), (333, 7), (65535, 100)] {
        let expected = 48 + slots * (line_bytes.next_multiple_of(8) + 32);
        if expected != line_queue_bytes(line_bytes, slots) {
            return Err(Failure::new("line_queue_bytes is not what STEREOPSIS_LINE_QUEUE_BYTES says"));
        }
    }
    Ok(LINE_QUEUE_BYTES.to_owned())
}

/// How many bytes a rectifier takes, as a macro.
fn rectifier_macro() -> Outcome<String> {
    let expected = |width: usize, height: usize, lines: usize| {
        let lattice = (width.div_ceil(16) + 3) * (height.div_ceil(16) + 3);
        80 + 16 * (lattice + height.div_ceil(2)) + 2 * width * (lines + 1) + lines
    };
    for (width, height, lines) in [(16, 2, 3), (160, 120, 33), (333, 241, 40), (4096, 4096, 4097)] {
        if expected(width, height, lines) != rectifier_bytes(width, height, lines) {
            return Err(Failure::new("rectifier_bytes is not what STEREOPSIS_RECTIFIER_BYTES says"));
        }
    }
    Ok(RECTIFIER_BYTES.to_owned())
}

/// How many bytes a detector of features takes, as a macro.
fn detector_macro() -> String {
    let fixed = detector_bytes(0, 0);
    let (line, slot) = (detector_bytes(1, 0) - fixed, detector_bytes(0, 1) - fixed);
    [
        "/**",
        " * Bytes that are enough for a detector of features, on any target, for lines of up to `width`",
        " * pixels and `slots` corners of a row of cells.",
        " */",
        "#define STEREOPSIS_DETECTOR_BYTES(width, slots) \\",
        &format!("  ((size_t){fixed} + (size_t){line} * (width) + (size_t){slot} * (slots))"),
        "",
    ]
    .join("\n")
}

/// How many bytes a focus map takes, as a macro.
fn focus_macro() -> String {
    let fixed = focus_bytes(0, 0, 0);
    let [line, column, cell] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        .map(|[width, columns, cells]| focus_bytes(width, columns, cells) - fixed);
    [
        "/**",
        " * Bytes that are enough for a focus map, on any target, for lines of up to `width` pixels, rows of",
        " * up to `columns` cells, and frames of up to `cells` cells.",
        " */",
        "#define STEREOPSIS_FOCUS_BYTES(width, columns, cells) \\",
        &format!("  ((size_t){fixed} + (size_t){line} * (width) + \\"),
        &format!("   (size_t){column} * (columns) + (size_t){cell} * (cells))"),
        "",
    ]
    .join("\n")
}

/// How many bytes an odometry takes, as a macro.
fn odometry_macro() -> String {
    let fixed = odometry_bytes(0);
    let point = odometry_bytes(1) - fixed;
    [
        "/**",
        " * Bytes that are enough for an odometry that follows up to `points` points, on any target.",
        " */",
        &format!("#define STEREOPSIS_ODOMETRY_BYTES(points) ((size_t){fixed} + (size_t){point} * (points))"),
        "",
    ]
    .join("\n")
}

/// How many bytes a finder of obstacles takes, as a macro.
fn obstacles_macro() -> String {
    let fixed = obstacles_bytes(0, 0);
    let [column, row] = [[1, 0], [0, 1]].map(|[columns, rows]| obstacles_bytes(columns, rows) - fixed);
    let cell = obstacles_bytes(1, 1) - fixed - column - row;
    [
        "/**",
        " * Bytes that are enough for a finder of obstacles, on any target, in frames of up to `columns`",
        " * columns and `rows` rows of cells.",
        " */",
        "#define STEREOPSIS_OBSTACLES_BYTES(columns, rows) \\",
        &format!("  ((size_t){fixed} + (size_t){column} * (columns) + (size_t){row} * (rows) + \\"),
        &format!("   (size_t){cell} * (columns) * (rows))"),
        "",
    ]
    .join("\n")
}
