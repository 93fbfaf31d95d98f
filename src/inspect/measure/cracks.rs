//! Cracks: edges whose sides don't agree to the last bit.

use glam::{DVec3, Mat4, Vec2, Vec3};

#[cfg(test)]
use super::outlines::Outlines;
use super::outlines::{EdgeSide, OutlinePoint};
use geometry::mesh::{Mesh, Topology};
use geometry::view::project;

/// The cracks of a tessellation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cracks {
    /// The number of compared points: on every edge with several sides, each point counts once for each side after the first.
    pub edge_points: u64,
    /// The number of compared edges: those with several sides.
    pub edges_compared: u64,
    /// Points whose positions differ in at least one bit of one coordinate.
    pub different_bits: u64,
    /// Edges for which LOD gave the sides factors that differ in at least one bit.
    pub different_factors: u64,
    /// Points whose normals differ in at least one bit although the mesh's normals agree at both ends.
    pub different_normals: u64,
    /// Edges with any such difference, the widest gap first.
    pub edges: Vec<CrackedEdge>,
}

/// An edge whose sides disagree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrackedEdge {
    /// Index in [`Topology::edges`].
    pub edge: u32,
    /// Points whose positions differ.
    pub different_bits: u32,
    /// Points whose normals differ although the mesh's normals agree.
    pub different_normals: u32,
    pub different_factors: bool,
    /// The largest distance between two sides, in object units. It is measured between their positions of each point, or if
    /// they have different numbers of points, from each point of one to the line of the other. Beside a discarded patch it is the
    /// distance to the patch's corner across the edge: the hole is as wide.
    pub gap: f64,
    /// The two positions that are farthest apart.
    pub widest: [Vec3; 2],
    /// A patch that its factors leave out beside one that is drawn, an index in [`Topology::patches`].
    pub discarded: Option<u32>,
}

impl Cracks {
    /// Compares every edge's sides.
    #[cfg(test)]
    fn find(mesh: &Mesh, topology: &Topology, outlines: &Outlines) -> Self {
        let mut cracks = Self::default();
        for (edge, sides) in outlines.shared_edges(topology) {
            cracks.take(mesh, topology, edge, &sides, &outlines.discarded(topology, edge));
        }
        cracks.sorted()
    }

    /// Compares the sides of an edge, an index in [`Topology::edges`], of which some may be discarded by factors.
    pub(super) fn take(
        &mut self,
        mesh: &Mesh,
        topology: &Topology,
        edge: u32,
        sides: &[EdgeSide],
        discarded: &[EdgeSide],
    ) {
        self.edges_compared += 1;
        self.edge_points += points_compared(sides, discarded);
        let different_normals = different_normals(mesh, topology, edge, sides);
        let holes = discarded.iter().map(|side| (side, topology.patch_positions(side.patch)));
        if let Some(crack) = compare(edge, sides, &holes.collect::<Vec<_>>(), different_normals) {
            self.different_bits += u64::from(crack.different_bits);
            self.different_normals += u64::from(crack.different_normals);
            self.different_factors += u64::from(crack.different_factors);
            self.edges.push(crack);
        }
    }

    /// The cracks with the widest gap first, after all edges are taken.
    pub(super) fn sorted(mut self) -> Self {
        let bits = |edge: &CrackedEdge| (edge.different_bits, edge.different_normals);
        self.edges.sort_by(|a, b| b.gap.total_cmp(&a.gap).then(bits(b).cmp(&bits(a))));
        self
    }

    /// Edges whose positions differ, the widest gap first. Light may pass through them.
    pub fn cracked(&self) -> &[CrackedEdge] {
        // Edges whose positions agree are at the end.
        &self.edges[..self.edges.partition_point(CrackedEdge::is_cracked)]
    }

    /// Shading seams: edges whose positions agree and whose normals differ, although the mesh's normals agree.
    pub fn shading_seams(&self) -> impl Iterator<Item = &CrackedEdge> {
        self.edges.iter().filter(|edge| edge.different_normals > 0 && !edge.is_cracked())
    }

    /// The widest gap, in object units.
    pub fn max_gap(&self) -> f64 {
        self.edges.first().map_or(0.0, |edge| edge.gap)
    }

    /// The widest gap on screen, in px. Only the widest gap of each edge in object units is considered.
    pub fn max_gap_px(&self, clip_from_object: Mat4, viewport: Vec2) -> f64 {
        self.edges.iter().map(|edge| edge.gap_px(clip_from_object, viewport)).fold(0.0, f64::max)
    }
}

impl CrackedEdge {
    /// Whether positions differ.
    fn is_cracked(&self) -> bool {
        self.gap > 0.0 || self.different_bits > 0
    }

    /// The gap on screen, in px; 0 behind the eye.
    pub fn gap_px(&self, clip_from_object: Mat4, viewport: Vec2) -> f64 {
        let [a, b] = self.widest.map(|p| project(clip_from_object, viewport, p));
        a.zip(b).map_or(0.0, |(a, b)| f64::from(a.distance(b)))
    }
}

/// Up to this many distinct sides of an edge are compared with each other. Further ones are compared only with the first.
const PAIRED_SIDES: usize = 64;

/// A discarded side, and the positions of its patch's corners.
type Hole<'a> = (&'a EdgeSide, [Vec3; 3]);

fn points_compared(sides: &[EdgeSide], discarded: &[EdgeSide]) -> u64 {
    let Some((first, others)) = sides.split_first() else { return 0 };
    others.iter().chain(discarded).map(|other| first.points.len().max(other.points.len()) as u64).sum()
}

/// Compares the sides of an edge. Returns the crack, if anything differs.
fn compare(edge: u32, sides: &[EdgeSide], holes: &[Hole], different_normals: u32) -> Option<CrackedEdge> {
    let (first, others) = sides.split_first()?;
    let discarded = holes.iter().map(|(side, _)| *side);
    let all = || others.iter().chain(discarded.clone());
    let different_bits: u32 = all().map(|other| different(first, other, same_position)).sum();
    let same_factor = |other: &EdgeSide| other.factor.to_bits() == first.factor.to_bits();
    let different_factors = !all().all(same_factor) || others.iter().any(|other| other.word != first.word);
    if different_bits == 0 && different_normals == 0 && !different_factors {
        return None;
    }
    let across = holes.iter().flat_map(|(_, corners)| corners.map(|corner| from_line(first, corner)));
    let (gap, widest) = across.fold(widest(sides), larger);
    let discarded = holes.first().map(|(side, _)| side.patch);
    Some(CrackedEdge { edge, different_bits, different_normals, different_factors, gap, widest, discarded })
}

/// The largest gap over all pairs of sides, and its two positions.
fn widest(sides: &[EdgeSide]) -> Gap {
    let mut distinct: Vec<&EdgeSide> = Vec::new();
    for side in sides {
        if distinct.iter().take(PAIRED_SIDES).all(|known| different(known, side, same_position) > 0) {
            distinct.push(side);
        }
    }
    let (mut gap, mut at) = (0.0, [Vec3::ZERO; 2]);
    for (index, side) in distinct.iter().enumerate() {
        let earlier = if index < PAIRED_SIDES { index } else { 1 };
        for other in &distinct[..earlier] {
            let (distance, ends) = farthest(side, other);
            if distance >= gap {
                (gap, at) = (distance, ends);
            }
        }
    }
    (gap, at)
}

/// A distance in object units, and the positions between which it is.
type Gap = (f64, [Vec3; 2]);

fn larger(x: Gap, y: Gap) -> Gap {
    if y.0 >= x.0 { y } else { x }
}

fn farthest(a: &EdgeSide, b: &EdgeSide) -> Gap {
    let none = (0.0, [Vec3::ZERO; 2]);
    if a.points.len() == b.points.len() {
        return a.positions().zip(b.positions()).map(|(p, q)| (distance(p, q), [p, q])).fold(none, larger);
    }
    let both = a.positions().map(|p| from_line(b, p)).chain(b.positions().map(|p| from_line(a, p)));
    both.fold(none, larger)
}

/// How far a position is from the line of a side's points.
fn from_line(line: &EdgeSide, p: Vec3) -> Gap {
    let line: Vec<Vec3> = line.positions().collect();
    let near = line.windows(2).map(|ends| nearest(ends[0], ends[1], p)).map(|q| (distance(p, q), [p, q]));
    near.fold((f64::INFINITY, [p, p]), |x, y| if y.0 < x.0 { y } else { x })
}

/// The distance in object units; infinite if a coordinate is NaN.
fn distance(a: Vec3, b: Vec3) -> f64 {
    let distance = a.as_dvec3().distance(b.as_dvec3());
    if distance.is_nan() { f64::INFINITY } else { distance }
}

/// The point of a line from `a` to `b` that is nearest to `p`.
fn nearest(a: Vec3, b: Vec3, p: Vec3) -> Vec3 {
    let [a, b, p]: [DVec3; 3] = [a, b, p].map(Vec3::as_dvec3);
    let (along, length_squared) = ((p - a).dot(b - a), (b - a).length_squared());
    let t = if length_squared > 0.0 { (along / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    a.lerp(b, t).as_vec3()
}

fn same_position(a: &OutlinePoint, b: &OutlinePoint) -> bool {
    a.position.map(f32::to_bits) == b.position.map(f32::to_bits)
}

/// The number of points that differ. Points that only one side has count as different.
fn different(a: &EdgeSide, b: &EdgeSide, same: fn(&OutlinePoint, &OutlinePoint) -> bool) -> u32 {
    let (a, b) = (&a.points, &b.points);
    let differ = a.iter().zip(b).filter(|(a, b)| !same(a, b)).count();
    (differ + a.len().abs_diff(b.len())) as u32
}

/// The number of points whose normals differ, over sides with the same source normals at both ends as an earlier side.
fn different_normals(mesh: &Mesh, topology: &Topology, edge: u32, sides: &[EdgeSide]) -> u32 {
    let own = topology.side_range(&topology.edges[edge as usize]).map(|side| &topology.sides[side as usize]);
    let source = |patch: u32| {
        let side = own.clone().find(|side| side.patch() == patch);
        side.map(|side| {
            topology.side_corners(side).map(|c| mesh.corners[c as usize].normal.to_array().map(f32::to_bits))
        })
    };
    let sources: Vec<_> = sides.iter().map(|side| source(side.patch)).collect();
    let mut count = 0;
    for (index, side) in sides.iter().enumerate() {
        // On an edge with many sides, only the first ones are searched, to save time.
        let earlier = sources[..index.min(PAIRED_SIDES)].iter().position(|known| *known == sources[index]);
        if let Some(earlier) = earlier {
            count += different(&sides[earlier], side, |a, b| a.normal == b.normal);
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{Measured, RequestedFactors};
    use crate::settings::Settings;
    use geometry::mesh::{Corner, Material, Shape};
    use geometry::tessellate::{
        Convention, Edges, HullFactors, Lod, LodView, Partitioning, Surface, Tessellation, tessellate, tessellate_given,
    };

    #[test]
    fn a_cracked_edge_is_no_shading_seam() {
        let edge = |edge, gap, different_bits, different_normals| CrackedEdge {
            edge,
            different_bits,
            different_normals,
            different_factors: false,
            gap,
            widest: [Vec3::ZERO; 2],
            discarded: None,
        };
        let edges = vec![edge(0, 0.1, 3, 3), edge(1, 0.0, 1, 2), edge(2, 0.0, 0, 4), edge(3, 0.0, 0, 0)];
        let cracks = Cracks { edges, ..Cracks::default() }.sorted();
        assert_eq!(cracks.shading_seams().map(|seam| seam.edge).collect::<Vec<_>>(), [2]);
        assert_eq!(cracks.cracked().iter().map(|crack| crack.edge).collect::<Vec<_>>(), [0, 1]);
    }

    /// A view that holds every shape, at an angle at which no two edges look alike.
    fn view() -> LodView {
        let turned = Mat4::from_rotation_y(0.4) * Mat4::from_rotation_x(0.3) * 0.3;
        let clip_from_object = Mat4 { w_axis: glam::vec4(0.1, 0.0, 0.5, 1.0), ..turned };
        LodView::new(clip_from_object, Vec2::splat(300.0))
    }

    fn outlines(shape: Shape, settings: Settings) -> (Mesh, Topology, Outlines) {
        let mesh = shape.build();
        let topology = Topology::build(&mesh, &Default::default()).expect("nobody cancels");
        let inputs = settings.with(Tessellation { lod: Lod::Paper, ..settings.tessellation }).inputs(view());
        let out = tessellate(&mesh, &topology, &inputs, None);
        let mut outlines = Outlines::new(
            out.patch_factors,
            RequestedFactors::new(settings.tessellation.edges, settings.tessellation.convention, out.edge_factors),
        );
        outlines.take(0, &out.vertices);
        (mesh, topology, outlines)
    }

    fn cracks(shape: Shape, settings: Settings) -> Cracks {
        let (mesh, topology, outlines) = outlines(shape, settings);
        Cracks::find(&mesh, &topology, &outlines)
    }

    #[test]
    fn pn_tears_at_split_normals_and_pn_aen_does_not() {
        for partitioning in Partitioning::ALL {
            let settings =
                Settings::from(Tessellation { surface: Surface::Pn, partitioning, ..Tessellation::default() });
            let torn = cracks(Shape::CubeSplit, settings);
            assert_eq!(torn.edges.len(), 12, "the cube's own edges, not its faces' diagonals");
            assert!(torn.max_gap() > 0.01);
            for surface in [Surface::Flat, Surface::PnAen] {
                let closed = cracks(Shape::CubeSplit, settings.with(Tessellation { surface, ..settings.tessellation }));
                assert_eq!((closed.different_bits, closed.different_normals, closed.different_factors), (0, 0, 0));
                assert!(closed.edges.is_empty() && closed.edge_points > 18 && closed.edges_compared == 18);
            }
        }
    }

    #[test]
    fn as_published_edges_differ_in_their_last_bits() {
        let published = Settings::from(Tessellation { edges: Edges::AsPublished, ..Tessellation::default() });
        let found = cracks(Shape::Torus, published);
        let points = found.different_bits as f64 / found.edge_points as f64;
        let factors = found.different_factors as f64 / found.edges_compared as f64;
        assert!(points > 0.2 && factors > 0.1, "{points} of points, {factors} of factors");
        let close = |edge: &CrackedEdge| edge.gap < 1e-5 || edge.different_factors;
        assert!(found.edges.iter().all(close), "only the last bits differ");
    }

    #[test]
    fn one_bit_of_one_point_or_normal_is_a_crack() {
        let (mesh, topology, mut outlines) = outlines(Shape::Torus, Settings::default());
        assert!(Cracks::find(&mesh, &topology, &outlines).edges.is_empty());
        // The second point of patch 5's outline lies inside side 1.
        let point = &mut outlines.outline_mut(5)[1];
        point.position[0] = point.position[0].next_up();
        let cracks = Cracks::find(&mesh, &topology, &outlines);
        let side = topology.patches[5].sides[1];
        assert_eq!((cracks.different_bits, cracks.different_normals, cracks.edges.len()), (1, 0, 1));
        assert_eq!(cracks.edges[0].edge, topology.sides[side as usize].edge);
        outlines.outline_mut(5)[1].normal ^= 1;
        let cracks = Cracks::find(&mesh, &topology, &outlines);
        assert_eq!((cracks.different_bits, cracks.different_normals, cracks.edges.len()), (1, 1, 1));
    }

    #[test]
    fn split_normals_may_differ() {
        let cube = cracks(Shape::CubeSplit, Settings::default());
        assert_eq!(cube.different_normals, 0, "normals that the mesh splits don't count");
    }

    #[test]
    fn normals_of_many_sides_are_compared_where_the_sources_agree() {
        // Three triangles on one edge, of which the first two have the same normals.
        let corner = |position: [f32; 3], normal: Vec3| Corner { position: position.into(), normal, uv: Vec2::ZERO };
        let ends = [[0.0; 3], [1.0, 0.0, 0.0]];
        let thirds = [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
        let normals = [Vec3::Z, Vec3::Z, Vec3::Y];
        let corners = (0..3).flat_map(|k| [ends[0], ends[1], thirds[k]].map(|position| corner(position, normals[k])));
        let mut material = Material::plain("plain", [1.0; 4]);
        material.triangles = 0..3;
        let mesh = Mesh {
            corners: corners.collect(),
            triangles: vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]].into(),
            materials: vec![material],
            ..Mesh::default()
        };
        let topology = Topology::build(&mesh, &Default::default()).expect("nobody cancels");
        let edge = topology.edges.iter().position(|edge| topology.edge_sides(edge).len() == 3).expect("an edge");
        // Both points of each side have a normal of the side's own.
        let points = |normal| ends.map(|position| OutlinePoint { position, normal }).to_vec();
        let sides = [0, 1, 2].map(|patch| EdgeSide { patch, points: points(patch), ..side(&[]) });
        assert_eq!(different_normals(&mesh, &topology, edge as u32, &sides), 2, "those of the second side");
    }

    #[test]
    fn a_patch_that_its_factors_leave_out_beside_one_that_is_drawn_is_a_crack() {
        let mesh = Shape::Torus.build();
        let topology = Topology::new(&mesh);
        let found = |discarded: &[(u32, [f32; 3])]| {
            let mut given = vec![HullFactors { edges: [3.0; 3], inside: 3.0 }; topology.patches.len()];
            discarded.iter().for_each(|(patch, edges)| given[*patch as usize].edges = *edges);
            let inputs = Settings::default().inputs(view());
            let out = tessellate_given(&mesh, &topology, &inputs, &given);
            Measured::new(&mesh, &topology, RequestedFactors::given(Convention::D3d11, &given), &out).cracks
        };
        assert!(found(&[]).edges.is_empty());
        let [a, b, c] = topology.patch_positions(5);
        let height = (b - a).cross(c - a).length() / a.distance(b).min(b.distance(c)).min(c.distance(a));
        for factor in [f32::NAN, 0.0, -2.0] {
            let cracks = found(&[(5, [factor, 3.0, 3.0])]);
            assert_eq!((cracks.cracked().len(), cracks.different_normals), (3, 0), "{factor}");
            assert_eq!(cracks.different_factors, 1, "{factor}: the others got the same from both sides");
            // Three segments are four points.
            assert_eq!(cracks.different_bits, 12, "{factor}");
            assert!(cracks.edges.iter().all(|crack| crack.discarded == Some(5)));
            let gap = cracks.max_gap() as f32;
            // The edge is curved.
            assert!((0.8 * height..=1.05 * height).contains(&gap), "{gap}, where the triangle is {height} high");
        }
        // Between two such patches nothing is drawn.
        let across = topology.patches[5].sides.map(|side| topology.sides[side as usize].edge);
        let other = topology.edge_sides(&topology.edges[across[0] as usize]).iter().find(|side| side.patch() != 5);
        let two = [5, other.expect("a closed mesh").patch()].map(|patch| (patch, [f32::NAN; 3]));
        assert_eq!(found(&two).cracked().len(), 4);
    }

    fn side(points: &[[f32; 3]]) -> EdgeSide {
        let points: Vec<_> = points.iter().map(|&position| OutlinePoint { position, normal: 0 }).collect();
        EdgeSide { patch: 0, triangle: 0, factor: 2.0, word: 0, points }
    }

    #[test]
    fn the_largest_gap_is_found_between_any_two_sides() {
        let bent = |x: f32| side(&[[0.0; 3], [x, 0.0, 0.0], [0.0; 3]]);
        let sides = [bent(0.0), bent(-0.25), bent(0.5), bent(0.5)];
        let crack = compare(7, &sides, &[], 0).expect("they differ");
        assert_eq!((points_compared(&sides, &[]), crack.different_bits, crack.edge, crack.gap), (9, 3, 7, 0.75));
        assert_eq!(compare(0, &[bent(1.0), bent(1.0)], &[], 0), None);
        assert_eq!(compare(0, &[bent(1.0), bent(f32::NAN)], &[], 0).map(|crack| crack.gap), Some(f64::INFINITY));
    }

    #[test]
    fn sides_with_different_numbers_of_points_are_compared_as_lines() {
        let coarse = side(&[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]]);
        let fine = side(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.5, 0.0], [4.0, 0.0, 0.0]]);
        let crack = compare(0, &[coarse, fine], &[], 0).expect("they differ");
        assert_eq!(crack.gap, 0.5);
        assert_eq!(crack.widest.map(|p| p.y).into_iter().fold(0.0, f32::max), 0.5);
    }
}
