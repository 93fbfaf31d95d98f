//! Limits on a whole load: reading, edges, a crease band and heights. A load never takes more memory than it is
//! allowed, and isn't refused the memory that it needs.

use std::path::Path;
use std::sync::PoisonError;

use geometry::progress::Progress;
use inspect::engine::{Loaded, Preparation, load};
use load::heights::HeightSource;
use load::source::Source;
use load::{Limits, LoadError};

use super::counting::peak_of;
use super::glb::{blocks, indexed, loose};
use super::grid::Grid;
use super::{ALONE, temporary, textures};

/// Memory that doesn't depend on the file's size, in bytes.
const FIXED: usize = 1 << 20;

/// The parts of the necessary memory that are allowed.
const PARTS: [f64; 7] = [0.15, 0.3, 0.5, 0.65, 0.8, 0.9, 0.97];

/// Runs a whole load with this much memory (in bytes) beyond four times the files' size, and returns how much it took.
pub(crate) fn loaded(file: &Path, preparation: &Preparation, memory: u64) -> (Result<Loaded, LoadError>, usize) {
    let preparation = Preparation { limits: Limits { memory, ..Limits::default() }, ..preparation.clone() };
    let source = Source::File(file.to_path_buf());
    peak_of(|| load(&source, &preparation, &Progress::new()))
}

/// Loads a file with more and more memory. A load may ask for `most` times the memory that it takes; `image` is the
/// size of the height image file.
pub(crate) fn assert_bounded(name: &str, bytes: &[u8], image: usize, preparation: &Preparation, most: f64) {
    let file = temporary(name, bytes);
    let (result, needed) = loaded(&file, preparation, u64::MAX);
    let triangles = result.expect("a file without a fault").read.triangles.len();
    println!("{name}: {needed} bytes, {} a triangle, of a file of {}", needed / triangles, bytes.len() / triangles);
    let free = 4 * (bytes.len() + image);
    let (mut refused, mut least) = (0, free);
    for part in PARTS {
        let Some(memory) = ((needed as f64 * part) as usize).checked_sub(free) else { continue };
        let allowed = free + memory;
        let (result, took) = loaded(&file, preparation, memory as u64);
        assert!(took <= allowed + FIXED, "{name}: {took} of {allowed} bytes");
        if let Err(error) = result {
            let said = error.to_string();
            // Parts of a 3MF file may unpack to as much.
            let is_budget = said.contains(" MiB of memory, but files of this size may take only ")
                || said.contains(" MiB, but files of this size may unpack only to ");
            // A texture that would take too much is left out.
            assert!(is_budget || said.contains("has no image to displace by"), "{said}");
            (refused, least) = (refused + 1, allowed);
        }
    }
    let memory = (most * needed as f64) as u64 + FIXED as u64;
    let result = loaded(&file, preparation, memory.saturating_sub(free as u64)).0;
    println!("    refused {refused} times of {}, the last time with {least} bytes", PARTS.len());
    assert!(result.is_ok(), "{name}: {}", result.expect_err("an error"));
}

/// A number of triangles for which most of the memory depends on the file's size.
const TRIANGLES: usize = 57_000;

#[test]
fn the_limit_includes_edges() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let grid = Grid::new(TRIANGLES, 0.0);
    let plain = Preparation::default();
    assert_bounded("floats.glb", &indexed(grid, false), 0, &plain, 1.1);
    assert_bounded("quantised.glb", &indexed(grid, true), 0, &plain, 1.1);
    assert_bounded("blocks.glb", &blocks(grid), 0, &plain, 1.1);
    assert_bounded("loose.glb", &loose(grid, false), 0, &plain, 1.1);
    assert_bounded("apart.stl", &grid.stl(0.1), 0, &plain, 1.1);
    assert_bounded("creased.ply", &Grid::new(TRIANGLES, 40.0).ply(false), 0, &plain, 1.1);
    assert_bounded("plain.obj", &grid.obj(false), 0, &plain, 1.1);
    assert_bounded("plain.off", &grid.off(), 0, &plain, 1.1);
    assert_bounded("plain.3mf", &grid.threemf(), 0, &plain, 1.1);
}

#[test]
fn the_limit_includes_welds_and_crease_bands() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let welded = Preparation { weld: 1e-5, ..Preparation::default() };
    assert_bounded("welded.glb", &indexed(Grid::new(TRIANGLES, 0.0), true), 0, &welded, 1.5);
    assert_bounded("welded.stl", &Grid::new(TRIANGLES, 0.0).stl(0.1), 0, &welded, 1.5);
    let band = Preparation { crease_band: 1e-4, ..Preparation::default() };
    assert_bounded("crease-band.ply", &Grid::new(TRIANGLES, 40.0).ply(false), 0, &band, 1.5);
    assert_bounded("no-creases.glb", &indexed(Grid::new(TRIANGLES, 0.0), true), 0, &band, 1.5);
}

#[test]
fn the_limit_includes_heights() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let of = |heights| Preparation { heights: Some(heights), ..Preparation::default() };
    assert_bounded("materials.glb", &textures(3, 700), 0, &of(HeightSource::Materials), 1.1);
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::new(1500, 900).write_to(&mut png, image::ImageFormat::Png).expect("an image in memory");
    let image = temporary("heights.png", png.get_ref());
    let sheet = indexed(Grid::new(TRIANGLES, 0.0), true);
    assert_bounded("file.glb", &sheet, png.get_ref().len(), &of(HeightSource::File(image.to_path_buf())), 1.1);
}

/// A small file with large images. Each is in memory twice, as a texture and as heights.
#[test]
fn images_of_many_materials_are_refused_as_heights() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let bytes = textures(20, 2048);
    let allowed = 4 * bytes.len() + Limits::default().memory as usize;
    let file = temporary("images.glb", &bytes);
    let heights = Preparation { heights: Some(HeightSource::Materials), ..Preparation::default() };
    let memory = Limits::default().memory;
    assert!(loaded(&file, &Preparation::default(), memory).0.is_ok());
    let (result, took) = loaded(&file, &heights, memory);
    assert!(took <= allowed, "{took} of {allowed} bytes");
    let said = result.map(|_| ()).expect_err("830 MB").to_string();
    assert!(said.contains("heights of ") && said.contains("'s 20 images would take at least 8"), "{said}");
    assert!(said.ends_with("(--max-memory allows more); scale them down, or name one height image"), "{said}");
    let (result, took) = loaded(&file, &heights, 1 << 30);
    assert!(result.is_ok() && took > 600 << 20, "{took}");
}
