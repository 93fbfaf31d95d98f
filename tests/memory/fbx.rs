//! Binary FBX files of any size.

use std::sync::PoisonError;

use geometry::progress::Progress;
use inspect::engine::Preparation;
use load::Limits;

use super::bounded::assert_bounded;
use super::counting::peak_of;
use super::grid::Grid;
use super::{ALONE, load, taken, temporary};

/// Writes squares, whose vertices are 64-bit floats, with a normal for each corner if asked for.
fn fbx(grid: Grid, normals: bool) -> Vec<u8> {
    let vertices: Vec<u8> = grid.positions().flatten().flat_map(|x| f64::from(x).to_le_bytes()).collect();
    let corners = grid.quads().flat_map(|[a, b, c, d]| [a as i32, b as i32, c as i32, -1 - d as i32]);
    let corners: Vec<u8> = corners.flat_map(i32::to_le_bytes).collect();
    let up = (0..corners.len() / 4).flat_map(|_| [0.0, 0.0, 1.0_f64]).flat_map(f64::to_le_bytes);
    let mut bytes = b"Kaydara FBX Binary  \0\x1a\0".to_vec();
    bytes.extend(7400_u32.to_le_bytes());
    let nothing = |_: &mut Vec<u8>| {};
    entry(&mut bytes, "Objects", &[], |bytes| {
        entry(bytes, "Geometry", &[number(1), text("m\0\x01Geometry"), text("Mesh")], |bytes| {
            entry(bytes, "Vertices", &[array(b'd', 8, &vertices)], nothing);
            entry(bytes, "PolygonVertexIndex", &[array(b'i', 4, &corners)], nothing);
            if normals {
                entry(bytes, "LayerElementNormal", &[number(0)], |bytes| {
                    entry(bytes, "MappingInformationType", &[text("ByPolygonVertex")], nothing);
                    entry(bytes, "ReferenceInformationType", &[text("Direct")], nothing);
                    entry(bytes, "Normals", &[array(b'd', 8, &up.collect::<Vec<u8>>())], nothing);
                });
            }
        });
        entry(bytes, "Model", &[number(2), text("m\0\x01Model"), text("Mesh")], nothing);
    });
    entry(&mut bytes, "Connections", &[], |bytes| {
        for [from, to] in [[2, 0], [1, 2]] {
            entry(bytes, "C", &[text("OO"), number(from), number(to)], nothing);
        }
    });
    bytes.extend([0; 13]);
    bytes
}

/// Appends an entry with values, and with the entries that `inside` appends.
fn entry(bytes: &mut Vec<u8>, name: &str, values: &[Vec<u8>], inside: impl FnOnce(&mut Vec<u8>)) {
    let start = bytes.len();
    bytes.extend([0; 12]);
    bytes.push(name.len() as u8);
    bytes.extend(name.as_bytes());
    let length: usize = values.iter().map(Vec::len).sum();
    values.iter().for_each(|value| bytes.extend(value));
    let before = bytes.len();
    inside(bytes);
    if bytes.len() > before {
        bytes.extend([0; 13]);
    }
    let header = [bytes.len(), values.len(), length].map(|number| (number as u32).to_le_bytes());
    bytes[start..start + 12].copy_from_slice(header.as_flattened());
}

fn number(number: i64) -> Vec<u8> {
    [&b"L"[..], &number.to_le_bytes()].concat()
}

fn text(text: &str) -> Vec<u8> {
    [&b"S"[..], &(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

/// An array of numbers of this many bytes each.
fn array(kind: u8, width: usize, content: &[u8]) -> Vec<u8> {
    let header = [content.len() / width, 0, content.len()].map(|number| (number as u32).to_le_bytes());
    [&[kind][..], header.as_flattened(), content].concat()
}

const TRIANGLES: usize = 57_000;

#[test]
fn parsing_counts_within_the_limit() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let plain = Preparation::default();
    // Half of the memory is for ufbx's work, of which it rarely needs much.
    assert_bounded("plain.fbx", &fbx(Grid::new(TRIANGLES, 0.0), false), 0, &plain, 2.0);
    assert_bounded("normals.fbx", &fbx(Grid::new(TRIANGLES, 0.0), true), 0, &plain, 2.0);
}

#[test]
fn large_files_load_and_what_ufbx_takes_is_bounded() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    for normals in [false, true] {
        let bytes = fbx(Grid::new(1_000_000, 0.0), normals);
        let (result, took) = taken("large.fbx", bytes);
        assert!(result.is_ok_and(|loaded| loaded.mesh.triangles.len() > 990_000) && took > 1 << 20);
    }
    // Without memory beyond that for the file nothing is parsed that would take more.
    let bytes = fbx(Grid::new(TRIANGLES, 0.0), true);
    let (file, size) = (temporary("small.fbx", &bytes), bytes.len());
    let limits = Limits { memory: 0, ..Limits::default() };
    let (_, took) = peak_of(|| load(&file, &limits, &Progress::new()));
    assert!(took <= 4 * size + (1 << 20), "{took} bytes for {size}");
}
