//! Primitives that are compressed with Draco: how much memory the decoder takes, which can't be limited, but is estimated before.

use std::sync::PoisonError;

use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, GeometryAttributeType as Kind, Mesh, MeshEncoder, PointAttribute,
};
use inspect::engine::Preparation;
use load::Limits;
use serde_json::json;

use super::bounded::loaded;
use super::grid::Grid;
use super::{ALONE, bomb, glb, measured, taken, temporary};

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

/// A mesh as Draco data, with the encoder at a speed of 0 to 10.
fn compressed(mesh: Mesh, mut options: EncoderOptions, speed: i32) -> Vec<u8> {
    options.set_global_int("encoding_speed", speed);
    options.set_global_int("decoding_speed", speed);
    let (mut encoder, mut bytes) = (MeshEncoder::new(), EncoderBuffer::new());
    encoder.set_mesh(mesh);
    encoder.encode(&options, &mut bytes).expect("a mesh that can be compressed");
    bytes.data().to_vec()
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
    let (vertices, count) = (mesh.num_points(), mesh.num_faces());
    let bytes = compressed(mesh, options, speed);
    document(vertices, count, others, &bytes)
}

/// A wavy sheet as a scanner writes it, with normals and texture coordinates, of which another piece begins after so many rows and
/// columns of squares; none has no seams.
fn scan(grid: Grid, piece: Option<usize>, speed: i32) -> Vec<u8> {
    scan_of(grid, piece, speed, None)
}

/// The same, whose accessors may say another number of vertices than there are.
fn scan_of(grid: Grid, piece: Option<usize>, speed: i32, said: Option<usize>) -> Vec<u8> {
    let corners: Vec<usize> = grid.triangles().flatten().collect();
    let (mut mesh, mut options) = (Mesh::new(), EncoderOptions::new());
    mesh.set_num_points(corners.len());
    let mut add = |kind: Kind, width: u8, bits: i32, value: &dyn Fn(usize, usize) -> [f32; 3]| {
        let mut attribute = PointAttribute::new();
        attribute.init(kind, width, DataType::Float32, false, corners.len());
        let numbers =
            corners.iter().enumerate().flat_map(|(i, vertex)| value(i / 6, *vertex).into_iter().take(width.into()));
        attribute.buffer_mut().write(0, &numbers.flat_map(f32::to_le_bytes).collect::<Vec<u8>>());
        let id = mesh.add_attribute(attribute);
        options.set_attribute_quantization(id, bits);
    };
    let at = |vertex: usize| [(vertex % grid.side) as f32, (vertex / grid.side) as f32];
    let height = |[x, y]: [f32; 2]| (x * 0.3).sin() + (y * 0.17).cos();
    add(Kind::Position, 3, 14, &|_, vertex| [at(vertex)[0], at(vertex)[1], height(at(vertex))]);
    add(Kind::Normal, 3, 10, &|_, vertex| {
        let [x, y] = at(vertex);
        let slope = [-0.3 * (x * 0.3).cos(), 0.17 * (y * 0.17).sin()];
        let length = (slope[0] * slope[0] + slope[1] * slope[1] + 1.0).sqrt();
        [slope[0] / length, slope[1] / length, 1.0 / length]
    });
    add(Kind::TexCoord, 2, 12, &|square, vertex| {
        let of_piece = |square: usize| piece.map_or(0.0, |piece| ((square / piece) % 2) as f32 * 0.5);
        let [u, v] = at(vertex).map(|x| x / (2 * grid.side) as f32);
        [u + of_piece(square % (grid.side - 1)), v + of_piece(square / (grid.side - 1)), 0.0]
    });
    mesh.try_set_num_faces(corners.len() / 3).expect("memory for triangles");
    (0..corners.len() / 3).for_each(|i| mesh.set_face_from_indices(i, [0, 1, 2].map(|k| (3 * i + k) as u32)));
    mesh.deduplicate_attribute_values().expect("attributes that can be compared");
    mesh.deduplicate_point_ids();
    let (vertices, count) = (mesh.num_points(), mesh.num_faces());
    let bytes = compressed(mesh, options, speed);
    document(said.unwrap_or(vertices), count, &[("NORMAL".to_owned(), 3), ("TEXCOORD_0".to_owned(), 2)], &bytes)
}

#[test]
fn files_from_an_encoder_fit() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let others = |count: usize, width: u8| (0..count).map(|i| (format!("TEXCOORD_{i}"), width)).collect::<Vec<_>>();
    for speed in [0, 5, 10] {
        for (count, width, apart) in [(0, 2, false), (1, 2, false), (2, 2, true), (12, 2, true), (20, 2, false)] {
            let grid = Grid::new(if count > 10 { 6_000 } else { 20_000 }, 0.0);
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

/// A scan of two million triangles is read within the default limit, with seams along every twentieth edge.
#[test]
fn scans_are_read_within_the_default_limit() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let triangles = std::env::var("PNAEN_TRIANGLES").ok().and_then(|count| count.parse().ok()).unwrap_or(2_000_000);
    let grid = Grid::new(triangles, 0.0);
    let bytes = scan(grid, Some(20), 5);
    let file = temporary("packed-scan.glb", &bytes);
    let memory = Limits::default().memory;
    let (result, took) = loaded(&file, &Preparation::default(), memory);
    println!("packed-scan: {} bytes of file, {} MiB taken", bytes.len(), took >> 20);
    assert!(took <= 4 * bytes.len() + memory as usize, "{took}");
    assert_eq!(result.expect("a file without a fault").read.triangles.len(), grid.triangle_count());
}

/// Returns the least limit under which a file isn't refused for its memory, in bytes, how much memory it takes then, and whether it is
/// read. A refusal says which limit would have been enough.
fn least_limit(name: &str, bytes: &[u8]) -> (usize, usize, bool) {
    let file = temporary(name, bytes);
    let mut limit = 1 << 20;
    loop {
        let allowed = limit as usize + 4 * bytes.len();
        let (result, took) = loaded(&file, &Preparation::default(), limit);
        match result {
            Ok(_) => return (allowed, took, true),
            Err(refused) => {
                let said = refused.to_string();
                if !said.contains("--max-memory") {
                    return (allowed, took, false);
                }
                let number = |before: &str, after: &str| -> Option<u64> {
                    said.split_once(before).and_then(|(_, rest)| rest.split_once(after)?.0.parse().ok())
                };
                let of_option = number("(--max-memory ", "MiB allows it)").map(|option| option << 20);
                // What follows needs more than decompressing, if anything.
                let of_others = number("at least ", " MiB").map(|needed| (needed << 20) - 4 * bytes.len() as u64);
                let next = of_option.or(of_others).expect("a number of MiB");
                assert!(next > limit, "{said}");
                limit = next;
            }
        }
    }
}

/// A file takes no more than what it would be refused for, and half of it at least if it is as programs write them. The most that any
/// data of this size can take is further from what flat sheets take, which compress best.
#[test]
fn what_is_said_to_be_needed_is_taken_at_most() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let check = |name: &str, bytes: &[u8], most: f64| {
        let (allowed, took, is_read) = least_limit("packed-least.glb", bytes);
        assert!(is_read, "{name}");
        let ratio = allowed as f64 / took as f64;
        println!("packed-least, {name}: {} MiB needed, {} taken, {ratio:.2} times", allowed >> 20, took >> 20);
        assert!(took <= allowed, "{name}: {took} of {allowed} bytes");
        assert!(ratio <= most, "{name}: {allowed} bytes for {took}");
    };
    for (speed, others) in [(5, 0), (5, 1), (0, 1), (10, 1)] {
        let others = vec![("TEXCOORD_0".to_owned(), 2); others];
        let bytes = sheet(Grid::new(200_000, 0.0), &others, false, speed);
        check(&format!("a flat sheet at speed {speed}"), &bytes, 2.0);
    }
    for (speed, piece) in [(0, Some(20)), (5, Some(20)), (10, Some(20)), (0, None), (5, None), (7, Some(1)), (10, None)]
    {
        let bytes = scan(Grid::new(200_000, 0.0), piece, speed);
        check(&format!("a scan in pieces of {piece:?} squares at speed {speed}"), &bytes, 1.75);
    }
}

/// Accessors that say that there are few vertices don't make the decoder take more than was allowed: seams make many more points than
/// they say, which is noticed once the connectivity is decoded.
#[test]
fn seams_that_the_accessors_know_nothing_of_are_counted() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    for (speed, piece, vertices) in [(5, Some(1), 10_000), (0, Some(1), 10_000), (5, Some(1), 1), (0, Some(2), 100)] {
        let bytes = scan_of(Grid::new(200_000, 0.0), piece, speed, Some(vertices));
        let (allowed, took, is_read) = least_limit("packed-few.glb", &bytes);
        println!("packed-few, speed {speed}: {} MiB allowed, {} taken", allowed >> 20, took >> 20);
        assert!(!is_read && took <= allowed, "speed {speed}: {took} of {allowed} bytes");
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
    let (mesh, took) = bomb("packed-largest-whole-table.glb", whole(512 << 10));
    assert!(mesh.is_err() && took > 700 << 20, "{took}");
    for (name, bytes) in
        [("packed-larger", table(2 << 20, 1 << 26, &vec![0; 1 << 20])), ("packed-whole", whole(1 << 20))]
    {
        let (mesh, took) = measured(name, bytes);
        let said = mesh.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(took < 8 && said.contains("MiB of memory, but files of this size may take only"), "{took} MiB: {said}");
    }
}
