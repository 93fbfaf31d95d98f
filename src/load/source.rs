//! The source of a mesh: a shape made in code, or a file.

use std::ffi::OsString;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use super::format::Format;
use super::import::Import;
use super::loaded_mesh::LoadedMesh;
use super::mesh_file::{LoadError, check_selected, load_selected, read};
use super::selection::Selection;
use crate::files::Limits;
use geometry::mesh::Mesh;
use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::normals::NormalSource;
use geometry::mesh::shapes::{MAX_LEVEL, Shape, ShapeError};
use geometry::progress::{Cancelled, Progress};

/// The prefix of a shape's name.
const SHAPE: &str = "shape:";

/// The name of the vase.
const VASE: &str = "vase";

/// A shape, the vase or a file. Its text form is `shape:torus`, `shape:torus@2`, `shape:vase`, or a path.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Source {
    Shape(Shape),
    /// A shape with levels, at a level from 1 to [`MAX_LEVEL`]. At level 0 it is a `Shape`.
    FineShape(Shape, u32),
    /// A painted vase of few triangles, which is part of the program: what the window opens if no mesh is named.
    #[default]
    Vase,
    File(PathBuf),
}

impl Source {
    /// Builds the shape, or loads the file within `limits`.
    ///
    /// # Errors
    /// The same as [`load_selected`]'s; a shape has none.
    pub fn load(&self, limits: &Limits, progress: &Progress) -> Result<LoadedMesh, LoadError> {
        self.load_selected(Selection::default(), limits, progress)
    }

    /// Builds the shape, or loads the file within `limits` with the materials of a variant, or another scene than the default one.
    ///
    /// # Errors
    /// The same as [`load_selected`]'s; a shape has only [`LoadError::Absent`], [`LoadError::Shape`] and [`LoadError::Cancelled`].
    pub fn load_selected(
        &self,
        selected: Selection,
        limits: &Limits,
        progress: &Progress,
    ) -> Result<LoadedMesh, LoadError> {
        let loaded = match self {
            Self::Shape(shape) => self.made(shape.build(), selected.import, progress),
            Self::FineShape(shape, level) => self.made(shape.build_at(*level), selected.import, progress),
            Self::Vase => read(Format::Gltf, assets::VASE.to_vec(), Path::new("vase.glb"), selected, limits, progress),
            Self::File(path) => return load_selected(path, selected, limits, progress),
        }?;
        check_selected(self.to_string().as_ref(), selected, &loaded.contents)?;
        Ok(loaded)
    }

    /// Returns a shape, whose normals may be made anew.
    ///
    /// # Errors
    /// [`LoadError::Shape`] if another place was asked for, since its exact surface doesn't move, and [`LoadError::Cancelled`].
    fn made(&self, mesh: Mesh, import: Import, progress: &Progress) -> Result<LoadedMesh, LoadError> {
        if import.up.is_some() || import.unit.is_some() {
            return Err(LoadError::Shape { shape: self.to_string() });
        }
        let mesh =
            if import.normals == NormalSource::Made { with_made_normals(mesh, &import, progress)? } else { mesh };
        Ok(LoadedMesh { mesh, ..LoadedMesh::default() })
    }

    /// Returns a shape at the level that followed its name.
    fn at_level(shape: Shape, level: &str) -> Result<Self, ShapeError> {
        if !shape.has_levels() {
            return Err(ShapeError::NoLevels { shape });
        }
        match level.parse() {
            Ok(0) => Ok(Self::Shape(shape)),
            Ok(level) if level <= MAX_LEVEL => Ok(Self::FineShape(shape, level)),
            _ => Err(ShapeError::Level { text: level.to_owned() }),
        }
    }

    /// Returns the shape at any level; none for a file.
    pub fn shape(&self) -> Option<Shape> {
        match self {
            Self::Shape(shape) | Self::FineShape(shape, _) => Some(*shape),
            Self::Vase | Self::File(_) => None,
        }
    }

    /// Returns a name for a window's title: the shape's name, or the file's name without its folder.
    pub fn title(&self) -> String {
        match self {
            Self::Shape(shape) => shape.title().to_owned(),
            Self::FineShape(shape, level) => shape.title_at(*level),
            Self::Vase => "Vase".to_owned(),
            Self::File(path) => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
        }
    }
}

/// Returns a shape with normals that are made from its triangles.
fn with_made_normals(mesh: Mesh, import: &Import, progress: &Progress) -> Result<Mesh, Cancelled> {
    let mut builder = MeshBuilder::with_crease_angle(import.crease_angle);
    for material in &mesh.materials {
        let own = builder.material(material.clone());
        for triangle in &mesh.triangles[material.triangles.start as usize..material.triangles.end as usize] {
            let corner = |id: u32| InputCorner { normal: None, ..mesh.corners[id as usize].into() };
            builder.triangle(own, triangle.map(corner));
        }
    }
    builder.finish(mesh.name, progress)
}

impl TryFrom<OsString> for Source {
    type Error = ShapeError;

    /// Parses the text form; unlike text, a path may have any encoding.
    fn try_from(text: OsString) -> Result<Self, ShapeError> {
        match text.to_str() {
            Some(text) => text.parse(),
            None => Ok(Self::File(text.into())),
        }
    }
}

impl FromStr for Source {
    type Err = ShapeError;

    fn from_str(text: &str) -> Result<Self, ShapeError> {
        match text.strip_prefix(SHAPE) {
            Some(VASE) => Ok(Self::Vase),
            Some(shape) => match shape.split_once('@') {
                Some((VASE, _)) => Err(ShapeError::VaseLevel),
                Some((name, level)) => Self::at_level(name.parse()?, level),
                None => shape.parse().map(Self::Shape),
            },
            None => Ok(Self::File(text.into())),
        }
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape(shape) => write!(f, "{SHAPE}{shape}"),
            Self::FineShape(shape, level) => write!(f, "{SHAPE}{shape}@{level}"),
            Self::Vase => write!(f, "{SHAPE}{VASE}"),
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
    fn a_level_stands_behind_the_name() {
        assert_eq!("shape:torus@3".parse(), Ok(Source::FineShape(Shape::Torus, 3)));
        assert_eq!(Source::FineShape(Shape::Torus, 3).to_string(), "shape:torus@3");
        assert_eq!("shape:torus@0".parse(), Ok(Source::Shape(Shape::Torus)));
        assert_eq!(Source::FineShape(Shape::Cone, 2).title(), "Cone, level 2");
        for text in ["7", "", "-1", "two", "1.5"] {
            let error = format!("shape:torus@{text}").parse::<Source>().unwrap_err();
            assert_eq!(error, ShapeError::Level { text: text.to_owned() });
            assert!(error.to_string().contains("0 to 6"), "{error}");
        }
        for shape in Shape::ALL {
            let parsed = format!("shape:{shape}@1").parse::<Source>();
            assert_eq!(parsed.is_ok(), shape.has_levels(), "{shape}");
            let said = parsed.err().map_or(String::new(), |error| error.to_string());
            assert!(
                shape.has_levels() || said.contains("no exact surface") && said.contains("icosphere, ellipsoid"),
                "{said}"
            );
        }
    }

    #[test]
    fn titles_are_short() {
        assert_eq!(Source::File("models/fox.glb".into()).title(), "fox.glb");
        assert_eq!(Source::Shape(Shape::Moebius).title(), "Moebius strip");
    }

    #[test]
    fn the_vase_is_always_there() {
        assert_eq!("shape:vase".parse(), Ok(Source::Vase));
        assert_eq!(Source::Vase.to_string(), "shape:vase");
        let loaded = Source::Vase.load(&Limits::default(), &Progress::new()).unwrap();
        assert_eq!((loaded.mesh.triangles.len(), loaded.warnings.len()), (308, 0));
    }

    #[test]
    fn shapes_load() {
        let loaded = Source::Shape(Shape::Icosphere).load(&Limits::default(), &Progress::new()).unwrap();
        assert_eq!((loaded.mesh.triangles.len(), loaded.file_bytes), (80, 0));
    }
}
