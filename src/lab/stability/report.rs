//! The results as text: a table for the terminal, and a page that explains each case.

use std::fmt::Write;

use super::{Quantity, Row, Subject};
use geometry::choice::texts;
use load::markdown;

/// The results of one method on one case: for each quantity, the worst number over devices and partitionings.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub case: String,
    pub method: &'static str,
    pub worst: Vec<(Quantity, f64)>,
    pub verdict: Verdict,
}

texts! {
    /// The verdict on one method and case.
    #[derive(PartialOrd, Ord)]
    pub enum Verdict, fn text {
        /// Everything measured holds.
        Holds => "holds",
        /// Something doesn't hold, but this program doesn't promise it: a published method fails there.
        Fails => "fails",
        /// Something doesn't hold that this program promises.
        BreaksPromise => "BREAKS A PROMISE",
    }
}

impl Verdict {
    fn new(row: &Row) -> Self {
        match (row.holds, row.promised) {
            (true, _) => Self::Holds,
            (false, false) => Self::Fails,
            (false, true) => Self::BreaksPromise,
        }
    }
}

/// Returns one line for each case and method, in the order of the rows.
pub fn lines(rows: &[Row]) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for row in rows {
        let known = lines.iter().position(|line| line.case == row.case && line.method == row.method);
        let index = known.unwrap_or_else(|| {
            let verdict = Verdict::Holds;
            lines.push(Line { case: row.case.clone(), method: row.method, worst: Vec::new(), verdict });
            lines.len() - 1
        });
        let line = &mut lines[index];
        line.verdict = line.verdict.max(Verdict::new(row));
        match line.worst.iter_mut().find(|(quantity, _)| *quantity == row.quantity) {
            Some((_, worst)) => *worst = worst.max(row.measured),
            None => line.worst.push((row.quantity, row.measured)),
        }
    }
    lines
}

/// The quantities that are measured on every case, with the headings of their columns.
const COLUMNS: [(Quantity, &str); 5] = [
    (Quantity::Points, "points"),
    (Quantity::Factors, "factors"),
    (Quantity::Normals, "normals"),
    (Quantity::NotFinite, "not finite"),
    (Quantity::Leaks, "leaks px"),
];

impl Line {
    fn cell(&self, quantity: Quantity) -> String {
        let found = self.worst.iter().find(|(known, _)| *known == quantity);
        found.map_or_else(|| "-".to_owned(), |(_, worst)| number(*worst))
    }

    /// The quantities that have no column, with their numbers.
    fn rest(&self) -> String {
        let rest = self.worst.iter().filter(|(quantity, _)| COLUMNS.iter().all(|(column, _)| column != quantity));
        let phrase = |(quantity, measured): &(Quantity, f64)| match quantity {
            Quantity::Segment if *measured == 0.0 => "all that is in view is cut as finely as possible".to_owned(),
            _ => format!("{} {}", number(*measured), quantity.unit()),
        };
        rest.map(phrase).collect::<Vec<_>>().join(", ")
    }
}

/// A number as short text: whole numbers without decimals, others with two decimals or three digits.
fn number(x: f64) -> String {
    if x.fract() == 0.0 && x.abs() < 1e15 {
        format!("{x}")
    } else if x >= 0.1 {
        format!("{x:.2}")
    } else {
        format!("{x:.2e}")
    }
}

/// What the columns mean.
pub const LEGEND: &str = "Points: edge points whose positions differ between sides in at least one bit; factors: edges whose \
     sides got different factors; normals: edge points whose normals differ although the mesh's normals agree; not finite: \
     vertices with infinite or NaN coordinates; leaks: pixels that show the inside of a closed mesh (- where they can't be counted). Each \
     number is the worst over factors, views, partitionings and devices.";

/// Formats lines as a table for a terminal.
pub fn table(lines: &[Line]) -> String {
    let mut text = format!("{:<20} {:<20}", "case", "method");
    for (_, column) in COLUMNS {
        let _ = write!(text, " {column:>11}");
    }
    text += "  verdict\n";
    let mut last = "";
    for line in lines {
        let case = if line.case == last { "" } else { &line.case };
        last = &line.case;
        let _ = write!(text, "{case:<20} {:<20}", line.method);
        for (quantity, _) in COLUMNS {
            let _ = write!(text, " {:>11}", line.cell(quantity));
        }
        let _ = write!(text, "  {}", line.verdict.text());
        let rest = line.rest();
        let _ = writeln!(text, "{}{rest}", if rest.is_empty() { "" } else { "; " });
    }
    text
}

/// The page's file name.
pub const PAGE: &str = "stability.md";

/// Returns the page in Markdown. It has a section for each subject: the text about it, its picture, which is a file in the page's
/// folder, and a table of its rows.
pub fn page(sections: &[(&Subject, Option<String>)], rows: &[Row]) -> String {
    let mut text = String::from("# Where tessellation breaks\n\n");
    let mut devices: Vec<_> = rows.iter().map(|row| row.device.as_str()).collect();
    devices.sort_unstable();
    devices.dedup();
    let _ = writeln!(
        text,
        "Written by `pnaen stability -o DIR`, run on: {}. Each picture shows, row by row: {}. Cracks are red, folded triangles \
         violet, T-junctions yellow.\n\n{}\n",
        devices.join(", "),
        super::Method::all().into_iter().map(super::Method::name).collect::<Vec<_>>().join(", "),
        LEGEND
    );
    let lines = lines(rows);
    for (Subject { name, about, .. }, picture) in sections {
        let _ = writeln!(text, "## {name}\n");
        if !about.is_empty() {
            let _ = writeln!(text, "{about}\n");
        }
        if let Some(picture) = picture {
            let _ = writeln!(text, "![{name}]({picture})\n");
        }
        let row = |line: &Line| {
            let cells = COLUMNS.map(|(quantity, _)| line.cell(quantity));
            let last = [line.rest(), line.verdict.text().to_owned()];
            [line.method.to_owned()].into_iter().chain(cells).chain(last).collect()
        };
        let rows: Vec<_> = lines.iter().filter(|line| line.case == *name).map(row).collect();
        let names = COLUMNS.map(|(_, name)| name);
        let columns: Vec<_> = ["method"].into_iter().chain(names).chain(["further", "verdict"]).collect();
        text += &markdown::table(&columns, &[0, columns.len() - 2, columns.len() - 1], &rows);
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(method: &'static str, quantity: Quantity, measured: f64, promised: bool) -> Row {
        let (case, device) = ("split".to_owned(), "cpu".to_owned());
        let holds = measured <= quantity.limit();
        let (partitioning, unit, tried) = ("pow2", quantity.unit(), None);
        Row { case, method, device, partitioning, measured, unit, promised, holds, quantity, tried }
    }

    #[test]
    fn a_line_has_the_worst_number_of_each_quantity() {
        let rows = [
            row("PN", Quantity::Points, 0.0, false),
            row("PN", Quantity::Points, 7.0, false),
            row("PN-AEN", Quantity::Points, 0.0, true),
            row("PN", Quantity::Segment, 2.5, true),
        ];
        let lines = lines(&rows);
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0].worst, [(Quantity::Points, 7.0), (Quantity::Segment, 2.5)]);
        assert_eq!((lines[0].verdict, lines[1].verdict), (Verdict::Fails, Verdict::Holds));
        let text = table(&lines);
        assert!(text.contains("fails; 2.50 times the segment asked for"), "{text}");
        let broken = row("PN-AEN", Quantity::Points, 1.0, true);
        assert_eq!(super::lines(&[broken])[0].verdict, Verdict::BreaksPromise);
    }

    #[test]
    fn a_page_without_a_picture_or_text_leaves_them_out() {
        let subject = Subject::new("split".to_owned(), geometry::mesh::Mesh::default(), 0.0);
        let section = |picture: Option<&str>| [(&subject, picture.map(str::to_owned))];
        let rows = [row("PN", Quantity::Points, 7.0, false)];
        let text = page(&section(None), &rows);
        assert!(text.contains("run on: cpu.") && !text.contains("!["), "{text}");
        assert!(text.contains("\n## split\n\n| method |") && text.contains("\n| PN | 7 |"), "{text}");
        assert!(page(&section(Some("a.png")), &rows).contains("\n![split](a.png)\n"));
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.0, 12.0, 0.2567, 0.000123].map(number), ["0", "12", "0.26", "1.23e-4"]);
    }
}
