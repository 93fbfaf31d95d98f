//! Lines that mark cracks, T-junctions, bones, the largest deviation, the selected patch, and the LOD camera.

use glam::{Vec2, Vec3};

use super::camera::Camera;
use super::layout::{
    BONE_COLOR, CRACK_COLOR, FACTOR_COLORS, LOD_CAMERA_COLOR, OUTLINE_COLOR, T_JUNCTION_COLOR, WORST_COLOR,
};
use super::{LineSegment, Scene};
use crate::measure::{CrackedEdge, Measured};
use geometry::mesh::{Bounds, TJunction, Topology};

/// Half the width of the lines of cracked edges, in px. Between two sides that are 3 px apart one still sees the gap.
const CRACK_HALF_WIDTH: f32 = 0.75;

/// The lines of every side of every cracked edge.
pub fn crack_lines(measured: &Measured, topology: &Topology) -> Vec<LineSegment> {
    crack_lines_in(measured, topology, |_| CRACK_COLOR)
}

/// The lines of every side of every cracked edge. `color` returns the sRGB colour of each edge.
pub fn crack_lines_in(
    measured: &Measured,
    topology: &Topology,
    color: impl Fn(&CrackedEdge) -> [u8; 3],
) -> Vec<LineSegment> {
    let mut lines = Vec::new();
    for edge in measured.cracks.cracked() {
        let color = color(edge);
        let sides = measured.outlines.edge(topology, edge.edge);
        // In most cracks the sides differ by far less than a line's width.
        let times = sides.len() as f32;
        for side in &sides {
            let points: Vec<_> = side.positions().collect();
            let line = |ends: &[Vec3]| LineSegment {
                times,
                half_width: CRACK_HALF_WIDTH,
                ..LineSegment::new(ends[0], ends[1], color)
            };
            lines.extend(points.windows(2).map(line));
        }
    }
    lines
}

/// Lines along the open edges that T-junctions lie on, and a dot on each junction's point.
pub fn t_junction_lines(topology: &Topology, junctions: &[TJunction]) -> Vec<LineSegment> {
    let at = |point: u32| topology.points[point as usize];
    let dot = |place: Vec3| LineSegment { half_width: 4.0, ..LineSegment::new(place, place, T_JUNCTION_COLOR) };
    let edge = |edge: u32| {
        let [a, b] = topology.edge_points(&topology.edges[edge as usize]).map(at);
        LineSegment::new(a, b, T_JUNCTION_COLOR)
    };
    // They are listed in the order of the edges, of which each gets one line.
    let of_edges = junctions.chunk_by(|a, b| a.edge == b.edge);
    let marks = of_edges.flat_map(|on_one| {
        std::iter::once(edge(on_one[0].edge)).chain(on_one.iter().map(|junction| dot(at(junction.point))))
    });
    marks.collect()
}

/// How many bones count as lying over each other. Most are within the mesh, and with less than 1 they are hardly fainter there.
const BONE_TIMES: f32 = 0.2;

/// The bones of a scene's mesh in its pose: a dot on each joint, and a line to the nearest joint above it.
pub fn bone_lines(scene: &Scene) -> Vec<LineSegment> {
    let bones = scene.tessellator.mesh().bones_in(scene.tessellator.posed().pose());
    let links = bones.iter().filter_map(|bone| Some((bones[bone.parent? as usize].place, bone.place, 1.25)));
    let dots = bones.iter().map(|bone| (bone.place, bone.place, 3.5));
    let seen = links.chain(dots).filter(|(start, end, _)| start.is_finite() && end.is_finite());
    let lines = outlined(&seen.collect::<Vec<_>>(), BONE_COLOR, 1.25).into_iter();
    lines.map(|line| LineSegment { times: BONE_TIMES, ..line }).collect()
}

/// Lines and dots, by their ends and half their widths, in a colour and above a border of this width in px, which sets them off
/// from any background.
pub fn outlined(marks: &[(Vec3, Vec3, f32)], color: [u8; 3], border: f32) -> Vec<LineSegment> {
    let lines = |color, wider: f32| {
        marks.iter().map(move |&(start, end, half_width)| {
            let half_width = half_width + wider;
            LineSegment { half_width, ..LineSegment::new(start, end, color) }
        })
    };
    lines(OUTLINE_COLOR, border).chain(lines(color, 0.0)).collect()
}

/// The place with the largest deviation: a dot on it, and a line to the nearest point of the reference surface.
pub fn worst_lines(emitted: Vec3, reference_shape: Vec3) -> Vec<LineSegment> {
    outlined(&[(emitted, reference_shape, 1.25), (emitted, emitted, 4.5)], WORST_COLOR, 1.5)
}

/// A patch that is narrower than this, as a part of its length, has thinner lines around it, which would otherwise cover it; but not
/// thinner than this part of others.
const NARROW: f32 = 0.02;
const THINNEST: f32 = 0.2;

/// The outline of a selected patch: lines through the points of the edges that factors 0, 1 and 2 cut. `width` is the patch's, as a
/// part of its length.
pub fn patch_lines(edges: &[Vec<Vec3>; 3], width: f32) -> Vec<LineSegment> {
    let thinner = (width / NARROW).clamp(THINNEST, 1.0);
    let edge = |points: &[Vec3], color, half_width| {
        let ends = points.windows(2).map(move |ends| LineSegment::new(ends[0], ends[1], color));
        ends.map(|line| LineSegment { half_width: half_width * thinner, ..line }).collect::<Vec<_>>()
    };
    let outline = edges.iter().flat_map(|points| edge(points, OUTLINE_COLOR, 2.75));
    let colored = edges.iter().zip(FACTOR_COLORS).flat_map(|(points, color)| edge(points, color, 1.75));
    outline.chain(colored).collect()
}

/// The view of the camera that LOD is computed for: its near plane, its frustum as far as the mesh reaches, and a dot on the eye.
/// `viewport` is that view's size in px.
pub fn lod_camera_lines(camera: &Camera, viewport: Vec2, bounds: &Bounds) -> Vec<LineSegment> {
    let line = |start, end| LineSegment { half_width: 1.0, ..LineSegment::new(start, end, LOD_CAMERA_COLOR) };
    let [near, far] = camera.frustum(viewport, bounds);
    let around = |plane: [Vec3; 4]| [0, 1, 2, 3].map(|k| line(plane[k], plane[(k + 1) % 4]));
    let mut lines = [around(near), around(far), [0, 1, 2, 3].map(|k| line(near[k], far[k]))].concat();
    if !camera.orthographic {
        lines.push(LineSegment { half_width: 4.0, ..line(camera.eye(), camera.eye()) });
    }
    lines
}
