//! Mistakes that are made on purpose in what we emit ourselves, each of which must be named, and nothing else.

use std::sync::Arc;

use glam::{Mat4, Vec2, Vec3, vec3};

use super::net_mistakes::{NetMistake, THIRD};
use super::*;
use geometry::mesh::{HeightMap, Heights, Shape};
use geometry::tessellate::{
    Convention, Displacement, Lod, LodView, Partitioning, Surface, domain_side, hull_factors, tessellate,
    tessellate_given, unpack_normal,
};
use inspect::settings::Choice;

/// A mesh, how it is tessellated, and what is emitted.
struct Scene {
    mesh: Mesh,
    topology: Topology,
    inputs: Inputs,
    out: Tessellated,
}

/// Triangles of another program.
#[derive(Clone)]
struct Theirs {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Scene {
    fn new(shape: Shape, tessellation: Tessellation) -> Self {
        Self::from_mesh(shape.build(), tessellation)
    }

    fn from_mesh(mesh: Mesh, tessellation: Tessellation) -> Self {
        let topology = Topology::new(&mesh);
        // Seen obliquely, so that edges of all directions have different lengths on screen.
        let clip = Mat4::from_cols_array_2d(&[
            [0.6, 0.1, 0.2, 0.0],
            [0.0, 0.5, 0.3, 0.0],
            [0.2, 0.3, 0.05, 0.3],
            [0.0, 0.0, 0.4, 1.5],
        ]);
        let inputs = Inputs::new(&tessellation, LodView::new(clip, Vec2::splat(250.0)));
        let out = tessellate(&mesh, &topology, &inputs, None);
        Self { mesh, topology, inputs, out }
    }

    /// What we emit with another tessellation.
    fn theirs(&self, change: impl FnOnce(&mut Tessellation)) -> Theirs {
        let mut tessellation = self.inputs.tessellation;
        change(&mut tessellation);
        let inputs = Inputs::new(&tessellation, self.inputs.view);
        Theirs::new(&tessellate(&self.mesh, &self.topology, &inputs, None))
    }

    /// What we emit if the hull shader changes the factors of sides 0, 1 and 2, and of the inside.
    fn theirs_with(&self, change: impl Fn([f32; 3], f32) -> ([f32; 3], f32)) -> Theirs {
        let mut written = hull_factors(&self.mesh, &self.topology, &self.inputs);
        let convention = self.inputs.tessellation.convention;
        let side = |i: usize| domain_side(convention, i as u32) as usize;
        for factors in &mut written {
            let mut sides = [0.0; 3];
            (0..3).for_each(|i| sides[side(i)] = factors.edges[i]);
            let (sides, inside) = change(sides, factors.inside);
            factors.edges = [0, 1, 2].map(|i| sides[side(i)]);
            factors.inside = inside;
        }
        Theirs::new(&tessellate_given(&self.mesh, &self.topology, &self.inputs, &written))
    }

    fn compare(&self, theirs: &Theirs) -> Comparison {
        self.compare_to_decimals(theirs, 0.0)
    }

    /// Compares with numbers that were rounded by up to `resolution` object units, as their file says.
    fn compare_to_decimals(&self, theirs: &Theirs, resolution: f64) -> Comparison {
        let ours = OurTessellation {
            mesh: &self.mesh,
            topology: &self.topology,
            inputs: &self.inputs,
            given: None,
            matrix: None,
            tessellated: &self.out,
        };
        let within = (16.0 * ulp(&self.topology)).max(2.0 * resolution);
        let theirs = ForeignMesh::new(&theirs.positions, theirs.triangles.iter().copied());
        compare(&ours, &theirs, Tolerances { within, resolution })
    }

    /// Compares, and checks that these kinds are found and no others. Returns their texts.
    fn check(&self, theirs: &Theirs, kinds: &[&str]) -> String {
        let found = self.compare(theirs);
        let texts: Vec<String> = found.findings.iter().map(Finding::to_string).collect();
        let own: Vec<&str> = found.findings.iter().map(Finding::kind).collect();
        assert_eq!(own, kinds, "{}\n{:?}", texts.join("\n"), found.farthest);
        texts.join("\n")
    }
}

impl Theirs {
    fn new(out: &Tessellated) -> Self {
        let positions = out.vertices.iter().map(|vertex| Vec3::from(vertex.position)).collect();
        Self { positions, triangles: out.triangles.clone() }
    }

    /// The same triangles in another order, each starting at another corner and with vertices of its own.
    fn shuffled(&self) -> Self {
        let mut random = fastrand::Rng::with_seed(7);
        let mut triangles = self.triangles.clone();
        random.shuffle(&mut triangles);
        triangles.iter_mut().for_each(|triangle| triangle.rotate_left(random.usize(0..3)));
        let positions: Vec<Vec3> = triangles.as_flattened().iter().map(|i| self.positions[*i as usize]).collect();
        let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Self { positions, triangles }
    }

    fn moved(mut self, change: impl Fn(Vec3) -> Vec3) -> Self {
        self.positions.iter_mut().for_each(|position| *position = change(*position));
        self
    }
}

/// LOD by edge length, whose factors differ from edge to edge.
fn varied(partitioning: Partitioning) -> Tessellation {
    Tessellation { lod: Lod::EdgeLength, pixels: 4.0, partitioning, ..Tessellation::default() }
}

fn torus(partitioning: Partitioning) -> Scene {
    Scene::new(Shape::Torus, varied(partitioning))
}

#[test]
fn what_we_emit_is_the_same_in_any_order() {
    for shape in Shape::ALL {
        for surface in [Surface::Flat, Surface::Pn, Surface::PnAen, Surface::Phong, Surface::NagataAen] {
            let scene = Scene::new(shape, Tessellation { surface, factor: 5.5, ..Tessellation::default() });
            scene.check(&Theirs::new(&scene.out).shuffled(), &[]);
        }
    }
    for partitioning in Partitioning::ALL {
        for convention in [Convention::D3d11, Convention::AmdPn, Convention::Rotated] {
            let scene = Scene::new(Shape::Torus, Tessellation { convention, ..varied(partitioning) });
            scene.check(&Theirs::new(&scene.out).shuffled(), &[]);
        }
    }
}

#[test]
fn rounding_is_told_from_mistakes() {
    // Under most LOD the last bits of factors move points, too.
    for lod in [Lod::Uniform, Lod::Error] {
        let scene = Scene::new(Shape::Torus, Tessellation { factor: 5.5, lod, ..Tessellation::default() });
        let noise = |size: f32| {
            Theirs::new(&scene.out).moved(|p| p + vec3((p.x * 1e4).sin(), (p.y * 1e4).sin(), (p.z * 1e4).cos()) * size)
        };
        scene.check(&noise(1e-7), &[]);
        let text = scene.check(&noise(5e-6), &["rounding"]);
        assert!(text.contains("last digits") && text.contains("--within"), "{text}");
        let found = scene.compare(&noise(5e-6)).farthest.expect("the same points").distance;
        assert!((4e-6..9e-6).contains(&found), "{found}");
    }
}

#[test]
fn numbers_of_16_bits_are_named_beside_other_mistakes() {
    let unit = |x: f32| x.abs().max(1.0 / 16384.0).log2().floor().exp2() / 1024.0;
    let halves = |p: Vec3| p.map(|x| (x / unit(x)).round() * unit(x));
    for scene in [torus(Partitioning::FractionalOdd), torus(Partitioning::Integer)] {
        let text = scene.check(&Theirs::new(&scene.out).moved(halves), &["rounding"]);
        assert!(text.contains("rounded to 16-bit floating-point numbers") && text.contains("--within "), "{text}");
        let scaled = Theirs::new(&scene.out).moved(|p| halves(100.0 * p));
        scene.check(&scaled, &["coordinates", "rounding"]);
    }
    let scene =
        Scene::new(Shape::Torus, Tessellation { partitioning: Partitioning::Integer, ..Tessellation::default() });
    scene.check(&scene.theirs(|own| own.factor = 5.0).moved(halves), &["factors", "rounding"]);
    // Where our own numbers have as few bits, nothing was rounded.
    let mut mesh = Shape::CubeSplit.build();
    mesh.corners.iter_mut().for_each(|corner| corner.position = corner.position.signum() * 0.5);
    let tessellation = Tessellation {
        surface: Surface::Flat,
        partitioning: Partitioning::Integer,
        factor: 4.0,
        ..Tessellation::default()
    };
    let cube = Scene::from_mesh(mesh, tessellation);
    let own = Theirs::new(&cube.out);
    let inside = |p: &Vec3| p.x == 0.5 && p.y.abs() < 0.5 && p.z.abs() < 0.5;
    let inside = own.positions.iter().copied().find(inside).expect("a face has points inside");
    let lifted = own.moved(|p| if p == inside { p + Vec3::X / 1024.0 } else { p });
    cube.check(&lifted, &["moved_vertices"]);
}

#[test]
fn three_decimals_are_enough_where_points_are_farther_apart() {
    let (decimals, resolution) = (|p: Vec3| (p * 1000.0).round() / 1000.0, 0.0005);
    for (partitioning, factor) in [(Partitioning::Integer, 5.0), (Partitioning::Rows, 4.0), (Partitioning::Pow2, 8.0)] {
        let scene = Scene::new(Shape::Torus, Tessellation { partitioning, factor, ..Tessellation::default() });
        let kinds = |theirs: Theirs| {
            let found = scene.compare_to_decimals(&theirs.moved(decimals), resolution);
            found.findings.iter().map(Finding::kind).collect::<Vec<_>>()
        };
        assert_eq!(kinds(Theirs::new(&scene.out)), [""; 0], "{partitioning:?}");
        assert_eq!(kinds(scene.theirs(|own| own.factor = 2.0)), ["factors"], "{partitioning:?}");
    }
}

#[test]
fn another_factor_everywhere_is_named() {
    for (partitioning, factor) in [
        (Partitioning::Integer, 5.0),
        (Partitioning::FractionalOdd, 6.25),
        (Partitioning::FractionalEven, 3.0),
        (Partitioning::Subtriangulation, 3.0),
    ] {
        let scene = Scene::new(Shape::Torus, Tessellation { partitioning, ..Tessellation::default() });
        let text = scene.check(&scene.theirs(|own| own.factor = factor).shuffled(), &["factors"]);
        assert!(text.contains(&format!("All its factors are {factor}.")), "{partitioning:?}: {text}");
    }
}

#[test]
fn each_partitioning_is_told_from_each_other() {
    for ours in Partitioning::DIRECT3D {
        let scene = torus(ours);
        for theirs in Partitioning::DIRECT3D.into_iter().chain([Partitioning::Rows]).filter(|theirs| *theirs != ours) {
            let text = scene.check(&scene.theirs(|own| own.partitioning = theirs).shuffled(), &["partitioning"]);
            let said = format!("Its partitioning is {}, and ours is {}", theirs.name(), ours.name());
            assert!(text.contains(&said), "{text}");
        }
    }
}

#[test]
fn factors_of_other_edges_are_conventions_and_crack() {
    let scene = torus(Partitioning::FractionalOdd);
    for convention in [Convention::Rotated, Convention::Mirrored] {
        let theirs = scene.theirs(|own| own.convention = convention).shuffled();
        let text = scene.check(&theirs, &["order_of_factors", "cracks"]);
        assert!(text.contains(&format!("as under --convention {}", convention.name())), "{text}");
        assert!(!scene.compare(&theirs).sides.is_empty());
    }
    // Valid conventions give the same points on edges, and others inside only in the last bits.
    for convention in [Convention::AmdPn, Convention::EdgeOrder] {
        let text = scene.check(&scene.theirs(|own| own.convention = convention).shuffled(), &["convention"]);
        assert!(text.contains(&format!("those of --convention {}", convention.name())), "{text}");
    }
}

#[test]
fn changes_of_factors_are_named() {
    let scene = torus(Partitioning::Integer);
    let mean = |[a, b, c]: [f32; 3]| (a + b + c) / 3.0;
    let least = |[a, b, c]: [f32; 3]| a.min(b).min(c);
    for (theirs, said) in [
        (scene.theirs_with(|sides, inside| (sides.map(f32::floor), inside.floor())), "rounded down"),
        (scene.theirs_with(|sides, inside| (sides.map(f32::round), inside.round())), "rounded to the nearest"),
        (scene.theirs_with(|sides, _| (sides, least(sides))), "inside factors are the least"),
        (scene.theirs_with(|sides, _| (sides, mean(sides))), "inside factors are the mean"),
        (scene.theirs_with(|sides, inside| (sides.map(|factor| factor / 2.0), inside / 2.0)), "0.5 times ours"),
        (scene.theirs_with(|sides, inside| (sides.map(|factor| factor.min(8.0)), inside.min(8.0))), "limited to 8"),
    ] {
        let text = scene.check(&theirs.shuffled(), &["factors"]);
        assert!(text.contains(said), "{said}: {text}");
    }
}

#[test]
fn factors_without_a_rule_are_listed_by_side() {
    let scene = torus(Partitioning::Integer);
    // Both sides of an edge get the same.
    let theirs = scene.theirs_with(|sides, inside| (sides.map(|factor| factor + 1.0 + (factor * 7.0).sin()), inside));
    let text = scene.check(&theirs, &["factors"]);
    assert!(text.contains("have other points") && text.contains("suit our partitioning, integer"), "{text}");
    let found = scene.compare(&theirs);
    let first = &found.sides[0];
    let own = first.ours.segments as f64;
    assert!(first.theirs.segments != first.ours.segments && (first.ours.factor - own).abs() < 0.01, "{first:?}");
    assert!(found.sides.len() > 100 && found.different.len() > 50);
}

#[test]
fn every_other_surface_is_named() {
    let scene = Scene::new(Shape::CubeSplit, Tessellation::default());
    for surface in Surface::ALL.into_iter().filter(|surface| *surface != Surface::PnAen) {
        let text = scene.check(&scene.theirs(|own| own.surface = surface).shuffled(), &["surface"]);
        assert!(text.contains(&format!("lie on that of --surface {}", surface.name())), "{surface:?}: {text}");
    }
    let text = scene.check(&scene.theirs(|own| (own.surface, own.alpha) = (Surface::PhongAen, 0.6)), &["surface"]);
    assert!(text.contains("--surface phong-aen --alpha 0.6"), "{text}");
    // Phong of another strength than ours, and other factors at the same time.
    let phong = Scene::new(Shape::Torus, Tessellation { surface: Surface::Phong, ..varied(Partitioning::Integer) });
    let theirs = phong.theirs(|own| (own.alpha, own.partitioning) = (1.0, Partitioning::Pow2));
    let text = phong.check(&theirs, &["surface", "partitioning"]);
    assert!(text.contains("--alpha 1") && text.contains("pow2"), "{text}");
}

/// What we emit if control points have a mistake.
fn with_mistake(scene: &Scene, mistake: NetMistake) -> Theirs {
    let surface = OurSurface { inputs: scene.inputs, mistake: Some(mistake) };
    Theirs {
        positions: surface.positions(&scene.mesh, &scene.topology, &scene.out.vertices),
        ..Theirs::new(&scene.out)
    }
}

#[test]
fn mistakes_in_control_points_are_named() {
    let edges = |share, bend| NetMistake::Edges { share, bend };
    let own = Tessellation { partitioning: Partitioning::Integer, factor: 5.0, ..Tessellation::default() };
    // Every fourth on the torus, whose patches have seams between them.
    for (shape, tried) in [(Shape::CubeSplit, 1), (Shape::Torus, 4)] {
        let scene = Scene::new(shape, own);
        let all = [
            (NetMistake::Center(0.0), "is E alone"),
            (NetMistake::Center(-1.0), "is V, the mean of the corners"),
            (NetMistake::Center(0.8), "E + 0.8 (E - V)"),
            (edges(0.5, 1.5), "at 1/2 of the edge, and not at 1/3"),
            (edges(2.0 * THIRD, 1.0), "at 2/3 of the edge"),
            (edges(THIRD, -1.0), "on the other side of the edge"),
            (edges(THIRD, 1.44), "as with normals of length 1.200"),
            (edges(THIRD, 0.5625), "as with normals of length 0.750"),
            (NetMistake::Times(1.5), "are 1.5 times ours"),
            (NetMistake::Swapped, "near the start and near the end of every side are exchanged"),
            (NetMistake::Exchanged(1), "b120 and b021 are exchanged"),
            (NetMistake::Exchanged(2), "b021 and b012 are exchanged"),
        ];
        for (mistake, said) in all.into_iter().step_by(tried) {
            let text = scene.check(&with_mistake(&scene, mistake).shuffled(), &["control_points"]);
            assert!(text.contains(said) && text.contains("Look "), "{shape}, {mistake:?}: {text}");
        }
    }
}

#[test]
fn other_spaces_are_named() {
    let scene = Scene::new(Shape::Bicubic, Tessellation { factor: 3.0, ..Tessellation::default() });
    let whole = Theirs::new(&scene.out).shuffled();
    let turn = Mat4::from_axis_angle(vec3(1.0, 2.0, 2.0) / 3.0, 0.5) * Mat4::from_translation(vec3(0.3, -0.2, 0.1));
    let text = scene.check(&whole.clone().moved(|p| turn.transform_point3(p)), &["coordinates"]);
    assert!(
        text.contains("turned by 28.6 degrees about (0.333, 0.667, 0.667), moved by (") && text.contains("Look "),
        "{text}"
    );
    let mirrored = whole.clone().moved(|p| turn.transform_point3(p * vec3(1.0, 1.0, -1.0)));
    assert!(scene.check(&mirrored, &["coordinates"]).contains("mirrored at the origin and turned by "));
    let clip = scene.inputs.view.clip_from_object;
    let divided = whole.clone().moved(|p| clip.project_point3(p));
    let text = scene.check(&divided, &["coordinates"]);
    assert!(text.contains("in clip space, by this camera's matrix, and divided by w"), "{text}");
    let text = scene.check(&whole.moved(|p| (clip * p.extend(1.0)).truncate()), &["coordinates"]);
    assert!(text.contains("in clip space, by this camera's matrix."), "{text}");
}

#[test]
fn another_view_is_told_from_moved_vertices() {
    // A few of the vertices lie where ours do.
    for partitioning in [Partitioning::Integer, Partitioning::FractionalOdd] {
        let own = Tessellation { pixels: 30.0, ..varied(partitioning) };
        let scene = Scene::new(Shape::Icosphere, own);
        let view =
            scene.inputs.view.seen_through(scene.inputs.view.clip_from_object, scene.inputs.view.half_viewport * 1.3);
        let theirs = tessellate(&scene.mesh, &scene.topology, &Inputs { view, ..scene.inputs }, None);
        let found = scene.compare(&Theirs::new(&theirs).shuffled());
        let kinds: Vec<_> = found.findings.iter().map(Finding::kind).collect();
        assert!(kinds.contains(&"factors") && !kinds.contains(&"moved_vertices"), "{partitioning:?}: {kinds:?}");
    }
}

#[test]
fn displacement_along_normals_is_told_from_other_moves() {
    let scene =
        Scene::new(Shape::Torus, Tessellation { partitioning: Partitioning::Integer, ..Tessellation::default() });
    let mut theirs = Theirs::new(&scene.out);
    for (position, vertex) in theirs.positions.iter_mut().zip(&scene.out.vertices) {
        *position += unpack_normal(vertex.normal) * (0.02 + 0.01 * (position.x * 9.0).sin());
    }
    let text = scene.check(&theirs.shuffled(), &["displaced"]);
    assert!(text.contains("along the normals, by up to 0.0300 object units outward"), "{text}");
    // Their factors are ours, though some of their points seem to lie elsewhere.
    assert!(scene.compare(&theirs).sides.is_empty() && scene.compare(&theirs).different.is_empty());
    let wavy = Theirs::new(&scene.out).moved(|p| p + vec3(0.006 * (p.y * 5.0).cos(), 0.0, 0.0));
    let text = scene.check(&wavy, &["displaced"]);
    assert!(text.contains("not along the normals"), "{text}");
}

#[test]
fn a_displaced_surface_is_told_from_its_base() {
    let mut mesh = Shape::Torus.build();
    let height = |i: u32| 0.5 + 0.5 * ((i % 64) as f32 / 5.0).sin() * ((i / 64) as f32 / 7.0).cos();
    mesh.heights =
        Some(Arc::new(Heights::everywhere(&mesh, HeightMap::new([64, 64], (0..4096).map(height).collect()))));
    let scene =
        Scene::from_mesh(mesh, Tessellation { displacement: Displacement::On, ..varied(Partitioning::Integer) });
    scene.check(&Theirs::new(&scene.out).shuffled(), &[]);
    let flat = scene.theirs(|own| own.displacement = Displacement::Off);
    let text = scene.check(&flat.shuffled(), &["surface"]);
    assert!(text.contains("It isn't displaced"), "{text}");
    let more = scene.theirs(|own| own.height_scale *= 1.5);
    let text = scene.check(&more, &["displaced"]);
    assert!(text.contains("otherwise than ours"), "{text}");
}

#[test]
fn a_moved_vertex_is_found() {
    let scene = torus(Partitioning::Integer);
    let whole = Theirs::new(&scene.out);
    // The last vertex of a patch is inside.
    let patch = scene.out.vertices[scene.out.vertices.len() / 2].patch();
    let last = scene.out.vertices.iter().rposition(|vertex| vertex.patch() == patch).expect("a vertex");
    let mut off = whole.clone();
    off.positions[last] *= 1.02;
    let moved = off.positions[last].distance(whole.positions[last]);
    let text = scene.check(&off, &["moved_vertices"]);
    assert!(text.contains("1 vertex is moved") && text.contains(&format!("triangle {patch}")), "{text}");
    let found = scene.compare(&off);
    assert_eq!(found.strays.len(), 1);
    let Some(Finding::Moved { distance, .. }) = found.findings.first() else { panic!("{text}") };
    assert!((distance - f64::from(moved)).abs() < 1e-5, "{distance}, not {moved}");
    // Towards a neighbour, which is along the surface.
    let mut along = whole.clone();
    let neighbour = scene.out.triangles.iter().find(|triangle| triangle.contains(&(last as u32))).expect("a triangle");
    let other = neighbour.iter().find(|vertex| **vertex != last as u32).expect("three vertices");
    let Place { weights, .. } = place_between(&scene, last, *other as usize);
    along.positions[last] = weights;
    let text = scene.check(&along, &["moved_vertices"]);
    assert!(text.contains("1 vertex is moved"), "{text}");
}

/// A point of the surface between two emitted vertices of one patch.
struct Place {
    weights: Vec3,
}

fn place_between(scene: &Scene, a: usize, b: usize) -> Place {
    let limit = geometry::tessellate::LimitSurface::new(&scene.mesh, &scene.topology, &scene.inputs);
    let [a, b] = [a, b].map(|index| scene.out.vertices[index]);
    let net = limit.net(a.patch());
    let [u, v] = [0, 1].map(|k| f64::from(a.domain()[k]) * 0.6 / 65536.0 + f64::from(b.domain()[k]) * 0.4 / 65536.0);
    Place { weights: limit.position(a.patch(), &net, u, v).as_vec3() }
}

#[test]
fn missing_and_additional_triangles_are_counted() {
    let scene = torus(Partitioning::FractionalEven);
    let whole = Theirs::new(&scene.out);
    let patch_of = |triangle: &[u32; 3]| scene.out.vertices[triangle[0] as usize].patch();
    let mut without_patches = whole.clone();
    without_patches.triangles.retain(|triangle| ![17, 40].contains(&patch_of(triangle)));
    let text = scene.check(&without_patches.shuffled(), &["missing_patches"]);
    assert!(text.contains("2 of 256 patches have no triangles: triangles 17, 40."), "{text}");
    let mut without_one = whole.clone();
    without_one.triangles.remove(100);
    let text = scene.check(&without_one.shuffled(), &["missing_triangles"]);
    assert!(text.contains("1 triangle is missing, in 1 patch"), "{text}");
    let mut twice = whole.clone();
    twice.triangles.extend_from_slice(&whole.triangles[500..503]);
    let text = scene.check(&twice.shuffled(), &["doubled_triangles"]);
    assert!(text.contains("3 triangles are there more than once"), "{text}");
    // A factor of 0 leaves a patch out that they have.
    let mut written = hull_factors(&scene.mesh, &scene.topology, &scene.inputs);
    written[17].edges = [0.0; 3];
    let out = tessellate_given(&scene.mesh, &scene.topology, &scene.inputs, &written);
    let culled = Scene { out, ..scene };
    let text = culled.check(&whole.shuffled(), &["additional_patches"]);
    assert!(text.contains("1 patch has triangles, though our tessellation leaves it out: triangle 17."), "{text}");
}

#[test]
fn winding_and_diagonals_are_told() {
    let scene = torus(Partitioning::FractionalOdd);
    let whole = Theirs::new(&scene.out);
    let mut flipped = whole.clone();
    flipped.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    let text = scene.check(&flipped.shuffled(), &["winding"]);
    assert!(text.contains("All triangles are wound the other way"), "{text}");
    flipped = whole.clone();
    flipped.triangles[..7].iter_mut().for_each(|triangle| triangle.swap(1, 2));
    assert!(scene.check(&flipped, &["winding"]).starts_with("7 of "));
    let mut turned = whole.clone();
    let [first, second] = quad(&turned.triangles);
    let (shared, own) = apart(turned.triangles[first], turned.triangles[second]);
    turned.triangles[first] = [own[0], shared[0], own[1]];
    turned.triangles[second] = [own[1], shared[1], own[0]];
    let text = scene.check(&turned.shuffled(), &["diagonals"]);
    assert!(text.contains("2 triangles join other points") && text.contains("diagonals are turned"), "{text}");
}

/// Two triangles that make up a convex quad inside one patch: neighbours of the list that share an edge.
fn quad(triangles: &[[u32; 3]]) -> [usize; 2] {
    let shared = |a: &[u32; 3], b: &[u32; 3]| a.iter().filter(|vertex| b.contains(vertex)).count();
    let first = triangles.windows(2).position(|pair| shared(&pair[0], &pair[1]) == 2).expect("neighbours");
    [first, first + 1]
}

/// The vertices that two triangles share, in the order of the first, and the one that each has alone.
fn apart(a: [u32; 3], b: [u32; 3]) -> ([u32; 2], [u32; 2]) {
    let alone = |own: [u32; 3], other: [u32; 3]| own.into_iter().find(|vertex| !other.contains(vertex)).expect("one");
    let own = [alone(a, b), alone(b, a)];
    let at = a.iter().position(|vertex| *vertex == own[0]).expect("it is one of them");
    ([a[(at + 1) % 3], a[(at + 2) % 3]], own)
}

#[test]
fn coordinates_that_are_turned_scaled_mirrored_or_moved_are_found_first() {
    // Nothing is symmetric about the bicubic vase.
    let scene = Scene::new(Shape::Bicubic, Tessellation { factor: 3.0, ..Tessellation::default() });
    let whole = Theirs::new(&scene.out).shuffled();
    for (theirs, said) in [
        (whole.clone().moved(|p| p * 100.0), "scaled (100 times ours)"),
        (whole.clone().moved(|p| vec3(p.x, -p.z, p.y)), "turned (its x, y, z are our x, -z, y)"),
        (
            whole.clone().moved(|p| vec3(p.x, -p.z, p.y) * 0.0254),
            "turned (its x, y, z are our x, -z, y) and scaled (0.0254",
        ),
        (whole.clone().moved(|p| vec3(p.x, p.y, -p.z)), "mirrored (its x, y, z are our x, y, -z)"),
        (whole.clone().moved(|p| p + vec3(5.0, 0.0, 0.0)), "moved (by (5, 0, 0))"),
    ] {
        let text = scene.compare(&theirs).findings.first().map(Finding::to_string).unwrap_or_default();
        assert!(text.contains(said), "{said}: {text}");
        let kinds: Vec<_> = scene.compare(&theirs).findings.iter().map(Finding::kind).collect();
        assert!(kinds.len() == 1 || kinds[1..] == ["rounding"], "{said}: {kinds:?}");
    }
    // Behind that, other mistakes are found as usual.
    let theirs =
        scene.theirs(|own| own.partitioning = Partitioning::FractionalEven).moved(|p| vec3(p.x, -p.z, p.y) * 100.0);
    assert!(scene.check(&theirs, &["coordinates", "partitioning"]).contains("fractional-even"));
}

#[test]
fn coordinates_of_a_symmetric_mesh_are_told_by_its_vertices() {
    // The torus looks nearly the same from eight sides and their opposites; LOD cuts each otherwise.
    let scene = torus(Partitioning::Integer);
    let whole = Theirs::new(&scene.out).shuffled();
    for (theirs, said) in [
        (
            whole.clone().moved(|p| vec3(p.x, -p.z, p.y) * 100.0),
            "turned (its x, y, z are our x, -z, y) and scaled (100 ",
        ),
        (whole.clone().moved(|p| -p), "mirrored (its x, y, z are our -x, -y, -z)."),
        (whole.clone().moved(|p| vec3(-p.x, p.y, p.z)), "mirrored (its x, y, z are our -x, y, z)."),
        (whole.clone().moved(|p| p * 1.03), "scaled (1.03 times ours)."),
    ] {
        let found: Vec<_> = scene.compare(&theirs).findings;
        let text = found.first().map(Finding::to_string).unwrap_or_default();
        assert!(text.contains(said), "{said}: {text}");
        let others: Vec<_> = found.iter().skip(1).map(Finding::kind).filter(|kind| *kind != "rounding").collect();
        assert!(others.is_empty(), "{said}: {others:?}");
    }
    // With other factors the surface alone tells, and of several ways to turn it the usual one is named.
    let theirs = scene.theirs(|own| own.partitioning = Partitioning::Pow2).moved(|p| vec3(p.x, -p.z, p.y));
    let text = scene.compare(&theirs).findings.first().map(Finding::to_string).unwrap_or_default();
    assert!(text.contains("its x, y, z are our x, -z, y"), "{text}");
}

#[test]
fn another_mesh_is_no_tessellation_of_this_one() {
    let scene = torus(Partitioning::Integer);
    let other = Scene::new(Shape::CubeSplit, Tessellation::default());
    let text = scene.check(&Theirs::new(&other.out), &["not_a_tessellation"]);
    assert!(text.contains("vertices are farther than"), "{text}");
}

#[test]
fn triangles_that_are_not_finite_are_said() {
    let scene = torus(Partitioning::Integer);
    let mut theirs = Theirs::new(&scene.out).shuffled();
    theirs.positions[3].y = f32::NAN;
    let text = scene.check(&theirs, &["not_finite", "missing_triangles"]);
    assert!(text.contains("1 triangle has a coordinate that is NaN"), "{text}");
}

/// A finding of each kind, with the numbers that the manual has.
fn examples() -> Vec<Finding> {
    use super::corner_orders::CornerOrder;
    use super::explanations::{Explanation, InsideRule, Rule};
    use super::findings::{Displaced, UnknownFactors};
    let axes = |axes, scale| Finding::Aligned(Alignment { axes, scale, offset: DVec3::ZERO }.into());
    let space = |kind| Finding::Aligned(Space::from_kind(kind));
    let net = |mistake| Finding::OtherNets { mistake, vertices: 120, of: 300 };
    let edges = |share, bend| net(NetMistake::Edges { share, bend });
    let surface = |surface, alpha| Tessellation { surface, alpha, ..Tessellation::default() };
    let [pn_aen, pn] = [Surface::PnAen, Surface::Pn].map(|own| surface(own, 0.75));
    let raised = Tessellation { displacement: Displacement::On, ..pn_aen };
    let other = |ours, theirs| Finding::OtherSurface { ours, theirs, vertices: 120, of: 300 };
    let displaced = |is_along_normals, largest| {
        let (outward, inward, ours) = (0.03, 0.0, Displacement::Off);
        Finding::Displaced(Displaced { vertices: 290, of: 300, largest, outward, inward, is_along_normals, ours })
    };
    let place = DVec3::new(1.0, 2.0, 3.0);
    let (ours, convention) = (Partitioning::FractionalOdd, Convention::D3d11);
    let factors = |partitioning, rule| {
        let explanations = vec![Explanation { partitioning, rule }];
        Finding::Factors { ours, convention, explanations, patches: 64, of: 64 }
    };
    let farthest = Farthest { distance: 5e-6, patch: 0, theirs: place, ours: place };
    let unknown = |is_of_view| {
        let (suits, ours) = (vec![Partitioning::Integer], Partitioning::Integer);
        Finding::UnknownFactors(UnknownFactors { patches: 60, of: 64, sides: 170, inside: 2, suits, ours, is_of_view })
    };
    vec![
        Finding::NotATessellation { far: 1203, vertices: 4000, distance: 0.05 },
        axes([(0, false), (2, true), (1, false)], 100.0),
        axes([(0, false), (1, false), (2, true)], 1.0),
        space(SpaceKind::View),
        space(SpaceKind::Clip),
        space(SpaceKind::DividedClip),
        space(SpaceKind::Turned { axis: DVec3::Y, degrees: 30.0, scale: 1.0, offset: DVec3::X, is_mirrored: false }),
        net(NetMistake::Center(0.0)),
        net(NetMistake::Center(-1.0)),
        net(NetMistake::Center(1.0)),
        edges(0.5, 1.5),
        edges(2.0 * THIRD, 1.0),
        edges(THIRD, -1.0),
        edges(THIRD, 0.0),
        edges(THIRD, 3.0),
        edges(THIRD, 1.44),
        net(NetMistake::Times(1.5)),
        net(NetMistake::Swapped),
        net(NetMistake::Exchanged(1)),
        other(pn_aen, pn),
        other(surface(Surface::Phong, 0.75), surface(Surface::Phong, 1.0)),
        other(raised, pn_aen),
        displaced(true, 0.03),
        displaced(false, 0.04),
        Finding::Moved { vertices: 1, farthest: place, distance: 0.02, triangle: 7 },
        factors(ours, Rule::All(7.0)),
        factors(Partitioning::FractionalEven, Rule::Same),
        factors(ours, Rule::Sides([2, 0, 1])),
        factors(ours, Rule::Down),
        factors(ours, Rule::Inside(InsideRule::Mean)),
        factors(ours, Rule::Times(0.5)),
        factors(ours, Rule::AtMost(16.0)),
        unknown(false),
        unknown(true),
        Finding::Cracked { edges: 90, of: 96 },
        Finding::MissingPatches { patches: 2, of: 64, triangles: vec![17, 40] },
        Finding::AdditionalPatches { patches: 1, triangles: vec![5] },
        Finding::MissingTriangles { count: 1, patches: 1 },
        Finding::Doubled { count: 3, patches: 2 },
        Finding::Flipped { count: 9, of: 9 },
        Finding::OtherTriangles { count: 2, patches: 1, order: None },
        Finding::OtherTriangles { count: 40, patches: 8, order: Some(CornerOrder::ALL[1]) },
        Finding::Convention { ours: convention, theirs: Convention::AmdPn },
        Finding::NotFinite { count: 1 },
        Finding::Rounding { farthest, ulps: 42.0, triangle: 7 },
    ]
}

#[test]
fn the_results_have_every_sentence_and_kind() {
    let page = documents::in_repository("docs/results/compare-meshes.md");
    let page = std::fs::read_to_string(page).expect("a page");
    for finding in examples() {
        assert!(page.contains(&format!("| {} |", finding)), "the page lacks: {}", finding);
        assert!(page.contains(&format!("`{}`", finding.kind())), "the page lacks {}", finding.kind());
    }
}
