//! Options that several commands share, and how their values are read.

use std::io::Write;
use std::path::PathBuf;
use std::str::FromStr;

use clap::builder::{OsStringValueParser, PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser};
use glam::Vec2;

use super::{AnimationOption, CliError};
use crate::engine::Preparation;
use crate::mesh::{Bounds, HeightSource, Limits, Source};
use crate::mesh::{Mesh, rim::WIDEST};
use crate::render::Camera;
use crate::settings::{
    ALPHA_RANGE, ARENA_BYTES, DISTANCE_RANGE, FACTOR_RANGE, HEIGHT_RANGE, PIXELS_RANGE, Settings, TOLERANCE_RANGE,
};
use crate::tessellate::{Clip, Convention, Displacement, Edges, Lod, Normals, Partitioning, Surface, fit_budget};

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
        let fits = fit_budget(tried, most, |tolerance| count(&Settings { tolerance, ..settings }))?;
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
        camera
    }

    /// Width and height in px.
    pub fn viewport(&self) -> Vec2 {
        Vec2::new(self.size.0[0] as f32, self.size.0[1] as f32)
    }
}

/// Reads a partitioning, and says what each is; HLSL's spelling with an underscore is one too.
pub fn partitioning() -> impl TypedValueParser<Value = Partitioning> {
    let value = |partitioning: Partitioning| {
        let about = partitioning.about().trim_end_matches('.');
        PossibleValue::new(partitioning.name()).help(about).alias(partitioning.name().replace('-', "_"))
    };
    PossibleValuesParser::new(Partitioning::ALL.map(value)).try_map(|name| name.parse::<Partitioning>())
}

/// Reads where to write a picture: not a name that says it is no PNG file.
pub fn picture() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(|path| {
        let path = PathBuf::from(path);
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some(other @ ("jpg" | "jpeg" | "webp" | "bmp" | "gif" | "tif" | "tiff")) => {
                Err(format!("pictures are PNG files, not .{other}: name it .png"))
            }
            _ => Ok(path),
        }
    })
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
}

impl Default for LimitOption {
    fn default() -> Self {
        Self { max_size: Limits::default().file }
    }
}

impl LimitOption {
    pub fn limits(&self) -> Limits {
        Limits { file: self.max_size }
    }
}

/// Width and height in px.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(pub [u32; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |text: &str| text.parse().ok().filter(|side| (1..=16384).contains(side));
        let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([side(w)?, side(h)?]));
        sides.map(Self).ok_or_else(|| "expected WIDTHxHEIGHT in px, each from 1 to 16384, such as 1280x720".into())
    }
}

/// Near and far, in bounding radii.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distances {
    pub near: f32,
    pub far: f32,
}

impl FromStr for Distances {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse().ok().filter(|number| DISTANCE_RANGE.contains(number));
        let both = text.split_once(',').and_then(|(near, far)| Some(Self { near: number(near)?, far: number(far)? }));
        both.filter(|both| both.near < both.far).ok_or_else(|| {
            "expected NEAR,FAR in bounding radii, from 0.1 to 1000 and far the larger, such as 2,10".into()
        })
    }
}

/// Where one looks from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraOption {
    /// Degrees.
    pub azimuth: f32,
    pub elevation: f32,
    /// Bounding radii.
    pub distance: Option<f32>,
}

impl FromStr for CameraOption {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f32>> =
            text.split(',').map(|number| number.trim().parse().ok().filter(|x: &f32| x.is_finite())).collect();
        match numbers.as_deref() {
            Some(&[azimuth, elevation]) => Ok(Self { azimuth, elevation, distance: None }),
            Some(&[azimuth, elevation, distance]) if distance > 0.0 => {
                Ok(Self { azimuth, elevation, distance: Some(distance) })
            }
            _ => Err("expected AZIMUTH,ELEVATION in degrees and perhaps a DISTANCE above 0 in bounding radii, such as 30,20,2.5".into()),
        }
    }
}

/// Reads a mesh's source, whose path may be in any encoding.
pub fn source() -> impl TypedValueParser<Value = Source> {
    OsStringValueParser::new().try_map(Source::try_from)
}

/// An sRGB colour as RRGGBB.
pub fn color(text: &str) -> Result<[u8; 3], String> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    let value = (digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit()))
        .then(|| u32::from_str_radix(digits, 16).ok())
        .flatten();
    let [_, r, g, b] = value.ok_or("expected six hexadecimal digits, such as 2b2e33")?.to_be_bytes();
    Ok([r, g, b])
}

/// A number of bytes, with a unit or without.
fn bytes(text: &str) -> Result<u64, String> {
    let (number, unit) = text.split_at(text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len()));
    let unit = match unit.trim().to_lowercase().as_str() {
        "" | "b" => Some(1),
        "kib" => Some(1_u64 << 10),
        "mib" => Some(1 << 20),
        "gib" => Some(1 << 30),
        _ => None,
    };
    let bytes = unit.zip(number.parse().ok()).and_then(|(unit, number): (u64, u64)| unit.checked_mul(number));
    let expected = "expected a whole number of bytes above 0, or of KiB, MiB or GiB, such as 500MiB";
    bytes.filter(|bytes| *bytes > 0).ok_or_else(|| expected.into())
}

/// A difference from 0 to 1.
pub fn threshold(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (0.0..=1.0).contains(number));
    number.ok_or_else(|| "expected a number from 0 to 1".into())
}

/// A fraction from 0 to 1.
pub fn fraction(text: &str) -> Result<f32, String> {
    within(text, 0.0..=1.0)
}

/// A weld tolerance, relative to the bounding diagonal, from 0 to 0.1.
pub fn weld(text: &str) -> Result<f32, String> {
    within(text, 0.0..=0.1)
}

/// The width of a rim, relative to the bounding diagonal.
fn rim(text: &str) -> Result<f32, String> {
    within(text, 0.0..=WIDEST)
}

pub fn factor(text: &str) -> Result<f32, String> {
    within(text, FACTOR_RANGE)
}

fn alpha(text: &str) -> Result<f32, String> {
    within(text, ALPHA_RANGE)
}

pub fn height_scale(text: &str) -> Result<f32, String> {
    within(text, HEIGHT_RANGE)
}

pub fn pixels(text: &str) -> Result<f32, String> {
    within(text, PIXELS_RANGE)
}

pub fn tolerance(text: &str) -> Result<f32, String> {
    within(text, TOLERANCE_RANGE)
}

fn within(text: &str, range: std::ops::RangeInclusive<f32>) -> Result<f32, String> {
    let number = text.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| format!("expected a number from {} to {}", range.start(), range.end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_colors_and_cameras_are_read_or_refused() {
        assert_eq!("640x480".parse(), Ok(Size([640, 480])));
        for bad in ["640", "0x10", "640x", "-1x5", "99999x5"] {
            assert!(bad.parse::<Size>().is_err(), "{bad}");
        }
        assert_eq!(color("#ff8000"), Ok([255, 128, 0]));
        for bad in ["", "12345", "1234567", "gggggg", "+12345"] {
            assert!(color(bad).is_err(), "{bad}");
        }
        let camera = CameraOption { azimuth: -10.0, elevation: 5.5, distance: Some(2.0) };
        assert_eq!("-10, 5.5,2".parse(), Ok(camera));
        for bad in ["1", "1,2,0", "1,2,3,4", "nan,0", "a,b"] {
            assert!(bad.parse::<CameraOption>().is_err(), "{bad}");
        }
        assert_eq!("1.5, 8".parse(), Ok(Distances { near: 1.5, far: 8.0 }));
        for bad in ["2", "8,2", "2,2", "0,5", "2,1001", "nan,3", "2,3,4"] {
            assert!(bad.parse::<Distances>().is_err(), "{bad}");
        }
        assert_eq!(["1", "2KiB", "3 mib", "2GiB"].map(bytes), [1, 2 << 10, 3 << 20, 2 << 30].map(Ok));
        assert_eq!(Limits::default(), LimitOption::default().limits());
        for bad in ["", "0", "0GiB", "-1", "1.5GiB", "GiB", "1GB", "1e9", "99999999999GiB", "+1"] {
            assert!(bytes(bad).is_err(), "{bad}");
        }
        assert!(weld("0").is_ok() && weld("1e-7") == Ok(1e-7) && weld("0.1").is_ok());
        assert!(weld("0.11").is_err() && weld("-1e-7").is_err() && weld("nan").is_err() && weld("").is_err());
        assert!(factor("nan").is_err() && factor("65").is_err() && factor("0.5").is_err() && factor("64").is_ok());
    }
}
