//! Pictures whose metadata says that they are turned.

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, GrayImage, ImageEncoder, Luma};
use std::fs::File;
use stereopsis_host::mock::MockCamera;

#[test]
fn a_picture_is_turned_as_its_metadata_asks_for() {
    let picture = GrayImage::from_fn(16, 8, |x, y| Luma([(10 * x + 7 * y) as u8]));
    // TIFF's header, little-endian, and a directory of one entry: tag 0x112, a short, one of it.
    let exif = |orientation: u8| {
        let mut exif = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0".to_vec();
        exif.extend([orientation, 0, 0, 0, 0, 0, 0, 0]);
        exif
    };
    let folder = tempfile::tempdir().expect("a folder");
    let played = |orientation: u8| {
        let path = folder.path().join("picture.png");
        let mut encoder = PngEncoder::new(File::create(&path).expect("a file"));
        encoder.set_exif_metadata(exif(orientation)).expect("PNG has a place for it");
        encoder.write_image(&picture, 16, 8, ExtendedColorType::L8).expect("a picture");
        let camera = MockCamera::open(&path).expect("a camera");
        image::imageops::grayscale(&camera.picture())
    };
    assert_eq!(played(1), picture);
    assert_eq!(played(3), image::imageops::rotate180(&picture));
    assert_eq!(played(6), image::imageops::rotate90(&picture));
}
