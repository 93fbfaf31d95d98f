//! OBJ.

use super::Gets::{Mended, Refused};
use super::{Case, case};
use crate::load::hostile_files::Format::Obj;

/// A triangle's vertices, then whatever is to be tried.
macro_rules! obj {
    ($rest:expr, $gets:expr) => {
        case(Obj, concat!("v 0 0 0\nv 1 0 0\nv 0 1 0\n", $rest), $gets)
    };
}

pub fn cases() -> Vec<Case> {
    vec![
        case(Obj, "", Refused("no triangles: it has no vertices")),
        (
            Obj,
            vec![0xff; 1000].into(),
            Refused("no triangles: it has no vertices, and 1 statements that OBJ doesn't have"),
        ),
        obj!(
            "p 1 2 3\n",
            Refused(
                "no triangles: it holds 3 positions, 3 points (p), 0 lines (l), and 0 free-form curves and surfaces"
            )
        ),
        obj!(
            "l 1 2\nl 2 3\n",
            Refused(
                "no triangles: it holds 3 positions, 0 points (p), 2 lines (l), and 0 free-form curves and surfaces"
            )
        ),
        obj!(
            "surf 0 1 0 1 1 2 3\n",
            Refused(
                "no triangles: it holds 3 positions, 0 points (p), 0 lines (l), and 1 free-form curves and surfaces"
            )
        ),
        obj!(
            "f 1 2\nf 1\nf\n",
            Refused(
                "no triangles: it holds 3 positions, 0 points (p), 0 lines (l), and 0 free-form curves and surfaces, and 3 faces of fewer than 3 corners"
            )
        ),
        obj!("f 1 2 9\n", Refused("line 4: the face uses position 9, and there are 3; export the model again")),
        obj!(
            "f 1 2 0\n",
            Refused("line 4: the face uses position 0, and they are counted from 1; export the model again")
        ),
        obj!(
            "f 1 2 -4\nv 1 1 1\n",
            Refused("line 4: the face uses position -4, and 3 are above it; export the model again")
        ),
        obj!(
            "f 1 2 4611686018427387904\n",
            Refused("line 4: the face uses position 4611686018427387904, and there are 3; export the model again")
        ),
        obj!(
            "f 1 2 -9223372036854775808\n",
            Refused("line 4: the face uses position -9223372036854775808, and 3 are above it; export the model again")
        ),
        obj!(
            "f 1 2 99999999999999999999\n",
            Refused("line 4: \"99999999999999999999\" is no number of a position; export the model again")
        ),
        obj!(
            "vn 0 0 1\nf 1//9223372036854775807 2 3\n",
            Refused("line 5: the face uses normal 9223372036854775807, and there are 1; export the model again")
        ),
        obj!(
            "f 1/1 2 3\n",
            Refused("line 4: the face uses texture coordinate 1, and there are 0; export the model again")
        ),
        obj!(
            "f 1/2/3/4 2 3\n",
            Refused("line 4: \"1/2/3/4\" is no corner, such as 1, 1/2, 1//3 or 1/2/3; export the model again")
        ),
        obj!("f a b c\n", Refused("line 4: \"a\" is no number of a position; export the model again")),
        obj!("f 1.0 2 3\n", Refused("line 4: \"1.0\" is no number of a position; export the model again")),
        case(Obj, "v 0 0 0\nv 1 0\n", Refused("line 2: v needs 3 numbers, and there are 2; export the model again")),
        case(Obj, "v 0 0 zero\n", Refused("line 1: \"zero\" is no number; export the model again")),
        case(
            Obj,
            "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n",
            Refused("line 4: the face has a position that isn't finite; export the model again"),
        ),
        case(
            Obj,
            "v 0 0 0\nv 1e308 0 0\nv 0 1 0\nf 1 2 3\n",
            Refused("line 4: the face has a position that isn't finite; export the model again"),
        ),
        case(
            Obj,
            "v 0 0 0\nv 2e37 0 0\nv 0 1 0\nf 1 2 3\n",
            Refused("line 4: the face has a coordinate beyond 1e37; export the model again"),
        ),
        obj!("vt nan 0\nvt\n", Refused("line 5: vt needs 1 numbers, and there are 0; export the model again")),
        case(
            Obj,
            format!("# {}", "x".repeat(100_000_000)),
            Refused("line 1: the line has 100000002 bytes, and at most 4194304 are read; export the model again"),
        ),
        case(
            Obj,
            format!("v 1 1 1\nf {}", "\\\n".repeat(8_000_000)),
            Refused("line 4194305: the line has 4194305 bytes, and at most 4194304 are read; export the model again"),
        ),
        case(Obj, many_materials(), Refused("it has more than 65536 materials; split it into several files")),
        obj!("f 1 2 3 \\", Mended(1, "faces without normals")),
        obj!("vt nan 0\nf 1/1 2/1 3\n", Mended(1, "uvs that aren't finite, replaced by (0, 0): 2.")),
        obj!(
            "vn nan 0 0\nvn 0 0 0\nf 1//1 2//2 3//2\n",
            Mended(1, "normals of no direction, replaced by ones that are smooth within 60 degrees: 3.")
        ),
        obj!(
            "mtllib ../../secret.mtl\nf 1 2 3\n",
            Mended(
                1,
                "the material file \"../../secret.mtl\" is left out: it leads out of a folder, with ..; only files in the document's folder and below are read"
            )
        ),
        obj!(
            "mtllib /dev/zero\nf 1 2 3\n",
            Mended(
                1,
                "the material file \"/dev/zero\" is left out: it is an absolute path; only files in the document's folder and below are read"
            )
        ),
        (
            Obj,
            b"g \xff\xfe\nusemtl \xff\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".into(),
            Mended(1, "materials that no material file describes, shown white: 1."),
        ),
        obj!("f 1 2 2 1\nf 1 1 1 1\nf 1 2 3\n", Mended(1, "faces of fewer than 3 corners, left out: 2.")),
        obj!("v 2 0 0\nv 3 0 0\nf 1 2 4 5\n", Mended(2, "cut into triangles that may overlap: 1.")),
        case(Obj, comb(12_000), Mended(23_999, "cut into triangles that may overlap: 1.")),
    ]
}

/// A material for every face.
fn many_materials() -> String {
    let faces: String = (0..70_000).map(|i| format!("usemtl {i}\nf 1 2 3\n")).collect();
    format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{faces}")
}

/// A single face like a comb, of which every tooth spans all corners that turn inward.
fn comb(teeth: u32) -> String {
    let vertices: String = (0..teeth).map(|i| format!("v 0 {i} 0\nv 1e7 {i}.5 0\n")).collect();
    let face: String = (1..=2 * teeth + 1).map(|i| format!(" {i}")).collect();
    format!("{vertices}v -1 {teeth} 0\nf{face}\n")
}
