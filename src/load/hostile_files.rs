//! Tests with FBX, OBJ, STL, PLY, OFF and 3MF files that are broken or hostile: what the loader answers, and that it never takes long.

mod mutated;
pub(in crate::load) mod odd;
pub(in crate::load) mod page;
mod seeds;
mod table;

use std::fmt::{Debug, Display};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use super::{Format, ReadError, fbx, obj, off, ply, stl, threemf};
use crate::files::Limits;
use crate::load::selection::Selection;
use crate::load::{Import, LoadedMesh};
use crate::progress::Progress;

/// The longest time that reading a file may take, in CPU time of this thread.
const LIMIT: Duration = Duration::from_secs(1);

/// Returns this thread's CPU time, to which other tests on a busy machine don't add. Returns the elapsed time on systems without
/// such a clock.
pub(in crate::load) fn time() -> Duration {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    let said = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = said.and_then(|said| said.split(' ').next()?.parse().ok());
    nanoseconds.map_or_else(|| START.elapsed(), Duration::from_nanos)
}

/// Whether an error is the expected one: its variant, followed by parts of its message (the place and the numbers), all separated
/// by ` | `. The pages in `docs/hostile` hold the whole sentences.
pub(in crate::load) fn is_expected(error: &(impl Debug + Display), expected: &str) -> bool {
    let (variant, parts) = expected.split_once(" | ").unwrap_or((expected, ""));
    let debug = format!("{error:?}");
    let own = debug.split(|letter: char| !letter.is_alphanumeric()).next();
    own == Some(variant) && mentions(&error.to_string(), parts)
}

/// Whether a message has all these parts, which are separated by ` | `, as whole words and numbers.
pub(in crate::load) fn mentions(message: &str, parts: &str) -> bool {
    let in_word = |letter: Option<char>| letter.is_some_and(char::is_alphanumeric);
    let is_whole = |start: usize, part: &str| {
        let (before, after) = (&message[..start], &message[start + part.len()..]);
        let joins_before = in_word(before.chars().next_back()) && in_word(part.chars().next());
        let joins_after = in_word(part.chars().next_back()) && in_word(after.chars().next());
        !joins_before && !joins_after
    };
    parts.split(" | ").all(|part| message.match_indices(part).any(|(start, _)| is_whole(start, part)))
}

/// The files that `PNAEN_MUTATE` names, as `a.glb:b.obj`.
pub(super) fn named_files() -> Vec<PathBuf> {
    let named = std::env::var("PNAEN_MUTATE").unwrap_or_default();
    named.split(':').filter(|path| !path.is_empty()).map(PathBuf::from).collect()
}

fn read(format: Format, bytes: &[u8]) -> Result<LoadedMesh, ReadError> {
    let start = time();
    let progress = Progress::new();
    let loaded = match format {
        // On this thread, whose time is measured.
        Format::Fbx => fbx::read_here(
            bytes.to_vec(),
            Path::new("nowhere"),
            "broken",
            Import::default(),
            &Limits::default(),
            &progress,
        ),
        Format::Obj => obj::read(
            bytes.to_vec(),
            Path::new("nowhere"),
            "broken",
            Selection::default(),
            &Limits::default(),
            &progress,
        ),
        Format::Stl => stl::read(bytes.to_vec(), "broken", Selection::default(), &Limits::default(), &progress),
        Format::Ply => {
            ply::read(bytes.to_vec(), Path::new("nowhere"), "broken", Import::default(), &Limits::default(), &progress)
        }
        Format::Off => off::read(bytes.to_vec(), "broken", Import::default(), &Limits::default(), &progress),
        Format::ThreeMf => threemf::read(bytes.to_vec(), "broken", Import::default(), &Limits::default(), &progress),
        Format::Gltf => panic!("glTF has hostile files of its own, in gltf/tests"),
    };
    let (took, length) = (time() - start, bytes.len());
    assert!(took < LIMIT, "{format:?} of {length} bytes took {took:?}");
    loaded
}
