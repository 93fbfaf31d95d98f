//! Leaks: pixels at which a crack shows the inside of a closed mesh.

use std::cmp::Reverse;
use std::collections::BTreeSet;

use glam::{DVec2, Mat4, Vec2, dvec2};

use super::Scene;
use super::adding::{Added, Adding};
use geometry::mesh::Topology;
use gpu::{Gpu, GpuError, Readback, submit_untimed};

/// The count of each pixel, which may be negative. This format holds every whole number up to 2048, and every adapter can blend
/// it.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// Counts leaks.
///
/// A closed surface covers every pixel with as many front faces as back faces, since a line of sight that enters it also leaves
/// it. Where a front and a back face meet at a silhouette, the rasteriser gives each pixel to both or to neither, by the same
/// rule. So all triangles are drawn without a depth test; front faces add 1 and back faces subtract 1. A pixel that isn't 0 at
/// the end sees the inside through a crack, or the outside from within. (If a line of sight passes through one crack in front
/// and another behind, the two cancel; the pixels around it still count.)
pub struct LeakCounter(Adding);

impl LeakCounter {
    /// Compiles nothing yet.
    pub(crate) fn new() -> Self {
        Self(Adding::new("leak_fragment", FORMAT, wgpu::BlendFactor::One, wgpu::ColorWrites::RED))
    }

    /// Starts to count the leaks of a picture of `size` (width and height in px), for a mesh that is closed and lies beyond the near
    /// plane: see [`closed_extent`](crate::engine::measurements::closed_extent).
    ///
    /// # Errors
    /// The picture is larger than the adapter draws, or the device was lost.
    pub fn start(&self, gpu: &Gpu, size: [u32; 2], clip: Mat4) -> Result<LeakCount, GpuError> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        let [width, height] = size.map(|side| side.max(1));
        if width > limit || height > limit {
            return Err(GpuError::PictureTooLarge { width, height, limit });
        }
        Ok(LeakCount { added: self.0.start(gpu, [width, height], clip)?, next_chunk: 0 })
    }

    /// The leaks in a picture of `size` (width and height in px), the largest first. The scene's counts must be known, its mesh must
    /// be closed, and all of it must lie beyond the near plane.
    ///
    /// # Errors
    /// The picture is larger than the adapter draws, or the device was lost.
    pub(crate) fn find(&self, gpu: &Gpu, scene: &mut Scene, size: [u32; 2], clip: Mat4) -> Result<Vec<Leak>, GpuError> {
        let mut count = self.start(gpu, size, clip)?;
        let mut counts = loop {
            if let Some(counts) = count.draw_next(gpu, scene)? {
                break counts;
            }
        };
        Ok(leaks_in(&counts.wait(gpu)?, size[0].max(1) as usize))
    }
}

/// A count under way.
pub struct LeakCount {
    added: Added,
    next_chunk: usize,
}

impl LeakCount {
    /// Emits and draws the next chunk. After the last one it returns the counts of all pixels, which are on their way to the
    /// host: see [`leaking_pixels`].
    ///
    /// # Errors
    /// The device was lost.
    pub fn draw_next(&mut self, gpu: &Gpu, scene: &mut Scene) -> Result<Option<Readback>, GpuError> {
        let (index, chunks) = (self.next_chunk, scene.tessellator.chunk_count());
        self.next_chunk += 1;
        let is_last = index + 1 >= chunks;
        let mut counts = submit_untimed(gpu, |recorder| {
            if index < chunks {
                scene.tessellator.emit(recorder, index)?;
            }
            let chunk = (index < chunks).then(|| scene.tessellator.chunk(index));
            self.added.draw(recorder, wgpu::Color::WHITE, chunk.as_ref());
            Ok(is_last.then(|| self.added.read(gpu, recorder)))
        })?;
        counts.iter_mut().for_each(Readback::request);
        Ok(counts)
    }
}

/// Indices of the pixels that leak, row by row from the top left, by the bytes of a [`LeakCount`].
fn leaking_pixels(counts: &[u8]) -> impl Iterator<Item = usize> {
    // Two bytes a pixel. Both zeros, +0 and -0, are 0.
    counts.chunks_exact(2).enumerate().filter(|(_, half)| half[0] != 0 || half[1] & 0x7f != 0).map(|(pixel, _)| pixel)
}

/// Pixels that leak and touch each other, also at their corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leak {
    /// The centre of the one of these pixels that is nearest to their middle, in px from the picture's top left.
    pub px: Vec2,
    /// How many they are.
    pub pixels: u32,
}

/// The leaks of a mesh in a view, or why none can be counted.
#[derive(Clone, Debug, PartialEq)]
pub enum Leaks {
    /// The largest first.
    Counted(Vec<Leak>),
    /// The mesh is open: one sees its inside past its border.
    Open,
    /// Triangles that meet are wound opposite ways, so that the mesh has no inside.
    BothWays,
    /// The near plane of the view cuts the mesh open.
    NearPlane,
    /// Of several views there is none in which they could be counted.
    InNoView,
}

impl Leaks {
    /// Why the leaks of a mesh can be counted in no view; none if they can.
    pub fn uncounted(topology: &Topology) -> Option<Self> {
        match (topology.is_closed(), topology.is_oriented()) {
            (true, true) => None,
            (true, false) => Some(Self::BothWays),
            (false, _) => Some(Self::Open),
        }
    }

    /// The leaks of the mirrored picture, which is `width` px wide.
    pub fn mirrored(self, width: f32) -> Self {
        match self {
            Self::Counted(leaks) => {
                let mirrored = |leak: Leak| Leak { px: Vec2::new(width - leak.px.x, leak.px.y), ..leak };
                Self::Counted(leaks.into_iter().map(mirrored).collect())
            }
            other => other,
        }
    }
}

/// The leaks of a picture `width` px wide, the largest first, by the bytes of a [`LeakCount`].
pub fn leaks_in(counts: &[u8], width: usize) -> Vec<Leak> {
    let mut left: BTreeSet<usize> = leaking_pixels(counts).collect();
    let mut leaks = Vec::new();
    while let Some(first) = left.pop_first() {
        let (mut reached, mut next) = (vec![first], 0);
        while let Some(&pixel) = reached.get(next) {
            next += 1;
            let [x, y] = [pixel % width, pixel / width];
            for beside in (y.saturating_sub(1)..=y + 1).flat_map(|y| (x.saturating_sub(1)..=x + 1).map(move |x| [x, y]))
            {
                let beside = (beside[0] < width).then_some(beside[1] * width + beside[0]);
                reached.extend(beside.filter(|beside| left.remove(beside)));
            }
        }
        reached.sort_unstable();
        leaks.push(leak_of(&reached, width));
    }
    // Stable, so that leaks of one size stay in the order of their first pixels.
    leaks.sort_by_key(|leak| Reverse(leak.pixels));
    leaks
}

/// The leak that these pixels are, in order.
fn leak_of(pixels: &[usize], width: usize) -> Leak {
    let centers = || pixels.iter().map(|pixel| dvec2((pixel % width) as f64, (pixel / width) as f64) + 0.5);
    let middle = centers().sum::<DVec2>() / pixels.len() as f64;
    let apart = |center: &DVec2| center.distance_squared(middle);
    let nearest = centers().min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or(middle);
    Leak { px: nearest.as_vec2(), pixels: pixels.len() as u32 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec2;

    #[test]
    fn pixels_that_touch_are_one_leak_and_the_largest_is_first() {
        // A pixel by itself, three along a diagonal, and two at the ends of rows, which don't touch each other.
        let rows = ["#......", "...#...", "..#....", ".#....#", "#......"];
        let counts: Vec<u8> =
            rows.concat().bytes().flat_map(|pixel| if pixel == b'#' { [0, 0x3c] } else { [0, 0x80] }).collect();
        let leak = |x: f32, y: f32, pixels| Leak { px: vec2(x, y), pixels };
        assert_eq!(leaks_in(&counts, 7), [leak(2.5, 2.5, 4), leak(0.5, 0.5, 1), leak(6.5, 3.5, 1)]);
        assert_eq!(leaking_pixels(&counts).count(), 6);
        assert_eq!(leaks_in(&[], 7), []);
    }

    #[test]
    fn a_leak_around_a_face_is_at_one_of_its_own_pixels() {
        let rows = [".###..", ".#.#..", ".###.."].concat();
        let counts: Vec<u8> = rows.bytes().flat_map(|pixel| [0, if pixel == b'#' { 0x3c } else { 0 }]).collect();
        assert_eq!(leaks_in(&counts, 6), [Leak { px: vec2(2.5, 0.5), pixels: 8 }]);
    }
}
