//! The gallery's page.

use std::fmt::Write;

use super::{Exhibit, Shown, Tile};
use crate::markdown;
use crate::numbers::{grouped, hundredths, short};

/// The page's file.
pub(crate) const PAGE: &str = "gallery.md";

/// What the columns and colours mean.
const LEGEND: &str = "Red edges: their sides are half a px apart or more, in this view. Blue ones: less, if only by the last \
     bit of a coordinate.\n\n\
     Error: the largest distance in px between what is drawn and the surface that it stands for; none where patches agree \
     on heights, since that surface is then no longer each patch's own. Points and normals: of edges, where \
     their sides differ in at least one bit. Gaps are in px and in object units. ms: the median of several runs, of all \
     passes that tessellate and of the draw without marks, which leaves out the backs of closed surfaces that nothing tears. Factors are lower than asked for where a tile would have more \
     than about 2,000,000 triangles.\n";

const COLUMNS: [&str; 11] = [
    "",
    "factor",
    "triangles",
    "error, px",
    "points that differ",
    "widest gap, px",
    "widest gap, units",
    "normals that differ",
    "folds",
    "ms to tessellate",
    "ms to draw",
];

/// Every exhibit with its picture, and a line for each of its tiles. `subject` is the mesh, if one was named; `adapter` is
/// what drew.
pub(crate) fn page(subject: Option<&str>, adapter: &str, shown: &[(Exhibit, Vec<Shown>)]) -> String {
    let on = subject.map_or("shapes made in code".to_owned(), ToOwned::to_owned);
    let mut text = format!(
        "# Every technique, side by side\n\nWritten by `pnaen gallery -o DIR`: {on}, drawn and timed on {adapter}.\n\n{LEGEND}"
    );
    for (exhibit, tiles) in shown {
        let Exhibit { name, title, about, .. } = exhibit;
        let _ = write!(text, "\n## {title}\n\n{about}\n\n![{title}]({name}.png)\n\n");
        for tile in &exhibit.tiles {
            let _ = writeln!(text, "- `{}`: {}", tile.name, tile.about);
        }
        text.push('\n');
        text += &table(&exhibit.tiles, tiles);
    }
    text
}

/// What each tile showed.
fn table(tiles: &[Tile], shown: &[Shown]) -> String {
    let row = |(tile, shown): (&Tile, &Shown)| {
        vec![
            format!("`{}`", tile.name),
            shown.factor.to_string(),
            grouped(shown.triangles),
            shown.error_px.map_or("-".to_owned(), hundredths),
            grouped(shown.different_bits),
            hundredths(shown.max_gap_px),
            short(shown.max_gap),
            grouped(shown.different_normals),
            grouped(shown.folds),
            hundredths(shown.tessellation_ms),
            hundredths(shown.draw_ms),
        ]
    };
    markdown::table(&COLUMNS, &[0], &tiles.iter().zip(shown).map(row).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::super::exhibits;
    use super::*;

    #[test]
    fn numbers_read_as_they_do_elsewhere() {
        let [exhibit, ..] = exhibits();
        let shown = Shown {
            factor: 5.5,
            triangles: 12345,
            error_px: None,
            different_bits: 1234,
            max_gap_px: 0.001,
            max_gap: 1.25e-7,
            different_normals: 0,
            folds: 1000,
            tessellation_ms: 12.345,
            draw_ms: 0.0,
        };
        let page = page(Some("a.glb"), "a card", &[(exhibit, vec![shown; 8])]);
        let row = "| 5.5 | 12,345 | - | 1,234 | < 0.01 | 1.25e-7 | 0 | 1,000 | 12.35 | 0 |\n";
        assert_eq!(page.matches(row).count(), 8, "{page}");
        assert!(
            page.contains("a.glb, drawn and timed on a card.") && page.contains(&format!("| `pn-aen` {row}")),
            "{page}"
        );
        assert!(page.contains("- `pn`: PN triangles (Vlachos et al. 2001)"), "{page}");
    }
}
