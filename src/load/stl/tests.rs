//! STL files as programs write them, and how text is told from binary.

use super::*;
use crate::face_builder::tests::{POINTS, assert_cube, triangles};
use crate::selection::{Selection, ShownParts};

fn read(bytes: &[u8]) -> LoadedMesh {
    super::read(bytes.to_vec(), &ModelFile::from_test("cube", &Progress::new())).unwrap()
}

/// A cube with wrong normals.
pub(crate) fn text() -> String {
    let vertex = |point: usize| format!("vertex {} {} {}\n", POINTS[point][0], POINTS[point][1], POINTS[point][2]);
    let facet = |t: &[usize; 3]| {
        let vertices: String = t.iter().map(|&point| vertex(point)).collect();
        format!("facet normal nan 0 1\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    let facets: Vec<String> = triangles().iter().map(facet).collect();
    format!("solid one\n{}endsolid one\nsolid two\n{}endsolid two\n", facets[..5].concat(), facets[5..].concat())
}

pub(crate) fn binary(header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(12_u32.to_le_bytes());
    for triangle in triangles() {
        bytes.extend([f32::NAN; 3].iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend(triangle.iter().flat_map(|&p| POINTS[p]).flat_map(|x| f32::from(x).to_le_bytes()));
        bytes.extend([7, 7]);
    }
    bytes
}

#[test]
fn both_kinds_are_a_cube_with_made_normals() {
    for bytes in [text().into_bytes(), binary(b"made by a test")] {
        let mesh = read(&bytes);
        assert_cube(&mesh);
        assert_eq!((mesh.name.as_str(), mesh.repairs.normals_made), ("cube", 36));
        assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    }
}

#[test]
fn triangles_of_a_binary_file_have_the_colours_that_programs_give_them() {
    let colored = |header: &[u8], bits: [u16; 2]| {
        let mut bytes = binary(header);
        for (i, triangle) in bytes[HEADER..].as_chunks_mut::<TRIANGLE>().0.iter_mut().enumerate() {
            triangle[48..].copy_from_slice(&bits[i % 2].to_le_bytes());
        }
        bytes
    };
    // A red one, and one without a colour.
    let mesh = read(&colored(b"made by a test", [0xfc00, 0]));
    assert_cube(&mesh);
    let details = mesh.details.as_ref().expect("colours");
    let colors = |i: usize| mesh.triangles[i].map(|corner| details[corner as usize].color);
    let red = Vec4::new(1.0, 0.0, 0.0, 1.0);
    assert_eq!([colors(0), colors(1), colors(2)], [[red; 3], [Vec4::ONE; 3], [red; 3]]);
    // The same bits are blue to Magics, and bit 15 stands for the colour of the part.
    let mesh = read(&colored(b"COLOR=\x00\xff\x00\xff", [0x7c00, 0x8000]));
    let details = mesh.details.as_ref().expect("colours");
    assert_eq!(details[mesh.triangles[0][0] as usize].color, Vec4::new(0.0, 0.0, 1.0, 1.0));
    assert_eq!(details[mesh.triangles[1][0] as usize].color, Vec4::new(0.0, 1.0, 0.0, 1.0));
    // A part of one colour needs no details.
    let mesh = read(&colored(b"COLOR=\x00\xff\x00\xff", [0x8000, 0x8000]));
    assert_eq!((mesh.materials[0].base_color, mesh.details.is_none()), ([0.0, 1.0, 0.0, 1.0], true));
    assert!(read(&binary(b"")).details.is_none(), "other bits are no colours");
}

#[test]
fn solids_of_text_files_are_parts() {
    let shown = ShownParts { hidden: vec!["one".to_owned()], ..ShownParts::default() };
    let selected = Selection { parts: Some(&shown), ..Selection::default() };
    let text = text() + FACET_WITHOUT_NAME;
    let mesh =
        super::read(text.into_bytes(), &ModelFile { selected, ..ModelFile::from_test("cube", &Progress::new()) })
            .expect("triangles");
    let parts: Vec<_> =
        mesh.contents.parts.iter().map(|part| (part.name.as_str(), part.triangles, part.is_hidden)).collect();
    assert_eq!(parts, [("one", 5, true), ("two", 7, false), ("solid 3", 1, false)]);
    assert_eq!(mesh.triangles.len(), 8);
    let of_each: Vec<_> = (0..8).map(|triangle| mesh.part_of(triangle)).collect();
    assert_eq!(of_each, [[Some(1); 7].as_slice(), &[Some(2)]].concat());
    assert!(read(&binary(b"solid one")).contents.parts.is_empty());
}

const FACET_WITHOUT_NAME: &str =
    "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";

#[test]
fn text_is_forgiven_its_case_its_spaces_and_its_ends_of_lines() {
    let text = text();
    let bom = format!("\u{feff}{text}");
    let mac = text.replace('\n', "\r");
    for text in
        [text.to_uppercase().replace("NAN", "NaN"), text.replace(' ', "\t  "), text.replace('\n', "\r\n\r\n"), bom, mac]
    {
        assert_cube(&read(text.as_bytes()));
    }
}

#[test]
fn a_binary_file_may_begin_with_solid() {
    for header in [&b"solid cube"[..], b"solid\0cube", b"SOLID"] {
        assert_cube(&read(&binary(header)));
    }
    // Its size doesn't show that it is binary any more, but its zeros do.
    let longer = [binary(b"solid cube"), b"made by a test".to_vec()].concat();
    let mesh = read(&longer);
    assert_cube(&mesh);
    assert_eq!(mesh.warnings, ["bytes after the last triangle, left out: 14."]);
}

#[test]
fn text_without_an_end_is_read_with_a_warning() {
    let text = text();
    let mesh = read(text.trim_end().trim_end_matches("endsolid two").as_bytes());
    assert_cube(&mesh);
    assert_eq!(mesh.warnings, ["solids without an end: the file may have been cut short: 1."]);
}

#[test]
fn cancelling_stops_the_work() {
    let progress = Progress::new();
    progress.cancel();
    for bytes in [text().into_bytes(), binary(b"")] {
        assert!(matches!(
            super::read(bytes.to_vec(), &ModelFile::from_test("", &progress)),
            Err(ReadError::Cancelled(_))
        ));
    }
}
