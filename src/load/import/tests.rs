//! Normals that are made, in every format; and axes and units that are chosen.

use std::path::Path;

use glam::{Vec3, vec3};
use proptest::prelude::*;

use super::*;
use crate::Format;
use crate::face_builder::tests::{POINTS, SIDES, assert_cube};
use crate::fbx::tests::documents::{Link, document, geometry, model, smoothed_prism};
use crate::fbx::tests::tree::text;
use crate::files::Limits;
use crate::loaded_mesh::LoadedMesh;
use crate::mesh_file::{LoadError, read};
use crate::selection::{Selection, ShownParts};
use crate::source::Source;
use geometry::mesh::shapes::Shape;
use geometry::progress::Progress;

const MADE: Import = Import {
    normals: NormalSource::Made,
    crease_angle: 60.0,
    up: None,
    unit: None,
    show_hidden: false,
    subdivide: Subdivide::File,
    levels: None,
    subdivide_uvs: None,
};

fn loaded(format: Format, bytes: &[u8], import: Import) -> LoadedMesh {
    styled(format, bytes, import, &[])
}

/// The same with styles of parts.
fn styled(format: Format, bytes: &[u8], import: Import, styles: &[(&str, &str)]) -> LoadedMesh {
    let style = |(name, style): &(&str, &str)| ((*name).to_owned(), style.parse().expect("a style"));
    let parts = ShownParts { styles: styles.iter().map(style).collect(), ..ShownParts::default() };
    let selected = Selection { import, parts: Some(&parts), ..Selection::default() };
    read(format, bytes.to_vec(), Path::new("nowhere/test"), selected, &Limits::default(), &Progress::new())
        .expect("a file without a fault")
}

/// The cube of the readers' tests, with a normal of all corners, and in one smoothing group.
fn smooth_cube() -> String {
    let vertices: String = POINTS.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    let corner = |i: &usize| format!(" {}//1", i + 1);
    let face = |side: &[usize; 4]| format!("f{}\n", side.iter().map(corner).collect::<String>());
    format!("{vertices}vn 0 1 0\ns 1\n{}", SIDES.iter().map(face).collect::<String>())
}

/// The same as PLY, with the wrong normals of vertices.
fn ply_cube() -> String {
    let vertices: String = POINTS.iter().map(|[x, y, z]| format!("{x} {y} {z} 0 1 0\n")).collect();
    let face = |[a, b, c, d]: &[usize; 4]| format!("4 {a} {b} {c} {d}\n");
    let properties: String = ["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property float {name}\n")).concat();
    format!(
        "ply\nformat ascii 1.0\nelement vertex 8\n{properties}element face 6\nproperty list uchar int vertex_indices\n\
         end_header\n{vertices}{}",
        SIDES.iter().map(face).collect::<String>()
    )
}

/// Checks that the normals of every triangle are its own.
fn assert_flat(mesh: &Mesh) {
    for triangle in mesh.triangles.iter() {
        let corners = triangle.map(|id| mesh.corners[id as usize]);
        let [a, b, c] = corners.map(|corner| corner.position);
        let face = (b - a).cross(c - a).normalize();
        assert!(corners.iter().all(|corner| corner.normal.distance(face) < 1e-4), "{corners:?}, not {face}");
    }
}

#[test]
fn made_normals_take_the_place_of_wrong_ones_and_of_smoothing_groups() {
    for (format, bytes) in [(Format::Obj, smooth_cube()), (Format::Ply, ply_cube())] {
        let own = loaded(format, bytes.as_bytes(), Import::default());
        assert!(own.corners.iter().all(|corner| corner.normal == Vec3::Y), "{format:?} has the file's");
        let made = loaded(format, bytes.as_bytes(), MADE);
        assert_cube(&made);
        assert_eq!((made.warnings.len(), made.repairs.normals_made), (0, 36), "{format:?} was asked for them");
    }
}

#[test]
fn the_crease_angle_holds_where_normals_are_missing_and_warnings_name_it() {
    let missing = smooth_cube().replace("//1", "").replace("s 1\n", "");
    let import = Import { crease_angle: 95.0, ..Import::default() };
    let mesh = loaded(Format::Obj, missing.as_bytes(), import);
    let diagonal = |corner: &geometry::mesh::Corner| corner.normal.distance(corner.position.normalize()) < 1e-6;
    assert!(mesh.corners.iter().all(diagonal), "the three sides of a corner are smooth");
    assert!(mesh.warnings[0].contains("smoothed below 95 degrees"), "{:?}", mesh.warnings);
    assert_cube(&loaded(Format::Obj, missing.as_bytes(), Import { crease_angle: 89.0, ..Import::default() }));
}

#[test]
fn gltf_and_fbx_files_get_normals_that_are_made() {
    let prism = text(&smoothed_prism());
    for (format, bytes) in [(Format::Gltf, assets::VASE), (Format::Fbx, &prism)] {
        let own = loaded(format, bytes, Import::default());
        let flat = loaded(format, bytes, Import { crease_angle: 0.0, ..MADE });
        assert_flat(&flat);
        assert_eq!(flat.triangles.len(), own.triangles.len());
        assert_eq!(flat.repairs.normals_made as usize, 3 * flat.triangles.len());
        assert!(flat.warnings.iter().all(|warning| !warning.contains("normals")), "{:?}", flat.warnings);
        assert!(own.repairs.normals_made == 0, "{format:?} has normals of its own");
    }
}

#[test]
fn shapes_get_made_normals_too_and_have_no_other_axis() {
    let load = |import| {
        let selected = Selection { import, ..Selection::default() };
        Source::Shape(Shape::Torus).load_selected(selected, &Limits::default(), &Progress::new())
    };
    assert_flat(&load(Import { crease_angle: 0.0, ..MADE }).expect("a shape").mesh);
    for import in
        [Import { up: Some(UpAxis::Z), ..MADE }, Import { unit: Some(FileUnit::Named(LengthUnit::Inch)), ..MADE }]
    {
        let refused = load(import).map(|_| ()).expect_err("its exact surface doesn't move");
        assert!(matches!(refused, LoadError::Shape { .. }), "{refused}");
    }
}

/// A floor and a wall, each a part of a material of its own, that meet in an edge. `normal` is that of all corners, and `before`
/// stands before the faces.
fn bent(normal: &str, before: &str) -> String {
    let corners = |numbers: [u32; 4]| numbers.map(|number| format!(" {number}{normal}")).concat();
    let positions = "v 0 0 0\nv 2 0 0\nv 2 0 2\nv 0 0 2\nv 0 2 0\nv 2 2 0\nvn 1 0 0\n";
    let faces = [("floor", "grey", [1, 4, 3, 2]), ("wall", "white", [1, 2, 6, 5])];
    let face = |(part, material, numbers)| format!("o {part}\nusemtl {material}\nf{}\n", corners(numbers));
    positions.to_owned() + before + &faces.map(face).concat()
}

/// The normals of the floor and of the wall at the edge between them, where each has one.
fn at_the_edge(loaded: &LoadedMesh) -> [Vec3; 2] {
    [0, 1].map(|part| {
        let own = (0..).zip(loaded.triangles.iter()).filter(|(triangle, _)| loaded.part_of(*triangle) == Some(part));
        let corners = own.flat_map(|(_, corners)| corners.map(|id| loaded.corners[id as usize]));
        let there: Vec<Vec3> = corners
            .filter(|corner| corner.position.y == 0.0 && corner.position.z == 0.0)
            .map(|corner| corner.normal)
            .collect();
        assert!(!there.is_empty() && there.iter().all(|normal| normal.distance(there[0]) < 1e-6), "{there:?}");
        there[0]
    })
}

/// With a wall and a floor that are equally large around each point, their mean normal lies in the middle.
fn assert_at_the_edge(loaded: &LoadedMesh, expected: [Vec3; 2], what: &str) {
    let found = at_the_edge(loaded);
    let are_near = found.iter().zip(expected).all(|(found, expected)| found.distance(expected) < 1e-6);
    assert!(are_near, "{what}: {found:?}, not {expected:?}");
}

#[test]
fn corners_of_a_part_follow_its_own_rule_and_count_the_faces_of_all_parts() {
    let between = vec3(0.0, 1.0, 1.0).normalize();
    let without = bent("", "");
    let given = bent("//1", "");
    let [usual, smooth] = [60.0, 180.0].map(|crease_angle| Import { crease_angle, ..Import::default() });
    type Case<'a> = (&'a str, Import, &'a [(&'a str, &'a str)], [Vec3; 2]);
    let cases: [Case; 12] = [
        (&without, usual, &[], [Vec3::Y, Vec3::Z]),
        (&without, usual, &[("wall", "crease=180")], [Vec3::Y, between]),
        (&without, usual, &[("wall", "crease=90")], [Vec3::Y, between]),
        (&without, smooth, &[("wall", "crease=0")], [between, Vec3::Z]),
        (&without, usual, &[("wall", "crease=180"), ("floor", "crease=180")], [between; 2]),
        (&without, smooth, &[("material:grey", "crease=89")], [Vec3::Y, between]),
        (&without, smooth, &[("material:grey", "crease=89"), ("floor", "crease=91")], [between; 2]),
        (&given, usual, &[], [Vec3::X; 2]),
        (&given, usual, &[("wall", "normals=made")], [Vec3::X, Vec3::Z]),
        (&given, usual, &[("wall", "normals=made,crease=180")], [Vec3::X, between]),
        (&given, MADE, &[("material:white", "normals=file")], [Vec3::Y, Vec3::X]),
        (&given, usual, &[("material:white", "normals=made"), ("wall", "normals=file")], [Vec3::X; 2]),
    ];
    for (text, import, styles, expected) in cases {
        let mesh = styled(Format::Obj, text.as_bytes(), import, styles);
        assert_at_the_edge(&mesh, expected, &format!("{styles:?} with {import:?}"));
    }
}

#[test]
fn smoothing_groups_count_for_parts_whose_normals_are_those_of_the_file() {
    let grouped = bent("", "s 1\n");
    let own = styled(Format::Obj, grouped.as_bytes(), Import::default(), &[("wall", "normals=made")]);
    let [floor, wall] = at_the_edge(&own);
    assert!(floor.z > 0.1, "{floor}");
    assert_at_the_edge(&own, [floor, Vec3::Z], "a wall that is made");
    let own = styled(Format::Obj, grouped.as_bytes(), MADE, &[("floor", "normals=file")]);
    assert_at_the_edge(&own, [floor, wall], "a floor of the file");
}

#[test]
fn normals_are_missed_only_where_nobody_chose_how_they_are_made() {
    let missed = |styles: &[(&str, &str)]| {
        let mut warnings = styled(Format::Obj, bent("", "").as_bytes(), Import::default(), styles).warnings;
        warnings.retain(|warning| is_of_lacking_normals(warning));
        warnings.first().and_then(|warning| warning.trim_end_matches('.').chars().last())
    };
    assert_eq!(missed(&[]), Some('2'));
    assert_eq!(missed(&[("wall", "surface=flat")]), Some('2'));
    assert_eq!(missed(&[("wall", "crease=30")]), Some('1'));
    assert_eq!(missed(&[("wall", "normals=made"), ("material:grey", "crease=60")]), None);
}

#[test]
fn all_parts_of_gltf_and_fbx_files_and_of_cages_can_have_made_normals() {
    let prism = text(&smoothed_prism());
    for (format, bytes) in [(Format::Gltf, assets::VASE), (Format::Fbx, &prism)] {
        let own = loaded(format, bytes, Import::default());
        let names: Vec<String> = own.contents.parts.iter().map(|part| part.name.clone()).collect();
        let styles: Vec<_> = names.iter().map(|name| (name.as_str(), "normals=made,crease=0")).collect();
        let [of_parts, of_all] = [
            styled(format, bytes, Import::default(), &styles),
            loaded(format, bytes, Import { crease_angle: 0.0, ..MADE }),
        ];
        assert_flat(&of_parts);
        assert_eq!((&of_parts.corners, &of_parts.triangles), (&of_all.corners, &of_all.triangles), "{format:?}");
        assert_eq!((&of_parts.warnings, of_parts.repairs), (&of_all.warnings, of_all.repairs), "{format:?}");
    }
    let import = Import { subdivide: Subdivide::CatmullClark, levels: Some(1.0), ..Import::default() };
    let flat = styled(Format::Obj, smooth_cube().as_bytes(), import, &[("default", "normals=made,crease=0")]);
    assert!(flat.is_refined && flat.triangles.len() == 48);
    assert_flat(&flat);
    let smooth = loaded(Format::Obj, smooth_cube().as_bytes(), import);
    assert!(smooth.corners.len() < flat.corners.len(), "it has the normals of the limit");
}

/// A triangle in centimetres, in a file that says which axis points up.
fn fbx(z_up: bool) -> Vec<u8> {
    let objects = vec![
        geometry(10, &[0.0, 0.0, 0.0, 100.0, 0.0, 0.0, 0.0, 200.0, 300.0], &[&[0, 1, 2]], Vec::new()),
        model(20, "triangle", "Mesh", &[]),
    ];
    text(&document(z_up, 1.0, objects, &[Link(20, 0, ""), Link(10, 20, "")]))
}

#[test]
fn what_was_chosen_takes_the_place_of_what_an_fbx_file_says() {
    let last = |z_up, import| loaded(Format::Fbx, &fbx(z_up), import).corners[2].position;
    let near = |a: Vec3, b: Vec3| assert!(a.distance(b) < 1e-5 * b.length(), "{a}, not {b}");
    let import = |up, unit: Option<LengthUnit>| Import { up, unit: unit.map(FileUnit::Named), ..Import::default() };
    near(last(true, import(None, None)), vec3(0.0, 3.0, -2.0));
    near(last(true, import(Some(UpAxis::Y), None)), vec3(0.0, 2.0, 3.0));
    near(last(false, import(Some(UpAxis::Z), None)), vec3(0.0, 3.0, -2.0));
    near(last(false, import(None, Some(LengthUnit::Metre))), vec3(0.0, 200.0, 300.0));
    near(last(true, import(Some(UpAxis::Y), Some(LengthUnit::Millimetre))), vec3(0.0, 0.2, 0.3));
}

/// In 3MF files Z points up. The unit of this one is the metre.
#[test]
fn what_was_chosen_takes_the_place_of_what_a_3mf_file_means() {
    let bytes = crate::threemf::tests::cube();
    let bounds = |import| {
        let bounds = loaded(Format::ThreeMf, &bytes, import).bounds();
        (bounds.min, bounds.max)
    };
    let import = |up, unit: Option<LengthUnit>| Import { up, unit: unit.map(FileUnit::Named), ..Import::default() };
    let own = bounds(import(None, None));
    let numbers = bounds(import(Some(UpAxis::Y), Some(LengthUnit::Metre)));
    let corners = [numbers.0, numbers.1].map(|corner| UpAxis::Z.turn(corner));
    assert_eq!(own, (corners[0].min(corners[1]), corners[0].max(corners[1])));
    assert_eq!(bounds(import(Some(UpAxis::Z), Some(LengthUnit::Metre))), own, "the same, said once more");
    let small = bounds(import(None, Some(LengthUnit::Millimetre)));
    assert!(small.1.distance(0.001 * own.1) < 1e-9, "{small:?}");
}

/// The lengths of units do what their definitions say.
#[test]
fn twelve_inches_are_a_foot() {
    assert!((12.0 * LengthUnit::Inch.metres() - LengthUnit::Foot.metres()).abs() < 1e-15);
    assert_eq!(10.0 * LengthUnit::Millimetre.metres(), LengthUnit::Centimetre.metres());
}

/// An inch that is written as a number moves points to the same bits as one that is named.
#[test]
fn a_unit_may_be_given_by_its_length() {
    let text = b"v 0.1 0.7 1.3\nv 3.3 17 -2\nv 1e5 0.03 9\nf 1 2 3\n";
    let corners = |unit| loaded(Format::Obj, text, Import { unit, ..Import::default() }).corners.clone();
    let written = corners(Some(FileUnit::Metres(0.0254)));
    assert_eq!(written, corners(Some(FileUnit::Named(LengthUnit::Inch))));
    assert_ne!(written, corners(None));
    for wrong in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e10, 1e-10] {
        assert_eq!(FileUnit::from_metres(wrong), None, "{wrong}");
    }
}

proptest! {
    #[test]
    fn a_file_in_another_unit_is_that_much_larger(
        points in prop::array::uniform3(prop::array::uniform3(-1e6_f32..1e6)),
        up in prop::sample::select(vec![UpAxis::Y, UpAxis::Z, UpAxis::NegX]),
        unit in prop::sample::select(vec![LengthUnit::Millimetre, LengthUnit::Foot, LengthUnit::Metre]),
    ) {
        let vertices: String = points.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
        let text = format!("{vertices}f 1 2 3\n");
        let plain = loaded(Format::Obj, text.as_bytes(), Import::default());
        let placed = loaded(Format::Obj, text.as_bytes(), Import { up: Some(up), unit: Some(FileUnit::Named(unit)), ..Import::default() });
        prop_assert_eq!(plain.corners.len(), placed.corners.len());
        for (own, placed) in plain.corners.iter().zip(&placed.corners) {
            let expected = up.turn(own.position).as_dvec3() * unit.metres();
            prop_assert!((placed.position.as_dvec3() - expected).abs().max_element() <= 1e-7 * expected.abs().max_element());
            prop_assert_eq!(placed.normal, up.turn(own.normal));
        }
    }
}
