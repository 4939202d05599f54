//! The calibration record: a stereo rig as bytes for flash.

use super::distortion::Distortion;
use super::fisheye::Fisheye;
use super::lens::Lens;
use super::pinhole::{Camera, CameraModelError};
use super::pose::Pose;
use super::stereo_rig::{ImageSize, StereoRig, StereoRigError};
use crate::geometry::Real;
use nalgebra::{Matrix3, Vector3};

/// What every record begins with.
const MAGIC: [u8; 4] = *b"STRG";
/// The version that is written, and the only one that is read.
const VERSION: u16 = 1;
/// The numbers: fx, fy, cx, cy, skew and eight coefficients of both cameras; R row by row; t.
const NUMBERS: usize = 2 * (5 + 8) + 9 + 3;
/// Where the numbers begin: behind the magic, the version, the length, both images' columns and rows and both
/// lenses' models.
const HEAD: usize = 4 + 2 + 2 + 8 + 4;
/// The models of lenses.
const BROWN_CONRADY: u16 = 0;
const FISHEYE: u16 = 1;
const BODY: usize = HEAD + 8 * NUMBERS;

/// Why bytes are no record of a rig.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RecordError {
    /// Fewer bytes than a record has.
    TooShort {
        /// Bytes that are needed.
        needed: usize,
    },
    /// The bytes begin with something else: erased flash, or another file.
    NotARecord,
    /// The record is of a version that this build does not know.
    Version {
        /// The version of the record.
        found: u16,
        /// The version that is read.
        known: u16,
    },
    /// The checksum is not that of the bytes: a bit has changed, or the record was written in part.
    Checksum,
    /// A lens is of a model that this build does not know, or has more coefficients than its model.
    Lens {
        /// The model's number.
        found: u16,
    },
    /// The first (0) or the second (1) camera's numbers are out of range.
    Camera(u8, CameraModelError),
    /// The numbers are no rig.
    Rig(StereoRigError),
}

error_text!(RecordError {
    Self::TooShort { needed } => "a record of a rig has {needed} bytes; these are fewer",
    Self::NotARecord => "the bytes are no record of a rig, which begins with STRG",
    Self::Version { found, known } => "the record is of version {found}; version {known} is read",
    Self::Checksum => "the record's checksum is wrong: it was changed or written in part",
    Self::Lens { found: found @ (BROWN_CONRADY | FISHEYE) } =>
        "the record's lens has more coefficients than its model, {found}",
    Self::Lens { found } => "the record has a lens of model {found}; 0 and 1 are read",
    Self::Camera(which, error) => "camera {which}: {error}",
    Self::Rig(error) => "{error}",
});

impl<T: Real> StereoRig<T> {
    /// Bytes of a record.
    pub const RECORD_BYTES: usize = BODY + 4;

    /// The rig as a record, for flash or a file: fixed in size, little-endian.
    ///
    /// | bytes | what |
    /// | --- | --- |
    /// | 0 to 3 | `STRG` |
    /// | 4, 5 | version, 1 |
    /// | 6, 7 | bytes in all, 328 |
    /// | 8 to 15 | columns and rows of the first camera's images, then of the second's |
    /// | 16 to 19 | the model of the first lens, then of the second: 0 [`Distortion`], 1 [`Fisheye`] |
    /// | 20 to 227 | fx, fy, cx, cy, skew (px), eight coefficients; first camera, then second, `f64` |
    /// | 228 to 299 | R, row by row, and |
    /// | 300 to 323 | t (m), with `P = R P' + t` from the second camera into the first |
    /// | 324 to 327 | CRC-32 of all before (ISO-HDLC: reversed 0x04C11DB7, as in Ethernet and zip) |
    ///
    /// The coefficients are k1, k2, p1, p2, k3, k4, k5, k6 of a [`Distortion`], k1 to k4 and zeros of a
    /// [`Fisheye`].
    ///
    /// ```
    /// use stereopsis::geometry::camera::{Camera, ImageSize, Pose, RecordError, StereoRig};
    /// use nalgebra::{Matrix3, Vector3};
    /// let camera = Camera::new(500.0, 500.0, 319.5, 239.5)?;
    /// let beside = Pose::new(Matrix3::identity(), Vector3::new(0.06, 0.0, 0.0))?;
    /// let rig = StereoRig::new([camera; 2], beside, [ImageSize { width: 640, height: 480 }; 2])?;
    /// let mut flash = rig.to_record();
    /// assert_eq!(StereoRig::from_record(&flash), Ok(rig));
    /// flash[20] ^= 1;
    /// assert_eq!(StereoRig::<f64>::from_record(&flash), Err(RecordError::Checksum));
    /// assert_eq!(StereoRig::<f32>::from_record(&[0xff; 512]), Err(RecordError::NotARecord));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn to_record(&self) -> [u8; BODY + 4] {
        let [first, second] = self.sizes();
        let [left, right] = self.cameras().each_ref().map(|camera| coefficients(camera.lens()));
        let (all, sides) = ((BODY + 4) as u16, [first.width, first.height, second.width, second.height]);
        let words =
            [VERSION, all].into_iter().chain(sides).chain([left.0, right.0]).flat_map(u16::to_le_bytes);
        let cameras = self.cameras().iter().zip([left.1, right.1]).flat_map(|(camera, lens)| {
            let ((fx, fy), (cx, cy)) = (camera.focal_px(), camera.principal_point());
            [fx, fy, cx, cy, camera.skew_px()].into_iter().chain(lens)
        });
        let rows = self.pose().rotation().transpose();
        let numbers = cameras.chain(rows.iter().copied()).chain(self.pose().translation().iter().copied());
        let mut record = [0; BODY + 4];
        let bytes = MAGIC.into_iter().chain(words).chain(numbers.flat_map(|x| x.to_f64().to_le_bytes()));
        record.iter_mut().zip(bytes).for_each(|(to, byte)| *to = byte);
        if let Some((body, checksum)) = record.split_last_chunk_mut::<4>() {
            *checksum = crc32(body).to_le_bytes();
        }
        record
    }

    /// The rig of a record at the beginning of `bytes`; what follows it is not looked at. A record that is
    /// not whole, of another version or of impossible numbers is refused by name: there is no rig by
    /// default.
    ///
    /// R is held as it is recorded, off from a rotation by 2e-4 at the most, as [`Pose::new`] accepts: in
    /// `f64`, [`Self::to_record`] writes again the bytes that were read.
    pub fn from_record(bytes: &[u8]) -> Result<Self, RecordError> {
        let too_short = RecordError::TooShort { needed: Self::RECORD_BYTES };
        if bytes.first_chunk().is_some_and(|magic| *magic != MAGIC) {
            return Err(RecordError::NotARecord);
        }
        let record: &[u8; BODY + 4] = bytes.first_chunk().ok_or(too_short)?;
        let (body, checksum) = record.split_last_chunk::<4>().ok_or(too_short)?;
        let (head, numbers) = body.split_first_chunk::<HEAD>().ok_or(too_short)?;
        let [_, _, _, _, v0, v1, l0, l1, sizes @ ..] = head;
        let version = u16::from_le_bytes([*v0, *v1]);
        if version != VERSION {
            return Err(RecordError::Version { found: version, known: VERSION });
        }
        if crc32(body) != u32::from_le_bytes(*checksum)
            || usize::from(u16::from_le_bytes([*l0, *l1])) != record.len()
        {
            return Err(RecordError::Checksum);
        }
        let [w0, w1, h0, h1, x0, x1, y0, y1, m0, m1, n0, n1] = *sizes;
        let size = |w: [u8; 2], h: [u8; 2]| ImageSize {
            width: u16::from_le_bytes(w),
            height: u16::from_le_bytes(h),
        };
        let sizes = [size([w0, w1], [h0, h1]), size([x0, x1], [y0, y1])];
        let mut values = [T::ZERO; NUMBERS];
        let (chunks, _) = numbers.as_chunks::<8>();
        values.iter_mut().zip(chunks).for_each(|(to, bytes)| *to = T::of(f64::from_le_bytes(*bytes)));
        let (numbers, rest) = values.split_first_chunk::<26>().ok_or(too_short)?;
        let [first, second] = numbers.as_chunks::<13>().0 else { return Err(too_short) };
        let &[r0, r1, r2, r3, r4, r5, r6, r7, r8, t0, t1, t2] = rest else { return Err(too_short) };
        let first = camera(0, u16::from_le_bytes([m0, m1]), first)?;
        let second = camera(1, u16::from_le_bytes([n0, n1]), second)?;
        let rotation = Matrix3::new(r0, r1, r2, r3, r4, r5, r6, r7, r8);
        let pose = Pose::of_parts(rotation, Vector3::new(t0, t1, t2)).checked(T::of(Pose::<T>::TOLERANCE));
        let pose = pose.map_err(|error| RecordError::Rig(StereoRigError::Pose(error)))?;
        Self::new([first, second], pose, sizes).map_err(RecordError::Rig)
    }
}

/// A lens's model, and its coefficients with zeros behind them.
fn coefficients<T: Real>(lens: &Lens<T>) -> (u16, [T; 8]) {
    match lens {
        Lens::BrownConrady(distortion) => (BROWN_CONRADY, distortion.to_opencv()),
        Lens::Fisheye(fisheye) => {
            let [k1, k2, k3, k4] = fisheye.to_opencv();
            (FISHEYE, [k1, k2, k3, k4, T::ZERO, T::ZERO, T::ZERO, T::ZERO])
        }
    }
}

/// A camera of fx, fy, cx, cy, skew and its coefficients.
fn camera<T: Real>(which: u8, model: u16, numbers: &[T; 13]) -> Result<Camera<T>, RecordError> {
    let [fx, fy, cx, cy, skew, lens @ ..] = *numbers;
    let lens = match (model, lens) {
        (BROWN_CONRADY, lens) => Lens::from(Distortion::from_opencv_rational(lens)),
        // Zeros as they are written, not -0: what is read is written again.
        (FISHEYE, [k1, k2, k3, k4, rest @ ..]) if rest.iter().all(|k| k.to_f64().to_bits() == 0) => {
            Fisheye::from_opencv([k1, k2, k3, k4]).into()
        }
        (found, _) => return Err(RecordError::Lens { found }),
    };
    let camera = Camera::new(fx, fy, cx, cy).and_then(|camera| camera.with_skew(skew)?.with_distortion(lens));
    camera.map_err(|error| RecordError::Camera(which, error))
}

/// CRC-32/ISO-HDLC, bit by bit: a record is read once.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, byte: &u8| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 & 0u32.wrapping_sub(crc & 1)))
    };
    !bytes.iter().fold(u32::MAX, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_the_usual_one() {
        // The catalogue's check value, of the digits 1 to 9.
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    }
}
