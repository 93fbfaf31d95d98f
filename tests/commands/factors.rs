//! `pnaen factors` and `--factors`: writing the hull shader's factors, and tessellating with those of a file.

use std::io::Write;
use std::process::Stdio;

use serde_json::Value;

use crate::{Folder, command, failure, number, output, run, sentence, write_triangles};

const CONVENTIONS: [&str; 5] = ["d3d11", "amd-pn", "edge-order", "rotated", "mirrored"];

/// Standard error of a run that must succeed.
fn said(arguments: &[&str]) -> String {
    let output = run(arguments);
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(output.status.success(), "{arguments:?}: {said}");
    said
}

/// Writes the factors of a torus under a convention.
fn write_factors(folder: &Folder, convention: &str) -> String {
    let path = folder.path(&format!("{convention}.csv"));
    let lod = ["--lod", "edge-length", "--device", "cpu"];
    output(&[&["factors", "shape:torus", "-o", &path, "--convention", convention], &lod[..]].concat());
    path
}

/// The numbers of a line of a file of factors.
fn numbers(line: &str) -> Vec<f32> {
    line.split(',').map(|number| number.parse().expect("a number")).collect()
}

#[test]
fn factors_are_printed_patch_by_patch_in_the_order_of_the_convention() {
    let printed = |more: &[&str]| {
        let text = output(&[&["factors", "shape:torus", "-o", "-", "--lod", "paper"], more].concat());
        let (header, rows) = text.split_once('\n').expect("lines");
        assert_eq!(header, "patch,e0,e1,e2,inside");
        rows.lines().map(numbers).collect::<Vec<_>>()
    };
    let d3d11 = printed(&[]);
    assert_eq!(d3d11.len(), 256);
    for (index, row) in d3d11.iter().enumerate() {
        assert_eq!(row[0], index as f32);
        assert_eq!(row[4], row[1].max(row[2]).max(row[3]));
    }
    assert!(d3d11.iter().filter(|row| row[1] != row[2] && row[2] != row[3]).count() > 200);
    // Direct3D 11's factors 0, 1, 2 are those of sides 1, 2, 0.
    for (convention, order) in
        [("amd-pn", [2, 3, 1]), ("edge-order", [3, 1, 2]), ("rotated", [3, 1, 2]), ("mirrored", [2, 1, 3])]
    {
        let expected: Vec<_> =
            d3d11.iter().map(|row| vec![row[0], row[order[0]], row[order[1]], row[order[2]], row[4]]).collect();
        assert_eq!(printed(&["--convention", convention]), expected, "{convention}");
    }
    let uniform = output(&["factors", "shape:cube-split", "-o", "-", "--factor", "5.3", "--device", "cpu"]);
    assert!(uniform.starts_with("patch,e0,e1,e2,inside\n0,5.3,5.3,5.3,5.3\n1,"), "{uniform}");
    let pow2 = output(&["factors", "shape:cube-split", "-o", "-", "--factor", "5.3", "--partitioning", "pow2"]);
    assert!(pow2.ends_with("\n11,8,8,8,8\n"), "{pow2}");
}

#[test]
fn factors_from_a_file_give_the_same_mesh_as_lod() {
    let folder = Folder::new();
    let [factors, direct, again] = ["factors.csv", "direct.obj", "again.obj"].map(|name| folder.path(name));
    let lods =
        [&["--lod", "edge-length", "--pixels", "24"][..], &["--lod", "error"], &["--lod", "distance", "--factor", "5"]];
    for (index, convention) in CONVENTIONS.into_iter().enumerate() {
        for device in ["gpu", "cpu"] {
            let partitioning = ["integer", "pow2", "fractional-odd", "fractional-even"][index % 4];
            let surface = ["--convention", convention, "--device", device, "--partitioning", partitioning];
            // Starting a device is slow, so the GPU gets one LOD per convention.
            for lod in if device == "cpu" { &lods[..] } else { &lods[index % 3..][..1] } {
                let view = [&surface[..], &["--camera", "30,20,1.5", "--clip", "frustum"], *lod].concat();
                output(&[&["factors", "shape:torus", "-o", &factors], &view[..]].concat());
                output(&[&["tessellate", "shape:torus", "-o", &direct], &view[..]].concat());
                let given = ["tessellate", "shape:torus", "-o", &again, "--factors", &factors];
                let said = said(&[&given[..], &surface].concat());
                assert!(said.contains(" of 256 patches are left out"), "{said}");
                let meshes = [&direct, &again].map(|path| std::fs::read(path).expect("a file"));
                assert!(meshes[0].len() > 10_000 && meshes[0] == meshes[1], "{view:?}");
            }
        }
    }
}

/// Stats of a picture with the factors of a file, and standard error.
fn drawn(folder: &Folder, factors: &str, convention: &str) -> (Value, String) {
    let picture = folder.path("out.png");
    let size = ["--size", "160x120", "--lighting", "camera", "--stats", "-", "--measure-error", "false"];
    let given = ["render", "shape:torus", "-o", &picture, "--factors", factors, "--convention", convention];
    let output = run(&[&given[..], &size].concat());
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(output.status.success(), "{said}");
    (serde_json::from_slice(&output.stdout).expect("JSON"), said)
}

#[test]
fn the_convention_of_a_file_is_recognised_by_its_edges() {
    let folder = Folder::new();
    let (amd, mirrored) = (write_factors(&folder, "amd-pn"), write_factors(&folder, "mirrored"));
    let (stats, said) = drawn(&folder, &amd, "d3d11");
    let different = number(&stats, "/factors_file/edges_different");
    assert!(different > 300.0, "{stats}");
    assert_eq!(different, number(&stats, "/cracks/different_factors"), "each such edge is a crack");
    assert!(number(&stats, "/cracks/max_gap") > 1e-3, "{stats}");
    assert!(
        said.starts_with(&format!("pnaen: {different} of 384 edges have different factors on their sides\n")),
        "{said}"
    );
    assert!(said.ends_with("consistent as amd-pn: pass --convention amd-pn\n"), "{said}");
    assert_eq!(said.lines().filter(|line| line.contains(" in triangle ")).count(), 10, "{said}");
    let file = &stats["factors_file"];
    assert_eq!((&file["consistent_as"], &file["convention"]), (&serde_json::json!(["amd-pn"]), &"d3d11".into()));
    let listed = file["edges"].as_array().expect("a list");
    assert_eq!(listed.len() as f64, different);
    let sides = |edge: &Value| ["/sides/0/factor", "/sides/1/factor"].map(|side| number(edge, side));
    let differences: Vec<_> = listed.iter().map(sides).map(|[a, b]| (a - b).abs()).collect();
    assert!(differences[0] > 0.0 && differences.is_sorted_by(|a, b| a >= b), "{differences:?}");

    let (stats, said) = drawn(&folder, &amd, "amd-pn");
    assert_eq!((number(&stats, "/cracks/edges"), number(&stats, "/factors_file/edges_different")), (0.0, 0.0));
    assert_eq!(said, "pnaen: 0 of 384 edges have different factors on their sides\n");
    let (stats, said) = drawn(&folder, &mirrored, "d3d11");
    assert!(said.contains("e0, e1, e2 are for edges (2, 0), (1, 2), (0, 1) as mirrored writes them"), "{said}");
    assert_eq!(stats["factors_file"]["consistent_as"], serde_json::json!([]));
    let (stats, _) = drawn(&folder, &mirrored, "mirrored");
    assert!(number(&stats, "/cracks/different_factors") > 300.0, "a wrong convention stays wrong: {stats}");
}

#[test]
fn one_edge_that_disagrees_is_named_with_its_triangles() {
    let folder = Folder::new();
    let path = write_factors(&folder, "d3d11");
    let text = std::fs::read_to_string(&path).expect("a file");
    let changed: Vec<String> = text
        .lines()
        .map(|line| {
            let patch = line.split_once(',').expect("columns").0;
            if patch == "7" { format!("7,inf,{}", line.splitn(3, ',').nth(2).expect("columns")) } else { line.into() }
        })
        .rev()
        .collect();
    // Lines in another order, with Windows line ends.
    let (header, rows) = changed.split_last().expect("lines");
    let one = folder.write("one.csv", format!("\u{feff}{header}\r\n\r\n{}\r\n", rows.join("\r\n")));
    let (stats, said) = drawn(&folder, &one, "d3d11");
    assert!(said.starts_with("pnaen: 1 of 384 edges have different factors on their sides\n"), "{said}");
    assert!(said.contains(", inf in triangle 7\n"), "{said}");
    assert!(said.contains("d3d11") && said.ends_with(" 1 edge that differs\n"), "{said}");
    assert_eq!((number(&stats, "/cracks/different_factors"), number(&stats, "/factors_capped")), (1.0, 1.0), "{stats}");
    let edge = &stats["factors_file"]["edges"][0];
    let sides = edge["sides"].as_array().expect("a list");
    let other = sides.iter().find(|side| side["triangle"] != 7).expect("two sides");
    assert!(sides.contains(&serde_json::json!({ "triangle": 7, "factor": "inf" })), "{edge}");
    assert!(said.contains(&format!(": {} in triangle {}, inf", other["factor"], other["triangle"])), "{said}{edge}");
    assert_eq!(edge["points"].as_array().map(Vec::len), Some(2));
}

#[test]
fn lines_of_degenerate_triangles_are_optional() {
    let folder = Folder::new();
    let [a, b, c, d] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let mesh = write_triangles(&folder, &[[a, b, c], [b, b, c], [b, d, c]], [0.0, 0.0, 1.0]);
    let written = output(&["factors", &mesh, "-o", "-", "--factor", "2", "--device", "cpu"]);
    assert_eq!(written, "patch,e0,e1,e2,inside\n0,2,2,2,2\n2,2,2,2,2\n");
    let (file, obj) = (folder.path("factors.csv"), folder.path("out.obj"));
    for line in ["", "1,9,9,9,9\n"] {
        std::fs::write(&file, written.clone() + line).expect("a writable folder");
        let said = said(&["tessellate", &mesh, "-o", &obj, "--device", "cpu", "--factors", &file]);
        assert!(said.contains("pnaen: 0 of 1 edges have"), "{said}");
        assert!(said.contains("consistent as amd-pn and edge-order too"), "{said}");
    }
}

#[test]
fn errors_in_a_file_are_one_line_with_the_line_number() {
    let folder = Folder::new();
    let [file, obj] = ["wrong.csv", "out.obj"].map(|name| folder.path(name));
    let text = output(&["factors", "shape:cube-split", "-o", "-", "--device", "cpu", "--factor", "8"]);
    let lines: Vec<_> = text.lines().collect();
    let with = |at: usize, line: &str| [&lines[..at], &[line], &lines[at + 1..]].concat().join("\n");
    for (text, words) in [
        (lines[1..].join("\n"), ["wrong.csv, line 1", "header \"patch,e0,e1,e2,inside\""]),
        (String::new(), ["wrong.csv, line 1", "header \"patch,e0,e1,e2,inside\""]),
        (with(3, "2,8,eight,8,8"), ["wrong.csv, line 4", "e1 is \"eight\""]),
        (with(3, "two,8,8,8,8"), ["wrong.csv, line 4", "patch is \"two\""]),
        (with(3, "2,8,8,8"), ["wrong.csv, line 4", "number of values is 4"]),
        (with(3, "12,8,8,8,8"), ["wrong.csv, line 4", "no patch 12"]),
        (with(3, "1,8,8,8,8"), ["wrong.csv, line 4", "patch 1 occurs twice"]),
        (lines[..9].join("\n"), ["wrong.csv, line 9", "patch 8 and 3 more"]),
    ] {
        std::fs::write(&file, text).expect("a writable folder");
        sentence(&["tessellate", "shape:cube-split", "-o", &obj, "--device", "cpu", "--factors", &file], &words);
        sentence(&["render", "shape:cube-split", "-o", &folder.path("out.png"), "--factors", &file], &words);
    }
    sentence(
        &["tessellate", "shape:torus", "-o", &obj, "--factors", "nowhere.csv"],
        &["nowhere.csv", "could not be read"],
    );
    for option in [["--lod", "uniform"], ["--factor", "8"], ["--pixels", "8"], ["--distances", "1,2"]] {
        let said = failure(&[&["render", "shape:torus", "-o", "x.png", "--factors", &file], &option[..]].concat(), 2);
        assert!(said.contains("cannot be used with") && said.contains(option[0]), "{said}");
    }
    failure(&["render", "shape:torus", "-o", "x.png", "--convention", "opengl"], 2);
    failure(&["factors", "shape:torus"], 2);
}

#[test]
fn factors_can_come_from_standard_input() {
    let folder = Folder::new();
    let obj = folder.path("out.obj");
    let arguments = ["tessellate", "shape:cube-split", "-o", &obj, "--factors", "-", "--device", "cpu"];
    let mut child = command(&arguments)
        .args(["--partitioning", "integer"])
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let rows: String = (0..12).map(|patch| format!("{patch},1,1,1,1\n")).collect();
    let text = format!("patch,e0,e1,e2,inside\n{rows}").replace("5,1,1,1,1", "5,1,0,1,1");
    child.stdin.take().expect("a pipe").write_all(text.as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("the program ends");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(crate::read_obj(&obj).1.len(), 11, "one of 12 patches is left out");
}
