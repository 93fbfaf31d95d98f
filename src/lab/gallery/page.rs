//! The gallery's page.

use std::fmt::Write;

use super::{Exhibit, Tile, TileResults};
use geometry::numbers::{grouped, hundredths, short};
use load::markdown;

/// The page's file.
pub const PAGE: &str = "gallery.md";

/// What the columns and colours mean.
const LEGEND: &str = "Edges are red where the gap between their sides is at least half a px wide in this view, and blue where \
     it is narrower, down to the last bit of a coordinate.\n\n\
     Error is the largest distance in px between what is drawn and the surface that it approximates. There is none where \
     patches agree on heights, since they then leave the surface that each patch has by itself. Points and normals are those \
     of edges whose sides differ in at least one bit. Gaps are in px and in object units. Times are medians of several runs in \
     ms: of all passes that tessellate, and of drawing without marks. Drawing leaves out the backs of closed surfaces that \
     don't tear. Factors are lower than asked for where a tile would have more than about 2,000,000 triangles.\n";

/// A column's name, and its text of a tile.
type Column = (&'static str, fn(&TileResults) -> String);

/// The columns after a tile's name.
const COLUMNS: [Column; 10] = [
    ("factor", |shown| shown.factor.to_string()),
    ("triangles", |shown| grouped(shown.triangles)),
    ("error, px", |shown| shown.error_px.map_or("-".to_owned(), hundredths)),
    ("points that differ", |shown| grouped(shown.different_bits)),
    ("widest gap, px", |shown| hundredths(shown.max_gap_px)),
    ("widest gap, units", |shown| short(shown.max_gap)),
    ("normals that differ", |shown| grouped(shown.different_normals)),
    ("folds", |shown| grouped(shown.folds)),
    ("ms to tessellate", |shown| hundredths(shown.tessellation_ms)),
    ("ms to draw", |shown| hundredths(shown.draw_ms)),
];

/// Returns the page in Markdown: every exhibit with its picture, and a line for each of its tiles. `subject` is the mesh, if
/// the user named one, and `adapter` the name of the device.
pub fn page(subject: Option<&str>, adapter: &str, shown: &[(Exhibit, Vec<TileResults>)]) -> String {
    let on = subject.map_or("shapes made in code".to_owned(), ToOwned::to_owned);
    let mut text = format!(
        "# Every technique, side by side\n\nWritten by `pnaen gallery -o DIR`: {on}, drawn and timed on {adapter}.\n\n{LEGEND}"
    );
    for (exhibit, tiles) in shown {
        let Exhibit { name, title, about, .. } = exhibit;
        let _ = write!(text, "\n## {title}\n\n{about}\n\n![{title}]({name}.png)\n\n");
        text.extend(exhibit.tiles.iter().map(|tile| format!("- `{}`: {}\n", tile.name, tile.about)));
        text.push('\n');
        text += &table(&exhibit.tiles, tiles);
    }
    text
}

/// Returns a table with the results of each tile.
fn table(tiles: &[Tile], shown: &[TileResults]) -> String {
    let row = |(tile, shown): (&Tile, &TileResults)| {
        let numbers = COLUMNS.map(|(_, text)| text(shown));
        [format!("`{}`", tile.name)].into_iter().chain(numbers).collect()
    };
    let columns: Vec<&str> = [""].into_iter().chain(COLUMNS.map(|(name, _)| name)).collect();
    markdown::table(&columns, &[0], &tiles.iter().zip(shown).map(row).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::super::exhibits;
    use super::*;

    #[test]
    fn a_row_has_short_numbers_and_the_page_names_mesh_and_adapter() {
        let [exhibit, ..] = exhibits();
        let shown = TileResults {
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
