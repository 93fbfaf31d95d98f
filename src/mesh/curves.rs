//! Curves: which sides of an edge share control points. What a set of sides shares is computed once, in the edge's own
//! direction, so that they agree to the last bit.

use super::{Mesh, Topology};

/// Which sides of an edge share a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sharing {
    /// All of them: flat dicing, and PN-AEN, whose control points are the mean over the sides.
    AllSides,
    /// Those with equal normals at both ends: PN, which lets the others tear apart.
    EqualNormals,
}

/// One set of sides of one edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Curve {
    /// End points, in the edge's direction.
    pub points: [u32; 2],
    /// Its run of [`Curves::sides`].
    pub first_side: u32,
    pub side_count: u32,
}

/// Every edge's curves.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    pub curves: Vec<Curve>,
    /// Corners at the start and the end of each curve's sides, in the edge's direction.
    pub sides: Vec<[u32; 2]>,
    /// Edge e owns curves `edge_curves[e]..edge_curves[e + 1]`.
    pub edge_curves: Vec<u32>,
    /// The curve of each side of the topology.
    pub side_curves: Vec<u32>,
}

impl Curves {
    /// Groups the sides of every edge. Linear in sides, but for edges with many.
    pub fn build(mesh: &Mesh, topology: &Topology, sharing: Sharing) -> Self {
        let mut curves = Curves { side_curves: vec![0; topology.sides.len()], ..Curves::default() };
        for edge in &topology.edges {
            curves.edge_curves.push(curves.curves.len() as u32);
            match sharing {
                Sharing::AllSides => curves.push(topology, edge.points, edge.sides.clone()),
                Sharing::EqualNormals => {
                    let normals = |side: u32| {
                        let [a, b] = topology.sides[side as usize].corners;
                        [a, b].map(|c| mesh.corners[c as usize].normal.to_array().map(|x| (x + 0.0).to_bits()))
                    };
                    let mut sides: Vec<u32> = edge.sides.clone().collect();
                    sides.sort_by_key(|&side| normals(side));
                    for group in sides.chunk_by(|&x, &y| normals(x) == normals(y)) {
                        // Equal normals propose equal control points: the first side speaks for all.
                        let curve = curves.curves.len() as u32;
                        curves.push(topology, edge.points, group[..1].iter().copied());
                        group.iter().for_each(|&side| curves.side_curves[side as usize] = curve);
                    }
                }
            }
        }
        curves.edge_curves.push(curves.curves.len() as u32);
        curves
    }

    fn push(&mut self, topology: &Topology, points: [u32; 2], sides: impl Iterator<Item = u32>) {
        let (curve, first_side) = (self.curves.len() as u32, self.sides.len() as u32);
        for side in sides {
            self.side_curves[side as usize] = curve;
            self.sides.push(topology.sides[side as usize].corners);
        }
        let side_count = self.sides.len() as u32 - first_side;
        self.curves.push(Curve { points, first_side, side_count });
    }
}
