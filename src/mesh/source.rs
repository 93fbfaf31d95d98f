//! Where a mesh comes from: a shape made in code, or a file.

use std::ffi::OsString;
use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use super::load::{LoadError, load};
use super::shapes::{Shape, UnknownShape};
use super::{Mesh, Progress};

/// What comes before a shape's name.
const SHAPE: &str = "shape:";

/// A shape or a file. As text: `shape:torus`, or a path.
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

impl Source {
    /// Builds the shape or reads the file.
    ///
    /// # Errors
    /// Those of [`load`]; a shape has none.
    pub fn load(&self, progress: &Progress) -> Result<Mesh, LoadError> {
        match self {
            Self::Shape(shape) => Ok(shape.build()),
            Self::File(path) => load(path, progress),
        }
    }

    /// A name for a window's title: the shape's, or the file's without its folder.
    pub fn title(&self) -> String {
        match self {
            Self::Shape(shape) => shape.title().to_owned(),
            Self::File(path) => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
        }
    }
}

impl TryFrom<OsString> for Source {
    type Error = UnknownShape;

    /// As from text, but a path may be in any encoding.
    fn try_from(text: OsString) -> Result<Self, UnknownShape> {
        match text.to_str() {
            Some(text) => text.parse(),
            None => Ok(Self::File(text.into())),
        }
    }
}

impl FromStr for Source {
    type Err = UnknownShape;

    fn from_str(text: &str) -> Result<Self, UnknownShape> {
        match text.strip_prefix(SHAPE) {
            Some(name) => name.parse().map(Self::Shape),
            None => Ok(Self::File(text.into())),
        }
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape(shape) => write!(f, "{SHAPE}{shape}"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_names_a_shape_or_a_file() {
        assert_eq!("shape:torus".parse(), Ok(Source::Shape(Shape::Torus)));
        assert_eq!("torus".parse(), Ok(Source::File("torus".into())));
        assert!("shape:nothing".parse::<Source>().is_err());
        assert_eq!(Source::Shape(Shape::Torus).to_string(), "shape:torus");
    }

    #[test]
    fn titles_are_short() {
        assert_eq!(Source::File("models/fox.glb".into()).title(), "fox.glb");
        assert_eq!(Source::Shape(Shape::Moebius).title(), "Moebius strip");
    }

    #[test]
    fn shapes_load() {
        let mesh = Source::Shape(Shape::Icosphere).load(&Progress::new()).unwrap();
        assert_eq!(mesh.triangles.len(), 80);
    }
}
