//! What is measured: meshes made in code, and settings that give the number of triangles asked for.

use std::f32::consts::TAU;
use std::sync::Arc;

use geometry::mesh::mesh_builder::MeshBuilder;
use geometry::mesh::{Corner, Material, Mesh, Topology};
use geometry::progress::Progress;
use geometry::tessellate::hull_factors::HullFactors;
use geometry::tessellate::{Lod, Partitioning, Tessellation};
use glam::{Vec2, Vec3};
use gpu::embed::GpuError;
use inspect::engine::Engine;
use inspect::render::camera::Camera;
use inspect::render::target::Target;
use inspect::settings::Settings;

use super::ours::Subject;

/// A cube of `side` by `side` by `side` tori, each of `columns` by `columns / 2` quads.
pub(crate) fn tori(columns: usize, side: usize) -> Mesh {
    let mut builder = MeshBuilder::new();
    let material = builder.material(Material::plain("grey", [0.6, 0.6, 0.6, 1.0]));
    let rows = columns / 2;
    let ring = |i: usize, of: usize| (TAU * (i % of) as f32 / of as f32).sin_cos();
    let node = |center: Vec3, i: usize, j: usize| {
        let (sin, cos) = ring(i, columns);
        let out = Vec3::new(sin, 0.0, cos);
        let (sin, cos) = ring(j, rows);
        let normal = (out * cos + Vec3::Y * sin).normalize();
        let uv = Vec2::new(i as f32 / columns as f32, 1.0 - j as f32 / rows as f32);
        Corner { position: center + out * 0.7 + normal * 0.3, normal, uv }
    };
    for place in 0..side * side * side {
        // The tori are far enough apart not to touch.
        let at = [place % side, place / side % side, place / (side * side)].map(|k| 2.5 * k as f32);
        for cell in 0..columns * rows {
            let (i, j) = (cell / rows, cell % rows);
            let [a, b, c, d] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| node(Vec3::from(at), i, j));
            builder.triangle(material, [a, b, c].map(Into::into));
            builder.triangle(material, [a, c, d].map(Into::into));
        }
    }
    // Nobody else holds this handle, so nobody can cancel.
    builder.finish("tori".to_owned(), &Progress::new()).unwrap_or_default()
}

/// The number of columns for a torus of about this many patches.
pub(crate) fn columns(patches: u64) -> usize {
    ((patches as f64).sqrt().round() as usize).next_multiple_of(2).max(6)
}

/// Uploads a mesh, with a camera that sees all of it.
///
/// # Errors
/// The mesh needs larger buffers than the adapter can bind.
pub(crate) fn subject(engine: &Engine, mesh: Mesh, size: [u32; 2], arena_bytes: u64) -> Result<Subject, GpuError> {
    let mesh = Arc::new(mesh);
    let topology = Arc::new(Topology::build(&mesh, &Progress::new()).unwrap_or_default());
    subject_of(engine, mesh, topology, size, arena_bytes)
}

/// The same with a topology.
///
/// # Errors
/// The same.
pub(crate) fn subject_of(
    engine: &Engine,
    mesh: Arc<Mesh>,
    topology: Arc<Topology>,
    size: [u32; 2],
    arena_bytes: u64,
) -> Result<Subject, GpuError> {
    let scene = engine.scene_of(mesh, topology, arena_bytes)?;
    let target = Target::new(&engine.gpu, size)?;
    let camera = Camera::framing(&scene.bounds, target.viewport());
    Ok(Subject { scene, target, camera, settings: Settings::from(Tessellation::default()) })
}

/// Where factors come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Factors {
    /// From the distance to the eye. The nearest patches have about four times the factors of the farthest.
    ByDistance(Partitioning),
    /// From a hash of each edge, between a quarter of the greatest factor and the factor itself.
    Hashed(Partitioning),
    /// One factor everywhere.
    Uniform(Partitioning),
}

impl Factors {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::ByDistance(Partitioning::FractionalOdd) => "fractional, by distance",
            Self::Hashed(Partitioning::FractionalOdd) => "fractional, hashed",
            Self::ByDistance(_) => "integer, by distance",
            Self::Hashed(_) => "integer, hashed",
            Self::Uniform(_) => "uniform",
        }
    }

    pub(crate) fn partitioning(self) -> Partitioning {
        match self {
            Self::ByDistance(partitioning) | Self::Hashed(partitioning) | Self::Uniform(partitioning) => partitioning,
        }
    }

    /// Tessellates a subject with such factors, up to `greatest`. Returns the number of triangles.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn take(self, engine: &Engine, subject: &mut Subject, greatest: f32) -> Result<u64, GpuError> {
        let radius = subject.scene.bounds.radius();
        let middle = subject.camera.distance / radius;
        let lod = if matches!(self, Self::ByDistance(_)) { Lod::Distance } else { Lod::Uniform };
        subject.settings = Settings::from(Tessellation {
            lod,
            factor: greatest,
            partitioning: self.partitioning(),
            near: middle - 1.0,
            // A third of the mesh's depth beyond the farthest patches, which then get a quarter of the greatest factor.
            far: middle + 1.0 + 2.0 / 3.0,
            ..Tessellation::default()
        });
        let given =
            matches!(self, Self::Hashed(_)).then(|| hashed(subject.scene.tessellator.topology(), greatest).into());
        subject.scene.tessellator.give(given)?;
        subject.count(engine).map(|(_, triangles)| triangles)
    }

    /// Tessellates a subject with factors that give `triangles`, to within half a percent under fractional partitioning.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn take_for(self, engine: &Engine, subject: &mut Subject, triangles: u64) -> Result<u64, GpuError> {
        let (mut low, mut high) = (1.0f32, 64.0f32);
        for _ in 0..16 {
            let middle = (low * high).sqrt();
            let found = self.take(engine, subject, middle)?;
            if (found as f64 / triangles as f64 - 1.0).abs() < 0.005 {
                return Ok(found);
            }
            if found < triangles { low = middle } else { high = middle }
        }
        self.take(engine, subject, high)
    }
}

/// Factors that are a hash of each edge, and so the same for all sides of an edge.
fn hashed(topology: &Topology, greatest: f32) -> Vec<HullFactors> {
    let factor = |edge: u32| {
        let mixed = edge.wrapping_mul(0x9e37_79b9);
        let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x85eb_ca6b);
        let part = (mixed >> 8) as f32 / (1 << 24) as f32;
        (greatest * (0.25 + 0.75 * part)).max(1.0)
    };
    let patch = |patch: &geometry::mesh::Patch| {
        let sides = patch.sides.map(|side| factor(topology.sides[side as usize].edge));
        HullFactors::from_sides(Default::default(), sides, sides[0].max(sides[1]).max(sides[2]))
    };
    topology.patches.iter().map(patch).collect()
}
