//! `pnaen render`: its pictures and its stats.

use std::path::Path;

use serde_json::Value;

use crate::{Folder, SIMPLE_LIGHT, number, output, run, sentence, stats, vase, write_corners};

#[test]
fn stats_have_counts_cracks_memory_and_times() {
    let stats = stats(&["shape:torus", "--factor", "4", "--partitioning", "integer"]);
    let number = |path: &str| number(&stats, path);
    assert!(stats["adapter"].as_str().is_some_and(|name| !name.is_empty()));
    let counts = ["/triangles_in", "/points", "/corners", "/degenerate", "/patches", "/patches_culled"].map(number);
    assert_eq!(counts, [256.0, 128.0, 153.0, 0.0, 256.0, 0.0]);
    // 1.5 N^2 triangles and 3 N + 3 R (R + 1) + 1 vertices per patch, with R = N / 2 - 1.
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
    // Its seams are of texture coordinates alone, of 4 segments each.
    assert_eq!(["/seams/edges", "/seams/points"].map(number), [24.0, 120.0]);
    for angle in ["max", "mean", "source_max", "source_mean", "max_added"] {
        assert_eq!(number(&format!("/seams/{angle}_degrees")), 0.0, "{angle}");
    }
    for bytes in ["input", "topology", "arena"] {
        assert!(number(&format!("/bytes/{bytes}")) > 0.0);
    }
    for pass in ["load", "topology", "nets", "factors", "counts", "scan", "chunks", "emit", "draw"] {
        assert!(number(&format!("/ms/{pass}")) >= 0.0, "{pass}");
    }
}

#[test]
fn the_manual_names_every_number_of_the_stats() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/manual/measuring.md");
    let page = std::fs::read_to_string(path).expect("the page");
    let is_named = |names: [String; 2]| names.iter().any(|name| page.contains(&format!("`{name}")));
    let stats = stats(&["shape:cube-split", "--surface", "pn", "--measure-error", "true"]);
    for key in stats.as_object().expect("an object").keys() {
        assert!(is_named([format!("{key}`"), format!("{key}.")]), "measuring.md doesn't name {key}");
    }
    for group in ["cracks", "seams"] {
        for key in stats[group].as_object().expect("an object").keys() {
            assert!(
                is_named([format!("{group}.{key}`"), format!(".{key}`")]),
                "measuring.md doesn't name {group}.{key}"
            );
        }
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
    assert!(pn["leaks"].as_u64() > Some(100), "one can see through the cracks: {pn}");
    for whole in [pn_aen, flat] {
        assert_eq!((&whole["cracks"]["different_bits"], &whole["leaks"]), (&0.into(), &0.into()));
        let angle = |name: &str| number(&whole, &format!("/seams/{name}_degrees"));
        assert!((angle("max") - angle("source_max")).abs() < 0.02 && angle("source_max") > 45.0, "{whole}");
        assert!((angle("mean") - angle("source_mean")).abs() < 0.02 && angle("max_added") < 0.02, "{whole}");
    }
}

#[test]
fn leaks_of_an_open_mesh_are_null() {
    let open = stats(&["shape:saddle"]);
    assert_eq!(open.get("leaks"), Some(&Value::Null), "{open}");
    assert_eq!(number(&open, "/cracks/edges_compared"), 96.0, "all edges but those of the boundary");
}

#[test]
fn stats_count_folds_where_normals_lie_nearly_in_the_plane() {
    let folder = Folder::new();
    // The leaning normals are like those at a notch and a point of a star.
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
fn shared_edges_crack_as_published_and_not_if_computed_per_edge() {
    let cracks =
        |options: &[&str]| stats(&[&["shape:torus", "--surface", "pn-aen"], options].concat())["cracks"].clone();
    let published = ["--edges", "as-published"];
    let adaptive = ["--lod", "paper", "--pixels", "4"];
    let uniform = cracks(&[&published[..], &["--factor", "8"]].concat());
    assert!(number(&uniform, "/different_bits") > 0.0 && number(&uniform, "/max_gap") > 0.0, "{uniform}");
    assert_eq!(uniform["different_factors"], 0, "a uniform factor is the same from every side: {uniform}");
    let paper = cracks(&[&published[..], &adaptive].concat());
    assert!(number(&paper, "/different_factors") > 0.0, "{paper}");
    let by_edge = cracks(&[&["--edges", "per-edge"][..], &adaptive].concat());
    assert_eq!((&by_edge["different_bits"], &by_edge["different_factors"]), (&0.into(), &0.into()), "{by_edge}");
}

#[test]
fn the_vase_is_drawn_without_cracks() {
    for lod in ["uniform", "paper"] {
        let stats = stats(&[vase(), "--lod", lod, "--pixels", "6", "--clip", "paper"]);
        assert_eq!((&stats["cracks"]["different_bits"], &stats["patches"]), (&0.into(), &308.into()));
    }
}

#[test]
fn a_picture_has_its_size_and_background() {
    let folder = Folder::new();
    let path = folder.path("out.png");
    output(&[
        "render",
        vase(),
        "-o",
        &path,
        "--size",
        "120x90",
        "--factor",
        "4",
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
fn a_picture_is_compared_with_its_reference() {
    let folder = Folder::new();
    let [reference, same, other] = ["reference.png", "same.png", "other.png"].map(|name| folder.path(name));
    let render = |out: &str, more: &[&str]| {
        let base = ["render", "shape:torus", "--size", "160x120", "--lod", "uniform", "-o", out];
        run(&[&base[..], &SIMPLE_LIGHT, more].concat())
    };
    assert!(render(&reference, &[]).status.success());
    assert!(render(&same, &["--reference", &reference]).status.success());
    assert!(!Path::new(&folder.path("same-diff.png")).exists());
    let differs = render(&other, &["--factor", "1", "--overlay", "wireframe", "--reference", &reference]);
    assert_eq!(differs.status.code(), Some(1));
    let said = String::from_utf8_lossy(&differs.stderr).into_owned();
    assert!(said.contains("other.png differs from") && said.contains("other-diff.png shows where"), "{said}");
    let diff = image::open(folder.path("other-diff.png")).expect("a PNG file");
    assert_eq!((diff.width(), diff.height()), (160, 120));
    assert!(Path::new(&other).exists(), "the picture is written even if it differs");
    sentence(
        &["render", "shape:torus", "--size", "80x60", "-o", &other, "--reference", &reference],
        &["reference.png", "80 x 60", "160 x 120", "--size 160x120"],
    );
    let before = std::fs::read(&reference).expect("a file");
    sentence(
        &["render", "shape:cone", "-o", &reference, "--reference", &reference],
        &["reference.png is read by the same command"],
    );
    assert_eq!(std::fs::read(&reference).expect("a file"), before);
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
fn stats_count_small_triangles_and_patches_with_low_factors() {
    let counts = |arguments: &[&str]| {
        let stats = stats(arguments);
        ["/triangles_out", "/triangles_in_view", "/triangles_below_3_px", "/patches_below_factor_2"]
            .map(|path| number(&stats, path))
    };
    let coarse = ["shape:torus", "--factor", "1", "--partitioning", "integer", "--measure-error", "false"];
    // In a picture of 160 x 120 px, the torus's 256 patches are about 5 px large.
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
fn a_selected_triangle_is_outlined() {
    let folder = Folder::new();
    let drawn = |name: &str, options: &[&str]| {
        let path = folder.path(name);
        let base = ["render", "shape:cube-split", "-o", &path, "--size", "320x240", "--camera", "0,0", "--factor", "4"];
        output(&[&base[..], &SIMPLE_LIGHT, options].concat());
        image::open(&path).expect("a PNG file").to_rgba8()
    };
    // Pink, lime and blue: FACTOR_COLORS of src/render/layout.rs.
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
fn a_section_cuts_the_picture_open_and_no_measurement() {
    let folder = Folder::new();
    let path = folder.path("cut.png");
    let draw = |options: &[&str]| {
        let usual = ["render", "shape:icosphere", "--camera", "0,0,4", "--size", "120x90", "--surface", "flat"];
        output(&[&usual[..], &SIMPLE_LIGHT, &["--factor", "1", "-o", &path], options].concat());
        image::open(&path).expect("a picture").to_rgba8()
    };
    let whole = draw(&[]);
    let background = *whole.get_pixel(0, 0);
    let covered = |picture: &image::RgbaImage| picture.pixels().filter(|pixel| **pixel != background).count();
    // Half of the sphere's disc is left; cut across the view, nearly all of it, whose backs are seen through the cut.
    let [beyond, before, across] = ["x", "-x", "-z"].map(|axis| draw(&[&format!("--section={axis}")]));
    let (all, parts) = (covered(&whole), [&beyond, &before, &across].map(covered));
    assert!(
        parts[..2].iter().all(|part| part.abs_diff(all / 2) < all / 20) && parts[2] > all * 9 / 10,
        "{all}, {parts:?}"
    );
    let (mut differing, beside) = (0, whole.enumerate_pixels().filter(|(x, ..)| x.abs_diff(60) > 2));
    for (x, y, pixel) in beside {
        let [kept, cut] = if x > 60 { [&beyond, &before] } else { [&before, &beyond] };
        assert_eq!(cut.get_pixel(x, y), &background, "{x}, {y}");
        differing += usize::from(kept.get_pixel(x, y) != pixel);
    }
    // But for the outline, where backs that the cut shows shine through.
    assert!(differing < all / 30, "{differing} of {all}");
    assert!(across != whole && covered(&draw(&["--section=-z", "--section-at", "1"])) == all);
    // Nothing of what the cut shows is left out because it faces away.
    assert!(draw(&["--section=-z", "--cull-back-faces"]) == across);
    let [cut, whole] = [&["--section=x"][..], &[]].map(|options| {
        let stats = stats(&[&["shape:cube-split", "--surface", "pn", "--factor", "4"], options].concat());
        (stats["cracks"].clone(), stats["folds"].clone(), stats["triangles_in_view"].clone())
    });
    assert_eq!(cut, whole);
}

#[test]
fn a_report_is_one_page_with_both_halves_what_was_found_and_the_command() {
    let folder = Folder::new();
    let path = folder.path("report.html");
    let split = ["--split", "0.5", "--split-left", "pn", "--partitioning", "integer", "--size", "80x60"];
    output(&[&["render", "shape:cube-split", "--factor", "4", "-o", &path], &split[..]].concat());
    let page = std::fs::read_to_string(&path).expect("a page");
    let pictures: Vec<_> = page.match_indices("src=\"data:image/png;base64,").collect();
    assert_eq!(pictures.len(), 2, "{page}");
    assert!(!page.contains("src=\"http") && page.ends_with("</html>\n"));
    for words in ["PN\n288 triangles, 12 cracked edges", "PN-AEN\n288 triangles, 0 cracked edges"] {
        assert!(page.contains(&format!("<figcaption>{words}</figcaption>")), "{words}: {page}");
    }
    for words in [
        "<span class=\"passed\">cracks</span>",
        "<span class=\"\">hard-edges</span>: 12 edges have two normals at an end",
        "pnaen render shape:cube-split",
        "<tr><th>triangles out</th><td>288</td></tr>",
        "<tr><th>left, cracks, edges</th><td>12</td></tr>",
    ] {
        assert!(page.contains(words), "{words}: {page}");
    }
}
