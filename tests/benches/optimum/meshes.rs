//! Meshes of many kinds: organic and hard surfaces, with patches of all sizes.

use std::f32::consts::TAU;
use std::path::PathBuf;
use std::sync::Arc;

use geometry::mesh::mesh_builder::MeshBuilder;
use geometry::mesh::shapes::Shape;
use geometry::mesh::{Corner, Material, Mesh};
use geometry::progress::Progress;
use glam::{Vec2, Vec3, vec3};
use load::files::Limits;
use load::source::Source;

/// All shapes, the meshes of this file, and those of mesh files. A file that can't be read is named on stderr and left out.
pub(crate) fn with_files(files: &[PathBuf]) -> Vec<(String, Arc<Mesh>)> {
    let shapes = Shape::ALL.into_iter().map(|shape| (shape.name().to_owned(), shape.build()));
    let mut all: Vec<_> = shapes.chain(made()).collect();
    for file in files {
        match Source::File(file.clone()).load(&Limits::default(), &Progress::new()) {
            Ok(loaded) => all.push((file.file_name().unwrap_or_default().to_string_lossy().into_owned(), loaded.mesh)),
            Err(error) => eprintln!("{}: {error}", file.display()),
        }
    }
    all.into_iter().map(|(name, mesh)| (name, Arc::new(mesh))).collect()
}

fn made() -> Vec<(String, Mesh)> {
    vec![
        ("head".to_owned(), sheet([28, 22], true, head)),
        ("blob of few patches".to_owned(), sheet([6, 4], true, blob)),
        ("knot".to_owned(), sheet([72, 8], false, knot)),
        ("terrain".to_owned(), sheet([20, 20], false, terrain)),
        ("gear".to_owned(), gear(14)),
        ("engine".to_owned(), engine()),
        ("shell".to_owned(), sheet([40, 10], false, shell)),
    ]
}

/// A mesh of `columns` by `rows` quads over a surface of two parameters from 0 to 1, with its own smooth normals. At poles quads
/// are triangles.
fn sheet([columns, rows]: [u16; 2], poles: bool, surface: impl Fn(f32, f32) -> Vec3) -> Mesh {
    let mut builder = MeshBuilder::new();
    let material = builder.material(Material::plain("clay", [0.7, 0.6, 0.5, 1.0]));
    let corner = |i: u16, j: u16| {
        let (u, v) = (f32::from(i) / f32::from(columns), f32::from(j) / f32::from(rows));
        // Beside a pole the normal is that of a place close to it.
        let at = if poles { v.clamp(0.004, 0.996) } else { v };
        let step = 1e-3;
        let along = surface(u + step, at) - surface(u - step, at);
        let up = surface(u, at + step) - surface(u, at - step);
        Corner { position: surface(u, v), normal: along.cross(up).normalize_or(Vec3::Y), uv: Vec2::new(u, v) }
    };
    for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
        let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(i, j));
        if !(poles && j == 0) {
            builder.triangle(material, [a, b, c].map(Into::into));
        }
        if !(poles && j + 1 == rows) {
            builder.triangle(material, [a, c, d].map(Into::into));
        }
    }
    finish(builder)
}

fn finish(builder: MeshBuilder) -> Mesh {
    // Nobody else holds this handle, so nobody can cancel.
    builder.finish("made".to_owned(), &Progress::new()).unwrap_or_default()
}

fn around(u: f32, v: f32) -> Vec3 {
    let ((sin, cos), (up_sin, up_cos)) = ((TAU * u).sin_cos(), (TAU * 0.5 * v).sin_cos());
    vec3(sin * up_sin, -up_cos, cos * up_sin)
}

/// A skull with brows, nose, eye sockets and a chin.
fn head(u: f32, v: f32) -> Vec3 {
    let out = around(u, v);
    let bump = |x: f32, y: f32, z: f32, size: f32, height: f32| {
        height * (-(out.distance(vec3(x, y, z).normalize()) / size).powi(2)).exp()
    };
    let face = bump(0.0, 0.0, 1.0, 0.18, 0.22) + bump(0.0, -0.75, 0.8, 0.3, 0.12) + bump(0.0, 0.35, 1.0, 0.35, 0.06);
    let eyes = bump(0.35, 0.15, 0.95, 0.16, 0.1) + bump(-0.35, 0.15, 0.95, 0.16, 0.1);
    out * (1.0 + face - eyes) * vec3(0.8, 1.1, 0.95)
}

fn blob(u: f32, v: f32) -> Vec3 {
    let out = around(u, v);
    out * (1.0 + 0.25 * (3.0 * out.x).sin() * (2.0 * out.y + 1.0).cos())
}

fn knot(u: f32, v: f32) -> Vec3 {
    let center = |t: f32| {
        let r = 1.0 + 0.45 * (3.0 * TAU * t).cos();
        vec3(r * (2.0 * TAU * t).cos(), 0.45 * (3.0 * TAU * t).sin(), r * (2.0 * TAU * t).sin())
    };
    let along = (center(u + 1e-3) - center(u - 1e-3)).normalize();
    let side = along.cross(center(u)).normalize();
    let (sin, cos) = (TAU * v).sin_cos();
    center(u) + (side * cos + along.cross(side) * -sin) * 0.22
}

fn terrain(u: f32, v: f32) -> Vec3 {
    // Cells get smaller towards one corner.
    let (x, z) = (2.0 * u * u - 1.0, 2.0 * v - 1.0);
    let height = 0.2 * (3.0 * x + 1.0).sin() * (2.5 * z).cos() + 0.06 * (9.0 * x * z + 4.0 * z).sin();
    vec3(x, height, -z)
}

fn shell(u: f32, v: f32) -> Vec3 {
    let turn = 2.5 * TAU * u;
    let growth = (1.6 * u).exp() * 0.25;
    let (sin, cos) = (TAU * v).sin_cos();
    let out = vec3(turn.cos(), 0.0, turn.sin());
    out * growth * (1.0 + 0.5 * cos) + Vec3::Y * (growth * 0.5 * sin - 0.8 * growth)
}

/// Flat triangles and quads with a normal for each face.
struct Faces(MeshBuilder);

impl Faces {
    fn new() -> Self {
        Self(MeshBuilder::new())
    }

    fn quad(&mut self, corners: [Vec3; 4], normals: Option<[Vec3; 4]>) {
        let material = self.0.material(Material::plain("steel", [0.5, 0.5, 0.55, 1.0]));
        let [a, b, c, _] = corners;
        let flat = (b - a).cross(c - a).normalize_or(Vec3::Y);
        let normals = normals.unwrap_or([flat; 4]);
        let at = |k: usize| Corner { position: corners[k], normal: normals[k], uv: Vec2::ZERO };
        for triangle in [[0, 1, 2], [0, 2, 3]] {
            self.0.triangle(material, triangle.map(|k| at(k).into()));
        }
    }

    /// A smooth tube of `segments` around an axis, from one end to the other, with these radii.
    fn tube(&mut self, from: Vec3, to: Vec3, radii: [f32; 2], segments: u16) {
        let axis = (to - from).normalize();
        let side = axis.any_orthonormal_vector();
        let out = |i: u16| {
            let (sin, cos) = (TAU * f32::from(i) / f32::from(segments)).sin_cos();
            side * cos + axis.cross(side) * sin
        };
        for i in 0..segments {
            let (p, q) = (out(i), out(i + 1));
            let corners = [from + p * radii[0], from + q * radii[0], to + q * radii[1], to + p * radii[1]];
            self.quad(corners, Some([p, q, q, p]));
            self.quad([from, from + q * radii[0], from + p * radii[0], from], None);
            self.quad([to, to + p * radii[1], to + q * radii[1], to], None);
        }
    }
}

/// Teeth with flat faces around a smooth rim.
fn gear(teeth: u16) -> Mesh {
    let mut faces = Faces::new();
    let at = |angle: f32, radius: f32, y: f32| vec3(angle.cos() * radius, y, angle.sin() * radius);
    for i in 0..teeth {
        let angle = |k: f32| TAU * (f32::from(i) + k) / f32::from(teeth);
        let outline = [(0.0, 0.8), (0.1, 1.0), (0.4, 1.0), (0.5, 0.8), (1.0, 0.8)];
        for pair in outline.windows(2) {
            let ((a, r), (b, s)) = (pair[0], pair[1]);
            let [low, high] = [-0.15, 0.15];
            let side = [at(angle(a), r, low), at(angle(a), r, high), at(angle(b), s, high), at(angle(b), s, low)];
            let smooth = (r == s).then(|| [angle(a), angle(a), angle(b), angle(b)].map(|angle| at(angle, 1.0, 0.0)));
            faces.quad(side, smooth);
            faces.quad(
                [at(angle(a), 0.3, high), at(angle(b), 0.3, high), at(angle(b), s, high), at(angle(a), r, high)],
                None,
            );
            faces.quad(
                [at(angle(b), 0.3, low), at(angle(a), 0.3, low), at(angle(a), r, low), at(angle(b), s, low)],
                None,
            );
        }
        let inner = [
            at(angle(0.0), 0.3, 0.15),
            at(angle(0.0), 0.3, -0.15),
            at(angle(1.0), 0.3, -0.15),
            at(angle(1.0), 0.3, 0.15),
        ];
        faces.quad(inner, Some([angle(0.0), angle(0.0), angle(1.0), angle(1.0)].map(|angle| -at(angle, 1.0, 0.0))));
    }
    finish(faces.0)
}

/// A block with cylinders, pipes and bolts: large and small patches beside each other.
fn engine() -> Mesh {
    let mut faces = Faces::new();
    let mut cuboid = |low: Vec3, high: Vec3| {
        let at = |x: bool, y: bool, z: bool| {
            vec3(if x { high.x } else { low.x }, if y { high.y } else { low.y }, if z { high.z } else { low.z })
        };
        let (f, t) = (false, true);
        for [a, b, c, d] in [
            [at(f, f, t), at(t, f, t), at(t, t, t), at(f, t, t)],
            [at(t, f, f), at(f, f, f), at(f, t, f), at(t, t, f)],
            [at(f, t, t), at(t, t, t), at(t, t, f), at(f, t, f)],
            [at(f, f, f), at(t, f, f), at(t, f, t), at(f, f, t)],
            [at(t, f, t), at(t, f, f), at(t, t, f), at(t, t, t)],
            [at(f, f, f), at(f, f, t), at(f, t, t), at(f, t, f)],
        ] {
            faces.quad([a, b, c, d], None);
        }
    };
    cuboid(vec3(-1.0, -0.5, -0.4), vec3(1.0, 0.3, 0.4));
    cuboid(vec3(-0.9, 0.3, -0.3), vec3(0.9, 0.4, 0.3));
    for i in 0..4u8 {
        let x = -0.7 + 0.45 * f32::from(i);
        faces.tube(vec3(x, 0.4, 0.0), vec3(x, 0.9, 0.0), [0.18, 0.18], 16);
        faces.tube(vec3(x, 0.1, 0.4), vec3(x, -0.1, 0.8), [0.08, 0.11], 8);
        faces.tube(vec3(x + 0.2, 0.4, 0.22), vec3(x + 0.2, 0.44, 0.22), [0.03, 0.03], 6);
    }
    faces.tube(vec3(-1.0, -0.2, 0.0), vec3(-1.3, -0.2, 0.0), [0.3, 0.3], 24);
    faces.tube(vec3(1.0, -0.2, 0.0), vec3(1.15, -0.2, 0.0), [0.35, 0.2], 12);
    finish(faces.0)
}
