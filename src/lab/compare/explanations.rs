//! Which one change of our factors gives the points that another program has.

use std::collections::HashMap;

use super::OurTessellation;
use super::assignment::{Assignment, Part};
use super::cuts::cuts_of;
use super::domain_points::{DomainPoints, pattern_points};
use super::foreign::spread;
use super::matching::Reach;
use geometry::choice::texts;
use geometry::tessellate::{
    Convention, HullFactors, Inputs, Partitioning, PatchFactors, Tessellation, domain_side, factor_side,
};

/// A change of what the hull shader writes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// None: the factors are ours.
    Same,
    /// Side k has the factor of this side.
    Sides([usize; 3]),
    /// Factors are rounded down to whole numbers.
    Down,
    /// Factors are rounded to the nearest whole number.
    Nearest,
    /// The inside factor is another function of the factors of the edges.
    Inside(InsideRule),
    /// All factors are ours times this.
    Times(f32),
    /// Factors are at most this.
    AtMost(f32),
    /// All factors are this.
    All(f32),
}

texts! {
    /// How an inside factor follows from those of the edges.
    pub enum InsideRule, fn text {
        Least => "the least of the edges' factors",
        Mean => "the mean of the edges' factors",
        Largest => "the largest of the edges' factors",
        One => "1",
    }
}

/// Factors that give their points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Explanation {
    pub partitioning: Partitioning,
    pub rule: Rule,
}

/// Side k may have the factor of another side in these ways.
const SIDES: [[usize; 3]; 5] = [[2, 0, 1], [1, 2, 0], [0, 2, 1], [1, 0, 2], [2, 1, 0]];

/// Lengths on screen, and distances, are the same to within rounding if they differ by no more than this share.
const HAIR: f32 = 1e-4;
/// The same for errors on screen, which are small differences of large numbers.
const HAIR_OF_ERRORS: f32 = 2e-3;
/// How many patches are looked at first.
const SAMPLE: usize = 64;
/// Factors explain points if at least this share of the patches has them.
const EXPLAINED: f64 = 0.97;

impl Rule {
    /// The convention under which sides have each other's factors like this, if it is a known one.
    pub fn convention(self) -> Option<Convention> {
        let Self::Sides(sides) = self else { return None };
        Convention::ALL.into_iter().find(|&convention| {
            (0..3).all(|i| sides[domain_side(convention, i) as usize] == factor_side(convention, i) as usize)
        })
    }

    /// Changes the factors of sides 0, 1 and 2, and that of the inside.
    fn apply(self, sides: [f32; 3], inside: f32) -> ([f32; 3], f32) {
        let each = |change: &dyn Fn(f32) -> f32| (sides.map(change), change(inside));
        match self {
            Self::Same => (sides, inside),
            Self::Sides(order) => (order.map(|side| sides[side]), inside),
            Self::Down => each(&|factor| factor.floor().max(1.0)),
            Self::Nearest => each(&|factor| factor.round().max(1.0)),
            Self::Inside(rule) => (sides, rule.apply(sides)),
            Self::Times(times) => each(&|factor| factor * times),
            Self::AtMost(most) => each(&|factor| factor.min(most)),
            Self::All(all) => ([all; 3], all),
        }
    }
}

impl InsideRule {
    fn apply(self, sides: [f32; 3]) -> f32 {
        match self {
            Self::Least => sides.into_iter().fold(f32::INFINITY, f32::min),
            Self::Mean => sides.into_iter().sum::<f32>() / 3.0,
            Self::Largest => sides.into_iter().fold(0.0, f32::max),
            Self::One => 1.0,
        }
    }
}

/// Seeks explanations.
pub(super) struct Explainer<'a> {
    pub ours: &'a OurTessellation<'a>,
    pub assignment: &'a Assignment<'a>,
    /// Our inputs with the surface that their vertices lie on, if it isn't ours.
    pub other: Option<&'a Inputs>,
    /// How near points of each patch must be.
    pub reaches: &'a [Reach],
}

/// A patch of theirs that is looked at first, and what they have there.
type Sampled = (u32, Part);

impl Explainer<'_> {
    /// Returns the simplest explanations, which all give their points. `different` are the patches whose points differ from ours.
    pub(super) fn explain(&self, different: &[u32]) -> Vec<Explanation> {
        let sample = self.sample(different);
        if sample.is_empty() {
            return Vec::new();
        }
        let own = self.ours.inputs.tessellation.partitioning;
        let uniform = self.uniform(&sample);
        let first = |may_be_same: bool, inputs: &Inputs| {
            let same = may_be_same.then(|| vec![Explanation { partitioning: own, rule: Rule::Same }]);
            self.first(same.into_iter().chain(self.groups(own, uniform)), inputs, &sample, different)
        };
        // LOD of another surface has other factors, which are no mistake.
        let of_other = self.other.map(|other| first(true, other)).filter(|found| !found.is_empty());
        // Where vertices are displaced, points of the same factors may seem to be others.
        let is_rough = !self.assignment.overlaid.fit.is_finite();
        of_other.unwrap_or_else(|| first(is_rough, self.ours.inputs))
    }

    /// Returns the explanations of the first group that has one, where LOD has these inputs.
    fn first(
        &self,
        groups: impl Iterator<Item = Vec<Explanation>>,
        inputs: &Inputs,
        sample: &[Sampled],
        different: &[u32],
    ) -> Vec<Explanation> {
        let mut written: HashMap<Partitioning, Vec<HullFactors>> = HashMap::new();
        let mut explains = |explanation: &Explanation| {
            let Explanation { partitioning, .. } = *explanation;
            let factors = written.entry(partitioning).or_insert_with(|| self.written(inputs, partitioning));
            self.explains(*explanation, factors, sample, different)
        };
        let mut found = groups.map(|group| group.into_iter().filter(&mut explains).collect::<Vec<_>>());
        found.find(|group| !group.is_empty()).unwrap_or_default()
    }

    /// Whether the last bits of LOD's factors decide between their points and ours: factors for a hair more or less detail give theirs.
    pub(super) fn are_last_bits(&self, different: &[u32]) -> bool {
        let own = self.ours.inputs.tessellation;
        if self.ours.given.is_some() || !own.used_lod().follows_view() {
            return false;
        }
        let hair = if own.used_lod().is_by_error() { HAIR_OF_ERRORS } else { HAIR };
        let written = [1.0 - hair, 1.0 + hair].map(|by| {
            let (pixels, tolerance, near, far) = (own.pixels * by, own.tolerance * by, own.near * by, own.far * by);
            let tessellation = Tessellation { pixels, tolerance, near, far, ..own };
            self.written(&Inputs { tessellation, ..*self.ours.inputs }, own.partitioning)
        });
        let same = Explanation { partitioning: own.partitioning, rule: Rule::Same };
        different.iter().all(|&patch| {
            let (part, reach) = (self.assignment.part(patch), self.reaches[patch as usize]);
            let gives = |written: &Vec<HullFactors>| {
                has_points(&part, self.factors(same, written[patch as usize]), own.convention, reach)
            };
            part.is_whole() && written.iter().any(gives)
        })
    }

    /// Groups of explanations, the simplest first. `uniform` is the one factor that all their edges seem to have.
    fn groups(&self, own: Partitioning, uniform: Option<f32>) -> [Vec<Explanation>; 3] {
        let with = |partitioning| move |rule| Explanation { partitioning, rule };
        let others = || Partitioning::ALL.into_iter().filter(move |other| *other != own);
        let mut changed: Vec<Rule> = vec![Rule::Down, Rule::Nearest];
        changed.extend(InsideRule::ALL.map(Rule::Inside));
        changed.extend([0.5, 2.0].map(Rule::Times));
        changed.extend([8.0, 15.0, 16.0, 31.0, 32.0].map(Rule::AtMost));
        // Under rows the inside factor names an edge, whose factor would be another one.
        let orders = SIDES.map(Rule::Sides).into_iter().filter(|_| !own.has_rows());
        let one = uniform.map(Rule::All);
        let first = others().map(|other| with(other)(Rule::Same)).chain(orders.map(with(own)));
        let second =
            |other| SIDES.map(Rule::Sides).into_iter().chain(one).chain(changed.iter().copied()).map(with(other));
        [
            one.map(with(own)).into_iter().chain(first).collect(),
            changed.iter().copied().map(with(own)).collect(),
            others().flat_map(second).collect(),
        ]
    }

    /// What a hull shader would write with these inputs, but this partitioning.
    fn written(&self, inputs: &Inputs, partitioning: Partitioning) -> Vec<HullFactors> {
        let tessellation = Tessellation { partitioning, ..inputs.tessellation };
        self.ours.written(&Inputs::new(&tessellation, inputs.view))
    }

    /// Patches of theirs without gaps: of those that differ, and a few others.
    fn sample(&self, different: &[u32]) -> Vec<Sampled> {
        let all = 0..self.ours.topology.patches.len() as u32;
        let same: Vec<u32> = all.filter(|patch| different.binary_search(patch).is_err()).collect();
        let chosen =
            |list: &[u32], most: usize| -> Vec<u32> { spread(list.len(), most).map(|place| list[place]).collect() };
        let patches = [chosen(different, SAMPLE), chosen(&same, SAMPLE / 4)].concat();
        let sampled = patches.into_iter().filter(|patch| self.assignment.count(*patch) > 0);
        sampled.map(|patch| (patch, self.assignment.part(patch))).filter(|(_, part)| part.is_whole()).collect()
    }

    /// The one factor that all edges of these patches seem to have.
    fn uniform(&self, sample: &[Sampled]) -> Option<f32> {
        let cuts = sample.iter().flat_map(|(patch, part)| cuts_of(part, self.reaches[*patch as usize]));
        let mut factors: Vec<f64> = cuts.map(|cut| cut.factor()).collect();
        factors.sort_by(f64::total_cmp);
        let middle = *factors.get(factors.len() / 2)?;
        let alike = factors.iter().filter(|factor| (*factor / middle - 1.0).abs() < 0.01).count();
        let plain = |unit: f64| Some((middle * unit).round() / unit).filter(|plain| (plain - middle).abs() < 0.003);
        let rounded = plain(1.0).or(plain(100.0)).unwrap_or((middle * 1e3).round() / 1e3);
        (alike as f64 >= EXPLAINED * factors.len() as f64).then_some(rounded as f32)
    }

    /// Whether factors explain their points: first on the sample, then on all patches, and on those that differ.
    fn explains(
        &self,
        explanation: Explanation,
        written: &[HullFactors],
        sample: &[Sampled],
        different: &[u32],
    ) -> bool {
        let fits = |patch: u32, part: &Part| {
            let factors = self.factors(explanation, written[patch as usize]);
            has_points(part, factors, self.ours.inputs.tessellation.convention, self.reaches[patch as usize])
        };
        let on_sample = sample.iter().filter(|(patch, part)| fits(*patch, part)).count();
        if (on_sample as f64) < EXPLAINED * sample.len() as f64 {
            return false;
        }
        let explained = |patches: &mut dyn Iterator<Item = u32>| {
            let (mut whole, mut fitting) = (0_u64, 0_u64);
            for patch in patches.filter(|patch| self.assignment.count(*patch) > 0) {
                let part = self.assignment.part(patch);
                if part.is_whole() {
                    whole += 1;
                    fitting += u64::from(fits(patch, &part));
                }
            }
            fitting as f64 >= EXPLAINED * whole as f64
        };
        // If few patches differ, our own factors explain nearly all of them, and nothing of what differs.
        explained(&mut different.iter().copied()) && explained(&mut (0..self.ours.topology.patches.len() as u32))
    }

    /// The factors of a patch under an explanation.
    fn factors(&self, Explanation { partitioning, rule }: Explanation, written: HullFactors) -> PatchFactors {
        if rule == Rule::Same || written.culls() {
            return written.rounded(partitioning).process(partitioning);
        }
        let convention = self.ours.inputs.tessellation.convention;
        let (sides, inside) = rule.apply(written.cutting(convention), written.inside);
        let edges = [0, 1, 2].map(|i| sides[domain_side(convention, i) as usize]);
        HullFactors { edges, inside }.rounded(partitioning).process(partitioning)
    }
}

/// Whether a patch of theirs has the points that these factors give. A vertex off the surface may be any of them.
fn has_points(part: &Part, factors: PatchFactors, convention: Convention, reach: Reach) -> bool {
    let expected = pattern_points(factors, convention);
    let pattern = DomainPoints::new(expected.iter().copied());
    let on_surface = || part.places.iter().filter(|place| place.distance <= reach.fit);
    if !on_surface().all(|place| pattern.nearest(place.weights, reach.domain).is_some()) {
        return false;
    }
    let strays = part.places.len() - on_surface().count();
    let theirs = DomainPoints::new(on_surface().map(|place| place.weights));
    expected.iter().filter(|point| theirs.nearest(**point, reach.domain).is_none()).count() <= strays
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_mistakes_are_conventions_and_other_orders_are_none() {
        let named = SIDES.map(|sides| Rule::Sides(sides).convention());
        assert_eq!(named, [Some(Convention::Rotated), None, Some(Convention::Mirrored), None, None]);
    }

    #[test]
    fn rules_change_factors_as_they_say() {
        let (sides, inside) = ([2.5, 3.4, 9.0], 9.0);
        assert_eq!(Rule::Down.apply(sides, inside), ([2.0, 3.0, 9.0], 9.0));
        assert_eq!(Rule::Nearest.apply(sides, inside), ([3.0, 3.0, 9.0], 9.0));
        assert_eq!(Rule::Sides([2, 0, 1]).apply(sides, inside), ([9.0, 2.5, 3.4], 9.0));
        assert_eq!(Rule::Inside(InsideRule::Least).apply(sides, inside), (sides, 2.5));
        assert_eq!(Rule::AtMost(3.0).apply(sides, inside), ([2.5, 3.0, 3.0], 3.0));
        assert_eq!(Rule::All(7.0).apply(sides, inside), ([7.0; 3], 7.0));
    }
}
