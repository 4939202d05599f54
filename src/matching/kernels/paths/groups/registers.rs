//! What groups in registers have alike, whichever processor's: everything that only moves bytes.

/// Items of an `impl Group` for a register of so many bytes. Beside them it needs `last_lane_of(cells, number)`: the last
/// lane of all cells that has the number which is in all lanes of `number` and in one of the cells.
macro_rules! register {
    ($lanes:literal) => {
        const LANES: usize = $lanes;
        type Cell = [u8; $lanes];
        type Bytes = [u8; $lanes];

        #[inline(always)]
        fn cells(bytes: &[u8]) -> &[Self::Cell] {
            bytes.as_chunks().0
        }

        #[inline(always)]
        fn cells_mut(bytes: &mut [u8]) -> &mut [Self::Cell] {
            bytes.as_chunks_mut().0
        }

        #[inline(always)]
        fn groups(bytes: &[u8]) -> &[Self::Bytes] {
            bytes.as_chunks().0
        }

        #[inline(always)]
        fn of_bytes(bytes: Self::Bytes) -> Self {
            Self::of(bytes)
        }

        #[inline(always)]
        fn last_least(cells: &[Self]) -> (u8, usize) {
            let all = cells.iter().fold(
                Self::splat(u8::MAX),
                #[inline(always)]
                |all, &cell| all.min(cell),
            );
            let least = all.least();
            (Self::lane(&[least], 0), Self::last_lane_of(cells, least))
        }

        #[inline(always)]
        fn lane(cells: &[Self], lane: usize) -> u8 {
            const { assert!(size_of::<Self>() == $lanes) };
            let (first, length) = (cells.as_ptr().cast(), size_of_val(cells));
            // SAFETY: registers are bytes, and as many of them are looked at as there are.
            let bytes: &[u8] = unsafe { core::slice::from_raw_parts(first, length) };
            bytes.get(lane).copied().unwrap_or(0)
        }

        #[inline(always)]
        fn raise(cells: &mut [Self], lane: usize) {
            let (first, length) = (cells.as_mut_ptr().cast(), size_of_val(cells));
            // SAFETY: as above; any byte is good.
            let bytes: &mut [u8] = unsafe { core::slice::from_raw_parts_mut(first, length) };
            if let Some(byte) = bytes.get_mut(lane) {
                *byte = u8::MAX;
            }
        }
    };
}
pub(super) use register;
