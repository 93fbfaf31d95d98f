//! The panels around the viewport: settings on the left, statistics and details on the right, the chart and the status line
//! below.

mod chart;
mod chart_diagram;
mod chart_panel;
pub(super) mod clip_moments;
mod crack_list;
pub(super) mod destinations;
mod deviation;
pub(super) mod displacement;
mod factors_list;
mod found_lists;
mod halves;
mod import;
mod look_rows;
mod morphs;
mod option_rows;
mod parts;
mod patch_explanation;
mod patch_panel;
mod patch_pattern;
mod settings_panel;
mod sides;
mod statistics;
mod status_line;
mod timeline;
mod toolbar;
mod user_shaders;
mod verdict;

use std::collections::HashSet;

use geometry::tessellate::Displacement;
use inspect::settings::SplitSide;
use load::{MorphWeights, NamedImage};

use crate::app::jobs::chart_job::Chart;
use crate::app::sections::OpenSections;
use sides::Side;

/// What the panels remember from one frame to the next.
#[derive(Default)]
pub(super) struct Panels {
    pub chart: Chart,
    pub open: OpenSections,
    /// Whether the panels on both sides are hidden, so that the picture has their room.
    pub are_hidden: bool,
    /// The panel that is shown where both share a side.
    pub side: Side,
    /// The half of a split view whose settings are edited.
    pub edited: SplitSide,
    /// What the paths of listed parts contain.
    pub parts_filter: String,
    /// What the names of listed morph targets contain.
    pub morphs_filter: String,
    /// Weights of morph targets that are dragged while the mesh is still being loaded with those before.
    pub dragged_morphs: Option<MorphWeights>,
    /// The material or part that a height image is asked for.
    pub displaced_part: String,
    /// Height images whose numbers are dragged while the mesh is still being loaded with those before.
    pub dragged_heights: Option<Vec<NamedImage>>,
    /// The paths of groups in the list of parts that are folded.
    pub folded_groups: HashSet<String>,
    /// The width of the crease band while it is being dragged, as a part of the bounding diagonal.
    pub dragged_crease_band: Option<f32>,
    /// How high the section of the selected patch is, in points.
    pub patch_height: f32,
    /// The displacement before it was last switched.
    pub last_displacement: Displacement,
}
