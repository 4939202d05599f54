//! The core's gradients against Sobel's masks, spelled out, at all small widths and at the ends of the range.

use stereopsis::imaging::gradients;
use stereopsis_host::scene::Random;

/// What neighbours count for, from left to right, in the rows above, here and below.
const ALONG: [[i32; 3]; 3] = [[-1, 0, 1], [-2, 0, 2], [-1, 0, 1]];
const ACROSS: [[i32; 3]; 3] = [[-1, -2, -1], [0, 0, 0], [1, 2, 1]];

/// Numbers at which gradients are cut off, what is beyond the largest among them.
const MOST: [u8; 6] = [0, 1, 7, 20, 127, 255];

/// A mask at every column; a column outside the line is the nearest inside.
fn masked(mask: &[[i32; 3]; 3], rows: &[&[u8]; 3], most: u8) -> Vec<u8> {
    let (width, most) = (rows[0].len() as i32, i32::from(most.min(127)));
    let at_column = |x: i32| {
        let places = (0..3).flat_map(|row| (0..3).map(move |column| (row, column)));
        let sum: i32 = places
            .map(|(row, column)| {
                let x = (x + column as i32 - 1).clamp(0, width - 1);
                mask[row][column] * i32::from(rows[row][x as usize])
            })
            .sum();
        (sum.max(-most).min(most) + most) as u8
    };
    (0..width).map(at_column).collect()
}

/// Compares the core's gradients of three rows of one length with the masks', with every number to cut off
/// at.
fn compare(rows: &[&[u8]; 3]) {
    let width = rows[0].len();
    for most in MOST {
        // What was there must not shine through, and what lies behind the line must stay.
        let (mut along, mut across) = (vec![0xa5; width + 3], vec![0x5a; width + 3]);
        gradients(rows, most, &mut along, &mut across);
        assert_eq!(along[..width], masked(&ALONG, rows, most), "along {rows:?}, cut off at {most}");
        assert_eq!(across[..width], masked(&ACROSS, rows, most), "across {rows:?}, cut off at {most}");
        assert_eq!(
            (&along[width..], &across[width..]),
            (&[0xa5; 3][..], &[0x5a; 3][..]),
            "behind {width} columns"
        );
    }
}

/// Three rows out of `byte`.
fn rows(width: usize, mut byte: impl FnMut() -> u8) -> [Vec<u8>; 3] {
    [(); 3].map(|()| (0..width).map(|_| byte()).collect())
}

fn compare_owned(rows: &[Vec<u8>; 3]) {
    compare(&rows.each_ref().map(Vec::as_slice));
}

#[test]
fn all_widths() {
    let mut random = Random::new(3);
    for width in 1..=70 {
        for _ in 0..20 {
            compare_owned(&rows(width, || random.byte()));
        }
    }
}

#[test]
fn every_black_and_white_line_of_up_to_five_columns() {
    for width in 1..=5 {
        for bits in 0..1u32 << (3 * width) {
            let mut place = 0;
            compare_owned(&rows(width, || {
                place += 1;
                if bits >> (place - 1) & 1 == 1 { 255 } else { 0 }
            }));
        }
    }
}

#[test]
fn black_and_white_lines_of_up_to_ten_columns() {
    let mut random = Random::new(4);
    for width in 6..=10 {
        for _ in 0..500 {
            compare_owned(&rows(width, || *random.pick(&[0, 255])));
        }
        for corner in [[0; 3], [255; 3], [0, 255, 255], [0, 0, 255], [255, 0, 255], [255, 255, 0]] {
            compare_owned(&corner.map(|grey| vec![grey; width]));
        }
    }
}

#[test]
fn rows_and_places_of_unequal_length_are_taken_as_far_as_all_go() {
    let mut random = Random::new(5);
    let [above, here, below] = rows(33, || random.byte());
    for length in 1..=33 {
        let expected_along = masked(&ALONG, &[&above[..length], &here[..length], &below[..length]], 20);
        let (mut along, mut across) = ([7; 33], [7; 33]);
        gradients(&[&above, &here[..length], &below], 20, &mut along, &mut across);
        assert_eq!(along[..length], expected_along);
        assert!(along[length..].iter().chain(&across[length..]).all(|&number| number == 7));
        // Fewer places than columns: the line goes on behind the last.
        let whole = masked(&ALONG, &[&above, &here, &below], 20);
        gradients(&[&above, &here, &below], 20, &mut along[..length], &mut across);
        assert_eq!(along[..length], whole[..length]);
        assert!(along[length..].iter().all(|&number| number == 7));
    }
}
