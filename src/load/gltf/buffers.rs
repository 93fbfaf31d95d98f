//! Reads the bytes of a document's buffers.

use ::gltf::Document;

use super::GltfError;
use super::notes::Notes;
use super::reach::Use;
use crate::uri::{self, Files};
use geometry::progress::Progress;

/// Reads the buffers that are used, and cuts each to the length in the document. `blob` is the binary chunk of a `.glb`. A buffer
/// that is marked in `fallback` stays empty, since its data is decompressed from another buffer. So does one that only details
/// use and that can't be read.
///
/// # Errors
/// [`GltfError::Buffer`] for a buffer that is missing or too short, and [`GltfError::Cancelled`].
pub(super) fn load(
    document: &Document,
    files: &Files,
    (uses, fallback): (&[Use], &[bool]),
    mut blob: Option<Vec<u8>>,
    notes: &mut Notes,
    progress: &Progress,
) -> Result<Vec<Vec<u8>>, GltfError> {
    let json = &document.as_json().buffers;
    let mut buffers = Vec::with_capacity(json.len());
    for (i, buffer) in json.iter().enumerate() {
        progress.check()?;
        let used = uses.get(i).copied().unwrap_or_default();
        if used == Use::None && fallback.get(i) != Some(&true) && buffer.uri.is_none() {
            // The chunk belongs to this buffer and to no other.
            blob = None;
        }
        if used == Use::None || fallback.get(i) == Some(&true) {
            buffers.push(Vec::new());
            continue;
        }
        let length = buffer.byte_length.0;
        let bytes = match &buffer.uri {
            Some(uri) => files.read(uri, true),
            None => {
                blob.take().ok_or_else(|| "the document has no binary chunk for it; export the model again".to_owned())
            }
        };
        // A cancelled read isn't an error of the buffer.
        progress.check()?;
        let uri = || buffer.uri.as_deref().map_or("the binary chunk".to_owned(), uri::shown);
        let bytes = match bytes.and_then(|bytes| cut(bytes, length)) {
            Ok(bytes) => bytes,
            Err(reason) if used == Use::Shape => return Err(GltfError::Buffer { buffer: i, uri: uri(), reason }),
            Err(reason) => {
                notes.push(format!("/buffers/{i} ({}) can't be read: {reason}. It is left out.", uri()));
                Vec::new()
            }
        };
        buffers.push(bytes);
        progress.set(0.3 * (i + 1) as f32 / json.len() as f32);
    }
    Ok(buffers)
}

/// Reads a buffer that is only a copy of data which others hold compressed.
///
/// # Errors
/// A clause if it has no data, or too little.
pub(super) fn read_copy(document: &Document, files: &Files, buffer: usize) -> Result<Vec<u8>, String> {
    let buffer = document.as_json().buffers.get(buffer).ok_or("there is no such buffer")?;
    let uri = buffer.uri.as_deref().ok_or("it has no data")?;
    cut(files.read(uri, true)?, buffer.byte_length.0)
}

fn cut(mut bytes: Vec<u8>, length: u64) -> Result<Vec<u8>, String> {
    match usize::try_from(length) {
        Ok(length) if length <= bytes.len() => {
            bytes.truncate(length);
            Ok(bytes)
        }
        _ => Err(format!("it should have {length} bytes but has {}; export the model again", bytes.len())),
    }
}
