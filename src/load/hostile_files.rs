//! Tests with FBX, OBJ, STL, PLY, OFF and 3MF files that are broken or hostile: what the loader answers, and that it always does.

mod mutated;
pub(crate) mod odd;
pub(crate) mod page;
mod seeds;
mod table;

use std::fmt::{Debug, Display};
use std::path::PathBuf;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use super::{Format, ReadError, fbx, obj, off, ply, stl, threemf};
use crate::LoadedMesh;
use crate::model_file::ModelFile;
use geometry::progress::Progress;

/// How long reading a file is waited for.
const PATIENCE: Duration = Duration::from_secs(100);

/// Reads a file on a thread of its own. No time is measured: this is for files that would hang a reader, so that the test fails
/// instead. Files that would take quadratic time are so long that this comes to hours, where a busy machine takes some seconds.
///
/// # Panics
/// If `read` panics, or doesn't come to an end.
pub(crate) fn unhung<T: Send + 'static>(read: impl FnOnce() -> T + Send + 'static) -> T {
    let (sender, receiver) = channel();
    let reading = std::thread::spawn(move || sender.send(read()));
    match receiver.recv_timeout(PATIENCE) {
        Ok(result) => result,
        Err(RecvTimeoutError::Timeout) => panic!("reading hasn't come to an end after {PATIENCE:?}"),
        Err(RecvTimeoutError::Disconnected) => match reading.join() {
            Err(panic) => std::panic::resume_unwind(panic),
            Ok(_) => unreachable!("it sends what it reads"),
        },
    }
}

/// Whether an error is the expected one: its variant, followed by parts of its message (the place and the numbers), all separated
/// by ` | `. The pages in `docs/hostile` hold the whole sentences.
pub(crate) fn is_expected(error: &(impl Debug + Display), expected: &str) -> bool {
    let (variant, parts) = expected.split_once(" | ").unwrap_or((expected, ""));
    let debug = format!("{error:?}");
    let own = debug.split(|letter: char| !letter.is_alphanumeric()).next();
    own == Some(variant) && mentions(&error.to_string(), parts)
}

/// Whether a message has all these parts, which are separated by ` | `, as whole words and numbers.
pub(crate) fn mentions(message: &str, parts: &str) -> bool {
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
    let bytes = bytes.to_vec();
    unhung(move || {
        let progress = Progress::new();
        let file = &ModelFile::of_test("broken", &progress);
        match format {
            Format::Fbx => fbx::read(bytes, file),
            Format::Obj => obj::read(bytes, file),
            Format::Stl => stl::read(bytes, file),
            Format::Ply => ply::read(bytes, file),
            Format::Off => off::read(bytes, file),
            Format::ThreeMf => threemf::read(bytes, file),
            Format::Gltf => panic!("glTF has hostile files of its own, in gltf/tests"),
        }
    })
}
