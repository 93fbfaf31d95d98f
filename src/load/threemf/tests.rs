//! 3MF files as slicers and modelling programs write them.

#[path = "../../../tests/documents/package.rs"]
pub(in crate::load) mod package;

use glam::Vec3;

use super::*;
use crate::load::face_builder::linear_color;
use crate::load::face_builder::tests::{POINTS, assert_cube, triangles};
use crate::mesh::Alpha;
use package::{Entry, MODEL, mesh, model, relationships, zip};

fn read(bytes: &[u8]) -> LoadedMesh {
    super::read(bytes.to_vec(), "cube", Import::default(), &Limits::default(), &Progress::new()).unwrap()
}

/// The mesh of a cube.
fn cube_mesh() -> String {
    mesh(POINTS.map(|point| point.map(f32::from)), triangles())
}

/// A file with one object.
fn of_object(object: &str, build: &str) -> Vec<u8> {
    package::package(&model(&format!("<object id=\"1\" {object}</object>"), build))
}

pub(crate) fn cube() -> Vec<u8> {
    of_object(&format!("type=\"model\">{}", cube_mesh()), "<item objectid=\"1\"/>")
}

/// The resources of [`everything`]: a painted cube, and an assembly of two of them.
fn painted() -> String {
    let painted = cube_mesh().replacen("v3=\"2\"/>", "v3=\"2\" pid=\"5\" p1=\"0\" p2=\"1\" p3=\"2\"/>", 1).replacen(
        "v3=\"1\"/>",
        "v3=\"1\" p1=\"1\"/>",
        1,
    );
    format!(
        "<basematerials id=\"4\"><base name=\"PLA\" displaycolor=\"#FF0000\"/><base name=\"Glass\" displaycolor=\"#0000FF80\"/>\
         </basematerials><m:colorgroup id=\"5\"><m:color color=\"#800000\"/><m:color color=\"#008000\"/>\
         <m:color color=\"#000080FF\"/></m:colorgroup><object id=\"1\" pid=\"4\" pindex=\"0\">{painted}</object>\
         <object id=\"2\"><components><component objectid=\"1\"/>\
         <component objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 8 0 0\"/></components></object>"
    )
}

/// A file with a part beside the model, materials, colours, components, a mirrored one, and what isn't read.
pub(crate) fn everything() -> Vec<u8> {
    let beside = model(&painted(), "");
    let own =
        "<object id=\"7\"><components><component p:path=\"/3D/Objects/a.model\" objectid=\"2\"/></components></object>";
    let root = model(own, "<item objectid=\"7\" transform=\"1 0 0 0 1 0 0 0 1 0 0 10\"/>");
    zip(&[
        Entry::stored("[Content_Types].xml", b"<Types/>"),
        Entry::stored("_rels/.rels", relationships().as_bytes()),
        Entry::stored(MODEL, root.as_bytes()),
        Entry::deflated("3D/Objects/a.model", beside.as_bytes()),
    ])
}

fn colors(mesh: &LoadedMesh) -> Vec<[f32; 4]> {
    let details = mesh.details.as_ref();
    let mut colors: Vec<_> =
        details.map_or(Vec::new(), |details| (0..details.len()).map(|i| details[i].color.to_array()).collect());
    colors.sort_unstable_by(|a, b| b.partial_cmp(a).expect("numbers"));
    colors.dedup();
    colors
}

#[test]
fn a_cube_gets_normals_and_no_warnings() {
    let deflated = zip(&[
        Entry::deflated("_rels/.rels", relationships().as_bytes()),
        Entry::deflated(
            MODEL,
            model(&format!("<object id=\"1\">{}</object>", cube_mesh()), "<item objectid=\"1\"/>").as_bytes(),
        ),
    ]);
    for bytes in [cube(), deflated] {
        let mesh = read(&bytes);
        assert_cube(&mesh);
        assert_eq!((mesh.name.as_str(), mesh.repairs.normals_made), ("cube", 36));
        assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
        assert_eq!((mesh.materials.len(), mesh.file_bytes), (1, bytes.len() as u64));
    }
}

#[test]
fn y_points_up_and_lengths_are_in_metres() {
    let triangle = mesh([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 20.0, 30.0]], [[0, 1, 2]]);
    let text = model(&format!("<object id=\"1\">{triangle}</object>"), "<item objectid=\"1\"/>");
    let units = [
        ("", 0.001),
        ("unit=\"millimeter\"", 0.001),
        ("unit=\"micron\"", 1e-6),
        ("unit=\"centimeter\"", 0.01),
        ("unit=\"inch\"", 0.0254),
        ("unit=\"foot\"", 0.3048),
        ("unit=\"meter\"", 1.0),
    ];
    for (unit, metres) in units {
        let mesh = read(&package::package(&text.replace("unit=\"meter\"", unit)));
        let bounds = mesh.bounds();
        assert!(bounds.max.distance(metres * Vec3::new(10.0, 30.0, 0.0)) <= 1e-5 * metres, "{unit}: {bounds:?}");
        assert!(bounds.min.distance(metres * Vec3::new(0.0, 0.0, -20.0)) <= 1e-5 * metres, "{unit}: {bounds:?}");
    }
    let mesh = read(&package::package(&text.replace("unit=\"meter\"", "unit=\"mile\"")));
    assert_eq!(mesh.warnings, ["The unit \"mile\" isn't one of 3MF, so lengths count as millimetres."]);
}

#[test]
fn components_are_placed_and_mirrored_ones_wound_outward() {
    let mesh = read(&everything());
    assert_eq!(mesh.triangles.len(), 24);
    // Eight to the right of the other one, both ten up.
    assert_eq!((mesh.bounds().min, mesh.bounds().max), (Vec3::new(-1.0, 9.0, -1.0), Vec3::new(9.0, 11.0, 1.0)));
    for triangle in mesh.triangles.iter() {
        let [a, b, c] = triangle.map(|corner| mesh.corners[corner as usize].position);
        let middle = Vec3::new(if a.x > 4.0 { 8.0 } else { 0.0 }, 10.0, 0.0);
        assert!((b - a).cross(c - a).dot(a - middle) > 0.0, "wound inward");
    }
}

#[test]
fn materials_and_colours_are_those_of_triangles_or_else_of_the_object() {
    let mesh = read(&everything());
    let materials: Vec<_> = mesh
        .materials
        .iter()
        .map(|material| (material.name.as_str(), material.triangles.len(), material.look.alpha))
        .collect();
    // Two cubes with one triangle of colours and one of glass each.
    let expected = [("PLA", 20, Alpha::Opaque), ("default", 2, Alpha::Opaque), ("Glass", 2, Alpha::Blend)];
    let mut found = materials.clone();
    found.sort_unstable_by_key(|(name, ..)| expected.iter().position(|(other, ..)| other == name));
    assert_eq!(found, expected, "{materials:?}");
    let of = |name: &str| mesh.materials.iter().find(|material| material.name == name).expect("a material").base_color;
    assert_eq!([of("PLA"), of("default")], [[1.0, 0.0, 0.0, 1.0], [1.0; 4]]);
    assert_eq!(of("Glass"), [0.0, 0.0, 1.0, 128.0 / 255.0]);
    let half = linear_color([128, 0, 0, 255]).x;
    assert_eq!(colors(&mesh), [[1.0; 4], [half, 0.0, 0.0, 1.0], [0.0, half, 0.0, 1.0], [0.0, 0.0, half, 1.0]]);
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
}

#[test]
fn a_library_shows_its_objects_but_not_their_parts_alone() {
    let mesh = read(&package::package(&model(&painted(), "")));
    assert_eq!(mesh.triangles.len(), 24);
    assert_eq!(mesh.warnings, ["The build has no items, so all objects are shown."]);
}

#[test]
fn prefixes_of_namespaces_are_free() {
    let text = model(&format!("<object id=\"1\">{}</object>", cube_mesh()), "<item objectid=\"1\"/>");
    let mut own = String::new();
    for (i, part) in text.split('<').enumerate() {
        match part.chars().next() {
            Some('?') => own += &format!("<{part}"),
            Some('/') => own += &format!("</c:{}", &part[1..]),
            Some(_) if i > 0 => own += &format!("<c:{part}"),
            _ => {}
        }
    }
    let own = own.replace("xmlns=", "xmlns:c=");
    assert_cube(&read(&package::package(&format!("\u{feff}{own}"))));
}

#[test]
fn the_directory_may_be_one_for_large_archives_and_offsets_may_be_off() {
    let plain = cube();
    let end = plain.len() - 22;
    let [length, start] = [12, 16].map(|at| {
        let number: [u8; 4] = plain[end + at..end + at + 4].try_into().expect("4 bytes");
        u64::from(u32::from_le_bytes(number))
    });
    // What APPNOTE.TXT 4.3.14 to 4.3.16 ask for: the large record, where it is, and a small one without numbers.
    let mut large = plain[..end].to_vec();
    large.extend([&b"PK\x06\x06"[..], &44_u64.to_le_bytes(), &[45, 0, 45, 0], &[0; 8]].concat());
    large.extend([2, 2, length, start].into_iter().flat_map(u64::to_le_bytes));
    large.extend([&b"PK\x06\x07\0\0\0\0"[..], &(end as u64).to_le_bytes(), &1_u32.to_le_bytes()].concat());
    large.extend([&b"PK\x05\x06\0\0\0\0"[..], &[0xff; 12], &[0; 2]].concat());
    assert_cube(&read(&large));
    let mut commented = plain;
    commented[end + 20..].copy_from_slice(&5_u16.to_le_bytes());
    commented.extend(b"hello");
    assert_cube(&read(&commented));
}

#[test]
fn cancelling_stops_the_work() {
    let progress = Progress::new();
    progress.cancel();
    assert!(matches!(
        super::read(cube(), "", Import::default(), &Limits::default(), &progress),
        Err(ReadError::Cancelled(_))
    ));
}
