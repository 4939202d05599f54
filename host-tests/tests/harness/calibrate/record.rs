//! The record in flash, and files.

use super::rig;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::geometry::camera::{
    CameraModelError, Distortion, Fisheye, ImageSize, Lens, PoseError, RecordError, StereoRig, StereoRigError,
};
use stereopsis_host::calibration::{RawCalibration, write_c, write_opencv, write_rust};

type Rig = StereoRig<f64>;

/// CRC-32 as a table's entries give it, the other way than the core's.
fn crc32(bytes: &[u8]) -> u32 {
    let entry = |i: u32| (0..8).fold(i, |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 });
    let table: Vec<u32> = (0..256).map(entry).collect();
    !bytes.iter().fold(!0, |crc, &byte| table[((crc ^ u32::from(byte)) & 255) as usize] ^ (crc >> 8))
}

/// The record with a number replaced and its checksum made right.
fn with(number: usize, value: f64) -> [u8; 328] {
    let mut record = rig().to_record();
    record[20 + 8 * number..][..8].copy_from_slice(&value.to_le_bytes());
    sealed(record)
}

fn sealed(mut record: [u8; 328]) -> [u8; 328] {
    let checksum = crc32(&record[..324]);
    record[324..].copy_from_slice(&checksum.to_le_bytes());
    record
}

fn near(a: &Rig, b: &Rig) -> bool {
    let cameras = a.cameras().iter().zip(b.cameras());
    cameras.into_iter().all(|(a, b)| (a.matrix() - b.matrix()).amax() < 1e-9)
        && a.cameras().each_ref().map(|c| *c.lens()) == b.cameras().each_ref().map(|c| *c.lens())
        && (a.pose().rotation() - b.pose().rotation()).amax() < 1e-12
        && (a.pose().translation() - b.pose().translation()).amax() < 1e-12
        && a.sizes() == b.sizes()
}

#[test]
fn a_record_is_the_rig() {
    let record = rig().to_record();
    assert_eq!(record.len(), Rig::RECORD_BYTES);
    assert_eq!(&record[..8], b"STRG\x01\x00\x48\x01");
    assert!(near(&Rig::from_record(&record).expect("a rig"), &rig()));
    // What follows in flash is not looked at; in single precision it is the same rig.
    let page: Vec<u8> = record.into_iter().chain([0xff; 100]).collect();
    let single = StereoRig::<f32>::from_record(&page).expect("a rig");
    assert!((f64::from(single.baseline_m()) - rig().baseline_m()).abs() < 1e-8);
    assert_eq!(single.to_record().len(), record.len());
}

/// Lenses of other models, in flash and in files.
#[test]
fn every_lens_comes_back() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let rational = Distortion::from_opencv_rational([-0.25, 0.06, 0.001, -0.002, 0.5, 0.125, 0.25, 0.75]);
    let fisheye = Fisheye::from_opencv([-0.02, 0.003, 0.001, -0.002]);
    for lens in [Lens::from(rational), Lens::from(fisheye)] {
        let cameras = rig().cameras().map(|camera| camera.with_distortion(lens).expect("a lens"));
        let rig = StereoRig::new(cameras, *rig().pose(), rig().sizes()).expect("a rig");
        assert!(near(&Rig::from_record(&rig.to_record()).expect("a rig"), &rig), "{lens:?}");
        let path = folder.path().join("rig.yml");
        std::fs::write(&path, write_opencv(&rig, &[])).expect("a file");
        assert!(near(&RawCalibration::open(&[path], None, None).expect("a rig").rig, &rig), "{lens:?}");
    }
}

#[test]
fn what_is_no_record_is_refused_by_name() {
    let record = rig().to_record();
    let read = |bytes: &[u8]| Rig::from_record(bytes).map(|_| ());
    assert_eq!(read(&[]), Err(RecordError::TooShort { needed: 328 }));
    assert_eq!(read(&record[..327]), Err(RecordError::TooShort { needed: 328 }));
    assert_eq!(read(&[0xff; 328]), Err(RecordError::NotARecord));
    let mut newer = record;
    newer[4] = 2;
    assert_eq!(read(&newer), Err(RecordError::Version { found: 2, known: 1 }));
    assert_eq!(read(&sealed(newer)), Err(RecordError::Version { found: 2, known: 1 }));
    for (number, value, why) in [
        (0, f64::NAN, RecordError::Camera(0, CameraModelError::NotFinite)),
        (0, -500.0, RecordError::Camera(0, CameraModelError::FocalLength)),
        (18, f64::INFINITY, RecordError::Camera(1, CameraModelError::NotFinite)),
        (26, 2.0, RecordError::Rig(StereoRigError::Pose(PoseError::NotARotation))),
        (35, f64::NAN, RecordError::Rig(StereoRigError::Pose(PoseError::NotFinite))),
    ] {
        assert_eq!(read(&with(number, value)), Err(why), "{number} {value}");
    }
    let mut other = record;
    other[18] = 2;
    assert_eq!(read(&sealed(other)), Err(RecordError::Lens { found: 2 }));
    let mut empty = record;
    empty[8..12].fill(0);
    assert_eq!(read(&sealed(empty)), Err(RecordError::Rig(StereoRigError::Size)));
    let nowhere = (35..38).fold(record, |mut record, number| {
        record[20 + 8 * number..][..8].fill(0);
        record
    });
    assert_eq!(read(&sealed(nowhere)), Err(RecordError::Rig(StereoRigError::NoBaseline)));
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// One wrong bit is never a rig.
    #[test]
    fn a_changed_bit_is_seen(bit in 0..328 * 8_usize) {
        let mut record = rig().to_record();
        record[bit / 8] ^= 1 << (bit % 8);
        prop_assert!(Rig::from_record(&record).is_err());
    }

    /// Whatever the bytes are, nothing panics.
    #[test]
    fn any_bytes_are_refused_or_a_rig(mut bytes in prop::collection::vec(any::<u8>(), 0..300),
        is_sealed in any::<bool>()) {
        if let (true, Some(record)) = (is_sealed, bytes.first_chunk_mut::<328>()) {
            record[..8].copy_from_slice(b"STRG\x01\x00\x48\x01");
            *record = sealed(*record);
        }
        let _ = Rig::from_record(&bytes);
    }
}

#[test]
fn files_are_the_rig_again() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let open = |name: &str, bytes: &[u8], images| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("a file");
        RawCalibration::open(&[path], images, None)
    };
    let opencv = open("rig.yml", write_opencv(&rig(), &["a note\nof two lines".into()]).as_bytes(), None)
        .expect("a rig");
    assert!(near(&opencv.rig, &rig()) && opencv.format == "OpenCV");
    let record = open("rig.bin", &rig().to_record(), None).expect("a rig");
    assert!(near(&record.rig, &rig()) && record.format == "record");
    let other = ImageSize { width: 640, height: 480 };
    for (name, bytes) in
        [("rig.yml", write_opencv(&rig(), &[]).into_bytes()), ("rig.bin", rig().to_record().to_vec())]
    {
        let error = open(name, &bytes, Some(other)).expect_err("another size").to_string();
        assert!(error.contains("width says 320"), "{error}");
    }
    let broken = open("rig.bin", &rig().to_record()[..200], None).expect_err("half a record").to_string();
    assert!(broken.contains("rig.bin: a record of a rig has 328 bytes"), "{broken}");
    // The constants hold the record's bytes.
    for text in [write_rust(&rig(), &["from a test".into()]), write_c(&rig(), &["from a test".into()])] {
        let bytes: Vec<u8> = text
            .split("0x")
            .skip(1)
            .map(|word| u8::from_str_radix(&word[..2], 16).expect("a byte"))
            .collect();
        assert_eq!(bytes, rig().to_record());
        assert!(text.starts_with("// from a test\n"));
    }
}
