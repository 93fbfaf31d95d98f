//! The sections of the panels, which fold.

use egui::collapsing_header::paint_default_icon;
use egui::{Rect, Sense, pos2, vec2};

/// Declares the sections of the left and of the right panel: each with its title, and whether it is open at the first
/// start, as what people set and read every day is.
macro_rules! sections {
    ($($section:ident => $title:literal, $opens:literal;)+) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(in crate::app) enum Section {
            $($section),+
        }

        impl Section {
            pub(in crate::app) const ALL: [Self; [$($title),+].len()] = [$(Self::$section),+];
            const OPEN_AT_FIRST: [bool; Self::ALL.len()] = [$($opens),+];

            /// Its title in the window, by which it is saved too.
            pub(in crate::app) fn title(self) -> &'static str {
                match self {
                    $(Self::$section => $title,)+
                }
            }
        }
    };
}

sections! {
    Surface => "Surface", true;
    LevelOfDetail => "Level of detail", true;
    Displacement => "Displacement", false;
    Parts => "Parts", true;
    MorphTargets => "Morph targets", true;
    Look => "Look", false;
    Import => "Import", false;
    Advanced => "Advanced", false;
    Patch => "Patch", true;
    Halves => "Left and right", true;
    Factors => "Factors of a file", true;
    LodShader => "Factors of a shader", true;
    Deviation => "Deviation", true;
    Cracks => "Cracks", false;
    Patches => "Patches", false;
    Waste => "Waste", false;
    Edges => "Edges", false;
    Mesh => "Mesh", false;
    Passes => "Passes", false;
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) struct OpenSections([bool; Section::ALL.len()]);

impl Default for OpenSections {
    fn default() -> Self {
        Self(Section::OPEN_AT_FIRST)
    }
}

impl OpenSections {
    pub(in crate::app) fn has(&self, section: Section) -> bool {
        self.0[section as usize]
    }

    pub(in crate::app) fn set(&mut self, section: Section, is_open: bool) {
        self.0[section as usize] = is_open;
    }

    /// Opens all sections, or closes them.
    pub(in crate::app) fn set_all(&mut self, is_open: bool) {
        self.0 = [is_open; Section::ALL.len()];
    }

    /// Shows the title of a section. A click folds the section or opens it. Returns whether it is open.
    pub(in crate::app) fn title(&mut self, ui: &mut egui::Ui, section: Section) -> bool {
        let is_open = &mut self.0[section as usize];
        if title_row(ui, section.title(), *is_open).clicked() {
            *is_open = !*is_open;
        }
        *is_open
    }
}

/// A row as wide as the panel: a triangle that points down if the section is open, and the title.
fn title_row(ui: &mut egui::Ui, title: &str, is_open: bool) -> egui::Response {
    ui.add_space(6.0);
    let size = vec2(ui.available_width(), ui.spacing().interact_size.y + 2.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::DisclosureTriangle, true, is_open, title));
    let visuals = ui.visuals();
    let (text, line) = (visuals.strong_text_color(), visuals.widgets.noninteractive.bg_stroke);
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, 3.0, visuals.widgets.hovered.weak_bg_fill.gamma_multiply(0.6));
    }
    if response.has_focus() {
        ui.painter().rect_stroke(rect, 3.0, visuals.selection.stroke, egui::StrokeKind::Inside);
    }
    let icon = Rect::from_center_size(pos2(rect.left() + 6.0, rect.center().y), vec2(10.0, 10.0));
    paint_default_icon(ui, if is_open { 1.0 } else { 0.0 }, &response.clone().with_new_rect(icon));
    let font = egui::TextStyle::Body.resolve(ui.style());
    let title = ui.painter().layout_no_wrap(title.to_owned(), font, text);
    let place = pos2(rect.left() + 18.0, rect.center().y - title.size().y / 2.0);
    ui.painter().galley(place, title, text);
    ui.painter().hline(rect.x_range(), rect.bottom() + 1.0, line);
    ui.add_space(2.0);
    response
}

/// Shows the contents of a panel, which scroll. They have the width that a scroll bar leaves, also where there is none, and never
/// take more: whatever is wider is cut off. So neither a section that opens nor a number that grows can move anything sideways. In a
/// panel that is too narrow for their least width, in points, they scroll sideways too.
pub(in crate::app) fn scrolling_column(ui: &mut egui::Ui, least: f32, show: impl FnOnce(&mut egui::Ui)) {
    let width = ui.available_width() - ui.spacing().scroll.allocated_width();
    egui::ScrollArea::new([width < least, true]).auto_shrink(false).show(ui, |ui| {
        let room = ui.available_rect_before_wrap();
        let room = room.with_max_x(room.left() + width.max(least));
        let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(room));
        let clip = ui.clip_rect();
        inside.set_clip_rect(clip.intersect(Rect::from_x_y_ranges(room.x_range().expand(2.0), clip.y_range())));
        show(&mut inside);
        let used = Rect::from_min_size(room.min, vec2(room.width(), inside.min_rect().height()));
        ui.allocate_rect(used, Sense::hover());
    });
}
