//! Connectivity: which points the triangles inside a patch join. Each triangle is computed from its number alone. Twin:
//! `shaders/connectivity.wgsl`. [`super::connectivity_table`] has the same results in a table.

use super::rings::{TransitionStep, ring_point, rings_before};

/// Which of the 31 places before a side's middle have a point. Points appear in the order of a breadth-first bisection:
/// place 16, then 8 and 24, then 4, 12, 20, 28, and so on.
///
/// With `half_points` from 2^L to 2^(L+1) - 1, level L of the bisection is complete and level L + 1 is filled from the
/// left: there are points at every multiple of 2^(5-L), and half-way between the first `extra` pairs of these.
#[derive(Clone, Copy, Debug)]
struct TransitionPlaces {
    shift: u32,
    extra: u32,
}

/// Returns the places of a side with this many points in half of it.
fn transition_places(half_points: u32) -> TransitionPlaces {
    let top = half_points.max(1).ilog2();
    TransitionPlaces { shift: 5 - top, extra: half_points.max(1) - (1 << top) }
}

/// Returns the number of points at places 1 to `place`.
fn points_up_to(places: TransitionPlaces, place: u32) -> u32 {
    (place >> places.shift) + places.extra.min((((2 * place) >> places.shift) + 1) >> 1)
}

/// Returns `place + skip` if both sides together have at most `count` points up to there, else `place`.
fn skip_places(inner: TransitionPlaces, outer: TransitionPlaces, place: u32, skip: u32, count: u32) -> u32 {
    let further = place + skip;
    let fits = points_up_to(inner, further) + points_up_to(outer, further) <= count;
    if fits { further } else { place }
}

/// Returns triangle `t` of those before the middle of a side.
pub(super) fn transition_before_middle(inner_half: u32, outer_half: u32, t: u32) -> TransitionStep {
    // The first triangle is the one on the edge's first segment, before place 1.
    let first = outer_half.min(1);
    if t < first {
        return TransitionStep { inner: 0, outer: 0, along_inner: false, inner_first: false };
    }
    let count = t - first;
    let inner_places = transition_places(inner_half);
    let outer_places = transition_places(outer_half);
    // A bisection over the 31 places, unrolled.
    let mut place = skip_places(inner_places, outer_places, 0, 16, count);
    place = skip_places(inner_places, outer_places, place, 8, count);
    place = skip_places(inner_places, outer_places, place, 4, count);
    place = skip_places(inner_places, outer_places, place, 2, count);
    place = skip_places(inner_places, outer_places, place, 1, count);

    // The triangle belongs to the next place. If both sides have a point there, the inner side's triangle comes first.
    let inner = points_up_to(inner_places, place);
    let outer = points_up_to(outer_places, place);
    let inner_steps = points_up_to(inner_places, place + 1) - inner;
    let along_inner = inner_steps == 1 && count == inner + outer;
    TransitionStep {
        inner: if along_inner { inner } else { inner + inner_steps },
        outer: first + outer,
        along_inner,
        inner_first: along_inner,
    }
}

/// Returns triangle `t` of those inside the first ring.
///
/// Triangles are numbered ring by ring. Each ring's sides are joined with the sides of the ring around it, which have
/// two segments more. In the centre of an odd patch there is one more triangle.
pub(super) fn regular_triangle(outer: u32, n: u32, t: u32) -> [u32; 3] {
    let rings = rings_before(n - 2, t / 6);
    let ring = rings + 2;
    let around_start = outer + 3 * rings * (n - 1 - rings);
    if 2 * ring > n {
        return [around_start, around_start + 1, around_start + 2];
    }
    let inner_segments = n - 2 * ring;
    let around_length = 3 * (inner_segments + 2);
    let start = around_start + around_length;
    let in_ring = t - 6 * rings * (n - 2 - rings);
    let per_side = 2 * inner_segments + 2;
    let side = u32::from(in_ring >= per_side) + u32::from(in_ring >= 2 * per_side);
    let q = in_ring - side * per_side;

    // Every triangle joins point h of the inner side, point h + 1 of the outer side, and a neighbour of one of them.
    let h = q >> 1;
    let odd = (q & 1) == 1;
    let early = q <= 2 * ((inner_segments + 1) >> 1);
    let inner_start = side * inner_segments + h;
    let outer_start = side * (inner_segments + 2) + h;
    let i = ring_point(start, 3 * inner_segments, inner_start);
    let o = ring_point(around_start, around_length, outer_start + 1);
    let third = if early != odd {
        ring_point(around_start, around_length, outer_start + if odd { 2 } else { 0 })
    } else {
        ring_point(start, 3 * inner_segments, if odd { inner_start + 1 } else { inner_start - 1 })
    };
    if !odd {
        return [third, o, i];
    }
    let last = q == per_side - 1;
    if early || last { [o, third, i] } else { [i, o, third] }
}
