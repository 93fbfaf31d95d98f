//! Options that several commands share.

mod cameras;
mod declared;
mod opening;
mod values;
mod view;

use clap::Args;
use glam::Vec2;

use super::{CliError, note, refuse};
use geometry::choice::Choice;
use geometry::mesh::crease_band::WIDEST;
use geometry::mesh::{FileCamera, Moment, PartStyle};
use geometry::progress::Progress;
use geometry::tessellate::{Displacement, LodView, Surface, Tessellation, tolerance_within_budget};
use gpu::Timing;
use inspect::engine::{Engine, Loaded, Preparation, load_reference};
use inspect::reference_shape::ReferenceShape;
use inspect::render::Scene;
use inspect::settings::options::TOLERANCE_RANGE;
use inspect::settings::{ARENA_BYTES, Settings};
use load::files::Limits;
use load::format::known_extensions;
use load::import::Subdivide;
use load::{HeightSource, ShownParts, Source};

pub(crate) use cameras::{CamerasOption, NamedView, check_view_name, said};
use declared::GivenTessellation;
pub(crate) use declared::{
    Declared, ImportOptions, Listed, PictureOptions, TessellationOptions, choice, named, number_of,
};
pub(crate) use opening::OpeningOptions;
pub(crate) use values::{
    CameraOption, ending_in, heights, morph, picture, picture_or_page, seconds, size, source, whole, whole_from, within,
};
pub(crate) use view::{LodCameraOption, MeshAt, ViewOptions};

/// The options about LOD, which can't be given with something that takes its place.
pub(crate) const LOD_OPTIONS: [&str; 5] = ["lod", "factor", "pixels", "distances", "max_triangles"];

/// How a mesh is tessellated, and where it is seen from.
#[derive(Clone, Debug, Args)]
pub struct SurfaceOptions {
    #[command(flatten)]
    pub tessellation: TessellationOptions,
    /// Under LOD by error, raise the tolerance until there are no more triangles than this
    #[arg(long, value_name = "N", value_parser = whole_from(1_u64))]
    pub max_triangles: Option<u64>,
    /// Height map that displaces the surface: a PNG, JPEG, WebP, TGA, KTX2, TIFF or EXR image over all materials, its stored
    /// brightness from 0 (black) to 1 (white); `material`, the brightness of each material's base colour image; or `file`, the images
    /// that the file gives its materials. NAME=IMAGE,scale=S,midlevel=H (S in object units) replaces that of a material, or gives
    /// a part or group one of its own; may be given several times. A part's image counts before its material's
    #[arg(long, value_name = "IMAGE|material|file|NAME=IMAGE[,scale=S,midlevel=H]", value_parser = heights())]
    pub height: Vec<HeightSource>,
    /// Memory for output on the device, in MiB, 1 to 65536; output that doesn't fit is made in chunks
    #[arg(long, value_name = "MIB", default_value_t = ARENA_BYTES >> 20, value_parser = whole(1..=65_536_u64))]
    pub arena: u64,
    #[command(flatten)]
    pub weld: WeldOption,
    /// Show the mesh in a pose of this animation; `pnaen info` lists the animations
    #[arg(long, value_name = "NAME")]
    pub animation: Option<String>,
    /// Time in the animation, in s; after its end the pose is that of the end
    #[arg(long, value_name = "SECONDS", requires = "animation", value_parser = seconds, default_value_t = 0.0, allow_hyphen_values = true)]
    pub time: f64,
    /// Width and height of the view, in px
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    pub size: [u32; 2],
    #[command(flatten)]
    pub view: ViewOptions,
}

/// What a command says of the mesh that it reads.
pub(crate) fn mesh_help() -> String {
    format!("A {} file, or a shape made in code such as shape:cube-split, or shape:torus@2 (finer)", known_extensions())
}

/// The options of an empty command line.
fn defaults<T: Args>() -> T {
    let matches = T::augment_args(clap::Command::new("pnaen")).get_matches_from(["pnaen"]);
    T::from_arg_matches(&matches).unwrap_or_else(|error| error.exit())
}

/// Lets options by default be those of an empty command line.
macro_rules! empty_by_default {
    ($($options:ty),+) => {
        $(impl Default for $options {
            fn default() -> Self {
                defaults()
            }
        })+
    };
}

empty_by_default!(SurfaceOptions, LimitOption, LodCameraOption, ViewOptions);

impl SurfaceOptions {
    /// Checks what parsing can't: options that need one another. `other` is a second surface that is tessellated with them too.
    pub(crate) fn check(&self, other: Option<Surface>) -> Result<(), CliError> {
        let settings = self.settings();
        let own = settings.tessellation;
        refuse(
            own.partitioning.has_one_factor() && own.lod.follows_view(),
            "--partitioning subtriangulation has the same number of segments everywhere: it needs --lod uniform",
        )?;
        refuse(
            self.weld.crease_band > 0.0 && self.animation.is_some(),
            "--animation can't be combined with --crease-band: its triangles belong to no joint or node that moves",
        )?;
        let usual = Tessellation::default();
        let is_of_part = |own: &HeightSource| matches!(own, HeightSource::Each(_));
        refuse(
            self.height.len() > 1 && !self.height.iter().all(is_of_part),
            "--height can be given several times only as NAME=IMAGE",
        )?;
        let takes_heights = !self.height.is_empty() || own.displacement.is_on();
        let is_lost = !takes_heights && (own.height_scale != usual.height_scale || own.midlevel != usual.midlevel);
        refuse(is_lost, "--height-scale and --midlevel need --height, or --displacement")?;
        let has_styles = self.weld.parts.part.iter().any(|(_, own)| own.is_of_tessellation());
        let is_lost = own == Tessellation::untessellated() && has_styles;
        refuse(is_lost, "--part has no effect on the mesh as it is: choose another surface, factor or partitioning")?;
        let has_strength =
            own.surface.is_phong() || other.is_some_and(Surface::is_phong) || self.weld.parts.shown().has_phong();
        let is_lost = !has_strength && own.alpha != usual.alpha;
        refuse(
            is_lost,
            "--alpha needs --surface phong or phong-aen, whose strength it is, or a --part with such a surface",
        )?;
        let is_lost = self.max_triangles.is_some() && !own.lod.is_by_error();
        refuse(is_lost, "--max-triangles needs --lod error, whose tolerance it raises")
    }

    /// What is done to the mesh after it was read. Displacement without an image uses those of the file.
    pub fn preparation(&self) -> Preparation {
        let wanted = (self.tessellation().displacement.is_on()).then_some(HeightSource::Model);
        Preparation { heights: HeightSource::joined(&self.height).or(wanted), ..self.weld.preparation() }
    }

    /// How the mesh is tessellated.
    pub fn tessellation(&self) -> Tessellation {
        let GivenTessellation { tessellation, displacement } = self.tessellation.0;
        Tessellation {
            displacement: displacement.unwrap_or(Displacement::usual(!self.height.is_empty())),
            // A pose may turn a part inside out, and its back is then seen.
            cull_back_faces: tessellation.cull_back_faces && self.animation.is_none(),
            ..tessellation
        }
    }

    /// Settings with these options and no overlays.
    pub fn settings(&self) -> Settings {
        Settings { import: self.weld.import.0, ..self.tessellation().into() }
    }

    /// The settings of a picture with these options.
    pub(crate) fn settings_of(&self, picture: &Settings) -> Settings {
        // A pose may turn a part inside out in either half.
        let is_still = self.animation.is_none();
        let left = Tessellation { cull_back_faces: picture.left.cull_back_faces && is_still, ..picture.left };
        Settings { import: self.weld.import.0, left, ..picture.with(self.tessellation()) }
    }

    /// Returns settings whose tolerance is raised until there are no more triangles than `--max-triangles` allows. Standard
    /// error tells the raised tolerance. `count` returns the number of triangles for settings. [`Self::check`] has made sure
    /// that `--max-triangles` comes with LOD by error.
    pub(crate) fn within_budget(
        &self,
        mut count: impl FnMut(&Settings) -> Result<u64, CliError>,
    ) -> Result<Settings, CliError> {
        let settings = self.settings();
        let Some(most) = self.max_triangles else { return Ok(settings) };
        let largest = TOLERANCE_RANGE.most;
        let at = |tolerance| settings.with(Tessellation { tolerance, ..settings.tessellation });
        let asked = settings.tessellation.tolerance;
        let Some(tolerance) = tolerance_within_budget(asked..=largest, most, |tolerance| count(&at(tolerance)))? else {
            let least = count(&at(largest))?;
            return Err(CliError::Budget { most, least, largest });
        };
        if tolerance > asked {
            note(&format!("tolerance raised from {asked} to {tolerance} px, for no more than {most} triangles"));
        }
        Ok(at(tolerance))
    }

    /// The same where the device counts the triangles.
    pub(crate) fn within_budget_on(
        &self,
        engine: &Engine,
        scene: &mut Scene,
        view: LodView,
    ) -> Result<Settings, CliError> {
        self.within_budget(|settings| {
            engine.count(scene, &settings.inputs(view), &mut Timing::Off)?;
            Ok(scene.tessellator.totals().1)
        })
    }

    /// Returns the chosen moment, or none at rest. Warns on standard error about a time beyond the end.
    pub fn moment(&self, loaded: &Loaded) -> Result<Option<Moment>, CliError> {
        let Some(name) = &self.animation else { return Ok(None) };
        let rig = loaded.mesh.rig.as_deref();
        let found = rig.and_then(|rig| rig.clip(name).map(|clip| (clip, rig.clips[clip].duration)));
        let Some((clip, duration)) = found else {
            let (file, name) = (loaded.source.to_string(), name.clone());
            let clips: Vec<_> = rig.iter().flat_map(|rig| &rig.clips).map(|clip| clip.name.clone()).collect();
            let has = if clips.is_empty() { "none".to_owned() } else { clips.join(", ") };
            return Err(CliError::NoAnimation { file, name, has });
        };
        if self.time > duration {
            // Files have times in f32: an f64 would print digits that the file doesn't have.
            let end = duration as f32;
            note(&format!("{name} ends at {end} s; the pose at its end is shown"));
        }
        Ok(Some(Moment { clip, time: self.time.min(duration) }))
    }

    /// Memory for output on the device, in bytes.
    pub fn arena_bytes(&self) -> u64 {
        self.arena << 20
    }

    /// Width and height in px.
    pub fn viewport(&self) -> Vec2 {
        Vec2::from(self.size.map(|side| side as f32))
    }
}

/// Finds a camera of the file by its name, or by its number from 0 if none has that name.
fn file_camera<'a>(mesh: &str, cameras: &'a [FileCamera], wanted: &str) -> Result<&'a FileCamera, CliError> {
    let named = cameras.iter().find(|camera| camera.name == wanted);
    let numbered = || cameras.get(wanted.parse::<usize>().ok()?);
    named.or_else(numbered).ok_or_else(|| {
        let known = cameras.iter().map(|camera| camera.name.clone()).collect();
        CliError::NoCamera { mesh: mesh.to_owned(), wanted: wanted.to_owned(), known }
    })
}

/// How a mesh is read, and what is done to it before it is tessellated: points are welded, and creases get a crease band.
#[derive(Clone, Debug, Default, Args)]
pub struct WeldOption {
    /// Weld points within this distance, relative to the bounding diagonal; 0 joins only exactly equal positions
    #[arg(long, value_name = "TOLERANCE", default_value_t = 0.0, value_parser = within(0.0..=0.1))]
    pub weld: f32,
    /// Cut triangles back from creases (edges with split normals) by this width, and fill the gap with a band of small triangles,
    /// so that nothing cracks there (Vlachos et al. 2001). On the crease they share one normal. The width is relative to the
    /// bounding diagonal, 0 to 0.1; 0 makes no band. It is at most a third of an edge, and half the radius of a triangle's
    /// incircle
    #[arg(long, alias = "rim", value_name = "WIDTH", default_value_t = 0.0, value_parser = within(0.0..=WIDEST), allow_hyphen_values = true)]
    pub crease_band: f32,
    /// Show the materials of this variant of a glTF file (KHR_materials_variants), by name; `info` lists them
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    pub variant: Option<String>,
    /// Show this scene of a glTF file instead of its default, by name or by number from 0; `info` lists them
    #[arg(long, value_name = "NAME|N", allow_hyphen_values = true)]
    pub scene: Option<String>,
    #[command(flatten)]
    pub parts: PartOptions,
    #[command(flatten)]
    pub import: ImportOptions,
    #[command(flatten)]
    pub limit: LimitOption,
}

impl WeldOption {
    pub fn preparation(&self) -> Preparation {
        Preparation {
            weld: self.weld,
            crease_band: self.crease_band,
            heights: None,
            variant: self.variant.clone(),
            scene: self.scene.clone(),
            parts: self.parts.shown(),
            import: self.import.0,
            limits: self.limit.limits(),
        }
    }
}

/// The surface that what is emitted is compared with.
#[derive(Clone, Debug, Default, Args)]
pub struct ReferenceOption {
    /// Reference surface that distances and errors are measured from: a mesh file, such as the high-poly original, or a shape.
    /// By default the exact surface of a shape; for other meshes the surface that the tessellation converges to
    #[arg(long = "reference-surface", value_name = "FILE", value_parser = source())]
    pub reference_shape: Option<Source>,
    /// Compare with the limit of the subdivision surface whose cage is --reference-surface, or without it the mesh's own file
    #[arg(long, value_name = "SCHEME", value_parser = choice::<Subdivide>())]
    pub reference_subdivide: Option<Subdivide>,
}

impl ReferenceOption {
    /// Loads the surface that was chosen for a mesh, and returns it with its name, made of that of its source; none if none was.
    pub(crate) fn load(
        &self,
        mesh: &Source,
        own: &Preparation,
        name: fn(&Source) -> String,
    ) -> Result<Option<(String, ReferenceShape)>, CliError> {
        if self.reference_shape.is_none() && self.reference_subdivide.is_none() {
            return Ok(None);
        }
        let (from, subdivide) = (self.reference_shape.as_ref(), self.reference_subdivide.unwrap_or_default());
        let found = load_reference(from, (mesh, own), subdivide, &Progress::new())?;
        let scheme = self.reference_subdivide.map_or_else(String::new, |scheme| format!(" ({})", scheme.name()));
        Ok(Some((name(from.unwrap_or(mesh)) + &scheme, found)))
    }
}

/// Which parts of a file are read, and in which shape.
#[derive(Clone, Debug, Default, Args)]
pub struct PartOptions {
    /// Leave out the part, group or material of this name or path; may be given several times. `info` lists them
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    hide_part: Vec<String>,
    /// Show only the part, group or material of this name or path, and others that are given so
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    show_part: Vec<String>,
    /// Give the part, group or material of this name a surface of its own, LOD 1/64 to 16 times as fine, normals, or a crease
    /// angle, such as `NAME:surface=flat,detail=0.5,normals=made,crease=30`; may be given several times. A part's count before its
    /// material's. Edges between parts take the surface that comes first in the list of `--surface`, and the finest detail
    #[arg(long, value_name = "NAME:KEY=VALUE,..", allow_hyphen_values = true, value_parser = values::part_style)]
    part: Vec<(String, PartStyle)>,
    /// Give a morph target or blend shape this weight where no clip moves it, such as Smile=0.7; may be given several times.
    /// `info` lists the targets
    #[arg(long, value_name = "NAME=WEIGHT", allow_hyphen_values = true, value_parser = values::morph)]
    morph: Vec<(String, f32)>,
}

impl PartOptions {
    /// Says on standard error that styles of parts have no effect, if some are given that don't.
    pub(crate) fn say_idle(&self, is_idle: fn(&PartStyle) -> bool, said: &str) {
        if self.part.iter().any(|(_, style)| is_idle(style)) {
            note(said);
        }
    }

    pub fn shown(&self) -> ShownParts {
        let (hidden, only) = (self.hide_part.clone(), self.show_part.clone());
        ShownParts { hidden, only, styles: self.part.clone(), morphs: self.morph.iter().cloned().collect() }
    }
}

/// How large files may be, and how much memory they may take.
#[derive(Clone, Copy, Debug, Args)]
pub struct LimitOption {
    /// Refuse a file larger than this, or larger buffers and images of it: a number of bytes, or one in KiB, MiB or GiB
    #[arg(long, value_name = "SIZE", default_value = "2GiB", value_parser = values::bytes)]
    pub max_size: u64,
    /// Refuse a mesh that would take more memory to load than this plus four times the size of its files, and scale textures down
    /// to it; written as --max-size is
    #[arg(long, value_name = "SIZE", default_value = "512MiB", value_parser = values::bytes)]
    pub max_memory: u64,
}

impl LimitOption {
    pub fn limits(&self) -> Limits {
        Limits { file: self.max_size, memory: self.max_memory }
    }
}
