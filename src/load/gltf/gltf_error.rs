//! Errors in glTF documents.

use crate::mesh::build_limits::BuildError;
use crate::progress::Cancelled;

/// Why a glTF document could not be loaded. The message doesn't contain the file's path. Places in the document are
/// JSON pointers (RFC 6901).
#[derive(Debug, thiserror::Error)]
pub enum GltfError {
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error("not a glTF 2.0 document: {reason}; export the model again as glTF 2.0")]
    NotGltf { reason: String },
    #[error("/extensionsRequired/{place} is {name}, which isn't supported; export the model without it")]
    Extension { place: usize, name: String },
    #[error("{pointer} {reason}; export the model again")]
    Document { pointer: String, reason: String },
    #[error("/buffers/{buffer} ({uri}) can't be read: {reason}")]
    Buffer { buffer: usize, uri: String, reason: String },
    #[error("/accessors/{accessor} ({role}) {reason}; export the model again")]
    Accessor { accessor: usize, role: String, reason: String },
    #[error("{primitive} {reason}; export the model again")]
    Primitive { primitive: String, reason: String },
    #[error("{pointer} {reason}; decompress the model first, for example with gltf-transform")]
    Draco { pointer: String, reason: String },
    #[error("{what} {reason}; split the model into several files")]
    TooLarge { what: String, reason: String },
    #[error("no triangles: {holds}")]
    Empty { holds: String },
}

impl From<BuildError> for GltfError {
    fn from(error: BuildError) -> Self {
        match error {
            BuildError::Cancelled(cancelled) => cancelled.into(),
            other => Self::TooLarge { what: "the scene".to_owned(), reason: other.to_string() },
        }
    }
}
