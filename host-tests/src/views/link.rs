//! Which corners of several pictures are one point.

use crate::correspond::{CorrespondError, Plan, features, matches};
use image::GrayImage;
use nalgebra::Point2;
use stereopsis::features::{Feature, Orientation};
use stereopsis::motion::bundle::Observation;

/// Pictures that are compared with one: those up to so many before it.
const REACH: usize = 4;

/// Points that two pictures or more show.
#[derive(Clone, Debug, Default)]
pub struct Links {
    /// Where they are seen, sorted by point.
    pub observations: Vec<Observation<f64>>,
    /// How many points there are.
    pub points: usize,
}

/// Corners that are the same point in pictures near each other, and chains of those. A chain that comes to
/// two corners of one picture is wrong somewhere, and left out.
pub fn link(plan: &Plan, pictures: &[GrayImage], told: impl Fn()) -> Result<Links, CorrespondError> {
    let mut corners: Vec<Vec<Feature>> = Vec::new();
    // Every corner of every picture by a number, and the one that stands for all it is linked to.
    let (mut firsts, mut stands) = (Vec::new(), Vec::new());
    for picture in pictures {
        let own = features(plan, Orientation::Upright, picture)?;
        firsts.push(stands.len());
        stands.extend(stands.len()..stands.len() + own.len());
        for (other, before) in corners.iter().enumerate().rev().take(REACH) {
            for found in matches(plan, before, &own)? {
                let a = root(&mut stands, firsts[other] + usize::from(found.left));
                let b = root(&mut stands, firsts[corners.len()] + usize::from(found.right));
                stands[a.max(b)] = a.min(b);
            }
        }
        corners.push(own);
        told();
    }
    let mut chains: Vec<Vec<(usize, Point2<f64>)>> = vec![Vec::new(); stands.len()];
    for (view, own) in corners.iter().enumerate() {
        for (n, corner) in own.iter().enumerate() {
            let chain = root(&mut stands, firsts[view] + n);
            chains[chain].push((view, Point2::new(corner.x_px.into(), corner.y_px.into())));
        }
    }
    let mut links = Links::default();
    for chain in chains {
        // Views come in their order.
        if chain.len() < 2 || chain.windows(2).any(|pair| pair[0].0 == pair[1].0) {
            continue;
        }
        let point = links.points as u32;
        links.points += 1;
        let observation =
            |(view, pixel): (usize, Point2<f64>)| Observation { point, view: view as u16, eye: 0, pixel };
        links.observations.extend(chain.into_iter().map(observation));
    }
    Ok(links)
}

/// The corner that stands for this one.
fn root(stands: &mut [usize], mut at: usize) -> usize {
    while stands[at] != at {
        stands[at] = stands[stands[at]];
        at = stands[at];
    }
    at
}
