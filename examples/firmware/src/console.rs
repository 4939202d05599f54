//! Figures as text on the host's console: a name and a number a line. `core::fmt` would be half of the flash.

use crate::host::HostFile;

/// The host's console.
pub struct Console(Option<HostFile>);

/// Digits of the largest number.
const DIGITS: usize = 20;

impl Console {
    /// The console; one that swallows everything when the host has none.
    pub fn open() -> Self {
        Self(HostFile::console().ok())
    }

    /// A line: the name, a blank, the number.
    pub fn figure(&mut self, name: &str, number: u64) {
        let mut digits = [b'0'; DIGITS];
        let mut rest = number;
        let mut count = 0;
        for digit in digits.iter_mut().rev() {
            *digit = b'0' + (rest % 10) as u8;
            rest /= 10;
            count += 1;
            if rest == 0 {
                break;
            }
        }
        self.text(name);
        self.text(" ");
        self.bytes(digits.get(DIGITS.saturating_sub(count)..).unwrap_or_default());
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
