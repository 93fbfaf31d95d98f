//! `--animation` and `--time`, with every command that tessellates.

use serde_json::{Value, json};

use crate::{Folder, SIMPLE_LIGHT, both, failure, output, run, sentence, vase};
use documents::moving::moving;

fn file(folder: &Folder) -> String {
    let path = folder.path("moving.glb");
    std::fs::write(&path, moving()).expect("a writable temporary folder");
    path
}

#[test]
fn stats_of_a_pose_name_it_and_count_no_cracks() {
    let folder = Folder::new();
    let file = file(&folder);
    let picture = |name: &str, options: &[&str]| {
        let picture = folder.path(name);
        let usual = ["render", &file, "-o", &picture, "--size", "200x160", "--factor", "4", "--stats", "-"];
        let all = [&usual[..], &SIMPLE_LIGHT, &["--measure-error", "false"], options].concat();
        let stats: Value = serde_json::from_str(&output(&all)).expect("JSON");
        (std::fs::read(&picture).expect("a picture"), stats)
    };
    let (rest, stats) = picture("rest.png", &[]);
    assert!(stats["animation"].is_null());
    let (bent, stats) = picture("bent.png", &["--animation", "All", "--time", "0.6"]);
    assert_eq!(stats["animation"], json!({ "name": "All", "time": 0.6 }));
    assert_eq!(stats["cracks"]["different_bits"], 0);
    assert_eq!(stats["leaks"], 0);
    assert!(stats["ms"]["deform"].as_f64().is_some());
    let (start, _) = picture("start.png", &["--animation", "All"]);
    assert!(rest != bent && bent != start);
}

#[test]
fn the_left_half_of_a_split_may_have_a_pose_of_its_own() {
    let folder = Folder::new();
    let (file, out) = (file(&folder), folder.path("picture.png"));
    let draw = |options: &[&str]| {
        let view = ["--camera", "30,20,3", "--target", "0,0,0", "--size", "160x120", "--factor", "3", "-o", &*out];
        output(&[&["render", &*file], &view[..], &SIMPLE_LIGHT, options].concat());
        image::open(&out).expect("a picture").to_rgba8()
    };
    let [early, late] = ["0.2", "0.6"].map(|time| ["--animation", "All", "--time", time]);
    let split = [&late[..], &["--split", "0.5", "--split-left", "pn-aen"]].concat();
    let [left, right] = [draw(&early), draw(&late)];
    let both = draw(&[&split[..], &["--split-time", "0.2"]].concat());
    assert!(left != right);
    // But for the last column: the software driver lets a sample of the right half in there.
    for (x, y, pixel) in both.enumerate_pixels().filter(|(x, ..)| *x != 79) {
        let expected = if x < 80 { left.get_pixel(x, y) } else { right.get_pixel(x, y) };
        assert_eq!(pixel, expected, "{x}, {y}");
    }
    let same = draw(&split);
    assert!(same != both && same == draw(&[&split[..], &["--split-time", "0.6"]].concat()));
    let stats = |own: &[&str]| crate::stats(&[&[&*file], &split[..], own].concat());
    let other = stats(&["--split-animation", "Bend", "--split-time", "0.5"]);
    assert_eq!(other["animation"], json!({ "name": "All", "time": 0.6 }));
    assert_eq!(other["left"]["animation"], json!({ "name": "Bend", "time": 0.5 }));
    assert_eq!(stats(&[])["left"]["animation"], json!({ "name": "All", "time": 0.6 }), "without options the same");
    assert!(stats(&["--split-animation", "rest"])["left"]["animation"].is_null());
    // A surface to compare with doesn't move.
    let own = [&*file, "--split", "0.5", "--reference-surface", "shape:torus", "--split-animation"];
    let said = failure(&[&["render", "-o", &*out], &own[..], &["Bend"]].concat(), 2);
    assert!(said.contains("--split-animation"), "{said}");
    assert!(crate::stats(&[&own[..], &["rest"]].concat())["left"]["animation"].is_null());
    let command = |mesh: &'static str, own: &[&'static str]| [&["render", mesh, "-o", "a.png"], own].concat();
    let own = ["--split", "0.5", "--split-animation", "Bend"];
    sentence(&command("shape:torus", &own), &["has no animation \"Bend\"", "it has none"]);
    let unknown = ["render", &*file, "-o", &*out, "--split", "0.5", "--split-animation", "Walk"];
    assert!(failure(&unknown, 1).contains("has no animation \"Walk\": it has Bend, Swell, Fly, All"));
    for bad in ["nan", "-1", "soon"] {
        failure(&command("shape:torus", &[&own[..], &["--split-time", bad]].concat()), 2);
    }
    let said = failure(&command("shape:torus", &["--split", "0.5", "--split-time", "1"]), 2);
    assert!(said.contains("--split-time needs --split-animation"), "{said}");
    assert!(failure(&command("shape:torus", &own[2..]), 2).contains("--split"));
}

#[test]
fn both_devices_write_the_pose() {
    let folder = Folder::new();
    let file = file(&folder);
    let extent = |device: &str, options: &[&str]| {
        let path = folder.path("out.obj");
        output(&[&["tessellate", &file, "-o", &path, "--factor", "4", "--device", device], options].concat());
        let text = std::fs::read_to_string(path).expect("a mesh");
        let xs = text.lines().filter_map(|line| line.strip_prefix("v ")?.split(' ').next()?.parse::<f64>().ok());
        xs.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| [least.min(x), most.max(x)])
    };
    let rest = extent("cpu", &[]);
    let pose = ["--animation", "Bend", "--time", "0.5"];
    let [gpu, cpu] = ["gpu", "cpu"].map(|device| extent(device, &pose));
    // The clip bends the mesh over, towards -x.
    assert!(rest[0] > -0.9 && gpu[0] < -1.5, "{rest:?} {gpu:?}");
    assert!((gpu[0] - cpu[0]).abs() < 1e-4 && (gpu[1] - cpu[1]).abs() < 1e-4, "{gpu:?} {cpu:?}");
    let factors = |options: &[&str]| {
        let lod = ["factors", &file, "-o", "-", "--lod", "edge-length"];
        output(&[&lod[..], &["--device", "cpu"], options].concat())
    };
    assert_ne!(factors(&[]), factors(&pose));
}

#[test]
fn chosen_weights_of_morph_targets_give_the_shape_of_a_clip_that_has_them() {
    let folder = Folder::new();
    let file = file(&folder);
    let positions_on = |device: &str, options: &[&str]| {
        let path = folder.path("out.obj");
        output(&[&["tessellate", &file, "-o", &path, "--factor", "3", "--device", device], options].concat());
        let text = std::fs::read_to_string(path).expect("a mesh");
        let vertices = text.lines().filter_map(|line| line.strip_prefix("v "));
        vertices
            .flat_map(|own| own.split(' ').map(|x| x.parse::<f64>().expect("a number")).collect::<Vec<_>>())
            .collect()
    };
    let positions = |options: &[&str]| positions_on("cpu", options);
    let largest = |a: &Vec<f64>, b: &Vec<f64>| {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let rest = positions(&[]);
    // At its end the clip has these weights.
    let clip = positions(&["--animation", "Swell", "--time", "1.5"]);
    let chosen = positions(&["--morph", "Swell=1", "--morph", "Lean=-1"]);
    assert!(largest(&clip, &chosen) < 1e-4 && largest(&rest, &chosen) > 0.5);
    let moved = positions(&["--morph", "Swell=0.5", "--animation", "Swell", "--time", "1.5"]);
    assert_eq!(clip, moved, "a clip that moves a target goes on doing so");
    let bent = ["--animation", "Bend", "--time", "0.5"];
    let swollen = ["--morph", "Swell=1", "--morph", "Lean=0"];
    let [gpu, cpu] = ["gpu", "cpu"].map(|device| positions_on(device, &[&bent[..], &swollen].concat()));
    assert!(
        largest(&gpu, &cpu) < 1e-4 && largest(&gpu, &positions(&bent)) > 0.1,
        "a clip that doesn't keeps its weight"
    );
    let picture = folder.path("posed.png");
    let moving = ["--morph", "Lean=1", "--animation", "Bend", "--time", "0.3", "--size", "200x160", "--factor", "4"];
    let counted = ["-o", &picture, "--stats", "-", "--measure-error", "false"];
    let drawn = output(&[&["render", &file], &moving[..], &SIMPLE_LIGHT, &counted].concat());
    let stats: Value = serde_json::from_str(&drawn).expect("JSON");
    assert_eq!((&stats["cracks"]["different_bits"], &stats["leaks"]), (&json!(0), &json!(0)));
    assert!(stats["ms"]["deform"].as_f64().is_some());
}

#[test]
fn the_left_half_of_a_split_may_have_weights_of_its_own() {
    let folder = Folder::new();
    let (file, out) = (file(&folder), folder.path("picture.png"));
    let (upright, leaning) = (["--morph", "Swell=0"], ["--morph", "Swell=0", "--morph", "Lean=1"]);
    let view = ["--target", "0,0,0", "--factor", "3"];
    // Distances of cameras are in bounding radii, of which the leaning beam has a smaller one.
    let radius = |options: &[&str]| {
        let stats = crate::stats(&[&[&*file, "--camera", "30,20,1"], &view[..], options].concat());
        let eye = stats["camera"]["eye"].as_array().expect("a place");
        eye.iter().map(|x| x.as_f64().expect("a number").powi(2)).sum::<f64>().sqrt()
    };
    let draw = |distance: f64, options: &[&str]| {
        let camera = format!("30,20,{distance}");
        let own = ["render", &*file, "--camera", &camera, "--size", "160x120", "-o", &*out];
        output(&[&own[..], &view, options].concat());
        image::open(&out).expect("a picture").to_rgba8()
    };
    let [left, right] = [draw(3.0 * radius(&upright) / radius(&leaning), &leaning), draw(3.0, &upright)];
    let split = [&upright[..], &["--split", "0.5", "--split-left", "pn-aen", "--split-morph", "Lean=1"]].concat();
    let both = draw(3.0, &split);
    // Rounding of that distance decides for a sample at an outline now and then.
    let differing = |alone: &image::RgbaImage, columns: std::ops::Range<u32>| {
        let places = columns.flat_map(|x| (0..120).map(move |y| (x, y)));
        places.filter(|&(x, y)| alone[(x, y)].0.iter().zip(both[(x, y)].0).any(|(a, b)| a.abs_diff(b) > 8)).count()
    };
    let found = [differing(&left, 0..79), differing(&right, 0..79), differing(&right, 80..160)];
    assert!(found[0] < 10 && found[1] > 100 && found[2] == 0, "{found:?}");
    let halves = crate::stats(&[&[&*file], &split[..]].concat());
    let triangles = |of: &Value| of["triangles_in"].as_u64().expect("a count");
    assert_eq!((halves["left"]["mesh"].as_str(), triangles(&halves["left"])), (Some(&*file), triangles(&halves)));
    // Another file's weights are those of that file.
    let with = ["shape:torus", "--split", "0.5", "--split-with", &*file];
    let other = crate::stats(&[&with[..], &["--split-morph", "Lean=1"]].concat());
    assert_eq!((triangles(&other["left"]), &other["left"]["parts"]), (triangles(&halves), &json!([])));
    let alone = ["render", &*file, "-o", &*out];
    let said = failure(&[&alone[..], &["--split-morph", "Lean=1"]].concat(), 2);
    assert!(said.contains("--split <"), "{said}");
    let unknown = [&alone[..], &["--split", "0.5", "--split-morph", "Smile=1"]].concat();
    let said = failure(&unknown, 1);
    assert!(said.contains("no morph target Smile") && said.contains("choose one of Lean, Swell"), "{said}");
    let none = ["render", "shape:torus", "-o", &*out, "--split", "0.5", "--split-morph", "Smile=1"];
    assert!(failure(&none, 1).contains("it has no morph targets"));
}

#[test]
fn morph_targets_are_listed_and_others_are_answered_with_them() {
    let folder = Folder::new();
    let file = file(&folder);
    let text = output(&["info", &file, "--morph", "Swell=1"]);
    assert!(text.contains("\nmorph target  Lean: 0 at rest in the file\nmorph target  Swell: 0.25 at rest"), "{text}");
    let info: Value = serde_json::from_str(&output(&["info", &file, "--json"])).expect("JSON");
    assert_eq!(info["morph_targets"], json!({ "Lean": 0.0, "Swell": 0.25 }));
    sentence(&["info", &file, "--morph", "Smile=1"], &["no morph target Smile", "choose one of Lean, Swell"]);
    sentence(&["info", vase(), "--morph", "Smile=1"], &["no morph target Smile", "it has no morph targets"]);
    assert!(failure(&["info", &file, "--morph", "Smile"], 2).contains("NAME=WEIGHT"));
}

#[test]
fn a_time_beyond_a_clips_end_is_its_end() {
    let folder = Folder::new();
    let file = file(&folder);
    let written = |time: &str| {
        let path = folder.path("out.obj");
        let command = ["tessellate", &file, "-o", &path, "--device", "cpu", "--animation", "Swell", "--time", time];
        let said = String::from_utf8(run(&command).stderr).expect("UTF-8");
        (std::fs::read(&path).expect("a mesh"), said)
    };
    let (end, said) = written("1.5");
    assert!(!said.contains("ends"), "{said}");
    let (after, said) = written("99");
    assert!(said.contains("pnaen: Swell ends at 1.5 s"), "{said}");
    assert!(end == after);
}

#[test]
fn an_unknown_animation_is_answered_with_those_there_are() {
    let folder = Folder::new();
    let (file, picture) = (file(&folder), folder.path("out.png"));
    let said = failure(&["render", &file, "-o", &picture, "--animation", "Fly away"], 1);
    assert!(said.contains("has no animation \"Fly away\": it has Bend, Swell, Fly, All"), "{said}");
    let said = failure(&["render", "shape:torus", "-o", &picture, "--animation", "Fly"], 1);
    assert!(said.contains("shape:torus has no animation \"Fly\": it has none"), "{said}");
    let said = failure(&["render", &file, "-o", &picture, "--time", "1"], 2);
    assert!(said.contains("--animation"), "{said}");
    for time in ["nan", "x", "inf", "-1"] {
        failure(&["render", &file, "-o", &picture, "--animation", "Fly", &format!("--time={time}")], 2);
    }
}

#[test]
fn info_lists_clips() {
    let folder = Folder::new();
    let file = file(&folder);
    let text = output(&["info", &file]);
    assert!(text.contains("\nanimation     Bend: 1 s, moves 1 joint\n"), "{text}");
    assert!(text.contains("\nanimation     Swell: 1.5 s, moves 2 morph targets\n"), "{text}");
    assert!(text.contains("\nanimation     All: 2 s, moves 1 joint, 1 node, 2 morph targets\n"), "{text}");
    let info: Value = serde_json::from_str(&output(&["info", &file, "--json"])).expect("JSON");
    let fly = json!({ "name": "Fly", "duration": 2.0, "joints": 0, "nodes": 1, "targets": 0 });
    assert_eq!(info["animations"][2], fly);
}

#[test]
fn the_worst_moment_of_a_clip_is_the_one_with_the_most() {
    let folder = Folder::new();
    let file = file(&folder);
    let triangles = |options: &[&str]| {
        let picture = folder.path("worst.png");
        let clip = ["--animation", "Bend", "--size", "200x160", "--lod", "edge-length"];
        let counted = ["-o", &picture, "--stats", "-", "--measure-error", "false"];
        let run = run(&[&["render", &file], &clip[..], &SIMPLE_LIGHT, &counted, options].concat());
        assert!(run.status.success(), "{run:?}");
        let stats: Value = serde_json::from_slice(&run.stdout).expect("JSON");
        let said = String::from_utf8(run.stderr).expect("text");
        (stats["triangles_out"].as_u64().expect("a count"), stats["animation"]["time"].as_f64().expect("a time"), said)
    };
    let (most, time, said) = triangles(&["--worst", "triangles"]);
    assert!(said.contains(&format!("the most triangles are at {} s: {most}", time as f32)), "{said}");
    for k in 0..=8 {
        let at = format!("{}", f64::from(k) * 0.25);
        assert!(triangles(&["--time", &at]).0 <= most + most / 50, "{at}");
    }
    assert_eq!(triangles(&["--time", &time.to_string()]).0, most);
    for (options, said) in
        [(&["--worst", "folds"][..], "--animation"), (&["--animation", "All", "--worst", "x"], "folds")]
    {
        assert!(failure(&[&["render", &file, "-o", "a.png"], options].concat(), 2).contains(said), "{options:?}");
    }
}

#[test]
fn bones_are_drawn_over_a_skin_and_change_no_picture_without_one() {
    let folder = Folder::new();
    let file = file(&folder);
    let picture = |mesh: &str, more: &[&str]| {
        let path = folder.path("picture.png");
        let usual = ["render", mesh, "-o", &path, "--size", "160x120", "--factor", "3"];
        let (_, errors) = both(&[&usual[..], &SIMPLE_LIGHT, more].concat());
        (image::open(&path).expect("a picture").to_rgba8(), errors)
    };
    let bones = ["--overlay", "bones"];
    for pose in [&[][..], &["--animation", "Bend", "--time", "0.5"]] {
        let [(plain, _), (with, errors)] = [picture(&file, pose), picture(&file, &[pose, &bones].concat())];
        let changed = plain.pixels().zip(with.pixels()).filter(|(a, b)| a != b).count();
        assert!((50..5000).contains(&changed), "{changed} px");
        assert!(!errors.contains("bones"), "{errors}");
    }
    let (split, left_bones) = (["--split", "0.9"], ["--split", "0.9", "--split-looks", "bones"]);
    let [(plain, _), (left, _)] = [picture(&file, &split), picture(&file, &left_bones)];
    let changed = plain.enumerate_pixels().filter(|(x, y, own)| *own != left.get_pixel(*x, *y));
    let columns: Vec<u32> = changed.map(|(x, ..)| x).collect();
    // The left half ends with column 143.
    assert!(columns.len() > 50 && columns.iter().all(|x| *x < 144), "{columns:?}");
    for own in [&bones[..], &left_bones] {
        let without = &own[..own.len() - 2];
        let [(plain, _), (with, errors)] = [picture("shape:torus", without), picture("shape:torus", own)];
        assert_eq!(plain, with);
        assert!(errors.contains("--overlay bones has no effect: no skin moves the mesh"), "{errors}");
    }
}
