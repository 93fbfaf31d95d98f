//! Makes images as glTF has them of those that other descriptions of materials have: FBX and OBJ keep roughness and metalness, or
//! colour and opacity, apart, and glossiness is the reverse of roughness.

use crate::memory_budget::Budget;
use geometry::casts::{to_byte, to_usize};
use geometry::mesh::Texture;

/// Returns an image with roughness in green and metalness in blue, as glTF has them. Both are read from those channels: images of
/// one number are grey, and those that hold both have them there. Without an image the number is 1.
///
/// # Errors
/// A clause if it takes too much memory.
pub(super) fn metallic_roughness(
    roughness: Option<&Texture>,
    is_glossiness: bool,
    metalness: Option<&Texture>,
    budget: &Budget,
) -> Result<Texture, String> {
    let rough = |green: u8| if is_glossiness { 255 - green } else { green };
    joined(roughness, metalness, budget, |roughness, metalness| {
        [255, roughness.map_or(255, |texel| rough(texel[1])), metalness.map_or(255, |texel| texel[2]), 255]
    })
}

/// Returns an image with roughness in green, which is 1 less the glossiness in the alpha of another, times a factor.
///
/// # Errors
/// A clause if it takes too much memory.
pub(super) fn roughness(glossiness: &Texture, factor: f32, budget: &Budget) -> Result<Texture, String> {
    joined(Some(glossiness), None, budget, |glossy, _| {
        let glossiness = factor * f32::from(glossy.map_or(255, |texel| texel[3]));
        [255, to_byte(255.0 - glossiness), 255, 255]
    })
}

/// Returns an image of the colours of one image and the opacity that another has in its alpha, or in its colour if all of its alpha
/// is 1. Without an image of colours they are white.
///
/// # Errors
/// A clause if it takes too much memory.
pub(super) fn with_opacity(color: Option<&Texture>, opacity: &Texture, budget: &Budget) -> Result<Texture, String> {
    let has_alpha = opacity.rgba.as_chunks::<4>().0.iter().any(|texel| texel[3] < 255);
    joined(color, Some(opacity), budget, |color, opacity| {
        let [r, g, b, _] = color.unwrap_or([255; 4]);
        let alpha = opacity.map_or(255, |texel| if has_alpha { texel[3] } else { texel[1] });
        [r, g, b, alpha]
    })
}

/// Joins two images texel by texel, at the size of the larger one; texels of a smaller one are repeated.
fn joined(
    first: Option<&Texture>,
    second: Option<&Texture>,
    budget: &Budget,
    join: impl Fn(Option<[u8; 4]>, Option<[u8; 4]>) -> [u8; 4],
) -> Result<Texture, String> {
    let side = |i: usize| [first, second].into_iter().flatten().map(|texture| texture.size[i]).max().unwrap_or(1);
    let size @ [width, height] = [side(0), side(1)];
    budget.hold(u64::from(width) * u64::from(height) * 4)?;
    let texel = |texture: Option<&Texture>, x: u32, y: u32| {
        let texture = texture?;
        let [own_x, own_y] = [(x, width, 0), (y, height, 1)]
            .map(|(at, all, i): (u32, u32, usize)| u64::from(at) * u64::from(texture.size[i]) / u64::from(all));
        let at = to_usize(own_y * u64::from(texture.size[0]) + own_x);
        texture.rgba.as_chunks::<4>().0.get(at).copied()
    };
    let mut rgba = Vec::with_capacity(width as usize * height as usize * 4);
    for y in 0..height {
        for x in 0..width {
            rgba.extend(join(texel(first, x, y), texel(second, x, y)));
        }
    }
    Ok(Texture { size, rgba })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(size: [u32; 2], texels: &[[u8; 4]]) -> Texture {
        Texture { size, rgba: texels.as_flattened().to_vec() }
    }

    #[test]
    fn roughness_and_metalness_share_an_image_of_the_larger_size() {
        let budget = Budget::new(0, crate::Limits::default().memory);
        let rough = texture([2, 1], &[[10, 20, 30, 40], [50, 60, 70, 80]]);
        let metal = texture([1, 2], &[[1, 2, 3, 4], [5, 6, 7, 8]]);
        let both = metallic_roughness(Some(&rough), false, Some(&metal), &budget).expect("memory for 4 texels");
        let expected = [[255, 20, 3, 255], [255, 60, 3, 255], [255, 20, 7, 255], [255, 60, 7, 255]];
        assert_eq!((both.size, both.rgba), ([2, 2], expected.as_flattened().to_vec()));
        let one = metallic_roughness(Some(&rough), true, None, &budget).expect("memory for 2 texels");
        assert_eq!(one.rgba, [[255, 235, 255, 255], [255, 195, 255, 255]].as_flattened());
    }

    #[test]
    fn roughness_is_what_glossiness_leaves() {
        let budget = Budget::new(0, crate::Limits::default().memory);
        let glossy = texture([2, 1], &[[1, 2, 3, 0], [4, 5, 6, 200]]);
        let rough = roughness(&glossy, 0.5, &budget).expect("memory for 2 texels");
        assert_eq!(
            (rough.size, &rough.rgba[..]),
            ([2, 1], [[255, 255, 255, 255], [255, 155, 255, 255]].as_flattened())
        );
    }

    #[test]
    fn opacity_is_alpha_or_else_a_shade() {
        let budget = Budget::new(0, crate::Limits::default().memory);
        let color = texture([1, 1], &[[1, 2, 3, 255]]);
        let of = |texel| with_opacity(Some(&color), &texture([1, 1], &[texel]), &budget).expect("memory for a texel");
        assert_eq!(of([9, 9, 9, 100]).rgba, [1, 2, 3, 100]);
        assert_eq!(of([9, 9, 9, 255]).rgba, [1, 2, 3, 9]);
    }

    #[test]
    fn images_that_take_too_much_memory_are_refused() {
        let budget = Budget::new(0, 15);
        let opacity = texture([2, 2], &[[0; 4]; 4]);
        assert!(with_opacity(None, &opacity, &budget).is_err());
    }
}
