//! Compares the control points that the sides of an edge were given, each by itself.

use glam::{DVec3, Vec3};

use geometry::mesh::{Curves, Topology};

/// Where the sides of edges have different control points.
#[derive(Clone, Debug, PartialEq)]
pub struct PointsAgreement {
    /// Edges with several sides.
    pub edges_compared: u64,
    /// Edges whose sides differ in at least one bit of a control point, the largest distance first.
    pub edges: Vec<PointsDisagreement>,
}

/// An edge whose sides have different control points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointsDisagreement {
    /// Index in [`Topology::edges`].
    pub edge: u32,
    /// The largest distance between the control points of two sides near the same end, in object units.
    pub distance: f64,
    /// The mesh's triangles of these two sides.
    pub triangles: [u32; 2],
}

impl PointsAgreement {
    /// Compares the first side of every edge with the others. `nets` has for each curve the control points near its start and near
    /// its end, in object units.
    pub fn new(topology: &Topology, curves: &Curves, nets: &[[Vec3; 2]]) -> Self {
        // The control points of a side in its edge's direction.
        let along_edge = |side: u32| {
            let [ab, ba] = nets[curves.side_curves[side as usize] as usize];
            let runs_as_curve = topology.sides[side as usize].reversed() == curves.runs_against(topology, side);
            if runs_as_curve { [ab, ba] } else { [ba, ab] }
        };
        let triangle = |side: u32| topology.patches[topology.sides[side as usize].patch() as usize].triangle;
        let mut agreement = Self { edges_compared: 0, edges: Vec::new() };
        for (index, edge) in (0..).zip(&topology.edges) {
            let mut others = topology.side_range(edge);
            let Some(first) = others.next().filter(|_| !others.is_empty()) else { continue };
            agreement.edges_compared += 1;
            let own = along_edge(first);
            let apart = others.filter(|&other| bits(own) != bits(along_edge(other)));
            let apart = apart.map(|other| (farthest(own, along_edge(other)), other));
            if let Some((distance, other)) = apart.max_by(|a, b| a.0.total_cmp(&b.0)) {
                let triangles = [triangle(first), triangle(other)];
                agreement.edges.push(PointsDisagreement { edge: index, distance, triangles });
            }
        }
        agreement.edges.sort_by(|a, b| b.distance.total_cmp(&a.distance));
        agreement
    }

    /// The largest distance, in object units; 0 where all sides agree.
    pub fn max_distance(&self) -> f64 {
        self.edges.first().map_or(0.0, |edge| edge.distance)
    }
}

fn bits(points: [Vec3; 2]) -> [[u32; 3]; 2] {
    points.map(|point| point.to_array().map(f32::to_bits))
}

fn farthest(a: [Vec3; 2], b: [Vec3; 2]) -> f64 {
    let [[a, b], [c, d]]: [[DVec3; 2]; 2] = [a, b].map(|points| points.map(Vec3::as_dvec3));
    a.distance(c).max(b.distance(d))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::{Shape, Sharing};

    /// The straight edges' control points of every curve, of which one side's differ by this.
    fn of_straight(sharing: Sharing, side: u32, off: Vec3) -> (Topology, PointsAgreement) {
        let topology = Topology::build(&Shape::Icosahedron.build(), &Default::default()).expect("nobody cancels");
        let curves = Curves::build(&Shape::Icosahedron.build(), &topology, sharing);
        let mut nets: Vec<[Vec3; 2]> = curves
            .curves
            .iter()
            .map(|curve| {
                let [a, b] = curve.points.map(|point| topology.points[point as usize]);
                [(a * 2.0 + b) / 3.0, (b * 2.0 + a) / 3.0]
            })
            .collect();
        nets[curves.side_curves[side as usize] as usize][0] += off;
        let agreement = PointsAgreement::new(&topology, &curves, &nets);
        (topology, agreement)
    }

    #[test]
    fn a_side_that_differs_is_found_in_either_direction() {
        for sharing in [Sharing::EachSide, Sharing::None, Sharing::NoneAveraged] {
            let (topology, agreement) = of_straight(sharing, 0, Vec3::ZERO);
            assert_eq!((agreement.edges_compared, agreement.edges.len()), (30, 0), "{sharing:?}");
            assert_eq!(agreement.max_distance(), 0.0);
            for side in 0..topology.sides.len() as u32 {
                let (topology, agreement) = of_straight(sharing, side, Vec3::new(0.0, 0.25, 0.0));
                let own = &topology.sides[side as usize];
                let [found] = agreement.edges[..] else { panic!("{sharing:?} {side}: {:?}", agreement.edges) };
                assert_eq!(found.edge, own.edge);
                assert!((found.distance - 0.25).abs() < 1e-6 && found.distance == agreement.max_distance());
                assert!(found.triangles.contains(&topology.patches[own.patch() as usize].triangle));
            }
        }
    }
}
