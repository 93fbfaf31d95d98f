//! `pnaen adjacency`: index buffers in every format and size, and files that are compared with them.

use std::io::Write;
use std::process::Stdio;

use serde_json::Value;

use crate::{Folder, assert_says, command, failure, output, run, sentence, vase, write_triangles};

const COUNTS: [(&str, usize); 4] = [("6", 6), ("9", 9), ("12", 12), ("18", 18)];

/// A mesh's indices as JSON on standard output.
fn json(mesh: &str, indices: &str) -> Value {
    serde_json::from_str(&output(&["adjacency", mesh, "--indices", indices, "-o", "-"])).expect("JSON")
}

/// The indices of a mesh, patch by patch, out of JSON.
fn patches(document: &Value) -> Vec<Vec<u32>> {
    serde_json::from_value(document["patches"].clone()).expect("lists of indices")
}

/// The indices in bare bytes.
fn indices(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks(4).map(|index| u32::from_le_bytes(index.try_into().expect("four bytes"))).collect()
}

fn write_indices(path: &str, indices: &[u32]) {
    let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
    std::fs::write(path, bytes).expect("a writable folder");
}

/// A square whose second triangle is degenerate.
fn write_degenerate(folder: &Folder) -> String {
    let [a, b, c, d] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    write_triangles(folder, &[[a, b, c], [b, b, c], [b, d, c]], [0.0, 0.0, 1.0])
}

#[test]
fn json_and_bare_indices_agree_and_contain_each_other() {
    let folder = Folder::new();
    for mesh in ["shape:cube-split", "shape:moebius", vase()] {
        let [six, nine, twelve, eighteen] = COUNTS.map(|(name, count)| {
            let document = json(mesh, name);
            assert_eq!(document["indices_per_patch"], count);
            let patches = patches(&document);
            assert!(patches.iter().all(|patch| patch.len() == count));
            let by_name = folder.path("OUT.BIN");
            let asked = folder.path("out.idx");
            output(&["adjacency", mesh, "--indices", name, "-o", &by_name]);
            output(&["adjacency", mesh, "--indices", name, "-o", &asked, "--format", "bin"]);
            let [by_name, asked] = [by_name, asked].map(|path| std::fs::read(path).expect("a file"));
            let piped = run(&["adjacency", mesh, "--indices", name, "-o", "-", "--format", "bin"]).stdout;
            assert!(by_name == asked && asked == piped, "{mesh} {name}");
            assert_eq!(indices(&piped), patches.concat(), "{mesh} {name}");
            patches
        });
        let triangles: Vec<Vec<u32>> = serde_json::from_value(json(mesh, "6")["triangles"].clone()).expect("lists");
        for (patch, twelve) in twelve.iter().enumerate() {
            assert_eq!(
                [&triangles[patch][..], &six[patch]].concat(),
                nine[patch],
                "nine are the triangle's own and the six"
            );
            assert_eq!(nine[patch], twelve[..9]);
            assert_eq!(*twelve, eighteen[patch][..12]);
        }
    }
    let named_otherwise = folder.path("out.bin");
    output(&["adjacency", "shape:torus", "-o", &named_otherwise, "--format", "json"]);
    assert!(std::fs::read(&named_otherwise).expect("a file").starts_with(b"{"));
    output(&["adjacency", "shape:torus", "--against", &named_otherwise]);
}

#[test]
fn the_json_lists_corners_triangles_and_patches() {
    let folder = Folder::new();
    let document = json("shape:cube-split", "9");
    let counts = ["positions", "normals", "uvs", "triangles", "patch_triangles", "patches"];
    let counts = counts.map(|list| document[list].as_array().map_or(0, Vec::len));
    assert_eq!(counts, [24, 24, 24, 12, 12, 12]);
    let mesh = write_degenerate(&folder);
    let document = json(&mesh, "6");
    assert_eq!(document["patch_triangles"], serde_json::json!([0, 2]));
    assert_eq!(document["triangles"], serde_json::json!([[0, 1, 2], [1, 1, 2], [1, 3, 2]]));
    assert_eq!(document["patches"], serde_json::json!([[0, 1, 1, 2, 2, 0], [1, 3, 3, 2, 2, 1]]));
    let said = run(&["adjacency", &mesh, "-o", &folder.path("out.bin")]).stderr;
    let said = String::from_utf8(said).expect("text");
    assert!(said.starts_with("pnaen: 1 of 3 triangles are degenerate"), "{said}");
}

#[test]
fn written_files_compare_equal_in_every_format_and_layout() {
    let folder = Folder::new();
    for (name, _) in COUNTS {
        for file in ["a.json", "a.bin", "a"] {
            let path = folder.path(file);
            let mesh = ["adjacency", vase(), "--indices", name];
            output(&[&mesh[..], &["-o", &path]].concat());
            let compared = run(&[&mesh[..], &["--against", &path]].concat());
            assert!(compared.status.success() && compared.stdout.is_empty(), "{compared:?}");
            let said = String::from_utf8(compared.stderr).expect("text");
            assert!(
                said.starts_with(&format!("pnaen: {path}: 0 of ")) && said.ends_with(" patches differ\n"),
                "{said}"
            );
        }
    }
    let [file, copy] = ["a.json", "copy.bin"].map(|name| folder.path(name));
    output(&["adjacency", vase(), "--indices", "18", "--against", &file, "-o", &copy]);
    output(&["adjacency", vase(), "--indices", "18", "--against", &copy]);
}

#[test]
fn differences_are_listed_with_patch_side_indices_and_meaning() {
    let folder = Folder::new();
    let path = folder.path("theirs.bin");
    let compare = || failure(&["adjacency", "shape:cube-split", "--against", &path], 1);
    let original = patches(&json("shape:cube-split", "9")).concat();
    let own = |patch: usize, k: usize| original[9 * patch + k];
    // Side 0-1 of patch 2 gets the patch's own corners, as if it were a boundary.
    let mut changed = original.clone();
    (changed[18 + 3], changed[18 + 4]) = (own(2, 0), own(2, 1));
    write_indices(&path, &changed);
    let said = compare();
    let lines: Vec<_> = said.lines().collect();
    let difference = format!(
        "pnaen: patch 2, side 0-1: the file has {}, {} (the patch's own) instead of {}, {}: other corners, same points, \
         other normals",
        own(2, 0),
        own(2, 1),
        own(2, 3),
        own(2, 4)
    );
    let summary = format!("pnaen: {path}: 1 of 12 patches differs: 1 (other corners, same points, other normals)");
    assert_eq!(lines, [difference, summary]);

    // Patch 0 starts at another corner, patch 4 has a side reversed, and patch 5 has a wrong side and swapped corners.
    changed[0..3].rotate_left(1);
    changed[3..9].rotate_left(2);
    changed.swap(36 + 5, 36 + 6);
    (changed[45 + 7], changed[45 + 8]) = (own(5, 1), own(5, 1));
    changed.swap(45, 46);
    write_indices(&path, &changed);
    let said = compare();
    assert_says(&said, &["patch 0, corners: ", "patch 2, side 0-1: ", "patch 4, side 1-2: ", "patch 5, corners: "]);
    assert!(said.contains("patch 5, side 2-0: ") && !said.contains("first"), "{said}");
    let summary = format!(
        "pnaen: {path}: 4 of 12 patches differ: 1 (the same patch, starting at another corner), 1 (other corners, same \
         points, other normals), 1 (the side's two corners exchanged), 1 (other points)\n"
    );
    assert!(said.ends_with(&summary), "{said}");

    // All patches have their sides in the neighbours' direction.
    let exchanged: Vec<_> =
        original.chunks(9).flat_map(|p| [p[0], p[1], p[2], p[4], p[3], p[6], p[5], p[8], p[7]]).collect();
    write_indices(&path, &exchanged);
    let said = compare();
    assert!(said.starts_with("pnaen: the first 10 of 36 differences:\n"), "{said}");
    assert_eq!(said.lines().count(), 12);
    assert!(said.ends_with(": 12 of 12 patches differ: 12 (the side's two corners exchanged)\n"), "{said}");
}

#[test]
fn json_and_bare_indices_are_compared_alike() {
    let folder = Folder::new();
    let [text, bare] = ["theirs.json", "theirs.bin"].map(|name| folder.path(name));
    let mesh = write_degenerate(&folder);
    let mut document = json(&mesh, "12");
    document["patches"][1][3] = 0.into();
    std::fs::write(&text, document.to_string()).expect("a writable folder");
    write_indices(&bare, &patches(&document).concat());
    let [text, bare] = [&text, &bare].map(|path| {
        let said = failure(&["adjacency", &mesh, "--indices", "12", "--against", path], 1);
        said.replace(path.as_str(), "FILE")
    });
    assert_eq!(text, bare);
    assert_says(
        &text,
        &[
            "patch 1 (triangle 2), side 0-1: ",
            " 0, 3 instead of 1, 3 (",
            "FILE: 1 of 2 patches differs: 1 (other points)",
        ],
    );
}

#[test]
fn errors_in_a_file_are_one_line_with_their_numbers() {
    let folder = Folder::new();
    let (text, bare) = (folder.path("wrong.json"), folder.path("wrong.bin"));
    let wrong = |path: &str, bytes: &[u8], words: &[&str]| {
        std::fs::write(path, bytes).expect("a writable folder");
        sentence(&["adjacency", "shape:cube-split", "--against", path], words);
    };
    let bin = run(&["adjacency", "shape:cube-split", "-o", "-", "--format", "bin"]).stdout;
    wrong(&bare, &bin[1..], &["wrong.bin", "431 bytes", "12 patches of 9 indices", "take 432"]);
    wrong(&bare, &bin[36..], &["wrong.bin", "396 bytes", "take 432"]);
    wrong(&bare, b"", &["it has 0 bytes"]);
    wrong(&bare, &[&bin[..], &bin[..144]].concat(), &["576 bytes", "(--indices 12 would fit)"]);
    wrong(&bare, &[&bin[..428], &[24, 0, 0, 0]].concat(), &["patch 11 has index 24", "corners are 0 to 23"]);
    wrong(&text, &bin, &["wrong.json: this is not JSON"]);
    wrong(&text, b"{\"indices_per_patch\": 9}", &["missing field `patches`"]);
    let document = json("shape:cube-split", "9").to_string();
    let six = json("shape:cube-split", "6").to_string();
    wrong(&text, six.as_bytes(), &["6 indices per patch", "--indices asks for 9"]);
    wrong(&bare, six.as_bytes(), &["6 indices per patch"]);
    let other = json("shape:icosahedron", "9").to_string();
    wrong(&text, other.as_bytes(), &["20 patches", "the mesh has 12"]);
    let smooth = json("shape:cube-smooth", "9").to_string();
    wrong(&text, smooth.as_bytes(), &["its positions differ", "first at index 8", "another mesh"]);
    wrong(&text, document.replacen("[[", "[[9,", 2).as_bytes(), &["wrong.json: this is not JSON"]);

    let compare = |path: &str| ["adjacency", "shape:cube-split", "--against", path].map(str::to_owned);
    for (path, words) in [
        ("nowhere.bin", ["nowhere.bin", "could not be read"]),
        (&folder.path(""), ["could not be read", "it is a folder"]),
    ] {
        sentence(&compare(path).each_ref().map(String::as_str), &words);
    }
    sentence(
        &["adjacency", "shape:cube-split", "--against", &text, "-o", &text],
        &["wrong.json is read by the same command"],
    );
    assert!(std::fs::read_to_string(&text).expect("a file").starts_with('{'), "the file is unchanged");
}

#[test]
fn a_file_with_patches_of_degenerate_triangles_is_recognised() {
    let folder = Folder::new();
    let (mesh, path) = (write_degenerate(&folder), folder.path("theirs.bin"));
    write_indices(&path, &[0; 27]);
    sentence(&["adjacency", &mesh, "--against", &path], &["108 bytes", "take 72", "degenerate triangles"]);
}

#[test]
fn a_file_to_write_or_to_compare_is_required() {
    let said = failure(&["adjacency", "shape:torus"], 2);
    assert!(said.contains("-o") && said.contains("--against"), "{said}");
}

#[test]
fn a_file_can_come_from_standard_input() {
    let bin = run(&["adjacency", "shape:torus", "-o", "-", "--format", "bin"]).stdout;
    let json = output(&["adjacency", "shape:torus", "-o", "-"]).into_bytes();
    for bytes in [bin, json] {
        let mut child = command(&["adjacency", "shape:torus", "--against", "-"])
            .stdin(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        child.stdin.take().expect("a pipe").write_all(&bytes).expect("it reads");
        let output = child.wait_with_output().expect("the program ends");
        assert!(output.status.success(), "{output:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "pnaen: standard input: 0 of 256 patches differ\n");
    }
}

#[test]
fn corners_for_displacement_have_their_directions_and_shortest_edges() {
    let folder = Folder::new();
    let (image, out) = (folder.path("heights.png"), folder.path("corners.bin"));
    image::GrayImage::from_fn(32, 16, |x, _| image::Luma([8 * x as u8])).save(&image).expect("a writable folder");
    output(&["adjacency", "shape:cube-split", "--corners", &out, "--height", &image]);
    let bytes = std::fs::read(&out).expect("a file");
    let numbers: Vec<_> = bytes.chunks(4).map(|own| f32::from_le_bytes(own.try_into().expect("four bytes"))).collect();
    assert_eq!(numbers.len(), 24 * 10, "a cube has 24 corners");
    let document = json("shape:cube-split", "9");
    for (corner, own) in numbers.chunks(10).enumerate() {
        // Each point of a cube moves away from its middle. A face has the whole image, and 16 px is the length of its shorter sides.
        let place = |axis: usize| document["positions"][corner][axis].as_f64().expect("a number");
        for axis in 0..3 {
            let expected = place(axis).signum() / 3.0f64.sqrt();
            assert!((f64::from(own[axis]) - expected).abs() < 1e-5, "corner {corner}: {own:?}");
        }
        assert_eq!(own[9], 16.0, "corner {corner}");
    }
    // The image is needed, and it must be of all triangles.
    failure(&["adjacency", "shape:cube-split", "--corners", &out], 2);
    failure(&["adjacency", "shape:cube-split", "--height", &image, "-o", &out], 2);
}
