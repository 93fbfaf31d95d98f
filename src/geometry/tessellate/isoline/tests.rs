use proptest::prelude::*;

use super::*;
use crate::tessellate::domain::tests::any_factor;
use crate::tessellate::factors::FIXED_ONE;

#[test]
fn three_isolines_of_two_and_a_half_segments() {
    let rows = [
        (Partitioning::Integer, vec![0, 21845, 43691, 65536]),
        (Partitioning::Pow2, vec![0, 21845, 43691, 65536]),
        (Partitioning::FractionalOdd, vec![0, 16384, 49152, 65536]),
        (Partitioning::FractionalEven, vec![0, 28672, 32768, 36864, 65536]),
    ];
    for (p, row) in rows {
        let isolines = IsolineFactors::new(p, 3.0, 2.5).expect("isolines that are drawn");
        let points: Vec<_> = [0, 21845, 43691].into_iter().flat_map(|v| row.iter().map(move |&u| [u, v])).collect();
        assert_eq!(isolines.points(), points, "{p:?}");
        let count = row.len() as u32;
        let lines: Vec<_> = (0..3 * count - 1).filter(|point| (point + 1) % count > 0).map(|a| [a, a + 1]).collect();
        assert_eq!(isolines.lines(), lines, "{p:?}");
    }
}

#[test]
fn density_is_rounded_up_and_clamped_whatever_the_partitioning() {
    for p in Partitioning::ALL {
        let of = |density| segments(IsolineFactors::new(p, density, 4.0).expect("isolines that are drawn").density);
        let densities = [1e-9, 1.0, 1.000_000_1, 2.5, 63.5, 64.0, 1e9, f32::INFINITY];
        assert_eq!(densities.map(of), [1, 1, 2, 3, 64, 64, 64, 64], "{p:?}");
    }
}

#[test]
fn one_isoline_lies_at_v_0() {
    let one = IsolineFactors::new(Partitioning::FractionalOdd, 0.5, 1.0).expect("isolines that are drawn");
    assert_eq!((one.points(), one.lines()), (vec![[0, 0], [FIXED_ONE, 0]], vec![[0, 1]]));
}

#[test]
fn either_factor_culls() {
    for bad in [0.0, -0.0, -1.0, f32::NAN, f32::NEG_INFINITY] {
        for p in Partitioning::ALL {
            assert_eq!(IsolineFactors::new(p, bad, 3.0), None);
            assert_eq!(IsolineFactors::new(p, 3.0, bad), None);
        }
    }
}

proptest! {
    #[test]
    fn any_isolines_are_counted_and_equal(
        p in prop::sample::select(Partitioning::DIRECT3D.to_vec()),
        density in any_factor(),
        detail in any_factor(),
    ) {
        let Some(own) = IsolineFactors::new(p, density, detail) else { return Ok(()) };
        let (points, lines) = (own.points(), own.lines());
        prop_assert_eq!((points.len(), lines.len()), {
            // In closed form.
            let [isolines, along] = [own.density, own.detail].map(|word| segments(word) as usize);
            (isolines * (along + 1), isolines * along)
        });
        let isolines: Vec<_> = points.chunks(segments(own.detail) as usize + 1).collect();
        for (k, isoline) in (0..).zip(&isolines) {
            let v = isoline[0][1];
            prop_assert!(v.abs_diff(k * FIXED_ONE / isolines.len() as u32) <= k, "{} of {}", v, isolines.len());
            prop_assert!(isoline.iter().zip(isolines[0]).all(|(own, first)| *own == [first[0], v]));
            prop_assert!(isoline.iter().zip(isoline.iter().rev()).all(|(a, b)| a[0] + b[0] == FIXED_ONE));
        }
        prop_assert!(lines.iter().all(|[a, b]| points[*a as usize][1] == points[*b as usize][1]));
    }
}
