//! Runs the fuzz targets without a fuzzer: with every good and odd file of the corpus, and with copies of them in which bytes and numbers
//! are changed, cut off or replaced by those of other files.
//!
//! `PNAEN_MUTATIONS=100000` tries that many copies of each format; `PNAEN_MUTATE=a.glb:b.obj` also tries these files, each in its own
//! folder.

mod bodies;
#[path = "../corpus/cases.rs"]
mod cases;

// The name that the crate has everywhere else.
extern crate pnaen_load as load;

use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

use load::format::Format;
use proptest::prelude::*;
use proptest::sample::Index;

/// A change to a file: its place, its kind and its value.
type Change = (Index, u8, u32, Index);

/// The texts that replace a number, and the numbers that replace four bytes.
const TEXTS: [&str; 10] =
    ["0", "-1", "2147483648", "4294967295", "4611686018427387904", "18446744073709551615", "1e308", "0.5", "nan", "7"];
const NUMBERS: [u32; 5] = [0, u32::MAX, 1 << 30, f32::NAN.to_bits(), f32::MAX.to_bits()];

/// The greatest length of a file that is named; longer files would take too much of the time.
const LONGEST: usize = 16 << 20;

/// A file to change, and the path that it is read with.
struct Seed {
    path: String,
    bytes: Vec<u8>,
}

/// Returns a target's files of the corpus, the vase that the program opens first, and those that are named.
fn seeds(target: &str) -> Vec<Seed> {
    let folders = ["good", "odd"].map(|kind| format!("corpus/{target}/{kind}"));
    let own = folders.iter().flat_map(|folder| cases::cases(folder));
    let mut seeds: Vec<_> = own.map(|case| Seed { bytes: case.bytes(), path: case.path }).collect();
    if target == "glb" {
        seeds.push(Seed { bytes: assets::VASE.to_vec(), path: bodies::NOWHERE.to_owned() });
    }
    let named = std::env::var("PNAEN_MUTATE").unwrap_or_default();
    for path in named.split(':').filter(|path| is_of(target, Path::new(path))) {
        let bytes = std::fs::read(path).expect("a file that can be read");
        if bytes.len() <= LONGEST {
            seeds.push(Seed { bytes, path: path.to_owned() });
        }
    }
    seeds
}

/// Whether a file that is named is one for this target.
fn is_of(target: &str, path: &Path) -> bool {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    ending == target
        || [("threemf", "3mf"), ("panorama", "hdr"), ("panorama", "exr"), ("glb", "vrm")].contains(&(target, &*ending))
}

fn changed(seeds: &[Seed], seed: &Seed, changes: &[Change]) -> Vec<u8> {
    let mut bytes = seed.bytes.clone();
    for (place, kind, value, other) in changes {
        if bytes.is_empty() {
            break;
        }
        let (at, value) = (place.index(bytes.len()), *value);
        match kind % 14 {
            0 => bytes[at] ^= 1 << (value % 8),
            1 => bytes[at] = value as u8,
            2 => {
                let number = NUMBERS.get(value as usize % 10).unwrap_or(&value);
                bytes.iter_mut().skip(at).zip(number.to_le_bytes()).for_each(|(byte, new)| *byte = new);
            }
            // Half of the cuts are near the end, after most of the file.
            3 if value % 2 == 0 => bytes.truncate(at),
            3 => bytes.truncate(bytes.len().saturating_sub(value as usize % 64)),
            4 => _ = bytes.splice(at..at, value.to_string().into_bytes()),
            5 => {
                let other = &other.get(seeds).bytes;
                let start = value as usize % other.len().max(1);
                bytes.splice(at.., other[start..].iter().copied());
            }
            6 => {
                let other = value as usize % bytes.len();
                bytes.swap(at, other);
            }
            _ => replace_number(&mut bytes, at, value as usize),
        }
    }
    bytes
}

/// Replaces the first group of digits from a position on; the lengths in a `.glb` stay correct.
fn replace_number(bytes: &mut Vec<u8>, from: usize, value: usize) {
    let Some(start) = bytes[from..].iter().position(u8::is_ascii_digit).map(|i| i + from) else { return };
    let old = bytes[start..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let new = if value.is_multiple_of(3) { (value % 41).to_string() } else { TEXTS[value % TEXTS.len()].to_owned() };
    let grown = (new.len() as u32).wrapping_sub(old as u32);
    bytes.splice(start..start + old, new.into_bytes());
    if bytes.starts_with(b"glTF") {
        for length in [8, 12].into_iter().filter(|at| at + 4 <= start) {
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| bytes[length + i]);
            bytes[length..length + 4]
                .copy_from_slice(&u32::from_le_bytes([a, b, c, d]).wrapping_add(grown).to_le_bytes());
        }
    }
}

/// Runs a target with all its seeds, then with a number of changed copies, of which neither nearly all nor nearly none may be refused.
fn run(target: &str, copies: u32, body: fn(&[u8], &str) -> bool) {
    let seeds = seeds(target);
    assert!(seeds.len() >= 3, "{target} has {} seeds", seeds.len());
    for seed in &seeds {
        assert!(body(&seed.bytes, &seed.path), "a good or an odd file of {target} is refused");
    }
    let copies = std::env::var("PNAEN_MUTATIONS").ok().and_then(|copies| copies.parse().ok()).unwrap_or(copies);
    let config = ProptestConfig { cases: copies, failure_persistence: None, ..ProptestConfig::default() };
    let changes = prop::collection::vec(any::<Change>(), 1..5);
    let read = AtomicU32::new(0);
    let mut runner = proptest::test_runner::TestRunner::new(config);
    let found = runner.run(&(any::<Index>(), changes), |(seed, changes)| {
        let seed = seed.get(&seeds);
        read.fetch_add(u32::from(body(&changed(&seeds, seed, &changes), &seed.path)), Ordering::Relaxed);
        Ok(())
    });
    assert!(found.is_ok(), "{}", found.err().map_or(String::new(), |error| error.to_string()));
    let read = read.into_inner();
    println!("{copies} copies of {} files: {} refused", seeds.len(), copies - read);
    assert!((copies / 50..copies - copies / 50).contains(&read), "{read} of {copies} were read");
}

macro_rules! tests {
    ($($name:ident $copies:literal $body:expr;)+) => {
        $(#[test]
        fn $name() {
            run(stringify!($name), $copies, $body);
        })+
    };
}

bodies::targets!(tests);
