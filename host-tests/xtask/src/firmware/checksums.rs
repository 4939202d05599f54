//! Real pictures: the same checksum on every core, on the host, and from the example in C.

use super::frame;
use super::measured::{Checksum, Measured};
use super::program::{Built, Program};
use crate::c;
use crate::pictures::Pictures;
use crate::steps::{Failure, Outcome};
use std::collections::BTreeMap;
use std::path::PathBuf;
use stereopsis_host::run::MethodName;

/// Pairs of the folder of real pictures.
const PAIRS: [&str; 3] = ["cones", "venus", "mb2014q_Motorcycle"];

/// The real pairs by name; none without STEREO_DATA.
pub fn pairs() -> Outcome<Vec<(String, Pictures)>> {
    let Some(data) = std::env::var_os("STEREO_DATA").map(PathBuf::from) else { return Ok(Vec::new()) };
    let open = |name: &str| {
        let folder = data.join("stereo").join(name);
        Ok((name.to_owned(), Pictures::open(&folder.join("left.png"), &folder.join("right.png"))?))
    };
    PAIRS.into_iter().map(open).collect()
}

/// A program on all pairs, scaled to its size. Every run is compared with the host's.
pub fn on_core(built: &Built, pairs: &[(String, Pictures)]) -> Outcome<Vec<Checksum>> {
    let Program { width, height, .. } = built.program;
    let one = |(name, pair): &(String, Pictures)| {
        let frame = frame::run(built, &pair.scaled(width, height)?, false)?;
        Ok(Checksum { pair: name.clone(), crc32: frame.crc32 })
    };
    pairs.iter().map(one).collect()
}

/// Prints the checksums, a column for each core, the host and the example in C, and fails when a row has two.
pub fn compare(results: &[Measured], pairs: &[(String, Pictures)], in_c: c::Scope) -> Outcome {
    let mut rows: BTreeMap<_, Vec<(String, u32)>> = BTreeMap::new();
    for result in results {
        let Program { board, method, width, height, disparities, .. } = result.frame.program;
        for Checksum { pair, crc32 } in &result.checksums {
            let row = rows.entry((pair, method.name(), width, height, disparities)).or_default();
            row.push((board.core.to_owned(), *crc32));
        }
    }
    let scaled = |&(pair, method, width, height, disparities): &(&String, &str, u16, u16, u16)| {
        let of =
            pairs.iter().find(|(name, _)| name == pair).map(|(_, pictures)| pictures.scaled(width, height));
        let pictures = of.ok_or_else(|| Failure::new(format!("{pair}: no such pair")))??;
        let method: MethodName = method.parse().map_err(|e| Failure::new(format!("{e}")))?;
        Ok((pictures, method, disparities))
    };
    let frames = rows.keys().map(scaled).collect::<Outcome<Vec<_>>>()?;
    let runs: Vec<_> =
        frames.iter().map(|(pictures, method, disparities)| (pictures, *method, *disparities)).collect();
    let in_c = c::crc32s(&runs, in_c)?;
    for ((row, &(pictures, method, disparities)), in_c) in rows.values_mut().zip(&runs).zip(in_c) {
        row.push(("host".to_owned(), pictures.crc32(method, disparities)?));
        // The example in C has to say what the cores say.
        row.extend(in_c.into_iter().map(|(core, crc32)| (format!("C, {core}"), crc32)));
    }
    // Not every size is on every core.
    let longest = rows.values().max_by_key(|row| row.len());
    let columns: Vec<&str> = longest.into_iter().flatten().map(|(name, _)| name.as_str()).collect();
    println!("CRC-32 of disparities and flags:\n");
    println!("| pair | method | pixels | disparities | {} |", columns.join(" | "));
    println!("| --- | --- | --- | ---: |{}", " --- |".repeat(columns.len()));
    for ((pair, method, width, height, disparities), row) in &rows {
        let on = |column: &&str| row.iter().find(|(name, _)| name == column);
        let cell = |column| on(column).map_or("  |".to_owned(), |(_, crc32)| format!(" `{crc32:08x}` |"));
        let cells: String = columns.iter().map(cell).collect();
        println!("| {pair} | `{method}` | {width}x{height} | {disparities} |{cells}");
    }
    println!();
    let differs = |row: &[(String, u32)]| row.windows(2).any(|two| two[0].1 != two[1].1);
    match rows.iter().find(|(_, row)| differs(row)) {
        Some(((pair, method, ..), row)) => {
            Err(Failure::new(format!("{pair}, {method}: the checksums differ: {row:x?}")))
        }
        None => Ok(()),
    }
}
