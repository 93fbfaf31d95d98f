//! How far what a driver's tessellation stages made is from what our passes made.

use std::collections::{BTreeMap, BTreeSet};

use super::stages::CapturedCorner;

/// What our passes made of the same patches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ours<'a> {
    /// For every vertex its patch, and the weights of corners 0 and 1 in 16.16 fixed point.
    pub keys: &'a [(u32, u32, u32)],
    pub positions: &'a [[f32; 3]],
    /// Unit vectors.
    pub normals: &'a [[f32; 3]],
    pub triangles: &'a [[u32; 3]],
    /// For every patch the factors of its edges, and the one inside; zeros if it is left out.
    pub factors: &'a [[f32; 4]],
}

/// What differs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Agreement {
    /// The number of triangles that the stages made.
    pub triangles: usize,
    /// The largest difference of a factor, as a part of ours.
    pub factors: f64,
    /// Triangles that only the stages or only ours have.
    pub other_triangles: usize,
    /// The largest difference of a coordinate at the same domain point, in ULP of the largest coordinate.
    pub position_ulps: f64,
    /// The largest distance between unit normals at the same domain point.
    pub normals: f64,
    /// Points on shared edges whose sides have different bits.
    pub torn: usize,
    /// Points on edges that several sides have.
    pub shared: usize,
}

/// A domain point: its patch, and the weights of corners 0 and 1.
type Key = (u32, u32, u32);

/// Makes the weights of corners 0 and 1 of the tessellator's U and V, as a convention says.
pub(crate) type Weights<'a> = &'a dyn Fn([u32; 2]) -> [u32; 2];

/// A point on an edge: the bits of the edge's ends, and the place between them. At an end, that is the edge's only one: all edges
/// share it that meet there.
type EdgePoint = ([u32; 3], [u32; 3], u32);

/// The patches that have a point, and the bits that they give it.
type Sharers = (BTreeSet<u32>, BTreeSet<[u32; 3]>);

const ONE: u32 = 0x10000;

/// A captured corner's domain point. `weights` makes the weights of corners 0 and 1 of U and V.
fn key(corner: &CapturedCorner, weights: Weights) -> Key {
    let [u, v, _, patch] = corner.place;
    let u = (u * 65536.0).round() as u32;
    let v = ((v * 65536.0).round() as u32).min(ONE - u);
    let [u, v] = weights([u, v]);
    (patch as u32, u, v)
}

/// The same triangle, beginning with its least corner.
fn turned(mut triangle: [Key; 3]) -> [Key; 3] {
    let least = (0..3).min_by_key(|&k| triangle[k]).unwrap_or(0);
    triangle.rotate_left(least);
    triangle
}

/// How far two numbers are apart: infinitely if one isn't a number.
fn apart(x: f32, y: f32) -> f64 {
    let own = f64::from((x - y).abs());
    if own.is_nan() { f64::INFINITY } else { own }
}

/// Compares. `patch_corners` are the positions of every patch's corners, and `weights` as the domain shader's convention says.
pub(crate) fn compare(
    captured: &[[CapturedCorner; 3]],
    ours: &Ours,
    patch_corners: &[[[f32; 3]; 3]],
    weights: Weights,
) -> Agreement {
    let theirs: BTreeSet<_> = captured.iter().map(|own| turned([0, 1, 2].map(|k| key(&own[k], weights)))).collect();
    let own: BTreeSet<_> =
        ours.triangles.iter().map(|own| turned(own.map(|vertex| ours.keys[vertex as usize]))).collect();
    let own_points = ours.positions.iter().copied().zip(ours.normals.iter().copied());
    let at: BTreeMap<Key, ([f32; 3], [f32; 3])> = ours.keys.iter().copied().zip(own_points).collect();
    let largest = ours.positions.iter().flatten().fold(0.0f32, |most, x| most.max(x.abs()));
    let ulp = f64::from(largest.next_up() - largest);
    let mut made = Agreement {
        triangles: captured.len(),
        other_triangles: theirs.symmetric_difference(&own).count() + (captured.len() - theirs.len()),
        ..Agreement::default()
    };
    let mut seen = BTreeSet::new();
    for corner in captured.iter().flatten() {
        let key = key(corner, weights);
        let written = ours.factors[key.0 as usize];
        seen.insert(key.0);
        for (x, y) in corner.factors.into_iter().zip(written) {
            made.factors = made.factors.max(apart(x, y) / f64::from(y.abs().max(1.0)));
        }
        let Some((position, normal)) = at.get(&key) else { continue };
        for (x, y) in corner.position.iter().zip(position) {
            made.position_ulps = made.position_ulps.max(apart(*x, *y) / ulp);
        }
        let squares = corner.normal.iter().zip(normal).map(|(x, y)| apart(*x, *y).powi(2));
        made.normals = made.normals.max(squares.sum::<f64>().sqrt());
    }
    // A patch of which nothing came out was left out.
    let drawn = |factors: &[f32; 4]| factors[..3].iter().all(|&factor| factor > 0.0);
    let left_out = (0..).zip(ours.factors).filter(|(patch, own)| drawn(own) != seen.contains(patch)).count();
    made.other_triangles += left_out;
    (made.shared, made.torn) = shared_points(captured, patch_corners, weights);
    made
}

/// Counts the points on edges that several sides have, and those of them whose bits differ.
pub(crate) fn shared_points(
    captured: &[[CapturedCorner; 3]],
    patch_corners: &[[[f32; 3]; 3]],
    weights: Weights,
) -> (usize, usize) {
    let bits = |place: [f32; 3]| place.map(|x| (x + 0.0).to_bits());
    let mut points: BTreeMap<EdgePoint, Sharers> = BTreeMap::new();
    for corner in captured.iter().flatten() {
        let (patch, u, v) = key(corner, weights);
        let w = ONE - u - v;
        let (side, t) = match [w, u, v].iter().position(|&weight| weight == 0) {
            Some(0) => (0, v),
            Some(1) => (1, w),
            Some(_) => (2, u),
            None => continue,
        };
        let corners = patch_corners[patch as usize];
        let (start, end) = (bits(corners[side]), bits(corners[(side + 1) % 3]));
        let place = match t {
            0 => (start, start, 0),
            ONE => (end, end, 0),
            _ if start < end => (start, end, t),
            _ => (end, start, ONE - t),
        };
        let [x, y, z, _] = corner.position;
        let (patches, positions) = points.entry(place).or_default();
        patches.insert(patch);
        positions.insert(bits([x, y, z]));
    }
    let shared = points.values().filter(|(patches, _)| patches.len() > 1);
    let torn = shared.clone().filter(|(_, positions)| positions.len() > 1).count();
    (shared.count(), torn)
}
