//! Gates: `--fail-on` and `--evidence` of `render`, `tessellate` and `stability`.

mod cracks_and_leaks;
mod evidence;
mod meshes;

use std::path::Path;

use serde_json::Value;

use crate::{Folder, assert_says, failure, number, output, run, simple, write_corners};

const VIEW: [&str; 4] = ["--size", "160x120", "--lighting", "camera"];

/// The stats that a command has written.
fn written(stats: &str) -> Value {
    serde_json::from_slice(&std::fs::read(stats).expect("stats")).expect("JSON")
}

/// Draws a mesh with gates, [simply](simple). Returns the exit code, standard error, and the gates of the stats.
fn drawn(arguments: &[&str]) -> (Option<i32>, String, Vec<Value>) {
    let folder = Folder::new();
    let [picture, stats] = ["out.png", "stats.json"].map(|name| folder.path(name));
    let arguments = [arguments, &VIEW[..]].concat();
    let usual = ["-o", &picture, "--stats", &stats, "--measure-error", "false"];
    let ran = run(&[&["render"], &arguments[..], &simple(&arguments)[..], &usual].concat());
    assert!(Path::new(&picture).exists(), "the picture is written whatever gates say");
    let gates = written(&stats)["gates"].as_array().expect("an array").clone();
    (ran.status.code(), String::from_utf8_lossy(&ran.stderr).into_owned(), gates)
}

/// Writes a mesh of three triangles: a square's half, and beside its long edge two that meet in its middle. `extra` is appended.
fn write_junction(folder: &Folder, extra: &str) -> String {
    let text = "v 0 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 0.5 0.5 0\nf 1 2 3\nf 1 4 5\nf 5 4 2\n";
    folder.write("junction.obj", format!("{text}{extra}"))
}

/// Writes a triangle whose normals lean so that its patch turns over.
fn write_folds(folder: &Folder) -> String {
    let positions = [[0.0, 0.0, 0.0], [0.28, 0.0, 0.2], [1.0, 0.0, 0.0]];
    let leaning = [[0.0, 1.0, 0.0], [-0.77, 0.32, -0.56], [0.84, 0.28, 0.45]];
    write_corners(folder, &[0, 1, 2].map(|k| (positions[k], leaning[k])))
}

#[test]
fn a_sound_mesh_passes_all_gates() {
    let gates = "cracks,factors,leaks,folds,t-junctions,warnings,above-tolerance,triangles:100000,bytes:4000000,\
                 non-manifold,boundary,winding,normals-against-faces,degenerate,duplicates,near-seam,hard-edges,inflated,\
                 self-intersections,deviation:2%,pops:1px";
    let torus = ["shape:torus", "--reference-surface", "shape:torus", "--lod", "error", "--tolerance", "0.5"];
    let (code, said, gates) = drawn(&[&torus[..], &["--fail-on", gates]].concat());
    assert_eq!((code, said.as_str()), (Some(0), ""));
    assert_eq!(gates.len(), 21);
    for gate in &gates {
        assert_eq!((&gate["passed"], &gate["where"]), (&true.into(), &Value::Null), "{gate}");
    }
    let found = |index: usize| number(&gates[index], "/found");
    assert_eq!(number(&gates[7], "/limit"), 100_000.0);
    // A vertex takes 32 bytes, and a triangle 12. A closed mesh has at least half as many vertices as triangles.
    assert!(found(8) > found(7) * 28.0, "{gates:?}");
}

#[test]
fn the_farthest_jump_of_a_flight_is_held_to_a_limit() {
    let flown = |options: &[&str], limit: &str| {
        drawn(&[&["shape:cube-smooth", "--fail-on", &format!("pops:{limit}")], options].concat())
    };
    let by_length = ["--lod", "edge-length", "--pixels", "8", "--partitioning"];
    let px = |partitioning: &str| {
        let (code, said, gates) = flown(&[&by_length[..], &[partitioning]].concat(), "0px");
        assert_eq!(code, Some(1), "{partitioning}: {said}");
        assert_says(
            &said,
            &["px from one frame of the flight to the next, where 0px is allowed", "jump is of triangle"],
        );
        number(&gates[0], "/found")
    };
    let (integer, fractional) = (px("integer"), px("fractional-even"));
    assert!(fractional < 0.5 * integer, "{fractional} and {integer}");
    let (code, said, gates) = flown(&[&by_length[..], &["fractional-even"]].concat(), &format!("{integer}px"));
    assert_eq!((code, &gates[0]["passed"]), (Some(0), &true.into()), "{said}");
    assert_eq!(gates[0]["limit"], format!("{integer}px"));
    let (code, _, gates) = flown(&["--factor", "5"], "0px");
    assert_eq!((code, number(&gates[0], "/found")), (Some(0), 0.0), "nothing moves");
    let refused = |command: &[&str]| failure(&[command, &["shape:torus", "--fail-on", "pops:1px"]].concat(), 2);
    assert!(refused(&["render", "-o", "x.png", "--lod-camera", "0,0"]).contains("flies the camera"));
    assert!(refused(&["tessellate", "-o", "x.glb", "--device", "cpu"]).contains("--fail-on pops"));
    assert!(refused(&["stability"]).contains("pops"));
    failure(&["render", "shape:torus", "-o", "x.png", "--fail-on", "pops:1"], 2);
}

#[test]
fn every_gate_fails_on_what_it_is_about() {
    let folder = Folder::new();
    let (junction, folds) = (write_junction(&folder, ""), write_folds(&folder));
    let published = ["--edges", "as-published", "--lod", "paper", "--pixels", "4"];
    let torn = ["shape:cube-split", "--surface", "pn"];
    let cases: [(&str, &[&str], &[&str]); 9] = [
        (
            "cracks",
            &torn,
            &["12 edges are cracked, where 0 are allowed", "the widest gap", "object units", "between triangles"],
        ),
        ("cracks:11", &torn, &["12 edges are cracked, where 11 are allowed"]),
        ("leaks", &torn, &["px show the inside of the mesh", "the largest leak", "px of the picture"]),
        ("factors", &[&["shape:torus"], &published[..]].concat(), &["sides with different factors", "differ most"]),
        ("folds", &[&folds], &["folded", "triangle 0"]),
        ("t-junctions", &[&junction], &["1 T-junction", "(0.500, 0.500, 0)", "beside the edge of triangle 0"]),
        (
            "above-tolerance",
            &["shape:torus", "--factor", "1"],
            &["farther than 0.25 px", "the farthest", "of triangle"],
        ),
        ("triangles:100", &["shape:torus"], &["triangles are emitted, where 100 are allowed"]),
        ("bytes:100", &["shape:torus"], &["vertices and indices take", "bytes, where 100 are allowed"]),
    ];
    for (gate, arguments, words) in cases {
        let (code, said, gates) = drawn(&[arguments, &["--fail-on", gate]].concat());
        assert_eq!(code, Some(1), "{gate}: {said}");
        let name = gate.split(':').next().expect("a name");
        let line = said.lines().find(|line| line.contains(&format!("fails the gate {name}: ")));
        let line = line.unwrap_or_else(|| panic!("{gate}: {said}"));
        for word in words {
            assert!(line.contains(word), "{word:?} is not in {line}");
        }
        assert_eq!(gates.len(), 1);
        assert_eq!((&gates[0]["name"], &gates[0]["passed"]), (&name.into(), &false.into()));
        assert!(number(&gates[0], "/found") > number(&gates[0], "/limit"), "{gates:?}");
        let has_place = !matches!(name, "triangles" | "bytes");
        assert_eq!(gates[0]["where"]["text"].is_string(), has_place, "{gates:?}");
    }
}

#[test]
fn warnings_of_loading_fail_their_gate_with_the_first_one() {
    let folder = Folder::new();
    let odd = write_junction(&folder, "f 1 2 99\n");
    let (code, said, gates) = drawn(&[&odd, "--fail-on", "warnings,cracks"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.contains("fails the gate warnings: loading gave 2 warnings (the first: faces without normals"),
        "{said}"
    );
    assert_eq!((&gates[0]["passed"], &gates[1]["passed"]), (&false.into(), &true.into()));
    let (code, ..) = drawn(&[&odd, "--fail-on", "warnings:2"]);
    assert_eq!(code, Some(0));
}

#[test]
fn each_failed_gate_is_one_sentence() {
    let gates = "cracks,leaks,folds,triangles:1";
    let (code, said, found) = drawn(&["shape:cube-split", "--surface", "pn", "--fail-on", gates]);
    assert_eq!((code, said.lines().count()), (Some(1), 3), "{said}");
    assert!(said.lines().all(|line| line.starts_with("pnaen: shape:cube-split fails the gate ")), "{said}");
    let passed: Vec<_> = found.iter().map(|gate| gate["passed"].as_bool()).collect();
    assert_eq!(passed, [Some(false), Some(false), Some(true), Some(false)]);
}

#[test]
fn a_raised_tolerance_is_judged_by_the_one_that_was_asked_for() {
    let options = ["shape:torus", "--lod", "error", "--tolerance", "0.1", "--fail-on", "above-tolerance"];
    assert_eq!(drawn(&options).0, Some(0));
    let (code, said, _) = drawn(&[&options[..], &["--max-triangles", "600"]].concat());
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("tolerance raised from 0.1") && said.contains("farther than 0.1 px"), "{said}");
}

#[test]
fn the_tolerance_of_given_factors_is_that_of_the_command() {
    let folder = Folder::new();
    let [csv, shader, stats] = ["factors.csv", "lod.wgsl", "stats.json"].map(|name| folder.path(name));
    output(&["factors", "shape:torus", "--factor", "1", "-o", &csv]);
    std::fs::write(&shader, "fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32 { return 1.0; }")
        .expect("a writable folder");
    for given in [["--factors", &csv], ["--lod-shader", &shader]] {
        let judged = |tolerance: &str| {
            let options = ["--tolerance", tolerance, "--fail-on", "above-tolerance", "-o", &folder.path("x.png")];
            let torus = ["render", "shape:torus", "--stats", &stats, "--measure-error", "false"];
            let ran = run(&[&torus[..], &given[..], &VIEW, &options].concat());
            let stats = written(&stats);
            let said = String::from_utf8_lossy(&ran.stderr).into_owned();
            (ran.status.code(), said, number(&stats, "/settings/tolerance"))
        };
        let (code, said, tolerance) = judged("0.125");
        assert!(code == Some(1) && said.contains("farther than 0.125 px"), "{given:?}: {said}");
        assert_eq!(tolerance, 0.125);
        let (code, said, tolerance) = judged("50");
        assert_eq!((code, tolerance), (Some(0), 50.0), "{given:?}: {said}");
    }
}

#[test]
fn tessellate_is_judged_alike_on_both_devices() {
    let folder = Folder::new();
    let gates = "cracks,factors,folds,t-junctions,above-tolerance,triangles:100,bytes:100";
    let said = ["cpu", "gpu"].map(|device| {
        let out = folder.path(&format!("{device}.glb"));
        let said = failure(
            &[
                &["tessellate", "shape:cube-split", "--surface", "pn", "--factor", "8", "-o", &out][..],
                &["--device", device, "--fail-on", gates],
            ]
            .concat(),
            1,
        );
        assert!(Path::new(&out).exists());
        said
    });
    assert_eq!(said[0], said[1]);
    assert_eq!(said[0].lines().count(), 4, "cracks, above-tolerance, triangles and bytes: {}", said[0]);
    let evidence = folder.path("evidence");
    let out = folder.path("torn.glb");
    let options = ["-o", &out, "--size", "160x120", "--fail-on", "cracks", "--evidence", &evidence];
    failure(&[&["tessellate", "shape:cube-split", "--surface", "pn", "--factor", "8"], &options[..]].concat(), 1);
    assert!(Path::new(&evidence).join("torn-cracks.png").exists());
}

#[test]
fn stability_fails_on_gates_of_the_chosen_methods() {
    let base = ["stability", "--case", "split-normals", "--device", "cpu", "--cameras", "1"];
    output(&base);
    let said = failure(&[&base[..], &["--fail-on", "cracks"]].concat(), 1);
    assert_eq!(said.lines().count(), 1, "{said}");
    let words = [
        "split-normals fails the gate cracks: ",
        "edge points that differ",
        " on cpu, where 0 are allowed",
        "methods fail",
    ];
    assert_says(&said, &words);
    let table = output(&[&base[..], &["--fail-on", "cracks,folds", "--method", "pn-aen", "--method", "flat"]].concat());
    assert!(table.contains("PN-AEN") && !table.contains("Nagata"), "{table}");
    let folder = Folder::new();
    let junction = write_junction(&folder, "");
    let said = failure(&["stability", &junction, "--device", "cpu", "--method", "flat", "--fail-on", "t-junctions"], 1);
    assert!(said.contains("junction.obj fails the gate t-junctions: the mesh has 1 T-junction"), "{said}");
}

#[test]
fn gates_that_cannot_be_judged_are_wrong_usage() {
    let folder = Folder::new();
    let [glb, png] = ["a.glb", "a.png"].map(|name| folder.path(name));
    let render = ["render", "shape:torus", "-o", &png];
    let tessellate = ["tessellate", "shape:torus", "-o", &glb, "--device", "cpu"];
    let cases: [(&[&str], &[&str], &str); 9] = [
        (&render, &["--fail-on", "crack"], "t-junctions"),
        (&render, &["--fail-on", "triangles"], "triangles:100000"),
        (&render, &["--fail-on", "cracks:-1"], "whole number"),
        (&render, &["--evidence", "x"], "--fail-on"),
        (&tessellate, &["--fail-on", "leaks"], "--device gpu"),
        (&tessellate, &["--fail-on", "cracks", "--evidence", "x"], "--device gpu"),
        (&["stability"], &["--fail-on", "triangles:5"], "render or tessellate"),
        (&["stability", "--device", "cpu"], &["--fail-on", "leaks"], "--device gpu"),
        (&["stability", "--device", "cpu"], &["--fail-on", "cracks", "--evidence", "x"], "--device gpu"),
    ];
    for (command, options, word) in cases {
        let said = failure(&[command, options].concat(), 2);
        assert!(said.contains(word), "{word:?} is not in {said}");
    }
    assert!(!Path::new(&png).exists() && !Path::new(&glb).exists());
}
