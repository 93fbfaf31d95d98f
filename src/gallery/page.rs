//! The gallery's page.

use std::fmt::Write;

use super::{Exhibit, Shown};

/// The page's file.
pub const PAGE: &str = "gallery.md";

/// Every exhibit with its picture, and a line for each of its tiles. `subject` is the mesh, if one was named; `adapter` is
/// what drew.
pub fn page(subject: Option<&str>, adapter: &str, shown: &[(Exhibit, Vec<Shown>)]) -> String {
    let on = subject.map_or("shapes made in code".to_owned(), ToOwned::to_owned);
    let mut text =
        format!("# Every technique, side by side\n\nWritten by `pnaen gallery -o DIR`: {on}, drawn by {adapter}.\n");
    for (exhibit, tiles) in shown {
        let _ = write!(
            text,
            "\n## {}\n\n{}\n\n![{}]({}.png)\n\n",
            exhibit.title, exhibit.about, exhibit.title, exhibit.name
        );
        text += "| | what it is | triangles | points that differ | widest gap | normals that differ | folds |\n";
        text += "| --- | --- | ---: | ---: | ---: | ---: | ---: |\n";
        for (tile, shown) in exhibit.tiles.iter().zip(tiles) {
            let gap = if shown.max_gap == 0.0 { "0".to_owned() } else { format!("{:.1e}", shown.max_gap) };
            let Shown { triangles, different_bits, different_normals, folds, .. } = shown;
            let _ = writeln!(
                text,
                "| `{}` | {} | {triangles} | {different_bits} | {gap} | {different_normals} | {folds} |",
                tile.name, tile.about
            );
        }
    }
    text + "\nPoints and normals: of edges, where their sides differ in at least one bit. Gaps are in object units.\n"
}
