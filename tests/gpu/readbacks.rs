//! How often output is read back: once, however much is measured of it.

use std::path::Path;

use clap::Parser;
use inspect::engine::Engine;
use pnaen::cli::{Cli, Command, render_with, tessellate_with};

use crate::engine;

/// Chunks that a command reads back, on an engine that nothing else uses.
fn chunks_read(engine: &Engine, arguments: &[&str], output: &Path) -> u64 {
    let output = output.to_str().expect("a path in UTF-8");
    let all = ["pnaen"].into_iter().chain(arguments.iter().copied()).chain(["-o", output]);
    let command = Cli::try_parse_from(all).expect("a command").command.expect("a command");
    let before = engine.chunks_read();
    match command {
        Command::Render(args) => render_with(&args, "", || Ok(engine.clone())).expect("a picture"),
        Command::Tessellate(args) => tessellate_with(&args, || Ok(engine.clone())).expect("a mesh"),
        other => panic!("{other:?}"),
    }
    engine.chunks_read() - before
}

#[test]
fn each_chunk_is_read_back_once_whatever_is_asked_for() {
    let engine = Engine::new(engine().gpu.clone());
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let [picture, mesh, stats] = ["out.png", "out.obj", "stats.json"].map(|name| folder.path().join(name));
    let settings = ["shape:icosahedron@3", "--factor", "5", "--arena", "1"];
    let with = |command: &'static str, more: &[&'static str]| [&[command], &settings[..], more].concat();
    let read = |arguments: &[&str], output: &Path| chunks_read(&engine, arguments, output);

    let [right, left] = ["pn-aen", "flat"].map(|surface| read(&with("tessellate", &["--surface", surface]), &mesh));
    assert!(right > 1 && left == right, "{right} and {left} chunks of equal factors");
    assert_eq!(read(&with("render", &["--size", "160x120"]), &picture), 0, "nothing is measured");
    let stats = stats.to_str().expect("a path in UTF-8").to_owned();
    let everything = |more: &[&str]| {
        let requested = ["render", "--size", "160x120", "--overlay", "cracks,deviation", "--select", "3"];
        let reference_shape = ["--reference-surface", "shape:icosphere", "--stats", &stats];
        let all = [&requested[..], &settings[..], &reference_shape[..], more].concat();
        let count = read(&all, &picture);
        let text = std::fs::read_to_string(&stats).expect("stats");
        (count, serde_json::from_str::<serde_json::Value>(&text).expect("JSON"))
    };
    let (count, stats) = everything(&[]);
    assert_eq!(count, right, "one walk");
    for key in ["cracks", "max_error_px", "accuracy", "deviation"] {
        assert!(!stats[key].is_null(), "{key} was measured");
    }
    assert!(stats["triangles_in_view"].as_u64() > Some(0), "sizes were measured");
    let (count, stats) = everything(&["--split", "0.5", "--split-left", "flat"]);
    assert_eq!(count, left + right, "one walk over each half");
    assert!(!stats["left"]["accuracy"].is_null(), "the left half was measured too");
}
