//! Fixed-size memory whose size depends on the frame's capacity: what a method keeps for each disparity, and
//! its workspace.
#![allow(unsafe_code)]

/// Columns of zero sums before the image's first and after its last, to stand for those outside.
pub const OUTSIDE: usize = 5;

/// How many columns to each side the path from above comes from.
pub const COLUMNS_OFF: usize = 2;

/// What a kernel works with while a row lasts. No kernel finds anything in it from the row before.
///
/// `2 W + 3 D` bytes: room for window sums of all disparities beside the codes of the right image's rows, in
/// the order in which the kernel reads them, each with as many before as there are disparities. Beside that
/// `TABLES` words.
#[repr(C, align(8))]
pub struct WindowWorkspace<const TABLES: usize, const W: usize, const D: usize> {
    tables: [u32; TABLES],
    sums: [u8; D],
    before: [u16; D],
    codes: [u16; W],
    /// What makes the last word a whole one.
    rest: u16,
}

impl<const TABLES: usize, const W: usize, const D: usize> WindowWorkspace<TABLES, W, D> {
    /// All zero.
    pub const ZERO: Self = Self { tables: [0; TABLES], sums: [0; D], before: [0; D], codes: [0; W], rest: 0 };

    /// All of it as words.
    pub fn words(&mut self) -> &mut [u32] {
        let bytes = size_of_val(&self.sums) + size_of_val(&self.before) + size_of_val(&self.codes);
        let words = TABLES + (bytes + size_of_val(&self.rest)) / size_of::<u32>();
        // SAFETY: the fields are integers without a gap between them (`repr(C)`, the first a whole number of
        // half-words), any of whose values is a word, and `words` does not reach beyond the last one.
        unsafe { core::slice::from_raw_parts_mut(core::ptr::from_mut(self).cast(), words) }
    }
}

/// Sums of `W` columns with `D` disparities each, with [`OUTSIDE`] more before them and after that stay zero.
#[repr(C, align(8))]
pub struct Columns<const W: usize, const D: usize> {
    before: [[u8; D]; OUTSIDE],
    inside: [[u8; D]; W],
    after: [[u8; D]; OUTSIDE],
}

impl<const W: usize, const D: usize> Columns<W, D> {
    /// All zero.
    pub const ZERO: Self = Self { before: [[0; D]; OUTSIDE], inside: [[0; D]; W], after: [[0; D]; OUTSIDE] };

    /// All of it, one column after the other.
    pub fn flat(&mut self) -> &mut [u8] {
        let bytes = size_of_val(&self.before) + size_of_val(&self.inside) + size_of_val(&self.after);
        // SAFETY: the fields are bytes without a gap between them (`repr(C)`), `bytes` of them in all.
        unsafe { core::slice::from_raw_parts_mut(core::ptr::from_mut(self).cast(), bytes) }
    }
}

/// `VOLUMES` numbers for each of `D` disparities of `W` columns, and [`COLUMNS_OFF`] columns more.
#[repr(C, align(8))]
pub struct Volumes<const VOLUMES: usize, const W: usize, const D: usize> {
    columns: [[[u8; D]; W]; VOLUMES],
    more: [[u8; D]; COLUMNS_OFF],
}

impl<const VOLUMES: usize, const W: usize, const D: usize> Volumes<VOLUMES, W, D> {
    /// All zero.
    pub const ZERO: Self = Self { columns: [[[0; D]; W]; VOLUMES], more: [[0; D]; COLUMNS_OFF] };

    /// All of it, one column after the other.
    pub fn flat(&mut self) -> &mut [u8] {
        let bytes = size_of_val(&self.columns) + size_of_val(&self.more);
        // SAFETY: as for [`Columns::flat`].
        unsafe { core::slice::from_raw_parts_mut(core::ptr::from_mut(self).cast(), bytes) }
    }
}

/// What a method along paths works with while a row lasts: its features, then its winners.
#[repr(C, align(8))]
pub struct PathWorkspace<const W: usize, const D: usize> {
    pixels: [[u8; W]; PathWorkspace::<0, 0>::PER_PIXEL],
    disparities: [[u8; D]; PathWorkspace::<0, 0>::PER_DISPARITY],
}

impl PathWorkspace<0, 0> {
    /// Bytes a pixel: three features of the left row, four of the right one and the ends of a range; or the
    /// winner, what the right column keeps, the length of its surface, and two to work on answers.
    pub const PER_PIXEL: usize = if 3 + 4 + 2 > 4 + 2 + 2 + 2 { 3 + 4 + 2 } else { 4 + 2 + 2 + 2 };
    /// Bytes a disparity: what the right features have before them.
    pub const PER_DISPARITY: usize = 4 + 2;
}

impl<const W: usize, const D: usize> PathWorkspace<W, D> {
    /// All zero.
    pub const ZERO: Self = Self {
        pixels: [[0; W]; PathWorkspace::<0, 0>::PER_PIXEL],
        disparities: [[0; D]; PathWorkspace::<0, 0>::PER_DISPARITY],
    };

    /// Returns the bytes.
    pub fn bytes(&self) -> &[u8] {
        self.pixels.as_flattened()
    }

    /// All of it as words, but for the last bytes if they are not a whole one.
    pub fn words(&mut self) -> &mut [u32] {
        let words = (size_of_val(&self.pixels) + size_of_val(&self.disparities)) / size_of::<u32>();
        // SAFETY: the fields are bytes without a gap between them (`repr(C)`), any four of which are a word,
        // the first stands where a word may, and `words` does not reach beyond the last one.
        unsafe { core::slice::from_raw_parts_mut(core::ptr::from_mut(self).cast(), words) }
    }
}

/// Bytes where words of them can be read and written.
#[repr(C, align(8))]
pub struct Aligned<T>(pub T);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_given_to_its_last_whole_word() {
        // Three words, and 16 + 32 + 10 + 2 bytes; with an even width the last two make no word.
        let mut odd = WindowWorkspace::<3, 5, 16>::ZERO;
        assert_eq!(odd.words().len(), 3 + 60 / 4);
        let mut even = WindowWorkspace::<0, 4, 32>::ZERO;
        assert_eq!(even.words().len(), (32 + 64 + 8 + 2) / 4);
        // Five columns before and after.
        let mut columns = Columns::<3, 16>::ZERO;
        assert_eq!(columns.flat().len(), 13 * 16);
        // Two columns more.
        let mut volumes = Volumes::<2, 3, 16>::ZERO;
        assert_eq!(volumes.flat().len(), (2 * 3 + 2) * 16);
        let mut paths = PathWorkspace::<5, 16>::ZERO;
        assert_eq!(paths.bytes().len(), 10 * 5);
        assert_eq!(paths.words().len(), (10 * 5 + 6 * 16) / 4);
    }
}
