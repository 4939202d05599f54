//! Pixel formats, streams of two cameras and mirrored lines, against naive twins.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, Interleaved, LineFault, LineFormat, LineSource, LineStart, Mirrored,
    PixelFormat, SideBySide, StereoSource, StreamError,
};
use stereopsis::imaging::{BayerLines, GreyLines};

/// A camera over bytes in memory, one frame, in which the lines of `missing` are lost without a word.
pub struct Memory {
    format: LineFormat,
    bytes: Vec<u8>,
    missing: Vec<u16>,
    row: u16,
}

impl Memory {
    pub fn new(width: u16, height: u16, pixel: PixelFormat, bytes: Vec<u8>) -> Self {
        let format = LineFormat { width, height, pixel };
        assert_eq!(bytes.len(), format.line_bytes() * usize::from(height));
        Self { format, bytes, missing: Vec::new(), row: height }
    }

    pub fn without(self, missing: &[u16]) -> Self {
        Self { missing: missing.to_vec(), ..self }
    }
}

impl ErrorType for Memory {
    type Error = core::convert::Infallible;
}

impl LineSource for Memory {
    fn format(&self) -> LineFormat {
        self.format
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        self.row = 0;
        Ok(FrameStart { sequence: 9, timestamp_us: 70, exposure_us: 5 })
    }

    fn next_line(&mut self, line: &mut [u8]) -> Result<LineStart, CameraError<Self::Error>> {
        while self.missing.contains(&self.row) {
            self.row += 1;
        }
        if self.row >= self.format.height {
            return Err(CameraError::NoLineLeft);
        }
        let needed = self.format.line_bytes();
        let Some(line) = line.get_mut(..needed) else { return Err(CameraError::BufferTooShort { needed }) };
        line.copy_from_slice(&self.bytes[usize::from(self.row) * needed..][..needed]);
        self.row += 1;
        Ok(LineStart { row: self.row - 1, timestamp_us: 70 + u64::from(self.row) })
    }
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(11),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// One line through [`GreyLines`].
fn grey(width: u16, pixel: PixelFormat, bytes: Vec<u8>) -> Vec<u8> {
    let mut lines =
        GreyLines::<_, 512>::new(Memory::new(width, 1, pixel, bytes)).expect("512 bytes are enough");
    lines.start_frame().expect("memory");
    let mut out = vec![0xa5; usize::from(width) + 2];
    lines.next_line(&mut out).expect("a line");
    assert_eq!(out.split_off(usize::from(width)), [0xa5; 2]);
    out
}

/// Bits of a stream, the first pixel's first.
fn luma(r: u32, g: u32, b: u32) -> u8 {
    ((4899 * r + 9617 * g + 1868 * b + 8192) / 16384) as u8
}

proptest! {
    #![proptest_config(config(300))]

    /// Each format is packed from samples by arithmetic on whole numbers, and comes back as their top eight
    /// bits.
    #[test]
    fn samples_that_are_packed_come_back(samples in proptest::collection::vec(0u16..1024, 1..70)) {
        let width = samples.len() as u16;
        let top: Vec<u8> = samples.iter().map(|s| (s / 4) as u8).collect();
        let padded = |n: usize| { let mut s = samples.clone(); s.resize(s.len().next_multiple_of(n), 0); s };

        let ten: Vec<u8> = padded(4).chunks(4).flat_map(|p| {
            let low = (0..4).map(|i| (p[i] % 4) << (2 * i)).sum::<u16>();
            [p[0] / 4, p[1] / 4, p[2] / 4, p[3] / 4, low].map(|b| b as u8)
        }).collect();
        prop_assert_eq!(grey(width, PixelFormat::Grey10Packed, ten), top.clone());

        let twelve: Vec<u8> = padded(2).chunks(2).flat_map(|p| {
            let [a, b] = [p[0] * 4 + 3, p[1] * 4 + 1];
            [a / 16, b / 16, a % 16 + b % 16 * 16].map(|b| b as u8)
        }).collect();
        prop_assert_eq!(grey(width, PixelFormat::Grey12Packed, twelve), top.clone());

        let yuyv: Vec<u8> = padded(2).iter().flat_map(|s| [(s / 4) as u8, (s % 256) as u8]).collect();
        prop_assert_eq!(grey(width, PixelFormat::Yuyv, yuyv), top.clone());
        let uyvy: Vec<u8> = padded(2).iter().flat_map(|s| [(s % 256) as u8, (s / 4) as u8]).collect();
        prop_assert_eq!(grey(width, PixelFormat::Uyvy, uyvy), top.clone());

        let unpacked: Vec<u8> = samples.iter().flat_map(|s| s.to_le_bytes()).collect();
        prop_assert_eq!(grey(width, PixelFormat::Grey16 { bits: 10 }, unpacked.clone()), top.clone());
        prop_assert_eq!(grey(width, PixelFormat::Bayer16 { bits: 10 }, unpacked), top.clone());
        prop_assert_eq!(grey(width, PixelFormat::Bayer8, top.clone()), top);
    }

    #[test]
    fn rgb565_is_the_luma_of_its_spread_bits(pixels in proptest::collection::vec(any::<u16>(), 1..40)) {
        let expected: Vec<u8> = pixels.iter().map(|&p| {
            let (r, g, b) = (u32::from(p) / 2048, u32::from(p) / 32 % 64, u32::from(p) % 32);
            luma(r * 8 + r / 4, g * 4 + g / 16, b * 8 + b / 4)
        }).collect();
        let width = pixels.len() as u16;
        let high: Vec<u8> = pixels.iter().flat_map(|p| p.to_be_bytes()).collect();
        prop_assert_eq!(grey(width, PixelFormat::Rgb565 { high_byte_first: true }, high), expected.clone());
        let low: Vec<u8> = pixels.iter().flat_map(|p| p.to_le_bytes()).collect();
        prop_assert_eq!(grey(width, PixelFormat::Rgb565 { high_byte_first: false }, low), expected.clone());
        for (grey, p) in expected.iter().zip(&pixels) {
            let [r, g, b] = [(p >> 11, 31.0), (p >> 5 & 63, 63.0), (p & 31, 31.0)]
                .map(|(v, most)| f64::from(v) / most * 255.0);
            prop_assert!((f64::from(*grey) - (0.299 * r + 0.587 * g + 0.114 * b)).abs() <= 1.1);
        }
    }

    /// A mosaic's grey is the mean of the 2x2 block; at the right and lower edge that of the block before.
    #[test]
    fn a_mosaic_is_the_mean_of_four(width in 1usize..20, height in 1usize..9, seed: u64) {
        let bytes: Vec<u8> = (0..width * height).map(|i| (seed.rotate_left(i as u32 * 7) >> (i % 9)) as u8)
            .collect();
        let at = |x: usize, y: usize| u32::from(bytes[y.min(height - 1) * width + x.min(width - 1)]);
        let source = Memory::new(width as u16, height as u16, PixelFormat::Bayer8, bytes.clone());
        let mut lines = BayerLines::<_, 20, 20>::new(source).expect("room");
        for _ in 0..2 {
            lines.start_frame().expect("memory");
            for y in 0..height {
                let mut out = vec![0; width];
                prop_assert_eq!(lines.next_line(&mut out).map(|start| usize::from(start.row)), Ok(y));
                for (x, out) in out.iter().enumerate() {
                    let (x, y) = (x.min(width.saturating_sub(2)), y.min(height.saturating_sub(2)));
                    if height > 1 {
                        let sum = at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1);
                        prop_assert_eq!(u32::from(*out), (sum + 2) / 4);
                    }
                }
            }
            prop_assert_eq!(lines.next_line(&mut vec![0; width]), Err(CameraError::NoLineLeft));
        }
    }

    /// Halves of lines, and lines by turns, are the two pictures.
    #[test]
    fn streams_carry_two_pictures(width in 1u16..20, height in 1u16..9, seed: u64) {
        let picture = |salt: u64| -> Vec<u8> {
            (0..usize::from(width) * usize::from(height))
                .map(|i| ((seed ^ salt).rotate_left(i as u32) >> 3) as u8).collect()
        };
        let (left, right) = (picture(0), picture(0x5555));
        let rows = || left.chunks(width.into()).zip(right.chunks(width.into()));
        let both: Vec<u8> = rows().flat_map(|(l, r)| [l, r].concat()).collect();

        let beside = Memory::new(2 * width, height, PixelFormat::Grey8, both.clone());
        let mut beside = SideBySide::<_, 40>::new(beside).expect("an even width");
        let by_turns = Memory::new(width, 2 * height, PixelFormat::Grey8, both);
        let mut by_turns = Interleaved::new(by_turns, 30).expect("an even height");
        prop_assert_eq!((beside.max_row_skew_us(), by_turns.max_row_skew_us()), (0, 30));
        for source in [&mut beside as &mut dyn StereoSource<Error = _>, &mut by_turns] {
            prop_assert_eq!(source.format(), LineFormat { width, height, pixel: PixelFormat::Grey8 });
            source.start_frame().expect("memory");
            for (y, (l, r)) in rows().enumerate() {
                let (mut a, mut b) = (vec![0; width.into()], vec![0; width.into()]);
                prop_assert_eq!(source.next_lines(&mut a, &mut b).map(|start| usize::from(start.row)), Ok(y));
                prop_assert_eq!((&a[..], &b[..]), (l, r));
            }
            let (mut a, mut b) = (vec![0; width.into()], vec![0; width.into()]);
            prop_assert_eq!(source.next_lines(&mut a, &mut b), Err(CameraError::NoLineLeft));
        }
    }

    #[test]
    fn a_mirrored_line_is_its_pixels_from_the_right(pixels in proptest::collection::vec(any::<[u8; 3]>(),
        1..20)) {
        let bytes: Vec<u8> = pixels.concat();
        let source = Memory::new(pixels.len() as u16, 1, PixelFormat::Rgb8, bytes);
        let mut mirrored = Mirrored::new(source).expect("whole bytes");
        mirrored.start_frame().expect("memory");
        let mut out = vec![7; 3 * pixels.len() + 1];
        mirrored.next_line(&mut out).expect("a line");
        prop_assert_eq!(out.pop(), Some(7));
        prop_assert_eq!(out, pixels.iter().rev().copied().collect::<Vec<_>>().concat());
    }
}

#[test]
fn lines_of_groups_take_whole_groups() {
    let bytes = |width, pixel| LineFormat { width, height: 1, pixel }.line_bytes();
    assert_eq!([4, 5, 8].map(|width| bytes(width, PixelFormat::Grey10Packed)), [5, 10, 10]);
    assert_eq!([2, 3].map(|width| bytes(width, PixelFormat::Grey12Packed)), [3, 6]);
    assert_eq!([2, 3].map(|width| bytes(width, PixelFormat::Yuyv)), [4, 8]);
    assert_eq!(PixelFormat::Grey10Packed.bytes_per_pixel(), 2);
}

#[test]
fn a_lost_line_of_a_stream_loses_its_row_and_no_other() {
    let told = |missing: &[u16]| {
        let bytes = (0..8).flat_map(|row| [row; 2]).collect();
        let stream = Memory::new(2, 8, PixelFormat::Grey8, bytes).without(missing);
        let mut source = Interleaved::new(stream, 0).expect("an even height");
        source.start_frame().expect("memory");
        let mut seen = Vec::new();
        for _ in 0..6 {
            let (mut left, mut right) = ([0; 2], [0; 2]);
            match source.next_lines(&mut left, &mut right) {
                Ok(start) => {
                    assert_eq!((left, right), ([2 * start.row as u8; 2], [2 * start.row as u8 + 1; 2]));
                    seen.push(Some(start.row));
                }
                Err(CameraError::LineLost(LineFault::Dropped)) => seen.push(None),
                Err(e) => {
                    assert_eq!(e, CameraError::NoLineLeft);
                    break;
                }
            }
        }
        seen
    };
    assert_eq!(told(&[]), [Some(0), Some(1), Some(2), Some(3)]);
    // A right line is lost: the next left one is taken for it, and given up with its partner.
    assert_eq!(told(&[3]).iter().flatten().collect::<Vec<_>>(), [&0, &3]);
    assert_eq!(told(&[2]), [Some(0), None, Some(2), Some(3)]);
    assert_eq!(told(&[2, 3]), [Some(0), Some(2), Some(3)]);
}

#[test]
fn streams_that_carry_no_two_pictures_are_refused() {
    let stream = |width, height, pixel| {
        let format = LineFormat { width, height, pixel };
        Memory::new(width, height, pixel, vec![0; format.line_bytes() * usize::from(height)])
    };
    assert_eq!(
        SideBySide::<_, 9>::new(stream(5, 2, PixelFormat::Grey8)).err(),
        Some(StreamError::OddWidth { width: 5 })
    );
    assert_eq!(
        SideBySide::<_, 9>::new(stream(6, 2, PixelFormat::Yuyv)).err(),
        Some(StreamError::OddWidth { width: 6 })
    );
    assert_eq!(
        SideBySide::<_, 9>::new(stream(10, 2, PixelFormat::Grey8)).err(),
        Some(StreamError::BufferTooShort { needed: 10 })
    );
    assert_eq!(
        Interleaved::new(stream(4, 3, PixelFormat::Grey8), 0).err(),
        Some(StreamError::OddHeight { height: 3 })
    );
    assert_eq!(Mirrored::new(stream(4, 3, PixelFormat::Yuyv)).err(), Some(StreamError::SharedBytes));
    assert!(BayerLines::<_, 3, 9>::new(stream(4, 3, PixelFormat::Bayer8)).is_err());
    assert!(BayerLines::<_, 9, 3>::new(stream(4, 3, PixelFormat::Bayer8)).is_err());
}
