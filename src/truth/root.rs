//! Roots of falling functions.

/// The root of a function that is 0 or above at `low` (0 or above itself) and 0 or below at `high`, and falls between.
/// `f` gives its value and slope. Newton's steps, kept between what is known; where they creep, by halves, of the exponent
/// if the ends are far apart.
pub(super) fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = if low > 0.0 { low } else { high };
    for step in 1..600 {
        let (value, slope) = f(x);
        if value >= 0.0 {
            low = x;
        } else {
            high = x;
        }
        let newton = x - value / slope;
        if (newton - x).abs() <= 2e-16 * x || high - low <= 1e-16 * high {
            break;
        }
        let is_between = newton > low && newton < high;
        x = match is_between && step % 4 != 0 {
            true => newton,
            false if low > 0.0 && high > 4.0 * low => low.sqrt() * high.sqrt(),
            false => (low + high) / 2.0,
        };
    }
    x
}
