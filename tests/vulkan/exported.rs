//! What the driver's tessellation stages make of our exported shaders, beside what our passes make of the same mesh.

use std::f32::consts::TAU;
use std::rc::Rc;
use std::sync::Arc;

use geometry::mesh::adjacency::Layout;
use geometry::mesh::{HeightAmount, HeightMap, Heights, Mesh, Topology};
use geometry::progress::Progress;
use geometry::tessellate::hull_factors::HullFactors;
use geometry::tessellate::mesh_displacement::displaced_corners;
use geometry::tessellate::{Clip, Displacement, Lod, LodView, Surface, Tessellation, unpack_normal};
use gpu::embed::GpuError;
use gpu::recorder::Timing;
use gpu::user_lod::Given;
use inspect::engine::Engine;
use inspect::render::camera::Camera;
use inspect::render::scene::Scene;
use inspect::settings::{ARENA_BYTES, Settings};
use inspect::shader_files::{Language, ShaderError, ShaderFile, indices_per_patch, shader_files};
use pnaen::glam::Vec2;
use thiserror::Error;

use super::agreement::{Agreement, Ours, Weights, compare};
use super::device::Vulkan;
use super::stages::{CapturedCorner, Displaced, Drawn, Exported, StageError};

/// Why there is no comparison.
#[derive(Debug, Error)]
pub(crate) enum ExportedError {
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Shaders(#[from] ShaderError),
    #[error(transparent)]
    Stages(#[from] StageError),
}

/// Width and height of the view that LOD is computed for, in px.
pub(crate) const VIEWPORT: Vec2 = Vec2::new(640.0, 480.0);

/// The LODs that can be exported: all but that by error, which searches.
fn lods() -> impl Iterator<Item = Lod> {
    Lod::ALL.into_iter().filter(|lod| !lod.is_by_error())
}

/// Those of them that depend on the view.
pub(crate) fn lods_by_view() -> impl Iterator<Item = Lod> + Clone {
    Lod::ALL.into_iter().filter(|lod| lod.follows_view() && !lod.is_by_error())
}

/// The languages that run on tessellation stages.
pub(crate) const LANGUAGES: [Language; 2] = [Language::Glsl, Language::Hlsl];

/// A mesh that both tessellate.
pub(crate) struct Subject<'a> {
    engine: &'a Engine,
    vulkan: Rc<Vulkan>,
    mesh: Arc<Mesh>,
    topology: Arc<Topology>,
    scene: Scene,
    /// What LOD and clipping are computed for. At first all of the mesh is in view.
    pub view: LodView,
}

impl<'a> Subject<'a> {
    /// Uploads a mesh.
    ///
    /// # Errors
    /// No memory.
    pub(crate) fn new(engine: &'a Engine, vulkan: &Rc<Vulkan>, mesh: Mesh) -> Result<Self, ExportedError> {
        let mesh = Arc::new(mesh);
        // Nobody else holds this handle, so nobody can cancel.
        let topology = Arc::new(Topology::build(&mesh, &Progress::new()).unwrap_or_default());
        let scene = engine.scene_of(mesh.clone(), topology.clone(), ARENA_BYTES)?;
        let bounds = mesh.bounds();
        let view = Camera::framing(&bounds, VIEWPORT).lod_view(VIEWPORT, &bounds);
        Ok(Self { engine, vulkan: vulkan.clone(), mesh, topology, scene, view })
    }

    /// Runs the exported shaders of a tessellation, and compares. `weights` makes the weights of corners 0 and 1 of U and V, as
    /// the tessellation's convention says.
    ///
    /// # Errors
    /// It can't be exported, or the device was lost.
    pub(crate) fn agreement(
        &mut self,
        language: Language,
        tessellation: &Tessellation,
        weights: Weights,
    ) -> Result<Agreement, ExportedError> {
        let files = shader_files(language, tessellation, "a test")?;
        self.agreement_of(&files, language, tessellation, weights)
    }

    /// The same with other texts of the shaders.
    ///
    /// # Errors
    /// They don't compile, or the device was lost.
    pub(crate) fn agreement_of(
        &mut self,
        files: &[ShaderFile],
        language: Language,
        tessellation: &Tessellation,
        weights: Weights,
    ) -> Result<Agreement, ExportedError> {
        let inputs = Settings::from(*tessellation).inputs(self.view);
        self.scene.tessellator.give(None)?;
        self.engine.count(&mut self.scene, &inputs, &mut Timing::Off)?;
        let written = self.scene.tessellator.hull_factors()?;
        let room = self.scene.tessellator.totals().1 as usize * 2 + 1000;
        let captured = self.captured(files, language, tessellation, room)?;
        // Given factors say nothing of the edges of patches that are left out, on whose levels displacement depends.
        if tessellation.clip == Clip::Off || tessellation.displacement == Displacement::Off {
            // Factors may differ in their last bits, which moves points: ours are computed again with those of the stages.
            let mut given = written.clone();
            for corner in captured.iter().flatten() {
                let [a, b, c, inside] = corner.factors;
                given[corner.place[3] as usize] = HullFactors { edges: [a, b, c], inside };
            }
            self.scene.tessellator.give(Some(Given::from(given)))?;
            self.engine.count(&mut self.scene, &inputs, &mut Timing::Off)?;
        }
        let own = self.engine.read_tessellated(&mut self.scene)?;
        let keys: Vec<_> = own.vertices.iter().map(|vertex| (vertex.patch(), vertex.domain())).collect();
        let keys: Vec<_> = keys.into_iter().map(|(patch, [u, v])| (patch, u, v)).collect();
        let positions: Vec<_> = own.vertices.iter().map(|vertex| vertex.position).collect();
        let normals: Vec<_> = own.vertices.iter().map(|vertex| unpack_normal(vertex.normal).to_array()).collect();
        let words = |own: &HullFactors| {
            let [a, b, c] = own.edges;
            [a, b, c, own.inside]
        };
        let factors: Vec<_> = written.iter().map(words).collect();
        let ours = Ours {
            keys: &keys,
            positions: &positions,
            normals: &normals,
            triangles: &own.triangles,
            factors: &factors,
        };
        Ok(compare(&captured, &ours, &self.patch_corners(), weights))
    }

    fn captured(
        &self,
        files: &[ShaderFile],
        language: Language,
        tessellation: &Tessellation,
        room: usize,
    ) -> Result<Vec<[CapturedCorner; 3]>, ExportedError> {
        let file = |name: &str| files.iter().find(|file| file.name == name).map(|file| file.text.as_str());
        let text = |name: &str| file(name).unwrap_or_default();
        let exported = match language {
            Language::Hlsl => Exported::Hlsl(text("patch.hlsl")),
            _ => Exported::Glsl {
                vertex: text("patch.vert"),
                control: text("patch.tesc"),
                evaluation: text("patch.tese"),
            },
        };
        let per_patch = indices_per_patch(language, tessellation);
        let all = Layout::Eighteen.indices(&self.topology);
        let indices: Vec<_> = all.chunks(18).flat_map(|patch| &patch[..per_patch]).copied().collect();
        let (vertices, constants) = (self.vertices(), self.constants(tessellation));
        let corners = displaced_corners(&self.mesh, &self.topology);
        let displaced = corners.as_deref().filter(|_| tessellation.displacement != Displacement::Off);
        let displaced = displaced.and_then(|corners| {
            let map = self.mesh.heights.as_deref()?.maps.first()?;
            let levels = file("levels.comp").or(file("levels.hlsl"));
            Some(Displaced { corners, map, constants: self.height_constants(tessellation, map), levels })
        });
        let (vertices, indices, per_patch) = (&vertices[..], &indices[..], per_patch as u32);
        let drawn = Drawn { vertices, indices, per_patch, constants: &constants, displaced, room };
        Ok(exported.capture(&self.vulkan, &drawn)?)
    }

    /// The vertex buffer, laid out as the exported files say.
    fn vertices(&self) -> Vec<[f32; 8]> {
        let corners = self.mesh.corners.iter().zip(&self.topology.corner_points);
        let vertex = |(corner, &point): (&geometry::mesh::Corner, &u32)| {
            let ([x, y, z], [nx, ny, nz]) = (self.topology.points[point as usize].into(), corner.normal.into());
            [x, y, z, nx, ny, nz, corner.uv.x, corner.uv.y]
        };
        corners.map(vertex).collect()
    }

    /// How far white is above black, in object units.
    fn height_scale(&self, own: &Tessellation) -> f32 {
        own.height_scale * self.mesh.bounds().radius()
    }

    /// The constant buffer of displacement, laid out as the exported files say.
    fn height_constants(&self, own: &Tessellation, map: &HeightMap) -> [u32; 8] {
        let [width, height] = map.size;
        let (scale, midlevel) = (self.height_scale(own).to_bits(), own.midlevel.to_bits());
        [width, height, map.levels, map.wrap[0] as u32 + 4 * map.wrap[1] as u32, scale, midlevel, 0, 0]
    }

    /// The constant buffer, laid out as the exported files say.
    fn constants(&self, own: &Tessellation) -> [f32; 48] {
        let heights = self.mesh.heights.as_deref().filter(|_| own.displacement != Displacement::Off);
        let amount = HeightAmount { scale: self.height_scale(own), midlevel: own.midlevel };
        let reach = heights.map_or(0.0, |heights| heights.reach(amount));
        constants(own, &self.view.with_reach(reach))
    }

    fn patch_corners(&self) -> Vec<[[f32; 3]; 3]> {
        let position =
            |corner: u32| self.topology.points[self.topology.corner_points[corner as usize] as usize].to_array();
        self.topology.patches.iter().map(|patch| self.topology.corners(patch).map(position)).collect()
    }
}

/// The constant buffer of a view, laid out as the exported files say.
pub(crate) fn constants(own: &Tessellation, view: &LodView) -> [f32; 48] {
    let mut constants = [0.0; 48];
    let matrix = view.clip_from_object.to_cols_array();
    constants[..16].copy_from_slice(&matrix);
    constants[16..32].copy_from_slice(&matrix);
    constants[32..34].copy_from_slice(&view.half_viewport.to_array());
    constants[34] = view.reach();
    constants[36..39].copy_from_slice(&view.eye.to_array());
    constants[39] = view.radius;
    constants[40..45].copy_from_slice(&[own.factor, own.pixels, own.near, own.far, own.alpha]);
    constants
}

/// What was compared, and what came out.
pub(crate) struct Row {
    pub surface: Surface,
    pub lod: Lod,
    pub displacement: Displacement,
    pub language: Language,
    pub agreement: Agreement,
}

/// The ways to displace that can be exported.
pub(crate) const DISPLACEMENTS: [Displacement; 3] =
    [Displacement::On, Displacement::AsPublished, Displacement::PerPatch];

/// Compares every surface under every LOD, in both languages.
///
/// # Errors
/// A shader doesn't compile, or the device was lost.
pub(crate) fn rows(subject: &mut Subject) -> Result<Vec<Row>, ExportedError> {
    compared(subject, &Surface::ALL, &lods().map(|lod| (lod, Displacement::Off)).collect::<Vec<_>>())
}

/// Compares every surface under every kind of displacement, in both languages. The mesh must have heights.
///
/// # Errors
/// A shader doesn't compile, or the device was lost.
pub(crate) fn displaced_rows(subject: &mut Subject) -> Result<Vec<Row>, ExportedError> {
    compared(subject, &Surface::ALL, &DISPLACEMENTS.map(|displacement| (Lod::Uniform, displacement)))
}

/// Compares PN-AEN under every kind of displacement and every LOD that depends on the view, in both languages. The mesh must have
/// heights.
///
/// # Errors
/// A shader doesn't compile, or the device was lost.
pub(crate) fn rows_by_view(subject: &mut Subject) -> Result<Vec<Row>, ExportedError> {
    let kinds = lods_by_view().flat_map(|lod| DISPLACEMENTS.map(|displacement| (lod, displacement)));
    compared(subject, &[Surface::PnAen], &kinds.collect::<Vec<_>>())
}

/// Puts a mesh under waves, whose image repeats if texture coordinates go beyond it.
pub(crate) fn wavy(mut mesh: Mesh) -> Mesh {
    const SIZE: u32 = 64;
    let height = |i: u32| {
        let [x, y] = [i % SIZE, i / SIZE].map(|at| TAU * (at as f32 + 0.5) / SIZE as f32);
        0.5 + 0.25 * (2.0 * x).sin() * (3.0 * y).cos() + 0.2 * (x + 2.0 * y).cos()
    };
    let map = HeightMap::new([SIZE; 2], (0..SIZE * SIZE).map(height).collect());
    mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, map)));
    mesh
}

fn compared(
    subject: &mut Subject,
    surfaces: &[Surface],
    kinds: &[(Lod, Displacement)],
) -> Result<Vec<Row>, ExportedError> {
    let mut rows = Vec::new();
    for &surface in surfaces {
        for &(lod, displacement) in kinds {
            let own = Tessellation {
                surface,
                lod,
                displacement,
                factor: 6.3,
                pixels: 40.0,
                near: 2.0,
                far: 6.0,
                height_scale: 0.1,
                ..Tessellation::default()
            };
            for language in LANGUAGES {
                let agreement = subject.agreement(language, &own, &|weights| weights)?;
                rows.push(Row { surface, lod, displacement, language, agreement });
            }
        }
    }
    Ok(rows)
}

/// The name of a value on the command line, such as `pn-aen` for `PnAen`.
fn option_name(variant: &str) -> String {
    let mut name = String::new();
    for letter in variant.chars() {
        if letter.is_uppercase() && !name.is_empty() {
            name.push('-');
        }
        name.extend(letter.to_lowercase());
    }
    name
}

/// The rows as a Markdown table. Differences are rounded up, so that the table says what holds, and stays the same on drivers that
/// round otherwise.
pub(crate) fn table(rows: &[Row]) -> String {
    table_by(&["surface", "LOD"], rows)
}

/// The rows of displaced surfaces as a Markdown table, likewise.
pub(crate) fn displaced_table(rows: &[Row]) -> String {
    table_by(&["surface", "displacement"], rows)
}

/// The rows of one surface under LOD by the view as a Markdown table, likewise.
pub(crate) fn table_by_view(rows: &[Row]) -> String {
    table_by(&["LOD", "displacement"], rows)
}

/// A table that begins with two of these columns: `surface`, `LOD`, `displacement`.
fn table_by(columns: &[&str; 2], rows: &[Row]) -> String {
    let head = format!(
        "| {} | {} | language | triangles | other triangles | factors within | positions within | points on shared edges | \
         of these with other bits |\n| --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n",
        columns[0], columns[1]
    );
    let value = |row: &Row, column: &str| {
        option_name(&match column {
            "surface" => format!("{:?}", row.surface),
            "LOD" => format!("{:?}", row.lod),
            _ => format!("{:?}", row.displacement),
        })
    };
    let row = |row: &Row| {
        let own = &row.agreement;
        let factors = if own.factors <= 1e-6 { "0.000001".to_owned() } else { format!("{:.6}", own.factors) };
        format!(
            "| `{}` | `{}` | {} | {} | {} | {factors} | {} ULP | {} | {} |\n",
            value(row, columns[0]),
            value(row, columns[1]),
            format!("{:?}", row.language).to_uppercase(),
            own.triangles,
            own.other_triangles,
            own.position_ulps.max(2.0).ceil(),
            own.shared,
            own.torn,
        )
    };
    head + &rows.iter().map(row).collect::<String>()
}
