//! Where a mesh comes from.

use std::path::PathBuf;
use std::str::FromStr;

use super::{LoadError, Mesh, Progress, Shape, UnknownShape, load};

/// A file, or a shape made in code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    Shape(Shape),
    File(PathBuf),
}

impl Default for Source {
    fn default() -> Self {
        Self::Shape(Shape::default())
    }
}

impl FromStr for Source {
    type Err = UnknownShape;

    /// `shape:NAME`, or a path.
    fn from_str(text: &str) -> Result<Self, UnknownShape> {
        match text.strip_prefix("shape:") {
            Some(name) => name.parse().map(Self::Shape),
            None => Ok(Self::File(PathBuf::from(text))),
        }
    }
}

impl Source {
    /// What people call it: the file's name, or the shape's.
    pub fn title(&self) -> String {
        match self {
            Self::Shape(shape) => shape.title().to_owned(),
            Self::File(path) => {
                path.file_name().map_or_else(|| path.display(), |name| std::path::Path::new(name).display()).to_string()
            }
        }
    }

    /// Makes the shape or reads the file.
    ///
    /// # Errors
    /// See [`LoadError`].
    pub fn load(&self, progress: &Progress) -> Result<Mesh, LoadError> {
        match self {
            Self::Shape(shape) => Ok(shape.build()),
            Self::File(path) => load(path, progress),
        }
    }
}
