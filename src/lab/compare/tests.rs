//! Mistakes that are made on purpose in what we emit ourselves, each of which must be named, and nothing else.

mod coordinates;
mod factors;
mod rounding;
mod sentences;
mod surfaces;
mod triangles;

use glam::{Mat4, Vec2, Vec3, vec3};

use super::net_mistakes::{NetMistake, THIRD};
use super::*;
use geometry::mesh::Shape;
use geometry::tessellate::{
    Convention, Displacement, Lod, LodView, Partitioning, Surface, domain_side, hull_factors, tessellate,
    tessellate_given,
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
