//! The seeds of the fuzz targets: small files of every format. `PNAEN_UPDATE_SEEDS=1` writes them.

use super::mutated;
use crate::Format::{Fbx, Gltf, Obj, Off, Ply, Stl, ThreeMf};
use crate::{environment_file, gltf};

fn made() -> Vec<(&'static str, String, Vec<u8>)> {
    let mut made = Vec::new();
    for (i, (format, bytes)) in mutated::originals().into_iter().enumerate() {
        let target = match format {
            Fbx => "fbx",
            Obj => "obj",
            Stl => "stl",
            Ply => "ply",
            Off => "off",
            ThreeMf => "threemf",
            Gltf => unreachable!("its seeds come from its own tests"),
        };
        made.push((target, format!("{i}.{target}"), bytes));
    }
    let short = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf -3//1 -2//-1 -1//1 \\\n\np 1\n".to_vec();
    made.push(("obj", "short.obj".to_owned(), short));
    made.push(("stl", "nothing.stl".to_owned(), vec![0; 84]));
    let colored =
        b"COFF 3 1 3\n0 0 0 255 0 0 255\n1 0 0 0 255 0\n0 1 0 0.1 0.2 1\n3 0 1 2 0.5 0.5 0.5 # gray\n".to_vec();
    made.push(("off", "colored.off".to_owned(), colored));
    made.push(("threemf", "empty.threemf".to_owned(), [&b"PK\x05\x06"[..], &[0; 18]].concat()));
    made.extend(gltf::tests::seeds());
    made.extend(environment_file::tests::seeds());
    let factors = [
        ("ones", [1.0, 1.0, 1.0, 1.0]),
        ("largest", [64.0, 63.0, 64.0, f32::MAX]),
        ("between", [2.5, 7.01, 1.000_01, 3.99]),
        ("odd", [f32::NAN, f32::INFINITY, -0.0, f32::NAN]),
        ("tiny", [1e-45, 1e-38, f32::INFINITY, -1.0]),
    ];
    let bytes = |factors: [f32; 4]| factors.into_iter().flat_map(f32::to_le_bytes).collect();
    made.extend(factors.into_iter().map(|(name, factors)| ("factors", name.to_owned(), bytes(factors))));
    made
}

#[test]
fn seeds_are_what_the_tests_make() {
    let folder = documents::in_repository("tests/fuzzed/seeds");
    for (target, name, bytes) in made() {
        let path = folder.join(target).join(name);
        if std::env::var_os("PNAEN_UPDATE_SEEDS").is_some() {
            std::fs::create_dir_all(folder.join(target)).unwrap();
            std::fs::write(&path, &bytes).unwrap();
        }
        assert!(std::fs::read(&path).is_ok_and(|kept| kept == bytes), "{} differs", path.display());
    }
}
