//! Reads the bytes of a document's buffers, each when something first needs it.

use std::cell::OnceCell;

use ::gltf::Document;
use ::gltf::json::Buffer;

use super::GltfError;
use super::schema_check::Faults;
use crate::uri::{self, Files};

/// The buffers of a document.
pub(crate) struct Buffers<'a> {
    list: &'a [Buffer],
    /// For each buffer, whether it is only a fallback for programs that can't decompress, and may have no data.
    fallback: &'a [bool],
    faults: &'a Faults,
    files: &'a Files<'a>,
    /// What was read, cut to the lengths in the document; or a clause that says what is wrong.
    read: Vec<OnceCell<Result<Vec<u8>, String>>>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(
        document: &'a Document,
        fallback: &'a [bool],
        faults: &'a Faults,
        files: &'a Files<'a>,
        chunk: Option<Vec<u8>>,
    ) -> Self {
        let list = &document.as_json().buffers[..];
        let may_own = |i: &usize| list[*i].uri.is_none() && !fallback[*i] && faults.check("buffers", *i).is_ok();
        let mut read: Vec<_> = list.iter().map(|_| OnceCell::new()).collect();
        // The binary chunk of a `.glb` is the first of these.
        if let Some((owner, chunk)) = (0..list.len()).find(may_own).zip(chunk) {
            read[owner] = OnceCell::from(cut(chunk, list[owner].byte_length.0));
        }
        Self { list, fallback, faults, files, read }
    }

    /// Returns the bytes of a buffer. A fallback without a URI has none.
    ///
    /// # Errors
    /// [`GltfError::Document`] for one that is wrong, [`GltfError::Buffer`] for one that is missing or too short, and
    /// [`GltfError::Cancelled`].
    pub(super) fn bytes(&self, i: usize) -> Result<&[u8], GltfError> {
        self.faults.check("buffers", i)?;
        let Some((buffer, read)) = self.list.get(i).zip(self.read.get(i)) else { return Ok(&[]) };
        let read = read.get_or_init(|| match &buffer.uri {
            Some(uri) => cut(self.files.read(uri, true)?, buffer.byte_length.0),
            None if self.fallback[i] => Ok(Vec::new()),
            None => Err("the document has no binary chunk for it; export the model again".to_owned()),
        });
        // A cancelled read isn't an error of the buffer.
        self.files.progress.check()?;
        let uri = || buffer.uri.as_deref().map_or("the binary chunk".to_owned(), uri::shown);
        read.as_deref().map_err(|reason| GltfError::Buffer { buffer: i, uri: uri(), reason: reason.clone() })
    }

    /// Returns the size of all buffers that were read, in bytes.
    pub(super) fn size(&self) -> u64 {
        self.read.iter().filter_map(|read| Some(read.get()?.as_ref().ok()?.len() as u64)).sum()
    }
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
