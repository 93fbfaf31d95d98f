//! The tessellation factors that were asked for, before the tessellator clamped and rounded them.

use crate::mesh::Topology;
use crate::tessellate::{Convention, Edges, HullFactors, Partitioning, domain_side, factor_side};

/// The factors that were asked for, before the tessellator clamped and rounded them, and the convention under which.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AskedFactors {
    factors: Vec<f32>,
    belong: Belong,
    convention: Convention,
}

/// What each of them belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Belong {
    /// An edge.
    #[default]
    Edges,
    /// As published, a side (an index into [`Topology::sides`]).
    Sides,
    /// Three a patch: TessFactor[0..2], as they were given.
    Patches,
}

impl AskedFactors {
    /// What LOD gave.
    pub fn new(edges: Edges, convention: Convention, factors: Vec<f32>) -> Self {
        let belong = if edges == Edges::AsPublished { Belong::Sides } else { Belong::Edges };
        Self { factors, belong, convention }
    }

    /// What was given in place of LOD's.
    pub fn given(convention: Convention, given: &[HullFactors]) -> Self {
        let factors = given.iter().flat_map(|patch| patch.edges).collect();
        Self { factors, belong: Belong::Patches, convention }
    }

    /// What LOD gave; nothing where factors were given.
    pub fn into_factors(self) -> Vec<f32> {
        if self.belong == Belong::Patches { Vec::new() } else { self.factors }
    }

    /// How many are larger than a partitioning's largest.
    pub fn beyond(&self, partitioning: Partitioning) -> u64 {
        let most = if partitioning == Partitioning::FractionalOdd { 63.0 } else { 64.0 };
        self.factors.iter().filter(|&&factor| factor > most).count() as u64
    }

    /// Which of a patch's factors its side `k` is cut by.
    pub(super) fn index(&self, k: usize) -> usize {
        (0..3).position(|i| domain_side(self.convention, i) == k as u32).unwrap_or_default()
    }

    /// What a patch's factor `i` was asked to be.
    pub(super) fn of(&self, topology: &Topology, patch: u32, i: usize) -> f32 {
        let side = topology.patches[patch as usize].sides[factor_side(self.convention, i as u32) as usize];
        let index = match self.belong {
            Belong::Edges => topology.sides[side as usize].edge as usize,
            Belong::Sides => side as usize,
            Belong::Patches => 3 * patch as usize + i,
        };
        self.factors.get(index).copied().unwrap_or(f32::NAN)
    }
}
