//! `--surface-shader`: control points from a function of the user's own.

use serde_json::Value;

use crate::{Folder, SIMPLE_LIGHT, both, failure, number, run, sentence};

const PN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/surface/pn.wgsl");
const PN_AEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/surface/pn-aen.wgsl");

/// Writes a file whose function returns these control points.
fn write(folder: &Folder, name: &str, ab: &str, ba: &str) -> String {
    let path = folder.path(name);
    let text = format!(
        "fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints {{ return EdgePoints({ab}, {ba}); }}"
    );
    std::fs::write(&path, text).expect("a writable folder");
    path
}

#[test]
fn a_rule_that_tears_is_drawn_listed_and_measured_and_one_that_does_not_passes() {
    let folder = Folder::new();
    let picture = folder.path("out.png");
    let drawn = |shader: &str| {
        let size = ["--size", "160x120", "--overlay", "cracks", "--stats", "-"];
        let cube = ["render", "shape:cube-split", "--factor", "8", "-o", &picture, "--surface-shader", shader];
        let (stats, said) = both(&[&cube[..], &size, &SIMPLE_LIGHT].concat());
        (serde_json::from_str::<Value>(&stats).expect("JSON"), said)
    };
    let (stats, said) = drawn(PN);
    assert!(said.starts_with("pnaen: 12 of 18 edges have different control points on their sides\n"), "{said}");
    assert_eq!(
        said.lines().filter(|line| line.contains(" between the control points of triangles ")).count(),
        10,
        "{said}"
    );
    assert_eq!(number(&stats, "/surface_shader/edges_different"), 12.0);
    assert_eq!(stats["surface_shader"]["edges"].as_array().map(Vec::len), Some(12));
    assert!(number(&stats, "/surface_shader/max_distance") > number(&stats, "/cracks/max_gap"), "{stats}");
    assert_eq!((number(&stats, "/cracks/edges"), number(&stats, "/surface_shader/not_numbers")), (12.0, 0.0));
    assert_eq!((stats["settings"]["surface"].as_str(), &stats["max_error_px"]), (Some("surface-shader"), &Value::Null));
    let (stats, said) = drawn(PN_AEN);
    assert_eq!(said, "pnaen: 0 of 18 edges have different control points on their sides\n");
    assert_eq!((number(&stats, "/cracks/edges"), number(&stats, "/cracks/max_gap")), (0.0, 0.0));
    // As a gate.
    let gated = |shader: &str| {
        run(&[
            "tessellate",
            "shape:cube-split",
            "--factor",
            "8",
            "-o",
            &folder.path("out.obj"),
            "--surface-shader",
            shader,
            "--fail-on",
            "cracks",
        ])
    };
    assert!(gated(PN_AEN).status.success());
    let failed = gated(PN);
    assert_eq!(failed.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&failed.stderr).contains("12 edges"), "{failed:?}");
}

#[test]
fn a_surface_of_ones_own_is_written_turned_and_split() {
    let folder = Folder::new();
    let [own, ours] = ["own.obj", "ours.obj"].map(|name| folder.path(name));
    let flat = write(&folder, "flat.wgsl", "mix(edge.a, edge.b, 1.0 / 3.0)", "mix(edge.b, edge.a, 1.0 / 3.0)");
    both(&["tessellate", "shape:torus", "--factor", "8", "-o", &own, "--surface-shader", &flat]);
    both(&["tessellate", "shape:torus", "--factor", "8", "-o", &ours, "--surface", "flat"]);
    let positions = |path: &str| -> Vec<f32> {
        let text = std::fs::read_to_string(path).expect("a mesh");
        let points = text.lines().filter_map(|line| line.strip_prefix("v "));
        points.flat_map(|line| line.split(' ').map(|x| x.parse().expect("a number")).collect::<Vec<_>>()).collect()
    };
    let (own, ours) = (positions(&own), positions(&ours));
    assert!(own.len() == ours.len() && own.len() > 10_000);
    // A cubic with these control points is the straight line but for rounding.
    assert!(own.iter().zip(&ours).all(|(a, b)| (a - b).abs() < 1e-5));
    both(&[
        "turntable",
        "shape:torus",
        "--factor",
        "4",
        "-o",
        &folder.path("turn"),
        "--frames",
        "2",
        "--size",
        "64x48",
        "--lighting",
        "camera",
        "--surface-shader",
        PN,
    ]);
    let picture = folder.path("split.png");
    let split = ["--split", "0.5", "--split-left", "pn-aen", "--size", "160x120", "--stats", "-"];
    let cube = ["render", "shape:cube-split", "-o", &picture, "--surface-shader", PN];
    let (stats, _) = both(&[&cube[..], &split, &SIMPLE_LIGHT].concat());
    let stats: Value = serde_json::from_str(&stats).expect("JSON");
    assert_eq!(
        (number(&stats, "/cracks/edges"), number(&stats, "/left/cracks/edges")),
        (12.0, 0.0),
        "the left half is ours"
    );
    assert!(number(&stats, "/left/max_error_px") > 0.0, "{stats}");
}

#[test]
fn control_points_that_are_no_numbers_are_a_warning() {
    let folder = Folder::new();
    let nan = "edge.a + vec3<f32>(select(0.0, sqrt(-dot(edge.normal_a, edge.normal_a)), triangle.index == 5u))";
    let shader = write(&folder, "nan.wgsl", nan, "edge.b");
    let picture = folder.path("out.png");
    let (_, said) = both(&[
        "render",
        "shape:torus",
        "--factor",
        "4",
        "-o",
        &picture,
        "--size",
        "64x48",
        "--surface-shader",
        &shader,
    ]);
    assert!(
        said.contains("warning: ") && said.contains("3 sides got control points of the surface shader that are"),
        "{said}"
    );
}

#[test]
fn files_that_cannot_be_used_are_refused_with_their_line() {
    let folder = Folder::new();
    let picture = folder.path("out.png");
    let refused = |shader: &str, words: &[&str]| {
        sentence(&["render", "shape:cube-split", "-o", &picture, "--surface-shader", shader], words);
        assert!(!std::path::Path::new(&picture).exists());
    };
    refused(&write(&folder, "bad.wgsl", "\n\nnothing", "edge.b"), &["bad.wgsl, line 3: ", "nothing"]);
    refused(&folder.path("none.wgsl"), &["none.wgsl can't be read", "check its path"]);
    let of_lod = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/lod/distance.wgsl");
    refused(of_lod, &["distance.wgsl, line "]);
    let none = folder.write("empty.wgsl", "// nothing");
    refused(&none, &["empty.wgsl, line 1: there is no function edge_points"]);
    let endless = folder.path("endless.wgsl");
    let spin = "fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints {\n\
                var p = edge.a; loop { p += edge.b; } return EdgePoints(p, p); }";
    std::fs::write(&endless, spin).expect("a writable folder");
    refused(&endless, &["the loops of the surface shader took too long", "bound the loops more tightly"]);
}

#[test]
fn what_cannot_be_combined_is_named() {
    let folder = Folder::new();
    let [picture, mesh] = ["out.png", "out.obj"].map(|name| folder.path(name));
    let render = |more: &[&str]| {
        failure(&[&["render", "shape:cube-split", "-o", &picture, "--surface-shader", PN], more].concat(), 2)
    };
    assert!(render(&["--surface", "pn"]).contains("cannot be used with"));
    assert!(render(&["--alpha", "0.5"]).contains("--alpha needs"));
    assert!(render(&["--fail-on", "above-tolerance"]).contains("--fail-on above-tolerance measures on the CPU"));
    assert!(render(&["--overlay", "deviation"]).contains("name another one with --reference-surface"));
    let cpu = ["tessellate", "shape:cube-split", "-o", &mesh, "--surface-shader", PN, "--device", "cpu"];
    assert!(failure(&cpu, 2).contains("--surface-shader runs on the graphics adapter"));
    let exported = ["shaders", "--language", "hlsl", "-o", &folder.path("out"), "--surface-shader", PN];
    assert!(failure(&exported, 2).contains("--surface-shader can't be exported"));
    // It isn't overwritten.
    let own = write(&folder, "own.obj", "edge.a", "edge.b");
    let onto = ["tessellate", "shape:cube-split", "-o", &own, "--surface-shader", &own];
    assert!(failure(&onto, 1).contains("is read by the same command"));
    // A reference surface that is known does without the CPU's.
    let compared = ["--overlay", "deviation", "--reference-surface", "shape:icosphere", "--size", "64x48"];
    both(&[&["render", "shape:icosahedron", "-o", &picture, "--surface-shader", PN_AEN], &compared[..]].concat());
}
