//! Tessellates a mesh on this program's own device, and draws it in this program's own render pass.
//!
//! `cargo run --no-default-features --example embed [PICTURE.png]`

mod canvas;

use std::error::Error;
use std::f32::consts::TAU;

use canvas::Canvas;
use glam::{Vec3, vec3};
use image::RgbaImage;
use pnaen::embed::{Capacity, Context, OutputStatus, TessellatedMesh};
use pnaen::mesh::{Mesh, MeshSlices, SliceError};
use pnaen::tessellate::{Lod, Tessellation};

/// A torus of 96 triangles, from plain arrays as a game or a modeller has them.
fn torus() -> Result<Mesh, SliceError> {
    let (around, across) = (8, 6);
    let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for (i, j) in (0..around).flat_map(|i| (0..across).map(move |j| (i, j))) {
        let (u, v) = (TAU * i as f32 / around as f32, TAU * j as f32 / across as f32);
        let normal = vec3(u.cos() * v.cos(), v.sin(), u.sin() * v.cos());
        positions.push((vec3(u.cos(), 0.0, u.sin()) + normal * 0.45).to_array());
        normals.push(normal.to_array());
        let vertex = |i: u32, j: u32| (i % around) * across + j % across;
        let [a, b, c, d] = [vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j)];
        indices.extend([a, b, c, a, c, d]);
    }
    Mesh::from_slices(&MeshSlices { positions: &positions, normals: &normals, uvs: &[], indices: &indices })
}

/// Draws the torus with an LOD under which no triangle is farther than `tolerance` px from the curved surface. Returns
/// the picture, the status of the output, and whether the output was too large for `capacity`.
pub fn picture(tolerance: f32, capacity: Capacity) -> Result<(RgbaImage, OutputStatus, bool), Box<dyn Error>> {
    let canvas = Canvas::new([320, 240])?;
    let context = Context::new(&canvas.device, &canvas.queue)?;
    let mut mesh = TessellatedMesh::new(&context, torus()?, capacity)?;

    let view = canvas.look(vec3(0.0, 2.6, 3.2), Vec3::ZERO, 1.45);
    let mut encoder = canvas.device.create_command_encoder(&Default::default());
    mesh.set(&Tessellation { lod: Lod::Error, tolerance, ..Default::default() }, view)?;
    mesh.record(&mut encoder)?;
    canvas.draw(&mut encoder, &mesh)?;
    let (picture, status) = canvas.finish(encoder, &mesh)?;
    Ok((picture, status, mesh.has_overflowed(&status)))
}

#[allow(dead_code, reason = "tests take the picture")]
fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "embed.png".to_owned());
    let (picture, status, has_overflowed) = picture(0.5, Capacity { vertices: 100_000, triangles: 200_000 })?;
    picture.save(&path)?;
    println!("{path}: {} vertices, {} triangles", status.vertices, status.triangles);
    if has_overflowed {
        println!("some patches are missing: the capacity is too small");
    }
    Ok(())
}
