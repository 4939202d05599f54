//! The winner of a pixel, of the costs of all its candidates.

/// Finds the winner of the costs in `v16`, and puts it in its place; they are put in the `room`, which has
/// a byte more at both ends.
///
/// * The loop begins at `2`; `first` is the first lane that has a candidate, `last` the last one, whose
///   disparity is the smallest. Lanes before the first have 255.
/// * If `asked`, the least cost farther than two px beside the winner goes to `second`.
/// * `v1` has 255 in its first lane, `v4` has 0.
macro_rules! winner {
    () => {
        concat!(
            "vse8.v v16, ({room})\n",
            least!("v16", "best"),
            // Of those with the least cost the last one, which has the smallest disparity.
            "\nvmseq.vx v0, v16, {best}\n",
            "vid.v v24\n",
            "vredmaxu.vs v2, v24, v4, v0.t\n",
            "vmv.x.s {lane}, v2\n",
            "beqz {asked}, 6f\n",
            "addi {below}, {lane}, -2\n",
            "vsub.vx v24, v24, {below}\n",
            "vmsgtu.vi v0, v24, 4\n",
            "vredminu.vs v2, v16, v1, v0.t\n",
            "vmv.x.s {below}, v2\n",
            "sb {below}, 0({second})\n",
            "6:\n",
            "add {above}, {room}, {lane}\n",
            "lbu {below}, 1({above})\n",
            "lbu {above}, -1({above})\n",
            "beq {lane}, {last}, 3b\n",
            "beq {lane}, {first}, 4b\n",
            "5:\n",
            "sb {below}, 0({winners})\n",
            "sb {best}, 1({winners})\n",
            "sb {above}, 2({winners})\n",
            "sub {lane}, {last}, {lane}\n",
            "sb {lane}, 3({winners})"
        )
    };
}

/// What [`winner`] does where one beside the winner is no candidate: it goes before the loop.
macro_rules! winner_at_ends {
    () => {
        "j 2f
        // The smallest disparity has the other side for what is below it, an only one itself.
        3:
        mv {below}, {above}
        bne {lane}, {first}, 5f
        mv {below}, {best}
        mv {above}, {best}
        j 5f
        // The largest one has none above.
        4:
        mv {above}, {below}
        j 5f
        2:"
    };
}
