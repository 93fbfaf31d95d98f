//! Animates a skinned mesh, and changes how it is tessellated at the same time.
//!
//! `cargo run --no-default-features --features formats --example animate [PICTURE.png]` draws six moments side by side:
//! a tube bends, and its tessellation factor grows from 1 to 6. Between the moments only the pose and the settings are
//! uploaded.

mod canvas;

use std::error::Error;
use std::path::Path;

use canvas::Canvas;
use glam::vec3;
use image::RgbaImage;
use pnaen::embed::{Capacity, Context, TessellatedMesh};
use pnaen::load::{Limits, load};
use pnaen::mesh::Moment;
use pnaen::progress::Progress;
use pnaen::tessellate::{Partitioning, Tessellation};

/// Width and height of each picture, in px.
const SIZE: [u32; 2] = [192, 224];
/// The number of moments that are drawn.
pub const MOMENTS: u32 = 6;

/// Draws the moments. Returns the picture of each, and its number of triangles.
pub fn frames() -> Result<Vec<(RgbaImage, u32)>, Box<dyn Error>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/tube.gltf");
    let tube = load(&file, &Limits::default(), &Progress::new())?.mesh;
    let rig = tube.rig.clone().ok_or("the tube has no rig")?;

    let canvas = Canvas::new(SIZE)?;
    let context = Context::new(&canvas.device, &canvas.queue)?;
    let mut mesh = TessellatedMesh::new(&context, tube, Capacity { vertices: 20_000, triangles: 40_000 })?;
    let mut frames = Vec::new();
    for moment in 0..MOMENTS {
        let part = f64::from(moment) / f64::from(MOMENTS - 1);
        let factor = 1.0 + 5.0 * part as f32;
        let tessellation = Tessellation { factor, partitioning: Partitioning::FractionalOdd, ..Default::default() };
        let view = canvas.look(vec3(0.0, 2.2, 4.8), vec3(0.0, 1.45, 0.0), 1.6);
        mesh.set_pose(Some(rig.pose(Moment { clip: 0, time: part * rig.clips[0].duration * 0.8 })))?;
        mesh.set(&tessellation, view)?;

        let mut encoder = canvas.device.create_command_encoder(&Default::default());
        mesh.record(&mut encoder)?;
        canvas.draw(&mut encoder, &mesh)?;
        let (picture, status) = canvas.finish(encoder, &mesh)?;
        frames.push((picture, status.triangles));
    }
    Ok(frames)
}

#[allow(dead_code, reason = "tests take the pictures")]
fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "animate.png".to_owned());
    let mut strip = RgbaImage::new(SIZE[0] * MOMENTS, SIZE[1]);
    for (moment, (picture, triangles)) in (0..).zip(frames()?) {
        image::imageops::replace(&mut strip, &picture, i64::from(SIZE[0]) * moment, 0);
        println!("moment {moment}: {triangles} triangles");
    }
    strip.save(&path)?;
    println!("{path}");
    Ok(())
}
