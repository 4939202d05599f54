//! P1, P2 and truncations of semi-global matching (Hirschmüller 2008), by how brightness changes.

/// The numbers of the methods along paths, [`Sgm`](super::Sgm), [`SgmLean`](super::SgmLean) and
/// [`SgmEdge`](super::SgmEdge); the block methods do not look at them. Each method's own,
/// [`Method::PENALTIES`](super::Method::PENALTIES), are what measured best on real pairs.
///
/// A path's cost at a pixel and disparity is the pixel's own cost and the least of its predecessor's costs:
/// at the same disparity for nothing, at the next one for a `step`, at any other for a `jump` (Hirschmüller
/// 2008).
///
/// A matcher starts with penalties that are in order and bounded, with the largest jump; all kernels give the
/// same bits for every one of them:
///
/// * `cost >= 1`, `1 <= step[1] <= step[0] <= jump[0]`, `step[1] <= jump[1]`, `step[1] <= jump[2]`,
///   `edges[0] <= edges[1]`;
/// * `cost + step[0] + jump <= 127`: what a path costs, at most `cost + jump`, and the step from it take
///   seven bits. The least cost of a path is at most `cost`, that of the average of two above at most
///   `cost + jump / 2`; with a jump it stays below 189, and no other cost is more than 127 away from it;
/// * `3 cost + 2 jump <= 254`: a winner's sum of three paths, of which one agrees with it, is none that was
///   cut off at 255.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Penalties {
    /// A pixel's gradients are cut off at this many units to each side, 1 to [`Self::MOST_GRADIENT`]. The
    /// unit is an eighth of a grey level per pixel: a gradient is that of Sobel's operator. With
    /// [`Noise::Low`](crate::imaging::Noise::Low) it is a quarter, with
    /// [`Noise::High`](crate::imaging::Noise::High) a half.
    pub gradient: u8,
    /// Truncation of a pixel's matching cost.
    pub cost: u8,
    /// P1: penalty of a disparity change of one px, where the left image's brightness changes little, and
    /// where it changes more.
    pub step: [u8; 2],
    /// P2: penalty of a larger disparity change, where brightness changes little, more, and much.
    pub jump: [u8; 3],
    /// The changes of brightness, in grey levels, at which it is more, and much. Down a column, much is what
    /// [`SgmEdge`](super::SgmEdge) averages no costs across.
    pub edges: [u8; 2],
}

impl Penalties {
    /// The widest range of gradients: a pixel's cost stays within seven bits.
    pub const MOST_GRADIENT: u8 = 14;

    /// What measured best.
    pub const DEFAULT: Self =
        Self { gradient: 7, cost: 16, step: [18, 9], jump: [88, 28, 16], edges: [6, 12] };

    /// Penalties for smoothed lines, whose gradients may be larger before they are cut off.
    /// `cargo xtask altered` measures them, and any others.
    pub(super) const fn in_noise(self) -> Self {
        Self { gradient: 9, ..self }
    }

    /// All zero: of a matcher that was not started.
    pub(super) const UNSET: Self = Self { gradient: 0, cost: 0, step: [0; 2], jump: [0; 3], edges: [0; 2] };

    /// Whether all sums stay within their bytes: the bounds in the type's description.
    pub(super) const fn check(&self) -> Result<(), PenaltiesError> {
        let Self { gradient, cost, step: [step, small_step], jump: [little, more, much], edges } = *self;
        let most = if little > more { little } else { more };
        let most = if most > much { most } else { much };
        let least = if more < much { more } else { much };
        if gradient < 1 || gradient > Self::MOST_GRADIENT {
            return Err(PenaltiesError::Gradient);
        }
        if cost < 1 || small_step < 1 || small_step > step || edges[0] > edges[1] {
            return Err(PenaltiesError::Order);
        }
        if step > little || small_step > least {
            return Err(PenaltiesError::Order);
        }
        let (cost, step, jump) = (cost as u16, step as u16, most as u16);
        if cost + step + jump > 127 || cost + 2 * (cost + jump) >= 255 {
            return Err(PenaltiesError::Order);
        }
        Ok(())
    }

    /// What a step and a jump cost where the left image's brightness changes little, more and much.
    #[inline(always)]
    pub(super) fn changes(&self) -> [Change; 3] {
        let Self { step: [step, small_step], jump: [little, more, much], .. } = *self;
        [
            Change { step, jump: little },
            Change { step: small_step, jump: more },
            Change { step: small_step, jump: much },
        ]
    }
}

/// What is wrong with [`Penalties`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum PenaltiesError {
    /// The range of gradients is 0 or over [`Penalties::MOST_GRADIENT`].
    Gradient,
    /// The penalties are not in order, or a sum of them is over its byte.
    Order,
}

/// What changes of the disparity cost between two pixels.
#[derive(Clone, Copy)]
pub(super) struct Change {
    pub step: u8,
    pub jump: u8,
}

impl Default for Penalties {
    fn default() -> Self {
        Self::DEFAULT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the type's description derives of the bounds, for every cost, step and jump that a byte can be.
    #[test]
    fn no_sum_overflows_its_byte() {
        let mut accepted = 0;
        for (cost, jump) in (0..=255).flat_map(|cost| (0..=255).map(move |jump| (cost, jump))) {
            for step in 0..=255 {
                let penalties = Penalties { cost, step: [step, 1], jump: [jump, 1, 1], ..Penalties::DEFAULT };
                if penalties.check().is_err() {
                    continue;
                }
                accepted += 1;
                let [cost, step, jump] = [cost, step, jump].map(u16::from);
                // A path's cost and a step from it; a winner's sum of three paths, of which one agrees.
                assert!(cost + jump + step <= 127 && cost + 2 * (cost + jump) < 255, "{penalties:?}");
                // The least of a path, and of the average of two, with a jump.
                assert!(cost + jump <= 127 && cost + jump / 2 + jump < 189, "{penalties:?}");
            }
        }
        assert_eq!(accepted, 140_569);
    }

    /// Every rule in its own words.
    fn is_right(penalties: &Penalties) -> bool {
        let Penalties { cost, step, jump, edges, .. } = *penalties;
        let most = jump.into_iter().max().map_or(0, u32::from);
        let (cost, first_step) = (u32::from(cost), u32::from(step[0]));
        cost >= 1
            && step[1] >= 1
            && step[0] >= step[1]
            && jump[0] >= step[0]
            && jump[1] >= step[1]
            && jump[2] >= step[1]
            && edges[0] <= edges[1]
            && cost + first_step + most < 128
            && 3 * cost + 2 * most < 255
    }

    #[test]
    fn each_rule_holds_at_its_limit() {
        let jumps = [0, 1, 8, 9, 60, 103, 104, 111, 112, 126, 255];
        let jumps = || {
            jumps.into_iter().flat_map(move |a| jumps.into_iter().flat_map(move |b| jumps.map(|c| [a, b, c])))
        };
        let mut taken = 0;
        for cost in [0, 1, 2, 8, 9, 15, 16, 17, 50, 51, 84, 85, 125, 126, 255] {
            for step in [[0, 0], [1, 0], [1, 1], [1, 2], [8, 8], [8, 9], [9, 8], [60, 9], [63, 1], [255, 1]] {
                for (jump, edges) in jumps().zip([[6, 12], [0, 0], [9, 8], [255, 255]].into_iter().cycle()) {
                    let penalties = Penalties { gradient: 7, cost, step, jump, edges };
                    assert_eq!(penalties.check().is_ok(), is_right(&penalties), "{penalties:?}");
                    taken += usize::from(is_right(&penalties));
                }
            }
        }
        assert!(taken > 1000, "{taken}");
        for gradient in 0..=255 {
            let is_known = (1..=14).contains(&gradient);
            let expected = if is_known { Ok(()) } else { Err(PenaltiesError::Gradient) };
            assert_eq!(Penalties { gradient, ..Penalties::DEFAULT }.check(), expected, "{gradient}");
        }
    }

    #[test]
    fn each_change_has_its_step_and_jump() {
        let penalties = Penalties { step: [18, 9], jump: [88, 28, 16], ..Penalties::DEFAULT };
        let changes = penalties.changes().map(|change| (change.step, change.jump));
        assert_eq!(changes, [(18, 88), (9, 28), (9, 16)]);
        assert_eq!(penalties.in_noise(), Penalties { gradient: 9, ..penalties });
    }
}
