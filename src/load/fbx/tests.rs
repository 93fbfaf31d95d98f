//! Tests with small files that are made here.

pub(crate) mod documents;
mod hidden;
mod moving;
mod nurbs;
mod shapes;
mod spans;
mod surfaces;
pub(crate) mod tree;

use super::read_here;
use crate::loaded_mesh::LoadedMesh;
use crate::model_file::ModelFile;
use crate::read_error::ReadError;
use geometry::progress::Progress;

use tree::{Arrays, Entry, binary, text};

fn read(bytes: &[u8]) -> Result<LoadedMesh, ReadError> {
    read_here(bytes.to_vec(), &ModelFile::from_test("test", &Progress::new()))
}

/// Reads a file as text, as plain binary and as compressed binary. All must give the same mesh.
fn loaded(entries: &[Entry]) -> LoadedMesh {
    let files = [text(entries), binary(entries, Arrays::Plain), binary(entries, Arrays::Zlib)];
    let [first, others @ ..] = files.map(|bytes| read(&bytes).expect("a file without a fault"));
    for other in others {
        assert_eq!((&first.corners, &first.triangles), (&other.corners, &other.triangles));
        assert_eq!(first.warnings, other.warnings);
    }
    first
}

/// Returns whether two numbers differ by less than 1e-5.
fn near(a: impl AsRef<[f32]>, b: impl AsRef<[f32]>) -> bool {
    let (a, b) = (a.as_ref(), b.as_ref());
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5)
}

/// Small files of every kind: text, and binary with plain and with compressed arrays.
pub(crate) fn files() -> Vec<Vec<u8>> {
    let documents = [
        documents::smoothed_prism(),
        documents::skinned_strip(),
        documents::morphed_square(),
        documents::textured_square(Ok(&documents::image())),
    ];
    let arrays = [Arrays::Plain, Arrays::Zlib].into_iter().cycle();
    let both = documents.iter().zip(arrays).map(|(entries, arrays)| [text(entries), binary(entries, arrays)]);
    both.flatten().collect()
}
