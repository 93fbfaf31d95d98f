//! Reads the header of a PLY file: which elements follow, and which properties each has.

use super::textures;
use crate::read_error::{FilePosition, ReadError};
use crate::text_lines::{Line, Lines, first_word, parsed, shown, words};

/// How values are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// Declares the types of numbers by their Rust types, and their names in the original format and in later ones.
macro_rules! scalars {
    ($($name:ident is $kind:ident, $old:literal or $new:literal;)+) => {
        /// The type of a number in a binary file.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Scalar {
            $($name),+
        }

        impl Scalar {
            fn named(name: &[u8]) -> Option<Self> {
                [$(($old, $new, Self::$name)),+].into_iter().find_map(|(old, new, own)| {
                    (name == str::as_bytes(old) || name == str::as_bytes(new)).then_some(own)
                })
            }

            /// Returns the size in bytes.
            pub(super) fn size(self) -> usize {
                match self {
                    $(Self::$name => size_of::<$kind>()),+
                }
            }

            /// Decodes the number at the start of some bytes; none if they are too few.
            pub(super) fn decoded(self, bytes: &[u8], is_big: bool) -> Option<f64> {
                Some(match self {
                    $(Self::$name => {
                        let own = *bytes.first_chunk()?;
                        let number = if is_big { $kind::from_be_bytes(own) } else { $kind::from_le_bytes(own) };
                        number as f64
                    })+
                })
            }
        }
    };
}

// The last two aren't in the original format; some programs write them.
scalars! {
    I8 is i8, "char" or "int8";
    U8 is u8, "uchar" or "uint8";
    I16 is i16, "short" or "int16";
    U16 is u16, "ushort" or "uint16";
    I32 is i32, "int" or "int32";
    U32 is u32, "uint" or "uint32";
    F32 is f32, "float" or "float32";
    F64 is f64, "double" or "float64";
    I64 is i64, "long" or "int64";
    U64 is u64, "ulong" or "uint64";
}

/// A single value, or a list of values after their count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PropertyKind {
    One(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Property<'a> {
    pub name: &'a [u8],
    pub kind: PropertyKind,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element<'a> {
    pub name: &'a [u8],
    pub count: u64,
    pub properties: Vec<Property<'a>>,
}

impl Element<'_> {
    /// Returns the least size of one such element in a binary file, in bytes, with all its lists empty; and whether it
    /// has no lists.
    pub(super) fn least(&self) -> (u64, bool) {
        let size = |property: &Property| match property.kind {
            PropertyKind::One(scalar) | PropertyKind::List { count: scalar, .. } => scalar.size() as u64,
        };
        let fixed = self.properties.iter().all(|property| matches!(property.kind, PropertyKind::One(_)));
        (self.properties.iter().map(size).sum(), fixed)
    }
}

pub(super) struct Header<'a> {
    pub encoding: Encoding,
    pub elements: Vec<Element<'a>>,
    /// The lines after the header.
    pub lines: Lines<'a>,
    /// How many lines of the header aren't part of the format.
    pub other_lines: usize,
    /// The names of images.
    pub images: Vec<&'a [u8]>,
}

/// Reads a header.
///
/// # Errors
/// [`ReadError::Broken`].
pub(super) fn read(bytes: &[u8]) -> Result<Header<'_>, ReadError> {
    // Editors of text add a byte order mark.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let is_ply = bytes.get(..4).is_some_and(|start| start.starts_with(b"ply") && start[3].is_ascii_whitespace());
    if !is_ply {
        return Err(FilePosition::Everywhere.error("it isn't a PLY file: its first line isn't \"ply\""));
    }
    // A binary file may have any bytes after the header, so the header's first line tells how its lines end.
    let of_old_macs = bytes[3] == b'\r' && bytes.get(4) != Some(&b'\n');
    let mut lines = Lines::ending(bytes, if of_old_macs { b'\r' } else { b'\n' });
    let (mut encoding, mut elements, mut other_lines, mut images) = (None, Vec::new(), 0, Vec::new());
    lines.next()?;
    while let Some(line) = lines.next()? {
        let mut words = words(line.text);
        let fault = |reason: String| line.place().error(reason);
        match words.next() {
            None | Some(b"obj_info") => {}
            Some(b"comment") => images.extend(textures::named(first_word(line.text).1)),
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
                return Ok(Header { encoding, elements, lines, other_lines, images });
            }
            Some(_) => other_lines += 1,
        }
    }
    Err(FilePosition::Line(lines.count).error("the file ends within its header"))
}

fn format(word: Option<&[u8]>) -> Result<Encoding, String> {
    match word {
        Some(b"ascii") => Ok(Encoding::Text),
        Some(b"binary_little_endian") => Ok(Encoding::LittleEndian),
        Some(b"binary_big_endian") => Ok(Encoding::BigEndian),
        other => Err(format!(
            "the format is {} instead of ascii, binary_little_endian or binary_big_endian",
            shown(other.unwrap_or_default())
        )),
    }
}

fn element<'a>(line: &Line<'a>) -> Result<Element<'a>, String> {
    let mut words = words(line.text).skip(1);
    let (Some(name), Some(count), None) = (words.next(), words.next(), words.next()) else {
        return Err("an element needs a name and a number".to_owned());
    };
    let count = parsed(count).ok_or_else(|| format!("{} isn't a number of elements", shown(count)))?;
    Ok(Element { name, count, properties: Vec::new() })
}

fn property<'a>(line: &Line<'a>) -> Result<Property<'a>, String> {
    let words: Vec<_> = words(line.text).skip(1).take(5).collect();
    let scalar = |name| Scalar::named(name).ok_or_else(|| format!("{} isn't a type of numbers", shown(name)));
    match words[..] {
        [b"list", count, item, name] => {
            Ok(Property { name, kind: PropertyKind::List { count: scalar(count)?, item: scalar(item)? } })
        }
        [kind, name] => Ok(Property { name, kind: PropertyKind::One(scalar(kind)?) }),
        _ => Err("a property needs a type and a name; a list needs two types and a name".to_owned()),
    }
}
