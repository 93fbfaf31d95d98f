//! What is tried.

use std::fmt;

use clap::ValueEnum;

use crate::settings::{Settings, option_name};
use crate::tessellate::{Lod, Normals, Partitioning, Surface};

/// Where factors come from, and what it is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum)]
pub enum LodKind {
    /// One factor everywhere
    Uniform,
    /// The white paper's length of an edge on screen, in px a segment
    Paper,
    /// The error on screen, in px
    Error,
}

impl LodKind {
    pub const ALL: [Self; 3] = [Self::Uniform, Self::Paper, Self::Error];

    fn lod(self) -> Lod {
        match self {
            Self::Uniform => Lod::Uniform,
            Self::Paper => Lod::Paper,
            Self::Error => Lod::Error,
        }
    }

    /// The partitioning that it is commonly used with: numbers of segments whose rows nest are whole.
    fn partitioning(self) -> Partitioning {
        match self {
            Self::Uniform | Self::Paper => Partitioning::FractionalOdd,
            Self::Error => Partitioning::Integer,
        }
    }
}

/// A way to tessellate, but for how fine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Method {
    pub surface: Surface,
    pub normals: Normals,
    pub partitioning: Partitioning,
    pub lod: LodKind,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} by {} LOD", option_name(self.surface), option_name(self.lod))
    }
}

/// A method, and how fine: a factor, or px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    pub method: Method,
    pub value: f32,
}

impl Setting {
    /// All of the mesh is emitted, so that all of it can be held against a truth.
    pub fn settings(&self) -> Settings {
        let Method { surface, normals, partitioning, lod } = self.method;
        let plain = Settings { surface, normals, partitioning, lod: lod.lod(), ..Settings::default() };
        match lod {
            LodKind::Uniform => Settings { factor: self.value, ..plain },
            LodKind::Paper => Settings { pixels: self.value, ..plain },
            LodKind::Error => Settings { tolerance: self.value, ..plain },
        }
    }

    /// How fine, as short as it goes.
    pub fn label(&self) -> String {
        match self.method.lod {
            LodKind::Uniform => self.value.to_string(),
            LodKind::Paper | LodKind::Error => format!("{} px", self.value),
        }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.method.lod {
            LodKind::Uniform => "factor",
            LodKind::Paper => "paper",
            LodKind::Error => "error",
        };
        write!(f, "{what} {}", self.label())
    }
}

/// Everything that is tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    pub surfaces: Vec<Surface>,
    pub normals: Vec<Normals>,
    /// With every LOD; if empty, each has the one that it is commonly used with.
    pub partitionings: Vec<Partitioning>,
    pub lods: Vec<LodKind>,
    /// For uniform LOD.
    pub factors: Vec<f32>,
    /// For the white paper's, and by error.
    pub pixels: Vec<f32>,
    pub tolerances: Vec<f32>,
}

impl Plan {
    /// Method by method, each from coarse to fine as listed. Subtriangulation is uniform, so it has no other LOD.
    pub fn settings(&self) -> Vec<Setting> {
        let mut all: Vec<Setting> = Vec::new();
        for method in self.methods() {
            let values = match method.lod {
                LodKind::Uniform => &self.factors,
                LodKind::Paper => &self.pixels,
                LodKind::Error => &self.tolerances,
            };
            let settings = values.iter().map(|&value| Setting { method, value });
            // What was named twice is tried once.
            settings.for_each(|setting| {
                if !all.contains(&setting) {
                    all.push(setting);
                }
            });
        }
        all
    }

    fn methods(&self) -> Vec<Method> {
        let mut all = Vec::new();
        for (&surface, &normals) in self.surfaces.iter().flat_map(|a| self.normals.iter().map(move |b| (a, b))) {
            for &lod in &self.lods {
                let common = [lod.partitioning()];
                let listed = if self.partitionings.is_empty() { &common[..] } else { &self.partitionings };
                let possible = |partitioning: &&Partitioning| {
                    lod == LodKind::Uniform || **partitioning != Partitioning::Subtriangulation
                };
                let method = |&partitioning: &Partitioning| Method { surface, normals, partitioning, lod };
                all.extend(listed.iter().filter(possible).map(method));
            }
        }
        all
    }
}
