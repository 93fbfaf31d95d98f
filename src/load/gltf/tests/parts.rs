//! Named nodes as parts that can be left out.

use super::*;
use crate::parts::Part;
use crate::selection::ShownParts;

/// Reads what is selected of a document.
fn read_selected(draft: &Draft, selected: Selection) -> Result<LoadedMesh, GltfError> {
    let bytes = draft.document().to_string().into_bytes();
    read(bytes, &ModelFile { selected, ..ModelFile::from_test("draft", &Progress::new()) })
}

fn part(name: &str, triangles: u32, is_hidden: bool) -> Part {
    Part { name: name.to_owned(), triangles, is_hidden }
}

/// Two nodes of one name, one with the name of its mesh, one that shows nothing, and one without a name.
fn named() -> Draft {
    let mut draft = triangle();
    let unnamed = draft.root["meshes"][0].clone();
    draft.root["meshes"][0]["name"] = json!("mesh");
    draft.push("meshes", unnamed);
    draft.root["meshes"][1].as_object_mut().expect("a mesh").remove("name");
    draft.root["nodes"] = json!([
        { "name": "left", "mesh": 0, "children": [1] },
        { "name": "left", "mesh": 1, "translation": [5, 0, 0] },
        { "mesh": 0, "translation": [9, 0, 0] },
        { "name": "empty" },
        { "mesh": 1, "translation": [0, 7, 0] },
    ]);
    draft.root["scenes"] = json!([{ "nodes": [0, 2, 3, 4] }]);
    draft
}

#[test]
fn named_nodes_are_parts_and_hidden_ones_are_left_out() {
    let read = |hidden: &[&str]| {
        let hidden = hidden.iter().map(|name| (*name).to_owned()).collect();
        let shown = ShownParts { hidden, ..ShownParts::default() };
        read_selected(&named(), Selection { parts: Some(&shown), ..Selection::default() }).expect("triangles")
    };
    let whole = read(&[]);
    assert_eq!(
        (whole.triangles.len(), &whole.contents.parts[..]),
        (4, &[part("left", 2, false), part("mesh", 1, false)][..])
    );
    let of_each: Vec<_> = (0..4).map(|triangle| whole.part_of(triangle)).collect();
    assert_eq!(of_each, [Some(0), Some(0), Some(1), None], "children follow their parents");
    let some = read(&["left"]);
    assert_eq!(
        (some.triangles.len(), &some.contents.parts[..]),
        (2, &[part("left", 2, true), part("mesh", 1, false)][..])
    );
    assert!(some.corners.iter().all(|corner| corner.position.x > 8.0 || corner.position.y > 6.0));
    assert!(some.warnings.is_empty(), "{:?}", some.warnings);
}

#[test]
fn hidden_nodes_may_be_broken_and_hiding_all_is_said() {
    let mut draft = named();
    draft.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(99);
    let [some, all] = [&["left"][..], &["left", "mesh"]].map(|hidden| {
        let hidden = hidden.iter().map(|name| (*name).to_owned()).collect();
        ShownParts { hidden, ..ShownParts::default() }
    });
    let [some, all] = [&some, &all].map(|shown| Selection { parts: Some(shown), ..Selection::default() });
    assert!(read_selected(&draft, some).is_err());
    assert_eq!(read_selected(&draft, all).expect("the node without a name").triangles.len(), 1);
    draft.root["nodes"].as_array_mut().expect("nodes").truncate(3);
    draft.root["scenes"] = json!([{ "nodes": [0, 2] }]);
    let said = read_selected(&draft, all).map(|_| ()).expect_err("nothing is left").to_string();
    assert!(said.contains("its named parts are hidden"), "{said}");
}
