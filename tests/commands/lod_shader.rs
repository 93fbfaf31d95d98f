//! `--lod-shader`: factors from functions of the user's own.

use serde_json::Value;

use crate::{Folder, both, failure, number, output, sentence};

const EDGE: &str = "fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32 { return BODY; }";

/// Writes a file whose function for edges returns this.
fn write(folder: &Folder, name: &str, returns: &str) -> String {
    let path = folder.path(name);
    std::fs::write(&path, EDGE.replace("BODY", returns)).expect("a writable folder");
    path
}

#[test]
fn factors_of_functions_are_written_and_tessellate_as_their_file_does() {
    let folder = Folder::new();
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/lod/distance.wgsl");
    let [factors, direct, again] = ["factors.csv", "direct.obj", "again.obj"].map(|name| folder.path(name));
    let (_, said) = both(&["factors", "shape:torus", "-o", &factors, "--lod-shader", example]);
    assert_eq!(said, "pnaen: 0 of 384 edges have different factors on their sides\n");
    both(&["tessellate", "shape:torus", "-o", &direct, "--lod-shader", example]);
    both(&["tessellate", "shape:torus", "-o", &again, "--factors", &factors]);
    let meshes = [&direct, &again].map(|path| std::fs::read(path).expect("a file"));
    assert!(meshes[0].len() > 10_000 && meshes[0] == meshes[1]);
}

#[test]
fn what_is_not_symmetric_is_listed_and_drawn_as_cracks() {
    let folder = Folder::new();
    let shader = write(&folder, "start.wgsl", "4.0 + 2.0 * edge.a.y / view.radius");
    let picture = folder.path("out.png");
    let size = ["--size", "160x120", "--lighting", "camera", "--stats", "-", "--measure-error", "false"];
    let drawn = |shader: &str| {
        let (stats, said) =
            both(&[&["render", "shape:torus", "-o", &picture, "--lod-shader", shader], &size[..]].concat());
        (serde_json::from_str::<Value>(&stats).expect("JSON"), said)
    };
    let (stats, said) = drawn(&shader);
    let different = number(&stats, "/lod_shader/edges_different");
    assert!(different > 200.0, "{stats}");
    assert_eq!(different, number(&stats, "/cracks/different_factors"), "each such edge is a crack");
    assert!(
        said.starts_with(&format!("pnaen: {different} of 384 edges have different factors on their sides\n")),
        "{said}"
    );
    assert_eq!(said.lines().filter(|line| line.contains(" in triangle ")).count(), 10, "{said}");
    assert_eq!(stats["lod_shader"]["edges"].as_array().map(|edges| edges.len() as f64), Some(different));
    // One NaN.
    let shader = write(&folder, "nan.wgsl", "select(3.0, sqrt(-view.radius), triangle.index == 5u && edge.side == 0u)");
    let (stats, said) = drawn(&shader);
    let count = number(&stats, "/lod_shader/not_numbers");
    assert!((1.0..=2.0).contains(&count), "the inside factor may be one, too: {stats}");
    assert!(said.contains("warning: ") && said.contains("of the LOD shader "), "{said}");
    assert_eq!(number(&stats, "/lod_shader/patches_culled"), 1.0);
}

#[test]
fn files_that_cannot_be_used_are_refused_with_their_line() {
    let folder = Folder::new();
    let picture = folder.path("out.png");
    let with = |shader: &str| ["render", "shape:cube-split", "-o", &picture, "--lod-shader", shader].map(str::to_owned);
    let refused = |shader: &str, words: &[&str]| {
        let arguments = with(shader);
        sentence(&arguments.each_ref().map(|word| &**word), words);
        assert!(!std::path::Path::new(&picture).exists());
    };
    let bad = write(&folder, "bad.wgsl", "\n\nnothing + 1.0");
    refused(&bad, &["bad.wgsl, line 3: ", "nothing"]);
    refused(&write(&folder, "spins.wgsl", "spin()"), &["spins.wgsl, line 1: ", "spin"]);
    refused(&folder.path("none.wgsl"), &["none.wgsl can't be read", "check its path"]);
    let binary = folder.write("binary.wgsl", b"\x00\xff\xfe");
    refused(&binary, &["binary.wgsl isn't a text in UTF-8"]);
    let large = folder.write("large.wgsl", " ".repeat(3_000_000));
    refused(&large, &["large.wgsl has more than 65536 bytes"]);
    let endless = folder.path("endless.wgsl");
    let spin = "fn spin() -> f32 { var n = 1.0; while n > 0.0 { n += 1.0; if n > 9.0 { n = 1.0; } } return n; }";
    std::fs::write(&endless, format!("{spin}\n{}", EDGE.replace("BODY", "spin()"))).expect("a writable folder");
    refused(&endless, &["the loops of the LOD shader took too long", "bound the loops more tightly"]);
}

#[test]
fn options_that_exclude_functions_of_ones_own_are_named() {
    let folder = Folder::new();
    let (shader, out) = (write(&folder, "two.wgsl", "2.0"), folder.path("out.csv"));
    let with = |more: &[&str]| {
        failure(&[&["factors", "shape:cube-split", "-o", &out, "--lod-shader", &shader], more].concat(), 2)
    };
    assert!(with(&["--device", "cpu"]).contains("--lod-shader runs on the graphics adapter"));
    assert!(
        with(&["--partitioning", "subtriangulation"])
            .contains("can't be combined with --partitioning subtriangulation")
    );
    assert!(with(&["--lod", "paper"]).contains("cannot be used with"));
    assert!(with(&["--factor", "3"]).contains("cannot be used with"));
    let both = ["render", "shape:cube-split", "-o", "a.png", "--lod-shader", &shader, "--factors", "a.csv"];
    assert!(failure(&both, 2).contains("choose one"));
    // It isn't overwritten.
    let onto = ["factors", "shape:cube-split", "-o", &shader, "--lod-shader", &shader];
    assert!(failure(&onto, 1).contains("is read by the same command"));
    assert_eq!(output(&["factors", "shape:cube-split", "-o", "-", "--lod-shader", &shader]).lines().count(), 13);
}

#[test]
fn the_first_of_many_views_is_reported_and_a_check_leaves_that_to_its_gates() {
    let folder = Folder::new();
    let shader = write(&folder, "start.wgsl", "2.0 + distance(edge.a, view.eye) / view.radius");
    let [cameras, one, many, config] = ["cameras.txt", "one.png", "{}.png", "pnaen.toml"].map(|name| folder.path(name));
    std::fs::write(&cameras, "side --camera 90,0\nfront --camera 0,0\n").expect("a writable folder");
    let said = |out: &str, more: [&str; 2]| {
        let base = ["render", "shape:torus", "-o", out, "--size", "32x24", "--lod-shader", &shader];
        both(&[&base[..], &more].concat()).1
    };
    let alone = said(&one, ["--camera", "90,0"]);
    assert!(alone.starts_with("pnaen: 384 of 384 edges have different factors on their sides\n"), "{alone}");
    assert_eq!(said(&many, ["--cameras", &cameras]), alone);
    std::fs::write(&config, "[options]\nsize = \"32x24\"\nlod-shader = \"start.wgsl\"\n").expect("a writable folder");
    let errors = failure(&["check", "shape:torus", "--config", &config, "--fail-on", "factors"], 1);
    assert!(!errors.contains("on their sides") && errors.contains("0 passed, 1 failed"), "{errors}");
}
