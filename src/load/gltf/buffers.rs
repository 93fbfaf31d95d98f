//! Reads the bytes of a document's buffers.

use ::gltf::Document;

use super::GltfError;
use crate::load::uri::{self, Files};
use crate::progress::Progress;

/// Reads all buffers, and cuts each to the length in the document. `blob` is the binary chunk of a `.glb`. A buffer
/// that is marked in `fallback` stays empty, since its data is decompressed from another buffer.
///
/// # Errors
/// [`GltfError::Buffer`] for a buffer that is missing or too short, and [`GltfError::Cancelled`].
pub(super) fn load(
    document: &Document,
    files: &Files,
    fallback: &[bool],
    mut blob: Option<Vec<u8>>,
    progress: &Progress,
) -> Result<Vec<Vec<u8>>, GltfError> {
    let json = &document.as_json().buffers;
    let mut buffers = Vec::with_capacity(json.len());
    for (i, buffer) in json.iter().enumerate() {
        progress.check()?;
        if fallback.get(i) == Some(&true) {
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
        buffers.push(bytes.and_then(|bytes| cut(bytes, length)).map_err(|reason| {
            let uri = buffer.uri.as_deref().map_or("the binary chunk".to_owned(), uri::shown);
            GltfError::Buffer { buffer: i, uri, reason }
        })?);
        progress.set(0.3 * (i + 1) as f32 / json.len() as f32);
    }
    Ok(buffers)
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
