//! Lines of sight: how much of the way from a place to each of several eyes the emitted mesh leaves clear.

use glam::{DVec3, Vec3};

use super::{EmittedChunk, Visitor};
use geometry::cores::in_ranges;

/// The fewest triangles that are worth a thread.
const LEAST: usize = 4096;
/// How far outside a triangle, as a weight of its corners, a line still hits it, so that none slips through between two triangles.
const SLACK: f64 = 1e-9;

/// Lines of sight from one place.
pub struct Sight {
    from: DVec3,
    /// From the place to each eye, in object units.
    to_eyes: Vec<DVec3>,
    /// What is nearer to the place than this hides nothing, in object units: what is to be seen is no point.
    near: f64,
    /// A patch that hides nothing.
    through: Option<u32>,
    clear: Vec<f64>,
}

impl Sight {
    /// Lines from `from` to these eyes. What is nearer than `near` to `from` hides nothing. All in object units.
    pub fn new(from: Vec3, eyes: impl IntoIterator<Item = Vec3>, near: f32) -> Self {
        let from = from.as_dvec3();
        let to_eyes: Vec<DVec3> = eyes.into_iter().map(|eye| eye.as_dvec3() - from).collect();
        let clear = vec![1.0; to_eyes.len()];
        Self { from, to_eyes, near: near.into(), through: None, clear }
    }

    /// The same lines, of which this patch hides nothing.
    pub fn through(self, patch: Option<u32>) -> Self {
        Self { through: patch, ..self }
    }

    /// The part of each line that is clear from the place on, up to the first triangle: 1 if it is clear as far as the eye.
    pub fn clear(&self) -> &[f64] {
        &self.clear
    }
}

impl Visitor for Sight {
    fn take(&mut self, chunk: &EmittedChunk) {
        let Self { from, to_eyes, near, through, .. } = &*self;
        let found = in_ranges(chunk.triangles.len(), LEAST, |range| {
            let mut clear = vec![1.0_f64; to_eyes.len()];
            for triangle in &chunk.triangles[range] {
                if *through == Some(chunk.vertices[triangle[0] as usize].patch()) {
                    continue;
                }
                let corners =
                    triangle.map(|corner| Vec3::from(chunk.vertices[corner as usize].position).as_dvec3() - from);
                for (clear, to_eye) in clear.iter_mut().zip(to_eyes) {
                    let hit = part_at(corners, *to_eye).filter(|part| part * to_eye.length() > *near);
                    *clear = clear.min(hit.unwrap_or(1.0));
                }
            }
            clear
        });
        for found in found {
            self.clear.iter_mut().zip(found).for_each(|(clear, found)| *clear = clear.min(found));
        }
    }
}

/// The part of a line from the origin at which it goes through a triangle, if it does (Möller and Trumbore 1997, "Fast, Minimum
/// Storage Ray-Triangle Intersection", section 2).
fn part_at([a, b, c]: [DVec3; 3], line: DVec3) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let across = line.cross(ac);
    let scale = 1.0 / ab.dot(across);
    let u = -a.dot(across) * scale;
    // Also where a number isn't finite, as along a triangle's plane.
    if !(-SLACK..=1.0 + SLACK).contains(&u) {
        return None;
    }
    let beside = (-a).cross(ab);
    let v = line.dot(beside) * scale;
    let part = ac.dot(beside) * scale;
    (v >= -SLACK && u + v <= 1.0 + SLACK && part > 0.0).then_some(part)
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use glam::vec3;

    use super::*;
    use geometry::cores::on_threads;
    use geometry::tessellate::Vertex;

    #[test]
    fn a_line_is_clear_up_to_the_nearest_triangle() {
        let at = |position: Vec3| Vertex { position: position.into(), ..Vertex::zeroed() };
        // Many triangles across the line towards +Z, at z 2, 3, and so on, and one so near that it counts as the place itself.
        let wall = |z: f32| [vec3(-1.0, -1.0, z), vec3(3.0, -1.0, z), vec3(-1.0, 3.0, z)].map(at);
        let vertices: Vec<Vertex> = (2..10_000).rev().map(|z| z as f32).chain([1e-3]).flat_map(wall).collect();
        let triangles: Vec<[u32; 3]> =
            (0..vertices.len() as u32 / 3).map(|triangle| [0, 1, 2].map(|corner| 3 * triangle + corner)).collect();
        let eyes = [Vec3::Z * 8.0, Vec3::Z * 1.5, Vec3::NEG_Z, Vec3::X * 50.0, vec3(2.0, 2.0, 4.0)];
        for cores in [1, 3] {
            let mut sight = Sight::new(Vec3::ZERO, eyes, 0.01);
            on_threads(cores, || sight.take(&EmittedChunk::whole(&vertices, &triangles))).expect("threads");
            assert_eq!(sight.clear(), [0.25, 1.0, 1.0, 1.0, 0.5]);
        }
    }
}
