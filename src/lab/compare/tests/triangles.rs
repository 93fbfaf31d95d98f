//! Single vertices and triangles: moved, missing, repeated, turned over, not finite, or of another mesh.

use super::*;

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
