//! Speed against accuracy: every method at many settings, timed and held against a truth, as rows and as a picture.

mod axis;
mod bench;
mod cost;
mod labels;
mod legend;
mod look;
mod pen;
mod picture;
mod race;
pub(crate) mod report;
mod save;
mod setting;
mod words;

pub(crate) use axis::{Axis, Tick, tick_text};
pub(crate) use bench::{Bench, Effort, Probe, whole};
pub(crate) use cost::Cost;
pub(crate) use legend::looks;
pub(crate) use look::{Fill, Look, Shape, dash};
pub(crate) use pen::RADIUS;
pub(crate) use picture::{bitmap, svg};
#[cfg(test)]
pub(crate) use race::front;
pub(crate) use race::{Race, Win, has_converged};
pub(crate) use save::{SaveError, save};
pub(crate) use setting::{LodKind, Method, Plan, Setting, coarse_first};

use crate::gpu::{DRAWING, PassTime};
use crate::settings::Choice;
use crate::tessellate::Vertex;

/// The columns of a row written as CSV.
pub(crate) const COLUMNS: [&str; 17] = [
    "mesh",
    "adapter",
    "surface",
    "normals",
    "partitioning",
    "lod",
    "setting",
    "triangles",
    "vertices",
    "bytes",
    "ms_tessellate",
    "ms_draw",
    "ms_total",
    "max_error",
    "rms_error",
    "max_error_px",
    "normal_error_deg",
];

/// One setting, measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// As it was named.
    pub mesh: String,
    pub adapter: String,
    pub setting: Setting,
    pub triangles: u64,
    pub vertices: u64,
    pub time: Time,
    /// Against the truth; none without one, or where nothing was emitted that has an area.
    pub errors: Option<Errors>,
    /// The largest distance on screen, in px: from what was emitted to the truth, or without one to the surface's own limit;
    /// none if nothing is in view.
    pub max_error_px: Option<f64>,
}

/// Medians, in ms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Time {
    /// From factors to what is emitted, and displaced: what is done again whenever the view changes. Control nets are made once.
    pub tessellate: f64,
    pub draw: f64,
}

/// Distances both ways, as parts of the truth's bounding diagonal, and the largest angle between normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    pub largest: f64,
    pub rms: f64,
    pub normal_degrees: f64,
}

/// Passes that run again with every view.
const TESSELLATE: [&str; 7] = ["factors", "levels", "counts", "scan", "chunks", "emit", "displace"];

impl Time {
    pub fn of(passes: &[PassTime]) -> Self {
        let sum = |which: &dyn Fn(&str) -> bool| {
            passes.iter().filter(|time| which(time.pass)).map(|time| time.ms).sum::<f64>()
        };
        Self { tessellate: sum(&|pass| TESSELLATE.contains(&pass)), draw: sum(&|pass| DRAWING.contains(&pass)) }
    }

    pub fn total(&self) -> f64 {
        self.tessellate + self.draw
    }
}

impl Row {
    /// What the passes emit.
    pub fn bytes(&self) -> u64 {
        self.vertices * size_of::<Vertex>() as u64 + self.triangles * 12
    }

    /// The fields of [`COLUMNS`]; numbers read back exactly, and what is not known is empty.
    pub fn record(&self) -> [String; 17] {
        let Method { surface, normals, partitioning, lod } = self.setting.method;
        let known = |number: Option<f64>| number.map_or_else(String::new, |number| number.to_string());
        [
            self.mesh.clone(),
            self.adapter.clone(),
            surface.name().to_owned(),
            normals.name().to_owned(),
            partitioning.name().to_owned(),
            lod.name().to_owned(),
            self.setting.to_string(),
            self.triangles.to_string(),
            self.vertices.to_string(),
            self.bytes().to_string(),
            self.time.tessellate.to_string(),
            self.time.draw.to_string(),
            self.time.total().to_string(),
            known(self.errors.map(|errors| errors.largest)),
            known(self.errors.map(|errors| errors.rms)),
            known(self.max_error_px),
            known(self.errors.map(|errors| errors.normal_degrees)),
        ]
    }
}

/// A mesh, and what was measured of it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Subject {
    /// What it is called.
    pub title: String,
    /// What it was held against, in words; none for the limits of its own surfaces.
    pub truth: Option<String>,
    pub adapter: String,
    /// Of the view, in px.
    pub size: [u32; 2],
    pub rows: Vec<Row>,
}

impl Subject {
    /// How far a row is off: a part of the truth's diagonal, or px without a truth.
    pub(crate) fn error(&self, row: &Row) -> Option<f64> {
        self.error_of(row.errors, row.max_error_px)
    }

    /// The same, of anything measured as rows are.
    pub(crate) fn error_of(&self, errors: Option<Errors>, max_error_px: Option<f64>) -> Option<f64> {
        let error = match self.truth {
            Some(_) => errors.map(|errors| errors.largest),
            None => max_error_px,
        };
        error.filter(|error| error.is_finite())
    }
}

#[cfg(test)]
mod tests;
