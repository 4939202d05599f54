//! What firmware was measured to take, from the tables that `cargo xtask firmware --all` and `cargo xtask
//! growth` write.
//!
//! The tables of `docs/performance.md` are the data themselves: what the page says and what is estimated from
//! it cannot differ. Columns are found by their headings.

use crate::method::MethodName;

/// The page with the tables.
const PAGE: &str = include_str!("../../../../docs/performance.md");
/// The headings of the columns that are read.
const FIRMWARE: [&str; 8] =
    ["core", "method", "pixels", "disparities", "instructions", "static RAM", "stack", "flash"];
const GROWTH: [&str; 2] = ["what grows", "pixels, disparities"];

/// One program on one core, as it was measured.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Measured {
    /// The core's short name.
    pub core: &'static str,
    /// The method.
    pub method: MethodName,
    /// Columns of the images.
    pub width: u16,
    /// How many disparities were searched.
    pub disparities: u16,
    /// Instructions for a pixel, all its disparities together.
    pub per_pixel: f64,
    /// Bytes of static RAM of the whole program, of which the pipeline is nearly all.
    pub ram_bytes: u32,
    /// Bytes of stack that were in use.
    pub stack_bytes: u32,
    /// Bytes of flash of the whole program.
    pub flash_bytes: u32,
}

/// How the work for a pixel grows with the disparities.
#[derive(Clone, PartialEq, Debug)]
pub struct Growth {
    /// The core's short name.
    pub core: &'static str,
    /// The method.
    pub method: MethodName,
    /// Disparities and instructions for a pixel, in ascending order.
    pub points: Vec<(u16, f64)>,
}

/// The cells of the first table that has these headings, whose places are those of the headings; then all
/// headings.
fn table(headings: &[&str]) -> Option<(Vec<Vec<&'static str>>, Vec<&'static str>)> {
    let cells = |line: &'static str| -> Vec<&'static str> {
        let inner = line.trim().trim_matches('|');
        inner.split('|').map(str::trim).collect()
    };
    let is_head = |line: &&str| line.starts_with('|') && headings.iter().all(|&name| cells_have(line, name));
    let at = PAGE.lines().position(|line| is_head(&line))?;
    let head = cells(PAGE.lines().nth(at)?);
    let rows = PAGE.lines().skip(at + 2).take_while(|line| line.starts_with('|')).map(cells);
    Some((rows.filter(|row| row.len() == head.len()).collect(), head))
}

fn cells_have(line: &str, name: &str) -> bool {
    line.trim().trim_matches('|').split('|').any(|cell| cell.trim() == name)
}

fn method(cell: &str) -> Option<MethodName> {
    cell.trim_matches('`').parse().ok()
}

/// All programs of the table, in its order.
pub fn firmware() -> Vec<Measured> {
    let Some((rows, head)) = table(&FIRMWARE) else { return Vec::new() };
    let read = |row: Vec<&'static str>| {
        let cell = |name: &str| head.iter().position(|&heading| heading == name).map(|at| row[at]);
        let (width, height) = cell("pixels")?.split_once('x')?;
        let (width, height): (u16, u16) = (width.parse().ok()?, height.parse().ok()?);
        let pixels = f64::from(width) * f64::from(height);
        Some(Measured {
            core: cell("core")?,
            method: method(cell("method")?)?,
            width,
            disparities: cell("disparities")?.parse().ok()?,
            per_pixel: cell("instructions")?.parse::<f64>().ok()? / pixels,
            ram_bytes: cell("static RAM")?.parse().ok()?,
            stack_bytes: cell("stack")?.parse().ok()?,
            flash_bytes: cell("flash")?.parse().ok()?,
        })
    };
    rows.into_iter().filter_map(read).collect()
}

/// How the work grows, for the cores and methods that were measured.
pub fn growth() -> Vec<Growth> {
    let Some((rows, head)) = table(&GROWTH) else { return Vec::new() };
    let columns = head.iter().enumerate().skip(GROWTH.len());
    let read = |(at, heading): (usize, &&'static str)| {
        let (core, name) = heading.split_once(' ')?;
        let points = rows.iter().filter(|row| row[0] == "disparities").filter_map(|row| {
            let disparities: u16 = row[1].rsplit(", ").next()?.parse().ok()?;
            Some((disparities, f64::from(disparities) * row[at].parse::<f64>().ok()?))
        });
        Some(Growth { core, method: method(name)?, points: points.collect() })
    };
    columns.filter_map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_of_the_table_is_read() {
        let all = firmware();
        let lines = PAGE.lines().skip_while(|line| !line.starts_with("| core | method | pixels |"));
        let lines = lines.skip(2).take_while(|line| line.starts_with('|')).collect::<Vec<_>>();
        assert!(lines.len() > 60 && all.len() == lines.len(), "{} of {} lines", all.len(), lines.len());
        for (measured, line) in all.iter().zip(lines) {
            let begin = format!("| {} | `{}` | ", measured.core, measured.method);
            assert!(line.starts_with(&begin), "{line}");
            assert!(
                line.contains(&format!(" | {} | {} | ", measured.ram_bytes, measured.stack_bytes)),
                "{line}"
            );
            assert!(line.contains(&format!(" | {} | ", measured.flash_bytes)), "{line}");
        }
    }

    #[test]
    fn the_growth_of_two_methods_on_two_cores_is_read() {
        let all = growth();
        let found: Vec<_> = all.iter().map(|growth| (growth.core, growth.method.name())).collect();
        assert_eq!(found, [("m4", "block"), ("m4", "sgm"), ("m55", "block"), ("m55", "sgm")]);
        for growth in all {
            assert!(growth.points.len() >= 5 && growth.points.is_sorted(), "{growth:?}");
        }
    }
}
