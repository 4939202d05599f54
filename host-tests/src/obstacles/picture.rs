//! Stixels and sectors drawn on the left image.

use image::{Rgb, RgbImage};
use stereopsis::obstacles::{ObstacleConfig, ObstaclesView, SectorState, StixelKind};

/// Okabe and Ito's bluish green, vermillion, reddish purple, and a grey.
pub(super) const FREE: Rgb<u8> = Rgb([0x00, 0x9e, 0x73]);
pub(super) const OBSTACLE: Rgb<u8> = Rgb([0xd5, 0x5e, 0x00]);
pub(super) const DROP: Rgb<u8> = Rgb([0xcc, 0x79, 0xa7]);
pub(super) const BLIND: Rgb<u8> = Rgb([0x60, 0x60, 0x60]);

/// What the colours of [`picture`] mean.
pub const COLOURS: [(Rgb<u8>, &str); 4] = [
    (FREE, "ground that is seen; in the strip below the image a free sector"),
    (OBSTACLE, "an obstacle, the brighter the nearer; in the strip the brighter part is the higher"),
    (DROP, "a drop"),
    (BLIND, "in the strip a sector that is blind"),
];

/// The left image with the ground that is seen in green, obstacles in orange, the brighter the nearer, drops
/// in purple; below it a strip of sectors: free green, obstacles orange, drops purple, blind grey. The bright
/// part of an obstacle's bar is the higher the nearer it is.
pub fn picture(config: &ObstacleConfig, frame: &ObstaclesView<'_>, left: &RgbImage) -> RgbImage {
    let (width, height) = left.dimensions();
    let strip = (height / 10).max(8);
    let grey = |u: u32, v: u32| {
        let [r, g, b] = left.get_pixel(u, v).0.map(u32::from);
        Rgb([((r + 2 * g + b) / 4) as u8; 3])
    };
    let mut picture =
        RgbImage::from_fn(width, height + strip, |u, v| if v < height { grey(u, v) } else { BLIND });
    let stixels: Vec<_> = (0..frame.columns()).map(|x| frame.stixel(x)).collect();
    let nearest = stixels.iter().filter_map(|s| s.disparity.to_f32()).fold(1.0, f32::max);
    let cell = u32::from(config.cell_width);
    for (x, stixel) in stixels.iter().enumerate() {
        for u in (x as u32 * cell..(x as u32 + 1) * cell).take_while(|&u| u < width) {
            for v in u32::from(stixel.seen_row).min(height)..height {
                mix(&mut picture, u, v, FREE, 3);
            }
            if stixel.kind == StixelKind::Nothing {
                continue;
            }
            let share = stixel.disparity.to_f32().unwrap_or(0.0) / nearest;
            let colour = if stixel.kind == StixelKind::Drop { DROP } else { obstacle(share) };
            for v in u32::from(stixel.top_row)..=u32::from(stixel.base_row).min(height - 1) {
                let edge = v == u32::from(stixel.top_row) || v == u32::from(stixel.base_row);
                mix(&mut picture, u, v, colour, if edge { 8 } else { 5 });
            }
        }
    }
    let sectors: Vec<_> = (0..frame.sectors()).map(|i| frame.sector(i)).collect();
    let least_mm = sectors.iter().map(|s| s.depth_mm).filter(|&mm| mm > 0).min().unwrap_or(1);
    for (u, sector) in (0..width).filter_map(|u| Some((u, sectors.get(sector_at(frame, u, width))?))) {
        let (colour, part) = match sector.state {
            SectorState::Blind => continue,
            SectorState::Free => (FREE, 1.0),
            SectorState::Obstacle => (OBSTACLE, f32::from(least_mm) / f32::from(sector.depth_mm.max(1))),
            SectorState::Drop => (DROP, f32::from(least_mm) / f32::from(sector.depth_mm.max(1))),
        };
        let rows = (part * strip as f32).ceil() as u32;
        for v in 1..strip {
            picture.put_pixel(u, height + strip - v, if v <= rows { colour } else { dark(colour) });
        }
    }
    picture
}

/// The colour of an obstacle that has so much of the nearest one's disparity.
fn obstacle(share: f32) -> Rgb<u8> {
    let brightness = 0.25 + 0.75 * share;
    Rgb(OBSTACLE.0.map(|value| (f32::from(value) * brightness) as u8))
}

/// The colour at a third of its brightness.
fn dark(colour: Rgb<u8>) -> Rgb<u8> {
    Rgb(colour.0.map(|value| value / 3))
}

/// Mixes so many eighths of a colour into a pixel.
fn mix(picture: &mut RgbImage, u: u32, v: u32, colour: Rgb<u8>, eighths: u16) {
    let pixel = picture.get_pixel_mut(u, v);
    for (to, from) in pixel.0.iter_mut().zip(colour.0) {
        *to = ((u16::from(*to) * (8 - eighths) + u16::from(from) * eighths) / 8) as u8;
    }
}

/// The sector below column `u`: sectors have equal angles, so those at the sides are wider.
fn sector_at(frame: &ObstaclesView<'_>, u: u32, width: u32) -> usize {
    let mut scan = [0.0; ObstacleConfig::MOST_SECTORS];
    let scan = frame.laser_scan(&mut scan);
    let half = scan.angle_increment / 2.0;
    // Angles are to the left.
    let (first, last) = ((-scan.angle_max - half).tan(), (-scan.angle_min + half).tan());
    let tangent = first + (last - first) * u as f32 / (width.max(2) - 1) as f32;
    let place = (tangent.atan() - first.atan()) / scan.angle_increment.max(1e-6);
    (place.max(0.0) as usize).min(frame.sectors().saturating_sub(1))
}
