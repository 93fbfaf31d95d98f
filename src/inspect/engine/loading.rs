//! Reads a mesh and prepares it for the engine. Needs no device.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use crate::reference_shape::ReferenceShape;
use geometry::mesh::{BuildError, CreaseBand, Mesh, Moment, Topology, with_crease_band};
use geometry::progress::{Progress, Stage};
use geometry::tessellate::PosedMesh;
use load::files::Limits;
use load::heights::load_heights;
use load::import::Subdivide;
use load::part_tree::{self, Branch};
use load::selection::Selection;
use load::{Budget, Contents, HeightSource, Import, LoadError, LoadedMesh, ShownParts, Source, crease_band_warnings};

/// A mesh with its topology, and how long both took.
#[derive(Clone, Debug, Default)]
pub struct Loaded {
    pub source: Source,
    /// The preparation that was requested. The crease band may have become narrower than that.
    pub preparation: Preparation,
    pub crease_band: CreaseBand,
    /// The mesh as it was read: the same as `mesh` unless that has a crease band.
    pub read: Arc<Mesh>,
    pub mesh: Arc<Mesh>,
    /// Sentences about what was left out or repaired.
    pub warnings: Vec<String>,
    /// Whether all of it is a refined subdivision surface.
    pub is_refined: bool,
    /// What the file offers.
    pub contents: Arc<Contents>,
    /// Its parts as a tree.
    pub part_tree: Arc<Vec<Branch>>,
    /// Files that the mesh's own file names and that were read, with links resolved.
    pub files: Vec<PathBuf>,
    pub topology: Arc<Topology>,
    pub load_ms: f64,
    pub topology_ms: f64,
}

impl Loaded {
    /// A mesh that no file has.
    pub fn from_mesh(mesh: Arc<Mesh>, topology: Arc<Topology>) -> Self {
        Self { read: mesh.clone(), mesh, topology, ..Self::default() }
    }

    /// Whether both are of the same source, prepared alike. Its file may have changed since.
    pub fn is_prepared_as(&self, other: &Self) -> bool {
        self.source == other.source && self.preparation == other.preparation
    }

    /// Returns this mesh at a moment of one of its clips, deformed on the CPU. Without a moment it is at rest.
    pub fn posed(&self, moment: Option<Moment>) -> Self {
        let (mesh, topology) = (self.mesh.clone(), self.topology.clone());
        let pose = moment.zip(mesh.rig.as_ref()).map(|(moment, rig)| Arc::new(rig.pose(moment)));
        let (mesh, topology) = PosedMesh::new(mesh, topology, pose).deformed();
        Self { mesh, topology, ..self.clone() }
    }
}

/// How a mesh is read and prepared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preparation {
    /// The tolerance for welding points, relative to the bounding diagonal.
    pub weld: f32,
    /// The width of the crease band, relative to the bounding diagonal; 0 for none.
    pub crease_band: f32,
    /// The height images for displacement; none for those that the file gives its materials, if any.
    pub heights: Option<HeightSource>,
    /// The material variant of the file, by name; none for each primitive's own material.
    pub variant: Option<String>,
    /// The scene of the file, by name or by number from 0; none for its default scene.
    pub scene: Option<String>,
    /// Which parts of the file are read, and in which shape.
    pub parts: ShownParts,
    /// How the geometry of the file is taken.
    pub import: Import,
    pub limits: Limits,
}

impl Preparation {
    /// What of the file is read, and how.
    pub fn selection(&self) -> Selection<'_> {
        Selection {
            variant: self.variant.as_deref(),
            scene: self.scene.as_deref(),
            parts: Some(&self.parts),
            import: self.import,
        }
    }

    /// That of the mesh left of a split, which has these weights of morph targets: of the same mesh, or of another one, which is
    /// taken as this one is.
    pub fn of_left(&self, is_other: bool, morphs: &load::MorphWeights) -> Self {
        let plain = Self { import: self.import, limits: self.limits, ..Self::default() };
        let mut left = if is_other { plain } else { self.clone() };
        left.parts.morphs.extend(morphs.clone());
        left
    }
}

/// Loads the surface that a mesh is compared with: that of another source, at the mesh's place, or without one that of the mesh's
/// own. `subdivide` says how its polygons are refined.
///
/// # Errors
/// The same as [`ReferenceShape::load`]'s.
pub fn load_reference(
    from: Option<&Source>,
    (mesh, preparation): (&Source, &Preparation),
    subdivide: Subdivide,
    progress: &Progress,
) -> Result<ReferenceShape, LoadError> {
    let another = Selection { import: preparation.import.placement(), ..Selection::default() };
    let (source, selected) = from.map_or((mesh, preparation.selection()), |from| (from, another));
    let selected = Selection { import: Import { subdivide, ..selected.import }, ..selected };
    ReferenceShape::load(source, selected, &preparation.limits, progress)
}

/// Reads a mesh, prepares it, and builds its topology. Needs no device.
///
/// # Errors
/// The mesh or the height image can't be read, the mesh is too large or has nothing to show, or `progress` was cancelled.
pub fn load(source: &Source, preparation: &Preparation, progress: &Progress) -> Result<Loaded, LoadError> {
    let start = Instant::now();
    // Large images take longer than most meshes.
    let of_mesh = if preparation.heights.is_some() { 0.4 } else { 1.0 };
    let LoadedMesh { mesh: mut read, mut warnings, contents, files, file_bytes, is_refined } =
        source.load_selected(preparation.selection(), &preparation.limits, &progress.part(0.0, of_mesh))?;
    let loaded = Instant::now();
    let budget = Budget::from_mesh(&read, file_bytes, preparation.limits.memory);
    let too_large = |what| move |error| unfinished(source, what, error);
    let mut topology =
        Topology::build_afforded(&read, preparation.weld, &budget, progress).map_err(too_large("its edges"))?;
    if topology.patches.is_empty() {
        let welded = if preparation.weld > 0.0 { ", within the tolerance of --weld" } else { "" };
        let holds = format!("each of its {} triangles has two corners on one point{welded}", read.triangles.len());
        return Err(LoadError::Empty { path: source.to_string().into(), holds });
    }
    let (mut cut, mut crease_band) = (None, CreaseBand::default());
    if preparation.crease_band > 0.0 {
        let made = with_crease_band(&read, &topology, preparation.crease_band, &budget, progress)
            .map_err(too_large("its crease band"))?;
        cut = Some(made.0);
        (topology, crease_band) = (made.1, made.2);
        warnings.extend(crease_band_warnings(&crease_band));
        if read.rig.is_some() {
            warnings.push("its animations are left out, since a mesh with a crease band can't be animated.".to_owned());
        }
    }
    let mesh = cut.as_mut().unwrap_or(&mut read);
    let wanted = preparation.heights.as_ref();
    if wanted.is_some() {
        progress.enter(Stage::Heights);
    }
    let heights = load_heights(wanted, mesh, &contents.parts, &mut warnings, &budget, &progress.part(of_mesh, 1.0))?;
    mesh.heights = heights.map(Arc::new);
    let read = Arc::new(read);
    Ok(Loaded {
        source: source.clone(),
        preparation: preparation.clone(),
        crease_band,
        mesh: cut.map_or_else(|| read.clone(), Arc::new),
        read,
        warnings,
        is_refined,
        part_tree: Arc::new(part_tree::tree(&contents.parts)),
        contents: Arc::new(contents),
        files,
        topology: Arc::new(topology),
        load_ms: (loaded - start).as_secs_f64() * 1e3,
        topology_ms: loaded.elapsed().as_secs_f64() * 1e3,
    })
}

/// Converts the error of a step after reading; `what` names what that step makes.
fn unfinished(source: &Source, what: &'static str, error: BuildError) -> LoadError {
    match error {
        BuildError::Cancelled(cancelled) => cancelled.into(),
        other => LoadError::TooMuch { path: source.to_string().into(), what, reason: other.to_string() },
    }
}
