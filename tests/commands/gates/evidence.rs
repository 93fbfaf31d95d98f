//! Evidence: pictures of the worst places.

use std::path::Path;

use serde_json::Value;

use super::{VIEW, write_junction, written};
use crate::{Folder, failure, number, output};

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
    folder.write(if shell { "shell.obj" } else { "back.obj" }, text)
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
            let stats = written(&stats);
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
        let stats = written(&stats);
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
