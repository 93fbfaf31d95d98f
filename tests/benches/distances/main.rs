//! Times the largest distance between pairs of triangle meshes, both ways: `cargo bench --bench distances`.
//!
//! The distance is an interval that contains it for certain, and the bench says how narrow the interval is. The pairs are made here:
//! equal surfaces with equal and with other triangles, surfaces that are far apart, a surface and what a simplifier left of it,
//! noise, a spike, and triangles at random. No result makes the bench fail.
//!
//! Arguments after `--` are `triangles=N`, about how many triangles a mesh has (160,000); `relative=X` and `absolute=X`, the width
//! that suffices, as a part of the distance (0.01) and of the bounding diagonal (0.000001); `searches=N`, the number of searches
//! after which the interval stays as it is (200,000,000); and `only=NAME`, which measures one pair alone.

use std::f64::consts::{PI, TAU};
use std::time::Instant;

use geometry::near::{Farthest, Goal, Soup, TriangleTree, farthest};
use geometry::progress::Progress;
use glam::{DVec3, Vec3};

/// The largest part of a radius that noise moves a vertex by.
const NOISE: f64 = 1e-4;

/// How far the vertex of a spike is moved. A sheet has sides of 1.
const SPIKE: f32 = 0.1;

/// A mesh without anything but its shape.
#[derive(Clone, Default)]
struct Triangles {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Triangles {
    /// A rectangle of `rows` by `columns` quads. `at` gets both coordinates in 0 to 1.
    fn rectangle([rows, columns]: [u32; 2], diagonal: Diagonal, at: impl Fn(f64, f64) -> DVec3) -> Self {
        let place = |i: u32, j: u32| at(f64::from(i) / f64::from(rows), f64::from(j) / f64::from(columns)).as_vec3();
        let positions = (0..=rows).flat_map(|i| (0..=columns).map(move |j| (i, j))).map(|(i, j)| place(i, j)).collect();
        let quads = (0..rows).flat_map(|i| (0..columns).map(move |j| i * (columns + 1) + j));
        let triangles = quads.flat_map(|a| {
            let [b, c, d] = [a + 1, a + columns + 2, a + columns + 1];
            match diagonal {
                Diagonal::Falling => [[a, b, c], [a, c, d]],
                Diagonal::Rising => [[a, b, d], [b, c, d]],
            }
        });
        Self { positions, triangles: triangles.collect() }
    }

    /// A sphere of so many quads from pole to pole, and around. `at` moves the points of the unit sphere, whose first meridian is
    /// turned by an angle.
    fn sphere(quads: [u32; 2], turn: f64, at: impl Fn(DVec3) -> DVec3) -> Self {
        Self::rectangle(quads, Diagonal::Falling, |down, around| {
            let (polar, azimuth) = (PI * down, TAU * around + turn);
            at(DVec3::new(polar.sin() * azimuth.cos(), polar.cos(), polar.sin() * azimuth.sin()))
        })
    }

    /// A square sheet with sides of 1 and a height over each place.
    fn sheet(side: u32, diagonal: Diagonal, height: impl Fn(f64, f64) -> f64) -> Self {
        Self::rectangle([side, side], diagonal, |x, z| DVec3::new(x, height(x, z), z))
    }

    /// Small triangles at random places of a cube.
    fn at_random(count: u32, seed: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut place = || Vec3::from_array([0; 3].map(|_| random.f32()));
        let corners = |_| {
            let middle = place();
            [0; 3].map(|_| middle + 0.02 * place())
        };
        let positions = (0..count).flat_map(corners).collect();
        Self { positions, triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect() }
    }

    /// Moves all vertices away from the origin, or towards it, by random parts of their distances.
    fn with_noise(mut self) -> Self {
        let mut random = fastrand::Rng::with_seed(1);
        let moved = |place: Vec3, by: f64| (place.as_dvec3() * (1.0 + NOISE * (2.0 * by - 1.0))).as_vec3();
        self.positions.iter_mut().for_each(|place| *place = moved(*place, random.f64()));
        self
    }

    /// Moves the vertex at one place up.
    fn with_spike(mut self, vertex: u32) -> Self {
        self.positions[vertex as usize].y += SPIKE;
        self
    }

    /// What meshoptimizer's simplifier leaves, as a part of the triangles.
    fn simplified(&self, part: f64) -> Self {
        let wanted = 3 * (part * self.triangles.len() as f64) as usize;
        let points = meshopt::VertexDataAdapter::new(bytemuck::cast_slice(&self.positions), size_of::<Vec3>(), 0)
            .expect("a stride of whole positions");
        let options = meshopt::SimplifyOptions::None;
        let left = meshopt::simplify(self.triangles.as_flattened(), &points, wanted, f32::MAX, options, None);
        Self { positions: self.positions.clone(), triangles: left.as_chunks().0.to_vec() }
    }

    fn corners(&self) -> impl Iterator<Item = [Vec3; 3]> + Clone {
        self.triangles.iter().map(|triangle| triangle.map(|corner| self.positions[corner as usize]))
    }
}

/// How quads are divided.
#[derive(Clone, Copy)]
enum Diagonal {
    Falling,
    Rising,
}

/// A unit sphere with bumps, as if somebody had scanned something.
fn bumpy(place: DVec3) -> DVec3 {
    place * (1.0 + 0.02 * (17.0 * place.x).sin() * (13.0 * place.y).cos() * (11.0 * place.z).sin())
}

/// Makes the two meshes of a pair.
type Maker = Box<dyn Fn() -> [Triangles; 2]>;

/// The pairs of meshes with about so many triangles, and their names.
fn pairs(triangles: u32) -> Vec<(&'static str, Maker)> {
    use Diagonal::{Falling, Rising};

    let side = (triangles / 4).isqrt().max(16);
    let sheet_side = (triangles / 2).isqrt().max(16);
    // For the same surface of other quads, which are about as many.
    let fewer = |side: u32| side - side / 10;
    let sphere = move |turn: f64, radius: f64| Triangles::sphere([side, 2 * side], turn, |place| radius * place);
    let scan = move |side: u32, turn: f64| Triangles::sphere([side, 2 * side], turn, bumpy);
    let sheet = move |side: u32, diagonal| Triangles::sheet(side, diagonal, |_, _| 0.0);
    let saddle = move |diagonal| Triangles::sheet(sheet_side, diagonal, |x, z| x * z);
    let spheres = move |turn: f64, radius: f64| [sphere(0.0, 1.0), sphere(turn, radius)];
    let simplified = move |part: f64| {
        let whole = scan(side, 0.0).with_noise();
        let left = whole.simplified(part);
        [whole, left]
    };
    let spike = move || {
        let flat = sheet(sheet_side, Rising);
        [flat.clone(), flat.with_spike(sheet_side / 3 * (sheet_side + 2))]
    };
    let quads = [[side, 2 * side], [side + 19, 2 * side - 7]];
    vec![
        ("equal spheres", Box::new(move || spheres(0.0, 1.0))),
        ("turned spheres", Box::new(move || spheres(0.003, 1.0))),
        ("spheres of other quads", Box::new(move || quads.map(|quads| Triangles::sphere(quads, 0.0, |place| place)))),
        ("concentric spheres, 0.99", Box::new(move || spheres(0.001, 0.99))),
        ("concentric spheres, 0.9", Box::new(move || spheres(0.001, 0.9))),
        ("concentric spheres, 0.5", Box::new(move || spheres(0.001, 0.5))),
        ("scan and 50 % of it", Box::new(move || simplified(0.5))),
        ("scan and 10 % of it", Box::new(move || simplified(0.1))),
        ("scan and another scan", Box::new(move || [scan(side, 0.0), scan(fewer(side), 0.01)])),
        ("scan and noise", Box::new(move || [scan(side, 0.0), scan(side, 0.0).with_noise()])),
        (
            "flat sheets, other diagonals",
            Box::new(move || [Rising, Falling].map(|diagonal| sheet(sheet_side, diagonal))),
        ),
        ("flat sheets, other quads", Box::new(move || [sheet_side, fewer(sheet_side)].map(|side| sheet(side, Rising)))),
        (
            "flat sheets, 0.01 apart",
            Box::new(move || [sheet(sheet_side, Rising), Triangles::sheet(fewer(sheet_side), Falling, |_, _| 0.01)]),
        ),
        ("saddles, other diagonals", Box::new(move || [Rising, Falling].map(saddle))),
        ("sheet and a spike of one vertex", Box::new(spike)),
        ("triangles at random", Box::new(move || [1, 2].map(|seed| Triangles::at_random(triangles, seed)))),
    ]
}

/// What was measured one way.
struct Measured {
    farthest: Farthest,
    /// The bounding diagonal of the mesh that distances go to.
    diagonal: f64,
    /// How long it took to make the tree, and all, in s.
    seconds: [f64; 2],
}

fn measure(from: &Triangles, to: &Triangles, goal: impl Fn(f64) -> Goal) -> Measured {
    let start = Instant::now();
    let tree = TriangleTree::new(to.corners()).expect("a mesh with triangles");
    let built = start.elapsed().as_secs_f64();
    let [least, greatest] = tree.extent();
    let diagonal = least.distance(greatest);
    let soup = Soup { positions: &from.positions, triangles: &from.triangles };
    let found = farthest(soup, &tree, &goal(diagonal), &Progress::new());
    let farthest = found.expect("nobody cancels").expect("a mesh with triangles");
    Measured { farthest, diagonal, seconds: [built, start.elapsed().as_secs_f64()] }
}

fn print_row(name: &str, from: &Triangles, to: &Triangles, measured: &Measured) {
    let Measured { farthest, diagonal, seconds: [built, all] } = measured;
    let [least, most] = [farthest.distance.at_least, farthest.distance.at_most];
    let [own, others] = [from, to].map(|mesh| mesh.triangles.len());
    println!(
        "| {name} | {own} | {others} | {built:.2} | {all:.2} | {least:.9} | {most:.9} | {:.1e} | {:.2} % |",
        (most - least) / diagonal,
        if most > 0.0 { 100.0 * (most - least) / most } else { 0.0 },
    );
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    let value = |name: &str| arguments.iter().find_map(|argument| argument.strip_prefix(name));
    let number = |name: &str, default: f64| value(name).and_then(|text| text.parse().ok()).unwrap_or(default);
    let goal = |diagonal: f64| Goal {
        relative: number("relative=", 0.01),
        absolute: number("absolute=", 1e-6) * diagonal,
        searches: number("searches=", 2e8) as u64,
    };
    println!(
        "| meshes | triangles, from | triangles, to | tree, s | all, s | at least | at most | width / diagonal | width / distance |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (name, make) in pairs(number("triangles=", 160_000.0) as u32) {
        if value("only=").is_some_and(|only| name != only) {
            continue;
        }
        let [a, b] = make();
        for [from, to] in [[&a, &b], [&b, &a]] {
            print_row(name, from, to, &measure(from, to, goal));
        }
    }
}
