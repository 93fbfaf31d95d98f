//! The commands as a person or a pipeline meets them: the program itself, its output, its pictures, its exit codes.

use std::collections::{HashMap, HashSet};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

/// A folder of this test's own, gone when the test is.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("pnaen-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a writable temporary folder");
        Self(path)
    }

    fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().expect("a path in UTF-8").to_owned()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
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
    let output = run(arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// What a run that must fail says on standard error.
fn failure(arguments: &[&str], code: i32) -> String {
    let output = run(arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {errors}");
    assert!(!errors.contains("panicked"), "{errors}");
    errors
}

/// A failure in one sentence, with these words in it.
fn sentence(arguments: &[&str], words: &[&str]) {
    let errors = failure(arguments, 1);
    assert_eq!(errors.lines().count(), 1, "{errors}");
    assert!(errors.starts_with("pnaen: "), "{errors}");
    for word in words {
        assert!(errors.contains(word), "{word:?} is not in {errors}");
    }
}

fn vase() -> &'static str {
    concat!(env!("CARGO_MANIFEST_DIR"), "/assets/vase.glb")
}

fn stats(arguments: &[&str]) -> Value {
    let folder = Folder::new(&format!("stats-{}", arguments.join("-").replace(['/', ':', '.', ','], "_")));
    let picture = folder.path("out.png");
    let all = [&["render"], arguments, &["-o", &picture, "--size", "160x120", "--stats", "-"]].concat();
    serde_json::from_str(&output(&all)).expect("JSON")
}

#[test]
fn stats_say_what_was_done() {
    let stats = stats(&["shape:torus", "--factor", "4", "--partitioning", "integer"]);
    let number =
        |path: &str| stats.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {path}: {stats}"));
    assert!(stats["adapter"].as_str().is_some_and(|name| !name.is_empty()));
    let counts = ["/triangles_in", "/points", "/corners", "/degenerate", "/patches", "/patches_culled"].map(number);
    assert_eq!(counts, [256.0, 128.0, 153.0, 0.0, 256.0, 0.0]);
    // 1.5 N^2 triangles and 3 N + 3 R (R + 1) + 1 vertices a patch, R = N / 2 - 1.
    assert_eq!([number("/triangles_out"), number("/vertices_out")], [256.0 * 24.0, 256.0 * 19.0]);
    let edges = ["smooth", "split", "seam", "boundary", "non_manifold"].map(|kind| number(&format!("/edges/{kind}")));
    assert_eq!(edges, [360.0, 0.0, 24.0, 0.0, 0.0]);
    assert_eq!(number("/cracks/edge_points"), 384.0 * 5.0);
    for zero in ["different_bits", "max_gap", "max_gap_ulp", "max_gap_px", "edges"] {
        assert_eq!(number(&format!("/cracks/{zero}")), 0.0, "{zero}");
    }
    for bytes in ["input", "topology", "arena"] {
        assert!(number(&format!("/bytes/{bytes}")) > 0.0);
    }
    for pass in ["load", "topology", "nets", "factors", "counts", "scan", "chunks", "emit", "draw"] {
        assert!(number(&format!("/ms/{pass}")) >= 0.0, "{pass}");
    }
}

#[test]
fn pn_cracks_on_split_normals_and_pn_aen_does_not() {
    let cracks = |surface| stats(&["shape:cube-split", "--surface", surface])["cracks"].clone();
    let torn = cracks("pn");
    assert_eq!(torn["edges"], 12);
    assert!(torn["max_gap"].as_f64() > Some(0.01) && torn["max_gap_px"].as_f64() > Some(0.5), "{torn}");
    assert!(torn["max_gap_ulp"].as_f64() > Some(1e4), "{torn}");
    assert_eq!(cracks("pn-aen")["different_bits"], 0);
    assert_eq!(cracks("flat")["different_bits"], 0);
}

#[test]
fn a_file_of_ours_is_drawn_without_cracks() {
    for lod in ["uniform", "paper"] {
        let stats = stats(&[vase(), "--lod", lod, "--pixels", "6", "--clip", "paper"]);
        assert_eq!((&stats["cracks"]["different_bits"], &stats["patches"]), (&0.into(), &308.into()));
    }
}

#[test]
fn a_picture_has_the_size_and_background_asked_for() {
    let folder = Folder::new("picture");
    let path = folder.path("out.png");
    output(&[
        "render",
        vase(),
        "-o",
        &path,
        "--size",
        "120x90",
        "--background",
        "3264c8",
        "--overlay",
        "wireframe,patches,barycentric,adjacency,cracks",
    ]);
    let picture = image::open(&path).expect("a PNG file").to_rgba8();
    assert_eq!(picture.dimensions(), (120, 90));
    assert_eq!(picture.get_pixel(2, 2).0, [0x32, 0x64, 0xc8, 255]);
    assert_ne!(picture.get_pixel(60, 45).0, [0x32, 0x64, 0xc8, 255]);
}

#[test]
fn a_picture_is_held_against_its_reference() {
    let folder = Folder::new("reference");
    let [reference, same, other] = ["reference.png", "same.png", "other.png"].map(|name| folder.path(name));
    let render = |out: &str, more: &[&str]| {
        let base = ["render", "shape:torus", "--size", "160x120", "-o", out];
        run(&[&base[..], more].concat())
    };
    assert!(render(&reference, &[]).status.success());
    assert!(render(&same, &["--reference", &reference, "--threshold", "0.0001"]).status.success());
    assert!(!Path::new(&folder.path("same-diff.png")).exists());
    let differs = render(&other, &["--factor", "1", "--overlay", "wireframe", "--reference", &reference]);
    assert_eq!(differs.status.code(), Some(1));
    let said = String::from_utf8_lossy(&differs.stderr).into_owned();
    assert!(said.contains("other.png differs from") && said.contains("other-diff.png"), "{said}");
    let diff = image::open(folder.path("other-diff.png")).expect("a PNG file");
    assert_eq!((diff.width(), diff.height()), (160, 120));
    assert!(Path::new(&other).exists(), "the picture is written whatever it is held against");
    sentence(
        &["render", "shape:torus", "--size", "80x60", "-o", &other, "--reference", &reference],
        &["reference.png", "80 x 60", "160 x 120", "--size 160x120"],
    );
    let before = std::fs::read(&reference).expect("a file");
    sentence(&["render", "shape:cone", "-o", &reference, "--reference", &reference], &["would replace it"]);
    assert_eq!(std::fs::read(&reference).expect("a file"), before);
}

#[test]
fn both_devices_print_the_same_domain() {
    let folder = Folder::new("domain");
    let sets = folder.path("sets.txt");
    let text = "1 1 1 1\n2.5 3 7.25 4\n\nnan 1 1 1\n0 1 1 1\n-1 2 3 4\ninf 1 1 inf\n1 1 1 3\n64 64 64 64\n";
    std::fs::write(&sets, text).expect("a writable folder");
    for partitioning in ["integer", "pow2", "fractional-odd", "fractional-even"] {
        let domain = |device| output(&["domain", "--partitioning", partitioning, "--input", &sets, "--device", device]);
        let (gpu, cpu) = (domain("gpu"), domain("cpu"));
        assert!(gpu == cpu, "{partitioning}: the devices differ");
        let numbers: HashSet<&str> = cpu.lines().filter_map(|line| line.split(',').next()).collect();
        assert_eq!(numbers, HashSet::from(["0", "1", "5", "6", "7"]), "culled sets print nothing, and still count");
    }
}

#[test]
fn a_domain_is_printed_point_by_point() {
    let text = output(&["domain", "--partitioning", "integer", "--factors", "1,1,1,2", "--device", "cpu"]);
    let expected = "point,0,0,65536\npoint,1,0,0\npoint,2,65536,0\npoint,3,21845,21845\n\
                    triangle,3,0,1\ntriangle,3,1,2\ntriangle,3,2,0\n";
    assert_eq!(text, expected);
    assert_eq!(output(&["domain", "--partitioning", "fractional_odd", "--factors", "-3,1,nan,2"]), "");
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

#[test]
fn a_tessellated_mesh_is_closed_to_the_last_bit() {
    let folder = Folder::new("tessellate");
    let path = folder.path("out.obj");
    for device in ["gpu", "cpu"] {
        output(&["tessellate", "shape:cylinder", "-o", &path, "--device", device, "--factor", "5.5"]);
        let (positions, faces) = read_obj(&path);
        let mut edges: HashMap<_, i32> = HashMap::new();
        for face in faces {
            for k in 0..3 {
                let [a, b] = [face[k], face[(k + 1) % 3]].map(|i| positions[i]);
                if a != b {
                    *edges.entry((a, b)).or_default() += 1;
                    *edges.entry((b, a)).or_default() -= 1;
                }
            }
        }
        let open = edges.values().filter(|&&count| count != 0).count();
        assert_eq!(open, 0, "{device}: every edge is run once each way, by positions alone");
    }
}

#[test]
fn a_tessellated_mesh_can_be_opened_again() {
    let folder = Folder::new("again");
    let path = folder.path("out.glb");
    output(&["tessellate", vase(), "-o", &path, "--factor", "3", "--partitioning", "integer"]);
    let info: Value = serde_json::from_str(&output(&["info", &path, "--json"])).expect("JSON");
    assert_eq!(
        (&info["triangles"], &info["closed"], &info["euler_characteristic"]),
        (&(308 * 13).into(), &true.into(), &2.into())
    );
    assert_eq!(info["materials"][0]["texture"], serde_json::json!([64, 64]));
    assert_eq!(info["edges"]["non_manifold"], 0);
}

#[test]
fn a_mesh_without_triangles_left_is_written_and_refused_for_what_it_is() {
    let folder = Folder::new("empty");
    let [degenerate, out] = ["degenerate.gltf", "out.glb"].map(|name| folder.path(name));
    // Three corners on one point: a triangle that is left out. The buffer is 36 zero bytes.
    let zeros = "A".repeat(48);
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[0,0,0]}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{zeros}"}}]}}"#
    );
    std::fs::write(&degenerate, text).expect("a writable folder");
    let stats = stats(&[&degenerate]);
    assert_eq!((&stats["degenerate"], &stats["patches"], &stats["triangles_out"]), (&1.into(), &0.into(), &0.into()));
    output(&["tessellate", &degenerate, "-o", &out]);
    sentence(&["info", &out], &["no triangles"]);
}

#[test]
fn more_than_a_file_holds_is_refused_before_it_is_made() {
    let folder = Folder::new("huge");
    let [torus, out] = ["torus.glb", "out.glb"].map(|name| folder.path(name));
    output(&["tessellate", "shape:torus", "-o", &torus, "--factor", "20", "--partitioning", "integer"]);
    for device in ["gpu", "cpu"] {
        // 150 thousand triangles of 6144 each.
        let arguments = ["tessellate", &torus, "-o", &out, "--factor", "64", "--device", device];
        sentence(
            &[&arguments[..], &["--partitioning", "integer"]].concat(),
            &["out.glb", "943718400 triangles", "lower the factor"],
        );
    }
}

#[test]
fn adjacency_has_nine_or_twelve_indices_a_patch() {
    for (indices, name) in [(9, "9"), (12, "12")] {
        let text = output(&["adjacency", "shape:cube-split", "--indices", name, "-o", "-"]);
        let adjacency: Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(adjacency["indices_per_patch"], indices);
        let patches = adjacency["patches"].as_array().expect("an array");
        assert_eq!(patches.len(), 12);
        assert!(patches.iter().all(|patch| patch.as_array().map(Vec::len) == Some(indices)));
        let counts = ["positions", "normals"].map(|list| adjacency[list].as_array().map(Vec::len));
        assert_eq!(counts, [Some(24), Some(24)]);
    }
}

#[test]
fn info_is_for_people_and_for_programs() {
    let text = output(&["info", "shape:saddle"]);
    assert!(text.contains("boundary      24") && text.contains("open"), "{text}");
    let json: Value = serde_json::from_str(&output(&["info", "shape:saddle", "--json"])).expect("JSON");
    assert_eq!((&json["edges"]["boundary"], &json["closed"]), (&24.into(), &false.into()));
}

/// Writes triangles as a glTF document with a buffer next to it.
fn write_triangles(folder: &Folder, triangles: &[[[f32; 3]; 3]], normal: [f32; 3]) -> String {
    let positions = triangles.as_flattened().as_flattened();
    let count = positions.len() / 3;
    let floats = positions.iter().copied().chain(normal.into_iter().cycle().take(positions.len()));
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
    let path = folder.path("triangles.gltf");
    std::fs::write(&path, document.to_string()).expect("a writable folder");
    path
}

#[test]
fn info_tells_what_is_odd_and_what_a_weld_tolerance_changes() {
    let folder = Folder::new("odd");
    // One triangle above the edge from 0 to 4 along x, two below that meet at 1 on it and miss its ends by 1e-4.
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
    assert!(exact["warnings"][0].as_str().is_some_and(|warning| warning.contains("length isn't 1")), "{exact}");
}

#[test]
fn failures_are_one_sentence_and_exit_code_1() {
    let folder = Folder::new("failures");
    let [out, text, broken] = ["out.png", "notes.txt", "broken.gltf"].map(|name| folder.path(name));
    std::fs::write(&text, "no mesh").expect("a writable folder");
    std::fs::write(&broken, "{\"asset\":").expect("a writable folder");
    sentence(&["info", "nowhere.glb"], &["nowhere.glb", "can't be read"]);
    sentence(&["info", &text], &["notes.txt", ".gltf or .glb"]);
    sentence(&["info", &folder.path("")], &["is not a file"]);
    sentence(&["info", &broken], &["broken.gltf", "not a glTF 2.0 document"]);
    sentence(
        &["render", "shape:torus", "-o", &folder.path("no/such/folder/out.png")],
        &["out.png", "could not be written"],
    );
    sentence(
        &["render", "shape:torus", "-o", &out, "--reference", "nowhere.png"],
        &["nowhere.png", "could not be read"],
    );
    sentence(&["tessellate", "shape:torus", "-o", &folder.path("out.stl")], &["out.stl", ".glb or .obj"]);
    sentence(&["domain", "--partitioning", "integer", "--input", &text], &["notes.txt, line 1", "four numbers"]);
}

#[test]
fn a_picture_too_large_for_the_device_is_a_sentence() {
    let folder = Folder::new("large");
    let path = folder.path("out.png");
    let output = run(&["render", "shape:torus", "-o", &path, "--size", "16384x16384"]);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    // A device with memory enough may draw it.
    assert!(output.status.success() || output.status.code() == Some(1), "{errors}");
    assert!(errors.lines().count() <= 1 && !errors.contains("panicked"), "{errors}");
    assert_eq!(output.status.success(), Path::new(&path).exists());
}

#[test]
fn wrong_usage_exits_with_2() {
    for arguments in [
        &["render", "shape:torus"][..],
        &["render", "shape:teapot", "-o", "x.png"],
        &["render", "shape:torus", "-o", "x.png", "--factor", "65"],
        &["render", "shape:torus", "-o", "x.png", "--surface", "nurbs"],
        &["render", "shape:torus", "-o", "x.png", "--size", "0x0"],
        &["render", "shape:torus", "-o", "x.png", "--camera", "1"],
        &["domain", "--partitioning", "integer"],
        &["domain", "--partitioning", "thirds", "--factors", "1,1,1,1"],
        &["domain", "--partitioning", "integer", "--factors", "1,1,1"],
        &["adjacency", "shape:torus", "--indices", "10", "-o", "-"],
        &["info", "shape:torus", "--weld", "0.2"],
        &["info", "shape:torus", "--weld", "-1"],
        &["frobnicate", "--hard"],
    ] {
        failure(arguments, 2);
    }
}

#[test]
fn a_closed_pipe_is_no_failure() {
    let mut child = command(&["domain", "--partitioning", "integer", "--factors", "64,64,64,64", "--device", "cpu"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the program ends");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn sets_of_factors_come_from_standard_input_too() {
    let mut child = command(&["domain", "--partitioning", "integer", "--input", "-", "--device", "cpu"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    child.stdin.take().expect("a pipe").write_all(b"1 1 1 1\n").expect("it reads");
    let output = child.wait_with_output().expect("the program ends");
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        "0,point,0,0,65536\n0,point,1,0,0\n0,point,2,65536,0\n0,triangle,0,1,2\n"
    );
}

#[test]
fn without_a_display_the_window_becomes_a_picture() {
    let folder = Folder::new("preview");
    let output = command(&[]).current_dir(&folder.0).output().expect("the program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("no display") && said.contains("pnaen-preview.png"), "{said}");
    assert_eq!(said.lines().count(), 1);
    let picture = image::open(folder.path("pnaen-preview.png")).expect("a PNG file");
    assert_eq!((picture.width(), picture.height()), (1280, 720));
    let missing = command(&["nowhere.glb"]).current_dir(&folder.0).output().expect("the program starts");
    assert_eq!(missing.status.code(), Some(1));
}
