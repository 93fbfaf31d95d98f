//! Writes FBX files for tests, as text and as binary, from one tree of entries.

use std::fmt::Write;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;

/// The version of all files.
const VERSION: u32 = 7400;

/// An entry of a file.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub name: String,
    pub values: Vec<Value>,
    pub children: Vec<Entry>,
}

/// A value of an entry.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Int(i64),
    Real(f64),
    /// Names of objects are `Class::Name`, as in text files.
    Text(String),
    Ints(Vec<i32>),
    Longs(Vec<i64>),
    Reals(Vec<f64>),
    Bytes(Vec<u8>),
}

/// How the arrays of a binary file are stored.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Arrays {
    Plain,
    /// In a zlib stream, whose blocks aren't compressed.
    Zlib,
}

impl From<i64> for Value {
    fn from(value: i64) -> Self {
        Self::Int(value)
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self::Real(value)
    }
}

impl From<&str> for Value {
    fn from(value: &str) -> Self {
        Self::Text(value.to_owned())
    }
}

impl From<Vec<i32>> for Value {
    fn from(value: Vec<i32>) -> Self {
        Self::Ints(value)
    }
}

impl From<Vec<i64>> for Value {
    fn from(value: Vec<i64>) -> Self {
        Self::Longs(value)
    }
}

impl From<Vec<f64>> for Value {
    fn from(value: Vec<f64>) -> Self {
        Self::Reals(value)
    }
}

/// An entry with values.
pub(crate) fn entry(name: &str, values: Vec<Value>) -> Entry {
    Entry { name: name.to_owned(), values, children: Vec::new() }
}

/// An entry with one value.
pub(crate) fn one(name: &str, value: impl Into<Value>) -> Entry {
    entry(name, vec![value.into()])
}

/// An entry with children.
pub(crate) fn list(name: &str, children: Vec<Entry>) -> Entry {
    Entry { name: name.to_owned(), values: Vec::new(), children }
}

/// An object: its class in the file, its number, its name with the class of names, and its kind.
pub(crate) fn object(class: &str, id: i64, name: &str, kind: &str, children: Vec<Entry>) -> Entry {
    Entry { name: class.to_owned(), values: vec![id.into(), name.into(), kind.into()], children }
}

/// Properties of an object: name, type and values.
pub(crate) fn properties(all: &[(&str, &str, &[f64])]) -> Entry {
    let each = |&(name, kind, values): &(&str, &str, &[f64])| {
        let mut all: Vec<Value> = vec![name.into(), kind.into(), "".into(), "A".into()];
        all.extend(values.iter().map(|&value| match kind {
            "int" | "bool" | "enum" => Value::Int(value as i64),
            _ => Value::Real(value),
        }));
        entry("P", all)
    };
    list("Properties70", all.iter().map(each).collect())
}

/// A file as text.
pub(crate) fn text(entries: &[Entry]) -> Vec<u8> {
    let mut text = format!("; FBX {}.{}.0 project file\n", VERSION / 1000, VERSION / 100 % 10);
    entries.iter().for_each(|entry| write_text(entry, 0, &mut text));
    text.into_bytes()
}

fn write_text(entry: &Entry, depth: usize, text: &mut String) {
    let indent = "\t".repeat(depth);
    let array = |numbers: Vec<String>| format!("*{} {{ a: {} }}", numbers.len(), numbers.join(","));
    let values = entry.values.iter().map(|value| match value {
        Value::Int(value) => value.to_string(),
        Value::Real(value) => format!("{value:?}"),
        Value::Text(value) => format!("\"{value}\""),
        Value::Ints(values) => array(values.iter().map(i32::to_string).collect()),
        Value::Longs(values) => array(values.iter().map(i64::to_string).collect()),
        Value::Reals(values) => array(values.iter().map(|value| format!("{value:?}")).collect()),
        Value::Bytes(bytes) => format!(", \"{}\"", BASE64_STANDARD.encode(bytes)),
    });
    let values: Vec<String> = values.collect();
    let _ = write!(text, "{indent}{}: {}", entry.name, values.join(", "));
    if !entry.children.is_empty() {
        text.push_str(" {\n");
        entry.children.iter().for_each(|child| write_text(child, depth + 1, text));
        text.push_str(&indent);
        text.push('}');
    }
    text.push('\n');
}

/// A file as binary.
pub(crate) fn binary(entries: &[Entry], arrays: Arrays) -> Vec<u8> {
    let mut bytes = b"Kaydara FBX Binary  \0\x1a\0".to_vec();
    bytes.extend(VERSION.to_le_bytes());
    entries.iter().for_each(|entry| write_binary(entry, arrays, &mut bytes));
    bytes.extend([0; 13]);
    bytes
}

fn write_binary(entry: &Entry, arrays: Arrays, bytes: &mut Vec<u8>) {
    let start = bytes.len();
    bytes.extend([0; 12]);
    bytes.push(entry.name.len() as u8);
    bytes.extend(entry.name.as_bytes());
    let values = bytes.len();
    entry.values.iter().for_each(|value| write_value(value, arrays, bytes));
    let length = bytes.len() - values;
    if !entry.children.is_empty() {
        entry.children.iter().for_each(|child| write_binary(child, arrays, bytes));
        bytes.extend([0; 13]);
    }
    let header = [bytes.len(), entry.values.len(), length].map(|number| (number as u32).to_le_bytes());
    bytes[start..start + 12].copy_from_slice(header.as_flattened());
}

fn write_value(value: &Value, arrays: Arrays, bytes: &mut Vec<u8>) {
    let mut array = |kind: u8, count: usize, content: Vec<u8>| {
        let stored = if arrays == Arrays::Zlib { zlib_stored(&content) } else { content };
        bytes.push(kind);
        for number in [count, usize::from(arrays == Arrays::Zlib), stored.len()] {
            bytes.extend((number as u32).to_le_bytes());
        }
        bytes.extend(stored);
    };
    match value {
        Value::Ints(values) => array(b'i', values.len(), values.iter().flat_map(|x| x.to_le_bytes()).collect()),
        Value::Longs(values) => array(b'l', values.len(), values.iter().flat_map(|x| x.to_le_bytes()).collect()),
        Value::Reals(values) => array(b'd', values.len(), values.iter().flat_map(|x| x.to_le_bytes()).collect()),
        Value::Int(value) => {
            bytes.push(b'L');
            bytes.extend(value.to_le_bytes());
        }
        Value::Real(value) => {
            bytes.push(b'D');
            bytes.extend(value.to_le_bytes());
        }
        Value::Text(value) => {
            let stored = match value.split_once("::") {
                Some((class, name)) => format!("{name}\0\x01{class}"),
                None => value.clone(),
            };
            write_blob(b'S', stored.as_bytes(), bytes);
        }
        Value::Bytes(value) => write_blob(b'R', value, bytes),
    }
}

fn write_blob(kind: u8, content: &[u8], bytes: &mut Vec<u8>) {
    bytes.push(kind);
    bytes.extend((content.len() as u32).to_le_bytes());
    bytes.extend(content);
}

/// A zlib stream of blocks that aren't compressed (RFC 1950 and RFC 1951, section 3.2.4).
fn zlib_stored(content: &[u8]) -> Vec<u8> {
    let mut stream = vec![0x78, 0x01];
    let blocks = content.chunks(0xffff).collect::<Vec<_>>();
    for (i, block) in blocks.iter().enumerate() {
        stream.push(u8::from(i + 1 == blocks.len()));
        let length = block.len() as u16;
        stream.extend(length.to_le_bytes());
        stream.extend((!length).to_le_bytes());
        stream.extend(*block);
    }
    stream.extend(adler32(content.iter().copied()).to_be_bytes());
    stream
}

fn adler32(bytes: impl Iterator<Item = u8>) -> u32 {
    let (mut a, mut b) = (1_u32, 0_u32);
    for byte in bytes {
        a = (a + u32::from(byte)) % 65521;
        b = (b + a) % 65521;
    }
    b << 16 | a
}
