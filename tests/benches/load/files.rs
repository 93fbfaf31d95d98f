//! Writes a wavy torus in each format. Its triangles share their vertices, except in STL; only the GLB file has normals.

use std::f64::consts::TAU;
use std::fs::File;
use std::io::{BufWriter, Result, Write};
use std::path::Path;

use glam::{DVec3, Vec3};

/// Writes a torus of so many quads along each direction to a file.
type WriteMesh = fn(&Path, u32) -> Result<()>;

/// The names of the files, and what writes each.
pub(crate) const FORMATS: [(&str, WriteMesh); 4] =
    [("mesh.stl", write_stl), ("mesh.ply", write_ply), ("mesh.glb", write_glb), ("mesh.obj", write_obj)];

/// A position on the torus; a full turn in each direction is `TAU`.
fn place(u: f64, v: f64) -> DVec3 {
    let radius = 0.4 * (1.0 + 0.1 * (7.0 * u).sin() * (9.0 * v).sin() + 0.01 * (93.0 * u + 51.0 * v).sin());
    let out = DVec3::new(u.cos(), u.sin(), 0.0);
    100.0 * (out * (1.0 + radius * v.cos()) + DVec3::Z * (radius * v.sin()))
}

/// Returns for each vertex what `of` makes of its two angles, in rad.
fn each<T>(side: u32, of: impl Fn(f64, f64) -> T) -> impl Iterator<Item = T> {
    let angle = move |i: u32| f64::from(i) / f64::from(side) * TAU;
    (0..side * side).map(move |i| of(angle(i / side), angle(i % side)))
}

fn positions(side: u32) -> impl Iterator<Item = Vec3> {
    each(side, |u, v| place(u, v).as_vec3())
}

/// The normals, by central differences.
fn normals(side: u32) -> impl Iterator<Item = Vec3> {
    let normal = |u: f64, v: f64| {
        let step = 1e-5;
        let along = place(u + step, v) - place(u - step, v);
        along.cross(place(u, v + step) - place(u, v - step)).normalize().as_vec3()
    };
    each(side, normal)
}

fn triangles(side: u32) -> impl Iterator<Item = [u32; 3]> {
    (0..side * side).flat_map(move |i| {
        let (row, next_row) = (i / side * side, (i / side + 1) % side * side);
        let (column, next) = (i % side, (i % side + 1) % side);
        let [a, b, c, d] = [row + column, next_row + column, next_row + next, row + next];
        [[a, b, c], [a, c, d]]
    })
}

fn write_stl(path: &Path, side: u32) -> Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    let points: Vec<Vec3> = positions(side).collect();
    file.write_all(&[0; 80])?;
    file.write_all(&(2 * side * side).to_le_bytes())?;
    for triangle in triangles(side) {
        let corners = triangle.map(|point| points[point as usize].to_array());
        file.write_all(&[0; 12])?;
        file.write_all(bytemuck::cast_slice(corners.as_flattened()))?;
        file.write_all(&[0; 2])?;
    }
    file.flush()
}

fn write_ply(path: &Path, side: u32) -> Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    let (vertices, faces) = (side * side, 2 * side * side);
    write!(file, "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\n")?;
    write!(file, "property float x\nproperty float y\nproperty float z\nelement face {faces}\n")?;
    write!(file, "property list uchar int vertex_indices\nend_header\n")?;
    for position in positions(side) {
        file.write_all(bytemuck::bytes_of(&position))?;
    }
    for triangle in triangles(side) {
        file.write_all(&[3])?;
        file.write_all(bytemuck::bytes_of(&triangle))?;
    }
    file.flush()
}

fn write_glb(path: &Path, side: u32) -> Result<()> {
    let mut bin = Vec::new();
    triangles(side).for_each(|triangle| bin.extend_from_slice(bytemuck::bytes_of(&triangle)));
    let at = bin.len();
    positions(side).chain(normals(side)).for_each(|vector| bin.extend_from_slice(bytemuck::bytes_of(&vector)));
    let bytes = (bin.len() - at) / 2;
    let view = |offset, length| serde_json::json!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
    let accessor = |view, component, count, kind| serde_json::json!({ "bufferView": view, "componentType": component, "count": count, "type": kind });
    let (least, most) = positions(side)
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(least, most), point| (least.min(point), most.max(point)));
    let mut positions = accessor(1, 5126, side * side, "VEC3");
    positions["min"] = serde_json::json!(least.to_array());
    positions["max"] = serde_json::json!(most.to_array());
    let root = serde_json::json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 1, "NORMAL": 2 }, "indices": 0 }] }],
        "accessors": [accessor(0, 5125, 6 * side * side, "SCALAR"), positions, accessor(2, 5126, side * side, "VEC3")],
        "bufferViews": [view(0, at), view(at, bytes), view(at + bytes, bytes)],
        "buffers": [{ "byteLength": bin.len() }],
    });
    let mut json = root.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut file = BufWriter::new(File::create(path)?);
    let number = |number: usize| (number as u32).to_le_bytes();
    file.write_all(b"glTF\x02\0\0\0")?;
    file.write_all(&number(28 + json.len() + bin.len()))?;
    file.write_all(&number(json.len()))?;
    file.write_all(b"JSON")?;
    file.write_all(&json)?;
    file.write_all(&number(bin.len()))?;
    file.write_all(b"BIN\0")?;
    file.write_all(&bin)?;
    file.flush()
}

fn write_obj(path: &Path, side: u32) -> Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    for position in positions(side) {
        writeln!(file, "v {:.6} {:.6} {:.6}", position.x, position.y, position.z)?;
    }
    for [a, b, c] in triangles(side) {
        writeln!(file, "f {} {} {}", a + 1, b + 1, c + 1)?;
    }
    file.flush()
}
