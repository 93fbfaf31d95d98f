//! The panels around the viewport: settings on the left, statistics and details on the right, the chart and the status line
//! below.

pub(super) mod chart;
mod chart_diagram;
mod chart_panel;
mod crack_list;
mod crease_band;
mod deviation;
pub(super) mod displacement;
mod option_rows;
mod patch_explanation;
mod patch_panel;
mod patch_pattern;
pub(super) mod sections;
pub(super) mod settings_panel;
mod statistics;
mod status_line;
mod verdict;

use crate::tessellate::Displacement;

use chart::Chart;
use sections::OpenSections;

/// What the panels remember from one frame to the next.
pub(super) struct Panels {
    pub chart: Chart,
    pub open: OpenSections,
    /// Whether the panels on both sides are hidden, so that the picture has their room.
    pub are_hidden: bool,
    /// The width of the crease band while it is being dragged, as a part of the bounding diagonal.
    pub dragged_crease_band: Option<f32>,
    /// The displacement before it was last switched.
    pub last_displacement: Displacement,
}

impl Default for Panels {
    fn default() -> Self {
        Self {
            chart: Chart::default(),
            open: OpenSections::default(),
            are_hidden: false,
            dragged_crease_band: None,
            last_displacement: Displacement::Off,
        }
    }
}
