//! `--cameras`, and `--view-projection` with the matrices that stats print.

use std::path::Path;

use serde_json::Value;

use crate::{Folder, SIMPLE_LIGHT, failure, number, output, run, sentence};

fn json(path: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).expect("a file")).expect("JSON")
}

fn picture(path: &str) -> image::RgbaImage {
    image::open(path).expect("a picture").into_rgba8()
}

/// The matrix of stats, as it is printed there.
fn matrix(stats: &Value) -> String {
    stats.pointer("/camera/view_projection").expect("a matrix").to_string()
}

#[test]
fn many_views_are_drawn_by_one_command_and_a_matrix_from_stats_draws_one_again() {
    let folder = Folder::new();
    let [views, stats, again] = ["views", "stats.json", "again.png"].map(|name| folder.path(name));
    let torus = ["render", "shape:torus", "--size", "80x60", "--lod", "paper", "--measure-error", "false"];
    let base = [&torus[..], &SIMPLE_LIGHT].concat();
    let around = |more: &[&str]| run(&[&base[..], &["--cameras", "3"], more].concat());
    let drawn = around(&["-o", &views, "--stats", &stats]);
    assert!(drawn.status.success(), "{}", String::from_utf8_lossy(&drawn.stderr));
    let all = json(&stats);
    let all = all.as_array().expect("an array");
    let names: Vec<_> = all.iter().map(|own| own["view"].as_str().expect("a name")).collect();
    assert_eq!(names, ["view-0", "view-1", "view-2"]);
    // The heights of a spherical Fibonacci point set of three: 2/3, 0 and -2/3.
    let heights: Vec<_> = all.iter().map(|own| -number(own, "/camera/direction/1")).collect();
    assert!(heights.iter().zip([2.0 / 3.0, 0.0, -2.0 / 3.0]).all(|(a, b)| (a - b).abs() < 1e-5), "{heights:?}");
    let own = picture(&folder.path("views/view-1.png"));
    let matrix = matrix(&all[1]);
    output(&[&base[..], &["-o", &again, "--depth", "reversed", "--view-projection", &matrix]].concat());
    assert_eq!(picture(&again), own, "the same numbers land points at the same places");
    let reference = around(&["-o", &folder.path("now-{}.png"), "--reference", &views]);
    let said = String::from_utf8_lossy(&reference.stderr).into_owned();
    assert!(reference.status.success() && said.matches(" is the same as ").count() == 3, "{said}");
    let differs = around(&["-o", &folder.path("{}.png"), "--reference", &views, "--background", "000000"]);
    let said = String::from_utf8_lossy(&differs.stderr).into_owned();
    assert!(differs.status.code() == Some(1) && said.contains("3 of 3 pictures differ"), "{said}");
    assert!(
        said.contains("and none may since the same adapter") && Path::new(&folder.path("view-2-diff.png")).exists(),
        "{said}"
    );
}

#[test]
fn views_of_a_file_have_its_names_and_other_files_are_refused() {
    let folder = Folder::new();
    let [cameras, out] = ["cameras.txt", "out-{}.png"].map(|name| folder.path(name));
    let cone = [&["render", "shape:cone", "--size", "60x40", "--factor", "3"][..], &SIMPLE_LIGHT].concat();
    let base = [&cone[..], &["--cameras", &cameras]].concat();
    std::fs::write(&cameras, "# two\nfront --camera 0,0\n'from above' --camera 0,80,3 --orthographic\n")
        .expect("a file");
    output(&[&base[..], &["-o", &out]].concat());
    let [front, above] = ["out-front.png", "out-from above.png"].map(|name| picture(&folder.path(name)));
    assert_ne!(front, above);
    let single = folder.path("single.png");
    output(&[&cone[..], &["--camera", "0,80,3", "--orthographic", "-o", &single]].concat());
    assert_eq!(picture(&single), above);
    std::fs::write(&cameras, "front --camera 0,0\nback --zoom 2\n").expect("a file");
    sentence(&[&base[..], &["-o", &out]].concat(), &["cameras.txt", "line 2", "--zoom"]);
    for text in ["\u{feff}front --camera 0,0\r\n", "\u{feff}[{\"name\": \"front\", \"camera\": [0, 0]}]\r\n"] {
        std::fs::write(&cameras, text).expect("a file");
        output(&[&base[..], &["-o", &out]].concat());
    }
    std::fs::write(&cameras, "a --camera 0,0\nA --camera 1,0\n").expect("a file");
    sentence(&[&base[..], &["-o", &out]].concat(), &["cameras.txt", "two cameras are called A"]);
    let one = failure(&["render", "shape:cone", "--cameras", "2", "-o", &folder.path("a.png")], 2);
    assert!(one.contains("name a folder"), "{one}");
    let beside = failure(&[&base[..], &["-o", &out, "--roll", "3"]].concat(), 2);
    assert!(beside.contains("--roll"), "{beside}");
}

#[test]
fn meshes_and_factors_of_many_views_are_those_of_each_view_alone() {
    let folder = Folder::new();
    let cameras = folder.path("cameras.txt");
    let views = [("near", "0,0,1.5"), ("far", "90,10,6")];
    let lines = views.map(|(name, camera)| format!("{name} --camera {camera}\n"));
    std::fs::write(&cameras, lines.concat()).expect("a writable folder");
    let lod = ["--size", "80x60", "--lod", "paper", "--pixels", "6"];
    for device in ["cpu", "gpu"] {
        let many = |command: &str, place: &str| {
            output(
                &[&[command, "shape:torus", "-o", place, "--cameras", &cameras, "--device", device], &lod[..]].concat(),
            );
        };
        many("tessellate", &folder.path(&format!("{device}-{{}}.obj")));
        many("factors", &folder.path(device));
        for (command, of_many) in
            [("tessellate", format!("{device}-VIEW.obj")), ("factors", format!("{device}/VIEW.csv"))]
        {
            let read = |name: &str| std::fs::read(folder.path(name)).expect("a file");
            let both = views.map(|(name, camera)| {
                let (of_many, alone) =
                    (of_many.replace("VIEW", name), of_many.replace(&format!("{device}/"), "alone-"));
                let view = ["-o", &folder.path(&alone), "--camera", camera, "--device", device];
                output(&[&[command, "shape:torus"], &view[..], &lod].concat());
                assert!(read(&of_many) == read(&alone), "{command} on {device} from {name}");
                read(&of_many)
            });
            assert_ne!(both[0], both[1], "LOD follows the view");
        }
    }
}

#[test]
fn gates_judge_the_mesh_of_each_view_and_one_file_is_too_few() {
    let folder = Folder::new();
    let evidence = folder.path("evidence");
    let cube = ["tessellate", "shape:cube-split", "--surface", "pn", "--factor", "8"];
    let base = [&cube[..], &["--size", "80x60", "--cameras", "2"]].concat();
    let gates = ["--fail-on", "cracks,leaks", "--evidence", &evidence, "-o", &folder.path("m-{}.glb")];
    let said = failure(&[&base[..], &gates].concat(), 1);
    for line in
        ["shape:cube-split from view-0 fails the gate cracks", "shape:cube-split from view-1 fails the gate leaks"]
    {
        assert!(said.contains(line), "{said}");
    }
    for name in ["m-view-0-cracks.png", "m-view-1-leaks.png"] {
        assert!(Path::new(&evidence).join(name).exists(), "{name}");
    }
    let one = failure(&[&base[..], &["-o", &folder.path("a.glb")]].concat(), 2);
    assert!(one.contains("--cameras writes several meshes: put {} into the name"), "{one}");
    for place in ["-", &folder.path("a.csv")] {
        let one = failure(&["factors", "shape:torus", "--cameras", "2", "-o", place], 2);
        assert!(one.contains("--cameras writes several files: name a folder"), "{one}");
    }
    for (command, place) in [("tessellate", "{}.glb"), ("factors", "csv")] {
        let both = [command, "shape:torus", "-o", &folder.path(place), "--cameras", "2", "--camera", "1,2"];
        assert!(failure(&both, 2).contains("--camera <"), "{command}");
    }
}

#[test]
fn what_is_no_file_of_cameras_is_refused_in_a_sentence() {
    let folder = Folder::new();
    let (cameras, out) = (folder.path("cameras \u{e4}.txt"), folder.path("out"));
    let matrix = r#"[{"name": "engine", "view_projection": [0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]}]"#;
    for (text, words) in [
        ("", &["it has 0 cameras; a command takes 1 to 3600"][..]),
        ("# nothing\n", &["it has 0 cameras"]),
        ("[]", &["it has 0 cameras"]),
        ("a --camera nan,0", &["line 1", "AZIMUTH,ELEVATION"]),
        (r#"[{"name": "a", "camera": [NaN, 0]}]"#, &["it is no JSON", "line 1"]),
        (matrix, &["engine: w isn't above 0 anywhere"]),
    ] {
        std::fs::write(&cameras, text).expect("a writable folder");
        let named = if text == matrix { "engine" } else { "cameras \u{e4}.txt" };
        for command in ["render", "factors"] {
            let torus = [command, "shape:torus", "--factor", "1", "-o", &out, "--cameras", &cameras];
            sentence(&torus, &[words, &[named]].concat());
        }
    }
    std::fs::write(&cameras, [0xff, 0xfe]).expect("a writable folder");
    let torus = ["render", "shape:torus", "--factor", "1", "-o", &out, "--cameras"];
    sentence(&[&torus[..], &[&cameras]].concat(), &["isn't text in UTF-8"]);
    std::fs::write(&out, "").expect("a writable folder");
    sentence(&[&torus[..], &["2"]].concat(), &["out", "there is a file of this name"]);
    assert_eq!(std::fs::read(&out).expect("a file"), b"", "it is left alone");
}

#[test]
fn a_matrix_is_a_camera_for_factors_and_pictures_under_every_convention() {
    let folder = Folder::new();
    let stats = folder.path("stats.json");
    let view = ["--size", "120x90", "--lod", "paper", "--clip", "frustum", "--camera", "70,-15,2"];
    let [own, csv, other, mirrored] = ["own.png", "own.csv", "other.csv", "mirrored.png"].map(|name| folder.path(name));
    let drawn = ["render", "shape:torus", "-o", &own, "--stats", &stats, "--measure-error", "false"];
    output(&[&drawn[..], &view].concat());
    output(&[&["factors", "shape:torus", "-o", &csv], &view[..]].concat());
    let matrix: Vec<f64> = serde_json::from_str(&matrix(&json(&stats))).expect("numbers");
    // By rows, with Vulkan's y.
    let by_rows = |rows: [f64; 4]| {
        let entry = |i: usize| (matrix[i % 4 * 4 + i / 4] * rows[i / 4]).to_string();
        (0..16).map(entry).collect::<Vec<_>>().join(" ")
    };
    let options = ["--size", "120x90", "--lod", "paper", "--clip", "frustum", "--matrix-order", "row-major"];
    let depth = ["--depth", "reversed", "--view-projection"];
    let vulkan = by_rows([1.0, -1.0, 1.0, 1.0]);
    output(&[&["factors", "shape:torus", "-o", &other, "--clip-y", "down"], &options[..], &depth, &[&vulkan]].concat());
    let [csv, other] = [csv, other].map(|path| std::fs::read_to_string(path).expect("a file"));
    assert_eq!(csv, other, "the same bits of the rows give the same factors");
    let mirror = by_rows([-1.0, 1.0, 1.0, 1.0]);
    output(&[&["render", "shape:torus", "-o", &mirrored], &options[..], &depth, &[&mirror]].concat());
    assert_eq!(image::imageops::flip_horizontal(&picture(&mirrored)), picture(&own));
    let split = [&["render", "shape:torus", "-o", &mirrored, "--split", "0.5"], &options[..], &depth, &[&mirror]];
    assert!(failure(&split.concat(), 2).contains("mirrors"));
}

#[test]
fn what_is_no_matrix_is_refused_in_a_sentence() {
    let folder = Folder::new();
    let out = folder.path("out.png");
    let base = ["render", "shape:torus", "-o", &out, "--view-projection"];
    let few = failure(&[&base[..], &["1 2 3 4 5 6 7 8 9 10 11 12 13 14 15"]].concat(), 2);
    assert!(few.contains("expected 16 numbers, found 15"), "{few}");
    let nan = failure(&[&base[..], &["1 0 0 0 0 1 0 0 0 0 nan -1 0 0 1 2"]].concat(), 2);
    assert!(nan.contains("number 11 is nan"), "{nan}");
    sentence(&[&base[..], &["1 1 0 0 2 2 0 0 3 3 0 -1 0 0 1 2"]].concat(), &["singular"]);
    sentence(&[&base[..], &["1 0 0 0 0 1 0 0 0 0 0 -1 0 0 1 2"]].concat(), &["--depth"]);
    let turned = [
        "turntable",
        "shape:torus",
        "-o",
        &folder.path("turn"),
        "--view-projection",
        "1 0 0 0 0 1 0 0 0 0 0 -1 0 0 1 2",
    ];
    assert!(failure(&turned, 2).contains("turntable"));
    assert!(!Path::new(&out).exists());
}
