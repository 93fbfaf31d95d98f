//! `pnaen info`: the numbers of a mesh, with a weld tolerance or a crease band and without.

use serde_json::Value;

use crate::{Folder, failure, output, stats, vase, write_seam, write_triangles};

#[test]
fn info_is_printed_as_text_and_as_json() {
    let text = output(&["info", "shape:saddle"]);
    assert!(text.contains("boundary      24") && text.contains("open"), "{text}");
    assert!(text.contains("weld  ") && text.contains("\n  1e-5          joins nothing\n"), "{text}");
    assert!(!text.contains("near misses"), "{text}");
    let json: Value = serde_json::from_str(&output(&["info", "shape:saddle", "--json"])).expect("JSON");
    assert_eq!((&json["edges"]["boundary"], &json["closed"]), (&24.into(), &false.into()));
}

#[test]
fn a_crease_band_is_in_info_and_in_adjacency() {
    let band = ["--crease-band", "0.02"];
    let info = |file: &str| output(&[&["info", file, "--json"], &band[..]].concat());
    let json: Value = serde_json::from_str(&info("shape:cube-split")).expect("JSON");
    assert_eq!((&json["triangles"], &json["edges"]["split"], &json["closed"]), (&108.into(), &0.into(), &true.into()));
    assert_eq!((&json["crease_band"]["creases"], &json["crease_band"]["narrowed"]), (&12.into(), &0.into()));
    let text = output(&[&["info", "shape:cube-split"], &band[..]].concat());
    assert!(text.contains("\ncrease band   0.02 of the bounding diagonal wide, along 12 creases\n"), "{text}");
    let adjacency = output(&[&["adjacency", "shape:cube-split", "-o", "-"], &band[..]].concat());
    let adjacency: Value = serde_json::from_str(&adjacency).expect("JSON");
    assert_eq!(adjacency["patches"].as_array().map(Vec::len), Some(108));
    let torus: Value = serde_json::from_str(&info("shape:torus")).expect("JSON");
    assert!(torus["warnings"][0].as_str().is_some_and(|warning| warning.contains("no crease")), "{torus}");
    assert!(!output(&["info", "shape:cube-split"]).contains("crease band"));
}

#[test]
fn rim_is_another_name_of_the_crease_band() {
    for mesh in ["shape:cube-split", vase()] {
        let info = |option: &[&str]| output(&[&["info", mesh, "--json"], option].concat());
        let band = info(&["--crease-band", "0.02"]);
        assert_eq!(info(&["--rim", "0.02"]), band, "{mesh}");
        assert_ne!(info(&[]), band, "{mesh}");
    }
}

#[test]
fn weld_previews_are_about_the_mesh_without_its_crease_band() {
    let folder = Folder::new();
    let path = write_seam(&folder);
    let joins = |options: &[&str]| -> Value {
        let json: Value = serde_json::from_str(&output(&[&["info", &path, "--json"], options].concat())).expect("JSON");
        json["joins"].clone()
    };
    assert_eq!(joins(&["--crease-band", "0.01"]), joins(&[]));
}

#[test]
fn info_has_t_junctions_and_repairs_and_the_effect_of_a_weld_tolerance() {
    let folder = Folder::new();
    // One triangle above the edge from 0 to 4 along x. Two below it meet at 1 on the edge and miss its ends by 1e-4.
    let gap = 1e-4;
    let triangles = [
        [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, -gap, 0.0], [1.0, -2.0, 0.0]],
        [[4.0, -gap, 0.0], [1.0, 0.0, 0.0], [1.0, -2.0, 0.0]],
    ];
    let path = write_triangles(&folder, &triangles, [0.0, 0.0, -2.0]);
    let text = output(&["info", &path]);
    assert!(text.contains("T-junctions   1 ") && text.contains("  at 1 0 0 between 0 0 0 and 4 0 0\n"), "{text}");
    let info = |options: &[&str]| -> Value {
        serde_json::from_str(&output(&[&["info", &path, "--json"], options].concat())).expect("JSON")
    };
    let (exact, welded) = (info(&[]), info(&["--weld", "1e-4"]));
    assert_eq!((&exact["weld"], &exact["points"], &exact["t_junctions"]), (&0.0.into(), &7.into(), &1.into()));
    assert_eq!((&welded["points"], &welded["t_junctions"]), (&5.into(), &1.into()));
    let expected = serde_json::json!([[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]], [1.0, 0.0, 0.0]]);
    let junction = &welded["t_junctions_at"][0];
    assert_eq!((&junction["edge"], &junction["point"]), (&expected[0], &expected[1]));
    assert_eq!(junction["t"], 0.25);
    assert_eq!(
        (&exact["repairs"]["normals_rescaled"], &exact["normal_faults"]["against_face"]),
        (&9.into(), &9.into())
    );
    assert!(exact["warnings"][0].as_str().is_some_and(|warning| warning.contains("length wasn't 1")), "{exact}");
}

#[test]
fn a_weld_tolerance_closes_a_seam_that_almost_meets() {
    let folder = Folder::new();
    let (path, out) = (write_seam(&folder), folder.path("out.glb"));
    let json = |arguments: &[&str]| -> Value { serde_json::from_str(&output(arguments)).expect("JSON") };
    let info = |options: &[&str]| json(&[&["info", &path, "--json"], options].concat());
    for (options, open) in [(&[][..], true), (&["--weld", "1e-3"], false)] {
        let (info, drawn) = (info(options), stats(&[&[path.as_str()], options].concat()));
        let boundary: Value = if open { 6 } else { 0 }.into();
        assert_eq!((&info["edges"]["boundary"], &info["closed"]), (&boundary, &(!open).into()), "{options:?}");
        let joins: Vec<_> =
            info["joins"].as_array().expect("a list").iter().map(|join| join["edges"].clone()).collect();
        let expected = [0, 0, 0, 6, 6, 6].map(Value::from);
        assert_eq!(joins, expected, "compared with the exact weld under any tolerance: {options:?}");
        assert_eq!(drawn["edges"]["boundary"], boundary, "{options:?}");
        assert_eq!(drawn["leaks"], if open { Value::Null } else { 0.into() }, "{options:?}");
        assert_eq!((&drawn["cracks"]["edges"], &drawn["patches"]), (&0.into(), &4.into()), "{options:?}");
        // The written mesh is closed to the bit, so it needs no tolerance.
        output(&[&["tessellate", &path, "-o", &out, "--factor", "3", "--device", "cpu"], options].concat());
        assert_eq!(json(&["info", &out, "--json"])["closed"], !open, "{options:?}");
    }
    assert_eq!(info(&["--weld", "1e-5"])["edges"]["boundary"], 6, "the tolerance is smaller than the gap");
}

#[test]
fn control_characters_in_names_are_replaced() {
    let folder = Folder::new();
    let path = folder.path("odd\n\x1b[2J.obj");
    let name = format!("\x1b[2Jred{}", "x".repeat(1000));
    let mesh = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl {name}\nf 1 2 3\n");
    std::fs::write(&path, mesh).expect("a writable temporary folder");
    let text = output(&["info", &path]);
    let has_odd = |text: &str| text.contains(|letter: char| letter.is_control() && letter != '\n');
    assert!(!has_odd(&text), "{text:?}");
    assert!(text.starts_with("odd\u{fffd}\u{fffd}[2J"), "{text:?}");
    let material = text.lines().find(|line| line.starts_with("material")).expect("one");
    assert!(material.contains("\u{fffd}[2Jredxxx") && material.contains("x…: 1 triangles"), "{material}");
    assert!(material.chars().count() < 250, "{material}");
    let json: Value = serde_json::from_str(&output(&["info", &path, "--json"])).expect("JSON");
    assert_eq!(json["materials"][0]["name"].as_str(), Some(name.as_str()), "JSON has the whole name");
    std::fs::write(&path, "f 1 2 3\n").expect("a writable temporary folder");
    for said in [failure(&["info", &path], 1), failure(&["info", "no\x1b[2J\nsuch.glb"], 1)] {
        assert!(!has_odd(&said) && said.lines().count() == 1, "{said:?}");
    }
}
