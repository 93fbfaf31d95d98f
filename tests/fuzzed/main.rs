//! Runs the fuzz targets without a fuzzer: with every seed, and with copies of seeds in which bytes are changed, cut
//! off or replaced by those of other seeds.

mod bodies;

use std::path::Path;

use proptest::prelude::*;
use proptest::sample::Index;

/// A change to a file: its place, its kind and its value.
type Change = (Index, u8, u32, Index);

/// Returns the files in a target's folder of seeds, sorted by name.
fn seeds(target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzzed/seeds").join(target);
    let mut paths: Vec<_> =
        std::fs::read_dir(folder).expect("seeds").map(|entry| entry.expect("a seed").path()).collect();
    paths.sort();
    paths.iter().map(|path| std::fs::read(path).expect("a seed that can be read")).collect()
}

fn changed(seeds: &[Vec<u8>], seed: Index, changes: &[Change]) -> Vec<u8> {
    let mut bytes = seed.get(seeds).clone();
    for (place, kind, value, other) in changes {
        if bytes.is_empty() {
            break;
        }
        let at = place.index(bytes.len());
        match kind % 6 {
            0 => bytes[at] ^= 1 << (value % 8),
            1 => bytes[at] = *value as u8,
            2 => bytes.iter_mut().skip(at).zip(value.to_le_bytes()).for_each(|(byte, new)| *byte = new),
            3 => bytes.truncate(at),
            4 => _ = bytes.splice(at..at, value.to_string().into_bytes()),
            _ => {
                let other = other.get(seeds);
                let start = *value as usize % other.len().max(1);
                bytes.splice(at.., other[start..].iter().copied());
            }
        }
    }
    bytes
}

/// Runs a target with all its seeds, then with a number of changed copies.
fn run(target: &str, copies: u32, body: fn(&[u8])) {
    let seeds = seeds(target);
    assert!(seeds.len() >= 3, "{target} has {} seeds", seeds.len());
    seeds.iter().for_each(|seed| body(seed));
    let config = ProptestConfig { cases: copies, failure_persistence: None, ..ProptestConfig::default() };
    let changes = prop::collection::vec(any::<Change>(), 1..5);
    let mut runner = proptest::test_runner::TestRunner::new(config);
    let found = runner.run(&(any::<Index>(), changes), |(seed, changes)| {
        body(&changed(&seeds, seed, &changes));
        Ok(())
    });
    assert!(found.is_ok(), "{}", found.err().map_or(String::new(), |error| error.to_string()));
}

#[test]
fn gltf() {
    run("gltf", 10_000, bodies::gltf);
}

#[test]
fn glb() {
    run("glb", 10_000, bodies::glb);
}

#[test]
fn fbx() {
    run("fbx", 10_000, bodies::fbx);
}

#[test]
fn obj() {
    run("obj", 10_000, bodies::obj);
}

#[test]
fn stl() {
    run("stl", 10_000, bodies::stl);
}

#[test]
fn ply() {
    run("ply", 10_000, bodies::ply);
}

#[test]
fn panorama() {
    run("panorama", 1000, bodies::panorama);
}

#[test]
fn off() {
    run("off", 10_000, bodies::off);
}

#[test]
fn threemf() {
    run("threemf", 10_000, bodies::threemf);
}

#[test]
fn factors() {
    run("factors", 200, bodies::factors);
}
