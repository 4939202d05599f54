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
    state: DownsampleState,
    sums: [[u16; 2]; W],
    out: [u8; W],
}

/// How far a [`Downsample`] is with a frame.
#[derive(Default, Debug)]
pub struct DownsampleState {
    width: usize,
    /// Lines of the current `N` that came.
    phase: u16,
    /// Lines that came, even or odd.
    is_odd: bool,
}

/// A borrowed [`Downsample`] of any width.
#[derive(Debug)]
pub struct DownsampleView<'a, const N: usize> {
    state: &'a mut DownsampleState,
    /// `N` times the pixels of the last even line and of the last odd one.
    sums: &'a mut [u16],
    out: &'a mut [u8],
}

impl<const W: usize, const N: usize> Downsample<W, N> {
    /// Nothing came yet; [`Self::start`] says how long lines are.
    pub const fn new() -> Self {
        let state = DownsampleState { width: 0, phase: 0, is_odd: false };
        Self { state, sums: [[0; 2]; W], out: [0; W] }
    }

    /// The filter without its capacity.
    pub fn as_mut_view(&mut self) -> DownsampleView<'_, N> {
        DownsampleView::new(&mut self.state, self.sums.as_flattened_mut(), &mut self.out)
    }

    /// Begins a frame with lines of `width` pixels, at most the capacity.
    pub fn start(&mut self, width: usize) {
        self.as_mut_view().start(width);
    }

    /// Pixels in a line that goes out.
    pub fn width(&self) -> usize {
        self.state.width
    }

    /// Lines that go out of `height` that come in.
    pub const fn height(height: usize) -> usize {
        DownsampleView::<N>::height(height)
    }

    /// The next line; all but the first of every `N` make one that goes out.
    pub fn push(&mut self, line: &[u8]) -> Option<&[u8]> {
        self.as_mut_view().into_next(line)
    }
}

impl<'a, const N: usize> DownsampleView<'a, N> {
    /// A filter in the caller's memory. The capacity is as many pixels as `out` holds and half of what `sums`
    /// holds; it does not matter what is in them before [`Self::start`].
    pub fn new(state: &'a mut DownsampleState, sums: &'a mut [u16], out: &'a mut [u8]) -> Self {
        const { assert!(2 <= N && N <= 16, "2 to 16 pixels become one less") };
        Self { state, sums, out }
    }

    /// Begins a frame with lines of `width` pixels, at most the capacity.
    pub fn start(&mut self, width: usize) {
        let most = self.out.len().min(self.sums.len() / 2);
        *self.state = DownsampleState { width: width.min(most) / N * (N - 1), ..DownsampleState::default() };
    }

    /// Pixels in a line that goes out.
    pub fn width(&self) -> usize {
        self.state.width
    }

    /// Lines that go out of `height` that come in.
    pub const fn height(height: usize) -> usize {
        height / N * (N - 1) + (height % N).saturating_sub(1)
    }

    /// The next line; all but the first of every `N` make one that goes out.
    pub fn push(&mut self, line: &[u8]) -> Option<&[u8]> {
        DownsampleView::<N> { state: self.state, sums: self.sums, out: self.out }.into_next(line)
    }

    fn into_next(self, line: &[u8]) -> Option<&'a [u8]> {
        let parts = N as u16;
        let DownsampleState { width, phase, is_odd } = self.state;
        let (even, odd) = self.sums.split_at_mut_checked(*width)?;
        let (before, here) = if *is_odd { (even, odd) } else { (odd, even) };
        *is_odd = !*is_odd;
        let (mut places, _) = here.split_at_mut_checked(*width)?;
        for group in line.as_chunks::<N>().0 {
            let Some((here, after)) = places.split_at_mut_checked(N - 1) else { break };
            places = after;
            for ((j, pair), place) in (1..).zip(group.windows(2)).zip(here) {
                let &[a, b] = pair else { continue };
                *place = (parts - j) * u16::from(a) + j * u16::from(b);
            }
        }
        let j = *phase;
        *phase = (j + 1) % parts;
        if j == 0 {
            return None;
        }
        let area = u32::from(parts * parts);
        let out = self.out.get_mut(..*width)?;
        for ((out, &mut above), &mut here) in out.iter_mut().zip(before).zip(here) {
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
