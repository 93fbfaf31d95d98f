//! Bump maps that are images of normals. The statement `map_Bump` stands for heights, but Blender, for one, writes normal maps so.

use std::collections::{HashMap, HashSet};

use super::materials::Materials;
use super::next_statement;
use super::pieces::{Piece, in_pieces};
use crate::images::{decode_halved, texture_size};
use crate::memory_budget::Budget;
use crate::read_error::ReadError;
use crate::texture_room::decoded_bytes;
use geometry::mesh::mipmap::MipFilter;
use geometry::mesh::{Texture, borrowing};
use geometry::progress::Progress;

/// An image is looked at with no more px a side than this.
const SIDE: u32 = 256;

/// How far the square of a normal's length may be from 1. Eight bits a number take it as far as 0.03; halving, and programs that
/// don't normalise, take it further.
const LENGTH_ROOM: f32 = 0.35;

/// Which part of the texels must be normals.
const LEAST_PART: f32 = 0.9;

/// Looks at the bump maps of the materials that faces use, and makes those normal maps which are images of normals.
///
/// # Errors
/// [`ReadError::TooLarge`], [`ReadError::Cancelled`], and that a line is too long.
pub(super) fn find_normal_maps(
    materials: &mut Materials,
    pieces: &[Piece],
    (budget, progress): (&Budget, &Progress),
) -> Result<(), ReadError> {
    let candidates = materials.with_bump_maps();
    if candidates.is_empty() {
        return Ok(());
    }
    let mut used = HashSet::new();
    let names = |_: usize, piece: &Piece| used_names(piece, &candidates);
    let take = |_: &Piece, names: Result<HashSet<Vec<u8>>, ReadError>| {
        used.extend(names?);
        Ok(())
    };
    in_pieces(pieces, names, take, (budget, progress))?;
    // In an order that is the same on every run.
    let mut used = Vec::from_iter(used);
    used.sort_unstable();
    let mut known: HashMap<String, bool> = HashMap::new();
    for name in used {
        progress.check()?;
        let Some(file) = materials.bump_map(&name) else { continue };
        let is_normal_map = *known.entry(file.clone()).or_insert_with(|| holds_normals(materials, &file, budget));
        if is_normal_map {
            materials.take_bumps_for_normals(&name);
        }
    }
    Ok(())
}

/// Returns which of some names of materials a piece uses.
fn used_names(piece: &Piece, wanted: &HashSet<Vec<u8>>) -> Result<HashSet<Vec<u8>>, ReadError> {
    let (mut lines, mut found) = (piece.lines(), HashSet::new());
    while next_statement(&mut lines, |statement| {
        if statement.word == b"usemtl" && wanted.contains(statement.rest()) && !found.contains(statement.rest()) {
            found.insert(statement.rest().to_vec());
        }
    })? {}
    Ok(found)
}

/// Whether the image in a file is one of normals. What is wrong with the file is said when it is read as a texture.
fn holds_normals(materials: &Materials, file: &str, budget: &Budget) -> bool {
    let look = |bytes: Vec<u8>| {
        let side = texture_size(&bytes).map_or(0, |size| size[0].max(size[1]));
        let halvings = (side / SIDE).checked_ilog2().unwrap_or(0);
        let texture = decode_halved(&bytes, halvings, MipFilter::Numbers, budget)?;
        budget.release(decoded_bytes(texture.size));
        Ok(are_normals(&texture))
    };
    borrowing(budget, || materials.beside(file).and_then(look)).unwrap_or(false)
}

/// Whether nearly all texels are unit vectors that point away from the surface, and blue is the largest of the three on average.
fn are_normals(texture: &Texture) -> bool {
    let texels = texture.rgba.as_chunks::<4>().0;
    let (mut sums, mut units) = ([0.0_f64; 3], 0_usize);
    for &[r, g, b, _] in texels {
        let normal = [r, g, b].map(|channel| f32::from(channel) / 127.5 - 1.0);
        let square: f32 = normal.iter().map(|x| x * x).sum();
        units += usize::from((square - 1.0).abs() < LENGTH_ROOM && normal[2] > 0.0);
        sums.iter_mut().zip([r, g, b]).for_each(|(sum, channel)| *sum += f64::from(channel));
    }
    let [r, g, b] = sums;
    !texels.is_empty() && units as f32 >= LEAST_PART * texels.len() as f32 && b > 1.2 * r.max(g)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(texel: impl Fn(u32, u32) -> [u8; 3]) -> Texture {
        let texels = (0..64 * 64).map(|i| texel(i % 64, i / 64));
        Texture { size: [64; 2], rgba: texels.flat_map(|[r, g, b]| [r, g, b, 255]).collect() }
    }

    /// Normals of waves that are so steep.
    fn waves(steep: f32) -> Texture {
        texture(|x, y| {
            let slope = [(x as f32 * 0.4).sin() * steep, (y as f32 * 0.3).cos() * steep];
            let normal = glam::Vec3::new(slope[0], slope[1], 1.0).normalize();
            (normal * 127.5 + 127.5).round().to_array().map(|channel| channel as u8)
        })
    }

    #[test]
    fn images_of_normals_are_told_from_heights_and_colours() {
        assert!([0.0, 0.3, 1.0].into_iter().all(|steep| are_normals(&waves(steep))));
        let heights = |from: u32, to: u32| texture(move |x, y| [(from + (x * y) % (to - from)) as u8; 3]);
        assert!(
            [(0, 255), (100, 140), (190, 210), (200, 203)]
                .into_iter()
                .all(|(from, to)| !are_normals(&heights(from, to)))
        );
        assert!(!are_normals(&texture(|x, y| [(x * 4) as u8, (y * 4) as u8, 255])), "blue alone isn't enough");
        assert!(!are_normals(&texture(|_, _| [20, 40, 255])), "a blue wall");
        assert!(!are_normals(&Texture { size: [0; 2], rgba: Vec::new() }));
    }
}
