//! The option `--reference`: compares the picture with a reference picture.

use std::io::{BufReader, Write};
use std::path::{Path, PathBuf};

use image::{ImageError, ImageReader, RgbaImage};
use serde::Serialize;

use super::options::{steps, threshold, whole_from};
use super::picture_comparison::{Comparison, PictureTolerance, compare_by};
use super::{CliError, file_error, write_picture};
use crate::files::{file_reason, open_file};
use crate::names::shown_path;

/// The reference, and how much a picture may differ from it.
#[derive(Clone, Debug, Default, clap::Args)]
pub(crate) struct ReferenceOptions {
    /// Fail if the picture differs from this one by more than the three thresholds allow, and write a picture of the difference
    /// beside it. With --cameras, a folder, or a name with {} where each view's name goes
    #[arg(long, value_name = "PNG")]
    pub reference: Option<PathBuf>,
    #[command(flatten)]
    pub tolerance: ToleranceOptions,
}

#[derive(Clone, Copy, Debug, clap::Args)]
pub(crate) struct ToleranceOptions {
    /// Largest difference of the whole picture that passes: 0 for equal pictures, 1 for nothing in common (1 minus structural
    /// similarity)
    #[arg(long, value_name = "T", default_value_t = PictureTolerance::default().difference, value_parser = threshold, requires = "reference")]
    pub threshold: f64,
    /// Largest mean difference of a tile of 8 x 8 px that passes, in steps of 255; px at edges don't count
    #[arg(long, value_name = "STEPS", default_value_t = PictureTolerance::default().tile as f32, value_parser = steps, requires = "reference")]
    pub tile_threshold: f32,
    /// How many px may differ from all that is beside them in the reference by more than --px-step
    #[arg(long, value_name = "N", default_value_t = PictureTolerance::default().px, value_parser = whole_from(0_u64), requires = "reference")]
    pub px_threshold: u64,
    /// The difference from which on px are counted, in steps of 255
    #[arg(long, value_name = "STEPS", default_value_t = PictureTolerance::default().step, value_parser = steps, requires = "reference")]
    pub px_step: f32,
}

impl Default for ToleranceOptions {
    fn default() -> Self {
        let PictureTolerance { difference, tile, step, px } = PictureTolerance::default();
        Self { threshold: difference, tile_threshold: tile as f32, px_threshold: px, px_step: step }
    }
}

impl ToleranceOptions {
    fn tolerance(&self) -> PictureTolerance {
        let Self { threshold, tile_threshold, px_threshold, px_step } = *self;
        PictureTolerance { difference: threshold, tile: f64::from(tile_threshold), step: px_step, px: px_threshold }
    }
}

/// The part of stats about the reference.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ReferenceStats {
    /// Whether no threshold is exceeded.
    is_same: bool,
    /// 0 for equal pictures, 1 for nothing in common.
    difference: f64,
    /// The largest mean difference of a tile, in steps of 255.
    largest_tile: f64,
    /// How many px differ by more than the step.
    px_beyond: u64,
    px_step: f32,
}

/// A reference picture that was read.
pub(super) struct Reference {
    path: PathBuf,
    picture: RgbaImage,
    tolerance: PictureTolerance,
}

/// How a picture compares with its reference.
pub(super) struct Judged {
    pub stats: ReferenceStats,
    /// A sentence for people if it is the same, else the error.
    pub said: Result<String, CliError>,
}

impl Reference {
    /// Reads the reference picture at `path`. The command calls this before it draws or writes anything.
    ///
    /// # Errors
    /// It can't be read.
    pub(super) fn read(path: &Path, options: &ReferenceOptions) -> Result<Self, CliError> {
        let fail = |reason: &dyn std::fmt::Display| file_error(path, "read", reason);
        let file = open_file(path).map_err(|error| fail(&file_reason(&error)))?;
        let file = file.ok_or_else(|| fail(&"it is not a file; name a PNG, JPEG or WebP image"))?.0;
        let reader =
            ImageReader::new(BufReader::new(file)).with_guessed_format().map_err(|error| fail(&file_reason(&error)))?;
        let reference = reader.decode().map_err(|error| match error {
            ImageError::Unsupported(_) => fail(&"it is no image; name a PNG, JPEG or WebP one"),
            error => fail(&error),
        })?;
        let tolerance = options.tolerance.tolerance();
        Ok(Self { path: path.to_owned(), picture: reference.to_rgba8(), tolerance })
    }

    /// Compares the picture at `output` with it. If they differ, it writes the difference beside the picture.
    ///
    /// # Errors
    /// The picture is of another size, or the difference can't be written.
    pub(super) fn judge(&self, output: &Path, picture: &RgbaImage) -> Result<Judged, CliError> {
        let Self { path, picture: reference, tolerance } = self;
        let comparison = compare_by(picture, reference, tolerance.step)
            .map_err(|reason| CliError::Reference { reference: shown_path(path), reason })?;
        let Comparison { difference, largest_tile, px_beyond, .. } = comparison;
        let is_same = comparison.is_same(tolerance);
        let stats = ReferenceStats { is_same, difference, largest_tile, px_beyond, px_step: tolerance.step };
        let said = if is_same {
            Ok(format!(
                "{} is the same as {}: the difference is {difference:.4}, {largest_tile:.2} steps in the worst tile, and {} px \
                 are beyond {} steps",
                shown_path(output),
                shown_path(path),
                px_beyond,
                tolerance.step
            ))
        } else {
            let see = write_difference(output, comparison.map.clone())?;
            let how = comparison.excesses(tolerance).join(", and ");
            Err(CliError::Different { picture: shown_path(output), reference: shown_path(path), how, see })
        };
        Ok(Judged { stats, said })
    }
}

/// Writes the picture of the differences beside a picture, and returns the end of a sentence that says where.
fn write_difference(output: &Path, map: image::RgbImage) -> Result<String, CliError> {
    // A device or a pipe has no folder for the picture of the difference.
    if !output.is_file() {
        return Ok(String::new());
    }
    let mut name = output.file_stem().unwrap_or_default().to_owned();
    name.push("-diff.png");
    let diff = output.with_file_name(name);
    write_picture(&diff, &map.into())?;
    Ok(format!(": see {}, where the differences are bright", shown_path(&diff)))
}

/// Tells on standard error how pictures compare with their references.
///
/// # Errors
/// The one that differs, or how many do.
pub(super) fn conclude(all: Vec<Result<String, CliError>>) -> Result<(), CliError> {
    let count = all.len();
    let mut differing = Vec::new();
    for said in all {
        match said {
            Ok(said) => {
                let _ = writeln!(std::io::stderr(), "pnaen: {said}");
            }
            Err(error) => differing.push(error),
        }
    }
    if count == 1 {
        return differing.pop().map_or(Ok(()), Err);
    }
    for error in &differing {
        let _ = writeln!(std::io::stderr(), "pnaen: {error}");
    }
    match differing.len() {
        0 => Ok(()),
        different => Err(CliError::ManyDifferent { different, all: count }),
    }
}
