//! Triangle budgets: finds the tolerance of LOD by error at which a mesh has no more than a given number of triangles.

use std::ops::RangeInclusive;

/// The search ends when the largest tolerance that doesn't fit and the smallest that does are within this ratio.
const PRECISION: f32 = 1.01;

/// Returns the least tolerance of a range at which `count` (the number of triangles at a tolerance) is at most `most`,
/// to within 1 percent. Returns `None` if there are more triangles even at the largest tolerance. Calls `count` at most
/// 22 times for tolerances from 0.01 to 100: one for the least, one for each doubling, and 7 between the last two.
///
/// The count needn't fall everywhere. Tolerances that were tried and are less than the returned one all have too many
/// triangles, and the largest of them is within 1 percent of it.
///
/// # Errors
/// Returns the first error of `count`.
pub fn tolerance_within_budget<E>(
    tolerances: RangeInclusive<f32>,
    most: u64,
    mut count: impl FnMut(f32) -> Result<u64, E>,
) -> Result<Option<f32>, E> {
    let (mut over, last) = tolerances.into_inner();
    if count(over)? <= most {
        return Ok(Some(over));
    }
    let mut fits = loop {
        let next = (2.0 * over).min(last);
        if count(next)? <= most {
            break next;
        }
        if next >= last {
            return Ok(None);
        }
        over = next;
    };
    while fits > PRECISION * over {
        let middle = (fits * over).sqrt();
        if count(middle)? <= most {
            fits = middle;
        } else {
            over = middle;
        }
    }
    Ok(Some(fits))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    /// The range of the option `--tolerance`, in px.
    const ALLOWED: RangeInclusive<f32> = 0.01..=100.0;

    /// The found tolerance for a count, and all that were tried, in order, with whether they fit.
    fn search(
        tolerances: RangeInclusive<f32>,
        most: u64,
        count: impl Fn(f32) -> u64,
    ) -> (Option<f32>, Vec<(f32, bool)>) {
        let mut tried = Vec::new();
        let counted = |tolerance: f32| {
            let triangles = count(tolerance);
            tried.push((tolerance, triangles <= most));
            Ok::<_, Infallible>(triangles)
        };
        let found = tolerance_within_budget(tolerances, most, counted).unwrap_or_else(|never| match never {});
        (found, tried)
    }

    /// Checks what is promised about every count.
    fn check(found: f32, tried: &[(f32, bool)]) {
        assert!(tried.len() <= 22, "{} counts", tried.len());
        let fit = tried.iter().filter(|(_, fits)| *fits).map(|(tolerance, _)| *tolerance);
        assert_eq!(fit.fold(f32::INFINITY, f32::min), found, "no smaller one was seen to fit: {tried:?}");
        let over = tried.iter().filter(|(_, fits)| !*fits).map(|(tolerance, _)| *tolerance).fold(0.0, f32::max);
        assert!(over < found && (over == 0.0 || found <= 1.01 * over), "{over} doesn't fit and {found} does");
    }

    #[test]
    fn the_least_tolerance_that_fits_is_found_to_within_1_percent() {
        let count = |tolerance: f32| 100 + (1000.0 / tolerance) as u64;
        assert_eq!(search(0.25..=100.0, 5000, count), (Some(0.25), vec![(0.25, true)]));
        for from in [0.01, 0.25, 1.7] {
            for most in [60_000, 4099, 2000, 500, 150, 111, 110] {
                let (found, tried) = search(from..=100.0, most, count);
                let (found, exact) = (found.expect("within the range"), 1000.0 / (most as f32 - 99.0));
                let exact = exact.max(from);
                assert!(found >= exact * 0.999 && found <= exact * 1.0101, "{most}: {found} for {exact}");
                check(found, &tried);
            }
        }
        assert_eq!(search(ALLOWED, 100, count).0, None);
    }

    #[test]
    fn a_count_that_rises_in_places_gives_the_least_tolerance_that_was_seen_to_fit() {
        // Up to 3 % more or fewer triangles, in waves of 2 % of the tolerance.
        let wavy = |tolerance: f32| {
            let wave = 1.0 + 0.03 * (f64::from(tolerance).ln() / 0.02 * std::f64::consts::TAU).sin();
            (wave * 1e5 / f64::from(tolerance)) as u64
        };
        assert!(
            (1..100).any(|i| wavy(1.0 + 1e-3 * i as f32) > wavy(1.0 + 1e-3 * (i - 1) as f32)),
            "it rises in places"
        );
        for most in [9_000_000, 1_234_567, 100_000, 31_415, 2000, 1100] {
            let (found, tried) = search(ALLOWED, most, wavy);
            let found = found.expect("within the range");
            assert!(wavy(found) <= most);
            check(found, &tried);
            let smooth = 1e5 / most as f32;
            assert!(found > 0.96 * smooth && found < 1.05 * smooth, "{most}: {found} for {smooth}");
        }
        // Only from 0.3 to 0.35 px it fits, and the search passes there.
        let (found, tried) = search(ALLOWED, 1000, |tolerance| if (0.3..0.35).contains(&tolerance) { 1 } else { 1001 });
        let found = found.expect("within the range");
        assert!((0.3..=0.303).contains(&found), "{found}");
        check(found, &tried);
    }
}
