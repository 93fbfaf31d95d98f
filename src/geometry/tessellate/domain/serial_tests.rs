//! A serial tessellator for tests: it follows the specification point by point and triangle by triangle, and is what
//! the closed forms are compared with. It shares only the factors' words with them.

use crate::tessellate::factors::{FACTOR_ODD, PatchFactors};

const ONE: u32 = 65536;
const HALF: u32 = 32768;

/// A patch's points and triangles, in order.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Patch {
    pub points: Vec<[u32; 2]>,
    pub triangles: Vec<[u32; 3]>,
}

/// Tessellates a patch.
pub(super) fn patch(factors: PatchFactors) -> Patch {
    if factors == PatchFactors::default() {
        return Patch::default();
    }
    if factors.outside == [FACTOR_ODD | ONE; 3] && factors.inside & !FACTOR_ODD == ONE {
        return Patch { points: vec![[0, ONE], [0, 0], [ONE, 0]], triangles: vec![[0, 1, 2]] };
    }
    let mut points = outline(factors);
    let outline_length = points.len();
    rings(&row(factors.inside, true), is_odd(factors.inside), &mut points);
    Patch { triangles: triangles(factors, outline_length), points }
}

fn is_odd(word: u32) -> bool {
    word & FACTOR_ODD != 0
}

/// The fixed-point number of segments of half a row.
fn half(word: u32) -> u32 {
    let h = ((word & !FACTOR_ODD) + 1) >> 1;
    if is_odd(word) || h == HALF { h + HALF } else { h }
}

fn half_rounded_up(word: u32) -> u32 {
    half(word).div_ceil(ONE)
}

/// Where a row's points lie.
pub(super) fn row(word: u32, inside: bool) -> Vec<u32> {
    let odd = is_odd(word);
    let h = half_rounded_up(word);
    let (n, fewest) = if odd { (2 * h, 4) } else { (2 * h + 1, 3) };
    (0..if inside { n.max(fewest) } else { n }).map(|p| location(word, p)).collect()
}

fn location(word: u32, p: u32) -> u32 {
    let odd = u32::from(is_odd(word));
    let (floor, fraction) = (half(word) >> 16, half(word) & 0xffff);
    let h = half_rounded_up(word);
    if p == h && odd == 0 {
        return HALF;
    }
    let reciprocal = |k: u32| (131072 + k) / (2 * k);
    let without_top_bit = |v: u32| (0..32).rev().map(|b| 1 << b).find(|b| v >= *b).map_or(0, |b| v - b);
    let split = match (fraction, odd, floor) {
        (0, _, _) => u32::MAX,
        (_, 1, 1) => 0,
        (_, 1, _) => 2 * without_top_bit(floor - 1) + 1,
        _ => 2 * without_top_bit(floor) + 1,
    };
    let at = if p >= h { 2 * h - odd - p } else { p };
    let coarse = if at > split { at - 1 } else { at };
    let (rf, rc) = (reciprocal(2 * floor - odd), reciprocal(2 * h - odd));
    let x =
        (u64::from(coarse * rf) * u64::from(ONE - fraction) + u64::from(at * rc) * u64::from(fraction) + 32768) >> 16;
    let x = u32::try_from(x).expect("within 0..=1");
    if p >= h { ONE - x } else { x }
}

fn outline(factors: PatchFactors) -> Vec<[u32; 2]> {
    let [mut x0, x1, mut x2] = factors.outside.map(|word| row(word, false));
    x0.reverse();
    x2.reverse();
    let without_last = |x: Vec<u32>| x[..x.len() - 1].to_vec();
    let mut points: Vec<_> = without_last(x0).into_iter().map(|v| [0, v]).collect();
    points.extend(without_last(x1).into_iter().map(|u| [u, 0]));
    points.extend(without_last(x2).into_iter().map(|u| [u, ONE - u]));
    points
}

fn rings(x: &[u32], odd: bool, points: &mut Vec<[u32; 2]>) {
    let n = x.len();
    for r in 1..n / 2 {
        let last = n - 1 - r;
        let across = (x[r] * 0xaaaa + 32768) >> 16;
        for side in 0..3 {
            for p in r..last {
                let along = x[if side == 1 { p } else { last - (p - r) }] - ((across + 1) >> 1);
                points.push([[across, along], [along, across], [along, ONE - along - across]][side]);
            }
        }
    }
    if !odd {
        points.push([0x5555, 0x5555]);
    }
}

/// Returns the sides of a closed ring, as point numbers. Each ends with the first point of the next side.
fn closed_sides(start: u32, lengths: [u32; 3]) -> [Vec<u32>; 3] {
    let total: u32 = lengths.iter().sum();
    let mut first = 0;
    lengths.map(|length| {
        let side = (first..=first + length).map(|p| start + if p == total { 0 } else { p }).collect();
        first += length;
        side
    })
}

fn triangles(factors: PatchFactors, outline_length: usize) -> Vec<[u32; 3]> {
    let n = row(factors.inside, true).len() as u32;
    let odd = is_odd(factors.inside);
    let mut out = Vec::new();
    let mut around = closed_sides(0, factors.outside.map(|word| row(word, false).len() as u32 - 1));
    let mut start = outline_length as u32;
    let last_ring = if odd { n / 2 - 1 } else { n / 2 };
    for r in 1..=last_ring {
        let length = n - 1 - 2 * r;
        let ring = closed_sides(start, [length; 3]);
        for side in 0..3 {
            if r == 1 {
                transition(factors.inside, factors.outside[side], &ring[side], &around[side], &mut out);
            } else {
                regular(&ring[side], &around[side], &mut out);
            }
        }
        start += 3 * length;
        around = ring;
    }
    if odd {
        out.push([around[0][0], around[1][0], around[2][0]]);
    }
    out
}

fn regular(inner: &[u32], outer: &[u32], out: &mut Vec<[u32; 3]>) {
    let ni = inner.len();
    out.push([outer[0], outer[1], inner[0]]);
    let mut b = 1;
    for p in 0..ni - 1 {
        if p < ni / 2 {
            out.push([outer[b], inner[p + 1], inner[p]]);
            out.push([outer[b], outer[b + 1], inner[p + 1]]);
        } else {
            out.push([inner[p], outer[b], outer[b + 1]]);
            out.push([inner[p], outer[b + 1], inner[p + 1]]);
        }
        b += 1;
    }
    out.push([outer[b], outer[b + 1], inner[ni - 1]]);
}

/// Returns when the pair of points at place `i` of a side's two halves appears as factors grow.
fn order(i: u32) -> u32 {
    let j = i - 1;
    let z = j.trailing_zeros();
    (1 << (4 - z)) + (j >> (z + 1))
}

/// A walk along an edge and the ring's side beside it, which emits the triangles between them.
struct Walk<'a> {
    inner: &'a [u32],
    outer: &'a [u32],
    a: usize,
    b: usize,
    out: &'a mut Vec<[u32; 3]>,
}

impl Walk<'_> {
    fn step_out(&mut self) {
        self.out.push([self.outer[self.b], self.outer[self.b + 1], self.inner[self.a]]);
        self.b += 1;
    }

    fn step_in(&mut self) {
        self.out.push([self.inner[self.a], self.outer[self.b], self.inner[self.a + 1]]);
        self.a += 1;
    }

    fn step_out_from_inner(&mut self) {
        self.out.push([self.inner[self.a], self.outer[self.b], self.outer[self.b + 1]]);
        self.b += 1;
    }
}

fn transition(inside: u32, edge: u32, inner: &[u32], outer: &[u32], out: &mut Vec<[u32; 3]>) {
    let hi = half_rounded_up(inside) - u32::from(is_odd(inside));
    let ho = half_rounded_up(edge) - u32::from(is_odd(edge));
    let mut walk = Walk { inner, outer, a: 0, b: 0, out };
    if ho > 0 {
        walk.step_out();
    }
    for i in 2..=32 {
        if order(i) < hi {
            walk.step_in();
        }
        if order(i) < ho {
            walk.step_out();
        }
    }
    if is_odd(inside) {
        walk.step_in();
    }
    if is_odd(edge) {
        walk.step_out_from_inner();
    }
    for i in (2..=32).rev() {
        if order(i) < ho {
            walk.step_out();
        }
        if order(i) < hi {
            walk.step_in();
        }
    }
    if ho > 0 {
        walk.step_out();
    }
}

#[test]
fn the_order_is_a_breadth_first_bisection() {
    let listed = [
        16, 8, 17, 4, 18, 9, 19, 2, 20, 10, 21, 5, 22, 11, 23, 1, 24, 12, 25, 6, 26, 13, 27, 3, 28, 14, 29, 7, 30, 15,
        31,
    ];
    assert!((2..=32).map(order).eq(listed));
}
