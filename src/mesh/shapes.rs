//! Shapes made in code: small meshes with known answers, coarse on purpose so that tessellation shows.
//!
//! All are about one unit in radius, centred, with +Y up, counter-clockwise seen from outside.

mod polyhedra;
mod revolved;
mod sheets;

use std::fmt;
use std::str::FromStr;

use glam::{Vec2, Vec3};

use super::merge::MeshBuilder;
use super::{Corner, Material, Mesh, Progress};

/// A shape that needs no file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Shape {
    /// 12 triangles, with normals and a uv square for each face: every edge between faces is split. The normals lean
    /// outwards at the corners; upright ones would leave faces flat and edges straight, and nothing would tear.
    #[default]
    CubeSplit,
    /// 12 triangles whose corners share one normal on each point.
    CubeSmooth,
    /// 20 triangles with smooth normals.
    Icosahedron,
    /// 80 triangles with the sphere's own normals.
    Icosphere,
    /// 16 by 8 quads with the torus's own normals; uv seams both ways round.
    Torus,
    /// 12 sides and two caps with a crease between.
    Cylinder,
    /// 12 sides that each have a normal of their own at the apex, and a cap.
    Cone,
    /// The open patch y = (x^2 - z^2) / 2 over 6 by 6 quads.
    Saddle,
    /// A strip with half a twist: one side, one boundary, normals that flip at the join.
    Moebius,
}

/// There is no shape of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no shape \"{name}\"; choose one of {}", Shape::ALL.map(Shape::name).join(", "))]
pub struct UnknownShape {
    pub name: String,
}

impl Shape {
    /// All shapes, in the order of a menu.
    pub const ALL: [Self; 9] = [
        Self::CubeSplit,
        Self::CubeSmooth,
        Self::Icosahedron,
        Self::Icosphere,
        Self::Torus,
        Self::Cylinder,
        Self::Cone,
        Self::Saddle,
        Self::Moebius,
    ];

    /// The name that commands use, as in `shape:torus`.
    pub fn name(self) -> &'static str {
        match self {
            Self::CubeSplit => "cube-split",
            Self::CubeSmooth => "cube-smooth",
            Self::Icosahedron => "icosahedron",
            Self::Icosphere => "icosphere",
            Self::Torus => "torus",
            Self::Cylinder => "cylinder",
            Self::Cone => "cone",
            Self::Saddle => "saddle",
            Self::Moebius => "moebius",
        }
    }

    /// The name that people read in a menu.
    pub fn title(self) -> &'static str {
        match self {
            Self::CubeSplit => "Cube, split normals",
            Self::CubeSmooth => "Cube, smooth normals",
            Self::Icosahedron => "Icosahedron",
            Self::Icosphere => "Icosphere",
            Self::Torus => "Torus",
            Self::Cylinder => "Cylinder with caps",
            Self::Cone => "Cone",
            Self::Saddle => "Saddle",
            Self::Moebius => "Moebius strip",
        }
    }

    /// The mesh, the same every time.
    pub fn build(self) -> Mesh {
        let triangles = match self {
            Self::CubeSplit => polyhedra::cube_split(),
            Self::CubeSmooth => polyhedra::cube_smooth(),
            Self::Icosahedron => polyhedra::icosphere(0),
            Self::Icosphere => polyhedra::icosphere(1),
            Self::Torus => revolved::torus(),
            Self::Cylinder => revolved::cylinder(),
            Self::Cone => revolved::cone(),
            Self::Saddle => sheets::saddle(),
            Self::Moebius => sheets::moebius(),
        };
        let mut builder = MeshBuilder::new();
        let material = builder.material(Material::plain("default", [0.6, 0.6, 0.6, 1.0]));
        for triangle in triangles {
            builder.triangle(material, triangle.map(Into::into));
        }
        // Nobody else holds this handle, so nobody can cancel.
        builder.finish(self.title().to_owned(), &Progress::new()).unwrap_or_default()
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Shape {
    type Err = UnknownShape;

    fn from_str(name: &str) -> Result<Self, UnknownShape> {
        let found = Self::ALL.into_iter().find(|shape| shape.name() == name);
        found.ok_or_else(|| UnknownShape { name: name.to_owned() })
    }
}

fn corner(position: Vec3, normal: Vec3, uv: Vec2) -> Corner {
    Corner { position, normal: normal.normalize(), uv }
}

/// A quad a b c d, counter-clockwise, as two triangles along its diagonal a-c.
fn quad([a, b, c, d]: [Corner; 4]) -> [[Corner; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

#[cfg(test)]
mod tests;
