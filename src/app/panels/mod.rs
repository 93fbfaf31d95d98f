//! The panels around the viewport: settings on the left, statistics and details on the right, the chart and the status line
//! below.

pub(super) mod chart;
mod chart_diagram;
mod chart_panel;
mod crack_list;
mod crease_band;
mod deviation;
pub(super) mod displacement;
mod factors_list;
mod fold_list;
mod import;
mod leak_list;
mod light_rows;
mod lod_shader;
mod matcap;
mod option_rows;
mod parts;
mod patch_explanation;
mod patch_panel;
mod patch_pattern;
mod settings_panel;
mod statistics;
mod status_line;
mod toolbar;
mod verdict;

use crate::tessellate::Displacement;

use crate::app::sections::OpenSections;
use chart::Chart;

/// The widths of the left and of the right panel, and the least that is left for the picture, in points.
pub(super) const SETTINGS_WIDTH: f32 = 280.0;
pub(super) const FACTS_WIDTH: f32 = 304.0;
const LEAST_PICTURE: f32 = 220.0;

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

impl Panels {
    /// Whether the left and the right panel are shown in a window of this width, in points. A narrow one leaves out the right
    /// panel, and a very narrow one both.
    pub(super) fn shown(&self, width: f32) -> [bool; 2] {
        let fits = |panels: f32| !self.are_hidden && width >= panels + LEAST_PICTURE;
        [fits(SETTINGS_WIDTH), fits(SETTINGS_WIDTH + FACTS_WIDTH)]
    }
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
