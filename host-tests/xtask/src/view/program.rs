//! The live page beside the program `stereo`: the same command, the same bits.

use super::page::{LivePage, failed, numbers};
use crate::steps::{Failure, Outcome, output_of};
use std::path::Path;
use std::process::Command;

/// Runs the command line that the page says in the folder of its files, and compares: disparities, flags and
/// confidences, and depths where there are some, are equal to the bit.
pub fn as_the_program(page: &mut LivePage, stereo: &Path, folder: &Path) -> Outcome {
    page.press("copy-command")?;
    let command = page.browser.value("byId('copied').value")?;
    let command = command.as_str().unwrap_or_default();
    run_said(stereo, command, folder)?;
    let out = folder.join("depth");
    let differs = |what: &str| Failure::new(format!("{what} of the page differ from those of {command}"));

    let map = numbers(&out.join("disparity.pfm"))?;
    let found = page.plane("disparity")?;
    let found = found.as_chunks().0.iter().map(|raw| match u16::from_le_bytes(*raw) {
        u16::MAX => f32::INFINITY,
        raw => f32::from(raw) / 32.0,
    });
    if !found.eq(map.values.iter().copied()) {
        return Err(differs("disparities"));
    }
    for (plane, file) in [("flags", "flags.png"), ("confidence", "confidence.png")] {
        let path = out.join(file);
        let image = image::open(&path).map_err(|e| failed(&path, &e))?.into_luma8();
        if page.plane(plane)? != image.into_raw() {
            return Err(differs(plane));
        }
    }
    let path = out.join("depth.png");
    if path.is_file() {
        let image = image::open(&path).map_err(|e| failed(&path, &e))?.into_luma16();
        // Beyond its largest number of millimetres the core has none, and the file has that number.
        let of_core = |mm: u16| if mm == u16::MAX { 0 } else { mm };
        let depths: Vec<_> = image.into_raw().into_iter().map(of_core).flat_map(u16::to_le_bytes).collect();
        if page.plane("depth")? != depths {
            return Err(differs("depths"));
        }
    }
    println!("as {}", command.replace(" \\\n ", ""));
    Ok(())
}

/// Runs a command line of `stereo` in a folder; what it prints.
pub fn run_said(stereo: &Path, command: &str, folder: &Path) -> Outcome<String> {
    let words = command.replacen("stereo ", "\"$0\" ", 1);
    let mut run = Command::new("sh");
    run.args(["-c", &words]).arg(stereo).current_dir(folder);
    output_of(&mut run)
}
