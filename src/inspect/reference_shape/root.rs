//! Roots of monotonically decreasing functions.

/// Returns the root of a function that decreases from 0 or more at `low` (which is 0 or more) to 0 or less at `high`.
/// `f` gives its value and slope.
///
/// It takes Newton's steps, as long as they stay in the interval in which the root is known to lie. If they don't, and
/// every fourth time, it bisects that interval: arithmetically, or geometrically if its ends are far apart.
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
