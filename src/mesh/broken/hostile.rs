//! One broken file after another, with the sentence that it gets.

use std::borrow::Cow;

use super::Format::{self, Obj, Ply, Stl};
use super::read;

enum Gets {
    /// The problem's message.
    Refused(&'static str),
    /// So many triangles, and a warning that contains this.
    Mended(usize, &'static str),
}
use Gets::{Mended, Refused};

type Case = (Format, Cow<'static, [u8]>, Gets);

fn case(format: Format, text: impl Into<Cow<'static, str>>, gets: Gets) -> Case {
    let bytes = match text.into() {
        Cow::Borrowed(text) => Cow::Borrowed(text.as_bytes()),
        Cow::Owned(text) => Cow::Owned(text.into_bytes()),
    };
    (format, bytes, gets)
}

/// A triangle's vertices, then whatever is to be tried.
macro_rules! obj {
    ($rest:expr, $gets:expr) => {
        case(Obj, concat!("v 0 0 0\nv 1 0 0\nv 0 1 0\n", $rest), $gets)
    };
}

fn objs() -> Vec<Case> {
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
                "the material file \"../../secret.mtl\" is left out: only files in the document's folder are read"
            )
        ),
        obj!(
            "mtllib /dev/zero\nf 1 2 3\n",
            Mended(1, "the material file \"/dev/zero\" is left out: only files in the document's folder are read")
        ),
        (
            Obj,
            b"g \xff\xfe\nusemtl \xff\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".into(),
            Mended(1, "materials that no material file describes, shown white: 1."),
        ),
        obj!("f 1 2 2 1\nf 1 1 1 1\nf 1 2 3\n", Mended(1, "faces of fewer than 3 corners, left out: 2.")),
        obj!("v 2 0 0\nv 3 0 0\nf 1 2 4 5\n", Mended(2, "cut into triangles that may overlap: 1.")),
        case(Obj, comb(50_000), Mended(99_999, "cut into triangles that may overlap: 1.")),
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

fn stls() -> Vec<Case> {
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

/// A triangle in text, with a part of it replaced.
fn ply(part: &str, by: &str) -> String {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
                property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    assert!(text.contains(part), "{part}");
    text.replacen(part, by, 1)
}

/// The same in binary, with other counts of vertices and of the face's corners, and then these bytes.
fn binary(vertices: &str, count: u32, rest: &[u8]) -> Cow<'static, [u8]> {
    let header = format!(
        "ply\nformat binary_big_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uint int vertex_indices\nend_header\n"
    );
    let positions = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let positions: Vec<u8> = positions.iter().flat_map(|x| x.to_be_bytes()).collect();
    [header.as_bytes(), &positions, &count.to_be_bytes(), rest].concat().into()
}

const VERTICES: &str = "element vertex 3\n";

fn plys() -> Vec<Case> {
    let indices: Vec<u8> = [0, 1, 2].iter().flat_map(|i: &i32| i.to_be_bytes()).collect();
    vec![
        case(Ply, "", Refused("it is no PLY: its first line isn't \"ply\"; export the model again")),
        case(Ply, "plywood\n", Refused("it is no PLY: its first line isn't \"ply\"; export the model again")),
        case(Ply, "ply\n", Refused("line 1: the file ends within its header; export the model again")),
        case(Ply, ply("format ascii 1.0\n", ""), Refused("line 8: the header has no format; export the model again")),
        case(
            Ply,
            ply("ascii", "utf8"),
            Refused(
                "line 2: the format is \"utf8\", where ascii, binary_little_endian or binary_big_endian is expected; export the model again",
            ),
        ),
        case(
            Ply,
            ply("element vertex 3", "element vertex 4611686018427387904"),
            Refused(
                "line 9: the header says 4611686018427387904 of element \"vertex\", which take more than any file has bytes, and 27 are left; export the model again",
            ),
        ),
        case(
            Ply,
            ply("element vertex 3", "element vertex 1000"),
            Refused(
                "line 9: the header says 1000 of element \"vertex\", which take at least 6000 bytes, and 27 are left; export the model again",
            ),
        ),
        case(
            Ply,
            ply("element vertex 3", "element vertex -3"),
            Refused("line 3: \"-3\" is no count of elements; export the model again"),
        ),
        case(
            Ply,
            ply("element vertex 3", "element vertex"),
            Refused("line 3: an element has a name and a count; export the model again"),
        ),
        case(Ply, ply(VERTICES, ""), Refused("line 3: a property comes before any element; export the model again")),
        case(Ply, ply("float x", "real x"), Refused("line 4: \"real\" is no type; export the model again")),
        case(
            Ply,
            ply("float x", "x"),
            Refused(
                "line 4: a property has a type and a name, or is a list of two types and a name; export the model again",
            ),
        ),
        case(
            Ply,
            ply("list uchar", "list float"),
            Refused("line 8: the count of a list is no whole number; export the model again"),
        ),
        case(
            Ply,
            ply("end_header", "endheader"),
            Refused("line 9: \"endheader\" is no statement of a header; export the model again"),
        ),
        case(
            Ply,
            ply("float z", "float w"),
            Refused("line 9: the vertices have no x, y and z; export the model again"),
        ),
        case(
            Ply,
            ply("vertex_indices", "corners"),
            Refused("line 12: the element \"face\" has no list of name \"vertex_indices\"; export the model again"),
        ),
        case(
            Ply,
            ply(VERTICES, "element vertex 4611686018427387904\nelement vertex 3\n"),
            Refused("line 10: the vertices have no x, y and z; export the model again"),
        ),
        case(
            Ply,
            ply("element face 1", "element vertex 1\nproperty int x\nelement face 1"),
            Refused("line 14: the header has two elements of name \"vertex\"; export the model again"),
        ),
        case(
            Ply,
            ply("element face 1\nproperty list uchar int vertex_indices\n", ""),
            Refused("no triangles: it holds 3 vertices, 0 faces and 0 strips of triangles"),
        ),
        case(
            Ply,
            ply("1 0 0\n", "1 0\n"),
            Refused("line 11: the line has 2 numbers, and the element has more; export the model again"),
        ),
        case(
            Ply,
            ply("1 0 0\n", "1 0 0 7\n"),
            Refused("line 11: the line has 4 numbers, and the element \"vertex\" has 3; export the model again"),
        ),
        case(Ply, ply("1 0 0\n", "1 zero 0\n"), Refused("line 11: \"zero\" is no number; export the model again")),
        case(
            Ply,
            ply("1 0 0\n", "1e308 0 0\n"),
            Refused("line 13: the face has a position that isn't finite; export the model again"),
        ),
        case(
            Ply,
            ply("1 0 0\n", "nan 0 0\n"),
            Refused("line 13: the face has a position that isn't finite; export the model again"),
        ),
        case(
            Ply,
            ply("3 0 1 2", "3 0 1"),
            Refused("line 13: a list has 3 values, and 2 are in its line; export the model again"),
        ),
        case(Ply, ply("3 0 1 2", "-1 0 1 2"), Refused("line 13: a list has -1 values; export the model again")),
        case(
            Ply,
            ply("3 0 1 2", "4611686018427387904 0 1 2"),
            Refused("line 13: a list has 4611686018427388000 values, and 3 are in its line; export the model again"),
        ),
        case(
            Ply,
            ply("3 0 1 2", "3 0 1 3"),
            Refused("line 13: the face uses vertex 3, and there are 3, counted from 0; export the model again"),
        ),
        case(
            Ply,
            ply("3 0 1 2", "3 0 1 -1"),
            Refused("line 13: the face uses vertex -1, and there are 3, counted from 0; export the model again"),
        ),
        case(
            Ply,
            ply("3 0 1 2", "3 0 1 1.5"),
            Refused("line 13: the face uses vertex 1.5, and there are 3, counted from 0; export the model again"),
        ),
        case(
            Ply,
            ply("3 0 1 2", "2 0 1"),
            Refused(
                "no triangles: it holds 3 vertices, 1 faces and 0 strips of triangles, and 1 faces of fewer than 3 corners",
            ),
        ),
        case(
            Ply,
            ply("3 0 1 2\n", "\n\n\n\n\n\n"),
            Refused("line 18: the file ends after 0 of 1 of element \"face\"; export the model again"),
        ),
        case(
            Ply,
            ply("3 0 1 2", &"0 ".repeat(50_000_000)),
            Refused("line 13: the line has 100000000 bytes, and at most 4194304 are read; export the model again"),
        ),
        (
            Ply,
            binary("4611686018427387904", 3, &indices),
            Refused(
                "byte 183: the header says 4611686018427387904 of element \"vertex\", which take more than any file has bytes, and 52 are left; export the model again",
            ),
        ),
        (
            Ply,
            binary("5", 3, &indices),
            Refused(
                "byte 165: the header says 5 of element \"vertex\", which take at least 60 bytes, and 52 are left; export the model again",
            ),
        ),
        (
            Ply,
            binary("3", u32::MAX, &indices),
            Refused("byte 201: a list has 4294967295 values, and 12 bytes are left; export the model again"),
        ),
        (
            Ply,
            binary("3", 3, &indices[1..]),
            Refused("byte 201: a list has 3 values, and 11 bytes are left; export the model again"),
        ),
        (
            Ply,
            binary("3", 3, &[&indices[..], b"more"].concat()),
            Mended(1, "bytes after the last element, left out: 4."),
        ),
        case(
            Ply,
            ply(VERTICES, "element nothing 4611686018427387904\nelement vertex 3\n"),
            Mended(1, "vertices without normals"),
        ),
        (
            Ply,
            [b"ply\ncomment caf\xe9\xff\n", &ply("", "").as_bytes()[4..]].concat().into(),
            Mended(1, "vertices without normals"),
        ),
        case(
            Ply,
            ply("3 0 1 2", "9 0 1 2 0 0 0 1 1 2"),
            Mended(4, "corners of polygons where the one before is, left out: 3."),
        ),
    ]
}

#[test]
fn every_hostile_file_gets_its_sentence() {
    let cases: Vec<Case> = objs().into_iter().chain(stls()).chain(plys()).collect();
    assert!(cases.len() >= 90, "{}", cases.len());
    let wrong: Vec<String> = cases.into_iter().filter_map(wrong).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What a file got in place of what it was to get.
fn wrong((format, bytes, gets): Case) -> Option<String> {
    let result = read(format, &bytes);
    let is_right = match (&result, &gets) {
        (Err(fault), Refused(expected)) => fault.to_string() == *expected,
        (Ok(mesh), Mended(triangles, warning)) => {
            mesh.triangles.len() == *triangles && mesh.warnings.iter().any(|said| said.contains(warning))
        }
        _ => false,
    };
    let got = result.map(|mesh| (mesh.triangles.len(), mesh.warnings)).map_err(|fault| fault.to_string());
    let (Refused(expected) | Mended(_, expected)) = gets;
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(60)]);
    (!is_right).then(|| format!("{format:?} {start:?}\n  got {got:?}\n  in place of {expected:?}"))
}
