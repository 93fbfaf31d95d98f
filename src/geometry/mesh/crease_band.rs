//! Crease bands: bands of small triangles along creases, which leave PN triangles no split normals to tear at. This was
//! the remedy before PN-AEN. Source: Vlachos, Peters, Boyd and Mitchell 2001, "Curved PN Triangles", on sharp edges.
//!
//! An edge is *creased* if its sides have different normals at an end. Every triangle is cut back along its creased
//! edges by the band's width, and the strip between cut and crease becomes thin triangles. On the crease all sides
//! share one normal, the mean of theirs; on the cut each triangle keeps its own. So the crease is rounded off within
//! the width. The corners around a point that are connected by edges (a fan, see `fans`) share one normal too if theirs
//! differ. Then the other edges of the fan are cut as well, including those of triangles that touch the crease only
//! with that point.
//!
//! Between its ends a crease still curves by its normals, like any edge of PN triangles. Where it rises by more than
//! the band's width, triangles of the band fold over. That is a limit of this method, which PN-AEN doesn't have.
//!
//! What several triangles must agree on is computed once for each edge: where it is cut, and with which normal
//! (`cuts`). What lies inside a triangle is computed by the triangle (`pieces`).

mod cuts;
mod fans;
mod pieces;

use std::sync::Arc;

use glam::DVec3;
use serde::Serialize;

use super::build_limits::{Budget, BuildError, MAX_TRIANGLES};
use super::detail_table::DetailTable;
use super::mesh_builder::{InputCorner, MeshBuilder, StoredCorner};
use super::{Corner, CornerDetail, CornerDetails, Mesh, Topology};
use crate::casts::to_f32;
use crate::progress::Progress;

use cuts::{Cuts, EdgeCuts};
use fans::Fans;
use pieces::Cutter;

/// The greatest width of a crease band, relative to the bounding diagonal.
pub const WIDEST: f32 = 0.1;

/// Memory for each patch, in bytes: its corners, their fans, the fans' normals, and the search for patches on the same
/// points.
const PER_PATCH: usize = 160;

/// The width of a crease band, and how many edges and triangles it changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct CreaseBand {
    /// The requested width, relative to the bounding diagonal; 0 stands for no crease band.
    pub width: f32,
    /// Edges that had split normals.
    pub creases: u32,
    /// Edges and triangles that are too small for the full width.
    pub narrowed: u32,
}

/// Returns the mesh with a crease band along every creased edge of `topology`, with its exact topology, which the
/// budget holds. `width` is relative to the mesh's bounding diagonal. Triangles stay in order. The band is narrower
/// where there is too little room: an edge is cut at no more than a third of its length from an end, and a triangle at
/// no more than half-way from its corner to the centre of its incircle, so that no triangle turns over. Where there is
/// room, the band is at least eight units in the last place (ULP) of the largest coordinate wide.
///
/// Corners are moved to the topology's points, so that what was welded within a tolerance is exactly equal from here
/// on; a further weld isn't needed. Otherwise a mesh without creases doesn't change. Degenerate triangles stay
/// degenerate.
///
/// Afterwards all sides of each edge have the same normals, also on non-manifold edges. A closed mesh stays closed, and
/// boundary edges are only subdivided. Takes time linear in the number of triangles, except for sorting.
///
/// # Errors
/// [`BuildError`].
pub fn with_crease_band(
    mesh: &Mesh,
    topology: &Topology,
    width: f32,
    budget: &Budget,
    progress: &Progress,
) -> Result<(Mesh, Topology, CreaseBand), BuildError> {
    let take = |bytes: usize| budget.hold(bytes as u64);
    take(PER_PATCH * topology.patches.len() + size_of::<EdgeCuts>() * topology.edges.len())?;
    let fans = Fans::new(mesh, topology);
    progress.check()?;
    let cuts = Cuts::new(&fans, width);
    progress.check()?;
    let mut cutter = Cutter::new(&cuts);
    let cut = rebuilt(&fans, budget, progress, |patch, add| cutter.pieces(patch, add))?;
    let band = CreaseBand { width, creases: cuts.creases(), narrowed: cuts.narrowed + cutter.narrowed };
    let (made, topology) = agreed(cut, budget, progress)?;
    Ok((made, topology, band))
}

/// Gives all sides of each edge one normal in the cut mesh as well: where parts of a mesh lie on each other, cuts of
/// one part may fall onto those of another, and make edges that neither part had.
fn agreed(cut: Mesh, budget: &Budget, progress: &Progress) -> Result<(Mesh, Topology), BuildError> {
    let topology = Topology::build_afforded(&cut, 0.0, budget, progress)?;
    budget.hold((PER_PATCH * topology.patches.len()) as u64)?;
    let fans = Fans::new(&cut, &topology);
    if fans.normals.iter().all(Option::is_none) {
        return Ok((cut, topology));
    }
    let agreed = rebuilt(&fans, budget, progress, |patch, add| {
        let corners = topology.patch_corners(patch).map(|corner| cut.corners[corner as usize]);
        add([0, 1, 2].map(|k| Corner { normal: fans.normal(patch, k).unwrap_or(corners[k].normal), ..corners[k] }));
    })?;
    let topology = Topology::build_afforded(&agreed, 0.0, budget, progress)?;
    Ok((agreed, topology))
}

/// Returns a mesh in which each patch is replaced by the triangles that `pieces` calls its argument with. Degenerate
/// triangles stay, with their corners moved to their points.
fn rebuilt(
    fans: &Fans,
    budget: &Budget,
    progress: &Progress,
    mut pieces: impl FnMut(u32, &mut dyn FnMut([Corner; 3])),
) -> Result<Mesh, BuildError> {
    let Fans { mesh, topology, .. } = *fans;
    let (mut builder, mut made) = (MeshBuilder::new(), Vec::new());
    let mut details = mesh.details.as_ref().map(|details| (details, DetailTable::default()));
    for material in &mesh.materials {
        progress.check()?;
        let index = builder.material(material.clone());
        for triangle in material.triangles.clone() {
            builder.enter_part(mesh.part_of(triangle));
            match topology.patch_of(triangle) {
                Some(patch) => pieces(patch, &mut |corners| made.push(corners)),
                None => made.push(mesh.triangles[triangle as usize].map(|corner| fans.on_point(corner))),
            }
            let room = builder.make_room_for_triangles(index, made.len(), budget);
            room.and_then(|()| builder.make_room(3 * made.len(), budget))?;
            for corners in made.drain(..) {
                let mut kept = [StoredCorner::default(); 3];
                for (corner, kept) in corners.into_iter().zip(&mut kept) {
                    let number = match &mut details {
                        Some((details, table)) => {
                            table.number(detail_in(fans, details, triangle, &corner), 0, budget)?
                        }
                        None => 0,
                    };
                    *kept = builder.corner(InputCorner::from(corner), number);
                }
                builder.stored_triangle(index, kept);
            }
            if builder.len() as u64 > MAX_TRIANGLES {
                return Err(BuildError::TooManyTriangles);
            }
        }
    }
    let (made, numbers) = builder.finish_bound(mesh.name.clone(), budget, progress)?;
    let details = details.map(|(_, table)| table.into_lists(&numbers, budget)).transpose()?;
    Ok(Mesh {
        repairs: mesh.repairs,
        details: details.map(|(details, _)| Arc::new(details)),
        lights: mesh.lights.clone(),
        cameras: mesh.cameras.clone(),
        bones: mesh.bones_in(None),
        part_styles: mesh.part_styles.clone(),
        ..made
    })
}

/// Returns the details of a corner that lies in a triangle of the mesh: those of the triangle's own corner if it is at its
/// position, otherwise linear between all three.
fn detail_in(fans: &Fans, details: &CornerDetails, triangle: u32, corner: &Corner) -> CornerDetail {
    let corners = fans.mesh.triangles[triangle as usize];
    let own = corners.map(|corner| details[corner as usize]);
    let positions = corners.map(|corner| fans.on_point(corner).position);
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

#[cfg(test)]
mod tests;
