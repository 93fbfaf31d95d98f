//! What can be wrong with a file that is no document: OBJ, STL and PLY.

use std::fmt;

use crate::mesh::build_limits::BuildError;
use crate::progress::Cancelled;

/// Why such a file became no mesh. The file's own path is not part of the message.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error("{place}{reason}; export the model again")]
    Broken { place: Place, reason: String },
    #[error("it has more than {limit} {what}; split it into several files")]
    TooMany { limit: u64, what: &'static str },
    #[error("its mesh {reason}; split it into several files")]
    TooLarge { reason: String },
    #[error("no triangles: {holds}")]
    Empty { holds: String },
}

impl From<BuildError> for ReadError {
    fn from(error: BuildError) -> Self {
        match error {
            BuildError::Cancelled(cancelled) => cancelled.into(),
            other => Self::TooLarge { reason: other.to_string() },
        }
    }
}

/// Where in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// From 1: of text.
    Line(usize),
    /// From 0: of what is no text.
    Byte(usize),
    Everywhere,
}

impl Place {
    /// An error there.
    pub fn fault(self, reason: impl Into<String>) -> ReadError {
        ReadError::Broken { place: self, reason: reason.into() }
    }
}

/// As the start of a message.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}: "),
            Self::Byte(byte) => write!(f, "byte {byte}: "),
            Self::Everywhere => Ok(()),
        }
    }
}
