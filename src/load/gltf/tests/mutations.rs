//! Copies of documents with flipped bits, cut ends, swapped bytes and replaced numbers. Each must give a mesh or an
//! error, within a second.
//!
//! `PNAEN_MUTATIONS=10000` tries that many copies; `PNAEN_MUTATE=a.glb:b.gltf` also tries these files, each in its own
//! folder.

use std::panic::catch_unwind;
use std::path::PathBuf;

use fastrand::Rng;

use super::*;
use crate::Format;
use crate::hostile_files::{named_files, unhung};
use crate::ktx2::tests::{ETC1S_ALPHA, UASTC_ZSTD};

/// The number of copies in every run of the tests.
const COPIES: usize = 300;
/// The numbers that replace a number of the JSON.
const NUMBERS: [&str; 8] =
    ["0", "-1", "2147483648", "4294967295", "4611686018427387904", "18446744073709551615", "1e308", "0.5"];
/// The greatest length of a file; longer files would take too much of the time.
const LONGEST: usize = 16 << 20;

/// A document and its folder.
struct Subject {
    name: String,
    bytes: Vec<u8>,
    folder: PathBuf,
}

impl Subject {
    fn own(name: &str, bytes: Vec<u8>) -> Self {
        Self { name: name.to_owned(), bytes, folder: "nowhere".into() }
    }

    fn file(path: PathBuf) -> Self {
        let bytes = std::fs::read(&path).expect("a file that can be read");
        let folder = path.parent().expect("a file has a folder").to_owned();
        Self { name: path.display().to_string(), bytes, folder }
    }
}

fn subjects() -> Vec<Subject> {
    let vase = assets::path("vase.glb");
    let mut subjects = vec![
        Subject::own("a triangle", triangle().document().to_string().into_bytes()),
        Subject::own("something of everything", rich().glb()),
        Subject::own("a material with everything", materials::everything().document().to_string().into_bytes()),
        Subject::own("lights of every kind", lights::of_every_kind().document().to_string().into_bytes()),
        Subject::own("scenes and instances", scenes::of_every_kind().document().to_string().into_bytes()),
        Subject::own("a compressed grid", compressed::grid().glb()),
        Subject::own("a packed grid", packed::grid(packed::Order::Walked).glb()),
        Subject::own("a packed triangle that is skinned", packed::skinned().glb()),
        Subject::own("a texture in ETC1S", textures::extended(None, &[("KHR_texture_basisu", ETC1S_ALPHA)]).glb()),
        Subject::own("a texture in UASTC", textures::extended(None, &[("KHR_texture_basisu", UASTC_ZSTD)]).glb()),
        Subject::own("a texture in WebP", textures::extended(None, &[("EXT_texture_webp", &textures::webp())]).glb()),
        Subject::file(vase),
    ];
    let of_documents = |path: &PathBuf| Format::of_name(path) == Some(Format::Gltf);
    subjects.extend(named_files().into_iter().filter(of_documents).map(Subject::file));
    subjects.retain(|subject| subject.bytes.len() <= LONGEST);
    subjects
}

/// Returns small documents for fuzzers to start from: the target, a name, and the bytes.
pub(crate) fn seeds() -> Vec<(&'static str, String, Vec<u8>)> {
    let drafts = [
        ("triangle", triangle()),
        ("rich", rich()),
        ("materials", materials::everything()),
        ("lights", lights::of_every_kind()),
        ("scenes", scenes::of_every_kind()),
        ("compressed", compressed::grid()),
        ("packed", packed::grid(packed::Order::Walked)),
        ("packed-skinned", packed::skinned()),
        ("etc1s", textures::extended(None, &[("KHR_texture_basisu", ETC1S_ALPHA)])),
        ("uastc", textures::extended(None, &[("KHR_texture_basisu", UASTC_ZSTD)])),
        ("webp", textures::extended(None, &[("EXT_texture_webp", &textures::webp())])),
    ];
    let both = |(name, draft): (&str, Draft)| {
        let document = draft.document().to_string().into_bytes();
        [("gltf", format!("{name}.gltf"), document), ("glb", format!("{name}.glb"), draft.glb())]
    };
    drafts.into_iter().flat_map(both).collect()
}

/// A triangle with a skin, a morph target, a strip of indices and sparse values.
fn rich() -> Draft {
    let mut draft = triangle();
    let (places, indices) = (draft.view(&[2]), draft.indices(&[0, 1, 2]));
    let joints = draft.accessor(&[0; 12], 5121, "VEC4", 3);
    let weights = draft.floats("VEC4", &[0.25; 12]);
    let binds = draft.floats("MAT4", &glam::Mat4::IDENTITY.to_cols_array());
    let primitive = &mut draft.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["JOINTS_0"] = json!(joints);
    primitive["attributes"]["WEIGHTS_0"] = json!(weights);
    primitive["indices"] = json!(indices);
    primitive["mode"] = json!(5);
    primitive["targets"] = json!([{ "POSITION": 0, "NORMAL": 1 }]);
    draft.root["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": { "bufferView": places, "componentType": 5121 },
        "values": { "bufferView": 1 },
    });
    draft.root["meshes"][0]["weights"] = json!([0.5]);
    draft.root["nodes"] = json!([{ "mesh": 0, "skin": 0 }, {}]);
    draft.root["skins"] = json!([{ "joints": [1], "inverseBindMatrices": binds }]);
    draft
}

/// Returns the range of the JSON.
fn json_of(bytes: &[u8]) -> std::ops::Range<usize> {
    if glb::is_glb(bytes) { glb::parts(bytes).map_or(0..0, |parts| parts.json) } else { 0..bytes.len() }
}

/// Changes a document in one to four places.
fn mutate(bytes: &mut Vec<u8>, random: &mut Rng) {
    for _ in 0..=random.usize(..4) {
        let length = bytes.len();
        if length == 0 {
            return;
        }
        match random.usize(..8) {
            0 => bytes[random.usize(..length)] ^= 1 << random.usize(..8),
            1 => {
                // Half of the cuts are near the end, after most of the document.
                let cut = if random.usize(..2) == 0 { random.usize(..length) } else { random.usize(..64).min(length) };
                bytes.truncate(length - cut);
            }
            2 => bytes.swap(random.usize(..length), random.usize(..length)),
            3 => {
                let json = json_of(bytes);
                if !json.is_empty() {
                    bytes[json.start + random.usize(..json.len())] ^= 1 << random.usize(..7);
                }
            }
            _ => replace_number(bytes, random),
        }
    }
}

/// Replaces a number of the JSON; the lengths in a `.glb` stay correct.
fn replace_number(bytes: &mut Vec<u8>, random: &mut Rng) {
    let json = json_of(bytes);
    let is_start = |i: usize| bytes[i].is_ascii_digit() && matches!(bytes[i - 1], b':' | b',' | b'[' | b' ');
    let starts: Vec<usize> = (json.start + 1..json.end).filter(|&i| is_start(i)).collect();
    if starts.is_empty() {
        return;
    }
    let start = starts[random.usize(..starts.len())];
    let is_part = |byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
    let end = start + bytes[start..json.end].iter().take_while(|byte| is_part(byte)).count();
    let mut number = NUMBERS[random.usize(..NUMBERS.len())].to_owned();
    if random.usize(..3) == 0 {
        number = random.usize(..40).to_string();
    }
    let (old, new) = (end - start, number.len());
    bytes.splice(start..end, number.into_bytes());
    if glb::is_glb(bytes) {
        for at in [8, 12] {
            let length = u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
            bytes[at..at + 4].copy_from_slice(&(length + new as u32 - old as u32).to_le_bytes());
        }
    }
}

#[test]
fn mutations_become_a_mesh_or_a_sentence() {
    let copies = std::env::var("PNAEN_MUTATIONS").ok().and_then(|count| count.parse().ok()).unwrap_or(COPIES);
    let subjects = subjects();
    // Nearly all changed copies of documents with Draco data are refused, so they are counted separately.
    let (mut meshes, mut packed, mut others) = (0, 0, 0);
    for copy in 0..copies {
        let subject = &subjects[copy % subjects.len()];
        let is_packed = subject.name.starts_with("a packed");
        others += usize::from(!is_packed);
        let mut random = Rng::with_seed(copy as u64);
        let mut bytes = subject.bytes.clone();
        mutate(&mut bytes, &mut random);
        let folder = subject.folder.clone();
        let reading =
            move || read(bytes, &folder, "mutated", Selection::default(), &Limits::default(), &Progress::new());
        let result = catch_unwind(|| unhung(reading));
        let about = || format!("copy {copy}, of {}", subject.name);
        let result = result.unwrap_or_else(|_| panic!("{} panics", about()));
        match result {
            Ok(mesh) => {
                *(if is_packed { &mut packed } else { &mut meshes }) += 1;
                let (corners, is_sound) =
                    (mesh.corners.len() as u32, |t: &[u32; 3]| t.iter().all(|&c| c < mesh.corners.len() as u32));
                assert!(corners > 0 && mesh.triangles.iter().all(is_sound), "{}", about());
            }
            Err(problem) => assert!(!problem.to_string().contains('\n'), "{}: {problem}", about()),
        }
    }
    println!("{copies} copies of {} documents: {meshes} meshes and {packed} packed ones", subjects.len());
    assert!(meshes > others / 20 && meshes < others, "{meshes} of {others}");
    assert!(packed < copies - others, "{packed} of {}", copies - others);
}

#[test]
fn the_rich_draft_is_read() {
    assert_eq!(rich().read().unwrap().triangles.len(), 1);
}
