//! Errors in FBX, OBJ, STL, PLY, OFF and 3MF files.

use std::fmt;

use geometry::mesh::{BuildError, MemoryRefused};
use geometry::progress::Cancelled;

/// Why an FBX, OBJ, STL, PLY, OFF or 3MF file could not be loaded. The message doesn't contain the file's path.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum ReadError {
    /// Reading was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Something is wrong at a place in the file.
    #[error("{place}{reason}; export the model again")]
    Broken { place: FilePosition, reason: String },
    /// There is more of something than the program can hold.
    #[error("it has more than {limit} {what}; split it into several files")]
    TooMany { limit: u64, what: &'static str },
    /// The mesh would take too much memory, or have too many triangles.
    #[error("its mesh {reason}; split it into several files")]
    TooLarge { reason: String },
    /// The thread that reads the file can't be started.
    #[error("no thread can be started to read it ({reason}); close other programs and try again")]
    NoThread { reason: String },
    /// The file is a zip archive, but not one of 3MF.
    #[error(
        "it is a zip archive without a 3MF model, which holds {count} files, such as {first}; unpack it and open a model of \
         those"
    )]
    NoModel { count: usize, first: String },
    /// The file has no triangles.
    #[error("no triangles: {holds}")]
    Empty { holds: String },
}

impl From<MemoryRefused> for ReadError {
    fn from(refused: MemoryRefused) -> Self {
        Self::TooLarge { reason: refused.into() }
    }
}

impl From<BuildError> for ReadError {
    fn from(error: BuildError) -> Self {
        match error {
            BuildError::Cancelled(cancelled) => cancelled.into(),
            other => Self::TooLarge { reason: other.to_string() },
        }
    }
}

/// A position in a file, for messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePosition {
    /// The number of a line of text, from 1.
    Line(usize),
    /// The offset of a byte in a binary file, from 0.
    Byte(usize),
    /// The file as a whole.
    Everywhere,
}

impl FilePosition {
    /// Returns an error at this position.
    pub fn error(self, reason: impl Into<String>) -> ReadError {
        ReadError::Broken { place: self, reason: reason.into() }
    }
}

/// Writes the position as the start of a message.
impl fmt::Display for FilePosition {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}: "),
            Self::Byte(byte) => write!(f, "byte {byte}: "),
            Self::Everywhere => Ok(()),
        }
    }
}
