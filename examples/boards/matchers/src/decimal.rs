//! Numbers as text, without the formatting of the standard library, which takes flash and can panic.

/// The digits of a number, and what follows them.
pub struct Decimal {
    text: [u8; 11],
    first: usize,
}

impl Decimal {
    /// Makes the digits of a number.
    pub fn new(mut number: u32, end: u8) -> Self {
        let (mut text, mut first) = ([end; 11], 10);
        for (at, digit) in text.iter_mut().enumerate().rev().skip(1) {
            (*digit, number, first) = (b'0' + (number % 10) as u8, number / 10, at);
            if number == 0 {
                break;
            }
        }
        Self { text, first }
    }

    /// Returns the text.
    pub fn bytes(&self) -> &[u8] {
        self.text.get(self.first..).unwrap_or_default()
    }
}
