//! Pieces of the rows' assembly. What is said of instructions is for one word.

/// One instruction, of registers by their names.
macro_rules! op {
    ($name:literal, $to:literal, $one:literal, $other:literal) => {
        concat!($name, " {", $to, "}, {", $one, "}, {", $other, "}\n")
    };
}

/// A shift, or an addition of a number.
macro_rules! by {
    ($name:literal, $to:literal, $one:literal, $number:literal) => {
        concat!($name, " {", $to, "}, {", $one, "}, ", $number, "\n")
    };
}

/// What stands at so many bytes from where a register points to.
macro_rules! at {
    ($name:literal, $word:literal, $offset:literal, $place:literal) => {
        concat!($name, " {", $word, "}, ", $offset, "({", $place, "})\n")
    };
}

/// Makes `t` what the first of two numbers, a marked one, is over the second. 4 instructions.
macro_rules! over {
    ($marked:literal, $other:literal) => {
        concat!(
            op!("sub", "t", $marked, $other),
            op!("and", "u", "t", "top"),
            op!("mulhu", "u", "u", "below"),
            op!("and", "t", "t", "u"),
        )
    };
}

/// Makes the marked number the lesser of it and another one. 5 instructions.
macro_rules! lesser {
    ($marked:literal, $other:literal) => {
        concat!(over!($marked, $other), op!("sub", $marked, $marked, "t"))
    };
}

/// Makes the word before what it costs to come to the word here. 17 instructions.
macro_rules! come {
    ($before:literal, $here:literal, $next:literal) => {
        concat!(
            op!("or", $before, $before, "top"),
            lesser!($before, $next),
            op!("add", $before, $before, "step"),
            over!($before, $here),
            op!("sub", $before, $before, "bound"),
            op!("sub", $before, $before, "t"),
            op!("and", "t", $before, "top"),
            op!("mulhu", "t", "t", "below"),
            "not {t}, {t}\n",
            op!("and", $before, $before, "t"),
        )
    };
}

/// Makes the least of four marked numbers a number. 11 instructions, or 12.
macro_rules! least_of_four {
    ($marked:literal) => {
        concat!(
            by!("srli", "t", $marked, "16"),
            op!("sub", "t", $marked, "t"),
            op!("add", "t", "t", "top"),
            op!("and", "u", "t", "top"),
            op!("mulhu", "u", "u", "below"),
            op!("and", "t", "t", "u"),
            op!("sub", $marked, $marked, "t"),
            by!("srli", "t", $marked, "8"),
            by!("andi", $marked, $marked, "127"),
            by!("andi", "t", "t", "127"),
            concat!("bgeu {t}, {", $marked, "}, 9f\n"),
            concat!("mv {", $marked, "}, {t}\n"),
            "9:\n",
        )
    };
}

/// Makes `t`, a change of brightness, how many bytes before the [`Steps`]' costs of the largest changes its
/// own stand. 4 instructions.
macro_rules! kind {
    ($edge:literal, $edge_of_much:literal) => {
        concat!(
            op!("sltu", "u", "t", $edge),
            op!("sltu", "t", "t", $edge_of_much),
            op!("add", "t", "t", "u"),
            by!("slli", "t", "t", "3"),
        )
    };
}

/// Makes `a` what stands before a column whose first word is `b`, and `behind` what stands behind it. 6
/// instructions.
macro_rules! beside {
    ($far:literal) => {
        concat!(
            at!("lw", "a", "-4", "end"),
            by!("slli", "a", "a", "8"),
            op!("or", "a", "a", $far),
            by!("slli", "behind", $far, "24"),
            by!("srli", "t", "b", "8"),
            op!("or", "behind", "behind", "t"),
        )
    };
}

/// Goes through the words of a column from `$from` on: `come` makes each what it costs to come there, and
/// `$put` does the rest, where words stand that many bytes from there and from `$other`s. The word before the
/// column is in `a`, its first one in `b`. A column has fours of words up to `end`, where it ends there too,
/// or eight in all.
macro_rules! column {
    (fours, $from:literal, $put:ident $(, $other:literal)*) => {
        concat!(
            "j 3f\n2:\n",
            concat!(at!("lw", "b", "0", $from), come!("d", "a", "b"), $put!("d", "-4")),
            "3:\n",
            concat!(at!("lw", "c", "4", $from), come!("a", "b", "c"), $put!("a", "0")),
            concat!(at!("lw", "d", "8", $from), come!("b", "c", "d"), $put!("b", "4")),
            concat!(at!("lw", "a", "12", $from), come!("c", "d", "a"), $put!("c", "8")),
            by!("addi", $from, $from, "16"),
            $(by!("addi", $other, $other, "16"),)*
            concat!("bne {", $from, "}, {end}, 2b\n"),
            concat!("mv {b}, {behind}\n", come!("d", "a", "b"), $put!("d", "-4")),
        )
    };
    (eight, $from:literal, $put:ident $(, $other:literal)*) => {
        concat!(
            concat!(at!("lw", "c", "4", $from), come!("a", "b", "c"), $put!("a", "0")),
            concat!(at!("lw", "d", "8", $from), come!("b", "c", "d"), $put!("b", "4")),
            concat!(at!("lw", "a", "12", $from), come!("c", "d", "a"), $put!("c", "8")),
            concat!(at!("lw", "b", "16", $from), come!("d", "a", "b"), $put!("d", "12")),
            concat!(at!("lw", "c", "20", $from), come!("a", "b", "c"), $put!("a", "16")),
            concat!(at!("lw", "d", "24", $from), come!("b", "c", "d"), $put!("b", "20")),
            concat!(at!("lw", "a", "28", $from), come!("c", "d", "a"), $put!("c", "24")),
            concat!("mv {b}, {behind}\n", come!("d", "a", "b"), $put!("d", "28")),
            $(by!("addi", $other, $other, "32"),)*
        )
    };
}

/// Does to each word of a column what `$word` says of its place, so many bytes from `$place` and `$other`s,
/// which end at the column's end; and `$more` after four words.
macro_rules! words {
    (fours, $word:ident, $place:literal $(, $other:literal)* $(; $more:literal)?) => {
        concat!(
            "2:\n",
            concat!($word!("0"), $word!("4"), $word!("8"), $word!("12")),
            $(by!("addi", $other, $other, "16"),)*
            $($more,)?
            by!("addi", $place, $place, "16"),
            concat!("bne {", $place, "}, {end}, 2b\n"),
        )
    };
    (eight, $word:ident, $place:literal $(, $other:literal)* $(; $more:literal)?) => {
        concat!(
            concat!($word!("0"), $word!("4"), $word!("8"), $word!("12")),
            concat!($word!("16"), $word!("20"), $word!("24"), $word!("28")),
            $(by!("addi", $other, $other, "32"),)*
            by!("addi", $place, $place, "32"),
        )
    };
}
