//! The part of the patch's section that says why the patch has its factors: what was asked for, how far its triangles are from
//! the surface, and how many it needs by itself.

use egui::Ui;

use super::patch_panel::SelectedPatch;
use crate::app::patch_names::ends_text;
use crate::app::text::factor;
use crate::app::widgets::{dense, title};
use geometry::tessellate::{DecidedBy, EdgeFormula, ExplainedEdge, domain_side, inside_cut, is_enough, triangle_count};

impl SelectedPatch<'_> {
    pub(super) fn explanation_rows(&self, ui: &mut Ui) {
        if !self.by_error() {
            title(ui, WHY, "What LOD computes the factor of each edge from.");
            (0..3).for_each(|i| self.formula_row(ui, domain_side(self.convention, i) as usize));
        }
        let (name, hover) = if self.by_error() {
            (WHY, "What LOD by error was asked for, and how far the triangles are from the surface.")
        } else {
            ("Against LOD by error", "How the patch's triangles compare with the tolerance of LOD by error.")
        };
        title(ui, name, hover);
        self.error_header(ui);
        // In the order of the factors above.
        for i in 0..3 {
            self.error_row(ui, domain_side(self.convention, i) as usize);
        }
        self.inside_row(ui);
        self.tolerance_row(ui);
        self.least_rows(ui);
    }

    /// Whether its factors are those of LOD by error.
    fn by_error(&self) -> bool {
        self.lod().is_by_error() && self.given_by.is_none()
    }

    /// An edge's factor as LOD computes it.
    fn formula_row(&self, ui: &mut Ui, k: usize) {
        let formula = self.explained.and_then(|explained| explained.formulas).map(|formulas| formulas[k]);
        let (text, hover) = match (self.given_by, formula) {
            (Some(given_by), _) => (given_by.to_owned(), "The LOD that is chosen has no part in it.".to_owned()),
            (None, None) => (UNKNOWN.to_owned(), String::new()),
            (None, Some(formula)) => formula_text(formula),
        };
        ui.label(dense(format!("{:<4}{text}", ends_text(k as u32)))).on_hover_text(hover);
    }

    fn error_header(&self, ui: &mut Ui) {
        let error = "Error: an upper bound, in px on screen, of how far the triangles in the row along the edge, or along no edge, are \
                     from the surface.";
        let (text, hover) = if self.by_error() {
            let asked = "This asks: the factor that this patch asks the edge for. Others ask: the largest that a patch across the edge \
                         asks for. Gets: the largest of both. From: whose request that was; \u{201c}curve\u{201d} if nobody asked \
                         for more than the edge's curve needs by itself.";
            (
                HEADINGS.map(|[edge, own, others, got, from, px]| row(edge, own, others, got, from, px)),
                format!("{asked} {error}"),
            )
        } else {
            (HEADINGS.map(|[edge, .., px]| row(edge, "", "", "", "", px)), error.to_owned())
        };
        ui.label(dense(text.join("\n")).weak()).on_hover_text(hover);
    }

    fn error_row(&self, ui: &mut Ui, k: usize) {
        let name = ends_text(k as u32);
        let px = self.explained.and_then(|explained| explained.errors?.rows).map(|rows| rows[k]);
        let seen = match (self.explained, px) {
            (None, _) => UNKNOWN.to_owned(),
            (Some(_), px) => px.map_or_else(|| "-".to_owned(), px_text),
        };
        let edge = self.explained.and_then(|explained| explained.edges.as_ref()).map(|edges| &edges[k]);
        let (text, hover) = match edge {
            Some(edge) => {
                let others = edge.other().map_or_else(|| "-".to_owned(), factor_text);
                let asked = [factor_text(edge.own), others, factor_text(edge.got)];
                (row(&name, &asked[0], &asked[1], &asked[2], by_text(edge), &seen), self.requests(&name, edge))
            }
            None => {
                let asked = if self.by_error() { UNKNOWN } else { "" };
                (row(&name, asked, asked, asked, asked, &seen), format!("The row of triangles along edge {name}."))
            }
        };
        self.error_label(ui, &text, px).on_hover_text(hover);
    }

    /// Who asked for what, in sentences.
    fn requests(&self, name: &str, edge: &ExplainedEdge) -> String {
        let mut lines = vec![
            format!("The curve of edge {name} needs a factor of {} at least.", factor_text(edge.least)),
            format!("This patch asks for {}.", factor_text(edge.own)),
        ];
        lines.extend(edge.others.iter().take(LISTED).map(|&(patch, factor)| {
            let triangle = self.topology.patches[patch as usize].triangle;
            format!("Triangle {triangle} asks for {}.", factor_text(factor))
        }));
        if edge.others.len() > LISTED {
            lines.push(format!("{} more triangles ask, too.", edge.others.len() - LISTED));
        }
        match edge.decided_by() {
            DecidedBy::Again => lines.push(
                "The edge got more than that: a triangle asked again, or one factor for all edges takes fewer triangles."
                    .to_owned(),
            ),
            DecidedBy::All => lines
                .push("The edge got less than that, since one factor for all edges takes fewer triangles.".to_owned()),
            _ => {}
        }
        lines.join("\n")
    }

    fn inside_row(&self, ui: &mut Ui) {
        let errors = self.explained.and_then(|explained| explained.errors);
        let (name, hover) = match errors {
            Some(_) if self.explained.is_some_and(|explained| explained.is_flat) => (
                "flat",
                "The number of segments inside, and the triangles along no edge. The patch is flat, and nothing on it depends on \
                 where its points are within its plane. So all px of it are distances to the nearest point of the surface.",
            ),
            Some(errors) if errors.rows.is_none() => {
                ("whole", "All triangles of the patch: its pattern has no part that belongs to one edge.")
            }
            _ => (
                "inside",
                "The number of segments inside, and the triangles along no edge. LOD by error takes the least inside factor \
                 that suffices beside the factors of the edges.",
            ),
        };
        let cut = match self.factors.filter(|_| errors.is_some()) {
            None => UNKNOWN.to_owned(),
            Some(factors) => inside_cut(factors).to_string(),
        };
        let px = errors.map(|errors| errors.inside);
        let seen = px.map_or_else(|| UNKNOWN.to_owned(), px_text);
        self.error_label(ui, &format!("{name:<16}{cut:>5} {:<6}{seen:>6}", ""), px).on_hover_text(hover);
    }

    fn tolerance_row(&self, ui: &mut Ui) {
        let tolerance = self.explained.map_or_else(|| UNKNOWN.to_owned(), |explained| px_text(explained.tolerance));
        let mut hover = "The largest distance to the surface that LOD by error allows, in px.".to_owned();
        if !self.by_error() {
            hover += " The LOD that is used doesn't keep it.";
        }
        ui.label(dense(format!("{:<28}{tolerance:>6}", "tolerance"))).on_hover_text(hover);
    }

    fn least_rows(&self, ui: &mut Ui) {
        let Some((explained, factors)) = self.explained.zip(self.factors) else {
            ui.label(dense(format!("{:<12}{UNKNOWN:>6}", "minimum")));
            ui.label(dense(format!("{:<12}{UNKNOWN:>6}", "drawn")));
            return;
        };
        let least = explained.minimum;
        let [a, b, c] = least.sides.map(factor_text);
        let mut hover = format!(
            "The fewest triangles with which this patch alone would keep the tolerance, if it chose all its factors itself: {a}, \
             {b} and {c} on edges 0-1, 1-2 and 2-0, and {} inside.",
            factor_text(least.inside)
        );
        if !is_enough(least.inside) {
            hover += " The most segments that there are aren't enough for it, and these are as many.";
        }
        ui.label(dense(format!("{:<12}{:>6} triangles", "minimum", least.triangles))).on_hover_text(hover);
        let has = triangle_count(factors);
        let times = f64::from(has) / f64::from(least.triangles.max(1));
        let hover = "The triangles that are drawn, and how many times the minimum that is. The overlay of excess \
                     triangles shows this number for all patches.";
        ui.label(dense(format!("{:<12}{has:>6} triangles{times:>5.2}x", "drawn"))).on_hover_text(hover);
    }

    /// A row, in the colour of warnings if its triangles are beyond the tolerance.
    fn error_label(&self, ui: &mut Ui, text: &str, px: Option<f32>) -> egui::Response {
        let is_beyond = self.explained.is_some_and(|explained| px.is_some_and(|px| px > explained.tolerance));
        let color = ui.visuals().warn_fg_color;
        ui.label(if is_beyond { dense(text).color(color) } else { dense(text) })
    }
}

const WHY: &str = "Why these factors";

/// An LOD's formula with its numbers, and in a sentence.
fn formula_text((formula, detail): (EdgeFormula, f32)) -> (String, String) {
    let (times, why) = match detail {
        1.0 => (String::new(), ""),
        detail => (
            format!(" x {}", factor(detail.into(), 2)),
            " The finest detail of the parts beside the edge multiplies it.",
        ),
    };
    match formula {
        EdgeFormula::Uniform { factor: set } => {
            let text = if times.is_empty() {
                "the one that is set".to_owned()
            } else {
                format!("{}{times}", factor(set.into(), 2))
            };
            (text, format!("All edges have the factor that is set.{why}"))
        }
        EdgeFormula::Length { px, segment } => {
            let [length, each] = [px, segment].map(|px| factor(px.into(), 1));
            let quotient = factor(f64::from((px * detail / segment).max(1.0)), 3);
            let sign = if px * detail < segment { "->" } else { "=" };
            let hover = format!(
                "The edge's control polygon is {length} px long on screen, and a segment {each} px. A factor is 1 to 64.{why}"
            );
            (format!("{length} px{times} / {each} px {sign} {quotient}"), hover)
        }
        EdgeFormula::Distance { radii, factors } => {
            let [a, b] = factors.map(|own| factor(own.into(), 2));
            let [near, far] = radii.map(|own| factor(own.into(), 2));
            let mean = factor(f64::from(factors[0] + factors[1]) / 2.0, 3);
            let hover = format!(
                "The ends are {near} and {far} bounding radii from the eye: factors {a} and {b}. The edge gets the mean.{why}"
            );
            (format!("({a} + {b}) / 2 = {mean}"), hover)
        }
    }
}

/// In place of a number that isn't known yet.
const UNKNOWN: &str = "…";

/// How many patches across an edge are listed.
const LISTED: usize = 8;

/// The headings of the columns, on two lines.
const HEADINGS: [[&str; 6]; 2] =
    [["", "this", "others", "", "", "error"], ["edge", "asks", "ask", "gets", "from", "px"]];

/// The columns of a row: the edge, what this patch and others ask for, what the edge gets from whom, and px.
fn row(edge: &str, own: &str, others: &str, got: &str, from: &str, px: &str) -> String {
    format!("{edge:<4}{own:>5}{others:>7}{got:>5} {from:<6}{px:>6}")
}

fn by_text(edge: &ExplainedEdge) -> &'static str {
    match edge.decided_by() {
        DecidedBy::Curve => "curve",
        DecidedBy::Own => "this",
        DecidedBy::Other => "others",
        DecidedBy::Both => "both",
        DecidedBy::Again => "again",
        DecidedBy::All => "all",
    }
}

/// A factor that LOD by error asks for: a whole number, or more than there are.
fn factor_text(factor: f32) -> String {
    if is_enough(factor) { format!("{factor:.0}") } else { ">max".to_owned() }
}

fn px_text(px: f32) -> String {
    match px {
        px if !px.is_finite() => "∞".to_owned(),
        px if px < 10.0 => format!("{px:.3}"),
        px if px < 1000.0 => format!("{px:.1}"),
        px => format!("{px:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_fit_their_columns() {
        assert_eq!([0.0, 0.4871, 12.34, 4321.0, f32::INFINITY].map(px_text), ["0.000", "0.487", "12.3", "4e3", "∞"]);
        assert_eq!([1.0, 64.0, 127.5].map(factor_text), ["1", "64", ">max"]);
        let headings = HEADINGS.map(|[edge, own, others, got, from, px]| row(edge, own, others, got, from, px));
        let rows = [&headings[..], &[row("0-1", ">max", ">max", ">max", "others", "0.487")]].concat();
        assert!(rows.iter().all(|row| row.chars().count() == 34), "{rows:?}");
    }
}
