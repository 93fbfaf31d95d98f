//! Tessellation factors as CSV files, with a line for each patch: what the hull shader of this program or of another
//! engine wrote.

use thiserror::Error;

use super::text_lines::line_at;
use geometry::casts::to_usize;
use geometry::mesh::Topology;
use geometry::tessellate::{HullFactors, Partitioning, RowChoice};

/// The first line. `patch` is the index of the triangle, `e0` to `e2` are TessFactor[0..2], `inside` is
/// InsideTessFactor.
const HEADER: [&str; 5] = ["patch", "e0", "e1", "e2", "inside"];

/// The first line under rows. `base` is the number of the edge that is the base, empty if the factors of the edges choose it;
/// `width` is the number of segments to which rows widen; `flipped` is 1 if diagonals are flipped, else 0.
const ROW_HEADER: [&str; 7] = ["patch", "e0", "e1", "e2", "base", "width", "flipped"];

/// An error in a file of factors, and its line.
#[derive(Debug, PartialEq, Eq, Error)]
#[error("line {line}: {fault}")]
pub struct FactorsError {
    /// The line, counted from 1.
    pub line: usize,
    pub fault: LineFault,
}

/// What is wrong with a line.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LineFault {
    #[error(
        "expected the header \"patch,e0,e1,e2,inside\", or with --partitioning rows \"patch,e0,e1,e2,base,width,flipped\""
    )]
    Header,
    #[error("the columns base, width and flipped are those of rows: add --partitioning rows")]
    RowHeader,
    #[error("expected the values {}, but the number of values is {count}", columns.join(","))]
    Count { columns: &'static [&'static str], count: usize },
    #[error("base is {0:?}: expected 0, 1 or 2, or nothing if the factors of the edges choose it")]
    Base(String),
    #[error("flipped is {0:?}: expected 1 if diagonals are flipped, else 0")]
    Flipped(String),
    #[error("patch is {0:?}: expected the index of a triangle, such as 0")]
    Index(String),
    #[error("{column} is {text:?}: expected a number, such as 2.5, inf or NaN")]
    Number { column: &'static str, text: String },
    #[error("there is no patch {patch}: the mesh has {count} triangles, counted from 0")]
    Beyond { patch: u32, count: usize },
    #[error("patch {patch} occurs twice; its first line is {first}")]
    Again { patch: u32, first: usize },
    #[error("the file ends without a line for patch {first}{}: it may be of another mesh", and_more(*.others))]
    Missing { first: u32, others: usize },
    #[error("{0}")]
    Unreadable(String),
}

/// Returns the end of a message that names one of `count` + 1 things.
fn and_more(count: usize) -> String {
    if count == 0 { String::new() } else { format!(" and {count} more") }
}

/// Returns the columns of a partitioning.
fn columns(has_rows: bool) -> &'static [&'static str] {
    if has_rows { &ROW_HEADER } else { &HEADER }
}

/// Returns a CSV file with the factors that were written for each patch, under the index of its triangle. Degenerate
/// triangles have no patch and no line. Numbers are written so that they read back exactly.
pub fn to_csv(topology: &Topology, written: &[HullFactors], partitioning: Partitioning) -> String {
    let has_rows = partitioning.has_rows();
    let mut text = columns(has_rows).join(",") + "\n";
    for (patch, HullFactors { edges: [e0, e1, e2], inside }) in topology.patches.iter().zip(written) {
        text += &format!("{},{e0},{e1},{e2},", patch.triangle);
        text += &match (has_rows, RowChoice::new(*inside)) {
            (false, _) => format!("{inside}\n"),
            (true, RowChoice { base: Some((base, flips)), width }) => format!("{base},{width},{}\n", u32::from(flips)),
            (true, RowChoice { base: None, width }) => format!(",{width},0\n"),
        };
    }
    text
}

/// Reads the factors of each patch of a mesh with `triangles` triangles. The lines may be in any order. Lines of
/// degenerate triangles are allowed and ignored. Under rows a file may also have an inside factor, as other partitionings do.
///
/// # Errors
/// The text isn't such a file, or its patches aren't those of the mesh.
pub fn from_csv(
    text: &str,
    topology: &Topology,
    triangles: usize,
    partitioning: Partitioning,
) -> Result<Vec<HullFactors>, FactorsError> {
    let mut reader = csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(text.as_bytes());
    let byte = |at: Option<&csv::Position>| at.map_or(0, |at| to_usize(at.byte()));
    let fault = |byte: usize, fault| FactorsError { line: line_at(text.as_bytes(), byte), fault };
    let columns = match reader.headers() {
        Ok(header) if header == columns(false) => columns(false),
        Ok(header) if header == columns(true) && partitioning.has_rows() => columns(true),
        Ok(header) if header == columns(true) => return Err(fault(byte(header.position()), LineFault::RowHeader)),
        Ok(header) => return Err(fault(byte(header.position()), LineFault::Header)),
        Err(error) => return Err(fault(byte(error.position()), LineFault::Unreadable(error.to_string()))),
    };
    let mut lines: Vec<Option<(usize, HullFactors)>> = vec![None; triangles];
    for record in reader.records() {
        let record = record.map_err(|error| fault(byte(error.position()), LineFault::Unreadable(error.to_string())))?;
        let at = byte(record.position());
        if record.len() == 1 && record[0].is_empty() {
            continue;
        }
        let (patch, factors) = line(&record, columns).map_err(|reason| fault(at, reason))?;
        let beyond = LineFault::Beyond { patch, count: triangles };
        let place = lines.get_mut(patch as usize).ok_or_else(|| fault(at, beyond))?;
        if let Some((first, _)) = place {
            let first = line_at(text.as_bytes(), *first);
            return Err(fault(at, LineFault::Again { patch, first }));
        }
        *place = Some((at, factors));
    }
    let own = |patch: &geometry::mesh::Patch| lines[patch.triangle as usize].as_ref().map(|(_, factors)| *factors);
    let missing: Vec<_> = topology.patches.iter().filter(|patch| own(patch).is_none()).collect();
    if let Some(first) = missing.first() {
        let fault = LineFault::Missing { first: first.triangle, others: missing.len() - 1 };
        return Err(FactorsError { line: text.lines().count(), fault });
    }
    Ok(topology.patches.iter().filter_map(own).collect())
}

/// Reads the patch and the factors of one line.
fn line(record: &csv::StringRecord, columns: &'static [&'static str]) -> Result<(u32, HullFactors), LineFault> {
    if record.len() != columns.len() {
        return Err(LineFault::Count { columns, count: record.len() });
    }
    let quoted = |text: &str| text.chars().take(40).collect::<String>();
    let patch = record[0].parse().map_err(|_| LineFault::Index(quoted(&record[0])))?;
    let number =
        |i: usize| record[i].parse().map_err(|_| LineFault::Number { column: columns[i], text: quoted(&record[i]) });
    let edges = [number(1)?, number(2)?, number(3)?];
    if columns.len() == HEADER.len() {
        return Ok((patch, HullFactors { edges, inside: number(4)? }));
    }
    let flips = match &record[6] {
        "0" => false,
        "1" => true,
        other => return Err(LineFault::Flipped(quoted(other))),
    };
    let base = match &record[4] {
        "" => None,
        "0" => Some((0, flips)),
        "1" => Some((1, flips)),
        "2" => Some((2, flips)),
        other => return Err(LineFault::Base(quoted(other))),
    };
    Ok((patch, HullFactors { edges, inside: RowChoice { base, width: number(5)? }.inside() }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::{Corner, Mesh};
    use geometry::progress::Progress;

    /// Three triangles, the middle one of which is degenerate.
    fn topology() -> Topology {
        let at =
            |x: f32, y: f32| Corner { position: glam::vec3(x, y, 0.0), normal: glam::Vec3::Z, uv: glam::Vec2::ZERO };
        let corners = vec![at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)];
        let mesh = Mesh { corners, triangles: vec![[0, 1, 2], [1, 1, 2], [1, 3, 2]].into(), ..Mesh::default() };
        Topology::build(&mesh, &Progress::default()).expect("nobody cancels")
    }

    fn read(text: &str) -> Result<Vec<HullFactors>, FactorsError> {
        from_csv(text, &topology(), 3, Partitioning::Integer)
    }

    #[test]
    fn factors_are_read_back_to_the_bit() {
        let numbers =
            [0.1, 64.0, f32::NAN, f32::INFINITY, -0.0, 1.0 + f32::EPSILON, f32::MIN_POSITIVE / 8.0, 16777217.0];
        let [a, b] =
            [0, 4].map(|i| HullFactors { edges: [numbers[i], numbers[i + 1], numbers[i + 2]], inside: numbers[i + 3] });
        let text = to_csv(&topology(), &[a, b], Partitioning::Integer);
        assert!(text.starts_with("patch,e0,e1,e2,inside\n0,0.1,64,NaN,inf\n2,-0,1.0000001,"), "{text}");
        let bits = |all: &[HullFactors]| bytemuck::cast_slice::<_, u32>(all).to_vec();
        assert_eq!(read(&text).map(|all| bits(&all)), Ok(bits(&[a, b])));
    }

    #[test]
    fn rows_have_columns_of_their_own() {
        let own = [[4.0, 6.0, 3.0, 256.0 + 4.0], [2.0, 2.5, 1.0, 1536.0 + 7.25]];
        let own = own.map(|[u, v, w, inside]| HullFactors { edges: [u, v, w], inside });
        let text = to_csv(&topology(), &own, Partitioning::Rows);
        assert_eq!(text, "patch,e0,e1,e2,base,width,flipped\n0,4,6,3,0,4,0\n2,2,2.5,1,2,7.25,1\n");
        let read_rows = |text: &str| from_csv(text, &topology(), 3, Partitioning::Rows);
        assert_eq!(read_rows(&text), Ok(own.to_vec()));
        // The factors of the edges choose.
        let free = own.map(|factors| HullFactors { inside: 5.0, ..factors });
        let text = to_csv(&topology(), &free, Partitioning::Rows);
        assert!(text.contains("\n0,4,6,3,,5,0\n"), "{text}");
        assert_eq!(read_rows(&text), Ok(free.to_vec()));
        assert_eq!(read_rows("patch,e0,e1,e2,inside\n0,4,6,3,260\n2,2,2.5,1,1543.25\n"), Ok(own.to_vec()));
        let fault = |text: &str| {
            read_rows(&text.replace("ROWS", "patch,e0,e1,e2,base,width,flipped")).map_err(|e| (e.line, e.fault))
        };
        assert_eq!(fault("ROWS\n0,1,1,1,3,1,0\n"), Err((2, LineFault::Base("3".into()))));
        assert_eq!(fault("ROWS\n0,1,1,1,0,1,yes\n"), Err((2, LineFault::Flipped("yes".into()))));
        let count = LineFault::Count { columns: &ROW_HEADER, count: 5 };
        assert_eq!(fault("ROWS\n0,1,1,1,4\n"), Err((2, count)));
        let row_header = Err(FactorsError { line: 1, fault: LineFault::RowHeader });
        assert_eq!(read("patch,e0,e1,e2,base,width,flipped\n0,1,1,1,0,1,0\n"), row_header);
    }

    #[test]
    fn the_order_of_lines_blanks_and_line_ends_do_not_matter() {
        let expected = read("patch,e0,e1,e2,inside\n0,1,2,3,4\n2,5,6,7,8\n");
        assert_eq!(expected.as_ref().map(Vec::len), Ok(2));
        for text in [
            "\u{feff}patch,e0,e1,e2,inside\r\n2,5,6,7,8\r\n0,1,2,3,4\r\n",
            "\n patch , e0,e1 ,e2, inside \n\n  \n 2, 5,6.0,7e0 ,8\n1,9,9,9,9\n\t0,1,+2,3,4",
            "\"patch\",e0,e1,e2,inside\n\"0\",1,2,3,4\n2,5,6,7,8",
        ] {
            assert_eq!(read(text), expected, "{text:?}");
        }
    }

    #[test]
    fn errors_have_their_line() {
        let number = |column, text: &str| LineFault::Number { column, text: text.into() };
        for (rows, line, fault) in [
            ("0,1,2,3,4\n2,5,6,x,8\n", 3, number("e2", "x")),
            ("0,1,2,3,\n2,5,6,7,8\n", 2, number("inside", "")),
            ("\n\n0,1,2,3,4\n \n\n2,5,0x6,7,8\n", 7, number("e1", "0x6")),
            ("0,1,2,3,4\n-2,5,6,7,8\n", 3, LineFault::Index("-2".into())),
            ("0,1,2,3,4\n2,5,6,7\n", 3, LineFault::Count { columns: &HEADER, count: 4 }),
            ("0,1,2,3,4\n3,5,6,7,8\n", 3, LineFault::Beyond { patch: 3, count: 3 }),
            ("2,1,2,3,4\n0,1,2,3,4\n\n2,5,6,7,8\n", 5, LineFault::Again { patch: 2, first: 2 }),
            ("0,1,2,3,4\n\n1,1,1,1,1\n", 4, LineFault::Missing { first: 2, others: 0 }),
            ("", 1, LineFault::Missing { first: 0, others: 1 }),
        ] {
            for end in ["\n", "\r\n"] {
                let text = format!("patch,e0,e1,e2,inside\n{rows}").replace('\n', end);
                assert_eq!(read(&text), Err(FactorsError { line, fault: fault.clone() }), "{text:?}");
            }
        }
        for (text, line) in [("", 1), ("0,1,2,3,4\n", 1), ("\n\npatch;e0;e1;e2;inside\n", 3), ("patch,e0,e1,e2\n", 1)] {
            assert_eq!(read(text), Err(FactorsError { line, fault: LineFault::Header }), "{text:?}");
        }
        let fault = FactorsError { line: 9, fault: LineFault::Missing { first: 7, others: 2 } };
        assert_eq!(
            fault.to_string(),
            "line 9: the file ends without a line for patch 7 and 2 more: it may be of another mesh"
        );
    }
}
