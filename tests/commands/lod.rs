//! The options of LOD and clipping.

use serde_json::Value;

use crate::{Folder, SIMPLE_LIGHT, failure, number, output, read_obj, run, sentence, stats};

#[test]
fn lod_by_edge_length_and_frustum_clipping_work_close_to_the_eye() {
    let close = ["shape:torus", "--camera", "30,20,0.6", "--pixels", "48"];
    let [clipped, whole, paper] = [["edge-length", "frustum"], ["edge-length", "off"], ["paper", "off"]]
        .map(|[lod, clip]| stats(&[&close[..], &["--lod", lod, "--clip", clip]].concat()));
    assert!(number(&clipped, "/patches_culled") > 50.0 && number(&clipped, "/patches_culled") < 256.0, "{clipped}");
    assert_eq!((&whole["patches_culled"], &paper["patches_culled"]), (&0.into(), &0.into()));
    assert!(number(&clipped, "/triangles_out") < number(&whole, "/triangles_out"), "{clipped}");
    assert_ne!(
        whole["triangles_out"], paper["triangles_out"],
        "some edges reach behind the eye, where only the white paper's LOD fails"
    );
    for stats in [clipped, whole] {
        assert_eq!((&stats["cracks"]["edges"], &stats["not_finite"]), (&0.into(), &0.into()), "{stats}");
    }
}

#[test]
fn lod_by_error_keeps_its_tolerance_with_fewer_triangles() {
    let of = |options: &[&str]| stats(&[&["shape:torus", "--partitioning", "integer"], options].concat());
    let paper = of(&["--lod", "paper", "--pixels", "4", "--measure-error", "true"]);
    let reached = number(&paper, "/max_error_px");
    assert!(reached > 0.01, "{paper}");
    let tolerance = reached.to_string();
    let by_error = of(&["--lod", "error", "--tolerance", &tolerance, "--measure-error", "true"]);
    assert_eq!(number(&paper, "/lod_comparison/tolerance_px") as f32, reached as f32);
    assert_eq!(number(&paper, "/lod_comparison/triangles"), number(&by_error, "/triangles_out"));
    let times = number(&paper, "/triangles_out") / number(&by_error, "/triangles_out");
    assert_eq!(number(&paper, "/lod_comparison/times"), times);
    // LOD by error is compared with itself at the error that it reached, which is below its tolerance.
    assert!(number(&by_error, "/lod_comparison/times") <= 1.0, "{by_error}");
    assert!(number(&by_error, "/max_error_px") <= reached, "{by_error}");
    assert!(2.0 * number(&by_error, "/triangles_out") < number(&paper, "/triangles_out"), "{by_error}");
    assert_eq!((number(&by_error, "/factors_capped"), number(&by_error, "/cracks/different_bits")), (0.0, 0.0));
    let distance = of(&["--lod", "distance", "--factor", "9", "--distances", "2,5"]);
    assert!(distance["lod_comparison"].is_null(), "{distance}");
    assert!(distance["max_error_px"].is_null() && number(&distance, "/triangles_out") > 256.0, "{distance}");
}

#[test]
fn stats_have_the_numbers_that_the_lod_uses() {
    let adaptive = ["--pixels", "20", "--tolerance", "3", "--distances", "2,5"];
    for (lod, used) in [
        ("uniform", [None; 4]),
        ("paper", [Some(20.0), None, None, None]),
        ("edge-length", [Some(20.0), None, None, None]),
        ("error", [None, Some(3.0), None, None]),
        ("distance", [None, None, Some(2.0), Some(5.0)]),
    ] {
        let stats = stats(&[&["shape:torus", "--lod", lod], &adaptive[..]].concat());
        let settings = &stats["settings"];
        let found = ["pixels", "tolerance", "near", "far"].map(|key| settings[key].as_f64());
        assert_eq!((settings["lod"].as_str(), found), (Some(lod), used), "{settings}");
        assert_eq!(settings["cull_back_faces"].as_bool(), Some(false), "{settings}");
    }
    let budget = stats(&["shape:torus", "--lod", "error", "--tolerance", "0.1", "--max-triangles", "2000"]);
    assert!(number(&budget, "/settings/tolerance") > 0.1, "the tolerance that was used: {budget}");
}

#[test]
fn subtriangulation_needs_uniform_factors() {
    let folder = Folder::new();
    let [picture, mesh, factors] = ["out.png", "out.obj", "out.csv"].map(|name| folder.path(name));
    let pattern = ["shape:torus", "--partitioning", "subtriangulation"];
    for lod in ["paper", "edge-length", "error", "distance"] {
        for (command, out) in [("render", &picture), ("tessellate", &mesh), ("factors", &factors)] {
            let said = failure(&[&[command, "-o", out], &pattern[..], &["--lod", lod]].concat(), 2);
            assert!(said.contains("subtriangulation") && said.contains("--lod uniform"), "{said}");
            assert!(!std::path::Path::new(out).exists(), "nothing is written");
        }
    }
    let stats = stats(&[&pattern[..], &["--factor", "6.2", "--lod", "uniform"]].concat());
    assert_eq!((number(&stats, "/triangles_out"), number(&stats, "/cracks/different_bits")), (256.0 * 49.0, 0.0));
    // A file of its own factors gives the same mesh. A file with one other factor is refused.
    output(&[&["factors", "-o", &factors, "--factor", "6.2"], &pattern[..]].concat());
    output(&[&["tessellate", "-o", &mesh, "--factor", "6.2", "--device", "cpu"], &pattern[..]].concat());
    let again = folder.path("again.obj");
    output(&[&["tessellate", "-o", &again, "--factors", &factors, "--device", "cpu"], &pattern[..]].concat());
    assert_eq!(std::fs::read(&again).expect("a file"), std::fs::read(&mesh).expect("a file"));
    let uneven = std::fs::read_to_string(&factors).expect("a file").replace("\n7,6.2,", "\n7,6.1,");
    std::fs::write(&factors, uneven).expect("a writable folder");
    let given = ["tessellate", "-o", &again, "--factors", &factors];
    sentence(&[&given[..], &pattern].concat(), &["out.csv", "patch 7", "not all equal", "--partitioning"]);
}

#[test]
fn a_budget_of_triangles_raises_the_tolerance_and_reports_it() {
    let folder = Folder::new();
    let [picture, mesh] = ["out.png", "out.obj"].map(|name| folder.path(name));
    let by_error = ["shape:torus", "--lod", "error", "--tolerance", "0.1"];
    let all = number(&stats(&by_error), "/triangles_out");
    let by_error = [&by_error[..], &["--size", "160x120"]].concat();
    let most = (0.5 * all).to_string();
    let drawn = [&["render", "-o", &*picture], &by_error[..], &SIMPLE_LIGHT].concat();
    let counted = ["--stats", "-", "--measure-error", "false", "--max-triangles", &most];
    let result = run(&[&drawn[..], &counted].concat());
    let said = String::from_utf8(result.stderr).expect("text");
    assert!(said.contains("tolerance raised from 0.1 to") && said.contains(&most), "{said}");
    let stats: Value = serde_json::from_slice(&result.stdout).expect("JSON");
    let count = number(&stats, "/triangles_out");
    assert!(count <= 0.5 * all && count > 0.2 * all, "{count} of {all}");
    // A tolerance that fits already stays, without a message.
    let result = run(&[&drawn[..], &["--max-triangles", "9999999"]].concat());
    assert!(result.status.success() && result.stderr.is_empty());
    // The option works on the CPU as well. A budget below the mesh's own triangles is an error.
    output(&[&["tessellate", "-o", &mesh, "--device", "cpu", "--max-triangles", "300"], &by_error[..]].concat());
    assert!(read_obj(&mesh).1.len() <= 300);
    sentence(
        &[&["render", "-o", &picture, "--max-triangles", "200"], &by_error[..]].concat(),
        &["256 triangles", "more than 200"],
    );
    let said = failure(&["render", "shape:torus", "-o", &picture, "--factor", "8", "--max-triangles", "200"], 2);
    assert!(said.contains("--lod error"), "{said}");
}
