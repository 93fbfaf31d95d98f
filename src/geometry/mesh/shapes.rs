//! Meshes that are made in code: small, with known properties, and coarse so that tessellation shows.
//!
//! All have a radius of about 1 object unit, are centred, have +Y up, and are counter-clockwise seen from outside.

pub mod bicubic;
pub mod polyhedra;
pub mod revolved;
pub mod sheets;

use std::fmt;
use std::str::FromStr;

use glam::{Vec2, Vec3};

use super::mesh_builder::MeshBuilder;
use super::{Corner, Material, Mesh};
use crate::choice::{Choice, choices};
use crate::progress::Progress;

choices! {
    /// A mesh that is made in code. The order is that of the menu.
    #[derive(Default, Hash)]
    pub enum Shape {
        #[default]
        CubeSplit => "cube-split", "Cube, split normals",
            "12 triangles, with normals and a uv square for each face: all edges between faces are split. The normals lean \
             outwards at the corners. If they were at right angles to the faces, PN triangles would leave faces flat and edges \
             straight, and nothing would tear.";
        CubeSmooth => "cube-smooth", "Cube, smooth normals", "12 triangles; all corners on one point have the same normal.";
        Icosahedron => "icosahedron", "Icosahedron", "20 triangles with smooth normals.";
        Icosphere => "icosphere", "Icosphere", "80 triangles with the normals of the sphere.";
        Ellipsoid => "ellipsoid", "Ellipsoid",
            "The icosphere, scaled to three different radii, with the normals of the ellipsoid.";
        Torus => "torus", "Torus", "16 by 8 quads with the normals of the torus, and uv seams around both circles.";
        Cylinder => "cylinder", "Cylinder with caps", "12 sides and two caps, with creases between sides and caps.";
        Cone => "cone", "Cone", "12 sides, each with a normal of its own at the apex, and a cap.";
        Saddle => "saddle", "Saddle", "The open surface y = (x^2 - z^2) / 2 over 6 by 6 quads.";
        Bicubic => "bicubic", "Bicubic patches",
            "A leaning vase without lid or bottom: 5 by 3 bicubic patches, each sampled at 2 by 2 quads, with the surface's \
             normals.";
        Moebius => "moebius", "Moebius strip",
            "A strip with half a twist. It has one side and one boundary, and its normals flip where its ends meet.";
    }
}

/// The highest level of a shape with levels.
pub const MAX_LEVEL: u32 = 6;

/// Why a text doesn't name a shape.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ShapeError {
    #[error("there is no shape \"{name}\"; choose one of {}, or vase", Shape::ALL.map(Shape::name).join(", "))]
    Unknown { name: String },
    #[error("\"{text}\" isn't a level of a shape; choose a whole number from 0 to {MAX_LEVEL}, as in shape:torus@2")]
    Level { text: String },
    #[error("vase has no levels; leave out the @")]
    VaseLevel,
    #[error(
        "{shape} has no exact surface to be sampled more finely, so it has no levels; leave out the @, or choose one of {}",
        Shape::ALL.into_iter().filter(|shape| shape.has_levels()).map(Shape::name).collect::<Vec<_>>().join(", ")
    )]
    NoLevels { shape: Shape },
}

impl Shape {
    /// Returns the name in commands, as in `shape:torus`.
    pub fn name(self) -> &'static str {
        self.description().name
    }

    /// Returns the name for menus.
    pub fn title(self) -> &'static str {
        self.description().label
    }

    /// Returns whether the shape's corners are samples of a curved surface, which can be sampled more densely.
    pub fn has_levels(self) -> bool {
        !matches!(self, Self::CubeSplit | Self::CubeSmooth | Self::Moebius)
    }

    /// Builds the mesh at level 0. It is the same every time.
    pub fn build(self) -> Mesh {
        self.build_at(0)
    }

    /// Builds the mesh with its number of segments doubled `level` times. All corners lie on the same surface and have
    /// its normals. A shape without levels stays as it is.
    pub fn build_at(self, level: u32) -> Mesh {
        let triangles = match self {
            Self::CubeSplit => polyhedra::cube(|position, normal| normal + 0.6 * position),
            Self::CubeSmooth => polyhedra::cube_smooth(),
            Self::Icosahedron => polyhedra::icosphere(level),
            Self::Icosphere => polyhedra::icosphere(1 + level),
            Self::Ellipsoid => polyhedra::ellipsoid(1 + level),
            Self::Torus => revolved::torus(level),
            Self::Cylinder => revolved::cylinder(level),
            Self::Cone => revolved::cone(level),
            Self::Saddle => sheets::saddle(level),
            Self::Bicubic => bicubic::vase(level),
            Self::Moebius => sheets::moebius(),
        };
        let mut builder = MeshBuilder::new();
        let material = builder.material(Material::plain("default", [0.6, 0.6, 0.6, 1.0]));
        for triangle in triangles {
            builder.triangle(material, triangle.map(Into::into));
        }
        // The only possible error is cancellation, and no other code has this handle.
        builder.finish(self.title_at(level), &Progress::new()).unwrap_or_default()
    }

    /// Returns the name for menus, with the level if it isn't 0.
    pub fn title_at(self, level: u32) -> String {
        if level == 0 { self.title().to_owned() } else { format!("{}, level {level}", self.title()) }
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Shape {
    type Err = ShapeError;

    fn from_str(name: &str) -> Result<Self, ShapeError> {
        Self::named(name).ok_or_else(|| ShapeError::Unknown { name: name.to_owned() })
    }
}

fn corner(position: Vec3, normal: Vec3, uv: Vec2) -> Corner {
    Corner { position, normal: normal.normalize(), uv }
}

/// Returns the triangles of all cells of a grid, column by column.
fn grid(
    columns: usize,
    rows: usize,
    cell: impl Fn(usize, usize) -> [[Corner; 3]; 2],
) -> impl Iterator<Item = [Corner; 3]> {
    (0..columns).flat_map(move |i| (0..rows).map(move |j| [i, j])).flat_map(move |[i, j]| cell(i, j))
}

/// Returns two triangles for the quad a b c d, which is counter-clockwise, cut along its diagonal a-c.
fn quad([a, b, c, d]: [Corner; 4]) -> [[Corner; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

#[cfg(test)]
mod tests;
