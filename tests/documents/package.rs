//! Zip archives, and 3MF packages with a model.

use std::io::Write;

use flate2::write::DeflateEncoder;
use flate2::{Compression, Crc};

/// The namespaces that a model declares.
pub const NAMESPACES: &str = "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
     xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\" \
     xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"";

/// Where the model is.
pub const MODEL: &str = "3D/3dmodel.model";

/// A file in an archive.
pub struct Entry<'a> {
    pub name: &'a str,
    pub method: u16,
    /// Its bytes in the archive.
    pub packed: Vec<u8>,
    pub crc: u32,
    /// How many bytes it is said to unpack to.
    pub unpacked: u32,
}

impl<'a> Entry<'a> {
    pub fn stored(name: &'a str, bytes: &[u8]) -> Self {
        let mut crc = Crc::new();
        crc.update(bytes);
        Self { name, method: 0, packed: bytes.to_vec(), crc: crc.sum(), unpacked: bytes.len() as u32 }
    }

    pub fn deflated(name: &'a str, bytes: &[u8]) -> Self {
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(bytes).expect("memory takes what is written");
        Self { method: 8, packed: encoder.finish().expect("memory takes what is written"), ..Self::stored(name, bytes) }
    }
}

/// Writes an archive: each file behind its header, then the directory.
pub fn zip(entries: &[Entry]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for entry in entries {
        let sizes = [entry.crc, entry.packed.len() as u32, entry.unpacked].map(u32::to_le_bytes).concat();
        let name = entry.name.len() as u16;
        let both =
            [&[20, 0, 0, 0][..], &entry.method.to_le_bytes(), &[0; 4], &sizes, &name.to_le_bytes(), &[0; 2]].concat();
        directory.extend([&b"PK\x01\x02\x14\0"[..], &both, &[0; 10]].concat());
        directory.extend((bytes.len() as u32).to_le_bytes());
        directory.extend(entry.name.as_bytes());
        bytes.extend([&b"PK\x03\x04"[..], &both, entry.name.as_bytes(), &entry.packed].concat());
    }
    let [start, length] = [bytes.len(), directory.len()].map(|number| (number as u32).to_le_bytes());
    let count = (entries.len().min(0xffff) as u16).to_le_bytes();
    bytes.extend(directory);
    bytes.extend([&b"PK\x05\x06\0\0\0\0"[..], &count, &count, &length, &start, &[0; 2]].concat());
    bytes
}

/// The part that says which part is the model.
pub fn relationships() -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\
         <Relationship Id=\"r\" Target=\"/{MODEL}\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>\
         </Relationships>"
    )
}

/// A package whose model is this text.
pub fn package(model: &str) -> Vec<u8> {
    zip(&[Entry::stored("_rels/.rels", relationships().as_bytes()), Entry::stored(MODEL, model.as_bytes())])
}

/// A model with these resources and this build. The unit is the metre.
pub fn model(resources: &str, build: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"meter\" {NAMESPACES}><resources>{resources}</resources>\
         <build>{build}</build></model>"
    )
}

/// An element with a mesh of vertices and triangles.
pub fn mesh(vertices: impl IntoIterator<Item = [f32; 3]>, triangles: impl IntoIterator<Item = [usize; 3]>) -> String {
    let vertices: String =
        vertices.into_iter().map(|[x, y, z]| format!("<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>")).collect();
    let triangles: String =
        triangles.into_iter().map(|[a, b, c]| format!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>")).collect();
    format!("<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>")
}
