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
        // Doubled with every bit, digit by digit: a 32-bit core's division of 64 bits is a kilobyte of flash.
        let (mut digits, mut rest) = ([b'0'; DIGITS], number);
        for _ in 0..u64::BITS {
            keep_loop();
            // Of a number of digits that the compiler does not know: else it unrolls all twenty.
            double(core::hint::black_box(digits.as_mut_slice()), (rest >> (u64::BITS - 1)) as u8);
            rest <<= 1;
        }
        let mut zeros = 0;
        while zeros < DIGITS - 1 && digits.get(zeros) == Some(&b'0') {
            keep_loop();
            zeros += 1;
        }
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

/// Doubles a decimal number, and adds to its last digit.
#[inline(never)]
fn double(digits: &mut [u8], more: u8) {
    let mut carry = more;
    for digit in digits.iter_mut().rev() {
        keep_loop();
        let twice = 2 * (*digit - b'0') + carry;
        carry = u8::from(twice >= 10);
        *digit = b'0' + twice - 10 * carry;
    }
}

/// In the body of a loop: no instruction, so that the loop is not unrolled, which would take flash.
#[inline(always)]
fn keep_loop() {
    core::hint::black_box(());
}
