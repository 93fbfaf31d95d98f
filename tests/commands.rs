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

/// A number in an object.
fn number(object: &Value, path: &str) -> f64 {
    object.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {path}: {object}"))
}

#[test]
fn stats_say_what_was_done() {
    let stats = stats(&["shape:torus", "--factor", "4", "--partitioning", "integer"]);
    let number = |path: &str| number(&stats, path);
    assert!(stats["adapter"].as_str().is_some_and(|name| !name.is_empty()));
    let counts = ["/triangles_in", "/points", "/corners", "/degenerate", "/patches", "/patches_culled"].map(number);
    assert_eq!(counts, [256.0, 128.0, 153.0, 0.0, 256.0, 0.0]);
    // 1.5 N^2 triangles and 3 N + 3 R (R + 1) + 1 vertices a patch, R = N / 2 - 1.
    assert_eq!([number("/triangles_out"), number("/vertices_out")], [256.0 * 24.0, 256.0 * 19.0]);
    let edges = ["smooth", "split", "seam", "boundary", "non_manifold"].map(|kind| number(&format!("/edges/{kind}")));
    assert_eq!(edges, [360.0, 0.0, 24.0, 0.0, 0.0]);
    assert_eq!(number("/cracks/edge_points"), 384.0 * 5.0);
    assert_eq!(number("/cracks/edges_compared"), 384.0);
    let kinds = ["different_bits", "different_factors", "different_normals"];
    for zero in kinds.into_iter().chain(["max_gap", "max_gap_ulp", "max_gap_px", "edges"]) {
        assert_eq!(number(&format!("/cracks/{zero}")), 0.0, "{zero}");
    }
    assert_eq!(["/leaks", "/folds", "/not_finite"].map(number), [0.0; 3]);
    for bytes in ["input", "topology", "arena"] {
        assert!(number(&format!("/bytes/{bytes}")) > 0.0);
    }
    for pass in ["load", "topology", "nets", "factors", "counts", "scan", "chunks", "emit", "draw"] {
        assert!(number(&format!("/ms/{pass}")) >= 0.0, "{pass}");
    }
}

#[test]
fn pn_cracks_on_split_normals_and_pn_aen_does_not() {
    let drawn = |surface| stats(&["shape:cube-split", "--surface", surface]);
    let (pn, pn_aen, flat) = (drawn("pn"), drawn("pn-aen"), drawn("flat"));
    let torn = &pn["cracks"];
    assert_eq!((&torn["edges"], &torn["edges_compared"]), (&12.into(), &18.into()));
    assert!(torn["max_gap"].as_f64() > Some(0.01) && torn["max_gap_px"].as_f64() > Some(0.5), "{torn}");
    assert!(torn["max_gap_ulp"].as_f64() > Some(1e4), "{torn}");
    assert!(pn["leaks"].as_u64() > Some(100), "one looks through the cracks: {pn}");
    for whole in [pn_aen, flat] {
        assert_eq!((&whole["cracks"]["different_bits"], &whole["leaks"]), (&0.into(), &0.into()));
    }
}

#[test]
fn an_open_mesh_has_no_leaks_to_count() {
    let open = stats(&["shape:saddle"]);
    assert_eq!(open.get("leaks"), Some(&Value::Null), "{open}");
    assert_eq!(number(&open, "/cracks/edges_compared"), 96.0, "all but the borders");
}

#[test]
fn stats_count_folds_where_normals_lie_nearly_in_the_plane() {
    let folder = Folder::new("folds");
    // The last two as at a notch and a point of a star.
    let positions = [[0.0, 0.0, 0.0], [0.28, 0.0, 0.2], [1.0, 0.0, 0.0]];
    let upright = [[0.0, 1.0, 0.0]; 3];
    let leaning = [[0.0, 1.0, 0.0], [-0.77, 0.32, -0.56], [0.84, 0.28, 0.45]];
    let folds = |normals: [[f32; 3]; 3]| {
        let path = write_corners(&folder, &[0, 1, 2].map(|k| (positions[k], normals[k])));
        number(&stats(&[&path]), "/folds")
    };
    assert_eq!(folds(upright), 0.0);
    assert!(folds(leaning) > 0.0);
}

#[test]
fn edges_differ_as_published_and_not_by_edge() {
    let cracks =
        |options: &[&str]| stats(&[&["shape:torus", "--surface", "pn-aen"], options].concat())["cracks"].clone();
    let published = ["--edges", "as-published"];
    let adaptive = ["--lod", "paper", "--pixels", "4"];
    let uniform = cracks(&published);
    assert!(number(&uniform, "/different_bits") > 0.0 && number(&uniform, "/max_gap") > 0.0, "{uniform}");
    assert_eq!(uniform["different_factors"], 0, "a uniform factor is the same from every side: {uniform}");
    let paper = cracks(&[&published[..], &adaptive].concat());
    assert!(number(&paper, "/different_factors") > 0.0, "{paper}");
    let by_edge = cracks(&[&["--edges", "per-edge"][..], &adaptive].concat());
    assert_eq!((&by_edge["different_bits"], &by_edge["different_factors"]), (&0.into(), &0.into()), "{by_edge}");
}

#[test]
fn adaptive_lod_by_edge_length_and_clipping_by_the_frustum_hold_close_to_the_eye() {
    let close = ["shape:torus", "--camera", "30,20,0.6", "--pixels", "48"];
    let [clipped, whole, paper] = [["edge-length", "frustum"], ["edge-length", "off"], ["paper", "off"]]
        .map(|[lod, clip]| stats(&[&close[..], &["--lod", lod, "--clip", clip]].concat()));
    assert!(number(&clipped, "/patches_culled") > 50.0 && number(&clipped, "/patches_culled") < 256.0, "{clipped}");
    assert_eq!((&whole["patches_culled"], &paper["patches_culled"]), (&0.into(), &0.into()));
    assert!(number(&clipped, "/triangles_out") < number(&whole, "/triangles_out"), "{clipped}");
    assert_ne!(whole["triangles_out"], paper["triangles_out"], "edges reach behind the eye");
    for stats in [clipped, whole] {
        assert_eq!((&stats["cracks"]["edges"], &stats["not_finite"]), (&0.into(), &0.into()), "{stats}");
    }
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
fn a_selected_triangle_is_outlined() {
    let folder = Folder::new("select");
    let drawn = |name: &str, options: &[&str]| {
        let path = folder.path(name);
        let base = ["render", "shape:cube-split", "-o", &path, "--size", "320x240", "--camera", "0,0"];
        output(&[&base[..], options].concat());
        image::open(&path).expect("a PNG file").to_rgba8()
    };
    // Pink, lime and blue as src/render/layout.rs has them.
    let colors: [[i32; 3]; 3] = [[240, 90, 130], [120, 185, 40], [90, 125, 255]];
    let count = |picture: &image::RgbaImage, color: [i32; 3]| {
        let near = |pixel: &image::Rgba<u8>| (0..3).all(|c| (i32::from(pixel.0[c]) - color[c]).abs() <= 4);
        picture.pixels().filter(|pixel| near(pixel)).count()
    };
    let plain = drawn("plain.png", &[]);
    let outlined = drawn("outlined.png", &["--select", "8"]);
    for color in colors {
        assert_eq!(count(&plain, color), 0, "{color:?}");
        assert!(count(&outlined, color) > 100, "{color:?}: {}", count(&outlined, color));
    }
    let path = folder.path("none.png");
    sentence(&["render", "shape:cube-split", "-o", &path, "--select", "12"], &["0 to 11", "no triangle 12"]);
    assert!(!Path::new(&path).exists());
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
    assert!(text.contains("weld  ") && text.contains("\n  1e-5          joins nothing\n"), "{text}");
    assert!(!text.contains("near misses"), "{text}");
    let json: Value = serde_json::from_str(&output(&["info", "shape:saddle", "--json"])).expect("JSON");
    assert_eq!((&json["edges"]["boundary"], &json["closed"]), (&24.into(), &false.into()));
}

/// Writes triangles as a glTF document with a buffer next to it.
fn write_triangles(folder: &Folder, triangles: &[[[f32; 3]; 3]], normal: [f32; 3]) -> String {
    let corners: Vec<_> = triangles.as_flattened().iter().map(|&position| (position, normal)).collect();
    write_corners(folder, &corners)
}

/// The same from corners, three a triangle, with their positions and normals.
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

/// A tetrahedron of which one face was moved by a ten-thousandth of the diagonal.
fn write_seam(folder: &Folder) -> String {
    let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let moved = [o, z, y].map(|point| point.map(|coordinate: f32| coordinate + 1e-4));
    write_triangles(folder, &[[o, y, x], [o, x, z], [x, y, z], moved], [0.0, 0.0, 1.0])
}

#[test]
fn a_seam_that_almost_meets_is_closed_within_a_tolerance() {
    let folder = Folder::new("seam");
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
        assert_eq!(joins, expected, "against the exact weld, whatever the tolerance: {options:?}");
        assert_eq!(drawn["edges"]["boundary"], boundary, "{options:?}");
        assert_eq!(drawn["leaks"], if open { Value::Null } else { 0.into() }, "{options:?}");
        assert_eq!((&drawn["cracks"]["edges"], &drawn["patches"]), (&0.into(), &4.into()), "{options:?}");
        // Closed to the bit: what is written is opened without a tolerance.
        output(&[&["tessellate", &path, "-o", &out, "--factor", "3", "--device", "cpu"], options].concat());
        assert_eq!(json(&["info", &out, "--json"])["closed"], !open, "{options:?}");
    }
    assert_eq!(info(&["--weld", "1e-5"])["edges"]["boundary"], 6, "less than the gap");
}

/// The rows of `pnaen stability --json` on the CPU.
fn stability(arguments: &[&str]) -> Vec<Value> {
    let text = output(&[&["stability", "--device", "cpu", "--json"], arguments].concat());
    serde_json::from_str(&text).expect("a JSON array")
}

/// Text in a row of `pnaen stability --json`.
fn word<'a>(row: &'a Value, key: &str) -> &'a str {
    row[key].as_str().unwrap_or_else(|| panic!("no {key}: {row}"))
}

/// The cases that rows belong to, in their order.
fn cases(rows: &[Value]) -> Vec<&str> {
    let mut cases: Vec<_> = rows.iter().map(|row| word(row, "case")).collect();
    cases.dedup();
    cases
}

const METHODS: [&str; 4] = ["flat", "PN", "PN-AEN as published", "PN-AEN"];

#[test]
fn stability_measures_every_method_in_every_partitioning() {
    let rows = stability(&["--case", "split-normals", "--cameras", "1"]);
    let keys = ["case", "method", "device", "partitioning", "measured", "unit", "promised", "holds"];
    let units =
        ["edge points that differ", "edges whose factors differ", "edge normals that differ", "vertices not finite"];
    let mut expected = HashSet::new();
    for method in METHODS {
        for partitioning in ["integer", "pow2", "fractional-odd", "fractional-even"] {
            expected.extend(units.map(|unit| (method, partitioning, unit)));
        }
    }
    let found: HashSet<_> =
        rows.iter().map(|row| ["method", "partitioning", "unit"].map(|key| word(row, key))).collect();
    assert_eq!(found, expected.iter().map(|&(method, partitioning, unit)| [method, partitioning, unit]).collect());
    assert_eq!(rows.len(), expected.len(), "each once");
    for row in &rows {
        let own: HashSet<_> = row.as_object().expect("an object").keys().map(String::as_str).collect();
        assert_eq!(own, HashSet::from(keys));
        assert_eq!((word(row, "case"), word(row, "device")), ("split-normals", "cpu"));
        let (measured, holds) = (number(row, "/measured"), row["holds"].as_bool().expect("a truth value"));
        assert_eq!(holds, measured == 0.0, "{row}");
        let promised = row["promised"].as_bool().expect("a truth value");
        assert!(holds || !promised, "{row}");
        match (word(row, "method"), word(row, "unit")) {
            ("flat" | "PN-AEN", _) => assert!(promised, "{row}"),
            ("PN" | "PN-AEN as published", "edge points that differ") => assert!(!holds, "{row}"),
            _ => {}
        }
    }
    // A uniform factor is the same from every side: only views can tell.
    let factors = |rows: &[Value]| rows.iter().any(|row| word(row, "unit") == units[1] && row["holds"] == false);
    assert!(factors(&rows) && !factors(&stability(&["--case", "split-normals", "--cameras", "0"])));
}

#[test]
fn stability_runs_cases_in_one_order_however_they_are_asked_for() {
    let run = |names: &[&str]| {
        let options = names.iter().flat_map(|name| ["--case", name]);
        stability(&["--cameras", "0"].into_iter().chain(options).collect::<Vec<_>>())
    };
    let rows = run(&["split-normals", "t-junction"]);
    assert_eq!(cases(&rows), ["split-normals", "t-junction"]);
    assert!(rows == run(&["t-junction", "split-normals", "t-junction"]), "the same rows in the same order");
}

#[test]
fn a_case_that_is_not_there_is_answered_with_those_that_are() {
    let said = failure(&["stability", "--case", "teapot", "--device", "cpu", "--json"], 2);
    for name in ["teapot", "split-normals", "smooth-torus", "near-seam", "shared-apex"] {
        assert!(said.contains(name), "{name:?} is not in {said}");
    }
}

#[test]
fn stability_prints_a_table_with_verdicts() {
    let text =
        output(&["stability", "--case", "smooth-torus", "--case", "t-junction", "--device", "cpu", "--cameras", "0"]);
    let table: Vec<Vec<&str>> =
        text.lines().map(|line| line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect()).collect();
    assert_eq!(table[0][..3], ["case", "method", "points"], "{text}");
    assert_eq!(text.matches("verdict").count(), 1, "{text}");
    assert_eq!((table[1][0], table[5][..2].to_vec()), ("smooth-torus", vec!["t-junction", "search"]), "{text}");
    for (method, line) in METHODS.iter().zip(&table[1..5]) {
        let cells = &line[line.len() - 7..];
        assert_eq!(cells[0], *method, "{text}");
        if *method == "PN-AEN as published" {
            assert!(cells[1].parse::<u32>().is_ok_and(|points| points > 0), "{text}");
            assert_eq!(cells[6], "fails", "{text}");
        } else {
            assert_eq!(cells[1..], ["0", "0", "0", "0", "-", "holds"], "{text}");
        }
    }
    assert_eq!(table[5].last(), Some(&"holds: 0 T-junctions missed"), "{text}");
    let legend = text.lines().last().expect("lines");
    assert!(legend.starts_with("points: ") && legend.contains("factors: "), "{text}");
}

#[test]
fn stability_draws_its_cases_and_writes_a_page() {
    let folder = Folder::new("stability");
    let pages = folder.path("made/on/the/way");
    output(&["stability", "--case", "split-normals", "--cameras", "0", "-o", &pages]);
    let mut files: Vec<_> =
        std::fs::read_dir(&pages).expect("a folder").map(|file| file.expect("a file").file_name()).collect();
    files.sort();
    assert_eq!(files, ["split-normals.png", "stability.md"]);

    let picture = image::open(Path::new(&pages).join("split-normals.png")).expect("a PNG file").to_rgb8();
    // Four methods side by side, each with cracks in red where there are any.
    let width = picture.width() / 4;
    let parts =
        [0, 1, 2, 3].map(|k| image::imageops::crop_imm(&picture, k * width, 0, width, picture.height()).to_image());
    let colors = parts.each_ref().map(|part| part.pixels().collect::<HashSet<_>>().len());
    assert!(colors.iter().all(|&count| count > 20), "{colors:?} colours");
    let red = parts.map(|part| part.pixels().filter(|p| p.0[0] > 200 && p.0[1] < 100 && p.0[2] < 80).count());
    assert!(red[0] == 0 && red[1] > 100 && red[3] == 0, "{red:?} red px");

    let page = std::fs::read_to_string(Path::new(&pages).join("stability.md")).expect("a page");
    assert!(page.contains("\n## split-normals\n") && page.contains("](split-normals.png)"), "{page}");
    // After the headings and the rule below them.
    let lines = page.lines().filter(|line| line.starts_with("| ")).skip(2);
    let lines: Vec<_> = lines.map(|line| line.trim_matches(['|', ' ']).split(" | ").collect::<Vec<_>>()).collect();
    let verdicts: Vec<_> = lines.iter().map(|cells| (cells[0], cells[cells.len() - 1])).collect();
    assert_eq!(verdicts, METHODS.into_iter().zip(["holds", "fails", "fails", "holds"]).collect::<Vec<_>>(), "{page}");

    let file = Path::new(&pages).join("stability.md/below");
    let below = file.to_str().expect("a path in UTF-8");
    let arguments = ["stability", "--case", "split-normals", "--device", "cpu", "-o", below];
    sentence(&arguments, &[below, "could not be made"]);
}

#[test]
fn stability_takes_files_too() {
    let folder = Folder::new("tent");
    // Two sides of a roof, each with its own normal.
    let [left, right] = [[-0.48, 0.6, 0.64], [0.48, 0.6, 0.64]];
    let [front, back] = [[0.0, -1.0, 1.0], [0.0, 1.0, 1.0]];
    let roof = [
        ([-1.0, 0.0, 0.0], left),
        (front, left),
        (back, left),
        ([1.0, 0.0, 0.0], right),
        (back, right),
        (front, right),
    ];
    let path = write_corners(&folder, &roof);
    let rows = stability(&[&path, "--cameras", "0"]);
    assert_eq!(cases(&rows), ["triangles.gltf"]);
    for method in METHODS {
        let torn = rows.iter().filter(|row| word(row, "method") == method && row["holds"] == false).count();
        assert_eq!(torn > 0, method.starts_with("PN") && method != "PN-AEN", "{method}");
    }
    assert_eq!(cases(&stability(&[&path, "--case", "t-junction", "--cameras", "0"])), ["t-junction", "triangles.gltf"]);
    sentence(&["stability", "nowhere.glb", "--device", "cpu"], &["nowhere.glb", "can't be read"]);

    // Drawn and written down like a case; one more of that name has a picture of its own.
    let pages = folder.path("pages");
    output(&["stability", &path, &path, "--cameras", "0", "--device", "gpu", "-o", &pages]);
    let page = std::fs::read_to_string(Path::new(&pages).join("stability.md")).expect("a page");
    for (name, picture) in [("triangles.gltf", "triangles.png"), ("triangles (2).gltf", "triangles--2-.png")] {
        let section = format!("\n## {name}\n\n![{name}]({picture})\n\n| method |");
        assert!(page.contains(&section) && Path::new(&pages).join(picture).exists(), "{page}");
    }
    assert!(!page.contains("cpu"), "{page}");

    // What can't be loaded is said before anything runs.
    let unmade = folder.path("unmade");
    sentence(&["stability", "--case", "soup", "nowhere.glb", "-o", &unmade], &["nowhere.glb"]);
    assert!(!Path::new(&unmade).exists());
}

#[test]
fn stability_looks_into_a_file_that_a_tolerance_closes() {
    let folder = Folder::new("looks");
    let path = write_seam(&folder);
    let leaks = |options: &[&str]| {
        let text = output(&[&["stability", &path, "--json", "--cameras", "0", "--device", "gpu"], options].concat());
        let rows: Vec<Value> = serde_json::from_str(&text).expect("a JSON array");
        assert!(rows.iter().all(|row| word(row, "device") != "cpu"), "{text}");
        rows.iter()
            .filter(|row| word(row, "unit") == "px leaking")
            .map(|row| number(row, "/measured"))
            .collect::<Vec<_>>()
    };
    assert_eq!(leaks(&[]), [0.0; 0], "open");
    assert_eq!(leaks(&["--weld", "1e-3"]), [0.0; 16], "four methods in four partitionings");
}

#[test]
fn lod_by_error_keeps_its_tolerance_with_fewer_triangles() {
    let of = |options: &[&str]| stats(&[&["shape:torus", "--partitioning", "integer"], options].concat());
    let paper = of(&["--lod", "paper", "--pixels", "4"]);
    let reached = number(&paper, "/max_error_px");
    assert!(reached > 0.01, "{paper}");
    let tolerance = reached.to_string();
    let by_error = of(&["--lod", "error", "--tolerance", &tolerance]);
    assert!(number(&by_error, "/max_error_px") <= reached, "{by_error}");
    assert!(2.0 * number(&by_error, "/triangles_out") < number(&paper, "/triangles_out"), "{by_error}");
    assert_eq!((number(&by_error, "/factors_capped"), number(&by_error, "/cracks/different_bits")), (0.0, 0.0));
    let distance = of(&["--lod", "distance", "--factor", "9", "--distances", "2,5", "--measure-error", "false"]);
    assert!(distance["max_error_px"].is_null() && number(&distance, "/triangles_out") > 256.0, "{distance}");
}

#[test]
fn a_budget_of_triangles_raises_the_tolerance_and_says_so() {
    let folder = Folder::new("budget");
    let [picture, mesh] = ["out.png", "out.obj"].map(|name| folder.path(name));
    let by_error = ["shape:torus", "--lod", "error", "--tolerance", "0.1"];
    let all = number(&stats(&by_error), "/triangles_out");
    let by_error = [&by_error[..], &["--size", "160x120"]].concat();
    let most = (0.5 * all).to_string();
    let result = run(&[&["render", "-o", &picture, "--stats", "-", "--max-triangles", &most], &by_error[..]].concat());
    let said = String::from_utf8(result.stderr).expect("text");
    assert!(said.contains("tolerance raised from 0.1 to") && said.contains(&most), "{said}");
    let stats: Value = serde_json::from_slice(&result.stdout).expect("JSON");
    let count = number(&stats, "/triangles_out");
    assert!(count <= 0.5 * all && count > 0.2 * all, "{count} of {all}");
    // A tolerance that fits already stays, and says nothing.
    let result = run(&[&["render", "-o", &picture, "--max-triangles", "9999999"], &by_error[..]].concat());
    assert!(result.status.success() && result.stderr.is_empty());
    // Both devices have the option; a budget below the mesh itself is a sentence.
    output(&[&["tessellate", "-o", &mesh, "--device", "cpu", "--max-triangles", "300"], &by_error[..]].concat());
    assert!(read_obj(&mesh).1.len() <= 300);
    sentence(
        &[&["render", "-o", &picture, "--max-triangles", "200"], &by_error[..]].concat(),
        &["256 triangles", "200"],
    );
    let said = failure(&["render", "shape:torus", "-o", &picture, "--max-triangles", "200"], 2);
    assert!(said.contains("--lod error"), "{said}");
}

#[test]
fn a_small_arena_gives_the_same_mesh() {
    let options = ["shape:torus", "--factor", "24"];
    let [large, small] = ["256", "1"].map(|arena| stats(&[&options[..], &["--arena", arena]].concat()));
    assert_eq!(large["cracks"], small["cracks"]);
    assert_eq!(large["triangles_out"], small["triangles_out"]);
    assert!(number(&small, "/bytes/arena") <= f64::from(1 << 20), "{small}");
    assert!(number(&large, "/bytes/arena") > f64::from(1 << 20), "{large}");
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
        &["info", "shape:torus", "--weld=-0.001"],
        &["info", "shape:torus", "--weld", "nan"],
        &["render", "shape:torus", "-o", "x.png", "--weld=-0.001"],
        &["tessellate", "shape:torus", "-o", "x.glb", "--weld", "nan"],
        &["stability", "shape:torus", "--device", "cpu", "--weld=-0.001"],
        &["stability", "shape:torus", "--device", "cpu", "--weld", "nan"],
        &["render", "shape:torus", "-o", "x.png", "--edges", "published"],
        &["render", "shape:torus", "-o", "x.png", "--lod", "edgelength"],
        &["tessellate", "shape:torus", "-o", "x.glb", "--lod", "edge_length"],
        &["render", "shape:torus", "-o", "x.png", "--clip", "frustrum"],
        &["tessellate", "shape:torus", "-o", "x.glb", "--clip", "frusta"],
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

#[test]
fn stats_count_small_triangles_and_patches_with_low_factors() {
    let counts = |arguments: &[&str]| {
        let stats = stats(arguments);
        ["/triangles_out", "/triangles_in_view", "/triangles_below_3_px", "/patches_below_factor_2"]
            .map(|path| number(&stats, path))
    };
    let coarse = ["shape:torus", "--factor", "1", "--partitioning", "integer", "--measure-error", "false"];
    // Framed in 160 x 120 px, the torus's 256 patches are some 5 px large.
    let [out, in_view, small, low] = counts(&coarse);
    assert_eq!([out, in_view, low], [256.0; 3]);
    assert!(small < 128.0, "{small} of 256 patches");
    let fine = ["shape:torus", "--factor", "16", "--partitioning", "integer", "--measure-error", "false"];
    let [out, in_view, small, low] = counts(&fine);
    assert_eq!([in_view, small, low], [out, out, 0.0]);
    let close = [&coarse[..], &["--camera", "30,20,0.5"]].concat();
    let [out, in_view, small, _] = counts(&close);
    assert!(in_view < out / 2.0 && small < in_view, "{small} of {in_view} of {out}");
    let even = ["shape:torus", "--factor", "1", "--partitioning", "fractional-even", "--measure-error", "false"];
    assert_eq!(counts(&even)[3], 0.0, "an even factor is at least 2");
}

#[test]
fn two_overlays_that_colour_the_surface_are_wrong_usage() {
    let folder = Folder::new("overlays");
    let picture = folder.path("out.png");
    let overlays = |list| ["render", "shape:torus", "-o", &picture, "--size", "60x40", "--overlay", list];
    for list in ["barycentric,factors", "triangle-size,wireframe,low-factors"] {
        let errors = failure(&overlays(list), 2);
        assert!(errors.contains("each colours the whole surface"), "{errors}");
        assert!(!Path::new(&picture).exists(), "before anything is drawn");
    }
    output(&overlays("triangle-size,wireframe,normals,back-faces"));
}
