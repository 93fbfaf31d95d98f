//! What can be wrong with a glTF document.

use crate::mesh::progress::Cancelled;

/// Why a glTF document became no mesh. The file's own path is not part of the message.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error("not a glTF 2.0 document: {reason}; export the model again as glTF 2.0")]
    NotGltf { reason: String },
    #[error("the document requires the extension {name}, which isn't supported; export the model without it")]
    Extension { name: String },
    #[error("buffer {buffer} ({uri}) can't be read: {reason}")]
    Buffer { buffer: usize, uri: String, reason: String },
    #[error("accessor {accessor} ({role}) {reason}; export the model again")]
    Accessor { accessor: usize, role: String, reason: String },
    #[error("{primitive} {reason}; export the model again")]
    Primitive { primitive: String, reason: String },
    #[error("the scene has more than {limit} triangles; split it into several files")]
    TooLarge { limit: usize },
    #[error("no triangles: {holds}")]
    Empty { holds: String },
}
