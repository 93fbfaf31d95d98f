//! The tessellator on the CPU against the driver's own, for all of Direct3D's domains: every point and every primitive.

use std::collections::BTreeMap;

use geometry::tessellate::{
    DomainKind, IsolineFactors, Partitioning, QuadFactors, domain_plan, domain_point, domain_triangle, point_count,
    process, triangle_count,
};

use crate::engine;
use crate::exported::vulkan;
use crate::vulkan::patterns::{FactorSet, Tessellator};

/// How many sets of factors each domain is compared with under each partitioning.
const SETS: usize = 5000;

/// The corners of triangles, or the ends of lines.
type Primitives<const CORNERS: usize> = Vec<[[u32; 2]; CORNERS]>;

/// A factor: often a small one, a whole one, or one of those at which something begins.
fn factor(random: &mut fastrand::Rng) -> f32 {
    let scaled = 0.5 * 132f32.powf(random.f32());
    match random.u32(..16) {
        0..8 => scaled,
        8..12 => scaled.round(),
        12 => f32::from_bits(1f32.to_bits() + random.u32(..0x200)),
        13 => 1.0,
        14 => f32::from_bits((random.u32(1..65) as f32).to_bits().wrapping_add_signed(random.i32(-2..3))),
        _ => [64.0, 63.0, 2.0, 1e9, f32::INFINITY, 1e-30][random.usize(..6)],
    }
}

/// Random factors in Vulkan's order. Now and then one of them is zero or negative, which culls the patch or acts as the smallest.
fn factors(random: &mut fastrand::Rng, partitioning: Partitioning) -> [f32; 6] {
    let mut factors = [0; 6].map(|_| factor(random));
    if random.u32(..8) == 0 {
        let [first, ..] = factors;
        factors[..4].fill(first);
    }
    if random.u32(..16) == 0 {
        factors[random.usize(..6)] = [0.0, -0.0, -3.0, f32::NEG_INFINITY][random.usize(..4)];
    }
    factors.map(|factor| partitioning.hull_factor(factor))
}

fn placed<const CORNERS: usize>(points: &[[u32; 2]], primitives: &[[u32; CORNERS]]) -> Primitives<CORNERS> {
    primitives.iter().map(|own| own.map(|point| points[point as usize])).collect()
}

fn triangle(partitioning: Partitioning, [u, v, w, _, inside, _]: [f32; 6]) -> Primitives<3> {
    let own = process(partitioning, [u, v, w], inside);
    let plan = domain_plan(own);
    let points: Vec<_> = (0..point_count(own)).map(|i| domain_point(&plan, i)).collect();
    let triangles: Vec<_> = (0..triangle_count(own)).map(|t| domain_triangle(&plan, t)).collect();
    placed(&points, &triangles)
}

fn quad(partitioning: Partitioning, [u0, v0, u1, v1, u, v]: [f32; 6]) -> Primitives<3> {
    let own = QuadFactors::new(partitioning, [u0, v0, u1, v1], [u, v]);
    own.map_or_else(Vec::new, |own| placed(&own.points(), &own.triangles()))
}

fn isolines(partitioning: Partitioning, [density, detail, ..]: [f32; 6]) -> Primitives<2> {
    let own = IsolineFactors::new(partitioning, density, detail);
    own.map_or_else(Vec::new, |own| placed(&own.points(), &own.lines()))
}

/// How often each primitive is there, whichever its first corner. Hardware makes them in any order, and winds triangles without
/// an area either way.
fn counted<const CORNERS: usize>(primitives: &Primitives<CORNERS>) -> BTreeMap<[[u32; 2]; CORNERS], usize> {
    let mut counts = BTreeMap::new();
    for mut corners in primitives.iter().copied() {
        let sides =
            [1, 2].map(|k| [0, 1].map(|axis| i64::from(corners[k % CORNERS][axis]) - i64::from(corners[0][axis])));
        if sides[0][0] * sides[1][1] == sides[0][1] * sides[1][0] {
            corners.sort_unstable();
        } else {
            let least = (0..CORNERS).min_by_key(|&k| corners[k]).unwrap_or(0);
            corners.rotate_left(least);
        }
        *counts.entry(corners).or_insert(0) += 1;
    }
    counts
}

/// Holds what `ours` makes of random factors to what the driver makes of them. A software driver follows the specification's order.
fn assert_agrees<const CORNERS: usize>(kind: DomainKind, ours: impl Fn(Partitioning, [f32; 6]) -> Primitives<CORNERS>) {
    let (vulkan, mut random) = (vulkan(), fastrand::Rng::with_seed(11));
    let is_ordered = engine().gpu.is_software();
    for partitioning in Partitioning::DIRECT3D {
        let tried: Vec<_> = (0..SETS).map(|_| factors(&mut random, partitioning)).collect();
        let expected: Vec<_> = tried.iter().map(|&factors| ours(partitioning, factors)).collect();
        let set = |(&factors, own): (_, &Primitives<CORNERS>)| FactorSet { factors, primitives: own.len() as u32 };
        let sets: Vec<_> = tried.iter().zip(&expected).map(set).collect();
        let tessellator = Tessellator::new(&vulkan, kind, partitioning).expect("a pipeline");
        let made = tessellator.run(&sets).expect("a driver that draws");
        for ((factors, own), theirs) in tried.iter().zip(&expected).zip(&made) {
            let same = if is_ordered { own == theirs } else { counted(own) == counted(theirs) };
            assert!(same, "{kind:?} {partitioning:?} {factors:?}: {} and {}", own.len(), theirs.len());
        }
        assert!(made.iter().filter(|own| !own.is_empty()).count() > SETS / 2, "few patches are drawn");
    }
}

#[test]
fn triangles_are_those_of_the_driver() {
    assert_agrees(DomainKind::Tri, triangle);
}

#[test]
fn quads_are_those_of_the_driver() {
    assert_agrees(DomainKind::Quad, quad);
}

#[test]
fn isolines_are_those_of_the_driver() {
    assert_agrees(DomainKind::Isoline, isolines);
}
