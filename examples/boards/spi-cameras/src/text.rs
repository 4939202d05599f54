//! What the boards say on their UART.

/// Bytes of the longest line.
pub const LONGEST: usize = 32;

/// A frame: its number and its nearest distance, millimetres: `12 524`.
pub fn frame(sequence: u32, nearest_mm: u16) -> impl Iterator<Item = u8> {
    decimal(sequence).chain(*b" ").chain(decimal(nearest_mm.into())).chain(*b"\n")
}

/// A fault, by the words of [`FrameError`](crate::frames::FrameError::words): `left unknown 66`.
pub fn fault((at, what, number): (&'static str, &'static str, u32)) -> impl Iterator<Item = u8> {
    at.bytes().chain(*b" ").chain(what.bytes()).chain(*b" ").chain(decimal(number)).chain(*b"\n")
}

/// The digits of a number.
fn decimal(number: u32) -> impl Iterator<Item = u8> {
    let powers = (0..10).rev().map(|power| 10_u32.pow(power));
    let powers = powers.filter(move |&power| power == 1 || power <= number);
    powers.map(move |power| b'0' + (number / power % 10) as u8)
}
