//! The pipeline held to its naive twin: every disparity, flag, deviation and confidence, to the bit, for
//! every kernel; images through a remap.

use crate::scene::SceneCamera;
use crate::twin::{self, Answers, match_pair};
use image::GrayImage;
use stereopsis::camera::StereoSource;
use stereopsis::imaging::{Remap, RemapError, RemapTable};
use stereopsis::matching::{Block, Config, Fast, Kernel, Method, Sgm, SgmEdge, SgmLean};
use stereopsis::pipeline::{Pipeline, PipelineError};

/// A method of the core with the twin's description of it.
pub trait Twin: Method {
    /// The method as the twin knows it.
    const TWIN: twin::Method;
}

impl Twin for Fast {
    const TWIN: twin::Method = twin::Method::FAST;
}

impl Twin for Block {
    const TWIN: twin::Method = twin::Method::BLOCK;
}

impl Twin for Sgm {
    const TWIN: twin::Method = twin::Method::SGM;
}

impl Twin for SgmEdge {
    const TWIN: twin::Method = twin::Method::SGM_EDGE;
}

impl Twin for SgmLean {
    const TWIN: twin::Method = twin::Method::SGM_LEAN;
}

/// All rows of the camera's next frame; panics where a row is left out.
pub fn rows<S: Method, C: StereoSource, const W: usize, const D: usize>(
    pipeline: &mut Pipeline<S, W, D>,
    camera: &mut C,
) -> Result<Answers, PipelineError<C::Error>> {
    let format = camera.format();
    let (width, height) = (usize::from(format.width), usize::from(format.height));
    let (disparity, flags, sigma_px, confidence) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut map = Answers { width, height, disparity, flags, sigma_px, confidence };
    pipeline.begin_frame(camera)?;
    let mut due = 0;
    while let Some(row) = pipeline.next_row(camera)? {
        assert_eq!(row.index(), due, "rows come in order");
        due += 1;
        map.disparity.extend_from_slice(row.disparities());
        map.flags.extend_from_slice(row.flags());
        map.confidence.extend_from_slice(row.confidences());
        map.sigma_px.extend((0..width).map(|x| row.sigma_px(x)));
        assert_eq!(row.sigma_px(width), None, "there is no pixel beside the image");
    }
    assert_eq!(due, format.height, "every row comes out");
    Ok(map)
}

/// Where two maps differ first, in words; `None` where they are equal.
pub fn difference(core: &Answers, twin: &Answers) -> Option<String> {
    assert_eq!((core.width, core.height), (twin.width, twin.height));
    assert_eq!(core.disparity.len(), twin.disparity.len());
    assert_eq!(core.confidence.len(), twin.confidence.len());
    let bits = |sigma: Option<f32>| sigma.map(f32::to_bits);
    let at = (0..core.disparity.len()).find(|&i| {
        core.disparity[i] != twin.disparity[i]
            || core.flags[i] != twin.flags[i]
            || bits(core.sigma_px[i]) != bits(twin.sigma_px[i])
            || core.confidence.get(i) != twin.confidence.get(i)
    })?;
    let pixel = |map: &Answers| {
        let (raw, flags) = (map.disparity[at].raw(), map.flags[at].bits());
        format!(
            "raw {raw} flags {flags:#08b} sigma {:?} confidence {:?}",
            map.sigma_px[at],
            map.confidence.get(at)
        )
    };
    let (x, y) = (at % core.width, at / core.width);
    Some(format!("column {x}, row {y}: the core says {}, the twin {}", pixel(core), pixel(twin)))
}

/// Runs the pair through the pipeline with every kernel of this processor and compares with the twin, whose
/// answers are returned; the error says in words where they differ first, or what was refused.
pub fn compare<S: Twin, const W: usize, const D: usize>(
    pipeline: &mut Pipeline<S, W, D>,
    config: &Config,
    pair: &(GrayImage, GrayImage),
) -> Result<Answers, String> {
    let expected = match_pair(&S::TWIN, config, &pair.0, &pair.1);
    compare_with(&expected, pipeline, config, pair)?;
    Ok(expected)
}

/// Runs the pair through the pipeline with every kernel of this processor and compares with the answers that
/// the twin gave to it; the error is that of [`compare`].
pub fn compare_with<S: Twin, const W: usize, const D: usize>(
    expected: &Answers,
    pipeline: &mut Pipeline<S, W, D>,
    config: &Config,
    pair: &(GrayImage, GrayImage),
) -> Result<(), String> {
    for kernel in Kernel::available() {
        pipeline.set_kernel(kernel).map_err(|e| format!("{}: {e}", kernel.name()))?;
        pipeline.start(config).map_err(|e| format!("{config:?}: {e}"))?;
        assert_eq!(pipeline.kernel(), kernel);
        let mut camera = SceneCamera::new(pair.0.clone(), pair.1.clone());
        let map = rows(pipeline, &mut camera).map_err(|e| format!("{config:?}: {e}"))?;
        if let Some(where_first) = difference(&map, expected) {
            return Err(format!("{} with kernel {}: {where_first}; {config:?}", S::NAME, kernel.name()));
        }
    }
    Ok(())
}

/// The whole image through a remap that holds `N` lines, and which pixels are valid (1 or 0).
pub fn remapped<const W: usize, const N: usize, const SLOTS: usize>(
    table: &RemapTable<SLOTS>,
    raw: &GrayImage,
) -> Result<(GrayImage, Vec<u8>), RemapError> {
    let mut remap = Box::new(Remap::<W, N, SLOTS>::new(table.clone())?);
    let width = usize::from(table.size().width);
    let (mut out, mut valid) = (GrayImage::new(width as u32, table.size().height.into()), Vec::new());
    // Twice: the second frame begins anew.
    for _ in 0..2 {
        valid.clear();
        let mut lines = raw.chunks_exact(raw.width() as usize);
        remap.begin();
        for (row, out) in (0..).zip(out.chunks_exact_mut(width)) {
            assert_eq!(remap.next_row(), row);
            // At any place in a word.
            let begin = usize::from(row % 4);
            let mut mask = vec![9; begin + width];
            while remap.wants_line() {
                remap.next_line().copy_from_slice(lines.next().expect("it wants no more than there are"));
                remap.accept();
            }
            assert_eq!(remap.row(out, &mut mask[begin..])?, row);
            valid.extend_from_slice(&mask[begin..]);
        }
    }
    assert_eq!(remap.next_row(), table.size().height);
    assert_eq!(remap.row(&mut [], &mut []), Err(RemapError::NoLineLeft));
    Ok((out, valid))
}
