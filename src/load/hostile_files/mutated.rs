//! Copies of good files with changed bits, ends and numbers. Each must give a mesh or an error, without a panic and
//! without taking for ever.
//!
//! `PNAEN_MUTATIONS` and `PNAEN_MUTATE` work as for glTF documents: see `load/gltf/tests/mutations.rs`.

use fastrand::Rng;

use super::read;
use crate::Format::{self, Fbx, Obj, Off, Ply, Stl, ThreeMf};
use crate::{fbx, obj, off, ply, stl, threemf};

/// The texts that replace a number.
const NUMBERS: [&str; 5] = ["0", "-1", "4611686018427387904", "1e308", "nan"];

pub(super) fn originals() -> Vec<(Format, Vec<u8>)> {
    let mut originals = vec![
        (Obj, obj::tests::cube().into_bytes()),
        (Obj, obj::tests::everything().into_bytes()),
        (Stl, stl::tests::text().into_bytes()),
        (Stl, stl::tests::binary(b"solid cube")),
        (Ply, ply::tests::strip("0 1 2 -1 3 4 5").into_bytes()),
    ];
    originals.extend(fbx::tests::files().into_iter().map(|file| (Fbx, file)));
    originals.extend((0..3).map(|encoding| (Ply, ply::tests::cube(encoding, 6, 4))));
    originals.extend([off::tests::cube(), off::tests::everything()].map(|text| (Off, text.into_bytes())));
    originals.extend(
        [
            threemf::tests::cube(),
            threemf::tests::everything(),
            threemf::tests::with_texture(),
            threemf::tests::layers::many_layers(3),
        ]
        .map(|file| (ThreeMf, file)),
    );
    originals
}

/// Returns the files that `PNAEN_MUTATE` names, without those of glTF, whose own tests take them.
fn files() -> impl Iterator<Item = (Format, Vec<u8>)> {
    crate::hostile_files::named_files().into_iter().filter_map(|path| {
        let format = Format::of_name(&path).filter(|format| *format != Format::Gltf)?;
        Some((format, std::fs::read(path).expect("a file that can be read")))
    })
}

fn mutate(bytes: &mut Vec<u8>, random: &mut Rng) {
    for _ in 0..=random.usize(..4) {
        let at = random.usize(..bytes.len().max(1));
        match random.usize(..8) {
            0 => bytes.truncate(at),
            1 | 2 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << random.usize(..8)),
            3 => {
                let number = [0, u32::MAX, 1 << 30, f32::NAN.to_bits(), f32::MAX.to_bits()][random.usize(..5)];
                bytes.iter_mut().skip(at).zip(number.to_le_bytes()).for_each(|(byte, new)| *byte = new);
            }
            _ => replace_number(bytes, at, NUMBERS[random.usize(..NUMBERS.len())]),
        }
    }
}

/// Replaces the first group of digits from a position on.
fn replace_number(bytes: &mut Vec<u8>, from: usize, by: &str) {
    let Some(start) = bytes.iter().skip(from).position(u8::is_ascii_digit).map(|i| i + from) else { return };
    let length = bytes[start..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    bytes.splice(start..start + length, by.bytes());
}

#[test]
fn mutated_copies_are_read_or_refused() {
    let copies = std::env::var("PNAEN_MUTATIONS").ok().and_then(|copies| copies.parse().ok()).unwrap_or(300);
    let originals: Vec<_> = originals().into_iter().chain(files()).collect();
    for (format, bytes) in &originals {
        assert!(read(*format, bytes).is_ok(), "{format:?}");
    }
    let (mut random, mut refused) = (Rng::with_seed(1), 0);
    for i in 0..copies {
        let (format, mut bytes) = originals[i % originals.len()].clone();
        mutate(&mut bytes, &mut random);
        if let Err(fault) = read(format, &bytes) {
            let message = fault.to_string();
            assert!(message.len() < 300 && !message.contains(char::is_control), "{message}");
            refused += 1;
        }
    }
    println!("{copies} copies of {} files: {refused} refused", originals.len());
    assert!(refused > copies / 10 && refused < copies, "{refused} of {copies} were refused");
}
