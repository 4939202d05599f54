//! Gradients of brightness, cut off: what is left is which way the brightness goes, and how steeply where it is flat.

/// Sobel's gradients of a row along the line and across it, in eighths of a grey level per pixel, cut off at `most` (up to
/// 127) to each side, plus `most`: 0 to 2 `most`.
///
/// `rows` are the rows above, here and below; every number is written for which all of them have a pixel. A line ends where
/// the shortest of them does, and columns outside it are the nearest inside.
pub fn gradients(rows: &[&[u8]; 3], most: u8, along: &mut [u8], across: &mut [u8]) {
    let most = i16::from(most.min(127));
    let width = rows.iter().fold(usize::MAX, |w, row| w.min(row.len()));
    let [Some(above), Some(here), Some(below)] = rows.map(|row| row.get(..width)) else { return };
    let cut = |gradient: i16| (gradient.clamp(-most, most) + most) as u8;
    let both = |above: [u8; 3], here: [u8; 3], below: [u8; 3]| {
        let [a, b, c] = [above, here, below].map(|row| row.map(i16::from));
        let along = (a[2] - a[0]) + 2 * (b[2] - b[0]) + (c[2] - c[0]);
        let across = (c[0] - a[0]) + 2 * (c[1] - a[1]) + (c[2] - a[2]);
        (cut(along), cut(across))
    };
    let inner = along.iter_mut().zip(across.iter_mut()).skip(1);
    let lines = above.windows(3).zip(here.windows(3)).zip(below.windows(3));
    for ((along, across), ((above, here), below)) in inner.zip(lines) {
        let three = |row: &[u8]| row.first_chunk().copied().unwrap_or([0; 3]);
        (*along, *across) = both(three(above), three(here), three(below));
    }
    let last = width.saturating_sub(1);
    for x in [0, last] {
        let three = |row: &[u8]| [x.saturating_sub(1), x, (x + 1).min(last)].map(|x| row.get(x).copied().unwrap_or(0));
        if let Some((along, across)) = along.get_mut(x).zip(across.get_mut(x)).filter(|_| x < width) {
            (*along, *across) = both(three(above), three(here), three(below));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_has_one_gradient_but_at_its_ends() {
        let ramp = [10, 11, 12, 13, 14];
        let (mut along, mut across) = ([0; 5], [0; 5]);
        gradients(&[&ramp; 3], 20, &mut along, &mut across);
        assert_eq!((along, across), ([24, 28, 28, 28, 24], [20; 5]));
        gradients(&[&[9; 5], &[10; 5], &[11; 5]], 5, &mut along, &mut across);
        assert_eq!((along, across), ([5; 5], [10; 5]));
    }

    #[test]
    fn only_what_has_a_place_is_written() {
        let (mut along, mut across) = ([99; 4], [99; 2]);
        gradients(&[&[1, 2, 4], &[1, 2, 4], &[1, 2, 4]], 100, &mut along, &mut across);
        assert_eq!((along, across), ([104, 112, 108, 99], [100, 100]));
        gradients(&[&[], &[1], &[1]], 100, &mut along, &mut across);
        assert_eq!(along[0], 104);
    }
}
