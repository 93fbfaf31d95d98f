//! `pnaen compare`: tessellated meshes of other programs, as mesh files and as CSV, held against ours.

use std::fmt::Write;

use serde_json::Value;

use crate::{Folder, both, failure, number, output, read_obj, run, sentence, write_corners};

/// Torus with factors that differ from edge to edge.
const VARIED: [&str; 7] = ["--lod", "edge-length", "--pixels", "40", "--size", "640x400", "--partitioning=integer"];

/// Writes what we emit ourselves with these options. Returns the path.
fn emitted(folder: &Folder, name: &str, options: &[&str]) -> String {
    let path = folder.path(name);
    output(&[&["tessellate", "shape:torus", "--device", "cpu", "-o", &path], options].concat());
    path
}

/// Compares with the torus. Returns standard output, whatever the exit code, which must be this one.
fn compared(theirs: &str, options: &[&str], code: i32) -> String {
    let run = run(&[&["compare", theirs, "--mesh", "shape:torus"], options].concat());
    let [said, errors] = [&run.stdout, &run.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    assert_eq!(run.status.code(), Some(code), "{said}\n{errors}");
    said
}

/// A CSV file as a frame debugger writes it: a line for each corner of each triangle, with clip-space positions before ours.
fn csv_of(obj: &str, header: &str, digits: usize) -> String {
    let (positions, faces) = read_obj(obj);
    let mut text = header.to_owned() + "\n";
    for (row, index) in faces.as_flattened().iter().enumerate() {
        let [x, y, z] = positions[*index].map(f32::from_bits);
        writeln!(text, "{row}, {index}, 0.1, 0.2, 0.3, 2.5, {x:.digits$}, {y:.digits$}, {z:.digits$}").expect("a text");
    }
    text
}

const HEADER: &str = "VTX, IDX, gl_Position.x, gl_Position.y, gl_Position.z, gl_Position.w, \
                      outPosition.x, outPosition.y, outPosition.z";

#[test]
fn our_our_exports_are_the_same_in_every_format() {
    let folder = Folder::new();
    for name in ["a.obj", "a.glb"] {
        let theirs = emitted(&folder, name, &VARIED);
        let said = compared(&theirs, &VARIED, 0);
        assert!(said.contains("is the same tessellation of shape:torus as ours."), "{said}");
        assert!(said.contains("256 of 256 patches"), "{said}");
    }
    let csv = folder.path("a.csv");
    for digits in [9, 4] {
        std::fs::write(&csv, csv_of(&folder.path("a.obj"), HEADER, digits)).expect("a writable folder");
        // Few digits allow as much as they leave out.
        compared(&csv, &VARIED, 0);
    }
    compared(&csv, &[&VARIED[..], &["--position-column", "outPosition"]].concat(), 0);
}

#[test]
fn what_the_graphics_card_tessellates_is_the_same_too() {
    let folder = Folder::new();
    let theirs = folder.path("gpu.glb");
    // Its factors have other last bits than ours, which moves points under fractional partitioning.
    let options = [&VARIED[..6], &["--partitioning=fractional-odd"]].concat();
    output(&[&["tessellate", "shape:torus", "--device", "gpu", "-o", &theirs], &options[..]].concat());
    assert!(compared(&theirs, &options, 0).contains("is the same tessellation of shape:torus as ours."));
}

#[test]
fn triangles_whose_corners_lie_in_line_are_no_difference() {
    let folder = Folder::new();
    let (a, b, c, d) = ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.2, 1.0], [0.0, 0.0, 1.0]);
    let middle = [0.5, 0.0, 0.0];
    let [n, m] = [[-0.6, 0.8, 0.0], [0.6, 0.8, 0.0]];
    let corners = [(a, n), (c, m), (b, m), (a, n), (d, n), (c, m), (a, n), (b, m), (middle, [0.0, 1.0, 0.0])];
    let mesh = write_corners(&folder, &corners);
    let said = output(&["info", &mesh]);
    assert!(said.contains("3 (0 degenerate, left out; 1 with their corners in line)"), "{said}");
    let theirs = folder.path("theirs.glb");
    let options = ["--lod", "paper", "--pixels", "12", "--partitioning", "integer", "--size", "640x400"];
    output(&[&["tessellate", &mesh, "--device", "cpu", "-o", &theirs], &options[..]].concat());
    let said = output(&[&["compare", &theirs, "--mesh", &mesh], &options[..]].concat());
    assert!(said.contains("is the same tessellation"), "{said}");
}

#[test]
fn coordinates_in_clip_space_are_named_by_the_matrix_that_is_given() {
    let folder = Folder::new();
    let (positions, faces) = read_obj(&emitted(&folder, "a.obj", &["--factor", "3"]));
    // Looks along -z from 4 units away, 90 degrees wide, from 1 to 10 units.
    let clip = |[x, y, z]: [f32; 3]| {
        let w = 4.0 - z;
        [x / w, y / w, (10.0 * w - 10.0) / 9.0 / w]
    };
    let mut text = String::new();
    for [x, y, z] in positions.iter().map(|position| clip(position.map(f32::from_bits))) {
        writeln!(text, "v {x} {y} {z}").expect("a text");
    }
    for [a, b, c] in faces.iter().map(|face| face.map(|index| index + 1)) {
        writeln!(text, "f {a} {b} {c}").expect("a text");
    }
    let theirs = folder.write("clip.obj", text);
    let depth = (10.0 * 4.0 - 10.0) / 9.0;
    let matrix = format!("1 0 0 0 0 1 0 0 0 0 {} -1 0 0 {depth} 4", -10.0 / 9.0);
    let said = compared(&theirs, &["--factor", "3", "--view-projection", &matrix], 1);
    assert!(
        said.starts_with("Its coordinates are in clip space, by this camera's matrix, and divided by w."),
        "{said}"
    );
    assert_eq!(said.lines().take_while(|line| !line.is_empty()).count(), 1, "{said}");
}

#[test]
fn a_difference_is_said_and_fails() {
    let folder = Folder::new();
    let theirs = emitted(&folder, "a.obj", &[&VARIED[..], &["--convention", "rotated"]].concat());
    let arguments = [&["compare", &theirs, "--mesh", "shape:torus"][..], &VARIED].concat();
    let errors = failure(&arguments, 1);
    assert_eq!(errors.lines().count(), 1, "{errors}");
    assert!(errors.contains("a.obj isn't our tessellation: 2 differences are above"), "{errors}");
    let said = compared(&theirs, &VARIED, 1);
    assert!(said.starts_with("Edges have each other's factors"), "{said}");
    assert!(said.contains("--convention rotated") && said.contains("The 10 sides that differ the most"), "{said}");
    // The option that it names makes it the same.
    compared(&theirs, &[&VARIED[..], &["--convention", "rotated"]].concat(), 0);
}

#[test]
fn json_has_the_findings_and_the_sides() {
    let folder = Folder::new();
    let theirs = emitted(&folder, "a.obj", &["--factor", "6"]);
    let said = compared(&theirs, &["--json", "--factor", "8"], 1);
    let found: Value = serde_json::from_str(&said).expect("JSON");
    assert_eq!((&found["same"], &found["findings"][0]["kind"]), (&Value::Bool(false), &Value::from("factors")));
    assert_eq!(found["sides"][0]["ours"]["segments"], 9);
    assert!((number(&found, "/sides/0/theirs/factor") - 6.0).abs() < 0.01, "{}", found["sides"][0]);
    assert!(number(&found, "/from_surface/ulp") < 16.0);
    let same: Value = serde_json::from_str(&compared(&theirs, &["--json", "--factor", "6"], 0)).expect("JSON");
    assert_eq!((&same["same"], same["findings"].as_array().map(Vec::len)), (&Value::Bool(true), Some(0)));
    assert!(number(&same, "/farthest/distance/ulp") < 1.0);
}

#[test]
fn distances_may_be_larger_if_one_says_so() {
    let folder = Folder::new();
    emitted(&folder, "a.obj", &[]);
    // An OBJ file doesn't say how many digits its numbers have.
    let (positions, faces) = read_obj(&folder.path("a.obj"));
    let mut text = String::new();
    for [x, y, z] in positions.iter().map(|position| position.map(f32::from_bits)) {
        writeln!(text, "v {x:.5} {y:.5} {z:.5}").expect("a text");
    }
    for [a, b, c] in faces.iter().map(|face| face.map(|index| index + 1)) {
        writeln!(text, "f {a} {b} {c}").expect("a text");
    }
    let theirs = folder.write("rounded.obj", text);
    let said = compared(&theirs, &[], 1);
    let within = said.split("--within ").nth(1).and_then(|rest| rest.split_once(".\n")).expect("an option").0;
    compared(&theirs, &["--within", within], 0);
    compared(&theirs, &["--within", "1000ulp"], 0);
}

#[test]
fn a_picture_shows_what_differs() {
    let folder = Folder::new();
    let theirs = emitted(&folder, "a.obj", &[&VARIED[..], &["--convention", "mirrored"]].concat());
    let picture = folder.path("a.png");
    compared(&theirs, &[&VARIED[..], &["-o", &picture]].concat(), 1);
    let drawn = image::open(&picture).expect("a picture").to_rgb8();
    assert_eq!(drawn.dimensions(), (640, 400));
    // The key's block of the colour of sides.
    let orange = drawn.pixels().filter(|pixel| pixel.0 == [255, 150, 30]).count();
    assert!(orange > 60, "{orange} px in the colour of sides that are cut differently");
}

#[test]
fn positions_of_16_bits_are_named_and_may_be_allowed() {
    let folder = Folder::new();
    let options = ["--factor", "5", "--partitioning", "integer"];
    let (positions, faces) = read_obj(&emitted(&folder, "theirs.obj", &options));
    let rounded = |x: f32| {
        let unit = x.abs().max(1.0 / 16384.0).log2().floor().exp2() / 1024.0;
        (x / unit).round() * unit
    };
    let mut text = String::new();
    for position in &positions {
        let [x, y, z] = position.map(|bits| rounded(f32::from_bits(bits)));
        writeln!(text, "v {x} {y} {z}").expect("a text");
    }
    for [a, b, c] in faces.iter().map(|face| face.map(|index| index + 1)) {
        writeln!(text, "f {a} {b} {c}").expect("a text");
    }
    let half = folder.write("half.obj", text);
    let said = compared(&half, &options, 1);
    assert!(said.starts_with("Its coordinates are rounded to 16-bit floating-point numbers"), "{said}");
    let (_, allowed) = said.split_once("--within ").expect("what allows it");
    let (allowed, _) = allowed.split_once(".\n").expect("the sentence's end");
    compared(&half, &[&options[..], &["--within", allowed]].concat(), 0);
}

#[test]
fn files_that_cannot_be_compared_are_refused_with_a_sentence() {
    let folder = Folder::new();
    let write = |name: &str, text: &str| {
        let path = folder.path(name);
        std::fs::write(&path, text).expect("a writable folder");
        path
    };
    let compare = |theirs: &str, words: &[&str]| sentence(&["compare", theirs, "--mesh", "shape:torus"], words);
    compare(&folder.path("none.csv"), &["none.csv", "there is no such file"]);
    compare(&write("empty.csv", ""), &["it has no lines"]);
    compare(
        &write("clip.csv", "VTX, IDX, SV_Position.x, SV_Position.y, SV_Position.z, SV_Position.w\n"),
        &["clip space", "--position-column"],
    );
    compare(&write("none.csv", "VTX, IDX, uv.x, uv.y\n0,0,0,0\n"), &["none of its columns are positions"]);
    compare(&write("text.csv", "x,y,z\n0,0,a\n"), &["line 2: z is \"a\""]);
    compare(&write("header.csv", "x,y,z\n"), &["has no triangles to compare"]);
    compare(&write("theirs.obj", "v 0 0 0\n"), &["theirs.obj", "no triangles"]);
    let usage = failure(&["compare", &folder.path("a.obj"), "--mesh", "shape:torus", "--position-column", "P"], 2);
    assert!(usage.contains("--position-column names a column of a .csv file"), "{usage}");
    let usage = failure(&["compare", &folder.path("a.obj"), "--mesh", "shape:torus", "--within", "-1"], 2);
    assert!(usage.contains("expected a distance"), "{usage}");
    failure(&["compare", &folder.path("a.obj")], 2);
    let theirs = emitted(&folder, "sound.obj", &[]);
    std::fs::create_dir(folder.path("folder")).expect("a writable folder");
    let drawn = ["compare", &theirs, "--mesh", "shape:torus", "-o", &folder.path("folder")];
    sentence(&drawn, &["folder", "it is a folder; name a file"]);
}

#[test]
fn normals_that_theirs_lacks_are_not_worth_a_word_and_other_repairs_are() {
    let folder = Folder::new();
    let theirs = emitted(&folder, "a.obj", &[]);
    let (positions, faces) = read_obj(&theirs);
    let vertices: Vec<_> = positions.iter().map(|position| position.map(f32::from_bits)).collect();
    let mut obj = String::new();
    vertices.iter().for_each(|[x, y, z]| writeln!(obj, "v {x} {y} {z}").expect("a text"));
    faces.iter().map(|face| face.map(|index| index + 1)).for_each(|[a, b, c]| {
        writeln!(obj, "f {a} {b} {c}").expect("a text");
    });
    let mut ply = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        vertices.len(),
        faces.len()
    );
    let mut off = format!("OFF\n{} {} 0\n", vertices.len(), faces.len());
    for text in [&mut ply, &mut off] {
        vertices.iter().for_each(|[x, y, z]| writeln!(text, "{x} {y} {z}").expect("a text"));
        faces.iter().for_each(|[a, b, c]| writeln!(text, "3 {a} {b} {c}").expect("a text"));
    }
    for (name, text) in [("bare.obj", &obj), ("bare.ply", &ply), ("bare.off", &off)] {
        let theirs = folder.path(name);
        std::fs::write(&theirs, text).expect("a writable folder");
        let (said, errors) = both(&["compare", &theirs, "--mesh", "shape:torus"]);
        assert!(said.contains("is the same tessellation") && errors.is_empty(), "{name}: {errors}");
    }
    let repaired = folder.write("repaired.obj", obj + "p 1\n");
    let (_, errors) = both(&["compare", &repaired, "--mesh", "shape:torus"]);
    assert_eq!(errors, "pnaen: warning: points (p), left out: 1.\n");
}

#[test]
fn another_mesh_and_indices_out_of_range_are_said() {
    let folder = Folder::new();
    let other = folder.path("cube.obj");
    output(&["tessellate", "shape:cube-split", "--device", "cpu", "-o", &other]);
    let said = compared(&other, &[], 1);
    assert!(said.starts_with("It isn't a tessellation of this mesh: "), "{said}");
    let theirs = emitted(&folder, "a.obj", &[]);
    let broken = std::fs::read_to_string(&theirs).expect("a file") + "f 1 2 999999\n";
    std::fs::write(&theirs, broken).expect("a writable folder");
    let said = compared(&theirs, &[], 0);
    assert!(said.contains("is the same"), "{said}");
    let errors = run(&["compare", &theirs, "--mesh", "shape:torus"]).stderr;
    assert!(String::from_utf8_lossy(&errors).contains("warning: "), "the face that is left out is named");
}
