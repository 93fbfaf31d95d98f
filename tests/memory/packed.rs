//! Primitives that are compressed with Draco: how much memory the decoder takes, which can't be limited.

use std::sync::PoisonError;

use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, GeometryAttributeType as Kind, Mesh, MeshEncoder, PointAttribute,
};
use pnaen::internals::Preparation;
use pnaen::load::Limits;
use serde_json::json;

use super::bounded::loaded;
use super::grid::Grid;
use super::{ALONE, glb, measured, taken, temporary};

/// A primitive with positions and other attributes, given by names, types and widths; `from` is the buffer.
fn document(vertices: usize, triangles: usize, others: &[(String, u8)], from: &[u8]) -> Vec<u8> {
    let accessor = |width: u8| {
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][usize::from(width) - 1];
        json!({ "componentType": 5126, "type": kind, "count": vertices })
    };
    let named = [("POSITION".to_owned(), 3)].into_iter().chain(others.iter().cloned());
    let indices = json!({ "componentType": 5125, "type": "SCALAR", "count": 3 * triangles });
    let places: serde_json::Map<_, _> = named.clone().enumerate().map(|(i, (name, _))| (name, json!(i))).collect();
    let accessors: Vec<_> = named.map(|(_, width)| accessor(width)).chain([indices]).collect();
    let extension = json!({ "bufferView": 0, "attributes": places });
    let root = json!({
        "asset": { "version": "2.0" },
        "extensionsRequired": ["KHR_draco_mesh_compression"],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{
            "attributes": places, "indices": accessors.len() - 1,
            "extensions": { "KHR_draco_mesh_compression": extension },
        }] }],
        "accessors": accessors,
        "bufferViews": [{ "buffer": 0, "byteLength": from.len() }],
        "buffers": [{ "byteLength": from.len() }],
    });
    glb(&root, from)
}

/// A sheet with or without common corners. The more attributes it has, the more neighbours of its edges are in memory
/// at once.
fn sheet(grid: Grid, others: &[(String, u8)], apart: bool, speed: i32) -> Vec<u8> {
    let order: Vec<usize> =
        if apart { grid.triangles().flatten().collect() } else { (0..grid.side * grid.rows).collect() };
    let (mut mesh, mut options) = (Mesh::new(), EncoderOptions::new());
    mesh.set_num_points(order.len());
    let mut add = |kind: Kind, width: u8, value: &dyn Fn(usize, usize) -> f32| {
        let mut attribute = PointAttribute::new();
        attribute.init(kind, width, DataType::Float32, false, order.len());
        let numbers = order.iter().enumerate().flat_map(|(i, _)| (0..usize::from(width)).map(move |k| (i, k)));
        let bytes: Vec<u8> = numbers.flat_map(|(i, k)| value(i, k).to_le_bytes()).collect();
        attribute.buffer_mut().write(0, &bytes);
        let id = mesh.add_attribute(attribute);
        options.set_attribute_quantization(id, 11);
    };
    add(Kind::Position, 3, &|i, k| grid.position(order[i])[k]);
    for (_, width) in others {
        add(Kind::Generic, *width, &|i, k| if apart { (i % 2000) as f32 } else { k as f32 });
    }
    let triangles: Vec<[u32; 3]> = match apart {
        true => (0..grid.triangle_count() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        false => grid.triangles().map(|triangle| triangle.map(|i| i as u32)).collect(),
    };
    mesh.try_set_num_faces(triangles.len()).expect("memory for triangles");
    triangles.iter().enumerate().for_each(|(i, triangle)| mesh.set_face_from_indices(i, *triangle));
    if apart {
        mesh.deduplicate_attribute_values().expect("attributes that can be compared");
        mesh.deduplicate_point_ids();
    }
    options.set_global_int("encoding_speed", speed);
    options.set_global_int("decoding_speed", speed);
    let (vertices, count) = (mesh.num_points(), mesh.num_faces());
    let (mut encoder, mut bytes) = (MeshEncoder::new(), EncoderBuffer::new());
    encoder.set_mesh(mesh);
    encoder.encode(&options, &mut bytes).expect("a mesh that can be compressed");
    document(vertices, count, others, bytes.data())
}

#[test]
fn files_from_an_encoder_fit() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let others = |count: usize, width: u8| (0..count).map(|i| (format!("TEXCOORD_{i}"), width)).collect::<Vec<_>>();
    for speed in [0, 5, 10] {
        for (count, width, apart) in [(0, 2, false), (1, 2, false), (2, 2, true), (12, 2, true), (20, 2, false)] {
            let grid = Grid::of(if count > 10 { 6_000 } else { 20_000 }, 0.0);
            let bytes = sheet(grid, &others(count, width), apart, speed);
            let size = bytes.len();
            let (mesh, took) = taken(&format!("packed-{count}-{speed}.glb"), bytes);
            println!(
                "    {} bytes of file, {} taken a triangle",
                size / grid.triangle_count(),
                took / grid.triangle_count()
            );
            assert_eq!(mesh.expect("a file without a fault").mesh.triangles.len(), grid.triangle_count());
        }
    }
}

/// A scan is read within the default limit. A file is refused for the memory that decoding might take, not for what it does
/// take.
#[test]
fn scans_are_read_and_larger_files_with_more_memory() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let grid = Grid::of(500_000, 0.0);
    let bytes = sheet(grid, &[("TEXCOORD_0".to_owned(), 2)], false, 5);
    let file = temporary("packed-trusted.glb", &bytes);
    let said = loaded(&file, &Preparation::default(), 100 << 20).0.map(|_| ()).expect_err("too much");
    assert!(said.to_string().contains("(--max-memory allows more); decompress the model first"), "{said}");
    let memory = Limits::default().memory;
    let (result, took) = loaded(&file, &Preparation::default(), memory);
    println!("packed-trusted: {} bytes of file, {} MiB taken", bytes.len(), took >> 20);
    assert!(took <= 4 * bytes.len() + memory as usize, "{took}");
    assert_eq!(result.expect("a file without a fault").mesh.triangles.len(), grid.triangle_count());
}

/// Returns the least limit under which a file can be read, in bytes, and how much memory that takes. A refusal says how much
/// it lacks.
fn least_limit(name: &str, bytes: &[u8]) -> (usize, usize) {
    let file = temporary(name, bytes);
    let mut limit = 1 << 20;
    loop {
        let allowed = limit as usize + 4 * bytes.len();
        let (result, took) = loaded(&file, &Preparation::default(), limit);
        match result {
            Ok(_) => return (allowed, took),
            Err(refused) => {
                let said = refused.to_string();
                let needed = said.split_once("at least ").and_then(|(_, rest)| rest.split_once(" MiB"));
                let needed: usize = needed.and_then(|(number, _)| number.parse().ok()).expect("a number of MiB");
                assert!(needed << 20 > allowed, "{said}");
                limit = ((needed << 20) - 4 * bytes.len()) as u64;
            }
        }
    }
}

/// A file takes no more than what it would be refused for. That is the most which any data of this size can take; a flat sheet, which
/// compresses best, takes an eighth of it at least.
#[test]
fn what_is_said_to_be_needed_is_taken_at_most() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    for (speed, others) in [(5, 0), (5, 1), (0, 1), (10, 1)] {
        let others = vec![("TEXCOORD_0".to_owned(), 2); others];
        let bytes = sheet(Grid::of(200_000, 0.0), &others, false, speed);
        let (allowed, took) = least_limit("packed-least.glb", &bytes);
        println!("packed-least, speed {speed}: {} MiB needed, {} taken", allowed >> 20, took >> 20);
        assert!(took <= allowed, "speed {speed}: {took} of {allowed} bytes");
        assert!(allowed <= 8 * took, "speed {speed}: {allowed} bytes for {took}");
    }
}

/// The indices of one triangle, encoded with a table of as many symbols as its bytes can name, followed by `rest`.
fn table(length: usize, symbols: usize, rest: &[u8]) -> Vec<u8> {
    let mut bytes = b"DRACO\x02\x02\x01\0\0\0\x01\x03\0\x01\x01".to_vec();
    let mut left = symbols;
    while left > 127 {
        bytes.push(left as u8 | 128);
        left >>= 7;
    }
    bytes.push(left as u8);
    bytes.extend(rest);
    bytes.resize(length, 0xff);
    document(3, 1, &[], &bytes)
}

#[test]
fn tables_that_take_most_memory_are_counted() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    // A table that ends too early. It counts as a complete one, which takes three times as much.
    let length = 160 << 10;
    let (mesh, took) = measured("packed-table", table(length, (length - 64) * 64, &vec![0; length - 32]));
    assert!(mesh.is_err() && (70..256).contains(&took), "{took} MiB");
    // A complete table: the first symbol has the whole probability of 2^12, and all others have none.
    let whole = |length: usize| table(length, (length - 64) * 64 + 1, &[2, 64, 0]);
    let (mesh, took) = measured("packed-whole-table", whole(160 << 10));
    assert!(mesh.is_err() && (200..256).contains(&took), "{took} MiB");
    for (name, bytes) in
        [("packed-larger", table(1 << 20, 1 << 25, &vec![0; 1 << 20 >> 1])), ("packed-whole", whole(256 << 10))]
    {
        let (mesh, took) = measured(name, bytes);
        let said = mesh.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(took < 8 && said.contains("MiB of memory, but files of this size may take only"), "{took} MiB: {said}");
    }
}
