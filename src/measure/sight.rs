//! Lines of sight: how much of the way from a place to an eye the emitted mesh leaves clear.

use glam::{DVec3, Vec3};

use super::{EmittedChunk, Visitor};
use crate::cores::in_ranges;

/// The fewest triangles that are worth a thread.
const LEAST: usize = 4096;
/// How far outside a triangle, as a weight of its corners, a line still hits it, so that none slips through between two triangles.
const SLACK: f64 = 1e-9;

/// Lines of sight.
pub(crate) struct Sight {
    lines: Vec<SightLine>,
    /// What is nearer to a line's place than this hides nothing, in object units: what is to be seen is no point.
    near: f64,
    clear: Vec<f64>,
}

/// A line from a place to an eye, in object units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SightLine {
    pub from: DVec3,
    pub to_eye: DVec3,
}

impl Sight {
    /// Looks along these lines. What is nearer than `near` object units to their places hides nothing.
    pub(crate) fn new(lines: Vec<SightLine>, near: f64) -> Self {
        let clear = vec![1.0; lines.len()];
        Self { lines, near, clear }
    }

    /// The part of each line that is clear from its place on, up to the first triangle: 1 if it is clear as far as the eye.
    pub(crate) fn clear(&self) -> &[f64] {
        &self.clear
    }
}

impl Visitor for Sight {
    fn take(&mut self, chunk: &EmittedChunk) {
        let Self { lines, near, .. } = &*self;
        let found = in_ranges(chunk.triangles.len(), LEAST, |range| {
            let mut clear = vec![1.0_f64; lines.len()];
            for triangle in &chunk.triangles[range] {
                let corners = triangle.map(|corner| Vec3::from(chunk.vertices[corner as usize].position).as_dvec3());
                for (clear, SightLine { from, to_eye }) in clear.iter_mut().zip(lines) {
                    let hit = part_at(corners.map(|corner| corner - from), *to_eye);
                    let hit = hit.filter(|part| part * to_eye.length() > *near);
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
    use glam::{dvec3, vec3};

    use super::*;
    use crate::cores::tests::on_cores;
    use crate::tessellate::Vertex;

    #[test]
    fn a_line_is_clear_up_to_the_nearest_triangle() {
        let at = |position: Vec3| Vertex { position: position.into(), ..Vertex::zeroed() };
        // Many triangles across the line towards +Z, at z 2, 3, and so on, and one so near that it counts as the place itself.
        let wall = |z: f32| [vec3(-1.0, -1.0, z), vec3(3.0, -1.0, z), vec3(-1.0, 3.0, z)].map(at);
        let vertices: Vec<Vertex> = (2..10_000).rev().map(|z| z as f32).chain([1e-3]).flat_map(wall).collect();
        let triangles: Vec<[u32; 3]> =
            (0..vertices.len() as u32 / 3).map(|triangle| [0, 1, 2].map(|corner| 3 * triangle + corner)).collect();
        let line = |from: DVec3, to_eye: DVec3| SightLine { from, to_eye };
        let eyes = [dvec3(0.0, 0.0, 8.0), dvec3(0.0, 0.0, 1.5), DVec3::NEG_Z, DVec3::X * 50.0, dvec3(2.0, 2.0, 4.0)];
        let lines = [eyes.map(|eye| line(DVec3::ZERO, eye)).to_vec(), vec![line(DVec3::Z, DVec3::Z * 4.0)]].concat();
        for cores in [1, 3] {
            let mut sight = Sight::new(lines.clone(), 0.01);
            on_cores(cores, || sight.take(&EmittedChunk::whole(&vertices, &triangles)));
            assert_eq!(sight.clear(), [0.25, 1.0, 1.0, 1.0, 0.5, 0.25]);
        }
    }
}
