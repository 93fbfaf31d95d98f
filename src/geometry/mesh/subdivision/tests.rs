//! Refined cages, against the published rules and closed forms.

mod butterfly;
mod face_varying;
mod limits;
mod odd_cages;
mod refinement;
mod rules;

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, Vec3};

use super::*;

const MANY: u64 = 1 << 24;

/// A cage with its positions.
#[derive(Clone, Default)]
struct Shape {
    positions: Vec<DVec3>,
    starts: Vec<u32>,
    corners: Vec<u32>,
    creases: Vec<([u32; 2], f32)>,
    sharp_points: Vec<(u32, f32)>,
    scheme: Scheme,
    boundary: Boundary,
}

impl Shape {
    fn new(positions: Vec<DVec3>, faces: &[&[u32]]) -> Self {
        let mut starts = vec![0];
        faces.iter().for_each(|face| starts.push(starts[starts.len() - 1] + to_u32(face.len())));
        Self { positions, starts, corners: faces.concat(), ..Self::default() }
    }

    fn cage(&self) -> Cage<'_> {
        Cage {
            points: self.positions.len(),
            starts: &self.starts,
            corners: &self.corners,
            scheme: self.scheme,
            boundary: self.boundary,
            creases: &self.creases,
            sharp_points: &self.sharp_points,
            holes: &[],
        }
    }

    fn refined(&self, levels: u8) -> (Refinement, Vec<DVec3>) {
        let refinement = Refinement::new(&self.cage(), levels, MANY).unwrap();
        let positions = refinement.refine(&self.positions);
        (refinement, positions)
    }

    /// The edges, by their two points.
    fn edges(&self) -> Vec<[u32; 2]> {
        let faces = self.starts.array_windows().map(|&[start, end]| &self.corners[start as usize..end as usize]);
        let sides = faces.flat_map(|face| (0..face.len()).map(|k| [face[k], face[(k + 1) % face.len()]]));
        let mut edges: Vec<_> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    fn creased(self, sharpness: f32) -> Self {
        let creases = self.edges().into_iter().map(|edge| (edge, sharpness)).collect();
        Self { creases, ..self }
    }

    fn shaken(mut self, random: &mut fastrand::Rng) -> Self {
        let mut some = || random.f64() - 0.5;
        self.positions.iter_mut().for_each(|position| *position += 0.4 * DVec3::new(some(), some(), some()));
        self
    }
}

fn cube() -> Shape {
    let sign = |k: usize, bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
    let positions = (0..8).map(|k| DVec3::new(sign(k, 0), sign(k, 1), sign(k, 2))).collect();
    let faces: [&[u32]; 6] = [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    Shape::new(positions, &faces)
}

/// Two poles, 0 and 1, that so many quadrilaterals or triangles meet at.
fn poles(edges: u32, scheme: Scheme) -> Shape {
    let rim = if scheme == Scheme::CatmullClark { 2 * edges } else { edges };
    let at = |k: u32| DVec2::from_angle(TAU * f64::from(k) / f64::from(rim)).extend(0.2 * f64::from(k % 2));
    let positions = [DVec3::Z, -DVec3::Z].into_iter().chain((0..rim).map(at)).collect();
    let faces: Vec<Vec<u32>> = (0..edges)
        .flat_map(|i| match scheme {
            Scheme::Loop | Scheme::Butterfly => [vec![0, 2 + i, 2 + (i + 1) % rim], vec![1, 2 + (i + 1) % rim, 2 + i]],
            Scheme::CatmullClark => {
                let [a, b, c, d] = [0, 1, 2, 3].map(|k| 2 + (2 * i + k) % rim);
                [vec![0, a, b, c], vec![1, d, c, b]]
            }
        })
        .collect();
    let faces: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
    Shape { scheme, ..Shape::new(positions, &faces) }
}

/// So many faces around point 0, which is on the boundary.
fn fan(faces: u32, scheme: Scheme) -> Shape {
    let rim = if scheme == Scheme::CatmullClark { 2 * faces } else { faces };
    let at = |k: u32| DVec2::from_angle(PI * f64::from(k) / f64::from(rim)).extend(0.0);
    let positions = [DVec3::ZERO].into_iter().chain((0..=rim).map(at)).collect();
    let faces: Vec<Vec<u32>> = (0..faces)
        .map(|i| match scheme {
            Scheme::Loop | Scheme::Butterfly => vec![0, 1 + i, 2 + i],
            Scheme::CatmullClark => vec![0, 1 + 2 * i, 2 + 2 * i, 3 + 2 * i],
        })
        .collect();
    let faces: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
    Shape { scheme, ..Shape::new(positions, &faces) }
}

/// A square of so many quadrilaterals along each side, over whole numbers.
fn grid(size: u32) -> Shape {
    let positions = (0..=size).flat_map(|y| (0..=size).map(move |x| DVec3::new(x.into(), y.into(), 0.0))).collect();
    let at = |x: u32, y: u32| y * (size + 1) + x;
    let faces: Vec<[u32; 4]> = (0..size)
        .flat_map(|y| (0..size).map(move |x| [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]))
        .collect();
    let faces: Vec<&[u32]> = faces.iter().map(<[u32; 4]>::as_slice).collect();
    Shape::new(positions, &faces)
}

/// The same of triangles, which a diagonal cuts all squares into.
fn triangle_grid(size: u32) -> Shape {
    let square = grid(size);
    let halves = |&[a, b, c, d]: &[u32; 4]| [[a, b, c], [a, c, d]];
    let faces: Vec<[u32; 3]> = square.corners.as_chunks().0.iter().flat_map(halves).collect();
    let faces: Vec<&[u32]> = faces.iter().map(<[u32; 3]>::as_slice).collect();
    Shape { scheme: Scheme::Butterfly, ..Shape::new(square.positions, &faces) }
}

/// Shapes with boundaries, creases, darts and corners of every sharpness, in all schemes.
fn varied() -> Vec<Shape> {
    let mut random = fastrand::Rng::with_seed(7);
    let mut shapes = vec![cube(), grid(4), poles(5, Scheme::CatmullClark), poles(7, Scheme::Loop)];
    shapes.extend([fan(3, Scheme::CatmullClark), fan(5, Scheme::Loop)]);
    shapes.extend([poles(7, Scheme::Butterfly), triangle_grid(3)]);
    for k in 0..24 {
        let mut shape = shapes[k % 8].clone().shaken(&mut random);
        let mut sharpness = || random.f32() * 4.0;
        shape.creases = shape.edges().into_iter().step_by(2 + k / 6).map(|edge| (edge, sharpness())).collect();
        shape.sharp_points = (0..to_u32(shape.positions.len())).step_by(5).map(|point| (point, sharpness())).collect();
        shape.boundary = [Boundary::Edges, Boundary::EdgesAndCorners][k % 2];
        shapes.push(shape);
    }
    shapes
}

fn assert_near(a: DVec3, b: DVec3) {
    assert!((a - b).abs().max_element() < 1e-12, "{a} is not {b}");
}

/// The point that a level makes of an edge.
fn middle(shape: &Shape, refined: &[DVec3], edge: [u32; 2]) -> DVec3 {
    refined[shape.positions.len() + shape.edges().iter().position(|other| *other == edge).unwrap()]
}
