//! STL.

use super::Gets::{Mended, Refused};
use super::{Case, case};
use crate::load::hostile_files::Format::Stl;

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

pub fn cases() -> Vec<Case> {
    let triangle = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let mut infinite = triangle;
    infinite[4] = f32::INFINITY;
    let cut = stl(2, &[triangle; 2])[..150].to_vec();
    vec![
        case(
            Stl,
            "",
            Refused(
                "it is no STL: it doesn't begin with \"solid\", and has 0 bytes of a header's 84; export the model again",
            ),
        ),
        case(
            Stl,
            "ply\n",
            Refused(
                "it is no STL: it doesn't begin with \"solid\", and has 4 bytes of a header's 84; export the model again",
            ),
        ),
        (
            Stl,
            cut.into(),
            Refused(
                "byte 80: its header says 2 triangles, which take 184 bytes, and the file has 150; export the model again",
            ),
        ),
        (
            Stl,
            stl(u32::MAX, &[triangle]).into(),
            Refused(
                "byte 80: its header says 4294967295 triangles, which take 214748364834 bytes, and the file has 134; export the model again",
            ),
        ),
        (Stl, stl(0, &[]).into(), Refused("no triangles: its header counts 0 triangles")),
        (
            Stl,
            stl(2, &[triangle, infinite]).into(),
            Refused("byte 134: the face has a position that isn't finite; export the model again"),
        ),
        (Stl, stl(1, &[triangle; 2]).into(), Mended(1, "bytes after the last triangle, left out: 50.")),
        case(Stl, "solid", Refused("no triangles: it holds 1 solids without facets")),
        case(
            Stl,
            FACET.replace("endloop\nendfacet\n", ""),
            Refused("line 6: the file ends within the facet that begins in line 2; export the model again"),
        ),
        case(
            Stl,
            FACET.replace("vertex 0 1 0\n", ""),
            Refused("line 7: the facet has 2 vertices in place of 3; export the model again"),
        ),
        case(
            Stl,
            FACET.replace("endloop", &"vertex 2 2 2\n".repeat(100_000)),
            Refused("line 100008: the facet has 100003 vertices in place of 3; export the model again"),
        ),
        case(
            Stl,
            FACET.replace("vertex 1 0 0", "vertex 1 0"),
            Refused("line 5: vertex needs 3 numbers, and there are 2; export the model again"),
        ),
        case(
            Stl,
            FACET.replace("vertex 1 0 0", "vertex 1 0 0,"),
            Refused("line 5: \"0,\" is no number; export the model again"),
        ),
        case(
            Stl,
            FACET.replace("vertex 1 0 0", "vertex 1 0 nan"),
            Refused("line 8: the face has a position that isn't finite; export the model again"),
        ),
        case(
            Stl,
            FACET.replace("facet normal", "face normal"),
            Refused(
                "line 2: it begins with \"face\", where facet, endsolid or solid is expected; export the model again",
            ),
        ),
        case(
            Stl,
            FACET.replace("endloop", "endsolid a"),
            Refused(
                "line 7: it begins with \"endsolid\", where vertex, endloop or endfacet is expected; export the model again",
            ),
        ),
        case(
            Stl,
            format!("solid {}", "1 ".repeat(50_000_000)),
            Refused("line 1: the line has 100000006 bytes, and at most 4194304 are read; export the model again"),
        ),
        case(Stl, FACET, Mended(1, "solids without an end: the file may have been cut short: 1.")),
    ]
}
