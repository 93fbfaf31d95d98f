//! STL.

use super::Gets::{Refused, Repaired};
use super::{Case, case};
use crate::Format::Stl;

/// A binary file with this header, which ends after its first triangle and these bits.
fn colored(header: &[u8], bits: u16) -> Vec<u8> {
    let mut bytes = stl(2, &[[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]]);
    bytes[..header.len()].copy_from_slice(header);
    bytes[132..].copy_from_slice(&bits.to_le_bytes());
    bytes
}

/// A binary file that says it has so many triangles, and has others.
fn stl(said: u32, triangles: &[[f32; 9]]) -> Vec<u8> {
    let mut bytes = b"solid in name only".to_vec();
    bytes.resize(80, 0);
    bytes.extend(said.to_le_bytes());
    for triangle in triangles {
        bytes.extend([[0.0; 3].as_slice(), triangle].concat().iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}

const FACET: &str =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

pub(super) fn cases() -> Vec<Case> {
    let triangle = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let mut infinite = triangle;
    infinite[4] = f32::INFINITY;
    let cut = stl(2, &[triangle; 2])[..150].to_vec();
    vec![
        case(Stl, "", Refused("Broken | STL | \"solid\" | 0 | 84")),
        case(Stl, "ply\n", Refused("Broken | STL | \"solid\" | 4 | 84")),
        (Stl, cut.into(), Repaired(1, "cut short | 2 triangles | after 1")),
        (Stl, stl(u32::MAX, &[triangle]).into(), Repaired(1, "cut short | 4294967295 | after 1")),
        (Stl, stl(9, &[]).into(), Refused("Empty | 9 | triangles | none")),
        (Stl, stl(0, &[]).into(), Refused("Empty | 0 | triangles | header")),
        (Stl, stl(2, &[triangle, infinite]).into(), Repaired(1, "1 faces | a number | byte 134 | left out")),
        (Stl, stl(1, &[triangle; 2]).into(), Repaired(1, "bytes after the last triangle | 50")),
        (Stl, colored(b"odd.stl with all bits set", u16::MAX).into(), Repaired(1, "cut short | 2 triangles | after 1")),
        (
            Stl,
            colored(&[b"x".repeat(73), b"COLOR=\xff".to_vec()].concat(), 7).into(),
            Repaired(1, "cut short | 2 triangles | after 1"),
        ),
        case(Stl, "solid", Refused("Empty | 1 | triangles | solids")),
        case(Stl, FACET.replace("endloop\nendfacet\n", ""), Refused("Empty | 1 | solids")),
        case(Stl, format!("{FACET}facet normal 0 0 1\nouter loop\n"), Repaired(1, "ends within the facet | line 9")),
        case(Stl, FACET.replace("solid a\n", "") + "made by hand\n", Repaired(1, "lines that aren't part | 1")),
        case(Stl, FACET.replace("outer", "# red\ncolor 1 0 0\nouter"), Repaired(1, "lines that aren't part | 2")),
        case(Stl, FACET.replace("vertex 0 1 0\n", ""), Refused("Broken | line 7 | 2 | 3")),
        case(
            Stl,
            FACET.replace("endloop", &"vertex 2 2 2\n".repeat(1_000_000)),
            Refused("Broken | line 1000008 | 1000003 | 3"),
        ),
        case(Stl, FACET.replace("vertex 1 0 0", "vertex 1 0"), Refused("Empty | 1 faces | a number | line 8")),
        case(Stl, FACET.replace("vertex 1 0 0", "vertex 1 0 0,"), Repaired(1, "a comma in a number | 1")),
        case(Stl, FACET.replace("vertex 1 0 0", "vertex 1 0 nan"), Refused("Empty | 1 faces | a number | line 8")),
        case(Stl, FACET.replace("facet normal", "face normal"), Refused("Broken | line 3 | \"outer\" | facet")),
        case(Stl, FACET.replace("endloop", "endsolid a"), Repaired(1, "facets without an end | 1")),
        case(Stl, format!("solid {}", "1 ".repeat(50_000_000)), Refused("Broken | line 1 | 100000006 | 4194304")),
        case(Stl, FACET, Repaired(1, "solids without an end | 1")),
    ]
}
