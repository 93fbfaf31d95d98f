//! The header of a PLY file: what elements follow, and what each consists of.

use crate::load::read_error::{Place, ReadError};
use crate::load::text_lines::{Line, Lines, shown};

/// How values are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// What a number is in binary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// In bytes.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// A value, or a list of them behind their count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    One(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Property<'a> {
    pub name: &'a [u8],
    pub kind: Kind,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Element<'a> {
    pub name: &'a [u8],
    pub count: u64,
    pub properties: Vec<Property<'a>>,
}

impl Element<'_> {
    /// The size in binary of one whose lists are all empty, in bytes; and whether it has no lists.
    pub fn least(&self) -> (u64, bool) {
        let size = |property: &Property| match property.kind {
            Kind::One(scalar) | Kind::List { count: scalar, .. } => scalar.size() as u64,
        };
        let fixed = self.properties.iter().all(|property| matches!(property.kind, Kind::One(_)));
        (self.properties.iter().map(size).sum(), fixed)
    }
}

pub struct Header<'a> {
    pub encoding: Encoding,
    pub elements: Vec<Element<'a>>,
    /// What follows it.
    pub lines: Lines<'a>,
}

/// Reads a header.
///
/// # Errors
/// [`ReadError::Broken`].
pub fn read(bytes: &[u8]) -> Result<Header<'_>, ReadError> {
    let is_ply = bytes.get(..4).is_some_and(|start| start.starts_with(b"ply") && start[3].is_ascii_whitespace());
    if !is_ply {
        return Err(Place::Everywhere.fault("it is no PLY: its first line isn't \"ply\""));
    }
    // What follows in binary may have any byte in it.
    let of_old_macs = bytes[3] == b'\r' && bytes.get(4) != Some(&b'\n');
    let mut lines = Lines::ending(bytes, if of_old_macs { b'\r' } else { b'\n' });
    let (mut encoding, mut elements) = (None, Vec::new());
    lines.next()?;
    while let Some(line) = lines.next()? {
        let mut words = line.words();
        let fault = |reason: String| line.place().fault(reason);
        match words.next() {
            None | Some(b"comment" | b"obj_info") => {}
            Some(b"format") => encoding = Some(format(words.next()).map_err(fault)?),
            Some(b"element") => elements.push(element(&line).map_err(fault)?),
            Some(b"property") => {
                let Some(Element { properties, .. }) = elements.last_mut() else {
                    return Err(fault("a property comes before any element".to_owned()));
                };
                properties.push(property(&line).map_err(fault)?);
            }
            Some(b"end_header") => {
                let encoding = encoding.ok_or_else(|| fault("the header has no format".to_owned()))?;
                return Ok(Header { encoding, elements, lines });
            }
            Some(word) => return Err(fault(format!("{} is no statement of a header", shown(word)))),
        }
    }
    Err(Place::Line(lines.count()).fault("the file ends within its header"))
}

fn format(word: Option<&[u8]>) -> Result<Encoding, String> {
    match word {
        Some(b"ascii") => Ok(Encoding::Text),
        Some(b"binary_little_endian") => Ok(Encoding::LittleEndian),
        Some(b"binary_big_endian") => Ok(Encoding::BigEndian),
        other => Err(format!(
            "the format is {}, where ascii, binary_little_endian or binary_big_endian is expected",
            shown(other.unwrap_or_default())
        )),
    }
}

fn element<'a>(line: &Line<'a>) -> Result<Element<'a>, String> {
    let mut words = line.words().skip(1);
    let (Some(name), Some(count), None) = (words.next(), words.next(), words.next()) else {
        return Err("an element has a name and a count".to_owned());
    };
    let number = std::str::from_utf8(count).ok().and_then(|count| count.parse().ok());
    let count = number.ok_or_else(|| format!("{} is no count of elements", shown(count)))?;
    Ok(Element { name, count, properties: Vec::new() })
}

fn property<'a>(line: &Line<'a>) -> Result<Property<'a>, String> {
    let words: Vec<_> = line.words().skip(1).take(5).collect();
    let scalar = |name| Scalar::named(name).ok_or_else(|| format!("{} is no type", shown(name)));
    match words[..] {
        [b"list", count, item, name] => {
            let (count, item) = (scalar(count)?, scalar(item)?);
            if matches!(count, Scalar::F32 | Scalar::F64) {
                return Err("the count of a list is no whole number".to_owned());
            }
            Ok(Property { name, kind: Kind::List { count, item } })
        }
        [kind, name] => Ok(Property { name, kind: Kind::One(scalar(kind)?) }),
        _ => Err("a property has a type and a name, or is a list of two types and a name".to_owned()),
    }
}
