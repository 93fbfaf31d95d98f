//! Where the factors of a file or a shader disagree: the edges whose sides have different factors, and for a file the convention that
//! would fit.

use egui::RichText;

use crate::app::App;
use crate::app::sections::Section;
use crate::app::text::{counted, grouped, short};
use crate::app::widgets::{FoundRow, columns, fact, found_list};
use inspect::measure::Agreement;
use inspect::settings::Choice;

impl App {
    /// The section about factors of a file or of an LOD shader, if those that are shown come from one.
    pub(in crate::app) fn given_section(&mut self, ui: &mut egui::Ui) {
        let section = if self.uses_lod_shader() { Section::LodShader } else { Section::Factors };
        if (self.given.is_none() && section == Section::Factors) || !self.panels.open.title(ui, section) {
            return;
        }
        match self.agreement() {
            Some(agreement) => agreement_rows(ui, agreement),
            None => return drop(ui.weak("The factors are being compared\u{2026}")),
        }
        self.convention_advice(ui);
        if let Some(said) = self.not_numbers_said() {
            ui.add(egui::Label::new(RichText::new(said).color(ui.visuals().warn_fg_color)).wrap());
        }
        self.disagreements(ui);
    }

    /// How the sides of edges agree whose factors come from a file or a shader, once they are compared.
    pub(super) fn agreement(&self) -> Option<&Agreement> {
        match self.uses_lod_shader() {
            true => self.results()?.agreement.as_ref(),
            false => Some(&self.given.as_ref()?.content.compared.as_ref()?.1),
        }
    }

    /// Says which convention fits a file, if edges differ under the one that is set, and offers it.
    fn convention_advice(&mut self, ui: &mut egui::Ui) {
        let Some(agreement) = self.agreement().filter(|_| self.given.is_some()) else { return };
        let Some((nearest, different)) = agreement.nearest() else { return };
        let own = agreement.edges.len() as u64;
        if different >= own {
            let text = "No other convention makes more sides agree.";
            return if own > 0 {
                drop(ui.add(egui::Label::new(text).wrap()))
            };
        }
        let differ = match different {
            0 => "all sides agree".to_owned(),
            _ => format!("{} differ", counted(different, "edge")),
        };
        ui.add(egui::Label::new(format!("Under the convention {}, {differ}.", nearest.label())).wrap());
        let button = ui.button(format!("Use {}", nearest.label()));
        if button.on_hover_text("Sets this convention, under Advanced.").clicked() {
            self.settings.tessellation.convention = nearest;
        }
    }

    /// The list of edges whose sides have different factors, the largest difference first. A click frames one.
    fn disagreements(&mut self, ui: &mut egui::Ui) {
        let Some(Agreement { edges, .. }) = self.agreement() else { return };
        if edges.is_empty() {
            return;
        }
        columns(ui, &format!("{:<9}{:>9}{:>9}", "edge", "least", "greatest"), true)
            .on_hover_text("The least and the greatest factor of a side of the edge.");
        let first = edges.first().map_or(0, |edge| edge.edge);
        let clicked = found_list(ui, "different factors", edges, first, |own| {
            let sides = own.sides.iter().map(|(triangle, factor)| format!("Triangle {triangle} has {factor}."));
            let [least, greatest] = own.extremes().map(|(_, factor)| short(factor.into()));
            FoundRow {
                columns: format!("{:<9}{least:>9}{greatest:>9}", own.edge),
                is_selected: self.selected_edge() == Some(own.edge),
                hover: sides.chain(["A click frames the edge.".to_owned()]).collect::<Vec<_>>().join("\n"),
            }
        });
        if let Some(edge) = clicked.map(|own| own.edge) {
            self.select_edge(edge);
        }
    }
}

/// How many edges agree.
fn agreement_rows(ui: &mut egui::Ui, agreement: &Agreement) {
    egui::Grid::new("given factors").num_columns(2).min_col_width(104.0).show(ui, |ui| {
        let hover = "Edges with several sides whose patches emit something.";
        fact(ui, "Edges compared", &grouped(agreement.edges_compared), hover);
        let hover = "Edges whose sides have different factors under the convention that is set.";
        fact(ui, "Different", &grouped(agreement.edges.len() as u64), hover);
        let hover = "Patches that emit nothing because one of their factors is not greater than 0.";
        fact(ui, "Patches left out", &grouped(agreement.patches_culled), hover);
    });
}
