//! Gates: `--fail-on` and `--evidence` of `render`, `tessellate` and `stability`.

use std::path::Path;

use serde_json::Value;

use crate::{Folder, assert_says, failure, number, output, run, simple, vase, write_corners};

const VIEW: [&str; 4] = ["--size", "160x120", "--lighting", "camera"];

/// Draws a mesh with gates, [simply](simple). Returns the exit code, standard error, and the gates of the stats.
fn drawn(arguments: &[&str]) -> (Option<i32>, String, Vec<Value>) {
    let folder = Folder::new();
    let [picture, stats] = ["out.png", "stats.json"].map(|name| folder.path(name));
    let arguments = [arguments, &VIEW[..]].concat();
    let usual = ["-o", &picture, "--stats", &stats, "--measure-error", "false"];
    let ran = run(&[&["render"], &arguments[..], &simple(&arguments)[..], &usual].concat());
    assert!(Path::new(&picture).exists(), "the picture is written whatever gates say");
    let stats: Value = serde_json::from_slice(&std::fs::read(&stats).expect("stats")).expect("JSON");
    let gates = stats["gates"].as_array().expect("an array").clone();
    (ran.status.code(), String::from_utf8_lossy(&ran.stderr).into_owned(), gates)
}

/// Writes a mesh of three triangles: a square's half, and beside its long edge two that meet in its middle. `extra` is appended.
fn write_junction(folder: &Folder, extra: &str) -> String {
    let path = folder.path("junction.obj");
    let text = "v 0 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 0.5 0.5 0\nf 1 2 3\nf 1 4 5\nf 5 4 2\n";
    std::fs::write(&path, format!("{text}{extra}")).expect("a writable folder");
    path
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

/// Writes an OBJ file of these corners and faces.
fn write_obj(folder: &Folder, name: &str, text: &str) -> String {
    let path = folder.path(name);
    std::fs::write(&path, text).expect("a writable folder");
    path
}

#[test]
fn a_mesh_is_judged_by_what_decides_how_it_tessellates() {
    let folder = Folder::new();
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\n";
    let gap = "v 1 0 0.00005\nv 0 1 0.00005\n";
    let turned = "vn 0 0 1\nvn 0 0 -1\nf 1//1 2//1 3//2\n";
    let cases = [
        ("non-manifold", "f 1 2 3\nf 1 3 4\nf 1 3 5\n", "1 edge has three triangles or more"),
        ("boundary", "f 1 2 3\nf 1 3 4\n", "4 edges are open"),
        ("winding", "f 1 2 3\nf 1 4 3\n", "1 edge has triangles wound opposite ways"),
        ("normals-against-faces", turned, "1 triangle has a normal that points behind it"),
        ("degenerate", "f 1 2 3\nf 1 3 3\n", "1 triangle has no area"),
        ("duplicates", "f 1 2 3\nf 2 3 1\n", "1 triangle repeats another one"),
        ("near-seam", &format!("{gap}f 1 2 4\nf 6 3 7\n"), "2 open edges nearly meet another one"),
        (
            "hard-edges",
            "vn 0 0 1\nvn 0 0.5 1\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n",
            "1 edge has two normals at an end",
        ),
    ];
    for (gate, faces, words) in cases {
        let mesh = write_obj(&folder, &format!("{gate}.obj"), &format!("{square}{faces}"));
        let evidence = folder.path(gate);
        let (code, said, gates) = drawn(&[&mesh, "--fail-on", gate, "--evidence", &evidence]);
        assert_eq!(code, Some(1), "{gate}: {said}");
        assert_says(&said, &[words, "where 0 are allowed", "the longest is"]);
        let is_picture =
            |entry: std::io::Result<std::fs::DirEntry>| entry.expect("an entry").path().extension().is_some();
        assert!(std::fs::read_dir(&evidence).expect("a picture of the place").any(is_picture));
        assert_eq!(gates[0]["passed"], false);
    }
}

#[test]
fn boxes_with_smooth_normals_are_inflated_and_round_meshes_are_not() {
    let (code, said, gates) = drawn(&["shape:cube-smooth", "--fail-on", "inflated"]);
    assert_eq!(code, Some(1));
    assert_says(
        &said,
        &["12 triangles are blown up at hard edges", "where 0 are allowed", "most, by 0.1", "rises triangle"],
    );
    assert_eq!(number(&gates[0], "/found"), 12.0);
    let glass = Path::new(vase()).with_file_name("glass.glb").display().to_string();
    for round in ["shape:icosahedron", "shape:torus", "shape:vase", "shape:cylinder", vase(), &glass] {
        assert_eq!(drawn(&[round, "--fail-on", "inflated"]).0, Some(0), "{round}");
    }
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

/// Writes a triangle whose normals lean outwards, so that its patch bulges, and one above it that the bulge goes through.
fn write_bulge(folder: &Folder) -> String {
    let low = [[0.0, 0.0, 0.0], [0.5, 0.0, -0.9], [1.0, 0.0, 0.0]];
    let middle = [0.5, 0.0, -0.3];
    let leaning = low.map(|corner: [f32; 3]| [corner[0] - middle[0], 0.5, corner[2] - middle[2]]);
    let high = low.map(|corner| [0, 1, 2].map(|i| middle[i] + 0.8 * (corner[i] - middle[i]) + [0.0, 0.1, 0.0][i]));
    let corners = [0, 1, 2].map(|k| (low[k], leaning[k]));
    write_corners(folder, &[corners, high.map(|corner| (corner, [0.0, 1.0, 0.0]))].concat())
}

#[test]
fn patches_that_curve_through_each_other_are_counted_on_both_devices() {
    let folder = Folder::new();
    let bulge = write_bulge(&folder);
    let curved = ["--surface", "pn", "--factor", "9", "--fail-on", "self-intersections"];
    let (code, said, gates) = drawn(&[&[&bulge[..]], &curved[..]].concat());
    assert_eq!(code, Some(1), "{said}");
    assert_says(&said, &["1 pair of patches crosses each other", "between those of triangles 0 and 1"]);
    assert_eq!(number(&gates[0], "/found"), 1.0);
    let glb = folder.path("out.glb");
    let on_cpu = [&["tessellate", &bulge[..], "-o", &glb, "--device", "cpu"], &curved[..]].concat();
    assert!(failure(&on_cpu, 1).contains("1 pair of patches crosses each other"));
    // The triangles themselves don't cross.
    assert_eq!(drawn(&[&bulge, "--surface", "flat", "--factor", "9", "--fail-on", "self-intersections"]).0, Some(0));
}

#[test]
fn deviation_passes_if_the_upper_end_does_and_fails_if_the_lower_end_does() {
    let sphere = ["shape:icosahedron", "--surface", "flat", "--factor", "1"];
    let exact = ["--reference-surface", "shape:icosahedron"];
    let judged = |options: &[&str]| drawn(&[&sphere[..], options].concat());
    // The largest distance is 0.2053 object units of 3.46.
    for (limit, code) in [("0.21", 0), ("0.2", 1), ("210mm", 0), ("20cm", 1), ("6%", 0), ("5.9%", 1), ("0", 1)] {
        let (found, said, gates) = judged(&[&exact[..], &["--fail-on", &format!("deviation:{limit}")]].concat());
        assert_eq!(found, Some(code), "{limit}: {said}");
        let [least, most] = ["at_least", "at_most"].map(|end| number(&gates[0], &format!("/found/{end}")));
        assert!(least <= 0.205_346 && (0.205_345..0.21).contains(&most), "{limit}: {gates:?}");
        assert_eq!(gates[0]["limit"], limit);
    }
    let (code, said, _) = judged(&["--fail-on", "deviation:1"]);
    assert_eq!(code, Some(1));
    assert_says(&said, &["without a reference surface", "--reference-surface"]);
    let culled = ["--cull-back-faces", "--fail-on", "deviation:1"];
    let (code, said, _) = judged(&[&exact[..], &culled[..]].concat());
    assert_eq!(code, Some(1));
    assert_says(&said, &["patches are left out", "without clipping and culling"]);
    failure(&["render", "shape:torus", "-o", "x.png", "--fail-on", "deviation"], 2);
    let tessellate = ["tessellate", "shape:torus", "-o", "x.glb", "--fail-on", "deviation:1"];
    assert!(failure(&tessellate, 2).contains("which render and check take"));
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

/// Writes a torus without one of its triangles.
fn write_missing(folder: &Folder) -> String {
    let path = folder.path("missing.obj");
    let options = ["--surface", "flat", "--factor", "1", "--partitioning", "integer", "--device", "cpu"];
    output(&[&["tessellate", "shape:torus", "-o", &path], &options[..]].concat());
    let whole = std::fs::read_to_string(&path).expect("a mesh");
    let last = whole.rfind("\nf ").expect("a face");
    std::fs::write(&path, &whole[..=last]).expect("a writable folder");
    path
}

#[test]
fn a_gate_that_cannot_be_judged_fails_and_says_why() {
    let folder = Folder::new();
    let mesh = write_missing(&folder);
    let why = "missing.obj fails the gate leaks: leaks can be counted only in a closed mesh, and this one is open: leave this gate \
               out for it";
    let (code, said, gates) = drawn(&[&mesh, "--fail-on", "leaks,folds"]);
    assert_eq!((code, said.lines().count()), (Some(1), 1), "{said}");
    assert!(said.contains(why), "{said}");
    assert_eq!((&gates[0]["passed"], &gates[0]["found"]), (&false.into(), &Value::Null));
    assert_eq!((&gates[1]["passed"], &gates[1]["found"]), (&true.into(), &0.into()));
    let stability = ["stability", &mesh, "--method", "pn", "--method", "flat", "--device", "gpu", "--cameras", "1"];
    let said = failure(&[&stability[..], &["--fail-on", "leaks,cracks"]].concat(), 1);
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains(why), "{said}");
    output(&[&stability[..], &["--fail-on", "cracks"]].concat());
    // The eye is inside the mesh, and another view would do.
    let (code, said, gates) = drawn(&["shape:torus", "--camera", "0,0,0.01", "--fail-on", "leaks"]);
    assert_eq!((code, &gates[0]["passed"], &gates[0]["found"]), (Some(1), &false.into(), &Value::Null));
    assert!(said.contains("move the camera away"), "{said}");
}

#[test]
fn leaks_of_a_mesh_that_is_closed_and_wound_both_ways_are_not_those_of_an_open_one() {
    let folder = Folder::new();
    // A tetrahedron whose last face is wound the other way.
    let path = folder.write("both.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 4 3\n");
    assert!(output(&["info", &path]).contains("surface       closed, wound both ways"));
    let (code, said, _) = drawn(&[&path, "--fail-on", "leaks"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("wound the same way") && !said.contains("open"), "{said}");
}

#[test]
fn a_patch_that_its_factors_leave_out_beside_one_that_is_drawn_is_a_crack() {
    let folder = Folder::new();
    let factors = folder.path("factors.csv");
    // A square of two triangles, with the diagonal as the edge of factor 0 of the first.
    let square = folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
    let judged = |second: &str, gates: &str| {
        std::fs::write(&factors, format!("patch,e0,e1,e2,inside\n0,3,3,3,3\n1,{second},3\n"))
            .expect("a writable folder");
        drawn(&[&square, "--factors", &factors, "--fail-on", gates])
    };
    let gates = "cracks,factors,folds";
    assert_eq!(judged("3,3,3", gates).0, Some(0));
    for discarding in ["nan", "0", "-1"] {
        // The edge of factor 2 is the diagonal, that of factor 0 is on the border.
        let (code, said, found) = judged(&format!("{discarding},3,3"), gates);
        assert_eq!(code, Some(1), "{said}");
        let words = [
            "1 edge is cracked",
            "the widest gap, 0.707 object units, is between triangles 0 and 1",
            "where the factors of triangle 1 leave it out",
        ];
        assert!(words.iter().all(|words| said.contains(words)), "{said}");
        assert_eq!((&found[0]["found"], &found[1]["found"], &found[2]["found"]), (&1.into(), &0.into(), &0.into()));
        let (_, said, found) = judged(&format!("3,3,{discarding}"), gates);
        assert_eq!((&found[0]["found"], &found[1]["found"], &found[2]["found"]), (&1.into(), &1.into(), &0.into()));
        assert!(said.contains("the factors differ most"), "{said}");
    }
    assert_eq!(judged("nan,3,3", "cracks:1").0, Some(0));
}

#[test]
fn leaks_are_judged_with_backs_left_out() {
    let torn = ["shape:cube-split", "--surface", "pn", "--fail-on", "leaks"];
    let (_, _, whole) = drawn(&torn);
    let (code, _, culled) = drawn(&[&torn[..], &["--cull-back-faces"]].concat());
    assert_eq!((code, number(&culled[0], "/found")), (Some(1), number(&whole[0], "/found")));
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
            let stats: Value = serde_json::from_slice(&std::fs::read(&stats).expect("stats")).expect("JSON");
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
fn evidence_shows_the_worst_places() {
    let folder = Folder::new();
    let [picture, evidence] = ["cube.png", "evidence"].map(|name| folder.path(name));
    let cube = ["render", "shape:cube-split", "--surface", "pn", "--factor", "8"];
    let base = [&cube[..], &["-o", &picture, "--evidence", &evidence]].concat();
    output(&[&base[..], &VIEW, &["--fail-on", "folds"]].concat());
    assert!(!Path::new(&evidence).exists(), "nothing failed");
    failure(&[&base[..], &VIEW, &["--fail-on", "cracks,leaks,folds,triangles:1"]].concat(), 1);
    let mut names: Vec<_> =
        std::fs::read_dir(&evidence).expect("a folder").map(|entry| entry.expect("a file")).collect();
    names.sort_by_key(std::fs::DirEntry::file_name);
    let names: Vec<_> = names.iter().map(|entry| entry.file_name().into_string().expect("UTF-8")).collect();
    assert_eq!(names, ["cube-cracks.png", "cube-leaks.png"]);
    assert_eq!(red(Path::new(&picture)), 0);
    for name in names {
        let shown = Path::new(&evidence).join(&name);
        assert_eq!(image::image_dimensions(&shown).expect("a PNG file"), (160, 120));
        assert!(red(&shown) > 40, "{name} has {} red px", red(&shown));
    }
    let written = std::fs::read(folder.path("cube.png")).expect("a file");
    let blocked = ["--fail-on", "cracks", "--evidence", &folder.path("cube.png")];
    let said = failure(&[&cube[..], &["-o", &folder.path("b.png")], &VIEW, &blocked].concat(), 1);
    assert!(said.contains("cube.png") && said.contains("could not be made"), "{said}");
    assert_eq!(std::fs::read(folder.path("cube.png")).expect("a file"), written);
}

/// Writes a cube around the origin that is smooth but for one corner, at the back to the lower left as the default camera sees it:
/// there one face has a normal of its own, so that two edges tear. With `shell`, a larger cube without tears is around it.
fn write_torn_at_the_back(folder: &Folder, shell: bool) -> String {
    let corner = |index: usize| [4, 2, 1].map(|bit| if index & bit == 0 { -1.0 } else { 1.0 });
    let faces = [[1, 3, 2, 0], [4, 6, 7, 5], [0, 4, 5, 1], [3, 7, 6, 2], [2, 6, 4, 0], [1, 5, 7, 3]];
    let mut text = String::from("vn 0 0 -1\n");
    for (cube, scale) in [1.0, 1.4].into_iter().enumerate().take(1 + usize::from(shell)) {
        for index in 0..8 {
            let [x, y, z] = corner(index);
            text += &format!("v {} {} {}\nvn {x} {y} {z}\n", x * scale, y * scale, z * scale);
        }
        for (number, face) in faces.into_iter().enumerate() {
            let is_torn = |index: usize| cube == 0 && number == 4 && index == 0;
            let vertex = |index: usize| 8 * cube + index + 1;
            let normal = |index: usize| if is_torn(index) { 1 } else { vertex(index) + 1 };
            let corners = face.map(|index| format!(" {}//{}", vertex(index), normal(index)));
            text += &format!("f{}\n", corners.concat());
        }
    }
    let path = folder.path(if shell { "shell.obj" } else { "back.obj" });
    std::fs::write(&path, text).expect("a writable folder");
    path
}

/// How many px of a picture have the colour of cracks that nothing hides: see src/render/layout.rs.
fn red(path: &Path) -> usize {
    let picture = image::open(path).expect("a PNG file").to_rgba8();
    picture.pixels().filter(|pixel| pixel.0[0] > 200 && pixel.0[1] < 90 && pixel.0[2] < 90).count()
}

#[test]
fn evidence_is_seen_from_where_nothing_hides_it() {
    let folder = Folder::new();
    for (shell, views) in [(false, [&[][..], &["--orthographic"]]), (true, [&[][..], &["--orthographic"]])] {
        let mesh = write_torn_at_the_back(&folder, shell);
        for view in views {
            let [picture, evidence, stats] = ["it.png", "evidence", "stats.json"].map(|name| folder.path(name));
            let base = ["render", &mesh, "--surface", "pn", "--factor", "8", "-o", &picture, "--stats", &stats];
            let base = [&base[..], &["--measure-error", "false"]].concat();
            let gates = ["--fail-on", "leaks,cracks", "--evidence", &evidence];
            let said = failure(&[&base[..], &VIEW, &gates, view].concat(), 1);
            assert_eq!(red(Path::new(&picture)), 0);
            for name in ["it-leaks.png", "it-cracks.png"] {
                let marked = red(&Path::new(&evidence).join(name));
                assert!(marked > 60, "{name} of {mesh} with {view:?} has {marked} red px");
            }
            let stats: Value = serde_json::from_slice(&std::fs::read(&stats).expect("stats")).expect("JSON");
            let leak = stats.pointer("/gates/0/where").expect("a place");
            let [x, y, z] = [0, 1, 2].map(|axis| number(leak, &format!("/at/{axis}")));
            assert!(z < -0.8 && (x < -0.8 || y < -0.8), "on one of the two torn edges: {leak}");
            assert!(leak["px"].is_array() && leak["triangles"].as_array().is_some_and(|all| all.len() == 2), "{leak}");
            assert!(said.contains(" px of the picture, between triangles "), "{said}");
            std::fs::remove_dir_all(&evidence).expect("a folder");
        }
    }
}

#[test]
fn evidence_of_a_fold_that_is_a_needle_shows_it() {
    let folder = Folder::new();
    let [mesh, picture, evidence] = ["needle.obj", "it.png", "evidence"].map(|name| folder.path(name));
    // The rounded edge of a plate's corner, of which all that is emitted is turned over.
    let needle = "v -0.0952 0.00003 0.1966\nv -0.1396 0.0001 0.2\nv -0.1589 0.0001 0.2\n\
                  vn 0.0003 -0.9999 0.0118\nvn 0.0002 -0.2872 0.9579\nvn -0.7175 -0.2665 0.6436\n";
    let back = "v -0.16 0 -0.2\nv 0.16 0 -0.2\nv 0.16 0.08 -0.2\nvn 0 0 -1\n";
    std::fs::write(&mesh, format!("{needle}{back}f 1//1 2//2 3//3\nf 4//4 6//4 5//4\n")).expect("a writable folder");
    failure(
        &[&["render", &mesh, "-o", &picture, "--fail-on", "folds", "--evidence", &evidence], &VIEW[..]].concat(),
        1,
    );
    let shown = Path::new(&evidence).join("it-folds.png");
    let picture = image::open(&shown).expect("a PNG file").into_rgb8();
    let of_fold = |pixel: &&image::Rgb<u8>| pixel[0].abs_diff(189) < 20 && pixel[1] < 90 && pixel[2] > 230;
    let folded = picture.pixels().filter(of_fold).count();
    assert!(folded > 60, "{folded} px are of a fold");
}

#[test]
fn evidence_of_an_engines_frame_comes_closer_too_and_px_are_those_of_its_picture() {
    let folder = Folder::new();
    let mesh = write_torn_at_the_back(&folder, false);
    let [picture, evidence, stats] = ["it.png", "evidence", "stats.json"].map(|name| folder.path(name));
    let base = ["render", &mesh, "--surface", "pn", "--factor", "8", "-o", &picture, "--stats", &stats];
    let base = [&base[..], &["--measure-error", "false"]].concat();
    // From behind, where the leak isn't hidden.
    let judged = |camera: &[&str]| {
        let gates = ["--fail-on", "leaks", "--evidence", &evidence];
        failure(&[&base[..], &VIEW, &gates, camera].concat(), 1);
        let stats: Value = serde_json::from_slice(&std::fs::read(&stats).expect("stats")).expect("JSON");
        let [x, y] = [0, 1].map(|axis| number(&stats, &format!("/gates/0/where/px/{axis}")));
        (x, y, red(&Path::new(&evidence).join("it-leaks.png")), stats)
    };
    let (x, y, marked, stats) = judged(&["--camera", "225,-30,4"]);
    let matrix = stats.pointer("/camera/view_projection").and_then(Value::as_array).expect("a matrix");
    let matrix: Vec<f64> = matrix.iter().map(|number| number.as_f64().expect("a number")).collect();
    let with = |mirror: f64| {
        let entry = |i: usize| (matrix[i] * if i.is_multiple_of(4) { mirror } else { 1.0 }).to_string();
        let matrix = (0..16).map(entry).collect::<Vec<_>>().join(" ");
        judged(&["--depth", "reversed", "--view-projection", &matrix])
    };
    let (same_x, same_y, same_marked, _) = with(1.0);
    assert_eq!((same_x, same_y), (x, y));
    assert!(marked > 60 && same_marked.abs_diff(marked) < 20, "{same_marked} red px, and {marked} with our own camera");
    let (mirrored_x, mirrored_y, mirrored_marked, _) = with(-1.0);
    assert!(
        (160.0 - mirrored_x - x).abs() <= 1.0 && (mirrored_y - y).abs() <= 1.0,
        "{mirrored_x} {mirrored_y}, {x} {y}"
    );
    assert!(mirrored_marked > 60, "{mirrored_marked} red px");
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
fn stability_draws_the_worst_places() {
    let folder = Folder::new();
    let evidence = folder.path("evidence");
    let junction = write_junction(&folder, "");
    let base = ["stability", "--device", "gpu", "--cameras", "1", "--evidence", &evidence, "--fail-on"];
    output(&[&base[..], &["cracks", "--case", "split-normals", "--method", "pn-aen"]].concat());
    assert!(!Path::new(&evidence).exists(), "nothing failed");
    failure(&[&base[..], &["cracks,leaks,folds", "--case", "split-normals", "--method", "pn"]].concat(), 1);
    failure(&[&base[..], &["t-junctions,warnings:1", "--method", "flat", &junction]].concat(), 1);
    let names = std::fs::read_dir(&evidence).expect("a folder").map(|entry| entry.expect("a file").file_name());
    let mut names: Vec<_> = names.map(|name| name.into_string().expect("UTF-8")).collect();
    names.sort();
    assert_eq!(names, ["junction-t-junctions.png", "split-normals-cracks.png", "split-normals-leaks.png"]);
    for name in names {
        let shown = image::open(Path::new(&evidence).join(&name)).expect("a PNG file").to_rgba8();
        assert_eq!(shown.dimensions(), (960, 720), "three px for one of those that were measured");
        // Cracks are red and edges with T-junctions yellow, as src/render/layout.rs has them.
        let marked = shown.pixels().filter(|pixel| pixel.0[0] > 200 && pixel.0[2] < 90).count();
        assert!(marked > 200, "{name} has {marked} px of lines");
    }
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
