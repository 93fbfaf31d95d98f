//! The older remedy for creases: a rim of small triangles along them, so that PN triangles have no split normals to tear
//! at. Source: Vlachos, Peters, Boyd and Mitchell 2001, "Curved PN Triangles", on sharp edges.
//!
//! A *creased* edge is one whose sides' normals differ at an end. Along it every triangle is cut back by the rim's width;
//! the strip between cut and crease becomes thin triangles. On the crease all sides share one normal, the mean of theirs;
//! on the cut each keeps its own, and so the crease is rounded off within the width and nothing changes beyond. Around a
//! point, the corners that hang together by edges ([`Fans`]) share one normal too if theirs differ; then edges from there
//! that aren't creased are cut as well, also those of triangles that touch the crease with that point only.
//!
//! What several triangles must agree on belongs to the edge: where it is cut, and with which normal, is computed once
//! ([`cuts`]). What lies inside a triangle is its own affair ([`pieces`]).

mod cuts;
mod fans;
mod pieces;

use serde::Serialize;

use cuts::{Cuts, width_in_units};
use fans::Fans;
use pieces::Cutter;

use super::merge::{LooseCorner, MeshBuilder};
use super::progress::{Cancelled, Progress};
use super::{Mesh, Topology};

/// The widest rim that can be asked for, relative to the bounding diagonal.
pub const WIDEST: f32 = 0.1;

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

impl Rim {
    /// What people should know of, one sentence each.
    fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.creases == 0 {
            warnings.push("no edge has split normals, so there is no crease for a rim.".to_owned());
        }
        if self.narrowed > 0 {
            warnings.push(format!("edges and triangles too small for all of the rim's width: {}.", self.narrowed));
        }
        warnings
    }
}

/// The mesh with a rim of a width relative to its bounding diagonal along every creased edge of `topology`, in the
/// triangles' order. The rim is narrower where there is no room: an edge is cut at no more than a third of its length
/// from an end, and a triangle at no more than half-way from its corner to the middle of its incircle, so that nothing
/// turns over. It is never narrower than eight units of the last place of the largest coordinate where there is room.
///
/// Corners lie on the topology's points: what was welded within a tolerance is equal from here on, and no further weld
/// should follow. A mesh without creases stays as it is but for that. Triangles without a patch stay degenerate.
///
/// Afterwards no edge of two sides is split. What was closed stays so, and boundaries are only subdivided. Two triangles on
/// the same three points are cut alike, so that edges inside them have four sides. Linear in triangles, but for a sort of
/// corners.
///
/// # Errors
/// [`Cancelled`] when `progress` says so.
pub fn with_rim(
    mesh: &Mesh,
    topology: &Topology,
    width: f32,
    progress: &Progress,
) -> Result<(Mesh, Rim), Cancelled> {
    let fans = Fans::of(mesh, topology);
    progress.check()?;
    let units = width_in_units(mesh, topology, width);
    let cuts = Cuts::of(mesh, topology, &fans, units);
    progress.check()?;
    let mut cutter = Cutter::new(mesh, topology, &fans, &cuts, units);
    let mut builder = MeshBuilder::new();
    for material in &mesh.materials {
        progress.check()?;
        let index = builder.material(material.clone());
        for triangle in material.triangles.clone() {
            let mut add = |corners: [LooseCorner; 3]| builder.triangle(index, corners);
            match topology.patch_of(triangle) {
                Some(patch) => cutter.pieces(patch, |piece| add(piece.map(LooseCorner::from))),
                None => add(mesh.triangles[triangle as usize].map(|corner| cutter.corner(corner).into())),
            }
        }
    }
    let rim = Rim { width, creases: cuts.creases(), narrowed: cuts.narrowed + cutter.narrowed };
    let warnings = mesh.warnings.iter().cloned().chain(rim.warnings()).collect();
    let made = builder.finish(mesh.name.clone(), progress)?;
    Ok((Mesh { repairs: mesh.repairs, warnings, ..made }, rim))
}

#[cfg(test)]
mod tests;
