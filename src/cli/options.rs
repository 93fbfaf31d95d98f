//! Options that several commands share.

mod values;

use std::io::Write;

use clap::builder::{OsStringValueParser, TypedValueParser};
use clap::{Args, Parser};
use glam::Vec2;

use super::{AnimationOption, CliError};
use crate::engine::Preparation;
use crate::files::Limits;
use crate::load::HeightSource;
use crate::mesh::{Bounds, Mesh};
use crate::render::Camera;
use crate::settings::{ARENA_BYTES, Settings, TOLERANCE_RANGE};
use crate::tessellate::{
    Clip, Convention, Displacement, Edges, Lod, Normals, Partitioning, Surface, tolerance_within_budget,
};

pub use values::{
    CameraOption, Distances, Place, Size, color, factor, fraction, height_scale, model, partitioning, picture, pixels,
    source, threshold, tolerance,
};

use values::{alpha, bytes, rim, weld};

/// What is tessellated how, and seen from where.
#[derive(Clone, Debug, Args)]
pub struct SurfaceOptions {
    /// Surface that each triangle becomes
    #[arg(long, value_enum, default_value_t = Settings::default().surface)]
    pub surface: Surface,
    /// How strong Phong tessellation is, 0 (flat) to 1; its authors use 0.75 (Boubekeur and Alexa 2008)
    #[arg(long, value_name = "A", default_value_t = Settings::default().alpha, value_parser = alpha)]
    pub alpha: f32,
    /// Which normals the surface is shaded with
    #[arg(long, value_enum, default_value_t = Settings::default().normals)]
    pub normals: Normals,
    /// Who computes what an edge's sides must agree on: the edge once, or every patch for itself as the white paper does
    #[arg(long, value_enum, default_value_t = Settings::default().edges)]
    pub edges: Edges,
    /// Tessellation factor under uniform LOD, and the largest under LOD by distance, 1 to 64
    #[arg(long, value_name = "F", default_value_t = Settings::default().factor, value_parser = factor)]
    pub factor: f32,
    /// How factors become segments
    #[arg(long, value_name = "P", default_value_t = Settings::default().partitioning, value_parser = partitioning())]
    pub partitioning: Partitioning,
    /// Where factors come from: the same everywhere; the white paper's projected length of an edge's control polygon;
    /// that in a form that holds for edges near and behind the eye too; the error on screen; or the distance to the eye
    #[arg(long, value_enum, default_value_t = Settings::default().lod)]
    pub lod: Lod,
    /// Length of a segment on screen under LOD by length (paper, edge-length), in px, 1 to 256
    #[arg(long, value_name = "P", default_value_t = Settings::default().pixels, value_parser = pixels)]
    pub pixels: f32,
    /// How far from the surface what is emitted may be on screen under LOD by error, in px, 0.01 to 100
    #[arg(long, value_name = "PX", default_value_t = Settings::default().tolerance, value_parser = tolerance)]
    pub tolerance: f32,
    /// Under LOD by distance, up to which distance from the eye the factor is --factor, and from which on it is 1, in
    /// bounding radii; linear between
    #[arg(long, value_name = "NEAR,FAR", default_value = "2,10")]
    pub distances: Distances,
    /// Whether patches out of view are left out: never; by the white paper's test, which can drop visible ones; or by each
    /// plane of the view on its own
    #[arg(long, value_enum, default_value_t = Settings::default().clip)]
    pub clip: Clip,
    /// Leave out patches that show their backs only, if the mesh is closed, wound outward and single-sided
    #[arg(long)]
    pub cull_back_faces: bool,
    /// Which edges factors 0, 1 and 2 are for, and which corners the weights u, v and w: as in Direct3D 11, as in AMD's PN
    /// triangles sample, or by edge; or, with hull and domain shader at odds, rotated or mirrored
    #[arg(long, value_name = "NAME", value_enum, default_value_t = Settings::default().convention)]
    pub convention: Convention,
    /// Under LOD by error, raise the tolerance until there are no more triangles than this
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub max_triangles: Option<u64>,
    /// What the surface is displaced by: a PNG or JPEG image over all materials, its brightness as stored from 0 (black) to 1
    /// (white); or `material`, the brightness of each material's base colour image
    #[arg(long, value_name = "IMAGE|material", value_parser = OsStringValueParser::new().map(HeightSource::from))]
    pub height: Option<HeightSource>,
    /// Whether the surface is displaced, and what its patches agree on where they meet; by default on with --height, else
    /// off. Without --height, by the materials' images
    #[arg(long, value_enum)]
    pub displacement: Option<Displacement>,
    /// How far white is above black, in bounding radii, -1 to 1
    #[arg(long, value_name = "S", default_value_t = Settings::default().height_scale, value_parser = height_scale, allow_hyphen_values = true)]
    pub height_scale: f32,
    /// The height that stays where it is, 0 to 1
    #[arg(long, value_name = "H", default_value_t = Settings::default().midlevel, value_parser = fraction)]
    pub midlevel: f32,
    /// Memory for output on the device, in MiB, 1 to 65536; what doesn't fit goes through it in chunks
    #[arg(long, value_name = "MIB", default_value_t = ARENA_BYTES >> 20, value_parser = clap::value_parser!(u64).range(1..=65536))]
    pub arena: u64,
    #[command(flatten)]
    pub weld: WeldOption,
    #[command(flatten)]
    pub animation: AnimationOption,
    /// Width and height of the view, in px
    #[arg(long, value_name = "WxH", default_value = "1280x720")]
    pub size: Size,
    /// Degrees from the front to the right, degrees upwards, and how far from the middle in bounding radii (by default as
    /// far as shows all)
    #[arg(long, value_name = "AZIMUTH,ELEVATION[,DISTANCE]", default_value = "30,20", allow_hyphen_values = true)]
    pub camera: CameraOption,
    /// Look at this place, in object units (by default at the middle of all that is shown)
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub target: Option<Place>,
    /// No perspective
    #[arg(long)]
    pub orthographic: bool,
}

impl Default for SurfaceOptions {
    /// What they are when none is given.
    fn default() -> Self {
        #[derive(Parser)]
        struct Defaults {
            #[command(flatten)]
            options: SurfaceOptions,
        }
        Defaults::parse_from(["pnaen"]).options
    }
}

impl SurfaceOptions {
    /// What parsing can't see: options that need one another.
    ///
    /// # Errors
    /// A budget without a tolerance to raise, an animation of what a rim was made for, heights that there aren't, or factors
    /// that differ under a partitioning that has one for all.
    pub fn check(&self) -> Result<(), CliError> {
        self.check_with(None)
    }

    /// The same where another surface may be tessellated with these options too.
    ///
    /// # Errors
    /// The same.
    pub fn check_with(&self, other: Option<Surface>) -> Result<(), CliError> {
        if self.partitioning == Partitioning::Subtriangulation && self.lod != Lod::Uniform {
            return Err(CliError::Usage(
                "--partitioning subtriangulation has one number of segments for all edges: it needs --lod uniform",
            ));
        }
        if self.weld.rim > 0.0 && self.animation.animation.is_some() {
            return Err(CliError::Usage(
                "--animation can't be with --rim: a rim's triangles hang on nothing that moves",
            ));
        }
        let takes_heights = self.height.is_some() || self.displacement() != Displacement::Off;
        let Settings { height_scale, midlevel, .. } = Settings::default();
        if !takes_heights && (self.height_scale != height_scale || self.midlevel != midlevel) {
            return Err(CliError::Usage("--height-scale and --midlevel need --height, or --displacement"));
        }
        let has_strength = self.surface.is_phong() || other.is_some_and(Surface::is_phong);
        if !has_strength && self.alpha != Settings::default().alpha {
            return Err(CliError::Usage("--alpha needs --surface phong or phong-aen, whose strength it is"));
        }
        if self.max_triangles.is_some() && self.lod != Lod::Error {
            return Err(CliError::Usage("--max-triangles needs --lod error, whose tolerance it raises"));
        }
        Ok(())
    }

    /// What becomes of the mesh after it was read. Displacement without an image is by the materials'.
    pub fn preparation(&self) -> Preparation {
        let wanted = (self.displacement() != Displacement::Off).then_some(HeightSource::Materials);
        Preparation { heights: self.height.clone().or(wanted), ..self.weld.preparation() }
    }

    fn displacement(&self) -> Displacement {
        let default = if self.height.is_some() { Displacement::On } else { Displacement::Off };
        self.displacement.unwrap_or(default)
    }

    /// Settings with these options, and nothing over the surface.
    pub fn settings(&self) -> Settings {
        let Self { surface, alpha, normals, edges, factor, partitioning, lod, pixels, .. } = *self;
        let Self { tolerance, clip, cull_back_faces, convention, height_scale, midlevel, .. } = *self;
        let Distances { near, far } = self.distances;
        Settings {
            surface,
            alpha,
            normals,
            edges,
            factor,
            partitioning,
            lod,
            pixels,
            tolerance,
            near,
            far,
            clip,
            // A pose may turn a part inside out, and its back is then seen.
            cull_back_faces: cull_back_faces && self.animation.animation.is_none(),
            convention,
            displacement: self.displacement(),
            height_scale,
            midlevel,
            ..Settings::default()
        }
    }

    /// The same with a tolerance at which there are no more triangles than asked for, which it says on standard error;
    /// `count` gives the number for settings. LOD is by error if there is a budget.
    ///
    /// # Errors
    /// There are more triangles at any tolerance, or `count` fails.
    pub fn within_budget(
        &self,
        mut count: impl FnMut(&Settings) -> Result<u64, CliError>,
    ) -> Result<Settings, CliError> {
        let settings = self.settings();
        let Some(most) = self.max_triangles else { return Ok(settings) };
        let largest = *TOLERANCE_RANGE.end();
        let tried = settings.tolerance..=largest;
        let fits = tolerance_within_budget(tried, most, |tolerance| count(&Settings { tolerance, ..settings }))?;
        let Some(tolerance) = fits else {
            let least = count(&Settings { tolerance: largest, ..settings })?;
            return Err(CliError::Budget { most, least, largest });
        };
        if tolerance > settings.tolerance {
            let _ = writeln!(
                std::io::stderr(),
                "pnaen: tolerance raised from {} to {tolerance} px, for no more than {most} triangles",
                settings.tolerance
            );
        }
        Ok(Settings { tolerance, ..settings })
    }

    /// Memory for output on the device.
    pub fn arena_bytes(&self) -> u64 {
        self.arena << 20
    }

    /// Looks at everything that is drawn of a mesh with these bounds; its distance is in their radii.
    pub fn camera(&self, mesh: &Mesh, bounds: &Bounds) -> Camera {
        let mut camera = Camera::framing(&bounds.grown(self.settings().reach(mesh)), self.viewport());
        (camera.azimuth, camera.elevation) = (self.camera.azimuth, self.camera.elevation.clamp(-89.9, 89.9));
        if let Some(radii) = self.camera.distance {
            camera.distance = radii * bounds.radius();
        }
        camera.target = self.target.map_or(camera.target, |place| place.0);
        camera.orthographic = self.orthographic;
        camera
    }

    /// Width and height in px.
    pub fn viewport(&self) -> Vec2 {
        Vec2::new(self.size.0[0] as f32, self.size.0[1] as f32)
    }
}

/// What is made of a mesh before anything else: which points are one, and what becomes of creases.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct WeldOption {
    /// Weld points within this distance, relative to the bounding diagonal; 0 joins only exactly equal positions
    #[arg(long, value_name = "TOLERANCE", default_value_t = 0.0, value_parser = weld)]
    pub weld: f32,
    /// Cut triangles back from creases, edges with split normals, by this width, and fill it with a rim of small triangles
    /// with one normal on the crease, so that PN triangles don't tear there (Vlachos et al. 2001). Relative to the bounding
    /// diagonal, 0 to 0.1; 0 is no rim. No wider than a third of an edge, or than half-way to the middle of a triangle's incircle
    #[arg(long, value_name = "WIDTH", default_value_t = 0.0, value_parser = rim, allow_hyphen_values = true)]
    pub rim: f32,
    #[command(flatten)]
    pub limit: LimitOption,
}

impl WeldOption {
    pub fn preparation(&self) -> Preparation {
        Preparation { weld: self.weld, rim: self.rim, heights: None, limits: self.limit.limits() }
    }
}

/// How much is read.
#[derive(Clone, Copy, Debug, Args)]
pub struct LimitOption {
    /// Refuse a file larger than this, and larger buffers and images that it names; a number of bytes, or one of KiB, MiB or
    /// GiB
    #[arg(long, value_name = "SIZE", default_value = "2GiB", value_parser = bytes)]
    pub max_size: u64,
    /// Refuse what would take more memory to load than this and four times the size of its files; a number of bytes, or one
    /// of KiB, MiB or GiB
    #[arg(long, value_name = "SIZE", default_value = "256MiB", value_parser = bytes)]
    pub max_memory: u64,
}

impl Default for LimitOption {
    fn default() -> Self {
        let Limits { file, memory } = Limits::default();
        Self { max_size: file, max_memory: memory }
    }
}

impl LimitOption {
    pub fn limits(&self) -> Limits {
        Limits { file: self.max_size, memory: self.max_memory }
    }
}
