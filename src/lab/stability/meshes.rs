//! The meshes of the cases. They are made in code, small, and have one defect each.

mod techniques;

pub(super) use techniques::{dart, displaced, height_seams, inflection, moving};

use glam::{Vec2, Vec3, vec3};

use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::{Corner, Material, Mesh, PartRange, PartStyle, Shape};
use geometry::progress::Progress;
use geometry::tessellate::Surface;

/// Makes a mesh of separate triangles as a loader does: normals are repaired, and equal corners merged.
fn mesh(triangles: impl IntoIterator<Item = [InputCorner; 3]>) -> Mesh {
    let mut builder = MeshBuilder::new();
    let material = builder.material(Material::plain("default", [0.6, 0.6, 0.6, 1.0]));
    for triangle in triangles {
        builder.triangle(material, triangle);
    }
    // Nobody else holds this handle, so nobody can cancel.
    builder.finish("case".to_owned(), &Progress::new()).unwrap_or_default()
}

fn corner(position: Vec3, normal: Vec3) -> InputCorner {
    InputCorner { position, normal: Some(normal), uv: Vec2::ZERO }
}

/// A shape's triangles, each with its index.
fn triangles(shape: Shape) -> Vec<(usize, [Corner; 3])> {
    let mesh = shape.build();
    mesh.triangles.iter().map(|corners| corners.map(|c| mesh.corners[c as usize])).enumerate().collect()
}

/// A shape with every corner changed. `change` gets the index of the triangle, that of the corner in it, and the corner.
fn changed(shape: Shape, change: impl Fn(usize, usize, Corner) -> Corner) -> Mesh {
    let triangles = triangles(shape).into_iter();
    mesh(triangles.map(|(t, corners)| [0, 1, 2].map(|k| InputCorner::from(change(t, k, corners[k])))))
}

pub(super) fn scaled(shape: Shape, scale: Vec3, offset: Vec3) -> Mesh {
    changed(shape, |_, _, corner| Corner { position: corner.position * scale + offset, ..corner })
}

pub(super) fn with_normals(shape: Shape, normal: impl Fn(usize, usize, Corner) -> Vec3) -> Mesh {
    changed(shape, |t, k, corner| Corner { normal: normal(t, k, corner), ..corner })
}

/// Five half-planes around one edge. Each has two triangles, and its own normals.
pub(super) fn fins() -> Mesh {
    let fin = |k: usize| {
        let angle = std::f32::consts::TAU * k as f32 / 5.0;
        let (out, normal) = (vec3(angle.cos(), 0.0, angle.sin()), vec3(-angle.sin(), 0.3, angle.cos()));
        let at = |out_by: f32, up: f32| corner(out * out_by + Vec3::Y * up, (normal + 0.4 * out).normalize());
        [[at(0.0, -1.0), at(0.0, 1.0), at(1.0, 0.7)], [at(0.0, -1.0), at(1.0, 0.7), at(1.0, -0.7)]]
    };
    mesh((0..5).flat_map(fin))
}

/// A torus in nine parts: one for each surface, whose details differ, and one that takes what is set. Triangles of a part are far from
/// each other, so that each part meets each other one.
pub(super) fn parts() -> Mesh {
    let shape = Shape::Torus.build();
    let count = Surface::ALL.len() as u32 + 1;
    let part = |triangle: u32| (triangle / 2 + triangle / 16 + triangle / 128 * 3) % count;
    let ranges = (0..shape.triangles.len() as u32).map(|own| PartRange { triangles: own..own + 1, part: part(own) });
    let styles = Surface::ALL.into_iter().zip([0.25, 1.0, 2.0].into_iter().cycle());
    let style = |(surface, detail)| PartStyle { surface: Some(surface), detail: Some(detail), ..PartStyle::default() };
    Mesh { part_ranges: ranges.collect(), part_styles: styles.map(style).collect(), ..shape }
}

/// An icosphere in which every third triangle is wound the other way.
pub(super) fn reversed_neighbours() -> Mesh {
    let turned = |(t, [a, b, c]): (usize, [Corner; 3])| if t % 3 == 0 { [a, c, b] } else { [a, b, c] };
    mesh(triangles(Shape::Icosphere).into_iter().map(|triangle| turned(triangle).map(InputCorner::from)))
}

/// A torus in which every other triangle appears twice and every fifth once more with reversed winding, with degenerate
/// triangles among them.
pub(super) fn duplicates() -> Mesh {
    let repeated = |(t, [a, b, c]): (usize, [Corner; 3])| {
        let mut all = vec![[a, b, c]];
        if t % 2 == 0 {
            all.push([b, c, a]);
        }
        if t % 5 == 0 {
            all.extend([[a, c, b], [a, a, b]]);
        }
        all
    };
    mesh(triangles(Shape::Torus).into_iter().flat_map(repeated).map(|corners| corners.map(InputCorner::from)))
}

/// A saddle in which every other triangle writes zeros as -0.
pub(super) fn signed_zeros() -> Mesh {
    changed(Shape::Saddle, |t, _, corner| {
        let signed = |v: Vec3| v.map(|x| if x.abs() < 1e-6 { if t % 2 == 0 { -0.0 } else { 0.0 } } else { x });
        Corner { position: signed(corner.position), normal: signed(corner.normal), uv: corner.uv }
    })
}

/// Half a torus and its mirror image, which share the points between them.
pub(super) fn mirrored() -> Mesh {
    let on_plane = |mut corner: Corner| {
        for x in [&mut corner.position.x, &mut corner.normal.x] {
            *x = if x.abs() < 1e-5 { 0.0 } else { *x };
        }
        corner
    };
    let half = triangles(Shape::Torus)
        .into_iter()
        .filter(|(_, corners)| corners.iter().map(|c| c.position.x).sum::<f32>() > 0.0);
    let both = half.flat_map(|(_, corners)| {
        let flip = vec3(-1.0, 1.0, 1.0);
        let own = corners.map(on_plane);
        let [a, b, c] = own.map(|c| Corner { position: c.position * flip, normal: c.normal * flip, ..c });
        [own, [a, c, b]]
    });
    mesh(both.map(|corners| corners.map(InputCorner::from)))
}

/// A cube whose normals run along its edges.
pub(super) fn edge_normals() -> Mesh {
    let triangles = triangles(Shape::CubeSplit).into_iter();
    mesh(triangles.map(|(_, c)| {
        [0, 1, 2].map(|k| {
            let along = c[(k + 1) % 3].position - c[k].position;
            corner(c[k].position, along.normalize())
        })
    }))
}

/// A saddle whose middle line has denormal coordinates, which many devices take for zero.
pub(super) fn denormals() -> Mesh {
    changed(Shape::Saddle, |t, k, corner| {
        let least = f32::from_bits(1 + (3 * t + k) as u32);
        let small = |x: f32| if x.abs() < 1e-6 { least } else { x };
        Corner { position: corner.position.map(small), ..corner }
    })
}

/// A torus cut through the middle, with its right half moved by a millionth of its size.
pub(super) fn near_seam() -> Mesh {
    let moved = |corners: [Corner; 3]| {
        let right = corners.iter().map(|c| c.position.x).sum::<f32>() > 0.0;
        let offset = if right { vec3(2e-6, 1e-6, -1e-6) } else { Vec3::ZERO };
        corners.map(|c| InputCorner::from(Corner { position: c.position + offset, ..c }))
    };
    mesh(triangles(Shape::Torus).into_iter().map(|(_, corners)| moved(corners)))
}

/// Two triangles that meet at a ridge, with normals of their own that lean apart.
pub(super) fn roof() -> Mesh {
    let ends = [vec3(0.0, 0.3, 1.0), vec3(0.0, 0.3, -1.0)];
    let side = |x: f32, [a, b]: [Vec3; 2]| {
        let at = |p: Vec3| corner(p, (vec3(0.6 * x, 1.0, 0.0) + 0.5 * p).normalize());
        [at(a), at(vec3(x, -0.3, 0.0)), at(b)]
    };
    mesh([side(1.0, ends), side(-1.0, [ends[1], ends[0]])])
}

/// The number of T-junctions in [`t_junction`]: 3 on a straight edge, and 4 beside edges that follow the sheet's curve.
pub(super) const T_JUNCTIONS: u32 = 7;

/// A curved sheet: one large quad, beside it a column of four small ones, and beside that a column of eight. Three points
/// lie on the large quad's edge, and one beside an edge of each of the four.
pub(super) fn t_junction() -> Mesh {
    let at = |x: f32, z: f32| corner(vec3(x, 0.3 * (1.0 - z * z), z), vec3(0.3 * x, 1.0, 0.6 * z).normalize());
    // The points of the four quads on this edge lie straight, although the sheet is curved there.
    let on_edge = |z: f32| corner(vec3(0.0, 0.0, z), vec3(0.0, 1.0, 0.6 * z).normalize());
    let quad = |a, b, c, d| [[a, b, c], [a, c, d]];
    let mut all = quad(at(-1.0, 1.0), on_edge(1.0), on_edge(-1.0), at(-1.0, -1.0)).to_vec();
    for k in 0..4 {
        let (near, far) = (1.0 - 0.5 * k as f32, 0.5 - 0.5 * k as f32);
        all.extend(quad(on_edge(near), at(1.0, near), at(1.0, far), on_edge(far)));
    }
    for k in 0..8 {
        let (near, far) = (1.0 - 0.25 * k as f32, 0.75 - 0.25 * k as f32);
        all.extend(quad(at(1.0, near), at(1.5, near), at(1.5, far), at(1.0, far)));
    }
    mesh(all)
}

/// A flat star. The normals at its tips lie nearly in its plane and are turned sideways, and those at its notches lean
/// inwards.
pub(super) fn star() -> Mesh {
    let at = |k: usize| {
        let angle = std::f32::consts::TAU * k as f32 / 10.0;
        let (out, sideways) = (vec3(angle.cos(), 0.0, angle.sin()), vec3(-angle.sin(), 0.0, angle.cos()));
        let (radius, lean) = if k.is_multiple_of(2) { (1.0, out * 3.0 + sideways * 1.6) } else { (0.35, out * -3.0) };
        corner(out * radius, (Vec3::Y + lean).normalize())
    };
    let middle = corner(Vec3::ZERO, Vec3::Y);
    mesh((0..10).map(|k| [middle, at((k + 1) % 10), at(k)]))
}

/// A ground of two large triangles, with normals of a surface that rises towards its corners.
pub(super) fn ground() -> Mesh {
    let at = |x: f32, z: f32| corner(vec3(x, 0.0, z) * 10.0, vec3(-0.2 * x, 1.0, -0.2 * z).normalize());
    let [a, b, c, d] = [at(-1.0, 1.0), at(1.0, 1.0), at(1.0, -1.0), at(-1.0, -1.0)];
    mesh([[a, b, c], [a, c, d]])
}

/// Random triangles over a few points, so that edges have many sides of either winding, some triangles are duplicates, and
/// some are degenerate. The normals are random, some of them zero, NaN or long. Each `seed` gives another soup.
pub fn soup(seed: u32) -> Mesh {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9) ^ 0x5bd1_e995);
    let points: Vec<Vec3> = (0..14).map(|_| random.vector()).collect();
    let triangles: Vec<_> =
        (0..60).map(|_| [0; 3].map(|_: i32| corner(points[random.below(14)], random.normal()))).collect();
    mesh(triangles)
}

/// A small generator of random numbers (xorshift, Marsaglia 2003), which gives the same numbers on every machine. It stays the
/// crate's own, because the committed results in `docs/stability` are of meshes made from exactly these numbers.
struct Random(u32);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 = self.0.max(1);
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    fn below(&mut self, count: u32) -> usize {
        (self.next() % count) as usize
    }

    /// Coordinates from -1 to 1.
    fn vector(&mut self) -> Vec3 {
        Vec3::from([0; 3].map(|_: i32| (self.next() >> 8) as f32 / (1 << 23) as f32 - 1.0))
    }

    fn normal(&mut self) -> Vec3 {
        match self.below(12) {
            0 => Vec3::ZERO,
            1 => Vec3::NAN,
            2 => self.vector() * 1e20,
            _ => self.vector(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stability::CASES;
    use geometry::mesh::{NormalFaults, Topology, t_junctions};

    fn made(name: &str) -> Mesh {
        (CASES.iter().find(|case| case.name == name).expect("a case").mesh)()
    }

    fn topology(mesh: &Mesh) -> Topology {
        Topology::build(mesh, &Progress::new()).expect("nobody cancels")
    }

    #[test]
    fn every_mesh_has_its_defect() {
        let fins = fins();
        let fins = topology(&fins);
        assert_eq!(fins.edges.iter().map(|edge| fins.edge_sides(edge).len()).max(), Some(5));
        let reversed = topology(&reversed_neighbours());
        let alike =
            |edge: &&geometry::mesh::Edge| matches!(reversed.edge_sides(edge), [a, b] if a.reversed() == b.reversed());
        assert!(reversed.edges.iter().filter(alike).count() > 20);
        assert!(topology(&duplicates()).degenerate > 10);
        assert!(
            topology(&signed_zeros()).edge_counts().boundary == topology(&Shape::Saddle.build()).edge_counts().boundary
        );
        assert!(topology(&mirrored()).is_closed_and_oriented());
        assert!(topology(&made("far-away")).is_closed_and_oriented());
        assert!(
            made("zero-normals").repairs.normals_replaced > 50 && made("nan-normals").repairs.normals_replaced > 50
        );
        assert!(made("long-normals").repairs.normals_rescaled > 50);
        assert!(denormals().repairs.denormals > 5);
        let seam = near_seam();
        assert!(topology(&seam).edge_counts().boundary > 20);
        assert!(
            Topology::build_within(&seam, 1e-5, &Progress::new()).expect("nobody cancels").is_closed_and_oriented()
        );
    }

    #[test]
    fn each_fault_of_normals_is_counted() {
        let faults = |mesh: &Mesh| NormalFaults::new(mesh, &topology(mesh));
        assert!(faults(&made("opposite-normals")).opposite > 20);
        assert!(faults(&edge_normals()).along_edge > 20);
        assert_eq!(faults(&made("inward-normals")).against_face, 240);
    }

    #[test]
    fn the_t_junctions_are_found_on_and_beside_edges() {
        let found = t_junctions(&topology(&t_junction()), &Progress::new()).expect("nobody cancels");
        assert_eq!(found.len() as u32, T_JUNCTIONS);
        let beside = found.iter().filter(|junction| junction.distance > 0.01).count();
        assert_eq!((beside, found.iter().filter(|junction| junction.distance == 0.0).count()), (4, 3));
    }

    #[test]
    fn a_seed_gives_the_same_soup_and_another_seed_another() {
        assert_eq!(soup(3).triangles, soup(3).triangles);
        assert_ne!(soup(3).corners.len(), 0);
        assert!(soup(3).corners != soup(4).corners);
    }
}
