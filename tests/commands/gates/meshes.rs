//! Gates that judge the mesh or its surface: defects, normals, deviation and crossing patches.

use std::path::Path;

use super::drawn;
use crate::{Folder, assert_says, failure, number, vase, write_corners};

#[test]
fn a_mesh_is_judged_by_what_decides_how_it_tessellates() {
    let folder = Folder::new();
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\n";
    let gap = "v 1 0 0.00005\nv 0 1 0.00005\n";
    let turned = "vn 0 0 1\nvn 0 0 -1\nf 1//1 2//1 3//2\n";
    let cases = [
        ("non-manifold", "f 1 2 3\nf 1 3 4\nf 1 3 5\n", "1 edge has three triangles or more"),
        ("boundary", "f 1 2 3\nf 1 3 4\n", "4 edges are open"),
        ("winding", "f 1 2 3\nf 1 4 3\n", "1 edge has triangles wound opposite ways"),
        ("normals-against-faces", turned, "1 triangle has a normal that points behind it"),
        ("degenerate", "f 1 2 3\nf 1 3 3\n", "1 triangle has no area"),
        ("duplicates", "f 1 2 3\nf 2 3 1\n", "1 triangle repeats another one"),
        ("near-seam", &format!("{gap}f 1 2 4\nf 6 3 7\n"), "2 open edges nearly meet another one"),
        (
            "hard-edges",
            "vn 0 0 1\nvn 0 0.5 1\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n",
            "1 edge has two normals at an end",
        ),
    ];
    for (gate, faces, words) in cases {
        let mesh = folder.write(&format!("{gate}.obj"), format!("{square}{faces}"));
        let evidence = folder.path(gate);
        let (code, said, gates) = drawn(&[&mesh, "--fail-on", gate, "--evidence", &evidence]);
        assert_eq!(code, Some(1), "{gate}: {said}");
        assert_says(&said, &[words, "where 0 are allowed", "the longest is"]);
        let is_picture =
            |entry: std::io::Result<std::fs::DirEntry>| entry.expect("an entry").path().extension().is_some();
        assert!(std::fs::read_dir(&evidence).expect("a picture of the place").any(is_picture));
        assert_eq!(gates[0]["passed"], false);
    }
}

#[test]
fn boxes_with_smooth_normals_are_inflated_and_round_meshes_are_not() {
    let (code, said, gates) = drawn(&["shape:cube-smooth", "--fail-on", "inflated"]);
    assert_eq!(code, Some(1));
    assert_says(
        &said,
        &["12 triangles are blown up at hard edges", "where 0 are allowed", "most, by 0.1", "rises triangle"],
    );
    assert_eq!(number(&gates[0], "/found"), 12.0);
    let glass = Path::new(vase()).with_file_name("glass.glb").display().to_string();
    for round in ["shape:icosahedron", "shape:torus", "shape:vase", "shape:cylinder", vase(), &glass] {
        assert_eq!(drawn(&[round, "--fail-on", "inflated"]).0, Some(0), "{round}");
    }
}

/// Writes a triangle whose normals lean outwards, so that its patch bulges, and one above it that the bulge goes through.
fn write_bulge(folder: &Folder) -> String {
    let low = [[0.0, 0.0, 0.0], [0.5, 0.0, -0.9], [1.0, 0.0, 0.0]];
    let middle = [0.5, 0.0, -0.3];
    let leaning = low.map(|corner: [f32; 3]| [corner[0] - middle[0], 0.5, corner[2] - middle[2]]);
    let high = low.map(|corner| [0, 1, 2].map(|i| middle[i] + 0.8 * (corner[i] - middle[i]) + [0.0, 0.1, 0.0][i]));
    let corners = [0, 1, 2].map(|k| (low[k], leaning[k]));
    write_corners(folder, &[corners, high.map(|corner| (corner, [0.0, 1.0, 0.0]))].concat())
}

#[test]
fn patches_that_curve_through_each_other_are_counted_on_both_devices() {
    let folder = Folder::new();
    let bulge = write_bulge(&folder);
    let curved = ["--surface", "pn", "--factor", "9", "--fail-on", "self-intersections"];
    let (code, said, gates) = drawn(&[&[&bulge[..]], &curved[..]].concat());
    assert_eq!(code, Some(1), "{said}");
    assert_says(&said, &["1 pair of patches crosses each other", "between those of triangles 0 and 1"]);
    assert_eq!(number(&gates[0], "/found"), 1.0);
    let glb = folder.path("out.glb");
    let on_cpu = [&["tessellate", &bulge[..], "-o", &glb, "--device", "cpu"], &curved[..]].concat();
    assert!(failure(&on_cpu, 1).contains("1 pair of patches crosses each other"));
    // The triangles themselves don't cross.
    assert_eq!(drawn(&[&bulge, "--surface", "flat", "--factor", "9", "--fail-on", "self-intersections"]).0, Some(0));
}

#[test]
fn deviation_passes_if_the_upper_end_does_and_fails_if_the_lower_end_does() {
    let sphere = ["shape:icosahedron", "--surface", "flat", "--factor", "1"];
    let exact = ["--reference-surface", "shape:icosahedron"];
    let judged = |options: &[&str]| drawn(&[&sphere[..], options].concat());
    // The largest distance is 0.2053 object units of 3.46.
    for (limit, code) in [("0.21", 0), ("0.2", 1), ("210mm", 0), ("20cm", 1), ("6%", 0), ("5.9%", 1), ("0", 1)] {
        let (found, said, gates) = judged(&[&exact[..], &["--fail-on", &format!("deviation:{limit}")]].concat());
        assert_eq!(found, Some(code), "{limit}: {said}");
        let [least, most] = ["at_least", "at_most"].map(|end| number(&gates[0], &format!("/found/{end}")));
        assert!(least <= 0.205_346 && (0.205_345..0.21).contains(&most), "{limit}: {gates:?}");
        assert_eq!(gates[0]["limit"], limit);
    }
    let (code, said, _) = judged(&["--fail-on", "deviation:1"]);
    assert_eq!(code, Some(1));
    assert_says(&said, &["without a reference surface", "--reference-surface"]);
    let culled = ["--cull-back-faces", "--fail-on", "deviation:1"];
    let (code, said, _) = judged(&[&exact[..], &culled[..]].concat());
    assert_eq!(code, Some(1));
    assert_says(&said, &["patches are left out", "without clipping and culling"]);
    failure(&["render", "shape:torus", "-o", "x.png", "--fail-on", "deviation"], 2);
    let tessellate = ["tessellate", "shape:torus", "-o", "x.glb", "--fail-on", "deviation:1"];
    assert!(failure(&tessellate, 2).contains("which render and check take"));
}
