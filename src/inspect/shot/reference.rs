//! A reference picture: how a picture compares with it.

use std::io::{BufReader, Seek};
use std::path::{Path, PathBuf};

use image::{GrayImage, ImageError, ImageReader, RgbaImage};
use serde::Serialize;

use super::ShotError;
use super::files::file_error;
use super::picture_comparison::{CompareError, Comparison, compare, difference_picture};
use super::picture_file::{adapter_of, write_picture};
use geometry::names::shown_path;
use gpu::identity;
use load::files::{file_reason, open_file};

/// The largest mean difference of a square of 8 x 8 px that pictures of two drivers may have, in steps of 255. Chosen by what
/// an NVIDIA H200 draws otherwise than the software driver, which docs/results/compare-pictures.md lists, and by the pairs in `tests/gpu/reference.rs`.
pub const BETWEEN_DRIVERS: f32 = 1.5;

/// The part of stats about the reference.
#[derive(Clone, Debug, Serialize)]
pub struct ReferenceStats {
    is_same: bool,
    comparison: &'static str,
    /// How many px differ.
    px_different: u64,
    /// By how much at most, in steps of 255.
    largest_step: u8,
    /// The largest mean difference of a square of 8 x 8 px, in steps of 255.
    worst_square: f64,
    /// What that may be; none where all px must be equal.
    threshold: Option<f32>,
}

/// A reference picture that was read.
pub struct Reference {
    path: PathBuf,
    picture: RgbaImage,
    /// What drew it, if it says so.
    adapter: Option<String>,
    /// What was given with `--threshold`.
    threshold: Option<f32>,
}

/// How a picture and its reference differ, and how much they may.
#[derive(Debug)]
pub struct Verdict {
    comparison: Comparison,
    /// The largest mean difference of a square that is allowed; none where all px must be equal.
    threshold: Option<f32>,
    /// Why it is that much, as a clause of a sentence.
    why: &'static str,
}

impl Verdict {
    /// Whether both are the same: the one place that decides it.
    pub fn is_same(&self) -> bool {
        match self.threshold {
            None => self.comparison.px == 0,
            Some(threshold) => self.comparison.worst_square <= f64::from(threshold),
        }
    }

    fn stats(&self) -> ReferenceStats {
        let Comparison { px, largest, worst_square } = self.comparison;
        let comparison = if self.threshold.is_none() { "exact" } else { "tolerant" };
        let (is_same, threshold) = (self.is_same(), self.threshold);
        ReferenceStats { is_same, comparison, px_different: px, largest_step: largest, worst_square, threshold }
    }

    /// How much they differ and how much they may, as clauses of a sentence.
    pub fn in_words(&self) -> String {
        let Comparison { px, largest, worst_square } = self.comparison;
        let (px, why) = (format!("{px} px differ, by up to {largest} steps of 255"), self.why);
        match self.threshold {
            None if self.comparison.px == 0 => format!("all px are equal, as they must be since {why}"),
            None => format!("{px}, and none may since {why}"),
            Some(threshold) => format!(
                "{px}; the worst square of 8 x 8 px differs by {worst_square:.2} steps on average, and {threshold} are allowed since \
                 {why}"
            ),
        }
    }
}

/// How a picture compares with its reference.
pub struct Judged {
    pub stats: ReferenceStats,
    /// A sentence for people if it is the same, else the error.
    pub said: Result<String, ShotError>,
}

impl Reference {
    /// Reads the reference picture at `path`. The command calls this before it draws or writes anything.
    ///
    /// # Errors
    /// It can't be read.
    pub fn read(path: &Path, threshold: Option<f32>) -> Result<Self, ShotError> {
        let fail = |reason: &dyn std::fmt::Display| file_error(path, "read", reason);
        let file = open_file(path).map_err(|error| fail(&file_reason(&error)))?;
        let file = file.ok_or_else(|| fail(&"it is not a file; name a PNG, JPEG or WebP image"))?.0;
        let adapter = adapter_of(BufReader::new(&file));
        (&file).rewind().map_err(|error| fail(&file_reason(&error)))?;
        let reader =
            ImageReader::new(BufReader::new(file)).with_guessed_format().map_err(|error| fail(&file_reason(&error)))?;
        let reference = reader.decode().map_err(|error| match error {
            ImageError::Unsupported(_) => fail(&"it is no image; name a PNG, JPEG or WebP one"),
            error => fail(&error),
        })?;
        Ok(Self { path: path.to_owned(), picture: reference.to_rgba8(), adapter, threshold })
    }

    /// Compares a picture that this adapter has drawn with it.
    ///
    /// # Errors
    /// The picture is of another size.
    pub fn compare(&self, picture: &RgbaImage, adapter: &wgpu::AdapterInfo) -> Result<Verdict, CompareError> {
        let (threshold, why) = match (self.threshold, self.adapter.as_deref(), identity(adapter)) {
            (Some(_), ..) => (self.threshold, "--threshold says so"),
            (None, None, _) => (Some(BETWEEN_DRIVERS), "the reference doesn't say what drew it"),
            (None, Some(own), Some(other)) if own == other => {
                (None, "the same adapter, driver and processor drew both")
            }
            (None, Some(_), Some(_)) => {
                (Some(BETWEEN_DRIVERS), "another adapter, driver or processor drew the reference")
            }
            (None, Some(_), None) => (Some(BETWEEN_DRIVERS), "the adapter's driver or processor isn't known"),
        };
        Ok(Verdict { comparison: compare(picture, &self.picture)?, threshold, why })
    }

    /// Where a picture that was compared differs: px that differ by more than is allowed are grey to white, and all others black.
    pub fn difference(&self, picture: &RgbaImage, verdict: &Verdict) -> GrayImage {
        difference_picture(picture, &self.picture, verdict.threshold.unwrap_or(0.0))
    }

    /// Compares the picture at `output`, which this adapter has drawn, with it. If they differ, it writes the difference beside
    /// the picture.
    ///
    /// # Errors
    /// The picture is of another size, or the difference can't be written.
    pub fn judge(&self, output: &Path, picture: &RgbaImage, adapter: &wgpu::AdapterInfo) -> Result<Judged, ShotError> {
        let own = shown_path(&self.path);
        let verdict =
            self.compare(picture, adapter).map_err(|reason| ShotError::Reference { reference: own.clone(), reason })?;
        let said = if verdict.is_same() {
            Ok(format!("{} is the same as {own}: {}", shown_path(output), verdict.in_words()))
        } else {
            let see = write_difference(output, self.difference(picture, &verdict))?;
            Err(ShotError::Different { picture: shown_path(output), reference: own, how: verdict.in_words(), see })
        };
        Ok(Judged { stats: verdict.stats(), said })
    }
}

/// Writes the picture of the differences beside a picture, and returns the end of a sentence that says where.
fn write_difference(output: &Path, map: GrayImage) -> Result<String, ShotError> {
    // A device or a pipe has no folder for the picture of the difference.
    if !output.is_file() {
        return Ok(String::new());
    }
    let mut name = output.file_stem().unwrap_or_default().to_owned();
    name.push("-diff.png");
    let diff = output.with_file_name(name);
    write_picture(&diff, &map.into())?;
    Ok(format!("; {} shows where", shown_path(&diff)))
}
