//! `pnaen render --overlay silhouette`: what stats say of outlines, and that they are in the picture.

use serde_json::Value;

use crate::{Folder, number, output, stats};

#[test]
fn stats_say_how_far_the_outline_is_from_the_sources_and_the_surfaces() {
    let of = |factor: &str| {
        let options = ["--factor", factor, "--partitioning", "integer"];
        stats(&[&["shape:icosahedron", "--overlay", "silhouette"][..], &options].concat())
    };
    let coarse = of("1");
    let bulge = number(&coarse, "/silhouette/from_surface_px");
    assert!(number(&coarse, "/silhouette/from_source_px") == 0.0 && bulge > 5.0, "{coarse}");
    let at = ["/silhouette/from_surface_at/0", "/silhouette/from_surface_at/1"].map(|place| number(&coarse, place));
    assert!((0.0..160.0).contains(&at[0]) && (0.0..120.0).contains(&at[1]), "{at:?}");
    assert_eq!(coarse["silhouette"]["samples_per_px"], 2);
    let fine = of("32");
    assert!((number(&fine, "/silhouette/from_source_px") - bulge).abs() <= 1.0, "{fine}");
    assert!(number(&fine, "/silhouette/from_surface_px") <= 0.5, "{fine}");
}

#[test]
fn without_the_overlay_nothing_is_compared_and_a_mesh_out_of_view_has_no_outline() {
    assert_eq!(stats(&["shape:torus", "--overlay", "clay"])["silhouette"], Value::Null);
    let away = stats(&["shape:torus", "--overlay", "silhouette", "--target", "900,0,0", "--camera", "0,0,1"]);
    assert_eq!(away["silhouette"]["from_source_px"], Value::Null);
    assert_eq!(away["silhouette"]["from_surface_px"], Value::Null);
}

#[test]
fn outlines_and_their_legend_are_drawn_also_on_nothing() {
    let folder = Folder::new();
    let path = folder.path("out.png");
    output(&[
        "render",
        "shape:icosahedron",
        "--factor",
        "1",
        "--overlay",
        "silhouette",
        "--transparent",
        "--legend",
        "-o",
        &path,
    ]);
    let picture = image::open(&path).expect("a picture").to_rgba8();
    let of = |color: [u8; 3]| picture.pixels().filter(|pixel| pixel.0 == [color[0], color[1], color[2], 255]).count();
    // The swatch alone has over 100 px.
    assert!(of([224, 96, 128]) > 100 && of([32, 128, 224]) > 100 && of([160, 160, 0]) > 100);
    let half = picture.pixels().filter(|pixel| (1..255).contains(&pixel.0[3])).count();
    assert!(half > 100, "the surface's outline lies beyond the triangles, on nothing: {half}");
}
