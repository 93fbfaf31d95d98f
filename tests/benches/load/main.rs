//! Times loading a mesh of two million triangles, and `pnaen info` of it, for each format: `cargo bench --bench load`.
//!
//! With `PNAEN_PYTHON=/path/to/python` it also times how long trimesh and pymeshlab load the same files; both must be installed
//! for that Python. All take turns, and what is printed are medians of the turns.

mod files;

use std::hint::black_box;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use pnaen::load::{Limits, load};
use pnaen::progress::Progress;

/// How many quads the mesh has along each direction.
const SIDE: u32 = 1000;

/// The number of turns.
const RUNS: usize = 5;

/// The other programs, as `peers.py` calls them.
const PEERS: [&str; 2] = ["trimesh", "pymeshlab"];

/// Returns how long it takes to read a file into a mesh, in s.
fn loading(path: &Path) -> f64 {
    let start = Instant::now();
    let loaded = load(path, &Limits::default(), &Progress::new()).expect("a file without a fault");
    let taken = start.elapsed().as_secs_f64();
    assert_eq!(black_box(loaded).mesh.triangles.len() as u32, 2 * SIDE * SIDE);
    taken
}

/// Returns how long the program takes to start, load a file, and check and describe the mesh, in s.
fn describing(path: &Path) -> f64 {
    let start = Instant::now();
    let mut info = Command::new(env!("CARGO_BIN_EXE_pnaen"));
    let status = info.arg("info").arg(path).stdout(Stdio::null()).status().expect("the program");
    assert!(status.success(), "{status}");
    start.elapsed().as_secs_f64()
}

/// Returns how long another program takes to load a file, in s; not to start.
fn peer(python: &str, name: &str, path: &Path) -> f64 {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/benches/load/peers.py");
    let output = Command::new(python).args([script, name]).arg(path).output().expect("PNAEN_PYTHON names a Python");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8_lossy(&output.stdout);
    said.split_whitespace().last().and_then(|seconds| seconds.parse().ok()).expect("a number of seconds")
}

fn median(numbers: impl IntoIterator<Item = f64>) -> f64 {
    let mut numbers = Vec::from_iter(numbers);
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn main() {
    let python = std::env::var("PNAEN_PYTHON").ok();
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    println!("| format | load, s | `info`, s | `info` / load | trimesh, s | pymeshlab, s | faster of the two / load |");
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (name, write) in files::FORMATS {
        let path = folder.path().join(name);
        write(&path, SIDE).expect("a writable temporary folder");
        // One turn: loading, info, and the others.
        let turns: Vec<[f64; 4]> = (0..RUNS)
            .map(|_| {
                let others = PEERS.map(|name| python.as_ref().map_or(f64::NAN, |python| peer(python, name, &path)));
                [loading(&path), describing(&path), others[0], others[1]]
            })
            .collect();
        let [load, info, trimesh, pymeshlab] = [0, 1, 2, 3].map(|k| median(turns.iter().map(|turn| turn[k])));
        let of_info = median(turns.iter().map(|turn| turn[1] / turn[0]));
        let of_peers = median(turns.iter().map(|turn| turn[2].min(turn[3]) / turn[0]));
        println!("| {name} | {load:.2} | {info:.2} | {of_info:.2} | {trimesh:.2} | {pymeshlab:.2} | {of_peers:.2} |");
        std::fs::remove_file(&path).expect("a writable temporary folder");
    }
}
