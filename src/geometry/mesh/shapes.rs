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
use crate::names::every;
use crate::progress::Progress;

/// A mesh that is made in code.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Shape {
    /// 12 triangles, with normals and a uv square for each face: all edges between faces are split. The normals lean
    /// outwards at the corners. If they were at right angles to the faces, PN triangles would leave faces flat and
    /// edges straight, and nothing would tear.
    #[default]
    CubeSplit,
    /// 12 triangles; all corners on one point have the same normal.
    CubeSmooth,
    /// 20 triangles with smooth normals.
    Icosahedron,
    /// 80 triangles with the normals of the sphere.
    Icosphere,
    /// The icosphere, scaled to three different radii, with the normals of the ellipsoid.
    Ellipsoid,
    /// 16 by 8 quads with the normals of the torus, and uv seams around both circles.
    Torus,
    /// 12 sides and two caps, with creases between sides and caps.
    Cylinder,
    /// 12 sides, each with a normal of its own at the apex, and a cap.
    Cone,
    /// The open surface y = (x^2 - z^2) / 2 over 6 by 6 quads.
    Saddle,
    /// A leaning vase without lid or bottom: 5 by 3 bicubic patches, each sampled at 2 by 2 quads, with the surface's
    /// normals.
    Bicubic,
    /// A strip with half a twist. It has one side and one boundary, and its normals flip where its ends meet.
    Moebius,
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
    /// All shapes, in the order of the menu.
    pub const ALL: [Self; 11] = every![Shape:
        CubeSplit, CubeSmooth, Icosahedron, Icosphere, Ellipsoid, Torus, Cylinder, Cone, Saddle, Bicubic, Moebius,
    ];

    /// Returns the name in commands, as in `shape:torus`.
    pub fn name(self) -> &'static str {
        self.names().0
    }

    /// Returns the name for menus.
    pub fn title(self) -> &'static str {
        self.names().1
    }

    fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::CubeSplit => ("cube-split", "Cube, split normals"),
            Self::CubeSmooth => ("cube-smooth", "Cube, smooth normals"),
            Self::Icosahedron => ("icosahedron", "Icosahedron"),
            Self::Icosphere => ("icosphere", "Icosphere"),
            Self::Ellipsoid => ("ellipsoid", "Ellipsoid"),
            Self::Torus => ("torus", "Torus"),
            Self::Cylinder => ("cylinder", "Cylinder with caps"),
            Self::Cone => ("cone", "Cone"),
            Self::Saddle => ("saddle", "Saddle"),
            Self::Bicubic => ("bicubic", "Bicubic patches"),
            Self::Moebius => ("moebius", "Moebius strip"),
        }
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
            Self::CubeSplit => polyhedra::cube_split(),
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
        let found = Self::ALL.into_iter().find(|shape| shape.name() == name);
        found.ok_or_else(|| ShapeError::Unknown { name: name.to_owned() })
    }
}

fn corner(position: Vec3, normal: Vec3, uv: Vec2) -> Corner {
    Corner { position, normal: normal.normalize(), uv }
}

/// Returns two triangles for the quad a b c d, which is counter-clockwise, cut along its diagonal a-c.
fn quad([a, b, c, d]: [Corner; 4]) -> [[Corner; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

#[cfg(test)]
mod tests;
