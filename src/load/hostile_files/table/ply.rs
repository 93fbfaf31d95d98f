//! PLY.

use std::borrow::Cow;

use super::Gets::{Mended, Refused};
use super::{Case, case};
use crate::load::hostile_files::Format::Ply;

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

pub fn cases() -> Vec<Case> {
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
            Refused("line 13: a list has 4.611686018427388e18 values, and 3 are in its line; export the model again"),
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
