//! Square binary markers by number: the predefined dictionaries of OpenCV (Garrido-Jurado et al. 2014).

/// A dictionary of markers of `side` by `side` bits.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Dictionary {
    side: usize,
    /// The bits of each marker, row by row from the highest one, 1 is white.
    codes: Vec<u64>,
}

/// Bits along a marker, and the codes of the largest dictionary of that size.
const CODES: [(usize, &str); 4] = [
    (4, include_str!("dictionaries/4x4.txt")),
    (5, include_str!("dictionaries/5x5.txt")),
    (6, include_str!("dictionaries/6x6.txt")),
    (7, include_str!("dictionaries/7x7.txt")),
];
/// The sizes of dictionaries.
const COUNTS: [usize; 4] = [50, 100, 250, 1000];
/// Bits that may be wrong in a marker that is taken for the nearest one.
const MOST_WRONG: u32 = 1;

/// A marker that was recognised.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Marker {
    /// Its number in the dictionary.
    pub number: usize,
    /// The quarter turns, clockwise, that bring what was seen upright.
    pub turns: u8,
    /// Bits that were wrong.
    pub wrong: u32,
}

impl Dictionary {
    /// The dictionary with OpenCV's name, such as `4x4_50` or `DICT_4X4_50`: 4 to 7 bits along a side, and
    /// 50, 100, 250 or 1000 markers; `None` of another name.
    pub fn named(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let (sides, count) = name.strip_prefix("dict_").unwrap_or(&name).split_once('_')?;
        let count: usize = count.parse().ok().filter(|count| COUNTS.contains(count))?;
        let &(side, text) = CODES.iter().find(|(side, _)| sides == format!("{side}x{side}"))?;
        let words = text.lines().filter(|line| !line.starts_with('#')).flat_map(str::split_whitespace);
        let codes =
            words.take(count).map(|word| u64::from_str_radix(word, 16).ok()).collect::<Option<_>>()?;
        Some(Self { side, codes })
    }

    /// Bits along a side, without the black border of one bit.
    pub fn side(&self) -> usize {
        self.side
    }

    /// How many markers it has.
    pub fn len(&self) -> usize {
        self.codes.len()
    }

    /// Whether it has no marker.
    pub fn is_empty(&self) -> bool {
        self.codes.is_empty()
    }

    /// Whether a bit of a marker is white; `false` outside of it.
    pub fn is_white(&self, number: usize, column: usize, row: usize) -> bool {
        let inside = column < self.side && row < self.side;
        let bit = self.side * self.side - 1 - (row * self.side + column).min(self.side * self.side - 1);
        inside && self.codes.get(number).is_some_and(|code| code >> bit & 1 == 1)
    }

    /// The marker whose bits are most like `code`, in any of four turns, with at most one bit wrong.
    pub fn recognise(&self, code: u64) -> Option<Marker> {
        let mut turned = code;
        let mut best: Option<Marker> = None;
        for turns in 0..4 {
            for (number, marker) in self.codes.iter().enumerate() {
                let wrong = (marker ^ turned).count_ones();
                if wrong <= MOST_WRONG && best.is_none_or(|best| wrong < best.wrong) {
                    best = Some(Marker { number, turns, wrong });
                }
            }
            turned = self.turned(turned);
        }
        best
    }

    /// The bits turned clockwise by a quarter.
    fn turned(&self, code: u64) -> u64 {
        let n = self.side;
        let at = |row: usize, column: usize| code >> (n * n - 1 - (row * n + column)) & 1;
        let places = (0..n).flat_map(|row| (0..n).map(move |column| (row, column)));
        places.fold(0, |bits, (row, column)| bits << 1 | at(n - 1 - column, row))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_marker_of_4x4_is_as_published() {
        let dictionary = Dictionary::named("DICT_4X4_50").expect("a dictionary");
        let rows = [[1, 0, 1, 1], [0, 1, 0, 1], [0, 0, 1, 1], [0, 0, 1, 0]];
        for (row, bits) in rows.iter().enumerate() {
            for (column, &bit) in bits.iter().enumerate() {
                assert_eq!(dictionary.is_white(0, column, row), bit == 1);
            }
        }
        assert_eq!((dictionary.side(), dictionary.len()), (4, 50));
        // Upright, with a wrong bit, and as it is seen after three quarter turns.
        let marker = |turns, wrong| Some(Marker { number: 0, turns, wrong });
        assert_eq!(dictionary.recognise(0b1011_0101_0011_0010), marker(0, 0));
        assert_eq!(dictionary.recognise(0b1011_0101_0011_0011), marker(0, 1));
        let mut turned = 0b1011_0101_0011_0010;
        (0..3).for_each(|_| turned = dictionary.turned(turned));
        assert_eq!(dictionary.recognise(turned), marker(1, 0));
    }

    #[test]
    fn every_marker_is_itself_alone() {
        for name in ["4x4_50", "5x5_250", "6x6_250", "7x7_100"] {
            let dictionary = Dictionary::named(name).expect("a dictionary");
            for (number, &code) in dictionary.codes.iter().enumerate() {
                assert_eq!(dictionary.recognise(code), Some(Marker { number, turns: 0, wrong: 0 }), "{name}");
            }
        }
        for name in ["3x3_50", "4x4_60", "4x5_50", "4x4", "apriltag_36h11", ""] {
            assert_eq!(Dictionary::named(name), None, "{name}");
        }
    }
}
