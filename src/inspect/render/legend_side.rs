//! Where a picture has room for its legend.

use glam::{Vec2, Vec3, vec2};

use super::section::clip_from_object;
use super::{Camera, Scene, half_places};
use crate::settings::{Settings, SplitSide};
use geometry::view::project;

/// About how many places of a mesh are looked at.
const PLACES: usize = 4096;

/// Which of a picture's lower corners has the legend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LegendSide {
    #[default]
    Right,
    Left,
}

/// The lower corner of a picture of `size` px in which a legend that takes so many px covers less of the mesh: the right one, unless
/// the left one is better.
pub fn legend_side(
    scene: &Scene,
    camera: &Camera,
    settings: &Settings,
    size: [u32; 2],
    legend: [u32; 2],
) -> LegendSide {
    let (viewport, legend) = (Vec2::from(size.map(|side| side as f32)), Vec2::from(legend.map(|side| side as f32)));
    let mut covered = [0; 2];
    for (half, place) in SplitSide::BOTH.into_iter().zip(half_places(size, settings)) {
        let Some(own) = scene.half(half).filter(|_| settings.half(half).is_some()) else { continue };
        let clip = clip_from_object(camera, viewport, &own.bounds, settings);
        let [start, _, width, _] = place.area.map(|side| side as f32);
        for px in places(own).into_iter().filter_map(|place| project(clip, viewport, place)) {
            let x = if camera.is_mirrored() { viewport.x - px.x } else { px.x + place.shift as f32 };
            if px.y >= viewport.y - legend.y && px.y <= viewport.y && (start..=start + width).contains(&x) {
                covered[LegendSide::Right as usize] += usize::from(x >= viewport.x - legend.x);
                covered[LegendSide::Left as usize] += usize::from(x <= legend.x);
            }
        }
    }
    let [right, left] = covered;
    if left < right { LegendSide::Left } else { LegendSide::Right }
}

/// Places all over a mesh, in object units: of each of its triangles as many, and of many triangles only some.
fn places(scene: &Scene) -> Vec<Vec3> {
    let posed = scene.tessellator.posed().deformed_if_quick();
    let topology = posed.as_ref().map_or(scene.tessellator.topology(), |(_, topology)| topology);
    let count = topology.patches.len();
    let steps = PLACES.checked_div(count).unwrap_or_default().isqrt().max(1);
    let on_grid = (0..=steps).flat_map(|i| (0..=steps - i).map(move |j| vec2(i as f32, j as f32) / steps as f32));
    let on_grid: Vec<Vec2> = on_grid.collect();
    let patches = (0..count as u32).step_by(count.div_ceil(PLACES).max(1));
    let of_patch = |patch| {
        let [a, b, c] = topology.patch_positions(patch);
        on_grid.iter().map(move |at| a + (b - a) * at.x + (c - a) * at.y)
    };
    patches.flat_map(of_patch).collect()
}
