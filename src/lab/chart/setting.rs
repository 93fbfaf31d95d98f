//! The methods and settings that a chart tries.

use std::fmt;

use super::distinct;
use geometry::choice::choices;
use geometry::defaults::with_defaults;
use geometry::tessellate::{Lod, Normals, Partitioning, Surface, Tessellation};
use inspect::settings::{Choice, Settings};

choices! {
    /// The kinds of LOD that a chart tries, and the number that says how fine each is.
    #[derive(Hash)]
    pub enum LodKind {
        Uniform => "uniform", "Uniform factor", "All edges have the same factor.";
        Paper => "paper", "White paper's LOD",
            "The white paper's length of an edge on screen, divided by the length of a segment in px.";
        Error => "error", "LOD by error", "The error on screen, in px.";
        ErrorRows => "error-rows", "LOD by error, rows", "The error on screen, in px, with patches that are cut into rows.";
    }
}

impl LodKind {
    /// The kind of an LOD with a partitioning; `None` for one that isn't tried.
    fn new(lod: Lod, partitioning: Partitioning) -> Option<Self> {
        let has_rows = partitioning.has_rows() && lod.is_by_error();
        Self::ALL.into_iter().find(|kind| kind.declared().0 == lod && (*kind == Self::ErrorRows) == has_rows)
    }

    /// Its LOD, the partitioning that it is commonly used with, and the number that says how fine it is. LOD by error uses
    /// numbers of segments that nest, which are whole.
    fn declared(self) -> (Lod, Partitioning, fn(&mut Tessellation) -> &mut f32) {
        match self {
            Self::Uniform => (Lod::Uniform, Partitioning::FractionalOdd, |own| &mut own.factor),
            Self::Paper => (Lod::Paper, Partitioning::FractionalOdd, |own| &mut own.pixels),
            Self::Error => (Lod::Error, Partitioning::Integer, |own| &mut own.tolerance),
            Self::ErrorRows => (Lod::Error, Partitioning::Rows, |own| &mut own.tolerance),
        }
    }

    /// Whether its number is one of px, which is finer the less it is.
    fn is_in_px(self) -> bool {
        self != Self::Uniform
    }
}

/// A way to tessellate, except for how fine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Method {
    pub surface: Surface,
    pub normals: Normals,
    pub partitioning: Partitioning,
    pub lod: LodKind,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} by {} LOD", self.surface.name(), self.lod.name())
    }
}

/// A method, and a number that says how fine it is: a factor, or px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    pub method: Method,
    pub value: f32,
}

impl Setting {
    /// The setting that some settings amount to; `None` under an LOD that isn't tried.
    pub fn new(settings: &Settings) -> Option<Self> {
        let mut own = settings.tessellation;
        let Tessellation { surface, normals, partitioning, .. } = own;
        let lod = LodKind::new(own.used_lod(), partitioning)?;
        let (.., number) = lod.declared();
        Some(Self { method: Method { surface, normals, partitioning, lod }, value: *number(&mut own) })
    }

    /// Some settings with this one applied.
    pub fn applied(&self, settings: &Settings) -> Settings {
        let Method { surface, normals, partitioning, lod } = self.method;
        let (lod, _, number) = lod.declared();
        let mut own = Tessellation { surface, normals, partitioning, lod, ..settings.tessellation };
        *number(&mut own) = self.value;
        settings.with(own)
    }

    /// Whether this is a finer setting of the same method.
    pub fn is_finer(&self, than: &Self) -> bool {
        let [more, less] = if self.method.lod.is_in_px() { [than, self] } else { [self, than] };
        more.value > less.value && self.method == than.method
    }

    /// The number that says how fine it is, as short text.
    pub fn label(&self) -> String {
        if self.method.lod.is_in_px() { format!("{} px", self.value) } else { self.value.to_string() }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.method.lod {
            LodKind::Uniform => "factor",
            LodKind::Paper => "paper",
            LodKind::Error => "error",
            LodKind::ErrorRows => "error, rows",
        };
        write!(f, "{what} {}", self.label())
    }
}

with_defaults! {
    /// All methods and settings that a chart tries.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Plan {
        pub surfaces: Vec<Surface> =
            Surface::ALL.into_iter().filter(|surface| surface.is_flat() || surface.is_averaged()).collect(),
        pub normals: Vec<Normals> = vec![Normals::Linear],
        /// Each is tried with every LOD. If empty, each LOD has the partitioning that it is commonly used with.
        pub partitionings: Vec<Partitioning> = Vec::new(),
        pub lods: Vec<LodKind> = LodKind::ALL.to_vec(),
        /// The factors of uniform LOD.
        pub factors: Vec<f32> = vec![1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 48.0, 64.0],
        /// The px per segment of the white paper's LOD.
        pub pixels: Vec<f32> = vec![32.0, 16.0, 8.0, 4.0, 2.0, 1.0],
        /// The tolerances of LOD by error, in px.
        pub tolerances: Vec<f32> = vec![8.0, 4.0, 2.0, 1.0, 0.5, 0.25, 0.125],
    }
}

/// Reorders settings: the coarsest of every method first, then the next finer ones, so that all lines of a chart grow together.
pub fn coarse_first(settings: Vec<Setting>) -> Vec<Setting> {
    let place =
        |index: usize| settings[..index].iter().filter(|earlier| earlier.method == settings[index].method).count();
    let mut placed: Vec<_> = (0..settings.len()).map(|index| (place(index), settings[index])).collect();
    placed.sort_by_key(|(place, _)| *place);
    placed.into_iter().map(|(_, setting)| setting).collect()
}

impl Plan {
    /// All settings, method by method, each from coarse to fine as listed. Subtriangulation is only tried with uniform LOD.
    pub fn settings(&self) -> Vec<Setting> {
        let settings = |method: Method| {
            let values = match method.lod {
                LodKind::Uniform => &self.factors,
                LodKind::Paper => &self.pixels,
                LodKind::Error | LodKind::ErrorRows => &self.tolerances,
            };
            values.iter().map(move |&value| Setting { method, value })
        };
        // A setting that was named twice is tried once.
        distinct(self.methods().into_iter().flat_map(settings))
    }

    fn methods(&self) -> Vec<Method> {
        let mut all = Vec::new();
        for (&surface, &normals) in self.surfaces.iter().flat_map(|a| self.normals.iter().map(move |b| (a, b))) {
            for &lod in &self.lods {
                let common = [lod.declared().1];
                let has_common = self.partitionings.is_empty() || lod == LodKind::ErrorRows;
                let listed = if has_common { &common[..] } else { &self.partitionings };
                let possible = |partitioning: &&Partitioning| lod == LodKind::Uniform || !partitioning.has_one_factor();
                let method = |&partitioning: &Partitioning| {
                    let under_rows = lod == LodKind::Error && partitioning.has_rows();
                    let lod = if under_rows { LodKind::ErrorRows } else { lod };
                    Method { surface, normals, partitioning, lod }
                };
                all.extend(listed.iter().filter(possible).map(method));
            }
        }
        all
    }
}
