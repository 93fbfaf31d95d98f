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
mod settings_panel;
mod statistics;
mod status_line;

use crate::tessellate::Displacement;

use chart::Chart;

/// What the panels remember from one frame to the next.
pub(super) struct Panels {
    pub chart: Chart,
    /// The width of the crease band while it is being dragged, as a part of the bounding diagonal.
    pub dragged_crease_band: Option<f32>,
    /// The displacement before it was last switched.
    pub last_displacement: Displacement,
}

impl Default for Panels {
    fn default() -> Self {
        Self { chart: Chart::default(), dragged_crease_band: None, last_displacement: Displacement::Off }
    }
}
