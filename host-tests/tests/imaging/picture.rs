//! A picture is asked for pixels anywhere, by numbers of any size.

use stereopsis::imaging::Picture;
use stereopsis_host::scene::Random;

#[test]
fn there_is_nothing_outside() {
    let picture = Picture::new(&[7; 40], 10, 4).expect("forty pixels");
    for far in [f32::INFINITY, f32::MAX, 1e30, 10.0, -1e-9, f32::NEG_INFINITY, f32::NAN] {
        assert_eq!((picture.sample(far, 1.0), picture.sample(1.0, far)), (None, None), "{far}");
        assert_eq!(picture.sample(far, far), None, "{far}");
    }
    for far in [10, 11, usize::MAX / 10, usize::MAX - 1, usize::MAX] {
        assert_eq!(picture.run(far, 1, 2), None, "{far}");
        assert_eq!(picture.run(1, far, 2), None, "{far}");
        assert_eq!(picture.run(1, 1, far), None, "{far}");
        assert_eq!(picture.run(far, far, far), None, "{far}");
    }
    assert_eq!(picture.run(0, 3, 10), Some(&[7; 10][..]));
}

/// Every run of every small picture is that of its rows.
#[test]
fn runs_are_those_of_the_rows() {
    let pixels: Vec<u8> = (0..36).collect();
    for (width, height) in (0..=6).flat_map(|width| (0..=6).map(move |height| (width, height))) {
        let of_picture = &pixels[..width * height];
        let picture = Picture::new(of_picture, width as u16, height as u16).expect("as many pixels");
        let places = || (0..=8).chain([usize::MAX / 2, usize::MAX - 1, usize::MAX]);
        for (column, row) in places().flat_map(|column| places().map(move |row| (column, row))) {
            for length in places() {
                let line = of_picture.chunks(width.max(1)).nth(row).filter(|_| row < height);
                let line = if width == 0 && row < height { Some(&[][..]) } else { line };
                let expected = line.and_then(|line| line.get(column..column.checked_add(length)?));
                assert_eq!(
                    picture.run(column, row, length),
                    expected,
                    "{width}x{height}: {column} {row} {length}"
                );
            }
        }
    }
}

#[test]
fn samples_are_numbers_inside_only() {
    let picture = Picture::new(&[7; 40], 10, 4).expect("forty pixels");
    let random = &mut Random::new(3);
    let mut inside = 0;
    for _ in 0..100_000 {
        let [x, y] = [(); 2].map(|()| f32::from_bits(random.bits() as u32));
        let expected = (0.0..9.0).contains(&x) && (0.0..3.0).contains(&y);
        assert_eq!(picture.sample(x, y), expected.then_some(7.0), "{x} {y}");
        inside += u32::from(expected);
    }
    assert!(inside > 100, "{inside}");
}
