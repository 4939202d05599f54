//! The file's numbers, one after the other.

use super::{BalError, BalFault, BalProblem, view};
use crate::{command_line, limits};
use nalgebra::{Point2, Point3};
use std::path::Path;
use stereopsis::motion::bundle::Observation;

/// Cameras at most: an observation names one in 16 bits.
const MOST_CAMERAS: usize = 1 << 16;
/// Points and observations at most.
const MOST: usize = 1 << 30;
/// What compressed files begin with, and what unpacks them.
const PACKED: [(&[u8], &str); 4] =
    [(b"BZh", "bunzip2"), (b"\x1f\x8b", "gunzip"), (b"\xfd7zXZ", "unxz"), (b"PK\x03\x04", "unzip")];

/// Reads the problem in the file at `path`.
pub fn read_problem(path: &Path) -> Result<BalProblem, BalError> {
    let fault = |fault| BalError { path: path.into(), fault };
    let bytes = limits::read(path, limits::PROBLEM_BYTES).map_err(|e| fault(BalFault::Read(e)))?;
    if let Some((_, tool)) = PACKED.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return Err(fault(BalFault::Compressed(tool)));
    }
    let text = String::from_utf8(bytes).ok().filter(|text| !text.contains('\0'));
    let text = text.ok_or_else(|| fault(BalFault::Binary))?;
    parse(&text).map_err(fault)
}

/// The words of a text, and on which lines they stand.
struct Words<'a, I: Iterator<Item = (usize, &'a str)>> {
    words: I,
    read: usize,
    /// Cameras, points and observations.
    counts: [usize; 3],
}

impl<'a, I: Iterator<Item = (usize, &'a str)>> Words<'a, I> {
    fn next(&mut self, what: impl FnOnce() -> String) -> Result<(usize, &'a str), BalFault> {
        let Some(word) = self.words.next() else {
            let [cameras, points, observations] = self.counts;
            let needed = 3 + 4 * observations + 9 * cameras + 3 * points;
            let found = self.read;
            return Err(BalFault::TooFew { what: what(), cameras, points, observations, needed, found });
        };
        self.read += 1;
        Ok(word)
    }

    /// A whole number.
    fn whole(&mut self, what: impl Fn() -> String, least: usize, most: usize) -> Result<usize, BalFault> {
        let (line, word) = self.next(&what)?;
        let value = word.parse().ok().filter(|value| (least..=most).contains(value));
        value.ok_or_else(|| BalFault::Whole {
            line,
            what: what(),
            found: command_line::word(word),
            least,
            most,
        })
    }

    fn number(&mut self, what: impl Fn() -> String) -> Result<f64, BalFault> {
        let (line, word) = self.next(&what)?;
        let value = word.parse().ok().filter(|value: &f64| value.is_finite());
        value.ok_or_else(|| BalFault::NotANumber { line, what: what(), found: command_line::word(word) })
    }

    fn numbers<const N: usize>(&mut self, what: impl Fn() -> String) -> Result<[f64; N], BalFault> {
        let mut numbers = [0.0; N];
        for (k, number) in numbers.iter_mut().enumerate() {
            *number = self.number(|| format!("number {} of {}", k + 1, what()))?;
        }
        Ok(numbers)
    }
}

fn parse(text: &str) -> Result<BalProblem, BalFault> {
    if text.trim().is_empty() {
        return Err(BalFault::Empty);
    }
    let words =
        text.lines().zip(1..).flat_map(|(line, n)| line.split_ascii_whitespace().map(move |word| (n, word)));
    let mut words = Words { words, read: 0, counts: [0; 3] };
    let names = ["the number of cameras", "the number of points", "the number of observations"];
    for ((k, name), most) in names.iter().enumerate().zip([MOST_CAMERAS, MOST, MOST]) {
        words.counts[k] = words.whole(|| (*name).to_owned(), 1, most)?;
    }
    let [cameras, points, observations] = words.counts;
    let mut read = Vec::new();
    for n in 0..observations {
        let view = words.whole(|| format!("the camera of observation {n}"), 0, cameras - 1)?;
        let point = words.whole(|| format!("the point of observation {n}"), 0, points - 1)?;
        let [x, y] = words.numbers(|| format!("observation {n}"))?;
        read.push(Observation { point: point as u32, view: view as u16, eye: 0, pixel: Point2::new(x, -y) });
    }
    let views =
        (0..cameras).map(|n| words.numbers(|| format!("camera {n}")).map(view)).collect::<Result<_, _>>()?;
    let places = (0..points).map(|n| words.numbers::<3>(|| format!("point {n}")).map(Point3::from));
    let places = places.collect::<Result<_, _>>()?;
    if let Some((line, found)) = words.words.next() {
        return Err(BalFault::TooMany {
            line,
            found: command_line::word(found),
            cameras,
            points,
            observations,
        });
    }
    Ok(BalProblem::new(views, places, &read))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: &str = "1 1 1\n0 0 -385.99 387.12\n0.1 0.2 0.3\n1 2 3\n500 1e-7 0\n0.5 0.6 -7\n";

    fn fault(text: &str) -> String {
        parse(text).expect_err(text).to_string()
    }

    #[test]
    fn what_is_read_is_written() {
        let problem = parse(SMALL).expect("a problem");
        let mut written = Vec::new();
        problem.write(&mut written).expect("to memory");
        let again = parse(&String::from_utf8(written).expect("text")).expect("a problem");
        assert_eq!(again.observations, problem.observations);
        assert_eq!(again.points, problem.points);
        let off = again.views[0].pose.translation() - problem.views[0].pose.translation();
        assert!(off.amax() < 1e-14, "{off}");
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (from, to, said) in [
            ("1 1 1\n", "0 1 1\n", "line 1: '0' is not the number of cameras; a whole number from 1"),
            ("1 1 1\n", "1 1 2\n", "line 3: '0.1' is not the camera of observation 1"),
            (
                "\n0 0 ",
                "\n0 1 ",
                "line 2: '1' is not the point of observation 0; a whole number from 0 to 0 is needed",
            ),
            ("\n0 0 ", "\n-1 0 ", "line 2: '-1' is not the camera of observation 0"),
            ("387.12", "nan", "line 2: number 2 of observation 0: 'nan' is not a finite number"),
            ("500", "5oo", "line 5: number 7 of camera 0: '5oo'"),
            (
                " -7",
                "",
                "ends where number 3 of point 0 is due; 1 cameras, 1 points and 1 observations need 19 \
                 numbers, and it has 18",
            ),
            (" -7", " -7 8", "line 6: '8' stands behind the last point"),
            (SMALL, " \n", "the file is empty"),
            (SMALL, "1 1", "ends where the number of observations is due"),
        ] {
            let text = SMALL.replace(from, to);
            assert!(fault(&text).contains(said), "{text}: {}", fault(&text));
        }
    }
}
