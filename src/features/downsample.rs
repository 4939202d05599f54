//! Image pyramid: downsampling by area, line by line.

/// Makes `N - 1` pixels of every `N`, and `N - 1` lines of every `N`, each the mean of the area that it
/// covers, rounded.
///
/// `W` is the longest line that comes in, px; it takes `5 W` bytes. What is left over at the right, less than
/// `N` pixels, is left out. `Downsample<W, 2>` halves a picture; `Downsample<W, 3>` makes two pixels of
/// three.
///
/// Pixel `j` of the `N - 1` is `((N - 1 - j) p[j] + (j + 1) p[j + 1]) / N`, along both axes.
///
/// ```
/// use stereopsis::features::Downsample;
/// let mut shrink = Downsample::<8, 3>::new();
/// shrink.start(7);
/// assert_eq!(shrink.width(), 4);
/// assert_eq!(shrink.push(&[30, 60, 90, 0, 0, 30, 255]), None);
/// assert_eq!(shrink.push(&[30, 60, 90, 0, 0, 30, 255]), Some(&[40, 80, 0, 20][..]));
/// assert_eq!(shrink.push(&[0; 7]), Some(&[13, 27, 0, 7][..]));
/// ```
#[derive(Debug)]
pub struct Downsample<const W: usize, const N: usize> {
    width: usize,
    /// Lines of the current `N` that came.
    phase: u16,
    /// `N` times the pixels of the line before this one.
    before: [u16; W],
    /// Sums of the current line.
    here: [u16; W],
    out: [u8; W],
}

impl<const W: usize, const N: usize> Downsample<W, N> {
    /// Nothing came yet; [`Self::start`] says how long lines are.
    pub const fn new() -> Self {
        const { assert!(2 <= N && N <= 16, "2 to 16 pixels become one less") };
        Self { width: 0, phase: 0, before: [0; W], here: [0; W], out: [0; W] }
    }

    /// Begins a frame with lines of `width` pixels, at most the capacity.
    pub fn start(&mut self, width: usize) {
        self.width = width.min(W) / N * (N - 1);
        self.phase = 0;
    }

    /// Pixels in a line that goes out.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Lines that go out of `height` that come in.
    pub const fn height(height: usize) -> usize {
        height / N * (N - 1) + (height % N).saturating_sub(1)
    }

    /// The next line; all but the first of every `N` make one that goes out.
    pub fn push(&mut self, line: &[u8]) -> Option<&[u8]> {
        let parts = N as u16;
        core::mem::swap(&mut self.before, &mut self.here);
        let (mut places, _) = self.here.split_at_mut_checked(self.width)?;
        for group in line.as_chunks::<N>().0 {
            let Some((here, after)) = places.split_at_mut_checked(N - 1) else { break };
            places = after;
            for ((j, pair), place) in (1..).zip(group.windows(2)).zip(here) {
                let &[a, b] = pair else { continue };
                *place = (parts - j) * u16::from(a) + j * u16::from(b);
            }
        }
        let j = self.phase;
        self.phase = (self.phase + 1) % parts;
        if j == 0 {
            return None;
        }
        let area = u32::from(parts * parts);
        let out = self.out.get_mut(..self.width)?;
        for ((out, &above), &here) in out.iter_mut().zip(&self.before).zip(&self.here) {
            let sum = u32::from(parts - j) * u32::from(above) + u32::from(j) * u32::from(here);
            *out = ((sum + area / 2) / area) as u8;
        }
        Some(out)
    }
}

impl<const W: usize, const N: usize> Default for Downsample<W, N> {
    fn default() -> Self {
        Self::new()
    }
}
