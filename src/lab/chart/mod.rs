//! Speed against accuracy: every method is timed at many settings and compared with a reference surface. The results are rows,
//! a picture and a report.

mod axis;
mod bench;
mod labels;
mod legend;
mod method_style;
mod pen;
mod picture;
mod race;
pub mod report;
mod save;
mod setting;
mod words;

pub use axis::{Axis, Tick};
pub use bench::{Bench, Effort, whole};
pub use legend::method_styles;
pub use method_style::{Fill, MethodStyle, Shape, dash};
pub use pen::RADIUS;
pub use picture::{bitmap, svg};
pub use race::{Cost, front, has_converged};
pub(crate) use race::{Race, Win};
pub use save::save;
pub use setting::{LodKind, Method, Plan, Setting, coarse_first};

use geometry::near::Interval;
use geometry::tessellate::Vertex;
use gpu::{PassTime, ms_of};
use inspect::settings::Choice;

/// A column's name, and its text of a row.
type Column = (&'static str, fn(&Row) -> String);

/// The columns of a row written as CSV. Numbers read back exactly, and unknown values are empty.
const COLUMNS: [Column; 19] = [
    ("mesh", |row| row.mesh.clone()),
    ("adapter", |row| row.adapter.clone()),
    ("surface", |row| row.setting.method.surface.name().to_owned()),
    ("normals", |row| row.setting.method.normals.name().to_owned()),
    ("partitioning", |row| row.setting.method.partitioning.name().to_owned()),
    ("lod", |row| row.setting.method.lod.name().to_owned()),
    ("setting", |row| row.setting.to_string()),
    ("triangles", |row| row.probe.triangles.to_string()),
    ("vertices", |row| row.probe.vertices.to_string()),
    ("bytes", |row| row.bytes().to_string()),
    ("ms_tessellate", |row| row.probe.time.tessellate.to_string()),
    ("ms_draw", |row| row.probe.time.draw.to_string()),
    ("ms_total", |row| row.probe.time.total().to_string()),
    ("max_error", |row| known(row.probe.errors.map(|errors| errors.largest.at_least))),
    ("rms_error", |row| known(row.probe.errors.map(|errors| errors.rms))),
    ("max_error_px", |row| known(row.probe.max_error_px)),
    ("normal_error_deg", |row| known(row.probe.errors.map(|errors| errors.normal_degrees))),
    ("triangles_by_error", |row| known(row.probe.triangles_by_error)),
    ("max_error_at_most", |row| known(row.probe.errors.map(|errors| errors.largest.at_most))),
];

fn known(number: Option<impl ToString>) -> String {
    number.map_or_else(String::new, |number| number.to_string())
}

/// The names of the columns of [`Row::record`].
pub fn columns() -> [&'static str; 19] {
    COLUMNS.map(|(name, _)| name)
}

/// The measurements of one setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The mesh's name, as the user gave it.
    pub mesh: String,
    pub adapter: String,
    pub setting: Setting,
    pub probe: Probe,
}

/// The cost and the errors of some settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    pub triangles: u64,
    pub vertices: u64,
    pub time: Time,
    /// Compared with the reference surface; `None` without one, or if nothing with an area was emitted.
    pub errors: Option<Errors>,
    /// The largest distance on screen, in px, from what was emitted to the reference surface, or without one to the limit of
    /// the method's own surface; `None` if nothing is in view.
    pub max_error_px: Option<f64>,
    /// The triangles with which LOD by error comes as close to the limit of the method's own surface as this row does, on
    /// screen and under the same partitioning; `None` if nothing is in view, or the tessellator hasn't enough segments.
    pub triangles_by_error: Option<u64>,
}

/// Median times in ms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Time {
    /// All passes that run again when the view changes, from factors to displacement. Control nets are made once, and don't
    /// count.
    pub tessellate: f64,
    pub draw: f64,
}

/// Distances in both directions, as parts of the reference surface's bounding diagonal, and the largest angle between normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    pub largest: Interval,
    pub rms: f64,
    pub normal_degrees: f64,
}

/// The passes that run again when the view changes.
const TESSELLATE: [&str; 7] = ["factors", "levels", "counts", "scan", "chunks", "emit", "displace"];

impl Time {
    pub fn new(passes: &[PassTime]) -> Self {
        let tessellate = passes.iter().filter(|time| TESSELLATE.contains(&time.pass)).map(|time| time.ms).sum();
        Self { tessellate, draw: ms_of(passes, true) }
    }

    pub fn total(&self) -> f64 {
        self.tessellate + self.draw
    }
}

impl Row {
    /// The size of the emitted vertices and indices.
    pub fn bytes(&self) -> u64 {
        self.probe.vertices * size_of::<Vertex>() as u64 + self.probe.triangles * 12
    }

    /// The row as a record of CSV.
    pub fn record(&self) -> [String; 19] {
        COLUMNS.map(|(_, text)| text(self))
    }
}

/// A mesh with its measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// The mesh's name in pictures and reports.
    pub title: String,
    /// The reference surface that it was compared with, in words; `None` if each surface was compared with its own limit.
    pub reference_shape: Option<String>,
    pub adapter: String,
    /// The width and height of the view, in px.
    pub size: [u32; 2],
    pub rows: Vec<Row>,
}

impl Subject {
    /// The largest error that was found: a part of the reference surface's diagonal, or px without a reference surface.
    pub fn error(&self, probe: &Probe) -> Option<f64> {
        let error = match self.reference_shape {
            Some(_) => probe.errors.map(|errors| errors.largest.at_least),
            None => probe.max_error_px,
        };
        error.filter(|error| error.is_finite())
    }
}

/// Each value once, in the order in which they come first.
pub(crate) fn distinct<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut all = Vec::new();
    for value in values {
        if !all.contains(&value) {
            all.push(value);
        }
    }
    all
}

#[cfg(test)]
mod tests;
