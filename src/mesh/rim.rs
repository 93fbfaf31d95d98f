//! The older remedy for creases: a rim of small triangles along them, so that PN triangles have no split normals to tear
//! at. Source: Vlachos, Peters, Boyd and Mitchell 2001, "Curved PN Triangles", on sharp edges.
//!
//! A *creased* edge is one whose sides' normals differ at an end. Along it every triangle is cut back by the rim's width;
//! the strip between cut and crease becomes thin triangles. On the crease all sides share one normal, the mean of theirs;
//! on the cut each keeps its own, and so the crease is rounded off within the width. Around a point, the corners that hang
//! together by edges (`fans`) share one normal too if theirs differ; then edges from there that aren't creased are cut as
//! well, also those of triangles that touch the crease with that point only.
//!
//! Between its ends a crease still follows its normals as any edge of PN triangles does. Where it rises by more than the
//! rim is wide, triangles of the rim fold over: that is the method's limit, and PN-AEN has none of it.
//!
//! What several triangles must agree on belongs to the edge: where it is cut, and with which normal, is computed once
//! (`cuts`). What lies inside a triangle is its own affair (`pieces`).

mod cuts;
mod fans;
mod pieces;

use serde::Serialize;

use super::build_limits::{BuildError, MAX_TRIANGLES, MemoryAccount};
use super::mesh_builder::{LooseCorner, MeshBuilder};
use super::{Corner, Mesh, Topology};
use crate::progress::Progress;

use cuts::{Cuts, EdgeCuts, width_in_units};
use fans::Fans;
use pieces::Cutter;

/// The widest rim that can be asked for, relative to the bounding diagonal.
pub const WIDEST: f32 = 0.1;

/// Memory for a patch's corners, their fans and those fans' normals, and for finding patches on the same points, in bytes.
const PER_PATCH: usize = 160;

/// A rim and what came of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Rim {
    /// As asked for, relative to the bounding diagonal; 0 is no rim.
    pub width: f32,
    /// Edges that had split normals.
    pub creases: u32,
    /// Edges and triangles that are too small for all of the width.
    pub narrowed: u32,
}

/// The mesh with a rim of a width relative to its bounding diagonal along every creased edge of `topology`, in the
/// triangles' order. The rim is narrower where there is no room: an edge is cut at no more than a third of its length
/// from an end, and a triangle at no more than half-way from its corner to the middle of its incircle, so that nothing
/// turns over. It is never narrower than eight units of the last place of the largest coordinate where there is room.
///
/// Corners lie on the topology's points: what was welded within a tolerance is equal from here on, and no further weld
/// should follow. A mesh without creases stays as it is but for that. Triangles without a patch stay degenerate.
///
/// Afterwards all sides of an edge have the same normals, however many there are. What was closed stays so, and boundaries
/// are only subdivided. Linear in triangles, but for sorts. Returns the mesh with its exact topology, which the budget holds.
///
/// # Errors
/// [`BuildError`].
pub fn with_rim(
    mesh: &Mesh,
    topology: &Topology,
    width: f32,
    budget: &dyn MemoryAccount,
    progress: &Progress,
) -> Result<(Mesh, Topology, Rim), BuildError> {
    let take = |bytes: usize| budget.hold(bytes as u64);
    take(PER_PATCH * topology.patches.len() + size_of::<EdgeCuts>() * topology.edges.len())?;
    let fans = Fans::of(mesh, topology);
    progress.check()?;
    let units = width_in_units(mesh, topology, width);
    let cuts = Cuts::of(mesh, topology, &fans, units);
    progress.check()?;
    let mut cutter = Cutter::new(mesh, topology, &fans, &cuts, units);
    let cut = rebuilt(mesh, topology, budget, progress, |patch, add| cutter.pieces(patch, add))?;
    let rim = Rim { width, creases: cuts.creases(), narrowed: cuts.narrowed + cutter.narrowed };
    let (made, topology) = agreed(cut, budget, progress)?;
    Ok((made, topology, rim))
}

/// Where parts of a mesh lie on each other, cuts of one may fall onto those of another, and make edges that neither had:
/// there too all sides get one normal.
fn agreed(cut: Mesh, budget: &dyn MemoryAccount, progress: &Progress) -> Result<(Mesh, Topology), BuildError> {
    let topology = Topology::build_afforded(&cut, 0.0, budget, progress)?;
    budget.hold((PER_PATCH * topology.patches.len()) as u64)?;
    let fans = Fans::of(&cut, &topology);
    if !fans.any_split() {
        return Ok((cut, topology));
    }
    let agreed = rebuilt(&cut, &topology, budget, progress, |patch, add| {
        let corners = topology.patch_corners(patch).map(|corner| cut.corners[corner as usize]);
        add([0, 1, 2].map(|k| Corner { normal: fans.normal(patch, k).unwrap_or(corners[k].normal), ..corners[k] }));
    })?;
    let topology = Topology::build_afforded(&agreed, 0.0, budget, progress)?;
    Ok((agreed, topology))
}

/// A mesh with other triangles in place of each patch: those that `pieces` hands on. Triangles without a patch stay, on
/// their points.
fn rebuilt(
    mesh: &Mesh,
    topology: &Topology,
    budget: &dyn MemoryAccount,
    progress: &Progress,
    mut pieces: impl FnMut(u32, &mut dyn FnMut([Corner; 3])),
) -> Result<Mesh, BuildError> {
    let (mut builder, mut made) = (MeshBuilder::new(), Vec::new());
    for material in &mesh.materials {
        progress.check()?;
        let index = builder.material(material.clone());
        for triangle in material.triangles.clone() {
            match topology.patch_of(triangle) {
                Some(patch) => pieces(patch, &mut |corners| made.push(corners)),
                None => made.push(mesh.triangles[triangle as usize].map(|corner| on_point(mesh, topology, corner))),
            }
            let room = builder.make_room_for_triangles(index, made.len(), budget);
            room.and_then(|()| builder.make_room(3 * made.len(), budget))?;
            for corners in made.drain(..) {
                builder.triangle(index, corners.map(LooseCorner::from));
            }
            if builder.len() as u64 > MAX_TRIANGLES {
                return Err(BuildError::TooManyTriangles);
            }
        }
    }
    let (made, _) = builder.finish_bound(mesh.name.clone(), budget, progress)?;
    Ok(Mesh { repairs: mesh.repairs, ..made })
}

/// A corner of the mesh, on its point.
fn on_point(mesh: &Mesh, topology: &Topology, corner: u32) -> Corner {
    let point = topology.corner_points[corner as usize];
    Corner { position: topology.points[point as usize], ..mesh.corners[corner as usize] }
}

#[cfg(test)]
mod tests;
