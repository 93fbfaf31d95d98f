//! Errors in glTF documents.

use geometry::mesh::build_limits::{BuildError, MemoryRefused};
use geometry::progress::Cancelled;

/// Why a glTF document could not be loaded. The message doesn't contain the file's path. Places in the document are
/// JSON pointers (RFC 6901).
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum GltfError {
    /// The load was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The file is no glTF 2.0 document.
    #[error("not a glTF 2.0 document: {reason}; export the model again as glTF 2.0")]
    NotGltf { reason: String },
    /// The document requires an extension that changes the shape and isn't read, or that isn't known.
    #[error("/extensionsRequired/{place} is {name}, {reason}; {remedy}")]
    Extension { place: usize, name: String, reason: String, remedy: &'static str },
    /// A member of the document has a value that it can't have.
    #[error("{pointer} {reason}; {}", remedy(pointer))]
    Document { pointer: String, reason: String },
    /// A buffer could not be read.
    #[error("/buffers/{buffer} ({uri}) can't be read: {reason}")]
    Buffer { buffer: usize, uri: String, reason: String },
    /// An accessor's data can't be what the document says.
    #[error("/accessors/{accessor} ({role}) {reason}; export the model again")]
    Accessor { accessor: usize, role: String, reason: String },
    /// A primitive can't be used.
    #[error("{primitive} {reason}; export the model again")]
    Primitive { primitive: String, reason: String },
    /// A compressed primitive could not be decompressed.
    #[error("{pointer} {reason}; decompress the model first, for example with gltf-transform")]
    Draco { pointer: String, reason: String },
    /// Something would take too much memory, or have too many triangles.
    #[error("{what} {reason}; split the model into several files")]
    TooLarge { what: String, reason: String },
    /// The scene has no triangles.
    #[error("no triangles: {holds}")]
    Empty { holds: String },
}

impl GltfError {
    pub(super) fn large_json(refused: MemoryRefused) -> Self {
        Self::Document { pointer: "its JSON".to_owned(), reason: refused.into() }
    }

    pub(super) fn large_scene(refused: MemoryRefused) -> Self {
        Self::too_large("the scene")(refused)
    }

    /// The error of `what`, which takes too much memory.
    pub(super) fn too_large(what: &str) -> impl Fn(MemoryRefused) -> Self {
        move |refused| Self::TooLarge { what: what.to_owned(), reason: refused.into() }
    }

    /// Says why something that a model can do without isn't read, as a clause.
    pub(super) fn into_clause(self) -> String {
        match self {
            Self::Accessor { reason, .. } => reason,
            Self::Document { pointer, reason } => format!("can't be used: {pointer} {reason}"),
            other => format!("can't be used: {other}"),
        }
    }
}

/// Returns what a user can do about a member.
fn remedy(pointer: &str) -> &'static str {
    if pointer.starts_with("/skins/") || pointer.ends_with("/skin") {
        // Vertices may lie anywhere before their joints place them.
        "without its skin the shape isn't known: export the model again, or without bones and as it stands"
    } else {
        "export the model again"
    }
}

impl From<BuildError> for GltfError {
    fn from(error: BuildError) -> Self {
        match error {
            BuildError::Cancelled(cancelled) => cancelled.into(),
            other => Self::TooLarge { what: "the scene".to_owned(), reason: other.to_string() },
        }
    }
}
