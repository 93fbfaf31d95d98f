//! Triangle budgets: finds the tolerance of LOD by error at which a mesh has no more than a given number of triangles.

use std::ops::RangeInclusive;

/// The search ends when the largest tolerance that doesn't fit and the smallest that does are within this ratio.
const PRECISION: f32 = 1.02;

/// Returns the least tolerance of a range at which `count` (the number of triangles at a tolerance) is at most `most`,
/// to within 2 percent. Returns `None` if there are more triangles even at the largest tolerance. Calls `count` about a
/// dozen times.
///
/// # Errors
/// Returns the first error of `count`.
pub(crate) fn tolerance_within_budget<E>(
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

    fn fit(from: f32, most: u64) -> Option<f32> {
        let mut tried = 0;
        let count = |tolerance: f32| {
            tried += 1;
            assert!(tried < 24, "too many tries");
            Ok::<_, Infallible>(100 + (1000.0 / tolerance) as u64)
        };
        tolerance_within_budget(from..=100.0, most, count).unwrap_or_else(|never| match never {})
    }

    #[test]
    fn the_least_tolerance_that_fits_is_found() {
        assert_eq!(fit(0.25, 5000), Some(0.25));
        for most in [4099, 2000, 500, 150, 111] {
            let found = fit(0.25, most).expect("within the range");
            let exact = 1000.0 / (most as f32 - 99.0);
            assert!(found >= exact * 0.999 && found <= exact * 1.03, "{most}: {found} for {exact}");
        }
        assert_eq!(fit(0.25, 100), None);
    }
}
