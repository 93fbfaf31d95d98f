//! PLY.

use std::borrow::Cow;

use super::Gets::{Alone, Refused, Repaired};
use super::{ABSENT, Case, case};
use crate::Format::Ply;

/// A triangle in text, with a part of it replaced.
fn ply(part: &str, by: &str) -> String {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
                property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    assert!(text.contains(part), "{part}");
    text.replacen(part, by, 1)
}

/// The same with images that comments name, texture coordinates, and the number of its image.
fn textured(comments: &str, image: &str) -> String {
    let lists = "property list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty uint texnumber\n";
    let text = ply("property list uchar int vertex_indices\n", lists)
        .replace("3 0 1 2\n", &format!("3 0 1 2 6 0 0 1 0 0 1 {image}\n"));
    text.replacen("element vertex", &format!("{comments}element vertex"), 1)
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

/// Why a file whose only face is too short has no triangle.
const LONG: &str = "the only face says that it has more vertices than its line, as in a file that was cut within it";

const VERTICES: &str = "element vertex 3\n";

pub(super) fn cases() -> Vec<Case> {
    let indices: Vec<u8> = [0, 1, 2].iter().flat_map(|i: &i32| i.to_be_bytes()).collect();
    vec![
        case(Ply, "", Refused("Broken | PLY | \"ply\"")),
        case(Ply, "plywood\n", Refused("Broken | PLY | \"ply\"")),
        case(Ply, "ply\n", Refused("Broken | line 1 | header")),
        case(Ply, ply("format ascii 1.0\n", ""), Refused("Broken | line 8 | header | format")),
        case(Ply, ply("ascii", "utf8"), Refused("Broken | line 2 | \"utf8\" | format")),
        case(
            Ply,
            ply("element vertex 3", "element vertex 4611686018427387904"),
            Refused("Broken | line 9 | 4611686018427387904 | \"vertex\" | 27"),
        ),
        case(
            Ply,
            ply("element vertex 3", "element vertex 1000"),
            Refused("Broken | line 9 | 1000 | \"vertex\" | 6000 | 27"),
        ),
        case(Ply, ply("element vertex 3", "element vertex -3"), Refused("Broken | line 3 | \"-3\"")),
        case(Ply, ply("element vertex 3", "element vertex"), Refused("Broken | line 3 | element")),
        case(Ply, ply(VERTICES, ""), Refused("Broken | line 3 | property | element")),
        case(Ply, ply("float x", "real x"), Refused("Broken | line 4 | \"real\"")),
        case(Ply, ply("float x", "x"), Refused("Broken | line 4 | property | list")),
        case(Ply, ply("list uchar", "list float"), Repaired(1, "vertices without normals")),
        case(Ply, ply("end_header", "endheader"), Refused("Broken | line 13 | header")),
        case(Ply, ply("format", "made by hand\nformat"), Repaired(1, "lines of the header | 1")),
        case(
            Ply,
            ply("end_header", &format!("{}end_header", "comment TextureFile ../a.png\n".repeat(300))),
            Repaired(1, "images beyond the first 256 | 44"),
        ),
        case(Ply, textured("comment TextureFile ../../etc/passwd\n", "0"), Repaired(1, "../../etc/passwd | left out")),
        case(
            Ply,
            textured(&"comment TextureFile a.png\n".repeat(2), "4294967295"),
            Repaired(1, "vertices without normals"),
        ),
        case(Ply, ply("float z", "float w"), Refused("Broken | line 9 | x, y and z")),
        case(Ply, ply("vertex_indices", "corners"), Refused("Broken | line 12 | \"face\" | \"vertex_indices\"")),
        case(
            Ply,
            ply(VERTICES, "element vertex 4611686018427387904\nelement vertex 3\n"),
            Refused("Broken | line 10 | x, y and z"),
        ),
        case(
            Ply,
            ply("element face 1", "element vertex 1\nproperty int x\nelement face 1"),
            Refused("Broken | line 14 | \"vertex\" | header"),
        ),
        case(
            Ply,
            ply("element face 1\nproperty list uchar int vertex_indices\n", ""),
            Refused("Empty | 3 vertices | 0 faces | 0 strips"),
        ),
        case(Ply, ply("1 0 0\n", "1 0\n"), Refused("Broken | line 11 | 2 | element")),
        case(Ply, ply("1 0 0\n", "1 0 0 7\n"), Repaired(1, "more numbers than their element | 1")),
        case(Ply, ply("1 0 0\n", "1 zero 0\n"), Refused("Broken | line 11 | \"zero\"")),
        case(Ply, ply("1 0 0\n", "1e308 0 0\n"), Refused("Empty | 1 faces | a number | line 13")),
        case(Ply, ply("1 0 0\n", "nan 0 0\n"), Refused("Empty | 1 faces | a number | line 13")),
        case(Ply, ply("3 0 1 2", "3 0 1"), Refused("Empty | cut short | 1 faces")),
        case(Ply, ply("face 1", "face 3") + "3 0 2 1\n3 0 2", Repaired(2, "cut short | 3 | \"face\"")),
        // The last number may have had more digits.
        case(Ply, ply("face 1", "face 3") + "3 0 2 1", Repaired(1, "cut short | 3 | \"face\"")),
        case(
            Ply,
            ply("end_header", "element edge 2\nproperty int a\nend_header"),
            Repaired(1, "cut short | 2 | \"edge\""),
        ),
        case(Ply, ply("3 0 1 2", "-1 0 1 2"), Refused("Broken | line 13 | -1 | list")),
        case(Ply, ply("3 0 1 2", "4611686018427387904 0 1 2"), Alone("Empty | cut short | 1 faces", LONG)),
        case(Ply, ply("3 0 1 2", "3 0 1 3"), Refused("Empty | 1 faces | that isn't in the file | line 13")),
        case(Ply, ply("3 0 1 2", "3 0 1 -1"), Alone("Empty | 1 faces | that isn't in the file | line 13", ABSENT)),
        case(Ply, ply("3 0 1 2", "3 0 1 1.5"), Alone("Empty | 1 faces | that isn't in the file | line 13", ABSENT)),
        case(Ply, ply("3 0 1 2", "2 0 1"), Refused("Empty | 3 vertices | 1 faces | 0 strips")),
        case(Ply, ply("3 0 1 2\n", "\n\n\n\n\n\n"), Refused("Empty | cut short | 1 faces")),
        case(Ply, ply("3 0 1 2", &"0 ".repeat(50_000_000)), Refused("Broken | line 13 | 100000000 | 4194304")),
        (
            Ply,
            binary("4611686018427387904", 3, &indices),
            Refused("Broken | byte 183 | 4611686018427387904 | \"vertex\" | 52"),
        ),
        (Ply, binary("5", 3, &indices), Refused("Broken | byte 165 | 5 | \"vertex\" | 60 | 52")),
        (Ply, binary("3", u32::MAX, &indices), Refused("Empty | cut short | 1 faces")),
        (Ply, binary("3", 3, &indices[1..]), Refused("Empty | cut short | 1 faces")),
        (Ply, binary("3", 3, &[&indices[..], b"more"].concat()), Repaired(1, "bytes after the last element | 4")),
        case(
            Ply,
            ply(VERTICES, "element nothing 4611686018427387904\nelement vertex 3\n"),
            Repaired(1, "vertices without normals"),
        ),
        (
            Ply,
            [b"ply\ncomment caf\xe9\xff\n", &ply("", "").as_bytes()[4..]].concat().into(),
            Repaired(1, "vertices without normals"),
        ),
        case(Ply, ply("3 0 1 2", "9 0 1 2 0 0 0 1 1 2"), Repaired(4, "corners of polygons | 3")),
    ]
}
