//! Records of rigs.

use arbitrary::{Result, Unstructured};
use nalgebra::{Matrix3, Vector3};
use stereopsis::geometry::camera::StereoRig;

/// What is read of a record is a rig, and the record that is written of it is the one that was read.
pub fn come_back(u: &mut Unstructured<'_>) -> Result<()> {
    let mut bytes = vec![0; StereoRig::<f64>::RECORD_BYTES];
    u.fill_buffer(&mut bytes)?;
    if u.arbitrary()? {
        seal(&mut bytes);
    }
    let length = if u.ratio(1, 8)? { u.int_in_range(0..=bytes.len())? } else { bytes.len() };
    let Ok(rig) = StereoRig::<f64>::from_record(&bytes[..length]) else { return Ok(()) };
    assert_eq!(&rig.to_record()[..], &bytes[..length], "the record comes back");
    let pose = rig.pose();
    let turn: Matrix3<f64> = *pose.rotation();
    assert!((turn.transpose() * turn - Matrix3::identity()).norm() < 1e-6, "{turn}");
    assert!(pose.translation().iter().all(|v| v.is_finite()) && rig.baseline_m().is_finite(), "{rig:?}");
    assert!(*pose.translation() != Vector3::zeros(), "{rig:?}");
    Ok(())
}

/// Makes the last four bytes the checksum of those before.
pub fn seal(bytes: &mut [u8]) {
    let body = bytes.len() - 4;
    let crc = checksum(&bytes[..body]).to_le_bytes();
    bytes[body..].copy_from_slice(&crc);
}

/// CRC-32/ISO-HDLC, bit by bit.
fn checksum(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
    !bytes.iter().fold(u32::MAX, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), step))
}
