//! Tests of the commands through the program itself: its output, its pictures and its exit codes.

mod adapters;
mod adjacency;
mod animation;
mod cameras;
mod chart;
mod check;
mod compare;
mod deviation;
mod domain;
mod environment;
mod factors;
mod formats;
mod gallery;
mod gates;
mod import;
mod info;
mod lod;
mod lod_shader;
mod manual;
#[cfg(target_os = "linux")]
mod opened;
mod picture_file;
mod reference;
mod render;
mod scenes;
mod shaders;
mod silhouette;
mod stability;
mod subdivision;
mod surface_shader;
mod techniques;
mod tessellate;
mod turntable;
mod usage;
mod variants;
mod views;
#[cfg(unix)]
mod writing;

use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// A temporary folder, which is removed at the end of the test.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a writable temporary folder"))
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().expect("a path in UTF-8").to_owned()
    }

    /// Writes a file of this name, and returns its path.
    fn write(&self, name: &str, content: impl AsRef<[u8]>) -> String {
        let path = self.path(name);
        std::fs::write(&path, content).expect("a writable folder");
        path
    }
}

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pnaen"));
    command.args(arguments).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    command
}

fn run(arguments: &[&str]) -> Output {
    command(arguments).output().expect("the program starts")
}

/// Standard output of a run that must succeed.
fn output(arguments: &[&str]) -> String {
    both(arguments).0
}

/// Standard output and standard error of a run that must succeed.
fn both(arguments: &[&str]) -> (String, String) {
    let output = run(arguments);
    let [out, errors] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("text"));
    assert!(output.status.success(), "{arguments:?}: {errors}");
    (out, errors)
}

/// Standard error of a run that must fail with this exit code.
fn failure(arguments: &[&str], code: i32) -> String {
    let output = run(arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {errors}");
    assert!(!errors.contains("panicked"), "{errors}");
    errors
}

/// Checks that a run fails with one line on standard error that has all of these words.
fn sentence(arguments: &[&str], words: &[&str]) {
    let errors = failure(arguments, 1);
    assert_eq!(errors.lines().count(), 1, "{errors}");
    assert!(errors.starts_with("pnaen: "), "{errors}");
    assert_says(&errors, words);
}

/// Checks that a text has all of these parts.
#[track_caller]
fn assert_says(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part:?} is not in {text}");
    }
}

fn vase() -> &'static str {
    concat!(env!("CARGO_MANIFEST_DIR"), "/assets/vase.glb")
}

/// Light that needs no preparation.
const SIMPLE_LIGHT: [&str; 2] = ["--lighting", "camera"];

/// Options that make a picture start soon, but for those that `arguments` have: one factor, and [`SIMPLE_LIGHT`]. What LOD by error
/// and light from all around need is compiled anew in each start, which takes the software driver over a second.
fn simple(arguments: &[&str]) -> Vec<&'static str> {
    let has = |names: &[&str]| names.iter().any(|name| arguments.contains(name));
    let is_fine = has(&["--lod", "--factor", "--factors", "--lod-shader"]);
    let lod: &[&'static str] = if is_fine { &[] } else { &["--lod", "uniform"] };
    let light: &[&'static str] = if has(&["--lighting", "--environment"]) { &[] } else { &SIMPLE_LIGHT };
    [lod, light].concat()
}

/// Stats of a small [`simple`] picture, with the largest error if that is asked for.
fn stats(arguments: &[&str]) -> Value {
    let folder = Folder::new();
    let picture = folder.path("out.png");
    let error: &[&str] = if arguments.contains(&"--measure-error") { &[] } else { &["--measure-error", "false"] };
    let usual = ["-o", &picture, "--size", "160x120", "--stats", "-"];
    let all = [&["render"], arguments, &simple(arguments)[..], error, &usual].concat();
    serde_json::from_str(&output(&all)).expect("JSON")
}

/// A number in an object.
fn number(object: &Value, path: &str) -> f64 {
    object.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {path}: {object}"))
}

/// Vertices and faces of an OBJ file.
fn read_obj(path: &str) -> (Vec<[u32; 3]>, Vec<[usize; 3]>) {
    let text = std::fs::read_to_string(path).expect("a file");
    let numbers = |line: &str| {
        line.split(' ').skip(1).map(|word| word.parse::<f32>().expect("a number").to_bits()).collect::<Vec<_>>()
    };
    let index =
        |word: &str| word.split('/').next().and_then(|index| index.parse::<usize>().ok()).expect("an index") - 1;
    let positions =
        text.lines().filter(|line| line.starts_with("v ")).map(|line| numbers(line).try_into().expect("three"));
    let faces = text.lines().filter(|line| line.starts_with("f "));
    let faces = faces.map(|line| line.split(' ').skip(1).map(index).collect::<Vec<_>>().try_into().expect("three"));
    (positions.collect(), faces.collect())
}

/// Writes triangles as a glTF document with a buffer next to it.
fn write_triangles(folder: &Folder, triangles: &[[[f32; 3]; 3]], normal: [f32; 3]) -> String {
    let corners: Vec<_> = triangles.as_flattened().iter().map(|&position| (position, normal)).collect();
    write_corners(folder, &corners)
}

/// Like [`write_triangles`], from positions and normals of corners, three per triangle.
fn write_corners(folder: &Folder, corners: &[([f32; 3], [f32; 3])]) -> String {
    let count = corners.len();
    let positions = corners.iter().flat_map(|&(position, _)| position);
    let floats = positions.chain(corners.iter().flat_map(|&(_, normal)| normal));
    let bytes: Vec<u8> = floats.flat_map(f32::to_le_bytes).collect();
    let view = |i: usize| serde_json::json!({ "buffer": 0, "byteOffset": i * 12 * count, "byteLength": 12 * count });
    let accessor =
        |i: usize| serde_json::json!({ "bufferView": i, "componentType": 5126, "count": count, "type": "VEC3" });
    let document = serde_json::json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": 1 } }] }],
        "accessors": [accessor(0), accessor(1)], "bufferViews": [view(0), view(1)],
        "buffers": [{ "byteLength": bytes.len(), "uri": "data.bin" }],
    });
    std::fs::write(folder.path("data.bin"), bytes).expect("a writable folder");
    folder.write("triangles.gltf", document.to_string())
}

/// Writes a tetrahedron with one face moved by 1e-4 along each axis.
fn write_seam(folder: &Folder) -> String {
    let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let moved = [o, z, y].map(|point| point.map(|coordinate: f32| coordinate + 1e-4));
    write_triangles(folder, &[[o, y, x], [o, x, z], [x, y, z], moved], [0.0, 0.0, 1.0])
}
