//! What drawing a mesh's materials costs, and what layers add: `cargo bench --bench hardware -- materials MESH...`.

use std::path::PathBuf;
use std::sync::Arc;

use geometry::mesh::{Alpha, Mesh, Topology};
use geometry::progress::Progress;
use geometry::tessellate::Tessellation;
use inspect::engine::{Engine, Preparation, load as load_and_prepare};
use inspect::render::renderer::Renderer;
use inspect::settings::Settings;
use inspect::settings::light::Lighting;
use load::source::Source;

use super::Scale;
use super::numbers::{Spread, table, whole};
use super::subjects::subject_of;
use super::versus::BenchError;

/// The tessellation factors of all edges.
const FACTORS: [f32; 2] = [1.0, 4.0];

/// The times of one mesh at one factor.
pub(crate) struct Drawn {
    mesh: String,
    factor: f32,
    triangles: u64,
    /// With the base colour alone, under the two lights of the camera.
    base_color: Spread,
    /// With all maps, in the studio, each material with a shader of its own. What blends or transmits light is drawn as if it were
    /// opaque.
    studio: Spread,
    /// The same with one shader, which has what any of the materials needs.
    one_shader: Spread,
    /// With layers, and a shader for each material; none if no material has layers.
    layers: Option<Spread>,
}

/// Measures pictures of each mesh file, or of the vase if there are none.
///
/// # Errors
/// A file can't be read, or a device was lost or has no memory.
pub(crate) fn measure(engine: &Engine, scale: &Scale, files: &[String]) -> Result<Vec<Drawn>, BenchError> {
    let sources = files.iter().map(|path| Source::File(PathBuf::from(path)));
    let sources: Vec<_> = if files.is_empty() { vec![Source::Vase] } else { sources.collect() };
    let (engine, sharing) = (&with_shaders(engine, false), &with_shaders(engine, true));
    let mut rows = Vec::new();
    for source in sources {
        let loaded = load_and_prepare(&source, &Preparation::default(), &Progress::new())?;
        let opaque = without_layers(&loaded.mesh);
        for factor in FACTORS {
            let time_on = |engine, mesh, lighting| time(engine, scale, mesh, &loaded.topology, factor, lighting);
            let time = |mesh, lighting| time_on(engine, mesh, lighting);
            let (triangles, base_color) = time(&loaded.mesh, Lighting::Camera)?;
            let (_, studio) = time(&opaque, Lighting::Studio)?;
            let (_, one_shader) = time_on(sharing, &opaque, Lighting::Studio)?;
            let has_layers = !Arc::ptr_eq(&opaque, &loaded.mesh);
            let layers = if has_layers { Some(time(&loaded.mesh, Lighting::Studio)?.1) } else { None };
            let mesh = source.title().clone();
            rows.push(Drawn { mesh, factor, triangles, base_color, studio, one_shader, layers });
        }
    }
    Ok(rows)
}

/// The engine, with one shader for all materials of a mesh or with one for each.
fn with_shaders(engine: &Engine, shares_shaders: bool) -> Engine {
    let (mut engine, mut renderer) = (engine.clone(), Renderer::new(&engine.gpu));
    renderer.shares_shaders = shares_shaders;
    engine.renderer = Arc::new(renderer);
    engine
}

/// The number of triangles, and the time of a picture of what was emitted before.
fn time(
    engine: &Engine,
    scale: &Scale,
    mesh: &Arc<Mesh>,
    topology: &Arc<Topology>,
    factor: f32,
    lighting: Lighting,
) -> Result<(u64, Spread), BenchError> {
    let mut subject = subject_of(engine, mesh.clone(), topology.clone(), scale.size, scale.arena_bytes)?;
    let settings = Settings::from(Tessellation { factor, ..Tessellation::default() });
    subject.settings = Settings { lighting, ..settings };
    let (_, triangles) = subject.count(engine)?;
    Ok((triangles, subject.time_drawing(engine, scale.effort)?))
}

/// The mesh with opaque materials alone: itself, if it has no others.
fn without_layers(mesh: &Arc<Mesh>) -> Arc<Mesh> {
    let mut opaque = Mesh::clone(mesh);
    let mut has_layers = false;
    for look in opaque.materials.iter_mut().map(|material| &mut material.look) {
        has_layers |= look.alpha == Alpha::Blend || look.transmission > 0.0;
        look.transmission = 0.0;
        if look.alpha == Alpha::Blend {
            look.alpha = Alpha::Opaque;
        }
    }
    if has_layers { Arc::new(opaque) } else { mesh.clone() }
}

/// Returns the table of all rows.
pub(crate) fn table_of(rows: &[Drawn]) -> String {
    let row = |row: &Drawn| {
        vec![
            row.mesh.clone(),
            format!("{}", row.factor),
            whole(row.triangles),
            row.base_color.to_string(),
            row.studio.to_string(),
            row.one_shader.to_string(),
            row.layers.map_or_else(|| "none".to_owned(), |layers| layers.to_string()),
        ]
    };
    let head = "mesh | factor | triangles | base colour, ms | studio with all maps, ms | with one shader for all materials, ms | \
                with layers, ms";
    table(head, &rows.iter().map(row).collect::<Vec<_>>())
}
