//! OFF.

use super::Gets::{Refused, Repaired};
use super::{Case, case};
use crate::Format::Off;

/// A triangle, with the numbers of vertices and faces that it says.
fn off(counts: &str, face: &str) -> String {
    format!("OFF\n{counts} 0\n0 0 0\n1 0 0\n0 1 0\n{face}\n")
}

const FACE: &str = "3 0 1 2";

pub(super) fn cases() -> Vec<Case> {
    vec![
        case(Off, "", Refused("Broken | OFF | comments")),
        case(Off, "# OFF\n", Refused("Broken | OFF | comments")),
        case(Off, "OFF", Refused("Broken | line 1 | ends")),
        case(Off, "ply\n", Refused("Broken | line 1 | \"ply\" | OFF")),
        case(Off, "OFF BINARY\n\0\0\0\u{1}", Refused("Broken | binary OFF")),
        case(Off, "4nOFF\n3\n1 0 0\n", Refused("Broken | line 1 | 4nOFF | 3")),
        case(Off, off("-3 1", FACE), Refused("Broken | line 2 | -3 1 0")),
        case(Off, off("3", FACE).replace(" 0\n0", "\n0"), Refused("Broken | line 2 | numbers of vertices")),
        case(Off, off("99999999999999999999 1", FACE), Refused("Broken | line 2 | numbers of vertices")),
        case(Off, off("1000000000 1", FACE), Refused("Broken | after 4 | 1000000000")),
        case(Off, off("3 4000000000", FACE), Repaired(1, "cut short | 4000000000 faces | after 1")),
        case(Off, off("3 0", FACE), Refused("Empty | 3 vertices | 0 faces")),
        case(Off, off("3 1", "3 0 1 3"), Refused("Empty | 1 faces | position that isn't in the file | line 6")),
        case(Off, off("3 1", "3 0 1 -1"), Refused("Empty | 1 faces | position that isn't in the file | line 6")),
        case(Off, off("3 1", "3 0 1 1.5"), Refused("Empty | 1 faces | position that isn't in the file | line 6")),
        case(Off, off("3 2", &format!("{FACE}\n3 0 1 7")), Repaired(1, "1 faces | isn't in the file | line 7")),
        case(Off, off("3 1", "3 0 1"), Refused("Broken | line 6 | 2 corners | 3")),
        case(Off, off("3 1", "x 0 1 2"), Refused("Broken | line 6 | \"x\"")),
        case(Off, off("3 1", "18446744073709551615 0 1 2"), Refused("Broken | line 6 | more than 524288")),
        case(
            Off,
            off("3 1", &format!("600000 {}", "0 ".repeat(600_000))),
            Refused("Broken | line 6 | more than 524288"),
        ),
        case(Off, off("3 1", "2 0 1"), Refused("Empty | 1 faces of fewer than 3")),
        case(Off, off("3 2", &format!("{FACE} 1 2 3 4 5\n3 0 2 1")), Repaired(2, "colour | 3 or 4 numbers | 1")),
        case(Off, off("3 2", &format!("{FACE} 7\n3 0 2 1 red")), Repaired(2, "colour map | 2")),
        case(Off, off("3 1", &format!("{FACE} nan 0 0")), Repaired(1, "colour | 3 or 4 numbers | 1")),
        case(Off, off("3 1", &format!("{FACE}\n{FACE}\n")), Repaired(1, "after the last face | 1")),
        case(Off, off("3 1", FACE).replace("1 0 0", "1 0 nan"), Refused("Empty | 1 faces | a number | line 6")),
        case(Off, off("3 1", FACE).replace("1 0 0", "1 0"), Refused("Empty | 1 faces | a number | line 6")),
        case(Off, off("3 1", FACE).replace("1 0 0", "1 0 1e38"), Refused("Empty | 1 faces | 1e37 | line 6")),
        case(
            Off,
            off("3 1", FACE).replace("OFF", "4OFF").replace("0 0 0\n", "0 0 0 1\n").replace("1 0\n", "1 0 0\n"),
            Refused("Empty | 1 faces | a number | line 6"),
        ),
        case(Off, format!("OFF {}", "1 ".repeat(3_000_000)), Refused("Broken | line 1 | 6000004 | 4194304")),
    ]
}
