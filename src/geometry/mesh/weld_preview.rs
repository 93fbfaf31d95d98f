//! What welding within various tolerances would change, for choosing one.

use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt;

use foldhash::fast::RandomState;
use serde::Serialize;

use super::Mesh;
use super::near_points::NearPoints;
use super::topology::{EdgeKind, Topology, is_degenerate};
use super::weld::merge_within;
use crate::casts::to_u32;
use crate::cores::in_ranges;
use crate::progress::{Cancelled, Progress};

/// What welding within a tolerance changes, compared with the exact weld.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WeldPreview {
    /// The tolerance, relative to the bounding diagonal.
    pub tolerance: f32,
    /// Boundary edges of the exact topology that the weld connects to another: afterwards their side belongs to an edge
    /// with two sides or more. Edges of triangles that collapse don't count. None if most triangles have a side that is no longer than
    /// the tolerance: such a weld destroys the mesh, and isn't tried.
    pub edges: Option<u32>,
    /// Triangles that are patches of the exact topology and degenerate after the weld. None as for `edges`.
    pub collapsed: Option<u32>,
}

impl fmt::Display for WeldPreview {
    /// Writes the changes as text, without the tolerance.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.edges.zip(self.collapsed) {
            None => write!(f, "not tried, since most triangles have a shorter side"),
            Some((0, 0)) => write!(f, "joins nothing"),
            Some((edges, 0)) => write!(f, "joins {edges} edges"),
            Some((edges, collapsed)) => write!(f, "joins {edges} edges, collapses {collapsed} triangles"),
        }
    }
}

/// The tolerances to try, relative to the bounding diagonal: from the rounding of f32 to distances that visibly change
/// a mesh.
pub const TOLERANCES: [f32; 6] = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// How many triangles of the mesh are tried to estimate how long most sides are.
const SAMPLES: usize = 512;

/// Returns how many edges a weld within each of [`TOLERANCES`] would join, and how many triangles it would collapse, in
/// their order. `exact` is the mesh's topology without a tolerance, if the caller has it. To save time and memory, only
/// points that have another one nearby are welded, and no topology is built for the welded meshes: only the edges that
/// were open are looked up in them. `progress` goes from 0 to 1.
///
/// # Errors
/// [`Cancelled`] when `progress` says so.
pub fn weld_previews(
    mesh: &Mesh,
    exact: Option<&Topology>,
    progress: &Progress,
) -> Result<Vec<WeldPreview>, Cancelled> {
    progress.set(0.0);
    progress.check()?;
    let mut previews = TOLERANCES.map(|tolerance| WeldPreview { tolerance, edges: Some(0), collapsed: Some(0) });
    let bounds = mesh.bounds();
    let distances = TOLERANCES.map(|tolerance| bounds.part(tolerance.into()));
    let exact = match exact {
        Some(exact) => Exact::from_topology(mesh, Cow::Borrowed(exact)),
        None => Exact::from_topology(mesh, Cow::Owned(Topology::build(mesh, progress)?)),
    };
    // All positions may be the same.
    if distances[0] > 0.0 {
        let few = distances.partition_point(|&distance| exact.leaves_most_sides_longer(mesh, distance));
        previews[few..].iter_mut().for_each(|preview| (preview.edges, preview.collapsed) = (None, None));
        let near = NearPoints::find(&exact.topology.points, &exact.numbers, &distances[..few]);
        let changed: Vec<usize> = (0..few).filter(|&k| near.within(k).next().is_some()).collect();
        // Two at a time: more would take much memory.
        for (step, pair) in changed.chunks(2).enumerate() {
            progress.set((2 * step + 1) as f32 / (changed.len() + 1) as f32);
            progress.check()?;
            let count = |k: usize| exact.welded(mesh, &exact.merged(&near, k, distances[k]));
            let counted = in_ranges(pair.len(), 1, |range| pair[range].iter().map(|&k| count(k)).collect::<Vec<_>>());
            for (&k, counted) in pair.iter().zip(counted.into_iter().flatten()) {
                [previews[k].edges, previews[k].collapsed] = counted.map(Some);
            }
        }
    }
    progress.set(1.0);
    Ok(previews.to_vec())
}

/// The exact topology, with which the welded meshes are compared.
struct Exact<'a> {
    /// Only its points and the points of corners are used. If it isn't the caller's, it has nothing else, to save memory.
    topology: Cow<'a, Topology>,
    /// A number for each point; those with different ones aren't joined. Empty if all are the same.
    numbers: Vec<u32>,
    /// Boundary edges: the triangle, and which of its sides.
    open: Vec<(u32, u8)>,
    /// The number of degenerate triangles.
    degenerate: u32,
}

impl<'a> Exact<'a> {
    #[expect(clippy::cast_possible_truncation, reason = "a side is one of three")]
    fn from_topology(mesh: &Mesh, mut topology: Cow<'a, Topology>) -> Self {
        let open = topology.edges.iter().filter(|edge| edge.kind == EdgeKind::Boundary);
        let open = open.map(|edge| {
            let side = topology.sides[edge.first_side as usize];
            (topology.patches[side.patch() as usize].triangle, side.index() as u8)
        });
        let (open, degenerate) = (open.collect(), topology.degenerate);
        let alike = mesh.rig.as_ref().map_or(&[][..], |rig| &rig.alike);
        let number = |&corner: &u32| alike.get(corner as usize).copied().unwrap_or_default();
        let numbers = if alike.is_empty() { Vec::new() } else { topology.point_corners.iter().map(number).collect() };
        if let Cow::Owned(topology) = &mut topology {
            (topology.patches, topology.sides, topology.edges) = Default::default();
        }
        Self { topology, numbers, open, degenerate }
    }

    /// Estimates whether most triangles have no side shorter than a distance in object units.
    fn leaves_most_sides_longer(&self, mesh: &Mesh, distance: f64) -> bool {
        let step = (mesh.triangles.len() / SAMPLES).max(1);
        let is_long = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| self.topology.corner_points[corner as usize]);
            let at = |point: u32| self.topology.points[point as usize].as_dvec3();
            [(a, b), (b, c), (c, a)].into_iter().all(|(a, b)| a == b || at(a).distance(at(b)) > distance)
        };
        let samples = mesh.triangles.iter().step_by(step);
        2 * samples.clone().filter(|corners| is_long(corners)).count() >= samples.len()
    }

    /// Returns for each point a number: the same for all that are joined by a weld within a tolerance, given by its index and in
    /// object units. Of `near` are the points that may be joined with another.
    fn merged(&self, near: &NearPoints, k: usize, tolerance: f64) -> Vec<u32> {
        let points = &self.topology.points;
        let place = |point: u32| {
            let number = self.numbers.get(point as usize).copied().unwrap_or_default();
            (points[point as usize], number)
        };
        if near.all_within(k) {
            return merge_within((0..to_u32(points.len())).map(place), tolerance).1;
        }
        let (_, merged) = merge_within(near.within(k).map(place), tolerance);
        let mut joined: Vec<u32> = (0..to_u32(points.len())).collect();
        // For each merged point, the first that it was made of.
        let mut first = Vec::new();
        for (point, merged) in near.within(k).zip(merged) {
            if merged as usize == first.len() {
                first.push(point);
            }
            joined[point as usize] = first[merged as usize];
        }
        joined
    }

    /// Returns how many boundary edges are joined, and how many triangles collapse, if points are joined like this.
    fn welded(&self, mesh: &Mesh, joined: &[u32]) -> [u32; 2] {
        let points =
            |triangle: &[u32; 3]| triangle.map(|corner| joined[self.topology.corner_points[corner as usize] as usize]);
        if self.open.is_empty() {
            let degenerate = mesh.triangles.iter().filter(|triangle| is_degenerate(points(triangle))).count();
            return [0, to_u32(degenerate) - self.degenerate];
        }
        // For each edge that a boundary edge becomes, given by its points (the lower first), the number of its sides.
        let key = |points: [u32; 3], side: usize| {
            let [a, b] = [points[side], points[(side + 1) % 3]];
            [a.min(b), a.max(b)]
        };
        let own = |&(triangle, side): &(u32, u8)| {
            let points = points(&mesh.triangles[triangle as usize]);
            (!is_degenerate(points)).then(|| key(points, side.into()))
        };
        let mut sides: HashMap<[u32; 2], u32, RandomState> =
            self.open.iter().filter_map(own).map(|key| (key, 0)).collect();
        // Few points of most meshes are ends of boundary edges.
        let mut is_end = vec![false; joined.len()];
        sides.keys().flatten().for_each(|&point| is_end[point as usize] = true);
        let mut degenerate = 0;
        for points in mesh.triangles.iter().map(points) {
            if is_degenerate(points) {
                degenerate += 1;
                continue;
            }
            let ends = points.map(|point| is_end[point as usize]);
            for side in (0..3).filter(|&side| ends[side] && ends[(side + 1) % 3]) {
                if let Some(count) = sides.get_mut(&key(points, side)) {
                    *count += 1;
                }
            }
        }
        let shared = self.open.iter().filter_map(own).filter(|key| sides[key] > 1);
        [to_u32(shared.count()), degenerate - self.degenerate]
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{Vec2, Vec3};
    use proptest::prelude::*;

    use super::*;
    use crate::cores::on_threads;
    use crate::mesh::shapes::Shape;
    use crate::mesh::topology::{Edge, weld_corners};
    use crate::mesh::{Corner, Rig};

    /// The same as [`weld_previews`], found by welding all corners within each tolerance and comparing the topologies'
    /// triangles.
    fn slow_previews(mesh: &Mesh) -> Vec<WeldPreview> {
        let exact = Topology::build(mesh, &Progress::new()).unwrap();
        let of_edge = |edge: &Edge| {
            let side = exact.sides[edge.first_side as usize];
            (exact.patches[side.patch() as usize].triangle as usize, side.index())
        };
        let open: Vec<_> = exact.edges.iter().filter(|edge| edge.kind == EdgeKind::Boundary).map(of_edge).collect();
        let preview = |tolerance: f32| {
            let (_, corner_points) = weld_corners(mesh, tolerance);
            let triangles: Vec<[u32; 3]> =
                mesh.triangles.iter().map(|triangle| triangle.map(|corner| corner_points[corner as usize])).collect();
            let whole = || triangles.iter().filter(|points| !is_degenerate(**points));
            let edge = |points: &[u32; 3], side: usize| [points[side], points[(side + 1) % 3]];
            let sides_at = |[a, b]: [u32; 2]| {
                let all = whole().flat_map(|points| [0, 1, 2].map(|side| edge(points, side)));
                all.filter(|ends| *ends == [a, b] || *ends == [b, a]).count()
            };
            let joined = |&&(triangle, side): &&(usize, usize)| {
                !is_degenerate(triangles[triangle]) && sides_at(edge(&triangles[triangle], side)) > 1
            };
            let edges = open.iter().filter(joined).count() as u32;
            let collapsed = (triangles.len() - whole().count()) as u32 - exact.degenerate;
            let is_tried = !most_have_a_side_within(mesh, tolerance);
            WeldPreview { tolerance, edges: is_tried.then_some(edges), collapsed: is_tried.then_some(collapsed) }
        };
        TOLERANCES.map(preview).to_vec()
    }

    fn most_have_a_side_within(mesh: &Mesh, tolerance: f32) -> bool {
        let distance = mesh.bounds().part(tolerance.into());
        let at = |corner: u32| mesh.corners[corner as usize].position.as_dvec3();
        let is_short = |ends: [u32; 2]| {
            let [a, b] = ends.map(at);
            a != b && a.distance(b) <= distance
        };
        let short = mesh.triangles.iter().filter(|&&[a, b, c]| [[a, b], [b, c], [c, a]].into_iter().any(is_short));
        2 * short.count() > mesh.triangles.len()
    }

    proptest! {
        #[test]
        fn only_near_points_make_a_difference(
            places in prop::collection::vec((prop::array::uniform3(0_i8..4), prop::array::uniform3(0_u8..8)), 3..40),
            numbers in prop::collection::vec(0_u32..2, 40),
            is_rigged in any::<bool>(),
        ) {
            // Points that are about as far apart as the tolerances, with many that are exactly that far apart.
            let steps = [0.0, 1e-7, 2e-6, 1e-5, 1e-4, 1e-3, 1e-2, 2e-2];
            let corner = |(at, moved): &([i8; 3], [u8; 3])| Corner {
                position: Vec3::from(at.map(f32::from)) + Vec3::from(moved.map(|step| steps[usize::from(step)])),
                normal: Vec3::Z,
                uv: Vec2::ZERO,
            };
            let corners: Vec<Corner> = places.iter().map(corner).collect();
            let count = corners.len() as u32;
            let triangles: Vec<_> = (0..count).map(|i| [i, (i + 1) % count, (i + 2) % count]).collect();
            let rig = is_rigged.then(|| Rig { alike: numbers[..corners.len()].to_vec(), ..Rig::default() });
            let mesh = Mesh { corners, triangles: triangles.into(), rig: rig.map(Arc::new), ..Mesh::default() };
            prop_assert_eq!(weld_previews(&mesh, None, &Progress::new()).unwrap(), slow_previews(&mesh));
            let exact = Topology::build(&mesh, &Progress::new()).unwrap();
            prop_assert_eq!(weld_previews(&mesh, Some(&exact), &Progress::new()).unwrap(), slow_previews(&mesh));
        }
    }

    #[test]
    fn the_number_of_cores_makes_no_difference() {
        // A wavy sheet of 40,000 points, of which a third has another one nearby, at many distances.
        let side = 200;
        let place = |i: u32| {
            let (x, y) = ((i % side) as f32, (i / side) as f32);
            Vec3::new(x, y, (0.3 * x).sin() * (0.2 * y).cos())
        };
        let near = |i: u32| place(i) + Vec3::Z * 10_f32.powf((i % 97) as f32 / 20.0 - 5.0);
        let corner = |position: Vec3| Corner { position, normal: Vec3::Z, uv: Vec2::ZERO };
        let mut corners: Vec<Corner> = (0..side * side).map(place).map(corner).collect();
        let quads = (0..side - 1).flat_map(|y| (0..side - 1).map(move |x| y * side + x));
        let mut triangles: Vec<_> =
            quads.flat_map(|a| [[a, a + 1, a + side], [a + 1, a + side + 1, a + side]]).collect();
        for i in (0..side * side - side - 1).step_by(3) {
            triangles.push([0, 1, 2].map(|k| corners.len() as u32 + k));
            corners.extend([i, i + 1, i + side].map(near).map(corner));
        }
        let mesh = Mesh { corners, triangles: triangles.into(), ..Mesh::default() };
        let previews =
            |cores| on_threads(cores, || weld_previews(&mesh, None, &Progress::new()).unwrap()).expect("threads");
        let one = previews(1);
        // Its triangles have sides of a few thousandths of the diagonal.
        assert_eq!(one[5].edges, None);
        assert!(one[..5].windows(2).all(|pair| pair[0].edges < pair[1].edges), "{one:?}");
        [2, 3, 16].into_iter().for_each(|cores| assert_eq!(previews(cores), one, "{cores} cores"));
    }

    /// Triangles that share no corners.
    fn soup(triangles: &[[[f32; 2]; 3]]) -> Mesh {
        let corner = |&[x, y]: &[f32; 2]| Corner { position: Vec3::new(x, y, 0.0), normal: Vec3::Z, uv: Vec2::ZERO };
        let corners = triangles.as_flattened().iter().map(corner).collect();
        let triangles = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect::<Vec<_>>().into();
        Mesh { corners, triangles, ..Mesh::default() }
    }

    fn counts(mesh: &Mesh) -> Vec<[u32; 2]> {
        let joins = weld_previews(mesh, None, &Progress::new()).unwrap();
        assert!(joins.iter().map(|join| join.tolerance).eq(TOLERANCES));
        let exact = Topology::build(mesh, &Progress::new()).unwrap();
        assert_eq!(joins, super::weld_previews(mesh, Some(&exact), &Progress::new()).unwrap());
        joins.iter().filter_map(|join| Some([join.edges?, join.collapsed?])).collect()
    }

    #[test]
    fn a_gap_joins_from_the_first_tolerance_that_spans_it() {
        // The two halves of a square with a diagonal of 1.41, 1e-4 apart.
        let gap = 1e-4;
        let mesh = soup(&[[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [[0.0, gap], [1.0, 1.0 + gap], [0.0, 1.0]]]);
        assert_eq!(counts(&mesh), [[0, 0], [0, 0], [0, 0], [2, 0], [2, 0], [2, 0]]);
    }

    #[test]
    fn what_collapses_is_not_joined() {
        // A sliver, 1e-3 wide and 1e-4 too high, between two halves. First a weld joins it to both; with a larger
        // tolerance it collapses and the halves meet.
        let (w, gap) = (1e-3, 1e-4);
        let mesh = soup(&[
            [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            [[1.0, gap], [1.0 + w, gap], [0.0, 1.0 + gap]],
            [[1.0 + w, 0.0], [1.0, 1.0], [0.0, 1.0]],
        ]);
        assert_eq!(counts(&mesh), [[0, 0], [0, 0], [0, 0], [4, 0], [2, 1], [2, 1]]);
    }

    #[test]
    fn duplicates_and_closed_edges_are_joined_already() {
        let triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(counts(&soup(&[triangle, triangle])), [[0, 0]; 6]);
        assert_eq!(counts(&Shape::Torus.build()), [[0, 0]; 6]);
        assert_eq!(counts(&Shape::Moebius.build()), [[0, 0]; 6], "its boundary is nowhere near itself");
        assert_eq!(counts(&Mesh::default()), [[0, 0]; 6]);
    }

    #[test]
    fn triangles_on_one_point_were_degenerate_before() {
        let point = [[0.5, 0.5]; 3];
        assert_eq!(counts(&soup(&[point, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], point])), [[0, 0]; 6]);
    }

    #[test]
    fn previews_are_written_as_text() {
        let words = |edges, collapsed| {
            WeldPreview { tolerance: 1e-5, edges: Some(edges), collapsed: Some(collapsed) }.to_string()
        };
        assert_eq!(words(0, 0), "joins nothing");
        assert_eq!(words(12, 0), "joins 12 edges");
        assert_eq!(words(0, 3), "joins 0 edges, collapses 3 triangles");
    }

    #[test]
    fn a_tolerance_that_most_triangles_have_a_shorter_side_than_is_not_tried() {
        // Two slivers 0.01 wide, and a whole triangle. The diagonal is 3.2.
        let sliver = |x: f32| [[x, 0.0], [x + 0.01, 0.0], [x, 1.0]];
        let mesh = soup(&[sliver(0.0), sliver(0.5), [[0.0, 2.0], [1.0, 2.0], [0.0, 3.0]]]);
        assert_eq!(counts(&mesh), [[0, 0]; 5]);
        let last = weld_previews(&mesh, None, &Progress::new()).unwrap()[5];
        assert_eq!(last, WeldPreview { tolerance: 1e-2, edges: None, collapsed: None });
        assert_eq!(last.to_string(), "not tried, since most triangles have a shorter side");
    }

    #[test]
    fn cancelling_stops_the_work() {
        let progress = Progress::new();
        progress.cancel();
        assert_eq!(weld_previews(&Shape::Torus.build(), None, &progress), Err(Cancelled));
    }
}
