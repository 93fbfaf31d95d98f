use proptest::prelude::*;

use super::*;

const ODD_ONE: u32 = FACTOR_ODD | FIXED_ONE;

fn whole(factor: u32) -> u32 {
    (factor << 16) | (factor << 31)
}

#[test]
fn edge_factors_that_are_not_positive_cull_the_patch() {
    for bad in [0.0, -0.0, -1.0, f32::NAN, -f32::NAN, f32::NEG_INFINITY] {
        for p in Partitioning::ALL {
            for k in 0..3 {
                let mut edges = [3.0; 3];
                edges[k] = bad;
                let f = process(p, edges, 3.0);
                assert_eq!(f, PatchFactors::default(), "{bad} on edge {k} of {p:?}");
                assert!(patch_is_culled(f));
                assert_eq!((point_count(f), triangle_count(f)), (0, 0));
            }
        }
    }
}

#[test]
fn denormal_factors_count_as_positive() {
    for p in Partitioning::ALL {
        assert_eq!(process(p, [f32::from_bits(1); 3], 1.0), process(p, [1.0; 3], 1.0));
        assert!(!patch_is_culled(process(p, [f32::from_bits(1); 3], 1.0)));
    }
}

#[test]
fn inside_factors_never_cull() {
    for bad in [0.0, -0.0, -7.0, f32::NAN, -f32::NAN, f32::NEG_INFINITY, 1e-40] {
        for p in Partitioning::ALL {
            assert_eq!(process(p, [5.0; 3], bad), process(p, [5.0; 3], 1.0), "{bad} in {p:?}");
        }
    }
}

#[test]
fn factors_are_clamped() {
    let both = |p, x| process(p, [x; 3], x);
    let same = |word| PatchFactors { outside: [word; 3], inside: word };
    for high in [65.0, 1e9, f32::MAX, f32::INFINITY] {
        assert_eq!(both(Partitioning::Integer, high), same(64 << 16));
        assert_eq!(both(Partitioning::Pow2, high), same(64 << 16));
        assert_eq!(both(Partitioning::FractionalOdd, high), same(whole(63)));
        assert_eq!(both(Partitioning::FractionalEven, high), same(64 << 16));
    }
    assert_eq!(both(Partitioning::Integer, 0.25), PatchFactors { outside: [ODD_ONE; 3], inside: FIXED_ONE });
    assert_eq!(both(Partitioning::FractionalOdd, 0.25), same(ODD_ONE));
    assert_eq!(both(Partitioning::FractionalEven, 0.25), same(2 << 16));
}

#[test]
fn integer_factors_are_rounded_up_and_have_the_parity_of_the_result() {
    for p in [Partitioning::Integer, Partitioning::Pow2] {
        let f = process(p, [1.0, 1.000_000_1, 2.5], 4.0);
        assert_eq!(f, PatchFactors { outside: [ODD_ONE, 2 << 16, whole(3)], inside: 4 << 16 });
        // An inside of 1 is even.
        assert_eq!(process(p, [2.0, 1.0, 1.0], 1.0).inside, FIXED_ONE);
        assert_eq!(process(p, [2.0, 1.0, 1.0], 3.0).inside, whole(3));
    }
}

#[test]
fn fractional_factors_are_rounded_with_ties_to_even() {
    let steps = |x: f32| process(Partitioning::FractionalEven, [x; 3], x).inside;
    let half_step = 0.5 / 65536.0;
    assert_eq!(steps(2.0 + half_step), 2 << 16);
    assert_eq!(steps(2.0 + 3.0 * half_step), (2 << 16) + 2);
    assert_eq!(steps(f32::from_bits((2.0 + half_step).to_bits() + 1)), (2 << 16) + 1);
    assert_eq!(steps(2.0 + 2.0 * half_step), (2 << 16) + 1);
    assert_eq!(steps(f32::from_bits(64f32.to_bits() - 1)), 64 << 16);
}

#[test]
fn an_odd_patch_with_a_divided_edge_has_a_ring_inside() {
    let with_edge = |x: f32| process(Partitioning::FractionalOdd, [1.0, x, 1.0], 1.0);
    let tie = f32::from_bits(0x3f80_0040);
    for minimal in [0.5, 1.0, f32::from_bits(0x3f80_0001), tie] {
        let f = with_edge(minimal);
        assert!(patch_is_minimal(f), "{minimal:e}");
        assert_eq!((point_count(f), triangle_count(f)), (3, 1));
    }
    for split in [f32::from_bits(0x3f80_0041), 1.0 + 1.0 / 65536.0, 1.5, 3.0] {
        let f = with_edge(split);
        assert!(!patch_is_minimal(f), "{split:e}");
        assert_eq!(f.inside, FACTOR_ODD | (FIXED_ONE + 1));
        assert_eq!((point_count(f), triangle_count(f)), (8, 9));
    }
}

#[test]
fn counts_of_known_patches() {
    let counts = |p, edges, inside| {
        let f = process(p, edges, inside);
        (point_count(f), triangle_count(f))
    };
    assert_eq!(counts(Partitioning::Integer, [1.0; 3], 1.0), (3, 1));
    assert_eq!(counts(Partitioning::Integer, [2.0, 1.0, 1.0], 1.0), (5, 4));
    assert_eq!(counts(Partitioning::Pow2, [5.0, 7.0, 3.0], 4.0), (22, 27));
    assert_eq!(counts(Partitioning::FractionalEven, [1.0; 3], 1.0), (7, 6));
    for (n, triangles) in [(3, 13), (8, 96), (16, 384), (63, 5953), (64, 6144)] {
        assert_eq!(counts(Partitioning::Integer, [n as f32; 3], n as f32).1, triangles);
    }
    assert_eq!(counts(Partitioning::Integer, [64.0; 3], 64.0).0, 3169);
}

#[test]
fn pow2_rounds_up_and_keeps_factors_that_cull() {
    let cases = [(0.1, 1.0), (1.0, 1.0), (1.01, 2.0), (3.0, 4.0), (4.0, 4.0), (33.0, 64.0), (64.0, 64.0), (1e9, 64.0)];
    for (x, power) in cases {
        assert_eq!(round_pow2(x), power, "{x}");
    }
    assert_eq!(round_pow2(f32::INFINITY), 64.0);
    assert_eq!(round_pow2(f32::from_bits(1)), 1.0);
    for kept in [0.0f32, -0.0, -3.0, f32::NAN, f32::NEG_INFINITY] {
        assert_eq!(round_pow2(kept).to_bits(), kept.to_bits());
    }
}

proptest! {
    /// The words agree with arithmetic in f64, which is exact here.
    #[test]
    fn words_agree_with_exact_arithmetic(x in 0.5f32..140.0, p in prop::sample::select(Partitioning::ALL.to_vec())) {
        let f = process(p, [x; 3], x);
        let (low, high) = match p {
            Partitioning::FractionalOdd => (1.0, 63.0),
            Partitioning::FractionalEven => (2.0, 64.0),
            Partitioning::Rows => (1.0, 127.0),
            _ => (1.0, 64.0),
        };
        let clamped = f64::from(x).clamp(low, high);
        let expected = match p {
            Partitioning::FractionalOdd | Partitioning::FractionalEven => (clamped * 65536.0).round_ties_even(),
            _ => clamped.ceil() * 65536.0,
        };
        prop_assert_eq!(f64::from(f.outside[1] & FACTOR_VALUE), expected);
    }
}

#[test]
fn patches_are_low_if_they_are_drawn_with_all_factors_below_two() {
    let low = |edges, inside| patch_is_low(process(Partitioning::FractionalOdd, edges, inside));
    assert!(low([1.0; 3], 1.0) && low([1.0, 1.5, 1.99], 1.99));
    assert!(!low([1.0, 2.0, 1.0], 1.5) && !low([1.0; 3], 2.0));
    assert!(!low([1.0, 0.0, 1.0], 1.0), "nothing is drawn");
}

#[test]
fn there_are_at_least_two_segments_inside_and_three_if_they_are_odd() {
    assert_eq!([whole(1), FIXED_ONE, whole(2), whole(3), whole(4)].map(inside_segments), [3, 2, 2, 3, 4]);
}
