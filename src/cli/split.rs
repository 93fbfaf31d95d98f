//! `--split`: what is left of it, and what is said of that.

use clap::Args;
use serde::Serialize;

use super::options;
use super::stats::CrackStats;
use super::truth::{AccuracyStats, DeviationStats};
use crate::measure::Measured;
use crate::render::Scene;
use crate::settings::{Settings, option_name};
use crate::tessellate::Surface;
use crate::view::ScreenView;

#[derive(Clone, Copy, Debug, Default, Args)]
pub struct SplitOption {
    /// Left of this fraction of the width, show the mesh untessellated, or another surface
    #[arg(long, value_name = "FRACTION", value_parser = options::fraction)]
    pub split: Option<f32>,
    /// Left of the split, show this surface, all other options the same; deviation has one scale for both
    #[arg(long, value_name = "SURFACE", value_enum, requires = "split")]
    pub split_surface: Option<Surface>,
}

/// Another surface left of the split.
#[derive(Debug, Serialize)]
pub struct LeftStats {
    surface: String,
    triangles_out: u64,
    vertices_out: u64,
    cracks: CrackStats,
    folds: u64,
    pub max_error_px: Option<f64>,
    pub accuracy: Option<AccuracyStats>,
    pub deviation: Option<DeviationStats>,
}

impl LeftStats {
    /// Tessellated with these settings, and seen from `view`.
    pub fn new(scene: &Scene, measured: &Measured, settings: &Settings, view: ScreenView) -> Self {
        let (vertices_out, triangles_out) = scene.tessellator.totals();
        Self {
            surface: option_name(settings.surface),
            triangles_out,
            vertices_out,
            cracks: CrackStats::new(measured, scene.tessellator.topology(), view),
            folds: measured.folds,
            max_error_px: None,
            accuracy: None,
            deviation: None,
        }
    }
}
