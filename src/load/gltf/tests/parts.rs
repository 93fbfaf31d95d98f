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
    Part { name: name.to_owned(), triangles, is_hidden, level: 0 }
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
    let parts = |left: bool, below: bool| {
        [part("left", 1, left), part("left/left", 1, below), part("mesh", 1, false), part("default", 1, false)]
    };
    assert_eq!((whole.triangles.len(), &whole.contents.parts[..]), (4, &parts(false, false)[..]));
    let of_each: Vec<_> = (0..4).map(|triangle| whole.part_of(triangle)).collect();
    assert_eq!(of_each, [Some(0), Some(1), Some(2), Some(3)], "children follow their parents");
    let some = read(&["left"]);
    assert_eq!((some.triangles.len(), &some.contents.parts[..]), (2, &parts(true, true)[..]));
    assert!(some.corners.iter().all(|corner| corner.position.x > 8.0 || corner.position.y > 6.0));
    assert!(some.warnings.is_empty(), "{:?}", some.warnings);
    let own = read(&["/left/."]);
    assert_eq!((own.triangles.len(), &own.contents.parts[..]), (3, &parts(true, false)[..]), "children stay");
}

#[test]
fn other_levels_of_detail_are_placed_beside_the_first_and_shown_if_they_are_named() {
    let mut draft = named();
    draft.root["extensionsUsed"] = json!(["MSFT_lod"]);
    draft.root["nodes"] = json!([
        { "name": "group", "translation": [0, 7, 0], "children": [1] },
        { "name": "near", "mesh": 0, "extensions": { "MSFT_lod": { "ids": [2, 99, 1] } } },
        { "name": "far", "mesh": 1, "children": [3] },
        { "name": "bolt", "mesh": 1 },
        { "name": "near", "mesh": 1, "extensions": { "MSFT_lod": { "ids": [5] } } },
        { "name": "far", "mesh": 1 },
    ]);
    draft.root["scenes"] = json!([{ "nodes": [0, 4, 5] }]);
    let read = |only: &[&str]| {
        let mut named = ShownParts::default();
        named.show_only(only.iter().map(|name| (*name).to_owned()).collect());
        let selected = Selection { parts: Some(&named), ..Selection::default() };
        let loaded = read_selected(&draft, selected).expect("triangles");
        let shown = loaded.contents.parts.iter().filter(|part| !part.is_hidden).map(|part| part.name.clone());
        (shown.collect::<Vec<_>>(), loaded)
    };
    let (shown, first) = read(&[]);
    assert_eq!((shown, first.triangles.len()), (vec!["group/near".to_owned(), "near".to_owned()], 2));
    assert!(first.warnings.iter().any(|warning| warning.contains("levels of detail")), "{:?}", first.warnings);
    let (shown, other) = read(&["group/far"]);
    assert_eq!((shown, other.triangles.len()), (vec!["group/far".to_owned(), "group/far/bolt".to_owned()], 2));
    assert!(other.corners.iter().all(|corner| corner.position.y > 6.0), "it moves with the group");
    assert_eq!(read(&["group"]).0, ["group/near"]);
}

/// The paths of the parts that are shown if these names alone are, and where the corners are.
fn shown_of(draft: &Draft, only: &[&str]) -> (Vec<String>, Vec<glam::Vec3>) {
    let mut named = ShownParts::default();
    named.show_only(only.iter().map(|name| (*name).to_owned()).collect());
    let selected = Selection { parts: Some(&named), ..Selection::default() };
    let loaded = read_selected(draft, selected).expect("triangles");
    let shown = loaded.contents.parts.iter().filter(|part| !part.is_hidden).map(|part| part.name.clone());
    (shown.collect(), loaded.corners.iter().map(|corner| corner.position).collect())
}

#[test]
fn levels_of_one_name_or_without_one_are_told_apart_whichever_comes_first() {
    for (name, own) in [("Car", "Car"), ("", "default")] {
        for [first, level] in [[0, 1], [1, 0]] {
            let mut draft = named();
            draft.root["extensionsUsed"] = json!(["MSFT_lod"]);
            draft.root["nodes"] = json!([{ "name": name, "mesh": 1 }, { "name": name, "mesh": 1 }]);
            draft.root["nodes"][first]["extensions"] = json!({ "MSFT_lod": { "ids": [level] } });
            draft.root["nodes"][level]["translation"] = json!([0, 7, 0]);
            draft.root["scenes"] = json!([{ "nodes": [first] }]);
            let (shown, corners) = shown_of(&draft, &[]);
            assert_eq!((shown, corners.len()), (vec![own.to_owned()], 3), "{name} at {first}");
            assert!(corners.iter().all(|corner| corner.y < 6.0), "{name} at {first}");
            let other = format!("{own} (level 1)");
            let (shown, corners) = shown_of(&draft, &[&other]);
            assert_eq!((shown, corners.len()), (vec![other], 3), "{name} at {level}");
            assert!(corners.iter().all(|corner| corner.y > 6.0), "{name} at {level}");
        }
    }
}

#[test]
fn levels_that_name_each_other_or_hold_the_first_are_none_and_without_scenes_there_are_levels() {
    let read = |nodes, scenes: Option<serde_json::Value>| {
        let mut draft = named();
        draft.root["extensionsUsed"] = json!(["MSFT_lod"]);
        draft.root["nodes"] = nodes;
        match scenes {
            Some(scenes) => draft.root["scenes"] = scenes,
            None => ["scene", "scenes"].iter().for_each(|name| {
                draft.root.as_object_mut().expect("a document").remove(*name);
            }),
        }
        shown_of(&draft, &[]).0
    };
    let node = |name: &str, ids: &[usize], children: &[usize]| {
        let mut node = json!({ "name": name, "mesh": 1 });
        if !ids.is_empty() {
            node["extensions"] = json!({ "MSFT_lod": { "ids": ids } });
        }
        if !children.is_empty() {
            node["children"] = json!(children);
        }
        node
    };
    let both = json!([node("a", &[1], &[]), node("b", &[0], &[])]);
    assert_eq!(read(both, Some(json!([{ "nodes": [0, 1] }]))), ["a", "b"]);
    let inside = json!([node("a", &[], &[1]), node("b", &[], &[2]), node("c", &[0, 3], &[]), node("d", &[], &[])]);
    assert_eq!(read(inside, Some(json!([{ "nodes": [0] }]))), ["a", "a/b", "a/b/c"]);
    let two = json!([node("a", &[1], &[]), node("b", &[], &[])]);
    assert_eq!(read(two, None), ["a"]);
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
