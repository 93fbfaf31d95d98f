//! Reads the vertices that a frame debugger exports as CSV from its view of a mesh: a line for each vertex in the order in which
//! triangles use them, three lines a triangle, and a column for each component of each attribute, such as `POSITION.x`.

use std::path::{Path, PathBuf};

use csv::{ByteRecord, Reader, ReaderBuilder, Trim};
use glam::Vec3;
use thiserror::Error;

use super::memory_budget::Budget;
use super::text_lines::line_at;
use crate::files::{FileError, Limits, read_file};
use geometry::casts::to_usize;
use geometry::names::{shortened, shown, shown_path};
use geometry::progress::{Cancelled, Progress};

/// The vertices of triangles, three for each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CsvVertices {
    /// In the file's units; a coordinate that the file says it doesn't have is NaN.
    pub positions: Vec<Vec3>,
    /// Half a unit of the last decimal of the number that has the most.
    pub resolution: f64,
    /// Sentences about what was left out.
    pub warnings: Vec<String>,
}

/// Why a CSV file gives no positions.
#[derive(Debug, Error)]
pub enum CsvError {
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error(transparent)]
    File(#[from] FileError),
    #[error("{}: {fault}", shown_path(path))]
    Broken { path: PathBuf, fault: String },
}

/// What is said of positions that the rasterizer gets.
const IN_CLIP_SPACE: &str = "is in clip space, which can't be compared without the matrix that made it: let the shader also write its \
     position in object space, and name that column with --position-column";

/// Names columns.
fn listed(attributes: &[Attribute]) -> String {
    const NAMED: usize = 20;
    if attributes.is_empty() {
        return "none with x, y and z".to_owned();
    }
    let names: Vec<String> = attributes.iter().take(NAMED).map(|attribute| shown(&attribute.name)).collect();
    names.join(", ")
}

/// An attribute with at least three components.
struct Attribute {
    /// Its name, without components.
    name: String,
    /// The columns of x, y and z, and of w if there is one.
    columns: [usize; 3],
    w: Option<usize>,
}

/// Separators that are tried.
const SEPARATORS: [u8; 4] = *b",;\t|";
/// How many lines are read between two checks of memory and cancellation.
const LINES: usize = 1 << 16;
/// What frame debuggers write where there is no value.
const NOTHING: [&[u8]; 3] = [b"", b"-", b"---"];

/// Reads a file. `column` names the attribute that is the position, without its components; without it, it is found
/// by its name.
///
/// # Errors
/// [`CsvError`], whose message says what is wrong, where, and what to do.
pub fn read_vertices(
    path: &Path,
    column: Option<&str>,
    limits: &Limits,
    progress: &Progress,
) -> Result<CsvVertices, CsvError> {
    let bytes = read_file(path, limits, |_| Ok::<_, CsvError>(()), progress)?;
    let broken = |fault| CsvError::Broken { path: path.to_owned(), fault };
    let lines = Lines::open(&bytes).map_err(broken)?;
    let attribute = chosen(lines.attributes(), column).map_err(broken)?;
    lines.read(&attribute, &Budget::new(bytes.len(), limits.memory), progress, broken)
}

/// The lines of a file behind its header.
struct Lines<'a> {
    text: &'a [u8],
    reader: Reader<&'a [u8]>,
    header: Vec<String>,
    separator: u8,
}

impl<'a> Lines<'a> {
    /// # Errors
    /// What is wrong with the file.
    fn open(text: &'a [u8]) -> Result<Self, String> {
        if text.is_empty() {
            return Err("it has no lines; export the vertices again".to_owned());
        }
        if text.starts_with(&[0xff, 0xfe]) || text.starts_with(&[0xfe, 0xff]) {
            return Err("it is a text in UTF-16; save it as UTF-8".to_owned());
        }
        let first = text.split(|byte| matches!(byte, b'\n' | b'\r')).next().unwrap_or_default();
        let count = |separator: &u8| first.iter().filter(|byte| *byte == separator).count();
        let separator = SEPARATORS.into_iter().rev().max_by_key(count).unwrap_or(b',');
        let mut reader = ReaderBuilder::new().flexible(true).trim(Trim::All).delimiter(separator).from_reader(text);
        let header = reader.byte_headers().map_err(|error| error.to_string())?;
        let names: Vec<String> = header.iter().map(|name| String::from_utf8_lossy(name).into_owned()).collect();
        let is_number = |name: &String| name.parse::<f64>().is_ok();
        if names.iter().all(|name| name.is_empty() || is_number(name))
            || names.iter().filter(|name| is_number(name)).count() > 2
        {
            let line = shortened(&String::from_utf8_lossy(first), 60);
            let expected = "the names of columns, such as VTX, IDX, POSITION.x, POSITION.y, POSITION.z";
            return Err(format!("its first line, {line:?}, isn't a header; expected {expected}"));
        }
        Ok(Self { text, reader, header: names, separator })
    }

    /// The attributes with three components and more, in the order of the columns.
    fn attributes(&self) -> Vec<Attribute> {
        let mut found: Vec<(String, [Option<usize>; 4])> = Vec::new();
        for (column, name) in self.header.iter().enumerate() {
            let Some((base, component)) = component_of(name) else { continue };
            let place = found.iter().position(|(other, _)| other == base).unwrap_or_else(|| {
                found.push((base.to_owned(), [None; 4]));
                found.len() - 1
            });
            found[place].1[component].get_or_insert(column);
        }
        let whole = |(name, columns): (String, [Option<usize>; 4])| {
            let [x, y, z, w] = columns;
            Some(Attribute { name, columns: [x?, y?, z?], w })
        };
        found.into_iter().filter_map(whole).collect()
    }

    /// Reads the positions of all vertices. `broken` makes an error of what is wrong.
    fn read(
        mut self,
        attribute: &Attribute,
        budget: &Budget,
        progress: &Progress,
        broken: impl Fn(String) -> CsvError,
    ) -> Result<CsvVertices, CsvError> {
        let mut vertices = CsvVertices::default();
        let mut decimals = 0;
        let mut record = ByteRecord::new();
        loop {
            if vertices.positions.len().is_multiple_of(LINES) {
                progress.check()?;
                // A list that grows is copied to one that is twice as long.
                let room = vertices.positions.capacity() * size_of::<Vec3>() + 2 * LINES * size_of::<Vec3>();
                budget
                    .check(2 * room as u64)
                    .map_err(|refused| broken(format!("its vertices {refused}; split it into several files")))?;
            }
            if !self.reader.read_byte_record(&mut record).map_err(|error| broken(error.to_string()))? {
                break;
            }
            if record.len() == 1 && record[0].is_empty() {
                continue;
            }
            let position = self.position(&record, attribute, &mut decimals).map_err(|fault| {
                let byte = record.position().map_or(0, |at| to_usize(at.byte()));
                broken(format!("line {}: {fault}", line_at(self.text, byte)))
            });
            vertices.positions.push(position?);
        }
        let surplus = vertices.positions.len() % 3;
        if surplus > 0 {
            vertices.positions.truncate(vertices.positions.len() - surplus);
            vertices.warnings.push(format!(
                "vertices at the end that make no whole triangle, left out: {surplus}. If the triangles are strips, export them as \
                 a list."
            ));
        }
        vertices.resolution = if decimals > 0 { 0.5 * 10.0_f64.powi(-decimals) } else { 0.0 };
        Ok(vertices)
    }

    /// The position on one line. Counts the decimals that numbers have.
    fn position(&self, record: &ByteRecord, attribute: &Attribute, decimals: &mut i32) -> Result<Vec3, String> {
        let value = |column: usize, decimals: &mut i32| {
            let name = || shown(&self.header[column]);
            let (has, needs) = (record.len(), column + 1);
            let short = || format!("it has {has} values, but {} is value {needs}; export the vertices again", name());
            let text = record.get(column).ok_or_else(short)?;
            let fault = || {
                let text = shortened(&String::from_utf8_lossy(text), 40);
                format!("{} is {text:?}; expected a number, such as 0.25", name())
            };
            number(text, self.separator, decimals).ok_or_else(fault)
        };
        let [x, y, z] = attribute.columns;
        let position = Vec3::new(value(x, decimals)?, value(y, decimals)?, value(z, decimals)?);
        if let Some(w) = attribute.w.filter(|_| is_in_clip_space(&attribute.name)) {
            let w = value(w, &mut 0)?;
            if w.is_finite() && w != 1.0 {
                return Err(format!("w of {} is {w}, so that it {IN_CLIP_SPACE}", attribute.name));
            }
        }
        Ok(position)
    }
}

/// Parses a number. Where commas don't separate values, they may be the decimal point. Counts the decimals, those of numbers
/// with an exponent as if they had none.
#[expect(clippy::cast_possible_truncation, reason = "so many decimals are far beyond the limit")]
fn number(text: &[u8], separator: u8, decimals: &mut i32) -> Option<f32> {
    if NOTHING.contains(&text) {
        return Some(f32::NAN);
    }
    let text = std::str::from_utf8(text).ok()?;
    let text = if separator == b',' { text.to_owned() } else { text.replace(',', ".") };
    let number = text.parse().ok()?;
    let (digits, exponent) = text.split_once(['e', 'E']).unwrap_or((&text, "0"));
    let own = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len() as i32);
    *decimals = (*decimals).max(own.min(100) - exponent.parse::<i32>().unwrap_or(0).clamp(-100, 100));
    Some(number)
}

/// Splits the name of a column, such as `POSITION.x`, `pos_y`, `P[2]` or `Z`, into that of its attribute and a component.
fn component_of(name: &str) -> Option<(&str, usize)> {
    let trimmed = name.trim_end_matches([']', ')']);
    let last = trimmed.chars().next_back()?;
    let component = match last.to_ascii_lowercase() {
        'x' | '0' => 0,
        'y' | '1' => 1,
        'z' | '2' => 2,
        'w' | '3' => 3,
        _ => return None,
    };
    let base = &trimmed[..trimmed.len() - 1];
    if base.is_empty() {
        return (!last.is_ascii_digit()).then_some((base, component));
    }
    let name = base.strip_suffix(['.', '_', '[', '(', ' '])?;
    Some((name.trim_end(), component))
}

/// Whether an attribute of this name is what the rasterizer gets.
fn is_in_clip_space(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    name.contains("sv_pos") || name.contains("gl_position") || name.contains("clip")
}

/// Whether an attribute of this name may be the position.
fn is_position(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    name.contains("pos") || matches!(&name[..], "" | "p" | "v" | "vertex" | "coord")
}

/// Chooses the attribute that is the position.
///
/// # Errors
/// Which there are, if that isn't clear.
fn chosen(attributes: Vec<Attribute>, asked: Option<&str>) -> Result<Attribute, String> {
    let all = listed(&attributes);
    let clip = attributes.iter().find(|own| is_in_clip_space(&own.name)).map(|own| own.name.clone());
    let is_chosen = |own: &Attribute| match asked {
        Some(asked) => own.name.eq_ignore_ascii_case(asked),
        None => is_position(&own.name) && !is_in_clip_space(&own.name),
    };
    let mut found: Vec<Attribute> = attributes.into_iter().filter(is_chosen).collect();
    let help = "with --position-column";
    match (found.len(), asked, clip) {
        (0, Some(asked), _) => Err(format!("it has no column {asked}.x, .y and .z; it has {all}")),
        (0, None, Some(clip)) => Err(format!("its only position, {clip}, {IN_CLIP_SPACE}")),
        (0, None, None) => Err(format!("none of its columns are positions; it has {all}; name the one that is {help}")),
        (1, ..) | (_, Some(_), _) => Ok(found.swap_remove(0)),
        _ => Err(format!("several of its columns may be positions: {}; name one {help}", listed(&found))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    fn read(text: &str, column: Option<&str>) -> Result<CsvVertices, String> {
        let folder = tempfile::tempdir().expect("a writable folder");
        let path = folder.path().join("a.csv");
        std::fs::write(&path, text).expect("a writable folder");
        let shown = format!("{}: ", path.display());
        let read = read_vertices(&path, column, &Limits::default(), &Progress::new());
        read.map_err(|error| error.to_string().replace(&shown, ""))
    }

    const TRIANGLE: [Vec3; 3] = [vec3(0.0, 0.5, -1.0), vec3(1.25, 0.0, 0.0), vec3(0.0, 1.0, 3.0)];

    #[test]
    fn a_frame_debuggers_mesh_view_is_read() {
        let text = "VTX, IDX, gl_Position.x, gl_Position.y, gl_Position.z, gl_Position.w, position.x, position.y, position.z\n\
             0, 7, 9, 9, 9, 4, 0.00, 0.50, -1.00\n1, 3, 9, 9, 9, 4, 1.25, 0.00, 0.00\n2, 9, 9, 9, 9, 4, 0.00, 1.00, 3.00\n";
        let found = read(text, None).expect("positions");
        assert_eq!((found.positions.as_slice(), found.warnings.len()), (&TRIANGLE[..], 0));
        assert!((found.resolution - 0.005).abs() < 1e-12, "{}", found.resolution);
    }

    #[test]
    fn other_separators_names_and_decimal_points_are_read() {
        for text in [
            "x;y;z\n0,0;0,5;-1\n1,25;0;0\n0;1;3\n",
            "\u{feff}POSITION[0]\tPOSITION[1]\tPOSITION[2]\n0\t0.5\t-1\n1.25\t0\t0\n\n0\t1\t3\n",
            "\"pos_x\",\"pos_y\",\"pos_z\",\"n.x\",\"n.y\",\"n.z\"\r\n0,.5,-1e0,1,1,1\r\n125e-2,0,0,1,1,1\r\n0,1,3,1,1,1\r\n",
            "Z | X | Y\n-1|0|0.5\n0|1.25|0\n3|0|1",
        ] {
            assert_eq!(read(text, None).map(|found| found.positions), Ok(TRIANGLE.to_vec()), "{text}");
        }
    }

    #[test]
    fn a_column_can_be_named() {
        let text = "A.x,A.y,A.z,WORLDPOS.x,WORLDPOS.y,WORLDPOS.z,POSITION.x,POSITION.y,POSITION.z\n\
             0,0.5,-1,7,7,7,8,8,8\n1.25,0,0,7,7,7,8,8,8\n0,1,3,7,7,7,8,8,8\n";
        assert_eq!(read(text, Some("a")).map(|found| found.positions), Ok(TRIANGLE.to_vec()));
        let errors = [None, Some("B")].map(|column| read(text, column).expect_err("it isn't clear"));
        assert_eq!(
            errors[0],
            "several of its columns may be positions: WORLDPOS, POSITION; name one with --position-column"
        );
        assert_eq!(errors[1], "it has no column B.x, .y and .z; it has A, WORLDPOS, POSITION");
    }

    #[test]
    fn what_is_wrong_is_said_with_its_place() {
        for (text, said) in [
            ("", "it has no lines"),
            ("0,1,2\n3,4,5\n", "its first line, \"0,1,2\", isn't a header"),
            ("VTX,IDX,uv.x,uv.y\n0,0,0,0\n", "none of its columns are positions; it has none with x, y and z"),
            ("VTX,n.x,n.y,n.z\n0,0,0,0\n", "it has n; name the one that is with --position-column"),
            ("SV_Position.x,SV_Position.y,SV_Position.z,SV_Position.w\n0,0,0,1\n", "is in clip space"),
            ("x,y,z\n0,0,0\n\n0,zero,0\n", "line 4: y is \"zero\"; expected a number"),
            ("x,y,z\n0,0\n", "line 2: it has 2 values, but z is value 3"),
        ] {
            let error = read(text, None).expect_err(text);
            assert!(error.contains(said), "{text}: {error}");
        }
        let clip = "SV_Position.x,SV_Position.y,SV_Position.z,SV_Position.w\n0,0,0,1\n0,0,0,2\n";
        assert!(read(clip, Some("SV_Position")).expect_err("w is 2").contains("is in clip space"));
    }

    #[test]
    fn values_that_are_missing_are_nan_and_lines_beyond_triangles_are_left_out() {
        let found = read("x,y,z\n0,0,---\n1,nan,0\n2,0,inf\n3,0,0\n", None).expect("three lines");
        assert_eq!(found.positions.len(), 3);
        assert!(found.positions.iter().all(|position| !position.is_finite()));
        assert!(found.warnings[0].starts_with("vertices at the end that make no whole triangle, left out: 1."));
    }

    #[test]
    fn a_file_that_takes_too_much_memory_is_refused() {
        let folder = tempfile::tempdir().expect("a writable folder");
        let path = folder.path().join("a.csv");
        std::fs::write(&path, "x,y,z\n0,0,0\n").expect("a writable folder");
        let limits = Limits { memory: 1000, ..Limits::default() };
        let error = read_vertices(&path, None, &limits, &Progress::new()).expect_err("no memory").to_string();
        assert!(error.contains("split it into several files"), "{error}");
        let limits = Limits { file: 5, ..Limits::default() };
        let error = read_vertices(&path, None, &limits, &Progress::new()).expect_err("too many bytes").to_string();
        assert!(error.contains("5"), "{error}");
    }
}
