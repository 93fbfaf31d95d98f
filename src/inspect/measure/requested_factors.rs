//! The tessellation factors that were requested, before the tessellator clamped and rounded them.

use geometry::mesh::Topology;
use geometry::tessellate::{Convention, Edges, HullFactors, Partitioning, domain_side, factor_side, last_factor};

/// Factors before clamping and rounding, and the convention under which they were given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RequestedFactors {
    factors: Vec<f32>,
    owners: Owners,
    convention: Convention,
}

/// What each factor belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Owners {
    /// One per edge.
    #[default]
    Edges,
    /// One per side (an index into [`Topology::sides`]), as published.
    Sides,
    /// Three per patch, as they were given: TessFactor[0..2].
    Patches,
}

impl RequestedFactors {
    /// Factors from LOD.
    pub fn new(edges: Edges, convention: Convention, factors: Vec<f32>) -> Self {
        let owners = if edges == Edges::AsPublished { Owners::Sides } else { Owners::Edges };
        Self { factors, owners, convention }
    }

    /// Factors that were given in place of LOD's.
    pub fn given(convention: Convention, given: &[HullFactors]) -> Self {
        let factors = given.iter().flat_map(|patch| patch.edges).collect();
        Self { factors, owners: Owners::Patches, convention }
    }

    /// The factors from LOD; empty if factors were given.
    pub fn into_factors(self) -> Vec<f32> {
        if self.owners == Owners::Patches { Vec::new() } else { self.factors }
    }

    /// How many factors are larger than the largest of a partitioning.
    pub fn beyond(&self, partitioning: Partitioning) -> u64 {
        let most = last_factor(partitioning);
        self.factors.iter().filter(|&&factor| factor > most).count() as u64
    }

    /// Which of a patch's factors cuts its side `k`.
    pub(super) fn index(&self, k: usize) -> usize {
        (0..3).position(|i| domain_side(self.convention, i) == k as u32).unwrap_or_default()
    }

    /// A patch's factor `i`, as it was requested.
    pub(super) fn of(&self, topology: &Topology, patch: u32, i: usize) -> f32 {
        let side = topology.patches[patch as usize].sides[factor_side(self.convention, i as u32) as usize];
        let index = match self.owners {
            Owners::Edges => topology.sides[side as usize].edge as usize,
            Owners::Sides => side as usize,
            Owners::Patches => 3 * patch as usize + i,
        };
        self.factors.get(index).copied().unwrap_or(f32::NAN)
    }
}
