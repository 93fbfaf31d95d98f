//! Curves: the control points of edges, and which sides of an edge share them. Shared control points are computed once,
//! in the edge's own direction, so that all sides agree to the last bit. In the published algorithms nothing is shared,
//! and each side has a curve of its own.

use bytemuck::{Pod, Zeroable};

use super::{CurveStyle, Edge, Mesh, Side, StylesUsed, Topology};
use crate::casts::to_u32;
use crate::surface_kind::Surface;

/// Which sides of an edge share a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sharing {
    /// All sides share one: flat dicing, and PN-AEN, whose control points are the mean over the sides.
    AllSides,
    /// Sides with equal normals at both ends share one: PN triangles, which tear where normals differ.
    EqualNormals,
    /// No sides share one, so that nothing hides where they disagree; but all run as their edge does, and the edge has one
    /// factor. Each has the corners of its one neighbour beside its own: for control points by a function of the user's own.
    EachSide,
    /// No sides share one. Each side has a curve in its patch's direction, with control points from its own corners, as
    /// shaders without adjacency compute it.
    None,
    /// No sides share one, but each side averages its control points with those of its one neighbour, as the shader in
    /// the PN-AEN white paper does with a patch's nine indices (the first of `eighteen` in `adjacency.rs`).
    NoneAveraged,
}

impl Sharing {
    /// Returns whether each side has a curve and a tessellation factor of its own.
    pub fn is_per_patch(self) -> bool {
        matches!(self, Self::None | Self::NoneAveraged)
    }

    /// Returns which sides share an edge of this surface. Where parts with different surfaces meet (`differs`), all do, unless each side
    /// is computed for itself.
    fn of_edge(self, surface: Surface, differs: bool) -> Self {
        match self {
            Self::AllSides | Self::EqualNormals if surface.tears() && !differs => Self::EqualNormals,
            Self::AllSides | Self::EqualNormals => Self::AllSides,
            Self::EachSide | Self::None | Self::NoneAveraged => self,
        }
    }
}

/// The sides of an edge that share control points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Curve {
    /// The end points, in the curve's direction: the edge's direction, or the patch's if nothing is shared.
    pub points: [u32; 2],
    /// Where this curve's part of [`Curves::sides`] starts.
    pub first_side: u32,
    pub side_count: u32,
}

/// The curves of all edges.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    pub curves: Vec<Curve>,
    /// For each side that a curve's control points are computed from, its corners at the start and the end of the
    /// curve.
    pub sides: Vec<[u32; 2]>,
    /// Factor f is the factor of the curves `factor_curves[f]..factor_curves[f + 1]`. There is one factor for each
    /// edge, or for each side if nothing is shared.
    pub factor_curves: Vec<u32>,
    /// For each side of the topology, its curve.
    pub side_curves: Vec<u32>,
    /// For each curve; empty if no part of the mesh has a style of its own.
    pub styles: Vec<CurveStyle>,
    per_patch: bool,
}

impl Curves {
    /// Groups the sides of every edge into curves, whatever the styles of parts. Takes time linear in the number of sides, except
    /// for edges with many sides.
    pub fn build(mesh: &Mesh, topology: &Topology, sharing: Sharing) -> Self {
        Self::build_some(mesh, topology, (sharing, StylesUsed::Nothing), 0..to_u32(topology.edges.len()))
    }

    /// The same, as the styles of the mesh's parts say.
    pub fn styled(mesh: &Mesh, topology: &Topology, sharing: Sharing, used: StylesUsed) -> Self {
        Self::build_some(mesh, topology, (sharing, used), 0..to_u32(topology.edges.len()))
    }

    /// The same for some edges alone, in ascending order. The other edges have no curves.
    pub(crate) fn build_some(
        mesh: &Mesh,
        topology: &Topology,
        (sharing, used): (Sharing, StylesUsed),
        edges: impl Iterator<Item = u32>,
    ) -> Self {
        let used = if mesh.has_styles() { used } else { StylesUsed::Nothing };
        let per_patch = sharing.is_per_patch();
        let mut curves = Curves { side_curves: vec![0; topology.sides.len()], per_patch, ..Curves::default() };
        if !per_patch {
            curves.factor_curves = vec![0; topology.edges.len()];
        }
        for index in edges {
            let edge = &topology.edges[index as usize];
            let first = to_u32(curves.curves.len());
            let (surface, of_edge) = match used {
                StylesUsed::Nothing => (None, sharing),
                // Which surface is the same doesn't matter: something else makes it.
                StylesUsed::Details => (Some(Surface::OF_USER_SHADER), sharing),
                StylesUsed::All(surface) => {
                    let (style, differs) = topology.edge_style(mesh, edge, surface);
                    (Some(surface), sharing.of_edge(style.surface, differs))
                }
            };
            match of_edge {
                Sharing::AllSides => {
                    let sides = topology.side_range(edge);
                    curves.push_shared(topology, edge, sides.clone(), sides);
                }
                Sharing::EqualNormals => curves.push_by_normals(mesh, topology, edge),
                Sharing::EachSide | Sharing::None | Sharing::NoneAveraged => {
                    curves.push_own(topology, edge, |side| match used {
                        StylesUsed::All(surface) => {
                            let own = topology.patch_style(mesh, side.patch(), surface).surface;
                            own.is_averaged() || own.has_creases()
                        }
                        StylesUsed::Nothing | StylesUsed::Details => sharing != Sharing::None,
                    });
                }
            }
            if let Some(surface) = surface.filter(|_| per_patch) {
                let of_side = |side: &Side| topology.patch_style(mesh, side.patch(), surface);
                curves.styles.extend(topology.edge_sides(edge).iter().map(of_side));
            } else if let Some(surface) = surface {
                curves.styles.resize(curves.curves.len(), topology.edge_style(mesh, edge, surface).0);
            }
            if !per_patch {
                // The next edge starts where this one ends.
                let end = to_u32(curves.curves.len());
                curves.factor_curves[index as usize] = first;
                if let Some(next) = curves.factor_curves.get_mut(index as usize + 1) {
                    *next = end;
                }
            }
        }
        curves.factor_curves.push(to_u32(curves.curves.len()));
        curves
    }

    /// Returns whether a side (an index into [`Topology::sides`]) has the direction opposite to its curve's.
    pub fn runs_against(&self, topology: &Topology, side: u32) -> bool {
        !self.per_patch && topology.sides[side as usize].reversed()
    }

    /// Returns the index of a side's factor.
    pub fn factor(&self, topology: &Topology, side: u32) -> u32 {
        if self.per_patch { self.side_curves[side as usize] } else { topology.sides[side as usize].edge }
    }

    /// Returns the number of factors.
    pub fn factor_count(&self) -> u32 {
        to_u32(self.factor_curves.len()) - 1
    }

    /// Adds a curve in the edge's direction for the sides `all`. Its control points are computed from the sides
    /// `asked`.
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
            // Equal normals give equal control points, so the first side is enough.
            self.push_shared(topology, edge, group[..1].iter().copied(), group.iter().copied());
        }
    }

    /// Adds a curve for each side. If nothing is shared it has a factor too, and runs in its patch's direction.
    fn push_own(&mut self, topology: &Topology, edge: &Edge, with_neighbour: impl Fn(&Side) -> bool) {
        let sides = topology.side_range(edge);
        for side in sides.clone() {
            let reversed = self.per_patch && topology.sides[side as usize].reversed();
            let turned = |[a, b]: [u32; 2]| if reversed { [b, a] } else { [a, b] };
            // The other side, if there is exactly one: the shader in the white paper averages its control points with
            // these.
            let has_other = sides.len() == 2 && with_neighbour(&topology.sides[side as usize]);
            let other = has_other.then(|| sides.start + sides.start + 1 - side);
            let asked = std::iter::once(side).chain(other);
            if self.per_patch {
                self.factor_curves.push(to_u32(self.curves.len()));
            }
            let corners = asked.map(|side| turned(topology.side_corners(&topology.sides[side as usize])));
            self.side_curves[side as usize] = self.push(turned(topology.edge_points(edge)), corners);
        }
    }

    fn push(&mut self, points: [u32; 2], sides: impl Iterator<Item = [u32; 2]>) -> u32 {
        let first_side = to_u32(self.sides.len());
        self.sides.extend(sides);
        let side_count = to_u32(self.sides.len()) - first_side;
        self.curves.push(Curve { points, first_side, side_count });
        to_u32(self.curves.len()) - 1
    }
}

/// What [`Curves`] lists, one by one. Without lists all sides of an edge share a curve: curves and factors then have their edge's number,
/// and all else follows from the topology, so that a large mesh needs no memory for it.
pub struct CurveItems<'a> {
    pub topology: &'a Topology,
    pub lists: Option<&'a Curves>,
}

impl CurveItems<'_> {
    pub fn curve_count(&self) -> usize {
        self.lists.map_or(self.topology.edges.len(), |lists| lists.curves.len())
    }

    /// Returns an item of [`Curves::curves`].
    pub fn curve(&self, curve: usize) -> Curve {
        if let Some(lists) = self.lists {
            return lists.curves[curve];
        }
        let edge = &self.topology.edges[curve];
        let side_count = to_u32(self.topology.side_range(edge).len());
        Curve { points: self.topology.edge_points(edge), first_side: edge.first_side, side_count }
    }

    /// Returns the length of [`Curves::sides`].
    pub fn side_count(&self) -> usize {
        self.lists.map_or(self.topology.sides.len(), |lists| lists.sides.len())
    }

    /// Returns an item of [`Curves::sides`].
    pub fn side(&self, side: usize) -> [u32; 2] {
        self.lists.map_or_else(|| self.topology.side_corners(&self.topology.sides[side]), |lists| lists.sides[side])
    }

    pub fn factor_count(&self) -> u32 {
        self.lists.map_or(to_u32(self.topology.edges.len()), Curves::factor_count)
    }

    /// Returns an item of [`Curves::factor_curves`].
    pub fn factor_curve(&self, factor: usize) -> u32 {
        self.lists.map_or(to_u32(factor), |lists| lists.factor_curves[factor])
    }

    /// Returns the curve of a side of the topology, and whether the side has the opposite direction.
    pub fn curve_of(&self, side: u32) -> (u32, bool) {
        let own = &self.topology.sides[side as usize];
        let lists = self.lists.map(|lists| (lists.side_curves[side as usize], lists.runs_against(self.topology, side)));
        lists.unwrap_or((own.edge, own.reversed()))
    }

    /// Returns the factor of a side of the topology.
    pub fn factor(&self, side: u32) -> u32 {
        self.lists.map_or(self.topology.sides[side as usize].edge, |lists| lists.factor(self.topology, side))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Shape, adjacency};
    use crate::progress::Progress;

    #[test]
    fn as_published_each_side_uses_its_nine_indices() {
        for shape in Shape::ALL {
            let mesh = shape.build();
            let topology = Topology::build(&mesh, &Progress::new()).expect("not cancelled");
            let curves = Curves::build(&mesh, &topology, Sharing::NoneAveraged);
            assert_eq!(
                (curves.curves.len(), curves.factor_count() as usize),
                (topology.sides.len(), topology.sides.len())
            );
            for (index, patch) in topology.patches.iter().enumerate() {
                let nine = adjacency::eighteen(&topology, index as u32);
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
    fn each_side_alone_has_its_own_corners_first_and_then_those_across() {
        for shape in Shape::ALL {
            let mesh = shape.build();
            let topology = Topology::build(&mesh, &Progress::new()).expect("not cancelled");
            let curves = Curves::build(&mesh, &topology, Sharing::EachSide);
            assert_eq!(curves.curves.len(), topology.sides.len(), "{shape:?}");
            for (index, own) in (0..).zip(&topology.sides) {
                let curve = curves.curves[curves.side_curves[index as usize] as usize];
                let asked = &curves.sides[curve.first_side as usize..][..curve.side_count as usize];
                let sides = topology.side_range(&topology.edges[own.edge as usize]);
                let other = sides.clone().find(|&side| side != index).filter(|_| sides.len() == 2);
                let corners = |side: u32| topology.side_corners(&topology.sides[side as usize]);
                assert_eq!(asked[0], corners(index), "{shape:?}");
                assert_eq!(asked.get(1).copied(), other.map(corners), "{shape:?}");
            }
        }
    }

    #[test]
    fn without_lists_the_items_are_those_of_curves_that_all_sides_share() {
        // A third triangle at an edge, and one alone.
        let mut fan = Shape::CubeSplit.build();
        fan.triangles = [[0, 1, 2], [1, 0, 3], [0, 1, 8], [8, 9, 10]].to_vec().into();
        for mesh in Shape::ALL.iter().map(|shape| shape.build()).chain([fan]) {
            let topology = Topology::new(&mesh);
            let lists = Curves::build(&mesh, &topology, Sharing::AllSides);
            let [own, listed] = [None, Some(&lists)].map(|lists| CurveItems { topology: &topology, lists });
            let counts = |items: &CurveItems| (items.curve_count(), items.side_count(), items.factor_count());
            assert_eq!(counts(&own), counts(&listed), "{}", mesh.name);
            assert!((0..own.curve_count()).all(|i| own.curve(i) == listed.curve(i)), "{}", mesh.name);
            assert!((0..own.side_count()).all(|i| own.side(i) == listed.side(i)), "{}", mesh.name);
            assert!((0..=own.curve_count()).all(|i| own.factor_curve(i) == listed.factor_curve(i)), "{}", mesh.name);
            let of_side = |items: &CurveItems, side| (items.curve_of(side), items.factor(side));
            let sides = 0..to_u32(topology.sides.len());
            assert!(sides.into_iter().all(|i| of_side(&own, i) == of_side(&listed, i)), "{}", mesh.name);
        }
    }

    #[test]
    fn shared_curves_run_as_their_edge_does() {
        let mesh = Shape::CubeSplit.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("not cancelled");
        for (sharing, curves_per_split_edge, curves_per_diagonal) in
            [(Sharing::AllSides, 1, 1), (Sharing::EqualNormals, 2, 1), (Sharing::EachSide, 2, 2), (Sharing::None, 2, 2)]
        {
            let curves = Curves::build(&mesh, &topology, sharing);
            let diagonals = 6 * curves_per_diagonal;
            let factors = if sharing.is_per_patch() { topology.sides.len() } else { topology.edges.len() };
            assert_eq!(curves.factor_count() as usize, factors, "{sharing:?}");
            assert_eq!(curves.curves.len(), 12 * curves_per_split_edge + diagonals, "{sharing:?}");
            for (index, side) in (0..).zip(&topology.sides) {
                let [a, b] = curves.curves[curves.side_curves[index as usize] as usize].points;
                assert_eq!(curves.runs_against(&topology, index), side.reversed() && !sharing.is_per_patch());
                assert_eq!(a < b, !(sharing.is_per_patch() && side.reversed()));
            }
        }
    }
}
