//! Polygons that are taken as the cage of a subdivision surface.

use std::collections::BTreeSet;

use documents::cages::{CUBE, QUADS, cube};

use super::{Folder, SIMPLE_LIGHT, both, failure, number, output, run, stats};

/// The positions of the mesh that a file becomes.
fn positions(folder: &Folder, file: &str, options: &[&str]) -> Vec<[f64; 3]> {
    let written = folder.path("refined.obj");
    let usual = ["tessellate", file, "-o", &written, "--surface", "flat", "--factor", "1", "--device", "cpu"];
    output(&[&usual[..], options].concat());
    let text = std::fs::read_to_string(&written).expect("an OBJ file");
    let of_line = |line: &str| {
        let numbers: Vec<f64> = line.split(' ').map(|number| number.parse().expect("a number")).collect();
        [numbers[0], numbers[1], numbers[2]]
    };
    text.lines().filter_map(|line| line.strip_prefix("v ")).map(of_line).collect()
}

#[test]
fn a_cube_becomes_its_limit_surface_and_stays_closed() {
    let folder = Folder::new();
    let file = folder.path("cube.obj");
    std::fs::write(&file, cube()).expect("a writable folder");
    let of_scheme = |scheme: &str, levels: &str| {
        let options = ["--subdivide", scheme, "--levels", levels];
        let said = stats(&[&[&*file, "--factor", "2"][..], &options].concat());
        (positions(&folder, &file, &options), said)
    };
    for levels in ["1", "3"] {
        let (points, said) = of_scheme("catmull-clark", levels);
        // The limit of a corner of three faces is (9 v + 4 ends + opposite corners) / 24 (Halstead et al. 1993).
        let corners = points.iter().filter(|point| point.iter().all(|x| (x.abs() - 0.5).abs() < 1e-6)).count();
        assert!(corners >= 8, "{corners} of {} points", points.len());
        let farthest = points.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        assert!(farthest < 0.9, "{farthest}");
        let triangles = if levels == "1" { 24 * 2 } else { 24 * 16 * 2 };
        assert_eq!((said["triangles_in"].as_u64(), said["cracks"]["edges"].as_u64()), (Some(triangles), Some(0)));
        let edges = &said["edges"];
        assert_eq!((edges["boundary"].as_u64(), edges["split"].as_u64()), (Some(0), Some(0)), "{edges}");
    }
    let (_, said) = of_scheme("loop", "2");
    assert_eq!(said["triangles_in"].as_u64(), Some(12 * 16));
    let (points, said) = of_scheme("none", "2");
    assert_eq!((points.iter().flatten().all(|x| x.abs() == 1.0), said["triangles_in"].as_u64()), (true, Some(12)));
}

#[test]
fn a_cage_that_cannot_be_refined_stays_and_the_reason_is_said() {
    let folder = Folder::new();
    let file = folder.path("fin.obj");
    std::fs::write(&file, [CUBE, QUADS, "v 3 0 0\nf 1 2 9\n"].concat()).expect("a writable folder");
    let picture = folder.path("fin.png");
    let drawn = ["render", &file, "--factor", "1", "-o", &picture, "--size", "16x16", "--subdivide", "catmull-clark"];
    let (out, errors) = both(&[&drawn[..], &SIMPLE_LIGHT, &["--stats", "-", "--measure-error", "false"]].concat());
    assert!(out.contains("\"triangles_in\": 13"), "{out}");
    assert!(errors.contains("is shown as its control cage: 3 faces meet at the edge"), "{errors}");
    let refused = failure(&["render", &file, "-o", "a.png", "--subdivide", "loop", "--levels", "7"], 2);
    assert!(refused.contains("--levels"), "{refused}");
}

#[test]
fn how_far_a_tessellated_cage_is_from_its_limit_surface_is_measured() {
    let folder = Folder::new();
    let file = folder.path("cube.obj");
    std::fs::write(&file, cube()).expect("a writable folder");
    let reference = ["--reference-surface", &*file, "--reference-subdivide", "catmull-clark"];
    let largest = |options: &[&str]| {
        let said = stats(&[&[&*file, "--surface", "flat", "--factor", "1"][..], options, &reference].concat());
        ["at_least", "at_most"].map(|bound| number(&said, &format!("/accuracy/to_reference/max/{bound}")))
    };
    // A corner of the cage is the farthest from the limit, whose own corner is halfway to the middle.
    let [least, most] = largest(&[]);
    let corner = 0.75_f64.sqrt();
    assert!(least > corner - 1e-6 && most < corner + 0.01, "{least} to {most}");
    // The limit points of a refined cage lie on the limit surface.
    let [_, most] = largest(&["--subdivide", "catmull-clark", "--levels", "4"]);
    assert!(most < 1e-3, "{most}");
    std::fs::write(&file, [CUBE, QUADS, "v 3 0 0\nf 1 2 9\n"].concat()).expect("a writable folder");
    let refused = failure(&[&["render", &*file, "-o", "a.png", "--subdivide", "none"][..], &reference].concat(), 1);
    assert!(refused.contains("can't be a reference surface") && refused.contains("3 faces meet"), "{refused}");
    // What else is said about the file isn't why.
    std::fs::write(&file, [CUBE, QUADS, "v 3 0 0\nf 1 2 9\nf 1 2\n"].concat()).expect("a writable folder");
    let flawed = failure(&[&["render", &*file, "-o", "a.png", "--subdivide", "none"][..], &reference].concat(), 1);
    assert!(flawed.contains("fewer than 3 corners"), "{flawed}");
    assert_eq!(flawed.lines().last(), refused.lines().last());
}

/// Writes the cube, and returns its path.
fn written(folder: &Folder) -> String {
    folder.write("cube.obj", cube())
}

/// Options that draw a cage as it is, and compare it with its own limit.
const OWN: [&str; 6] = ["--surface", "flat", "--factor", "1", "--reference-subdivide", "catmull-clark"];

#[test]
fn a_cage_is_compared_with_its_own_limit_without_naming_it_twice() {
    let folder = Folder::new();
    let file = written(&folder);
    let said = |options: &[&str]| stats(&[&[&*file][..], &OWN, options].concat())["accuracy"].clone();
    let own = said(&[]);
    assert_eq!(own["reference_surface"], format!("{file} (catmull-clark)"));
    assert_eq!(own, said(&["--reference-surface", &file]));
    // The last refinement moved the reference by more than what is missing to the limit, which finer points lie on.
    let step = number(&own, "/reference_step");
    let missing = number(&said(&["--subdivide", "catmull-clark", "--levels", "6"]), "/to_reference/max/at_least");
    assert!(step > 2e-4 && step < 0.05, "{step}");
    assert!(missing > step / 10.0 && missing < step / 2.0, "{missing} after a step of {step}");
    let plain = stats(&[&*file, "--reference-surface", "shape:torus"]);
    assert!(plain["accuracy"]["reference_step"].is_null(), "{plain}");
    // Its faces as they are.
    let flat = stats(&[&*file, "--surface", "flat", "--factor", "1", "--reference-subdivide", "none"]);
    assert_eq!(flat["accuracy"]["reference_surface"], format!("{file} (none)"));
    assert!(number(&flat, "/accuracy/to_reference/max/at_most") < 1e-5, "{flat}");
    // What is hidden is hidden in the reference too.
    let [lid, rest] = [&QUADS[..10], &QUADS[10..]];
    let parts = folder.write("parts.obj", format!("{CUBE}o box\n{rest}o lid\n{lid}"));
    let refined = ["--subdivide", "catmull-clark", "--levels", "4", "--hide-part", "lid"];
    let open = stats(&[&[&*parts][..], &OWN, &refined].concat());
    let most = ["to", "from"].map(|way| number(&open, &format!("/accuracy/{way}_reference/max/at_most")));
    assert!(most.iter().all(|most| *most < 1e-3), "{most:?}");
}

#[test]
fn gates_charts_and_checks_take_the_own_limit() {
    let folder = Folder::new();
    let (file, picture) = (written(&folder), folder.path("cube.png"));
    let render = |limit: &'static str| {
        let gate = ["-o", &picture, "--size", "64x48", "--fail-on", limit];
        run(&[&["render", &file][..], &OWN, &SIMPLE_LIGHT, &gate].concat()).status.code()
    };
    assert_eq!((render("deviation:0.9"), render("deviation:0.8")), (Some(0), Some(1)));
    let options = ["--surfaces", "flat", "--lods", "uniform", "--factors", "1", "--samples", "2000", "--size", "64x48"];
    let own = ["chart", &*file, "--csv", "-", "--reference-subdivide", "catmull-clark"];
    let chart = output(&[&own[..], &options].concat());
    let mut reader = csv::Reader::from_reader(chart.as_bytes());
    let row = reader.records().next().expect("a row").expect("a whole row");
    let error: f64 = row[13].parse().expect("a number");
    // A part of the diagonal of the limit, whose half is between its corners' 0.87 and the cage's 1.74.
    assert!(error > 0.866 / 3.47 && error < 0.866 / 1.73, "{error}");
    for (limit, code) in [("0.9", 0), ("0.8", 1)] {
        let options = "surface = \"flat\"\nfactor = 1\nlighting = \"camera\"\nreference-subdivide = \"catmull-clark\"";
        let config = folder.write("own.toml", format!("fail-on = [\"deviation:{limit}\"]\n[options]\n{options}\n"));
        let ran = run(&["check", &file, "--config", &config]);
        assert_eq!(ran.status.code(), Some(code), "{}", String::from_utf8_lossy(&ran.stdout));
    }
}

#[test]
fn what_has_no_cage_of_its_own_is_refused() {
    let own = ["-o", "a.png", "--reference-subdivide", "loop"];
    for mesh in ["shape:torus", "shape:vase", "assets/vase.glb"] {
        let refused = failure(&[&["render", mesh][..], &own].concat(), 1);
        assert!(refused.contains("can't be a reference surface") && refused.contains("only polygons of"), "{refused}");
    }
}

#[test]
fn what_is_hidden_or_flawed_leaves_the_rest_as_it_is() {
    let folder = Folder::new();
    let file = folder.path("cube.obj");
    let [lid, rest] = [&QUADS[..10], &QUADS[10..]];
    let text = format!("{CUBE}o box\n{rest}f 1 1 2\no lid\n{lid}");
    std::fs::write(&file, text).expect("a writable folder");
    let options = ["--subdivide", "catmull-clark", "--levels", "2"];
    let all = positions(&folder, &file, &options);
    let some = positions(&folder, &file, &[&options[..], &["--hide-part", "lid"]].concat());
    assert!(some.len() < all.len() && some.len() > all.len() / 2, "{} of {}", some.len(), all.len());
    assert!(some.iter().all(|point| all.contains(point)), "the lid still shapes the faces beside it");
    let picture = folder.path("cube.png");
    let small = ["--factor", "1", "-o", &picture, "--size", "16x16"];
    let drawn = |mesh: &str| both(&[&["render", mesh][..], &small, &SIMPLE_LIGHT, &options].concat());
    let (_, errors) = drawn(&file);
    assert!(errors.contains("have a point twice, left out: 1"), "{errors}");
    let (_, errors) = drawn("assets/vase.glb");
    assert!(errors.contains("It isn't refined as a subdivision surface"), "{errors}");
}

#[test]
fn colours_and_texture_coordinates_are_refined_with_their_faces() {
    let folder = Folder::new();
    let file = folder.path("square.obj");
    // Red grows along x, and so does u.
    let square = "v 0 0 0 0 1 1\nv 1 0 0 1 1 1\nv 1 1 0 1 1 1\nv 0 1 0 0 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    std::fs::write(&file, square).expect("a writable folder");
    let options = ["--subdivide", "catmull-clark", "--levels", "3", "--surface", "flat", "--factor", "1"];
    let picture = folder.path("square.png");
    let usual = ["--camera", "0,0", "--orthographic", "--size", "64x64", "-o", &picture];
    output(&[&["render", &*file][..], &options, &usual].concat());
    let reds: Vec<u8> = {
        let picture = image::open(&picture).expect("a picture").to_rgba8();
        (16..48).map(|x| picture.get_pixel(x, 32).0[0]).collect()
    };
    // One value for each small face would be a staircase of eight steps.
    let distinct = reds.iter().collect::<BTreeSet<_>>().len();
    assert!(distinct > 16 && reds.is_sorted(), "{reds:?}");
}

#[test]
fn a_butterfly_surface_goes_through_the_corners_of_its_cage_and_is_a_reference() {
    let folder = Folder::new();
    let file = written(&folder);
    let options = ["--subdivide", "butterfly", "--levels", "3"];
    let points = positions(&folder, &file, &options);
    // Corners with normals of their own are written each.
    let kept: BTreeSet<String> =
        points.iter().filter(|point| point.iter().all(|x| x.abs() == 1.0)).map(|point| format!("{point:?}")).collect();
    assert_eq!(kept.len(), 8);
    let said = stats(&[&[&*file, "--factor", "2"][..], &options].concat());
    assert_eq!(said["triangles_in"].as_u64(), Some(12 * 64), "squares are cut first");
    assert_eq!((said["edges"]["boundary"].as_u64(), said["cracks"]["edges"].as_u64()), (Some(0), Some(0)));
    let compared = |options: &[&str]| {
        let own = ["--surface", "flat", "--factor", "1", "--reference-subdivide", "butterfly"];
        stats(&[&[&*file][..], &own, options].concat())["accuracy"].clone()
    };
    let cage = compared(&[]);
    assert_eq!(cage["reference_surface"], format!("{file} (butterfly)"));
    let step = number(&cage, "/reference_step");
    let missing = number(&compared(&["--subdivide", "butterfly", "--levels", "6"]), "/to_reference/max/at_least");
    assert!(step > 1e-4 && step < 0.05, "{step}");
    assert!(missing > step / 10.0 && missing < step, "{missing} after a step of {step}");
    // The surface bulges beyond the flat faces of the cage.
    assert!(number(&cage, "/to_reference/max/at_least") < 1.0 && points.iter().flatten().any(|x| x.abs() > 1.05));
}
