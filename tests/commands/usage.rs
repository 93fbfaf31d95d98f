//! Errors and exit codes of all commands, and the program without a display.

use std::path::Path;

use crate::{Folder, command, failure, output, run, sentence};

#[test]
fn failures_are_one_line_and_exit_code_1() {
    let folder = Folder::new();
    let [out, text, broken] = ["out.png", "notes.txt", "broken.gltf"].map(|name| folder.path(name));
    std::fs::write(&text, "no mesh").expect("a writable folder");
    std::fs::write(&broken, "{\"asset\":").expect("a writable folder");
    sentence(&["info", "nowhere.glb"], &["nowhere.glb", "can't be read"]);
    sentence(&["info", &text], &["notes.txt", ".gltf, .glb, .vrm, .fbx, .obj, .stl, .ply, .off or .3mf"]);
    sentence(&["info", &folder.path("")], &["is not a file"]);
    sentence(&["info", &broken], &["broken.gltf", "not a glTF 2.0 document"]);
    sentence(
        &["render", "shape:torus", "-o", &folder.path("no/such/folder/out.png")],
        &["out.png", "there is no folder", "no/such/folder"],
    );
    sentence(
        &["render", "shape:torus", "-o", &out, "--reference", "nowhere.png"],
        &["nowhere.png", "could not be read", "there is no such file or folder"],
    );
    let said = failure(&["tessellate", "shape:torus", "-o", &folder.path("out.stl")], 2);
    assert!(said.contains(".glb or .obj"), "{said}");
    // A missing folder is an error before anything is drawn, measured or emitted.
    let nowhere = folder.path("nowhere/out");
    for [command, option, ending] in
        [["render", "-o", ".png"], ["tessellate", "-o", ".obj"], ["chart", "-o", ".svg"], ["chart", "--csv", ".csv"]]
    {
        let output = format!("{nowhere}{ending}");
        sentence(&[command, "shape:torus", option, &output], &["there is no folder ", "nowhere"]);
    }
    sentence(&["info", &folder.path("missing.glb")], &["missing.glb can't be read", "no such file"]);
    sentence(&["domain", "--partitioning", "integer", "--input", &text], &["notes.txt, line 1", "four numbers"]);
}

#[test]
fn a_picture_too_large_for_the_device_is_an_error_of_one_line() {
    let folder = Folder::new();
    let path = folder.path("out.png");
    let output = run(&["render", "shape:torus", "--factor", "1", "-o", &path, "--size", "16384x16384"]);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    // A device with enough memory may draw it.
    assert!(output.status.success() || output.status.code() == Some(1), "{errors}");
    assert!(errors.lines().count() <= 1 && !errors.contains("panicked"), "{errors}");
    assert_eq!(output.status.success(), Path::new(&path).exists());
}

#[test]
fn wrong_usage_exits_with_2() {
    let folder = Folder::new();
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
        &["adjacency", "shape:torus", "--format", "csv", "-o", "-"],
        &["adjacency", "shape:torus", "--format", "bin", "--against", "-"],
        &["info", "shape:torus", "--weld", "0.2"],
        &["info", "shape:torus", "--weld", "-1"],
        &["info", "shape:torus", "--weld=-0.001"],
        &["info", "shape:torus", "--weld", "nan"],
        &["render", "shape:torus", "-o", "x.png", "--weld=-0.001"],
        &["tessellate", "shape:torus", "-o", "x.glb", "--weld", "nan"],
        &["stability", "shape:torus", "--device", "cpu", "--weld=-0.001"],
        &["stability", "shape:torus", "--device", "cpu", "--weld", "nan"],
        &["info", "shape:torus", "--crease-band", "0.11"],
        &["render", "shape:torus", "-o", "x.png", "--rim=-0.001"],
        &["stability", "shape:torus", "--device", "cpu", "--rim", "nan"],
        &["render", "shape:torus", "-o", "x.png", "--edges", "published"],
        &["render", "shape:torus", "-o", "x.png", "--lod", "edgelength"],
        &["tessellate", "shape:torus", "-o", "x.glb", "--lod", "edge_length"],
        &["render", "shape:torus", "-o", "x.png", "--clip", "frustrum"],
        &["tessellate", "shape:torus", "-o", "x.glb", "--clip", "frusta"],
        &["render", "shape:torus", "-o", "-"],
        &["render", "shape:torus", "-o", "x.json"],
        &["render", "shape:torus", "-o", "x.png", "--threshold", "3"],
        &["compare", "shape:torus", "--mesh", "shape:torus", "-o", "theirs.obj"],
        &["frobnicate", "--hard"],
    ] {
        // If a command wrote a file by mistake, it would be in this folder.
        let output = command(arguments).current_dir(&folder.0).output().expect("the program starts");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    }
    assert_eq!(std::fs::read_dir(&folder.0).expect("its folder").count(), 0, "nothing is written");
}

#[test]
fn adapter_and_the_cpu_exclude_each_other() {
    for arguments in [
        &["domain", "--partitioning", "integer", "--factors", "2,2,2,2"][..],
        &["tessellate", "shape:torus", "-o", "never.obj"],
        &["factors", "shape:torus", "-o", "never.csv"],
        &["stability", "shape:torus"],
    ] {
        let arguments: Vec<_> = arguments.iter().copied().chain(["--adapter", "software", "--device", "cpu"]).collect();
        let said = failure(&arguments, 2);
        assert!(said.contains("--adapter") && said.contains("--device cpu"), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
}

#[test]
fn without_a_display_the_program_writes_a_picture_without_the_settings_of_the_window() {
    let folder = Folder::new();
    std::fs::write(folder.path("window.json"), r#"{"settings": {"surface": "flat", "background": [255, 0, 0]}}"#)
        .expect("a writable folder");
    let pictures = [None, Some(""), Some(&*folder.path(""))].map(|kept| {
        let mut preview = command(&[]);
        preview.env_remove("PNAEN_CONFIG").envs(kept.map(|kept| ("PNAEN_CONFIG", kept)));
        let output = preview.current_dir(&folder.0).output().expect("the program starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(said.contains("no display") && said.contains("pnaen-preview.png"), "{said}");
        assert_eq!(said.lines().count(), 1);
        std::fs::read(folder.path("pnaen-preview.png")).expect("a picture")
    });
    assert!(pictures.iter().all(|own| *own == pictures[0]), "the same picture with settings and without");
    let picture = image::load_from_memory(&pictures[0]).expect("a PNG file");
    assert_eq!((picture.width(), picture.height()), (1280, 720));
    std::fs::write(folder.path("window.json"), "damaged").expect("a writable folder");
    let mut info = command(&["info", "shape:torus"]);
    assert!(info.env("PNAEN_CONFIG", folder.path("")).output().expect("the program starts").status.success());
    assert_eq!(std::fs::read(folder.path("window.json")).expect("it is still there"), b"damaged");
    let missing = command(&["nowhere.glb"]).current_dir(&folder.0).output().expect("the program starts");
    assert_eq!(missing.status.code(), Some(1));
    // With a display, too.
    let mut mistyped = command(&["rendr"]);
    let mistyped = mistyped.env("DISPLAY", ":0").current_dir(&folder.0).output().expect("the program starts");
    assert_eq!(mistyped.status.code(), Some(1));
    let said = String::from_utf8_lossy(&mistyped.stderr);
    assert_eq!(said, "pnaen: rendr can't be read: there is no such file, and no such command; see pnaen --help\n");
}

#[test]
fn a_unit_in_which_numbers_reach_too_far_is_refused() {
    let folder = Folder::new();
    let mesh = folder.path("large.obj");
    std::fs::write(&mesh, "v 0 0 0\nv 1e36 0 0\nv 1e36 1e36 0\nf 1 2 3\n").expect("a writable folder");
    sentence(&["info", &mesh, "--unit", "1000"], &["large.obj", "has coordinates beyond 1e37 in this unit"]);
}

#[test]
fn two_overlays_that_colour_the_surface_are_wrong_usage() {
    let folder = Folder::new();
    let picture = folder.path("out.png");
    let overlays =
        |list| ["render", "shape:torus", "--factor", "2", "-o", &picture, "--size", "60x40", "--overlay", list];
    for list in [
        "barycentric,factors",
        "triangle-size,wireframe,low-factors",
        "deviation,factors",
        "excess,low-factors",
        "clay,zebra",
    ] {
        let errors = failure(&overlays(list), 2);
        assert!(errors.contains("--overlay can't be"), "{errors}");
        assert!(!Path::new(&picture).exists(), "nothing is drawn");
    }
    output(&overlays("triangle-size, wireframe, normals ,back-faces"));
}

#[test]
fn what_an_option_takes_is_said() {
    let render = |option: &str, value: &str| failure(&["render", "shape:torus", "-o", "x.png", option, value], 2);
    for (said, words) in [
        (render("--select", "x"), "expected a whole number, 0 or more"),
        (render("--max-triangles", "0"), "expected a whole number, 1 or more"),
        (render("--arena", "0.5"), "expected a whole number from 1 to 65536"),
        (render("--view-projection", "1 2 x"), "expected 16 numbers, and number 3 is x"),
        (failure(&["check", "shape:torus", "--jobs", "0"], 2), "expected a whole number from 1 to 256"),
        (failure(&["info", "shape:teapot"], 2), "torus, cylinder, cone, saddle, bicubic, moebius, or vase"),
        (failure(&["info", "shape:vase@1"], 2), "vase has no levels; leave out the @"),
    ] {
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn pictures_must_be_png_files() {
    let folder = Folder::new();
    let errors = failure(&["render", "shape:cube-split", "-o", &folder.path("out.jpg")], 2);
    assert!(errors.contains("PNG") && errors.contains(".jpg"), "{errors}");
}

#[test]
fn a_mesh_of_degenerate_triangles_alone_has_nothing_to_show() {
    let folder = Folder::new();
    let path = folder.path("line.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nf 1 2 2\n").expect("a writable temporary folder");
    let words = ["no triangles to show", "each of its 1 triangles has two corners on one point"];
    sentence(&["render", &path, "-o", &folder.path("out.png")], &words);
    sentence(&["info", &path], &words);
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 1 1e-4 0\nf 1 2 3\n").expect("a writable temporary folder");
    sentence(&["info", &path, "--weld", "0.01"], &["two corners on one point, within the tolerance of --weld"]);
    output(&["info", &path]);
}

#[test]
fn files_beyond_the_limit_are_refused() {
    let vase = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/vase.glb");
    sentence(&["info", vase, "--max-size", "10KiB"], &["vase.glb has ", "at most 10240 ", "--max-size"]);
    sentence(&["--max-size", "10KiB", vase], &["vase.glb has ", "at most 10240 "]);
    sentence(
        &["render", "shape:torus", "--reference-surface", vase, "--max-size", "1", "-o", "unwritten.png"],
        &["vase.glb has ", "at most 1 "],
    );
    output(&["info", vase, "--max-size", "11 KiB"]);
    sentence(
        &["info", vase, "--max-memory", "1"],
        &["vase.glb: ", "MiB of memory, but files of this size may take only 4", " KiB (--max-memory allows more); "],
    );
    output(&["info", vase, "--max-memory", "1MiB"]);
    for option in ["--max-size", "--max-memory"] {
        for size in ["0", "1.5GiB", "much"] {
            let errors = failure(&["info", vase, option, size], 2);
            assert!(errors.contains("or of KiB, MiB or GiB"), "{errors}");
        }
    }
}

/// A glTF document of one triangle, with a member added to its accessor.
fn document(member: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"componentType":5126,"type":"VEC3","count":3,"bufferView":0{member}}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "buffers":[{{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}]}}"#
    )
}

#[test]
fn hostile_files_are_one_line_and_exit_code_1() {
    let folder = Folder::new();
    let write = |name: &str, bytes: &[u8]| {
        std::fs::write(folder.path(name), bytes).expect("a writable folder");
        folder.path(name)
    };
    output(&["info", &write("sound.gltf", document("").as_bytes())]);
    let past = write("past.gltf", document(r#","byteOffset":4611686018427387904"#).as_bytes());
    let expected = ["past.gltf: /accessors/0 (POSITION of /meshes/0/primitives/0)", "/bufferViews/0, which has 36;"];
    sentence(&["info", &past], &expected);
    let deep = write("deep.gltf", "[".repeat(100_000).as_bytes());
    sentence(&["render", &deep, "-o", &folder.path("none.png")], &["deep.gltf", "100000 levels", "at most 100 levels"]);
    let elsewhere = document("").replace("data:;base64,", "../%2e%2e/");
    sentence(&["info", &write("elsewhere.gltf", elsewhere.as_bytes())], &["/buffers/0", "leads out of a folder"]);
    let unknown = document("").replace(r#""nodes""#, r#""extensionsRequired":["EXT_unknown"],"nodes""#);
    sentence(&["info", &write("unknown.gltf", unknown.as_bytes())], &["unknown.gltf", "EXT_unknown"]);
    let chunk = [&b"glTF"[..], &[2, 0, 0, 0], &[24, 0, 0, 0], &[255; 4], b"JSON", b"{}  "].concat();
    sentence(&["info", &write("chunk.glb", &chunk)], &["chunk 0", "4294967295 bytes", "but 4 "]);
}

#[test]
fn devices_are_refused_and_not_read() {
    let folder = Folder::new();
    let picture = folder.path("none.png");
    let device = "it is a device";
    sentence(&["render", "shape:torus", "-o", &picture, "--factors", "/dev/zero"], &["/dev/zero", device]);
    sentence(&["adjacency", "shape:torus", "--against", "/dev/zero"], &["/dev/zero", device]);
    sentence(
        &["render", "shape:torus", "-o", &picture, "--reference", "/dev/zero"],
        &["/dev/zero", "it is not a file"],
    );
    sentence(&["info", "/dev/zero"], &["/dev/zero is not a file"]);
    let text = folder.write("text.png", "no image");
    sentence(&["render", "shape:torus", "-o", &picture, "--reference", &text], &["text.png", "it is no image"]);
}
