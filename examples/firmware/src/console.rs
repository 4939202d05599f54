//! Figures as text on the host's console: a name and a number a line. `core::fmt` would be half of the flash.

use crate::host::HostFile;

/// The host's console.
pub struct Console(Option<HostFile>);

/// Digits of the largest number.
const DIGITS: usize = 20;
/// What a one is worth in each of them.
const POWERS: &[u64; DIGITS] = &{
    let mut powers = [1; DIGITS];
    let mut digit = DIGITS - 1;
    while digit > 0 {
        powers[digit - 1] = powers[digit] * 10;
        digit -= 1;
    }
    powers
};

impl Console {
    /// The console; one that swallows everything when the host has none.
    pub fn open() -> Self {
        Self(HostFile::console().ok())
    }

    /// A line: the name, a blank, the number.
    pub fn figure(&mut self, name: &str, number: u64) {
        // Powers of ten are taken away: a 32-bit core's division of 64 bits is a kilobyte of flash.
        let mut digits = [b'0'; DIGITS];
        let mut rest = number;
        for (digit, &power) in digits.iter_mut().zip(POWERS) {
            // No more than nine times: of a loop without an end the compiler makes a division again.
            for _ in 0..9 {
                if rest >= power {
                    (rest, *digit) = (rest - power, *digit + 1);
                }
            }
        }
        let zeros = digits.iter().take(DIGITS - 1).take_while(|&&digit| digit == b'0').count();
        self.text(name);
        self.text(" ");
        self.bytes(digits.get(zeros..).unwrap_or_default());
        self.text("\n");
    }

    /// Text as it is.
    pub fn text(&mut self, text: &str) {
        self.bytes(text.as_bytes());
    }

    fn bytes(&mut self, bytes: &[u8]) {
        if let Some(out) = &self.0 {
            // Nobody is there to be told when the console fails.
            let _ = out.write(bytes);
        }
    }
}
