//! Checks factors that were given patch by patch: whether the sides of every edge have the same factor, and if not, in which
//! order of a patch's factors they would.

use geometry::mesh::{Side, Topology};
use geometry::tessellate::{Convention, HullFactors, domain_side, factor_side};

/// The result of the check.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement {
    /// Edges with several sides that emit something.
    pub edges_compared: u64,
    /// Patches that the tessellator leaves out because a factor isn't greater than zero.
    pub patches_culled: u64,
    /// Edges whose sides have different factors, the largest difference first.
    pub edges: Vec<Disagreement>,
    /// Every order that the three factors of a patch can have.
    pub orders: [Order; 6],
}

/// An edge whose sides have different factors.
#[derive(Clone, Debug, PartialEq)]
pub struct Disagreement {
    /// Index in [`Topology::edges`].
    pub edge: u32,
    /// For every side that emits something: the mesh's triangle, and its factor.
    pub sides: Vec<(u32, f32)>,
}

impl Disagreement {
    /// The sides with the least and the greatest factor.
    pub fn extremes(&self) -> [(u32, f32); 2] {
        let less = |a: &&(u32, f32), b: &&(u32, f32)| a.1.total_cmp(&b.1);
        let (least, greatest) = (self.sides.iter().min_by(less), self.sides.iter().max_by(less));
        [least, greatest].map(|side| side.copied().unwrap_or_default())
    }

    fn difference(&self) -> f64 {
        let [least, greatest] = self.extremes().map(|(_, factor)| f64::from(factor));
        greatest - least
    }
}

/// An order that a patch's factors can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Order {
    /// The sides that factors 0, 1 and 2 are for.
    pub sides: [u32; 3],
    /// Edges whose sides have different factors in this order.
    pub different: u64,
}

impl Order {
    /// The first convention that writes factors in this order.
    pub fn convention(&self) -> Option<Convention> {
        Convention::ALL.into_iter().find(|&convention| order(convention, factor_side) == self.sides)
    }

    /// The convention that writes factors in this order, if it is a valid one.
    pub fn valid_convention(&self) -> Option<Convention> {
        self.convention().filter(|convention| convention.is_consistent())
    }
}

const ORDERS: [[u32; 3]; 6] = [[1, 2, 0], [2, 0, 1], [0, 1, 2], [2, 1, 0], [1, 0, 2], [0, 2, 1]];

fn order(convention: Convention, side: fn(Convention, u32) -> u32) -> [u32; 3] {
    [0, 1, 2].map(|i| side(convention, i))
}

impl Agreement {
    /// Compares the sides of every edge as they are cut under a convention.
    pub fn new(topology: &Topology, given: &[HullFactors], convention: Convention) -> Self {
        let culled: Vec<bool> = given.iter().map(|patch| patch.culls()).collect();
        let shown = order(convention, domain_side);
        let mut agreement = Self {
            edges_compared: 0,
            patches_culled: culled.iter().filter(|&&culled| culled).count() as u64,
            edges: Vec::new(),
            orders: ORDERS.map(|sides| Order { sides, different: 0 }),
        };
        let mut emitted: Vec<&Side> = Vec::new();
        for (index, edge) in (0..).zip(&topology.edges) {
            emitted.clear();
            emitted.extend(topology.edge_sides(edge).iter().filter(|side| !culled[side.patch() as usize]));
            if emitted.len() < 2 {
                continue;
            }
            agreement.edges_compared += 1;
            for order in &mut agreement.orders {
                if differ(&emitted, given, order.sides) {
                    order.different += 1;
                    if order.sides == shown {
                        let side = |side: &&Side| {
                            (topology.patches[side.patch() as usize].triangle, factor(given, side, shown))
                        };
                        agreement.edges.push(Disagreement { edge: index, sides: emitted.iter().map(side).collect() });
                    }
                }
            }
        }
        agreement.edges.sort_by(|a, b| b.difference().total_cmp(&a.difference()));
        agreement
    }

    /// The valid convention under which the fewest edges differ, and how many do.
    pub fn nearest(&self) -> Option<(Convention, u64)> {
        let valid = self.orders.iter().filter_map(|order| Some((order.valid_convention()?, order.different)));
        valid.min_by_key(|(_, different)| *different)
    }

    /// Orders that make all sides of every edge agree.
    pub fn consistent(&self) -> impl Iterator<Item = &Order> {
        self.orders.iter().filter(|order| order.different == 0)
    }
}

fn differ(sides: &[&Side], given: &[HullFactors], order: [u32; 3]) -> bool {
    let own = |side: &Side| factor(given, side, order).to_bits();
    sides.iter().any(|side| own(side) != own(sides[0]))
}

/// The factor of a side if factors 0, 1 and 2 are for the sides in `order`.
fn factor(given: &[HullFactors], side: &Side, order: [u32; 3]) -> f32 {
    let at = order.iter().position(|&k| k as usize == side.index()).unwrap_or_default();
    given[side.patch() as usize].edges[at]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;
    use geometry::mesh::Shape;
    use geometry::progress::Progress;
    use geometry::tessellate::{Lod, LodView, Tessellation, hull_factors};

    /// The factors that a convention writes for a torus seen at an angle.
    fn written(convention: Convention) -> (Topology, Vec<HullFactors>) {
        let mesh = Shape::Torus.build();
        let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
        let turned = glam::Mat4::from_rotation_y(0.4) * glam::Mat4::from_rotation_x(0.3) * 0.3;
        let view =
            LodView::new(glam::Mat4 { w_axis: glam::vec4(0.1, 0.0, 0.5, 1.0), ..turned }, glam::Vec2::splat(300.0));
        let settings = Settings::from(Tessellation { lod: Lod::Paper, convention, ..Tessellation::default() });
        let written = hull_factors(&mesh, &topology, &settings.inputs(view));
        (topology, written)
    }

    fn consistent(agreement: &Agreement) -> Vec<Option<Convention>> {
        agreement.consistent().map(Order::convention).collect()
    }

    #[test]
    fn the_order_that_factors_were_written_in_is_found() {
        for (wrote, named) in [
            (Convention::D3d11, Convention::D3d11),
            (Convention::AmdPn, Convention::AmdPn),
            (Convention::EdgeOrder, Convention::EdgeOrder),
            (Convention::Rotated, Convention::EdgeOrder),
            (Convention::Mirrored, Convention::Mirrored),
        ] {
            let (topology, given) = written(wrote);
            for read in Convention::ALL {
                let agreement = Agreement::new(&topology, &given, read);
                assert_eq!(consistent(&agreement), [Some(named)], "{wrote:?} as {read:?}");
                let agrees = (0..3).all(|i| factor_side(wrote, i) == domain_side(read, i));
                assert_eq!(agreement.edges.is_empty(), agrees, "{wrote:?} as {read:?}");
                let shown = agreement.orders.iter().find(|all| all.sides == order(read, domain_side));
                assert_eq!(shown.map(|order| order.different), Some(agreement.edges.len() as u64));
                assert_eq!((agreement.edges_compared, agreement.patches_culled), (384, 0));
                assert!(agreement.edges.is_sorted_by(|a, b| a.difference() >= b.difference()));
            }
        }
        // No convention has this order.
        let (topology, mut given) = written(Convention::D3d11);
        given.iter_mut().for_each(|patch| patch.edges.swap(1, 2));
        assert_eq!(consistent(&Agreement::new(&topology, &given, Convention::D3d11)), [None]);
    }

    #[test]
    fn one_side_that_disagrees_is_found_with_its_neighbour() {
        let (topology, mut given) = written(Convention::D3d11);
        // Factor 0 is for side 1.
        let side = topology.patches[7].sides[1];
        let edge = topology.sides[side as usize].edge;
        let kept = given[7].edges[0];
        given[7].edges[0] = f32::INFINITY;
        let agreement = Agreement::new(&topology, &given, Convention::D3d11);
        assert_eq!(agreement.edges.iter().map(|found| found.edge).collect::<Vec<_>>(), [edge]);
        let other = topology.edge_sides(&topology.edges[edge as usize]).iter().find(|side| side.patch() != 7);
        let other = topology.patches[other.expect("closed").patch() as usize].triangle;
        assert_eq!(agreement.edges[0].extremes(), [(other, kept), (topology.patches[7].triangle, f32::INFINITY)]);
        assert_eq!(consistent(&agreement), []);
        assert_eq!((agreement.orders[0].different, agreement.orders[0].sides), (1, [1, 2, 0]));
    }

    #[test]
    fn culled_patches_are_not_compared() {
        let (topology, mut given) = written(Convention::D3d11);
        given[7].edges[0] = f32::NAN;
        given[8].edges[2] = -1.0;
        let agreement = Agreement::new(&topology, &given, Convention::D3d11);
        assert_eq!((agreement.patches_culled, agreement.edges.len()), (2, 0));
        assert!(agreement.edges_compared <= 384 - 5 && agreement.edges_compared >= 384 - 6, "{agreement:?}");
        let nothing = vec![HullFactors::default(); given.len()];
        let agreement = Agreement::new(&topology, &nothing, Convention::D3d11);
        assert_eq!((agreement.edges_compared, agreement.consistent().count()), (0, 6));
    }
}
