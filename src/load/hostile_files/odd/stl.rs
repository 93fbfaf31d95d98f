//! STL.

use super::Odd;
use crate::Format::Stl;

const WHOLE: &str = "solid a\n  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n      vertex 1 0 0\n      vertex 0 1 0\n    \
                     endloop\n  endfacet\nendsolid a\n";

fn of(name: &'static str, bytes: impl Into<Vec<u8>>, triangles: usize, warning: &'static str) -> Odd {
    Odd { name, format: Stl, bytes: bytes.into(), triangles, warning }
}

/// A text with a part of it replaced.
fn with(name: &'static str, part: &str, by: &str, warning: &'static str) -> Odd {
    assert!(WHOLE.contains(part), "{part}");
    of(name, WHOLE.replace(part, by), 1, warning)
}

/// A binary file: its header's text, the count that it says, its triangles' attributes, and what follows them.
fn binary(header: &[u8], said: u32, attributes: &[u16], rest: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, if header.is_empty() { 0 } else { b' ' });
    bytes.extend(said.to_le_bytes());
    for attribute in attributes {
        let numbers = [0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend(attribute.to_le_bytes());
    }
    bytes.extend(rest);
    bytes
}

pub(super) fn files() -> Vec<Odd> {
    texts().into_iter().chain(binaries()).collect()
}

fn texts() -> Vec<Odd> {
    vec![
        of("text in capitals", WHOLE.to_uppercase(), 1, ""),
        of(
            "notes before the solid",
            format!("\n# exported by hand\nunits mm\n{WHOLE}"),
            1,
            "aren't part of the format | 2",
        ),
        with("words in mixed case", "facet normal", "Facet Normal", ""),
        of("text with line ends of Windows", WHOLE.replace('\n', "\r\n"), 1, ""),
        of("text with line ends of old Macs", WHOLE.replace('\n', "\r"), 1, ""),
        of("text with a byte order mark", format!("\u{feff}{WHOLE}"), 1, ""),
        of("text after empty lines", format!("\n\n  {WHOLE}"), 1, ""),
        of("text with tabs and no indentation", WHOLE.replace("  ", "").replace(' ', "\t"), 1, ""),
        of("text without an end of the last line", WHOLE.trim_end(), 1, ""),
        with("a solid without a name", "solid a", "solid", ""),
        with("a solid whose name has several words", "solid a", "solid  Part 1 (copy), 12 mm", ""),
        of(
            "a solid whose name is in Latin-1",
            WHOLE
                .replace("solid a", "solid caf~")
                .bytes()
                .map(|b| if b == b'~' { 0xe9 } else { b })
                .collect::<Vec<u8>>(),
            1,
            "",
        ),
        with("a solid that ends with another name", "endsolid a", "endsolid b", ""),
        with("an end of two words", "endsolid a", "end solid a", ""),
        with("ends of two words", "endloop\n  endfacet", "end loop\n  end facet", ""),
        with("numbers with exponents of three digits", "1 0 0", "1.000000E+000 0.0e-000 +0", ""),
        with("a normal that isn't a number", "normal 0 0 1", "normal -nan(ind) nan 1.#QNAN", ""),
        with("a facet without a normal", "facet normal 0 0 1", "facet", ""),
        with("a facet without a loop", "outer loop\n", "\n", ""),
        with("a comment and a colour", "    outer", "# red\ncolor 1 0 0\n    outer", "lines that aren't part | 2"),
        of("no end of the solid", WHOLE.replace("endsolid a\n", ""), 1, "solids without an end | 1"),
        of("no solid around the facet", WHOLE.replace("endsolid a\n", "").replace("solid a\n", ""), 1, ""),
        with("a facet without an end", "  endfacet\n", "", "facets without an end | 1"),
        with("numbers with a comma for the point", "1 0 0", "1,0 0,0 0,0", "a comma in a number | 1"),
        of("two solids", WHOLE.repeat(2), 2, ""),
        of("an empty solid before another one", format!("solid none\nendsolid none\n{WHOLE}"), 1, ""),
    ]
}

fn binaries() -> Vec<Odd> {
    vec![
        of("binary whose header begins with solid", binary(b"solid made by a program", 2, &[0; 2], &[]), 2, ""),
        of("binary whose header has colours", binary(b"COLOR=\xff\x80\x00\xff,MATERIAL=", 1, &[0x7fff], &[]), 1, ""),
        of("binary whose facets have colours", binary(b"", 2, &[0x801f, 0x83e0], &[]), 2, ""),
        of(
            "binary with bytes after its triangles",
            binary(b"", 1, &[0], b"made by hand"),
            1,
            "bytes after the last triangle | 12",
        ),
        of("binary that says it has more triangles", binary(b"", 9, &[0; 2], &[]), 2, "cut short | 9 triangles"),
        of("binary that says it has no triangles", binary(b"", 0, &[0; 2], &[]), 2, "0 triangles | 2"),
        of(
            "binary that says it has 4294967295 triangles",
            binary(b"", u32::MAX, &[0; 2], &[]),
            2,
            "cut short | 4294967295",
        ),
        of("binary that is cut within a triangle", binary(b"", 2, &[0], &[0; 30]), 1, "cut short | 2 triangles"),
        of(
            "binary that begins with solid and is cut",
            binary(b"solid", 2, &[0], &[0; 30]),
            1,
            "cut short | 2 triangles",
        ),
    ]
}
