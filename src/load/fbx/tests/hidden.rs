//! What a file hides: nodes and layers that are switched off, and clips that show and hide nodes.

use super::documents::{Link, add, curves, document, geometry, model, stack};
use super::tree::{Entry, object, one, properties, text};
use super::{loaded, read};
use crate::fbx::read_here;
use crate::import::Import;
use crate::loaded_mesh::LoadedMesh;
use crate::model_file::ModelFile;
use crate::selection::{Selection, ShownParts};
use geometry::progress::Progress;

const TRIANGLE: [f64; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

/// A text file of a version before 6000, with a triangle. Values of properties stand in channels of animations there.
fn old(version: u32, visibility: &str) -> String {
    format!(
        "; FBX {}.0.0 project file\nFBXHeaderExtension: {{\n\tFBXVersion: {version}\n}}\nModel: \"flag\" {{\n\tType: \"Mesh\"\n\
         \tVertices: 0,0,0,1,0,0,0,1,0\n\tPolygonVertexIndex: 0,1,-3\n\tMaterialAssignation: \"AllSame\"\n\
         \tChannel: \"Transform\" {{\n\t\tChannel: \"T\" {{\n\t\t\tChannel: \"X\" {{\n\t\t\t\tDefault: 5\n\t\t\t}}\n\t\t}}\n\t}}\n\
         {visibility}}}\n",
        version / 1000
    )
}

#[test]
fn meshes_of_old_versions_are_shown_unless_their_channel_hides_them() {
    let channel = |value: &str| format!("\tChannel: \"Visibility\" {{\n\t\tDefault: {value}\n\t}}\n");
    for version in [3000, 5000] {
        for visibility in [String::new(), channel("1"), channel("0.5")] {
            let loaded = read(old(version, &visibility).as_bytes()).expect("a file without a fault");
            assert_eq!(loaded.triangles.len(), 1, "{version} {visibility}");
        }
        let refused = read(old(version, &channel("0")).as_bytes()).expect_err("it is hidden").to_string();
        assert!(
            refused.contains("1 nodes with meshes that it hides (--show-hidden shows them)"),
            "{version}: {refused}"
        );
    }
}

/// Three triangles: one on a node that is switched off, one whose layer is, and one below the latter that doesn't inherit it.
fn layered() -> Vec<Entry> {
    let off: &[(&str, &str, &[f64])] = &[("Visibility", "Visibility", &[0.0])];
    let alone: &[(&str, &str, &[f64])] = &[("Visibility Inheritance", "Visibility Inheritance", &[0.0])];
    let layer = |id, show: f64| {
        object(
            "CollectionExclusive",
            id,
            "DisplayLayer::layer",
            "DisplayLayer",
            vec![properties(&[("Show", "bool", &[show])])],
        )
    };
    let objects = vec![
        geometry(10, &TRIANGLE, &[&[0, 1, 2]], Vec::new()),
        model(20, "off", "Mesh", off),
        model(21, "in a layer that is off", "Mesh", &[]),
        model(22, "below, but shown", "Mesh", alone),
        layer(70, 0.0),
        layer(71, 1.0),
    ];
    let links = [Link(20, 0, ""), Link(21, 0, ""), Link(22, 21, ""), Link(21, 70, ""), Link(22, 71, "")];
    let meshes = [20, 21, 22].map(|node| Link(10, node, ""));
    document(false, 100.0, objects, &links.into_iter().chain(meshes).collect::<Vec<_>>())
}

#[test]
fn nodes_and_layers_that_are_off_are_hidden_unless_they_are_asked_for() {
    let loaded = loaded(&layered());
    let said = "meshes that the file hides, left out (--show-hidden shows them): 2.";
    assert_eq!(
        (loaded.triangles.len(), loaded.warnings.contains(&said.to_owned())),
        (1, true),
        "{:?}",
        loaded.warnings
    );
    let import = Import { show_hidden: true, ..Import::default() };
    let progress = Progress::new();
    let selected = Selection { import, ..Selection::default() };
    let file = ModelFile { selected, ..ModelFile::from_test("test", &progress) };
    let all = read_here(text(&layered()), &file).expect("no fault");
    assert_eq!(all.triangles.len(), 3);
    let parts: Vec<_> = all.contents.parts.iter().map(|part| (part.name.as_str(), part.triangles)).collect();
    assert_eq!(parts, [("off", 1), ("in a layer that is off", 1), ("in a layer that is off/below, but shown", 1)]);
    assert_eq!([0, 1, 2].map(|triangle| all.part_of(triangle)), [Some(0), Some(1), Some(2)]);
    assert!(all.warnings.iter().all(|warning| !warning.contains("hides")), "{:?}", all.warnings);
}

#[test]
fn the_first_level_of_detail_is_shown_and_another_one_if_it_is_named() {
    let group = object("NodeAttribute", 30, "NodeAttribute::", "LodGroup", vec![one("TypeFlags", "LodGroup")]);
    let objects = vec![
        geometry(10, &TRIANGLE, &[&[0, 1, 2]], Vec::new()),
        group,
        model(20, "car", "LodGroup", &[]),
        model(21, "high", "Mesh", &[]),
        model(22, "low", "Null", &[]),
        model(23, "wheel", "Mesh", &[]),
    ];
    let links = [Link(20, 0, ""), Link(30, 20, ""), Link(21, 20, ""), Link(22, 20, ""), Link(23, 22, "")];
    let meshes = [21, 23].map(|node| Link(10, node, ""));
    let entries = document(false, 100.0, objects, &links.into_iter().chain(meshes).collect::<Vec<_>>());
    let first = loaded(&entries);
    let parts: Vec<_> = first.contents.parts.iter().map(|part| (part.name.as_str(), part.is_hidden)).collect();
    assert_eq!(parts, [("car/high", false), ("car/low/wheel", true)]);
    assert_eq!(first.triangles.len(), 1);
    assert!(first.warnings.iter().any(|warning| warning.contains("levels of detail")), "{:?}", first.warnings);
    let low = ShownParts { only: vec!["low".to_owned()], ..ShownParts::default() };
    let progress = Progress::new();
    let selected = Selection { parts: Some(&low), ..Selection::default() };
    let file = ModelFile { selected, ..ModelFile::from_test("test", &progress) };
    let other = read_here(text(&entries), &file).expect("no fault");
    assert_eq!(other.contents.parts.iter().map(|part| part.is_hidden).collect::<Vec<_>>(), [true, false]);
}

#[test]
fn a_file_of_curves_alone_says_what_it_holds_and_what_helps() {
    let line = vec![one("Points", TRIANGLE.to_vec()), one("PointsIndex", vec![0, 1, -3])];
    let objects = vec![object("Geometry", 10, "Geometry::line", "Line", line), model(20, "curve", "Line", &[])];
    let entries = document(false, 100.0, objects, &[Link(20, 0, ""), Link(10, 20, "")]);
    let refused = read(&text(&entries)).expect_err("it has no triangles").to_string();
    assert!(refused.contains("1 lines and curves (export them as polygons)"), "{refused}");
}

/// A triangle whose visibility is 1, with a clip that has these keys for it.
fn blinking(keys: &[(f64, f64)]) -> LoadedMesh {
    let on: &[(&str, &str, &[f64])] = &[("Visibility", "Visibility", &[1.0])];
    let mut objects = vec![
        geometry(10, &TRIANGLE, &[&[0, 1, 2]], Vec::new()),
        model(20, "parent", "Null", on),
        model(21, "child", "Mesh", &[]),
        model(22, "without a mesh", "Null", on),
    ];
    let mut links = vec![Link(20, 0, ""), Link(21, 20, ""), Link(10, 21, ""), Link(22, 0, "")];
    let hides: &[(f64, f64)] = &[(0.0, 0.0), (1.0, 1.0)];
    add(
        (&mut objects, &mut links),
        [
            stack("blink", 2.0),
            curves(50, (20, "Visibility"), &[("d|Visibility", keys)], 2),
            curves(60, (22, "Visibility"), &[("d|Visibility", hides)], 2),
        ],
    );
    loaded(&document(false, 100.0, objects, &links))
}

#[test]
fn only_clips_that_show_or_hide_a_mesh_are_warned_of() {
    let said = |loaded: LoadedMesh| loaded.warnings.iter().filter(|warning| warning.contains("show and hide")).count();
    assert_eq!(said(blinking(&[(0.0, 1.0), (1.0, 0.0), (2.0, 1.0)])), 1);
    assert_eq!(said(blinking(&[(0.0, 0.0), (2.0, 0.0)])), 1, "hidden all the time, unlike without the clip");
    assert_eq!(said(blinking(&[(0.0, 1.0), (2.0, 1.0)])), 0);
    assert_eq!(said(blinking(&[(0.0, 1.0), (2.0, 0.5)])), 0, "what isn't 0 is on");
}
