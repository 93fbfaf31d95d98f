//! Cuts polygons into triangles by ear clipping. Every corner is used, and no triangle of a valid polygon lies outside
//! it.
//!
//! Source: O'Rourke 1998, "Computational Geometry in C", section 1.6.6: cutting off an ear changes only whether its two
//! neighbours are ears. Libraries for this leave out corners on straight edges, which makes T-junctions.

use std::collections::VecDeque;

use glam::{DVec2, DVec3, Vec3};

/// The work that the polygons of one file may still cause, counted in tests whether a corner lies in a triangle.
#[derive(Clone, Copy, Debug)]
pub struct WorkBudget(u64);

impl WorkBudget {
    /// Returns the budget for a file of `bytes` bytes: enough for polygons of 3,000 corners in which every ear is
    /// tested against all other corners, and for many times as many corners in ordinary polygons.
    pub fn new(bytes: usize) -> Self {
        Self((1 << 23) + 4 * bytes as u64)
    }
}

/// How well a polygon was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CutQuality {
    /// All triangles lie within the polygon, without overlaps.
    Exact,
    /// The polygon has no area, its sides cross, or the budget was used up: triangles may overlap.
    MayOverlap,
}

/// Cuts a polygon of three corners or more into triangles, two fewer than it has corners. The triangles hold indices
/// into `outline` and have its winding. Takes time quadratic in the number of corners that turn inward, but never more
/// than the budget.
pub fn triangulate(outline: &[Vec3], budget: &mut WorkBudget, triangles: &mut Vec<[usize; 3]>) -> CutQuality {
    if outline.len() == 3 {
        triangles.push([0, 1, 2]);
        return CutQuality::Exact;
    }
    let normal = newell(outline);
    let mut ears = Ears::new(flat(outline, normal), budget);
    ears.cut(triangles);
    if ears.forced || normal == DVec3::ZERO { CutQuality::MayOverlap } else { CutQuality::Exact }
}

/// Returns Newell's normal. Its length is twice the polygon's area, seen from the direction in which that is largest.
fn newell(outline: &[Vec3]) -> DVec3 {
    let first = outline[0].as_dvec3();
    outline.array_windows().map(|&[a, b]| (a.as_dvec3() - first).cross(b.as_dvec3() - first)).sum()
}

/// Projects the outline along the axis that is nearest to its normal, so that it is counter-clockwise. Coordinates stay
/// exact.
fn flat(outline: &[Vec3], normal: DVec3) -> Vec<DVec2> {
    let size = normal.abs();
    let (u, v, w) = match () {
        () if size.x > size.y && size.x > size.z => (1, 2, normal.x),
        () if size.y > size.z => (2, 0, normal.y),
        () => (0, 1, normal.z),
    };
    let sign = if w < 0.0 { -1.0 } else { 1.0 };
    outline.iter().map(|p| DVec2::new(f64::from(p[u]) * sign, f64::from(p[v]))).collect()
}

/// A polygon that is being cut.
struct Ears<'a> {
    points: Vec<DVec2>,
    /// The axis along which the polygon is longer: 0 or 1.
    axis: usize,
    /// The neighbours of each corner among those that are left.
    before: Vec<usize>,
    after: Vec<usize>,
    /// The corners that turn inward or are straight, sorted along that axis: only these can lie in an ear. Some may
    /// have been removed, or turn outward by now.
    inward: Vec<usize>,
    /// Corners that were ears when they were tested, the next one first, each with the number of that test.
    queue: VecDeque<(usize, u32)>,
    /// How often each corner has been tested.
    looks: Vec<u32>,
    /// Whether each corner has been removed.
    gone: Vec<bool>,
    budget: &'a mut WorkBudget,
    /// Whether a triangle had to be cut off that isn't an ear, or wasn't tested.
    forced: bool,
}

impl<'a> Ears<'a> {
    fn new(points: Vec<DVec2>, budget: &'a mut WorkBudget) -> Self {
        let count = points.len();
        let least = points.iter().fold(points[0], |least, p| least.min(*p));
        let size = points.iter().fold(points[0], |most, p| most.max(*p)) - least;
        let axis = usize::from(size.y > size.x);
        let before: Vec<_> = (0..count).map(|i| (i + count - 1) % count).collect();
        let after: Vec<_> = (0..count).map(|i| (i + 1) % count).collect();
        let (queue, looks, gone) = (VecDeque::new(), vec![0; count], vec![false; count]);
        let mut ears =
            Self { points, axis, before, after, inward: Vec::new(), queue, looks, gone, budget, forced: false };
        let mut inward: Vec<usize> = (0..count).filter(|&i| ears.turn(i) <= 0.0).collect();
        inward.sort_unstable_by(|&a, &b| ears.points[a][axis].total_cmp(&ears.points[b][axis]));
        ears.inward = inward;
        // Starts with the second corner, so that a quadrilateral is cut from its first.
        (1..=count).for_each(|i| ears.look(i % count));
        ears
    }

    fn cut(&mut self, triangles: &mut Vec<[usize; 3]>) {
        let mut left = self.points.len();
        let (mut any, mut sweep) = (0, left / 2);
        while left > 3 {
            if left == sweep {
                // Corners that have been removed or now turn outward need no more tests.
                let mut inward = std::mem::take(&mut self.inward);
                inward.retain(|&i| !self.gone[i] && self.turn(i) <= 0.0);
                self.inward = inward;
                sweep /= 2;
            }
            let ear = self.next_ear().unwrap_or_else(|| {
                self.forced = true;
                self.any_left(&mut any)
            });
            any = self.after[ear];
            triangles.push([self.before[ear], ear, self.after[ear]]);
            self.remove(ear);
            left -= 1;
        }
        let last = self.any_left(&mut any);
        triangles.push([self.before[last], last, self.after[last]]);
    }

    fn next_ear(&mut self) -> Option<usize> {
        while let Some((corner, look)) = self.queue.pop_front() {
            if look == self.looks[corner] && !self.gone[corner] {
                return Some(corner);
            }
        }
        None
    }

    /// Returns the first corner from `from` on that is left, and sets `from` to it.
    fn any_left(&self, from: &mut usize) -> usize {
        while self.gone[*from] {
            *from = self.after[*from];
        }
        *from
    }

    fn remove(&mut self, ear: usize) {
        let (before, after) = (self.before[ear], self.after[ear]);
        self.gone[ear] = true;
        self.after[before] = after;
        self.before[after] = before;
        [after, before].into_iter().for_each(|corner| self.look(corner));
    }

    /// Tests a corner, and queues it behind all others if it is an ear. So a large polygon doesn't become a fan.
    fn look(&mut self, corner: usize) {
        self.looks[corner] += 1;
        if self.is_ear(corner) {
            self.queue.push_back((corner, self.looks[corner]));
        }
    }

    fn is_ear(&mut self, corner: usize) -> bool {
        if self.turn(corner) <= 0.0 {
            return false;
        }
        let corners = [self.before[corner], corner, self.after[corner]];
        let [a, b, c] = corners.map(|i| self.points[i]);
        let (least, most) = (a.min(b).min(c), a.max(b).max(c));
        let (axis, points) = (self.axis, &self.points);
        let first = self.inward.partition_point(|&i| points[i][axis] < least[axis]);
        for &i in &self.inward[first..] {
            if self.points[i][axis] > most[axis] {
                break;
            }
            if self.budget.0 == 0 {
                self.forced = true;
                return true;
            }
            self.budget.0 -= 1;
            let p = self.points[i];
            let near = p.x >= least.x && p.x <= most.x && p.y >= least.y && p.y <= most.y;
            if near && !self.gone[i] && !corners.contains(&i) && p != a && p != b && p != c {
                let inside = cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0;
                if inside && self.turn(i) <= 0.0 {
                    return false;
                }
            }
        }
        true
    }

    /// Returns twice the area of a corner's triangle: above 0 where the outline turns outward.
    fn turn(&self, corner: usize) -> f64 {
        cross(self.points[self.before[corner]], self.points[corner], self.points[self.after[corner]])
    }
}

fn cross(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cut(outline: &[Vec3]) -> (Vec<[usize; 3]>, CutQuality) {
        let mut triangles = Vec::new();
        let cut = triangulate(outline, &mut WorkBudget::new(0), &mut triangles);
        (triangles, cut)
    }

    fn in_plane(outline: &[[f32; 2]]) -> Vec<Vec3> {
        outline.iter().map(|&[x, y]| Vec3::new(x, y, 2.0)).collect()
    }

    /// The area vectors of the triangles, doubled.
    fn areas(outline: &[Vec3], triangles: &[[usize; 3]]) -> Vec<DVec3> {
        let area = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| outline[i].as_dvec3());
            (b - a).cross(c - a)
        };
        triangles.iter().map(area).collect()
    }

    /// Checks that there are as many triangles as there must be, that all have the outline's winding, and that their
    /// areas add up to its area, so that none overlap.
    fn assert_exact(outline: &[Vec3]) {
        let (triangles, how) = cut(outline);
        assert_eq!((triangles.len(), how), (outline.len() - 2, CutQuality::Exact));
        let (whole, areas) = (newell(outline), areas(outline, &triangles));
        assert!(areas.iter().all(|area| area.dot(whole) > 0.0), "a triangle turns the other way, or has no area");
        let sum: DVec3 = areas.iter().sum();
        assert!((sum - whole).length() < 1e-9 * whole.length());
    }

    #[test]
    fn quadrilaterals_are_cut_from_the_first_corner_or_where_they_must_be() {
        let square = in_plane(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(cut(&square), (vec![[0, 1, 2], [0, 2, 3]], CutQuality::Exact));
        let arrow = in_plane(&[[0.0, 0.0], [4.0, -3.0], [1.0, 0.0], [4.0, 3.0]]);
        assert_exact(&arrow);
        assert!(cut(&arrow).0.iter().all(|t| t.contains(&0) && t.contains(&2)), "along the notch");
    }

    #[test]
    fn concave_outlines_in_every_plane_and_either_turn() {
        let comb: Vec<[f32; 2]> = (0..40)
            .map(|i| [(i / 2) as f32, if (i / 2) % 2 == 0 { 1.0 + (i % 2) as f32 } else { 9.0 - (i % 2) as f32 }])
            .chain([[19.0, -1.0], [0.0, -1.0]])
            .collect();
        for outline in [comb.clone(), comb.into_iter().rev().collect()] {
            let flat = in_plane(&outline);
            assert_exact(&flat);
            assert_exact(&flat.iter().map(|p| Vec3::new(p.z, p.x, p.y)).collect::<Vec<_>>());
            assert_exact(&flat.iter().map(|p| Vec3::new(p.y, p.z, p.x)).collect::<Vec<_>>());
            assert_exact(&flat.iter().map(|p| Vec3::new(p.x + p.y, p.y, p.x - 2.0 * p.y)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn corners_on_straight_edges_are_used() {
        let outline = in_plane(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [3.0, 3.0], [1.5, 3.0], [0.0, 3.0]]);
        assert_exact(&outline);
    }

    #[test]
    fn large_convex_outlines_do_not_become_fans() {
        let round = |i: usize| {
            let angle = std::f64::consts::TAU * i as f64 / 1000.0;
            Vec3::new((1e3 * angle.cos()) as f32, (1e3 * angle.sin()) as f32, 0.0)
        };
        let outline: Vec<Vec3> = (0..1000).map(round).collect();
        assert_exact(&outline);
        let mut of_corner = vec![0; outline.len()];
        cut(&outline).0.iter().flatten().for_each(|&corner| of_corner[corner] += 1);
        assert!(of_corner.iter().all(|&count| count < 30));
    }

    #[test]
    fn outlines_without_area_or_with_crossings_may_overlap() {
        let line = in_plane(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 0.0], [0.5, 0.0]]);
        let bow = in_plane(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
        for outline in [line, bow, vec![Vec3::ONE; 9]] {
            let (triangles, how) = cut(&outline);
            assert_eq!((triangles.len(), how), (outline.len() - 2, CutQuality::MayOverlap));
        }
    }

    #[test]
    fn large_outlines_are_cut_exactly() {
        let outline: Vec<Vec3> = (0..20_000)
            .map(|i| {
                let angle = std::f64::consts::TAU * f64::from(i) / 20_000.0;
                let radius = 1e6 * (1.0 + 0.01 * f64::from(i % 2));
                Vec3::new((radius * angle.cos()).round() as f32, (radius * angle.sin()).round() as f32, 0.0)
            })
            .collect();
        assert_exact(&outline);
    }

    #[test]
    fn the_budget_ends_the_work_of_hostile_outlines() {
        // A comb: each tooth has all inward corners in its range.
        let tooth = |i: u32| [[0.0, i as f32], [1e7, i as f32 + 0.5]];
        let comb: Vec<[f32; 2]> = (0..50_000).flat_map(tooth).chain([[0.0, 5e4], [-1.0, 5e4], [-1.0, 0.0]]).collect();
        let (outline, mut budget, mut triangles) = (in_plane(&comb), WorkBudget::new(0), Vec::new());
        assert_eq!(triangulate(&outline, &mut budget, &mut triangles), CutQuality::MayOverlap);
        assert_eq!((triangles.len(), budget.0), (outline.len() - 2, 0));
    }

    #[test]
    fn no_ear_has_a_corner_on_its_open_side() {
        // The fifth corner lies in the middle of the line between the first and the third, which would otherwise be cut
        // off with the second: what is left would touch itself, and have a triangle without area.
        for axes in [[0, 1], [1, 0]] {
            let outline = [[4.0, 2.0], [0.0, 1.0], [4.0, 0.0], [10.0, 0.0], [4.0, 1.0], [10.0, 2.0]];
            assert_exact(&in_plane(&outline.map(|p: [f32; 2]| axes.map(|axis| p[axis]))));
        }
    }

    proptest! {
        /// Outlines around a centre from which all of them can be seen, in whole numbers, for which the test is exact.
        #[test]
        fn stars_of_any_shape_are_cut_exactly(radii in prop::collection::vec(200_u32..4000, 4..40)) {
            let count = radii.len() as f64;
            let outline: Vec<Vec3> = radii.iter().enumerate().map(|(i, &radius)| {
                let angle = std::f64::consts::TAU * i as f64 / count;
                let [x, y] = [angle.cos(), angle.sin()].map(|x| (x * f64::from(radius)).round() as f32);
                Vec3::new(x, y, 0.0)
            }).collect();
            assert_exact(&outline);
        }

        #[test]
        fn any_outline_gets_its_triangles(points in prop::collection::vec(prop::array::uniform3(-3_i8..3), 3..30)) {
            let outline: Vec<Vec3> = points.iter().map(|p| Vec3::from(p.map(f32::from))).collect();
            let triangles = cut(&outline).0;
            prop_assert_eq!(triangles.len(), outline.len() - 2);
            prop_assert!(triangles.iter().all(|&[a, b, c]| a != b && b != c && c != a));
            // Every side of the outline is a side of exactly one triangle, in the same direction.
            for i in 0..outline.len() {
                let side = (i, (i + 1) % outline.len());
                let sides = || triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
                prop_assert_eq!(sides().filter(|&s| s == side).count(), 1);
            }
        }
    }
}
