//! OBJ.

use super::Odd;
use crate::Format::Obj;

const VERTICES: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const WHOLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn of(name: &'static str, bytes: impl Into<Vec<u8>>, triangles: usize, warning: &'static str) -> Odd {
    Odd { name, format: Obj, bytes: bytes.into(), triangles, warning }
}

/// A file with these lines after three vertices.
fn after(name: &'static str, lines: &str, triangles: usize, warning: &'static str) -> Odd {
    of(name, format!("{VERTICES}{lines}"), triangles, warning)
}

pub(super) fn files() -> Vec<Odd> {
    [texts(), corners(), materials()].into_iter().flatten().collect()
}

/// Oddities of the text.
fn texts() -> Vec<Odd> {
    let utf16: Vec<u8> = WHOLE.encode_utf16().flat_map(u16::to_le_bytes).collect();
    vec![
        of("line ends of Windows, and tabs", WHOLE.replace('\n', "\r\n").replace(' ', "\t"), 1, ""),
        of("line ends of old Macs", WHOLE.replace('\n', "\r"), 1, ""),
        of("line ends of several systems", WHOLE.replacen('\n', "\r\n", 1).replacen("v 1", "\r\nv 1", 1), 1, ""),
        of("a byte order mark", format!("\u{feff}{WHOLE}"), 1, ""),
        of("UTF-16 with a byte order mark", [vec![0xff, 0xfe], utf16].concat(), 1, ""),
        of("no end of the last line", WHOLE.trim_end(), 1, ""),
        of("spaces before and after every statement", WHOLE.replace("v ", "   v  ").replace('\n', " \t\n\n"), 1, ""),
        of("a comment after a face", WHOLE.replace("f 1 2 3", "f 1 2 3 # the only one"), 1, ""),
        of("a comment that ends with a backslash", format!("# C:\\models\\\n{WHOLE}"), 1, ""),
        after("a face on three lines", "f 1 \\\n2 \\\n3\n", 1, ""),
        of("numbers with exponents and signs", "v +0.0E+000 -0 .0\nv 1.e0 0 0\nv 0 1E-0 0.\nf 1 2 3\n", 1, ""),
        of("numbers of 20 digits", WHOLE.replace("v 1 0", "v 1.00000000000000000001 0"), 1, ""),
        of("numbers with a comma for the point", WHOLE.replace("1 0 0", "1,0 0,0 0,0"), 1, "a comma in a number | 1"),
        of("a zero byte at the end", format!("{WHOLE}\0"), 1, "statements that OBJ doesn't have | 1"),
        of("a control character that ends a text", format!("{WHOLE}\u{1a}"), 1, "statements that OBJ doesn't have | 1"),
        of("a name in Latin-1", [b"o caf\xe9\n", WHOLE.as_bytes()].concat(), 1, ""),
        after("groups and objects without names", "g\no\nf 1 2 3\n", 1, ""),
        after("statements about display and curves", "lod 1\nbevel on\ncstype bezier\ndeg 3\nvp 0 0\nf 1 2 3\n", 1, ""),
        of("a statement of another program", format!("{WHOLE}vw 1 0 0.5\n"), 1, "statements that OBJ doesn't have | 1"),
        of("faces before their vertices", format!("f 1 2 3\n{VERTICES}"), 1, ""),
    ]
}

/// Oddities of vertices and corners.
fn corners() -> Vec<Odd> {
    let more = |lines: &str| format!("vt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n{lines}");
    vec![
        after("numbers counted from the end", "f -3 -2 -1\n", 1, ""),
        after("numbers counted from both ends", "f 1 -2 3\n", 1, ""),
        after("normals counted from the end", &more("f -3//-1 -2//-1 -1//-1\n"), 1, ""),
        after("a slash after each number", "f 1/ 2/ 3/\n", 1, ""),
        after("two slashes after each number", "f 1// 2// 3//\n", 1, ""),
        after("a slash after texture coordinates", &more("f 1/1/ 2/2/ 3/3/\n"), 1, ""),
        after("corners of several forms", &more("f 1/1/1 2//1 3\n"), 1, ""),
        after("a fourth number in each corner", &more("f 1/1/1/1 2/2/1/1 3/3/1/1\n"), 1, "more than three numbers | 3"),
        after("numbers written as fractions", "f 1.0 2.0 3.0\n", 1, ""),
        after("texture coordinates of three numbers", "vt 0 0 0\nf 1/1 2/1 3/1\n", 1, ""),
        after("texture coordinates of one number", "vt 0.5\nf 1/1 2/1 3/1\n", 1, ""),
        after("texture coordinates that aren't in the file", "f 1/1 2/2 3/3\n", 1, "that aren't in the file | 3"),
        after("normals that aren't in the file", "f 1//1 2//2 3//3\n", 1, "that isn't in the file | 3"),
        after("an index of 0 where there are no normals", "f 1//0 2//0 3//0\n", 1, "that isn't in the file | 3"),
        of("positions with a weight", WHOLE.replace(" 0\n", " 0 1.0\n"), 1, ""),
        of("positions with colours", WHOLE.replace(" 0\n", " 0 1 0.5 0\n"), 1, ""),
        of("positions with colours up to 255", WHOLE.replace(" 0\n", " 0 255 128 0\n"), 1, ""),
        of("positions with a weight and a colour", WHOLE.replace(" 0\n", " 0 1.0 1 0.5 0\n"), 1, ""),
        of(
            "a position without z",
            "v 0 0 0\nv 1 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 1 3 4\n",
            2,
            "positions of two numbers | 1",
        ),
        after(
            "a normal that isn't a number",
            "vn nan nan nan\nf 1//1 2//1 3//1\n",
            1,
            "normals without a direction | 3",
        ),
        after("a polygon that repeats its first corner", "f 1 2 3 1\n", 1, "at the position of the corner before | 1"),
        after("a face of two corners", "f 1 2\nf 1 2 3\n", 1, "fewer than 3 corners | 1"),
        after(
            "a face whose position isn't in the file",
            "f 1 2 9\nf 1 2 3\n",
            1,
            "that isn't in the file | 1 | line 4",
        ),
        after("a face that counts from 0", "f 0 1 2\nf 1 2 3\n", 1, "that isn't in the file | 1 | line 4"),
        after("a polygon that turns inward", "v 0.2 0.2 0\nf 1 2 4 3\n", 2, ""),
        after("points and lines beside a face", "p 1\nl 1 2 3\nf 1 2 3\n", 1, "lines (l) | 1"),
        after("a statement for faces of old versions", "fo 1 2 3\n", 1, ""),
        after("smoothing that is on or off", "s off\nf 1 2 3\ns on\nf 1 2 3\n", 2, ""),
    ]
}

/// Oddities of materials.
fn materials() -> Vec<Odd> {
    let face = |lines: &str| format!("{lines}f 1 2 3\n");
    vec![
        after("a material without a library", &face("usemtl wood\n"), 1, "no material file describes | 1"),
        after("a material without a name", &face("mtllib wood.mtl\nusemtl\n"), 1, ""),
        after("a library with a space in its name", &face("mtllib my wood.mtl\nusemtl wood\n"), 1, ""),
        after("two libraries on one line", &face("mtllib wood.mtl paint.mtl\nusemtl paint\n"), 1, ""),
        after("a library at a path of Windows", &face("mtllib .\\wood.mtl\nusemtl wood\n"), 1, ""),
        after("a library on another machine", &face("mtllib C:\\models\\my wood.mtl\nusemtl wood\n"), 1, ""),
        after("a library that is missing", &face("mtllib none.mtl\nusemtl wood\n"), 1, "none.mtl"),
        after("a library after the faces", "usemtl wood\nf 1 2 3\nmtllib wood.mtl\n", 1, ""),
        after("a library that is named twice", &face("mtllib wood.mtl\nmtllib wood.mtl\nusemtl wood\n"), 1, ""),
    ]
}
