//! OFF files as programs write them: keywords, colours, and where the numbers stand.

use super::*;
use crate::face_builder::tests::{POINTS, SIDES, assert_cube};

fn read(text: &str) -> LoadedMesh {
    super::read(text.as_bytes().to_vec(), &ModelFile::from_test("cube", &Progress::new())).unwrap()
}

fn refused(text: &str) -> String {
    super::read(text.as_bytes().to_vec(), &ModelFile::from_test("", &Progress::new())).unwrap_err().to_string()
}

/// A cube of six squares, with lines before, between and behind its vertices and faces.
fn cube_of(header: &str, vertex: impl Fn(usize) -> String, face: impl Fn(usize) -> String) -> String {
    let vertices: String =
        (0..8).map(|i| format!("{} {} {} {}\n", POINTS[i][0], POINTS[i][1], POINTS[i][2], vertex(i))).collect();
    let side = |(i, [a, b, c, d]): (usize, &[usize; 4])| format!("4 {a} {b} {c} {d} {}\n", face(i));
    let faces: String = SIDES.iter().enumerate().map(side).collect();
    format!("{header}\n{vertices}\n# faces\n{faces}")
}

fn nothing(_: usize) -> String {
    String::new()
}

pub(crate) fn cube() -> String {
    cube_of("OFF # a cube\n\n8 6 12", nothing, nothing)
}

/// A cube with everything that a vertex may have, and colours of faces, which count for nothing beside those of vertices.
pub(crate) fn everything() -> String {
    cube_of("STCN4OFF\n8 6 0", |i| format!("1 0 0 1 {} 0 0 255 0.5 0.25", 30 * i), |i| format!("0.5 0.5 0.{i}"))
}

fn colors(mesh: &LoadedMesh) -> Vec<[f32; 4]> {
    mesh.details
        .as_ref()
        .map_or(Vec::new(), |details| (0..details.len()).map(|i| details[i].color.to_array()).collect())
}

#[test]
fn the_numbers_may_stand_in_the_first_line_or_without_a_keyword() {
    for header in ["OFF\n8 6 12", "OFF 8 6 12", "8 6 12", "OFF\n# made by hand\n 8\t6", "off\r\n8 6 12\r"] {
        let mesh = read(&cube_of(header, nothing, nothing));
        assert_cube(&mesh);
        assert_eq!(mesh.warnings, ["vertices without normals, which are smoothed below 60 degrees: 8."], "{header}");
    }
}

#[test]
fn keywords_say_what_a_vertex_has() {
    let kind = |keyword: &[u8]| VertexKind::new(keyword);
    let plain = VertexKind::default();
    assert_eq!(kind(b"OFF"), Some(plain));
    assert_eq!(kind(b"CNOFF"), Some(VertexKind { has_color: true, has_normal: true, ..plain }));
    assert_eq!(kind(b"NCOFF"), kind(b"CNOFF"));
    assert_eq!(kind(b"STOFF"), Some(VertexKind { has_uv: true, ..plain }));
    assert_eq!(kind(b"4nOFF"), Some(VertexKind { is_homogeneous: true, has_any_dimension: true, ..plain }));
    assert_eq!([kind(b"SOFF"), kind(b"CCOFF"), kind(b"XOFF"), kind(b"OFFS"), kind(b"")], [None; 5]);
}

#[test]
fn a_vertex_may_have_everything() {
    let text = everything();
    let mesh = read(&text);
    assert_eq!((mesh.triangles.len(), mesh.bounds().max), (12, Vec3::ONE));
    assert!(mesh.corners.iter().all(|corner| corner.normal == Vec3::Z && corner.uv == Vec2::new(0.5, 0.75)));
    let mut reds: Vec<_> = colors(&mesh).iter().map(|color| color[0]).collect();
    reds.sort_unstable_by(f32::total_cmp);
    reds.dedup();
    assert_eq!((reds.len(), reds[0]), (8, 0.0), "of vertices, not of faces");
    let far = read(&text.replace(" 1 0 0 1 ", " 0.5 0 0 1 "));
    assert_eq!(far.bounds().max, Vec3::splat(2.0), "the fourth coordinate divides");
}

#[test]
fn colours_of_vertices_go_up_to_255_or_to_1_in_a_whole_file() {
    let half = linear_color([128, 0, 255, 255]).to_array();
    let mesh = read(&cube_of("COFF\n8 6 0", |_| "128 0 255".to_owned(), nothing));
    assert!(!colors(&mesh).is_empty() && colors(&mesh).iter().all(|color| *color == half));
    let mesh = read(&cube_of("COFF\n8 6 0", |_| "0.502 0 1 1".to_owned(), nothing));
    assert!(colors(&mesh).iter().all(|color| *color == half));
    // Nearly black beside other colours, but blue where no number is larger.
    let mesh = read(&cube_of("COFF\n8 6 0", |i| format!("0 0 {}", if i == 0 { 200 } else { 1 }), nothing));
    assert!(colors(&mesh).iter().any(|color| *color == linear_color([0, 0, 1, 255]).to_array()));
    let mesh = read(&cube_of("COFF\n8 6 0", |_| "0 0 1".to_owned(), nothing));
    assert!(colors(&mesh).iter().all(|color| *color == [0.0, 0.0, 1.0, 1.0]));
    // The letter for colours may be missing.
    assert_eq!(colors(&read(&cube_of("OFF\n8 6 0", |_| "128 0 255".to_owned(), nothing)))[0], half);
}

#[test]
fn faces_have_colours_of_whole_numbers_or_of_others() {
    let face = |i: usize| ["", "255 0 0", "0.0 1.0 0.0 0.5", "7", "red", "1 2"][i].to_owned();
    let mesh = read(&cube_of("OFF\n8 6 0", nothing, face));
    assert_cube(&mesh);
    let mut found = colors(&mesh);
    found.sort_unstable_by(|a, b| a.partial_cmp(b).expect("numbers"));
    found.dedup();
    let half = 128.0 / 255.0;
    assert_eq!(found, [[0.0, 1.0, 0.0, half], [1.0, 0.0, 0.0, 1.0], [1.0; 4]]);
    assert_eq!(
        mesh.warnings[1..],
        [
            "faces with a number of a colour map, which isn't read: 2.",
            "faces with a colour that isn't 3 or 4 numbers, left out: 1."
        ]
    );
}

#[test]
fn a_file_that_was_cut_short_shows_its_whole_faces() {
    let text = cube();
    let whole = text.trim_end();
    for end in [whole.len() - 2, whole.len() - 12] {
        let mesh = read(&whole[..end]);
        assert!(
            mesh.warnings[0].starts_with("The file was cut short: it says that it has 6 faces"),
            "{:?}",
            mesh.warnings
        );
        assert!(mesh.triangles.len() < 12);
    }
    assert!(refused("OFF\n8 6 12\n0 0 0\n").contains("the file ends after 1 of its 8 vertices"));
}

#[test]
fn a_face_of_a_vertex_that_is_not_in_the_file_costs_that_face() {
    let mesh = read("OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n3 0 1 2\n4 0 1 2 x 255 0 0\n");
    assert_eq!(mesh.triangles.len(), 1);
    let said = "2 faces with the number of a position that isn't in the file, the first at line 6; they are left out.";
    assert!(mesh.warnings.iter().any(|warning| warning == said), "{:?}", mesh.warnings);
}

#[test]
fn the_number_of_vertices_may_follow_the_keyword_without_a_space() {
    for (space, glued) in [("OFF 8 6 12", "OFF8 6 12"), ("COFF\n8 6 12", "COFF8 6 12")] {
        let text = cube_of(space, nothing, nothing);
        let text = text.replacen(space, glued, 1);
        assert_cube(&read(&text));
        assert!(begins(text.as_bytes()), "{glued}");
    }
    assert!(refused("OFFS8 6 12\n").contains("begins with \"OFFS8\" instead of OFF"));
}

#[test]
fn what_is_not_read_is_refused_in_a_sentence() {
    assert!(refused("OFF BINARY\n\0\0\0\x08").contains("it is binary OFF, of which only the text form is read"));
    assert!(refused("nOFF\n5\n8 6 12\n").contains("any number of coordinates"));
    assert!(refused("# nothing\n").contains("no line besides comments"));
    assert!(refused("OFF\nmany\n").contains("line 2: \"many\" isn't the numbers of vertices, faces and edges"));
    assert!(refused("solid a\n").contains("begins with \"solid\" instead of OFF"));
}

#[test]
fn cancelling_stops_the_work() {
    let progress = Progress::new();
    progress.cancel();
    let text = cube().into_bytes();
    assert!(matches!(super::read(text, &ModelFile::from_test("", &progress)), Err(ReadError::Cancelled(_))));
}
