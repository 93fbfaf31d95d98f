//! Details of corners within a triangle (see [`CornerDetail`]), by their positions.

use glam::DVec3;

use super::on_point;
use crate::casts::to_f32;
use crate::mesh::{Corner, CornerDetail, CornerDetails, Mesh, Topology};

/// Returns the details of a corner that lies in a triangle of the mesh: those of the triangle's own corner if it is at its
/// position, otherwise linear between all three.
pub(super) fn detail_in(
    mesh: &Mesh,
    details: &CornerDetails,
    topology: &Topology,
    triangle: u32,
    corner: &Corner,
) -> CornerDetail {
    let corners = mesh.triangles[triangle as usize];
    let own = corners.map(|corner| details[corner as usize]);
    let positions = corners.map(|corner| on_point(mesh, topology, corner).position);
    if let Some(k) = (0..3).find(|&k| positions[k] == corner.position) {
        return own[k];
    }
    let weights = weights(positions.map(|position| position.as_dvec3()), corner.position.as_dvec3());
    CornerDetail::blended(own.each_ref(), weights.map(to_f32))
}

/// Returns how much each of three points counts at a position between them. They add up to 1.
fn weights([a, b, c]: [DVec3; 3], at: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let part = |from: DVec3, to: DVec3| normal.dot((to - from).cross(at - from)).max(0.0);
    let parts = [part(b, c), part(c, a), part(a, b)];
    let sum: f64 = parts.iter().sum();
    if sum > 0.0 && sum.is_finite() { parts.map(|part| part / sum) } else { [1.0, 0.0, 0.0] }
}
