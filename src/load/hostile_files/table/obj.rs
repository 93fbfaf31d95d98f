//! OBJ.

use super::Gets::{Alone, Refused, Repaired};
use super::{ABSENT, Case, case};
use crate::Format::Obj;

/// A triangle's vertices, then whatever is to be tried.
macro_rules! obj {
    ($rest:expr, $gets:expr) => {
        case(Obj, concat!("v 0 0 0\nv 1 0 0\nv 0 1 0\n", $rest), $gets)
    };
}

pub(super) fn cases() -> Vec<Case> {
    vec![
        case(Obj, "", Refused("Empty | vertices")),
        (Obj, vec![0xff; 1000].into(), Refused("Empty | vertices | a statement")),
        case(Obj, many_parts(), Repaired(1, "objects and groups | 65,536 | 4464")),
        obj!("p 1 2 3\n", Refused("Empty | 3 positions | 3 points")),
        obj!("l 1 2\nl 2 3\n", Refused("Empty | 3 positions | 2 lines")),
        obj!("surf 0 1 0 1 1 2 3\n", Refused("Empty | 3 positions | 1 free-form")),
        obj!("f 1 2\nf 1\nf\n", Refused("Empty | 3 positions | 3 faces | 3 corners")),
        obj!("f 1 2 9\n", Refused("Empty | 1 faces | that isn't in the file | line 4")),
        obj!("f 1 2 0\n", Alone("Empty | 1 faces | that isn't in the file | line 4", ABSENT)),
        obj!("f 1 2 -4\nv 1 1 1\n", Alone("Empty | 1 faces | that isn't in the file | line 4", ABSENT)),
        obj!("f 1 2 4611686018427387904\n", Alone("Empty | 1 faces | that isn't in the file | line 4", ABSENT)),
        obj!("f 1 2 -9223372036854775808\n", Alone("Empty | 1 faces | that isn't in the file | line 4", ABSENT)),
        obj!("f 1 2 99999999999999999999\n", Alone("Empty | 1 faces | that isn't in the file | line 4", ABSENT)),
        obj!("vn 0 0 1\nf 1//9223372036854775807 2 3\n", Repaired(1, "a normal that isn't in the file | 1")),
        obj!("f 1/1 2 3\n", Repaired(1, "texture coordinates that aren't in the file | 1")),
        obj!("vt 0 0\nvn 0 0 1\nf 1/0/1 2/x/1 3/1/0\n", Repaired(1, "texture coordinates that aren't in the file | 2")),
        obj!("f 1/2/3/4 2 3\n", Repaired(1, "more than three numbers | 1")),
        obj!("f a b c\n", Refused("Broken | line 4 | \"a\" | position")),
        obj!("f 1.0 2 3\n", Repaired(1, "faces without normals | 1")),
        case(Obj, "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n", Repaired(1, "positions of two numbers | 1")),
        case(Obj, "v 0,5 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", Repaired(1, "a comma in a number | 1")),
        obj!("v nan 0 0\nf 1 2 4\nf 1 2 3\n", Repaired(1, "1 faces | a number | 1e37 | line 5 | left out")),
        obj!("v 1.#IND -nan(ind) 3.1+e2\nf 1 2 4\nf 1 2 3\n", Repaired(1, "1 faces | a number | line 5 | left out")),
        obj!("v 1e308 0 0\nf 1 2 4\nf 1 2 3\n", Repaired(1, "1 faces | a number | line 5 | left out")),
        obj!("v 2e37 0 0\nf 1 2 4\nf 1 2 3\n", Repaired(1, "1 faces | 1e37 | line 5 | left out")),
        obj!("vn 1.#QNAN 0 0\nvn 0 0\nf 1//1 2//2 3//1\n", Repaired(1, "normals without a direction | 3")),
        obj!("vt nan 0\nvt\nf 1/1 2/2 3/2\n", Repaired(1, "uvs that aren't finite | 3")),
        obj!("s 1\nf 1 2 3\n", Repaired(1, "smoothing groups | 1")),
        obj!("s 1\nf 1 2 2\ns x\nf 1 2 3\n", Repaired(2, "faces without normals | 1")),
        (Obj, utf16("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), Repaired(1, "faces without normals | 1")),
        case(Obj, format!("# {}", "x".repeat(100_000_000)), Refused("Broken | line 1 | 100000002 | 4194304")),
        case(
            Obj,
            format!("v 1 1 1\nf {}", "\\\n".repeat(8_000_000)),
            Refused("Broken | line 4194305 | 4194305 | 4194304"),
        ),
        case(
            Obj,
            many_materials(),
            Alone(
                "TooMany | 65536 | materials",
                "each material is a draw of its own, and so many would take seconds a picture",
            ),
        ),
        obj!("f 1 2 3 \\", Repaired(1, "faces without normals")),
        obj!("vt nan 0\nf 1/1 2/1 3\n", Repaired(1, "uvs that aren't finite | 2")),
        obj!("vn nan 0 0\nvn 0 0 0\nf 1//1 2//2 3//2\n", Repaired(1, "normals without a direction | 3")),
        obj!("mtllib ../../secret.mtl\nf 1 2 3\n", Repaired(1, "\"../../secret.mtl\" is left out")),
        obj!("mtllib /dev/zero\nf 1 2 3\n", Repaired(1, "\"/dev/zero\" is left out")),
        (Obj, b"g \xff\xfe\nusemtl \xff\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".into(), Repaired(1, "materials | 1")),
        obj!("f 1 2 2 1\nf 1 1 1 1\nf 1 2 3\n", Repaired(1, "faces of fewer than 3 corners | 2")),
        obj!("v 2 0 0\nv 3 0 0\nf 1 2 4 5\n", Repaired(2, "may overlap | 1")),
        case(Obj, comb(12_000), Repaired(23_999, "may overlap | 1")),
    ]
}

/// A text in UTF-16 that ends within a unit.
fn utf16(text: &str) -> std::borrow::Cow<'static, [u8]> {
    let units = text.encode_utf16().flat_map(u16::to_be_bytes);
    [0xfe, 0xff].into_iter().chain(units).chain([0]).collect()
}

/// More objects than have names, and a face in the last one.
fn many_parts() -> String {
    let objects: String = (0..70_000).map(|i| format!("o {i}\n")).collect();
    format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{objects}f 1 2 3\n")
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
