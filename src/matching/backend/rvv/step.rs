//! A path's step.

use crate::matching::penalties::Penalties;

/// A cost that no path comes from, nor from a step beside it: more than any path costs (`Penalties::check`).
pub(super) fn far(penalties: &Penalties) -> u32 {
    127 - u32::from(penalties.step[0])
}

/// Moves the path in `v8` on to a pixel: `least` is the least that it costs, `step` and `jump` what changes
/// cost there, and at `costs` stand the pixel's. Nine instructions.
///
/// With m the least that it costs to come from near, it is `min(m - least, jump) + cost`. Beside the ends
/// of a column is `far`, a cost that no path comes from: with a step it is 127 at most, more than any path
/// costs.
macro_rules! step {
    ($step:literal, $jump:literal) => {
        concat!(
            "vslide1up.vx v16, v8, {far}\n",
            "vslide1down.vx v24, v8, {far}\n",
            "vminu.vv v16, v16, v24\n",
            "vadd.vx v16, v16, {",
            $step,
            "}\n",
            "vminu.vv v16, v16, v8\n",
            "vsub.vx v16, v16, {least}\n",
            "vminu.vx v16, v16, {",
            $jump,
            "}\n",
            "vle8.v v8, ({costs})\n",
            "vadd.vv v8, v8, v16",
        )
    };
}

/// What the least number of a group is, in the lowest byte of a register. `v1` has 255 in its first lane.
macro_rules! least {
    ($group:literal, $to:literal) => {
        concat!("vredminu.vs v2, ", $group, ", v1\n", "vmv.x.s {", $to, "}, v2")
    };
}

/// What a step and a jump cost at the next pixel.
macro_rules! change {
    ($step:literal, $jump:literal, $at:literal) => {
        concat!("lhu {", $step, "}, 0({", $at, "})\n", "srli {", $jump, "}, {", $step, "}, 8")
    };
}

/// How many bits of the codes in `v16` and of a code differ: of pairs, of fours, and of all.
macro_rules! bits_apart {
    ($code:literal) => {
        concat!(
            "vxor.vx v16, v16, {",
            $code,
            "}\n",
            "vsrl.vi v24, v16, 1\n",
            "vand.vx v24, v24, {odd}\n",
            "vsub.vv v16, v16, v24\n",
            "vsrl.vi v24, v16, 2\n",
            "vand.vx v24, v24, {pairs}\n",
            "vand.vx v16, v16, {pairs}\n",
            "vadd.vv v16, v16, v24\n",
            "vsrl.vi v24, v16, 4\n",
            "vadd.vv v16, v16, v24\n",
            "vand.vi v16, v16, 15"
        )
    };
}
