//! PLY.

use super::Odd;
use crate::Format::Ply;

const WHOLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
                     property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

fn of(name: &'static str, bytes: impl Into<Vec<u8>>, triangles: usize, warning: &'static str) -> Odd {
    Odd { name, format: Ply, bytes: bytes.into(), triangles, warning }
}

/// The text with parts of it replaced.
fn with(name: &'static str, parts: &[(&str, &str)], warning: &'static str) -> Odd {
    let text = parts.iter().fold(WHOLE.to_owned(), |text, (part, by)| {
        assert!(text.contains(part), "{name}: {part}");
        text.replacen(part, by, 1)
    });
    of(name, text, 1, warning)
}

/// A binary file of a triangle: its header's lines after the format, with this end, and its bytes.
fn binary(encoding: &str, end: &str, elements: &str, bytes: &[u8]) -> Vec<u8> {
    let header = format!("ply\nformat {encoding} 1.0\n{elements}end_header\n").replace('\n', end);
    [header.as_bytes(), bytes].concat()
}

pub(super) fn files() -> Vec<Odd> {
    [headers(), elements(), binaries()].into_iter().flatten().collect()
}

fn headers() -> Vec<Odd> {
    vec![
        of("line ends of Windows", WHOLE.replace('\n', "\r\n"), 1, ""),
        of("line ends of old Macs", WHOLE.replace('\n', "\r"), 1, ""),
        of("line ends of Windows in the header alone", WHOLE.replacen('\n', "\r\n", 9), 1, ""),
        of("a byte order mark", format!("\u{feff}{WHOLE}"), 1, ""),
        of("no end of the last line, whose number is whole", format!("{} ", WHOLE.trim_end()), 1, ""),
        with(
            "comments and notes",
            &[("element v", "comment\nobj_info 3 0\ncomment a b\nelement v"), ("end_h", "comment c\nend_h")],
            "",
        ),
        with("a comment in Latin-1 or UTF-8", &[("element v", "comment caf\u{e9}\nelement v")], ""),
        with(
            "spaces at the ends of lines",
            &[("ascii 1.0", "ascii 1.0 "), ("end_header", "end_header  "), ("ply", "ply ")],
            "",
        ),
        with("tabs between words", &[("property float x", "property\tfloat\tx"), ("1 0 0", "1\t0\t0")], ""),
        with("a format without a version", &[("ascii 1.0", "ascii")], ""),
        with(
            "a line that isn't part of the format",
            &[("element v", "made by hand\nelement v")],
            "lines of the header | 1",
        ),
    ]
}

fn elements() -> Vec<Odd> {
    let swapped = WHOLE.replace("element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n", "element face 1\nproperty list uchar int vertex_indices\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n").replace("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n");
    vec![
        with("positions of doubles", &[("float x", "double x"), ("float y", "float64 y"), ("float z", "double z")], ""),
        with("positions of whole numbers", &[("float x", "int x"), ("float y", "short y"), ("float z", "int8 z")], ""),
        with("counts and indices of other types", &[("uchar int", "int uint")], ""),
        with("counts and indices with names of sizes", &[("uchar int", "uint8 int32")], ""),
        with("indices written as fractions", &[("3 0 1 2", "3 0.0 1.0 2.0")], ""),
        with("numbers with exponents and signs", &[("1 0 0\n", "+1.000000E+000 -0 .0\n")], ""),
        with("the list's other name", &[("vertex_indices", "vertex_index")], ""),
        with("positions in another order", &[("float x\nproperty float y", "float y\nproperty float x")], ""),
        with(
            "properties that aren't known",
            &[
                ("float z\n", "float z\nproperty float confidence\nproperty uchar intensity\n"),
                ("0 0 0\n", "0 0 0 1 7\n"),
                ("1 0 0\n", "1 0 0 1 7\n"),
                ("0 1 0\n", "0 1 0 1 7\n"),
            ],
            "",
        ),
        with(
            "more numbers on a line than properties",
            &[("1 0 0\n", "1 0 0 255 0 0\n")],
            "lines with more numbers | 1",
        ),
        with(
            "colours of faces",
            &[
                ("vertex_indices\n", "vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"),
                ("3 0 1 2", "3 0 1 2 255 0 0"),
            ],
            "",
        ),
        with(
            "faces with a list of texture coordinates",
            &[
                ("vertex_indices\n", "vertex_indices\nproperty list uchar float texcoord\nproperty int texnumber\n"),
                ("3 0 1 2", "3 0 1 2 6 0 0 1 0 0 1 0"),
            ],
            "",
        ),
        with(
            "a list of vertices that isn't read",
            &[
                ("float z\n", "float z\nproperty list uchar int near\n"),
                ("0 0 0\n", "0 0 0 2 1 2\n"),
                ("1 0 0\n", "1 0 0 0\n"),
                ("0 1 0\n", "0 1 0 1 0\n"),
            ],
            "",
        ),
        with(
            "an unknown element with lists before the faces",
            &[
                ("element face", "element patch 2\nproperty list uchar int edges\nproperty float area\nelement face"),
                ("3 0 1 2", "2 1 2 0.5\n0 0.5\n3 0 1 2"),
            ],
            "",
        ),
        with(
            "edges after the faces",
            &[
                ("end_header", "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header"),
                ("3 0 1 2\n", "3 0 1 2\n0 1\n"),
            ],
            "",
        ),
        with("an element without any of it", &[("end_header", "element camera 0\nproperty float x\nend_header")], ""),
        with("empty lines between elements", &[("1 0 0\n", "\n1 0 0\n\n\n")], ""),
        with(
            "a face of two corners beside a whole one",
            &[("face 1", "face 2"), ("3 0 1 2", "2 0 1\n3 0 1 2")],
            "fewer than 3 corners | 1",
        ),
        with(
            "a face whose vertex isn't in the file",
            &[("face 1", "face 2"), ("3 0 1 2", "3 0 1 7\n3 0 1 2")],
            "that isn't in the file | 1 | line 13",
        ),
        with(
            "a face with a vertex of -1",
            &[("face 1", "face 2"), ("3 0 1 2", "3 0 1 -1\n3 0 1 2")],
            "that isn't in the file | 1 | line 13",
        ),
        of("faces before their vertices", swapped, 1, ""),
    ]
}

fn binaries() -> Vec<Odd> {
    let elements = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n";
    let positions = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let little = [bytemuck::cast_slice::<f32, u8>(&positions), &[3], bytemuck::cast_slice(&[0_i32, 1, 2])].concat();
    let big: Vec<u8> = positions
        .iter()
        .flat_map(|x| x.to_be_bytes())
        .chain([3])
        .chain([0_i32, 1, 2].iter().flat_map(|i| i.to_be_bytes()))
        .collect();
    let bytes = "element vertex 3\nproperty uchar x\nproperty char y\nproperty ushort z\nelement face 1\nproperty list uchar uchar vertex_index\n";
    let small = [0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 3, 0, 1, 2];
    vec![
        of("binary with line ends of Windows", binary("binary_little_endian", "\r\n", elements, &little), 1, ""),
        of("binary with line ends of old Macs", binary("binary_little_endian", "\r", elements, &little), 1, ""),
        of("binary with large ends first", binary("binary_big_endian", "\n", elements, &big), 1, ""),
        of(
            "binary with bytes after its end",
            binary("binary_little_endian", "\n", elements, &[&little[..], b"\n"].concat()),
            1,
            "bytes after the last element | 1",
        ),
        of("binary whose numbers are bytes", binary("binary_little_endian", "\n", bytes, &small), 1, ""),
        of(
            "binary whose first position begins with line ends",
            binary("binary_little_endian", "\n", bytes, &[10, 10, 13, 0, 1, 0, 0, 0, 0, 1, 0, 0, 3, 0, 1, 2]),
            1,
            "",
        ),
        of(
            "binary that is cut after its first face",
            binary("binary_little_endian", "\n", &elements.replace("face 1", "face 4"), &little),
            1,
            "cut short | 4",
        ),
    ]
}
