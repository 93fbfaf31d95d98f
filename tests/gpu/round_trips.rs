//! What we emit ourselves is the same as ours to `compare`, on meshes of all kinds, wherever it was tessellated.

use std::sync::Arc;

use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::{Material, Mesh, Shape, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{
    Clip, Convention, Inputs, Lod, Partitioning, Surface, Tessellated, Tessellation, tessellate,
};
use geometry::view::ulp;
use glam::{Vec2, Vec3, vec3};
use gpu::Timing;
use inspect::render::Camera;
use inspect::settings::{ARENA_BYTES, Settings};
use lab::compare::{Comparison, ForeignMesh, OurTessellation, Tolerances, compare};
use lab::stability::CASES;

use crate::engine;

const VIEWPORT: Vec2 = glam::vec2(640.0, 400.0);

fn corner(position: Vec3, normal: Vec3) -> InputCorner {
    InputCorner { position, normal: Some(normal.normalize()), uv: Vec2::ZERO }
}

fn mesh(triangles: impl IntoIterator<Item = [InputCorner; 3]>) -> Mesh {
    let mut builder = MeshBuilder::new();
    let material = builder.material(Material::plain("default", [0.6, 0.6, 0.6, 1.0]));
    triangles.into_iter().for_each(|triangle| builder.triangle(material, triangle));
    builder.finish("round trip".to_owned(), &Progress::new()).expect("nobody cancels")
}

fn triangles(shape: Shape) -> Vec<[InputCorner; 3]> {
    let own = shape.build();
    own.triangles.iter().map(|corners| corners.map(|c| own.corners[c as usize].into())).collect()
}

/// Quads side by side, each beside two of half its length. The T-junctions between them are filled by triangles whose corners lie
/// in line. `height` bends the sheet.
fn filled_junctions(height: f32) -> Mesh {
    let at = |x: f32, z: f32| corner(vec3(x, height * (1.0 - x * x), z), vec3(2.0 * height * x, 1.0, 0.4 * height * z));
    let quad = |a, b, c, d| [[a, b, c], [a, c, d]];
    let mut all = Vec::new();
    for k in 0..4 {
        let (near, far) = (1.0 - 0.5 * k as f32, 0.5 - 0.5 * k as f32);
        let middle = 0.5 * (near + far);
        all.extend(quad(at(-1.0, near), at(0.0, near), at(0.0, far), at(-1.0, far)));
        all.extend(quad(at(0.0, near), at(1.0, near), at(1.0, middle), at(0.0, middle)));
        all.extend(quad(at(0.0, middle), at(1.0, middle), at(1.0, far), at(0.0, far)));
        all.push([at(0.0, near), at(0.0, middle), at(0.0, far)]);
    }
    mesh(all)
}

/// A triangle whose corners lie in line, with normals that bend its sides, on an edge of an icosahedron's.
fn bent_in_line() -> Mesh {
    let mut all = triangles(Shape::Icosahedron);
    let [a, b, _] = all[0];
    let middle = 0.5 * (a.position + b.position);
    all.push([a, b, corner(middle, middle)]);
    mesh(all)
}

/// A saddle, and the same seen from below.
fn back_to_back() -> Mesh {
    let turned = |[a, b, c]: [InputCorner; 3]| {
        [a, c, b].map(|own| InputCorner { normal: own.normal.map(|normal| -normal), ..own })
    };
    let all = triangles(Shape::Saddle);
    mesh(all.iter().copied().chain(all.iter().copied().map(turned)))
}

/// An icosphere, whose every triangle is there twice.
fn twice() -> Mesh {
    let all = triangles(Shape::Icosphere);
    mesh(all.iter().chain(&all).copied())
}

/// A disk of thin triangles around its middle, every other one of which is a hundred times thinner, with texture seams between them.
fn needles() -> Mesh {
    let at = |k: usize| {
        let angle = 0.05 * (k / 2) as f32 + if k.is_multiple_of(2) { 0.0 } else { 5e-4 };
        corner(vec3(angle.cos(), 0.0, angle.sin()), vec3(0.5 * angle.cos(), 1.0, 0.5 * angle.sin()))
    };
    let seamed = |k: usize| {
        [corner(Vec3::ZERO, Vec3::Y), at(k + 1), at(k)]
            .map(|own| InputCorner { uv: Vec2::splat((k % 3) as f32 / 3.0), ..own })
    };
    mesh((0..60).map(seamed))
}

/// Meshes, with their names and weld tolerances.
fn meshes() -> Vec<(String, Mesh, f32)> {
    let cases = CASES.iter().map(|case| (case.name.to_owned(), (case.mesh)(), case.weld));
    let own = [
        ("filled T-junctions", filled_junctions(0.3)),
        ("flat filled T-junctions", filled_junctions(0.0)),
        ("bent in line", bent_in_line()),
        ("back to back", back_to_back()),
        ("twice", twice()),
        ("needles", needles()),
        ("cylinder", Shape::Cylinder.build()),
        ("bicubic", Shape::Bicubic.build()),
    ];
    cases.chain(own.map(|(name, mesh)| (name.to_owned(), mesh, 0.0))).collect()
}

/// Settings, of which each mesh gets three in turn. Their number shares no factor with three, so that all meshes together get all.
fn settings() -> [Tessellation; 13] {
    use Partitioning::{FractionalEven, FractionalOdd, Integer, Pow2, Rows, Subtriangulation};
    let by = |surface, lod, partitioning| Tessellation { surface, lod, partitioning, ..Tessellation::default() };
    let px = |pixels, own| Tessellation { pixels, ..own };
    let distance = |own| Tessellation { near: 1.0, far: 6.0, factor: 11.0, ..own };
    [
        px(12.0, by(Surface::PnAen, Lod::Paper, Integer)),
        px(20.0, by(Surface::PnAen, Lod::EdgeLength, FractionalOdd)),
        Tessellation { factor: 5.3, ..by(Surface::Phong, Lod::Uniform, FractionalOdd) },
        px(15.0, by(Surface::Pn, Lod::EdgeLength, Integer)),
        distance(by(Surface::NagataAen, Lod::Distance, FractionalEven)),
        Tessellation { tolerance: 0.5, ..by(Surface::PnCrease, Lod::Error, FractionalOdd) },
        Tessellation { factor: 5.0, ..by(Surface::Flat, Lod::Uniform, Rows) },
        Tessellation { tolerance: 0.3, ..by(Surface::PnAen, Lod::Error, Rows) },
        Tessellation { factor: 4.0, ..by(Surface::PhongAen, Lod::Uniform, Subtriangulation) },
        px(18.0, Tessellation { convention: Convention::AmdPn, ..by(Surface::Pn, Lod::Paper, FractionalEven) }),
        px(14.0, by(Surface::PnAen, Lod::EdgeLength, Pow2)),
        distance(Tessellation { clip: Clip::Frustum, ..by(Surface::PnAen, Lod::Distance, Integer) }),
        px(25.0, by(Surface::Nagata, Lod::EdgeLength, Rows)),
    ]
}

/// A mesh, seen obliquely.
struct Subject {
    mesh: Arc<Mesh>,
    topology: Arc<Topology>,
    inputs: Inputs,
}

impl Subject {
    fn new(mesh: Mesh, weld: f32, tessellation: &Tessellation) -> Self {
        let topology = Topology::build_within(&mesh, weld, &Progress::default()).expect("nobody cancels");
        let bounds = mesh.bounds();
        let camera = Camera { azimuth: 37.0, elevation: 21.0, ..Camera::framing(&bounds, VIEWPORT) };
        let inputs = Settings::from(*tessellation).inputs(camera.lod_view(VIEWPORT, &bounds));
        Self { mesh: Arc::new(mesh), topology: Arc::new(topology), inputs }
    }

    fn on_cpu(&self) -> Tessellated {
        tessellate(&self.mesh, &self.topology, &self.inputs, None)
    }

    fn on_gpu(&self) -> Tessellated {
        let mut scene = engine().scene_of(self.mesh.clone(), self.topology.clone(), ARENA_BYTES).expect("a small mesh");
        engine().count(&mut scene, &self.inputs, &mut Timing::Off).expect("counts");
        engine().read_tessellated(&mut scene).expect("a readback")
    }

    /// How far vertices of the same number are apart, in words.
    fn apart(&self, theirs: &Tessellated) -> String {
        let own = self.on_cpu();
        if own.patch_factors != theirs.patch_factors {
            let pairs = own.patch_factors.iter().zip(&theirs.patch_factors);
            return format!("{} patches have other factors", pairs.filter(|(own, theirs)| own != theirs).count());
        }
        let pairs = own.vertices.iter().zip(&theirs.vertices);
        let distance = pairs.map(|(own, theirs)| Vec3::from(own.position).distance(theirs.position.into()));
        format!("{} ULP apart", f64::from(distance.fold(0.0, f32::max)) / ulp(&self.topology))
    }

    /// Whether bounds of LOD by error, which may fall on either of two levels, gave some patches other factors than ours, and nothing else
    /// was found but those patches.
    fn has_other_factors_by_error(&self, theirs: &Tessellated, found: &Comparison) -> bool {
        let own = self.on_cpu();
        let pairs = own.patch_factors.iter().zip(&theirs.patch_factors);
        let others: Vec<u32> =
            (0..).zip(pairs).filter(|(_, (own, theirs))| own != theirs).map(|(patch, _)| patch).collect();
        let is_about_factors = found.findings.iter().all(|finding| ["factors", "cracks"].contains(&finding.kind()));
        self.inputs.tessellation.lod == Lod::Error
            && !others.is_empty()
            && is_about_factors
            && found.different == others
    }

    fn compared(&self, theirs: &Tessellated) -> Comparison {
        let tessellated = &self.on_cpu();
        let (mesh, topology, inputs) = (&*self.mesh, &*self.topology, &self.inputs);
        let ours = OurTessellation { mesh, topology, inputs, given: None, matrix: None, tessellated };
        let positions: Vec<Vec3> = theirs.vertices.iter().map(|vertex| vertex.position.into()).collect();
        let theirs = ForeignMesh::new(&positions, theirs.triangles.iter().copied());
        let exactness = Tolerances { within: 16.0 * ulp(topology), resolution: 0.0 };
        compare(&ours, &theirs, exactness)
    }
}

#[test]
fn what_we_emit_is_the_same_as_ours() {
    let (mut round_trips, mut failed) = (0, Vec::new());
    for (i, (name, mesh, weld)) in meshes().into_iter().enumerate() {
        for (j, tessellation) in settings().iter().cycle().skip(3 * i).take(3).enumerate() {
            let subject = Subject::new(mesh.clone(), weld, tessellation);
            let is_on_gpu = (i + j).is_multiple_of(2);
            let theirs = if is_on_gpu { subject.on_gpu() } else { subject.on_cpu() };
            let found = subject.compared(&theirs);
            round_trips += 1;
            if !found.findings.is_empty() && !subject.has_other_factors_by_error(&theirs, &found) {
                let texts: Vec<String> = found.findings.iter().map(ToString::to_string).collect();
                let Tessellation { surface, lod, partitioning, .. } = tessellation;
                let device = if is_on_gpu { "GPU" } else { "CPU" };
                let what = format!("{name}, {surface:?} {lod:?} {partitioning:?}, {device}");
                failed.push(format!("{what} ({}): {}", subject.apart(&theirs), texts.join(" ")));
            }
        }
    }
    assert_eq!(round_trips, 129);
    assert!(failed.is_empty(), "{} of {round_trips} aren't the same:\n{}", failed.len(), failed.join("\n"));
}

/// The triangles of a torus by the length of edges, whose factors the device computes in other last bits.
#[test]
fn last_bits_of_factors_are_no_difference() {
    for pixels in [5.0, 8.0, 13.0, 40.0] {
        for partitioning in Partitioning::ALL {
            let own = Tessellation { lod: Lod::EdgeLength, pixels, partitioning, ..Tessellation::default() };
            let subject = Subject::new(Shape::Torus.build(), 0.0, &own);
            let found = subject.compared(&subject.on_gpu());
            let texts: Vec<String> = found.findings.iter().map(ToString::to_string).collect();
            assert!(texts.is_empty(), "{pixels} px, {partitioning:?}: {texts:?}");
        }
    }
}
