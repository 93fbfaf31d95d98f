//! Bicubic Bézier patches, and the nearest point of all of them.

use glam::DVec3;

use super::{Nearest, Sample, Surface};
use geometry::mesh::shapes::bicubic::{BezierNet, at};

/// How many times patches are divided into quarters for the tree.
const DEPTH: u32 = 4;
/// How many more times a piece is divided to tell apart points at nearly the same distance. Pieces are then smaller
/// than 1e-7 of the patch.
const MAX_HALVINGS: u32 = 20;

/// Patches, and a tree of their pieces, each with the bounding box of its control points.
pub(super) struct Patches {
    patches: Vec<BezierNet>,
    roots: Vec<Piece>,
    extent: [DVec3; 2],
}

struct Piece {
    min: DVec3,
    max: DVec3,
    inside: Inside,
}

enum Inside {
    Pieces(Box<[Piece; 4]>),
    Net(Box<BezierNet>),
}

impl Piece {
    fn new(net: BezierNet, depth: u32) -> Self {
        let points = net.as_flattened();
        let min = points.iter().fold(DVec3::INFINITY, |min, point| min.min(*point));
        let max = points.iter().fold(DVec3::NEG_INFINITY, |max, point| max.max(*point));
        let inside = match depth {
            0 => Inside::Net(Box::new(net)),
            _ => Inside::Pieces(Box::new(quarters(&net).map(|quarter| Self::new(quarter, depth - 1)))),
        };
        Self { min, max, inside }
    }

    fn distance_squared(&self, p: DVec3) -> f64 {
        p.distance_squared(p.clamp(self.min, self.max))
    }

    /// Searches for a point nearer than `best`.
    fn search(&self, p: DVec3, best: &mut Best) {
        match &self.inside {
            Inside::Net(net) => search(net, p, MAX_HALVINGS, best),
            Inside::Pieces(pieces) => search_all(&pieces[..], p, best),
        }
    }
}

/// Searches the nearest pieces first, so that most others needn't be searched.
fn search_all(pieces: &[Piece], p: DVec3, best: &mut Best) {
    let mut order: Vec<_> = pieces.iter().map(|piece| (piece.distance_squared(p), piece)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (distance_squared, piece) in order {
        if distance_squared < best.distance_squared {
            piece.search(p, best);
        }
    }
}

impl Patches {
    pub(super) fn new(patches: Vec<BezierNet>) -> Self {
        let extent = [DVec3::NEG_ONE, DVec3::ONE].map(|sign| {
            let reach = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| reach(&patches, axis * sign));
            DVec3::from(reach) * sign
        });
        Self { roots: patches.iter().map(|net| Piece::new(*net, DEPTH)).collect(), extent, patches }
    }
}

impl Surface for Patches {
    fn closest(&self, p: DVec3, _: DVec3) -> Nearest {
        let mut best = Best { distance_squared: f64::INFINITY, point: p, across: DVec3::Y };
        search_all(&self.roots, p, &mut best);
        Nearest { point: best.point, normal: best.across.normalize(), distance: best.distance_squared.sqrt() }
    }

    fn extent(&self) -> [DVec3; 2] {
        self.extent
    }

    fn charts(&self) -> usize {
        self.patches.len()
    }

    fn at(&self, chart: usize, s: f64, t: f64) -> (Sample, f64) {
        let [point, along_u, along_v] = at(&self.patches[chart], s, t);
        let across = along_u.cross(along_v);
        (Sample { point, normal: across.normalize() }, across.length())
    }

    /// The control points of a derivative are differences of a patch's (Farin, "Curves and surfaces for CAGD", section 14.6),
    /// and it lies within their hull.
    fn bends(&self, chart: usize) -> [f64; 3] {
        let net = &self.patches[chart];
        let twice = |net: &BezierNet| {
            let second = |column: &[DVec3; 4], i: usize| (column[i + 2] - 2.0 * column[i + 1] + column[i]).length();
            net.iter().flat_map(|column| [second(column, 0), second(column, 1)]).fold(0.0, f64::max)
        };
        let twist = |i: usize, j: usize| (net[i + 1][j + 1] - net[i + 1][j] - net[i][j + 1] + net[i][j]).length();
        let mixed = (0..9).map(|k| twist(k / 3, k % 3)).fold(0.0, f64::max);
        [6.0 * twice(&transposed(net)), 9.0 * mixed, 6.0 * twice(net)]
    }
}

/// The nearest point found so far.
struct Best {
    distance_squared: f64,
    point: DVec3,
    /// The normal, of any length.
    across: DVec3,
}

/// Searches a piece. The squared distance is a polynomial, which is at least the least of its control values. Where
/// these prove that it is convex, Newton's method finds its only minimum. Elsewhere the piece is divided into quarters.
fn search(net: &BezierNet, p: DVec3, halvings: u32, best: &mut Best) {
    let squared = squared_distance(net, p);
    let least = squared.as_flattened().iter().copied().fold(f64::INFINITY, f64::min);
    // A point that is nearer by no more than a rounding error doesn't matter.
    let size = squared.as_flattened().iter().copied().fold(0.0, f64::max);
    if least >= best.distance_squared - 1e-15 * size {
        return;
    }
    descend(net, p, best);
    if halvings > 0 && !is_convex(&squared) {
        quarters(net).iter().for_each(|quarter| search(quarter, p, halvings - 1, best));
    }
}

/// Returns the control values of the squared distance from p, a polynomial of degree 6 in each parameter.
fn squared_distance(net: &BezierNet, p: DVec3) -> [[f64; 7]; 7] {
    const CUBIC: [f64; 4] = [1.0, 3.0, 3.0, 1.0];
    const SEXTIC: [f64; 7] = [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0];
    let mut out = [[0.0; 7]; 7];
    let from_p = net.map(|column| column.map(|point| point - p));
    for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let scaled = from_p[i][j] * (CUBIC[i] * CUBIC[j]);
        for (k, l) in (0..4).flat_map(|k| (0..4).map(move |l| (k, l))) {
            out[i + k][j + l] += scaled.dot(from_p[k][l]) * (CUBIC[k] * CUBIC[l]);
        }
    }
    for (a, column) in out.iter_mut().enumerate() {
        column.iter_mut().enumerate().for_each(|(b, value)| *value /= SEXTIC[a] * SEXTIC[b]);
    }
    out
}

/// Returns whether control values prove that a polynomial of degree 6 in each parameter is convex: its second
/// derivatives lie between the least and the greatest of their own control values.
fn is_convex(values: &[[f64; 7]; 7]) -> bool {
    let (mut uu, mut vv, mut uv) = (f64::INFINITY, f64::INFINITY, 0.0_f64);
    for a in 0..7 {
        for b in 0..7 {
            if a < 5 {
                uu = uu.min(values[a + 2][b] - 2.0 * values[a + 1][b] + values[a][b]);
            }
            if b < 5 {
                vv = vv.min(values[a][b + 2] - 2.0 * values[a][b + 1] + values[a][b]);
            }
            if a < 6 && b < 6 {
                uv = uv.max((values[a + 1][b + 1] - values[a + 1][b] - values[a][b + 1] + values[a][b]).abs());
            }
        }
    }
    uu > 0.0 && vv > 0.0 && 30.0 * 30.0 * uu * vv > 36.0 * 36.0 * uv * uv
}

/// Finds the nearest point of a piece by Newton's method from its middle. Steps stay in the piece and go downhill.
fn descend(net: &BezierNet, p: DVec3, best: &mut Best) {
    let [mut u, mut v] = [0.5, 0.5];
    let mut here = at(net, u, v);
    for _ in 0..50 {
        let [du, dv] = newton_step(net, here, here[0] - p, [u, v]);
        let mut length = 1.0;
        let (next, to) = loop {
            let to = [u + length * du, v + length * dv].map(|x| x.clamp(0.0, 1.0));
            let next = at(net, to[0], to[1]);
            // Small steps are taken in any case, since rounding may hide that they go downhill.
            let is_small = du.abs().max(dv.abs()) < 1e-5;
            if is_small || next[0].distance_squared(p) <= here[0].distance_squared(p) || length < 1e-4 {
                break (next, to);
            }
            length /= 2.0;
        };
        let moved = (to[0] - u).abs().max((to[1] - v).abs());
        if length < 1e-4 || moved == 0.0 {
            break;
        }
        ([u, v], here) = (to, next);
        if moved < 1e-13 {
            break;
        }
    }
    let [point, along_u, along_v] = here;
    let distance_squared = point.distance_squared(p);
    if distance_squared < best.distance_squared {
        *best = Best { distance_squared, point, across: along_u.cross(along_v) };
    }
}

/// Returns the step to where the gradient of half the squared distance is zero. Parameters that the gradient pushes out
/// of the piece stay. Where Newton's step wouldn't lead to a minimum, it is the Gauss-Newton step.
fn newton_step(net: &BezierNet, [_, along_u, along_v]: [DVec3; 3], from_p: DVec3, [u, v]: [f64; 2]) -> [f64; 2] {
    let gradient = [from_p.dot(along_u), from_p.dot(along_v)];
    let is_free = |x: f64, slope: f64| !(x <= 0.0 && slope > 0.0 || x >= 1.0 && slope < 0.0);
    let [uu, uv, vv] = second_derivatives(net, u, v);
    let metric = [along_u.length_squared(), along_u.dot(along_v), along_v.length_squared()];
    let hessian = [metric[0] + from_p.dot(uu), metric[1] + from_p.dot(uv), metric[2] + from_p.dot(vv)];
    match [is_free(u, gradient[0]), is_free(v, gradient[1])] {
        [false, false] => [0.0, 0.0],
        [true, false] => [-gradient[0] / if hessian[0] > 0.0 { hessian[0] } else { metric[0] }, 0.0],
        [false, true] => [0.0, -gradient[1] / if hessian[2] > 0.0 { hessian[2] } else { metric[2] }],
        [true, true] => {
            let determinant = |[a, b, c]: [f64; 3]| a * c - b * b;
            let is_minimum = hessian[0] > 0.0 && determinant(hessian) > 0.0;
            let [a, b, c] = if is_minimum { hessian } else { metric };
            let determinant = determinant([a, b, c]);
            [(b * gradient[1] - c * gradient[0]) / determinant, (b * gradient[0] - a * gradient[1]) / determinant]
        }
    }
}

/// Returns the second derivatives by u twice, by u and v, and by v twice.
fn second_derivatives(net: &BezierNet, u: f64, v: f64) -> [DVec3; 3] {
    use geometry::mesh::shapes::bicubic::{slopes, weights};
    let bends = |t: f64| [6.0 * (1.0 - t), 6.0 * (3.0 * t - 2.0), 6.0 * (1.0 - 3.0 * t), 6.0 * t];
    let sum = |by_u: [f64; 4], by_v: [f64; 4]| -> DVec3 {
        (0..4).map(|i| by_u[i] * (0..4).map(|j| by_v[j] * net[i][j]).sum::<DVec3>()).sum()
    };
    [sum(bends(u), weights(v)), sum(slopes(u), slopes(v)), sum(weights(u), bends(v))]
}

/// Returns both halves of a cubic curve (de Casteljau).
fn halves([a, b, c, d]: [DVec3; 4]) -> [[DVec3; 4]; 2] {
    let [ab, bc, cd] = [(a + b) / 2.0, (b + c) / 2.0, (c + d) / 2.0];
    let [abc, bcd] = [(ab + bc) / 2.0, (bc + cd) / 2.0];
    let middle = (abc + bcd) / 2.0;
    [[a, ab, abc, middle], [middle, bcd, cd, d]]
}

/// Exchanges the two parameters.
fn transposed(net: &BezierNet) -> BezierNet {
    std::array::from_fn(|i| std::array::from_fn(|j| net[j][i]))
}

/// Returns the four quarters of a patch.
fn quarters(net: &BezierNet) -> [BezierNet; 4] {
    let along = |net: &BezierNet| {
        let columns = net.map(halves);
        [0, 1].map(|half| columns.map(|column| column[half]))
    };
    let [below, above] = along(net);
    let [a, b] = along(&transposed(&below));
    let [c, d] = along(&transposed(&above));
    [a, b, c, d].map(|net| transposed(&net))
}

/// Returns the largest coordinate of the patches in a direction.
fn reach(patches: &[BezierNet], direction: DVec3) -> f64 {
    let along = |point: DVec3| point.dot(direction);
    let mut open = patches.to_vec();
    let mut best = f64::NEG_INFINITY;
    while let Some(net) = open.pop() {
        let corners = [net[0][0], net[0][3], net[3][0], net[3][3]].map(along);
        best = corners.into_iter().fold(best, f64::max);
        let bound = net.as_flattened().iter().copied().map(along).fold(f64::NEG_INFINITY, f64::max);
        if bound > best + 1e-9 {
            open.extend(quarters(&net));
        }
    }
    best
}
