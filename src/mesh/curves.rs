//! Curves: which sides of an edge share control points. What a set of sides shares is computed once, in the edge's own
//! direction, so that they agree to the last bit. As published, nothing is shared: every side has a curve of its own.

use super::{Edge, Mesh, Topology};

/// Which sides of an edge share a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sharing {
    /// All of them: flat dicing, and PN-AEN, whose control points are the mean over the sides.
    AllSides,
    /// Those with equal normals at both ends: PN, which lets the others tear apart.
    EqualNormals,
    /// None: every side has its own curve in its patch's direction, with its own proposal, as shaders without adjacency
    /// compute it.
    None,
    /// None, but a side averages its proposal with the one neighbour's, as the PN-AEN white paper's shader does from a
    /// patch's nine indices (see [`super::adjacency::nine`]).
    NoneAveraged,
}

impl Sharing {
    /// Whether every side has a curve, and a factor, of its own.
    pub fn is_per_patch(self) -> bool {
        matches!(self, Self::None | Self::NoneAveraged)
    }
}

/// One set of sides of one edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Curve {
    /// End points, in the curve's direction: the edge's, or the patch's where nothing is shared.
    pub points: [u32; 2],
    /// Its run of [`Curves::sides`].
    pub first_side: u32,
    pub side_count: u32,
}

/// Every edge's curves.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    pub curves: Vec<Curve>,
    /// Corners at the start and the end of each curve's sides, in the curve's direction.
    pub sides: Vec<[u32; 2]>,
    /// Factor f is asked for by curves `factor_curves[f]..factor_curves[f + 1]`. There is one factor an edge; or where
    /// nothing is shared, one a side.
    pub factor_curves: Vec<u32>,
    /// The curve of each side of the topology.
    pub side_curves: Vec<u32>,
    per_patch: bool,
}

impl Curves {
    /// Groups the sides of every edge. Linear in sides, but for edges with many.
    pub fn build(mesh: &Mesh, topology: &Topology, sharing: Sharing) -> Self {
        let per_patch = sharing.is_per_patch();
        let mut curves = Curves { side_curves: vec![0; topology.sides.len()], per_patch, ..Curves::default() };
        for edge in &topology.edges {
            if !per_patch {
                curves.factor_curves.push(curves.curves.len() as u32);
            }
            match sharing {
                Sharing::AllSides => {
                    let sides = topology.side_range(edge);
                    curves.push_shared(topology, edge, sides.clone(), sides);
                }
                Sharing::EqualNormals => curves.push_by_normals(mesh, topology, edge),
                Sharing::None | Sharing::NoneAveraged => {
                    curves.push_own(topology, edge, sharing == Sharing::NoneAveraged);
                }
            }
        }
        curves.factor_curves.push(curves.curves.len() as u32);
        curves
    }

    /// Whether a side (an index into [`Topology::sides`]) runs against its curve.
    pub fn runs_against(&self, topology: &Topology, side: u32) -> bool {
        !self.per_patch && topology.sides[side as usize].reversed()
    }

    /// Which factor a side has.
    pub fn factor(&self, topology: &Topology, side: u32) -> u32 {
        if self.per_patch { self.side_curves[side as usize] } else { topology.sides[side as usize].edge }
    }

    /// How many factors there are.
    pub fn factor_count(&self) -> u32 {
        self.factor_curves.len() as u32 - 1
    }

    /// A curve in the edge's direction for the sides `all`, of whom `asked` propose its control points.
    fn push_shared(
        &mut self,
        topology: &Topology,
        edge: &Edge,
        asked: impl Iterator<Item = u32>,
        all: impl Iterator<Item = u32>,
    ) {
        let curve = self
            .push(topology.edge_points(edge), asked.map(|side| topology.side_corners(&topology.sides[side as usize])));
        all.for_each(|side| self.side_curves[side as usize] = curve);
    }

    fn push_by_normals(&mut self, mesh: &Mesh, topology: &Topology, edge: &Edge) {
        let normals = |side: u32| {
            let [a, b] = topology.side_corners(&topology.sides[side as usize]);
            [a, b].map(|c| mesh.corners[c as usize].normal.to_array().map(|x| (x + 0.0).to_bits()))
        };
        let mut sides: Vec<u32> = topology.side_range(edge).collect();
        sides.sort_by_key(|&side| normals(side));
        for group in sides.chunk_by(|&x, &y| normals(x) == normals(y)) {
            // Equal normals propose equal control points: the first side speaks for all.
            self.push_shared(topology, edge, group[..1].iter().copied(), group.iter().copied());
        }
    }

    /// A curve for each side, in its patch's direction, and a factor for each.
    fn push_own(&mut self, topology: &Topology, edge: &Edge, averaged: bool) {
        let sides = topology.side_range(edge);
        for side in sides.clone() {
            let reversed = topology.sides[side as usize].reversed();
            let turned = |[a, b]: [u32; 2]| if reversed { [b, a] } else { [a, b] };
            // The only other side, if there is just one; the paper's shader adds it to its own proposal.
            let other = (averaged && sides.len() == 2).then(|| sides.start + sides.start + 1 - side);
            let asked = std::iter::once(side).chain(other);
            self.factor_curves.push(self.curves.len() as u32);
            let corners = asked.map(|side| turned(topology.side_corners(&topology.sides[side as usize])));
            self.side_curves[side as usize] = self.push(turned(topology.edge_points(edge)), corners);
        }
    }

    fn push(&mut self, points: [u32; 2], sides: impl Iterator<Item = [u32; 2]>) -> u32 {
        let first_side = self.sides.len() as u32;
        self.sides.extend(sides);
        let side_count = self.sides.len() as u32 - first_side;
        self.curves.push(Curve { points, first_side, side_count });
        self.curves.len() as u32 - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Shape, adjacency};
    use crate::progress::Progress;

    #[test]
    fn as_published_each_side_asks_for_what_the_nine_indices_hold() {
        for shape in Shape::ALL {
            let mesh = shape.build();
            let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
            let curves = Curves::build(&mesh, &topology, Sharing::NoneAveraged);
            assert_eq!(
                (curves.curves.len(), curves.factor_count() as usize),
                (topology.sides.len(), topology.sides.len())
            );
            for (index, patch) in topology.patches.iter().enumerate() {
                let nine = adjacency::nine(&topology, index as u32);
                for k in 0..3 {
                    let curve = curves.curves[curves.side_curves[patch.sides[k] as usize] as usize];
                    let asked = &curves.sides[curve.first_side as usize..][..curve.side_count as usize];
                    assert_eq!(asked[0], [nine[k], nine[(k + 1) % 3]], "{shape:?}: its own corners first");
                    assert_eq!(
                        asked[asked.len() - 1],
                        [nine[3 + 2 * k], nine[4 + 2 * k]],
                        "{shape:?}: across the side"
                    );
                    assert!(!curves.runs_against(&topology, patch.sides[k]));
                }
            }
        }
    }

    #[test]
    fn shared_curves_run_as_their_edge_does() {
        let mesh = Shape::CubeSplit.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        for (sharing, curves_per_split_edge) in [(Sharing::AllSides, 1), (Sharing::EqualNormals, 2), (Sharing::None, 2)]
        {
            let curves = Curves::build(&mesh, &topology, sharing);
            let diagonals = if sharing.is_per_patch() { 2 * 6 } else { 6 };
            assert_eq!(curves.curves.len(), 12 * curves_per_split_edge + diagonals, "{sharing:?}");
            for (index, side) in (0..).zip(&topology.sides) {
                let [a, b] = curves.curves[curves.side_curves[index as usize] as usize].points;
                assert_eq!(curves.runs_against(&topology, index), side.reversed() && !sharing.is_per_patch());
                assert_eq!(a < b, !(sharing.is_per_patch() && side.reversed()));
            }
        }
    }
}
