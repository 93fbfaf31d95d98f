//! Means of squares over an area, from samples.

use serde::Serialize;

/// The root of a mean of squares, with its standard error. The error is that of samples taken at random; samples that are
/// spread evenly err less.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Rms {
    pub value: f64,
    pub error: f64,
}

/// Sums over samples, each of which stands for some area.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MeanSquare {
    area: f64,
    squares: f64,
    /// The sums of squared areas, times the squares to the power of 0, 1 and 2.
    spread: [f64; 3],
}

impl MeanSquare {
    /// One sample.
    pub(crate) fn new(value: f64, area: f64) -> Self {
        let square = value * value;
        Self { area, squares: area * square, spread: [1.0, square, square * square].map(|power| area * area * power) }
    }

    pub(crate) fn add(&mut self, value: f64, area: f64) {
        *self = self.with(Self::new(value, area));
    }

    pub(crate) fn with(self, other: Self) -> Self {
        Self {
            area: self.area + other.area,
            squares: self.squares + other.squares,
            spread: [0, 1, 2].map(|i| self.spread[i] + other.spread[i]),
        }
    }

    /// `None` without an area.
    pub(crate) fn rms(&self) -> Option<Rms> {
        if self.area <= 0.0 {
            return None;
        }
        let mean = self.squares / self.area;
        let [one, squares, fourth_powers] = self.spread;
        let variance = (fourth_powers - 2.0 * mean * squares + mean * mean * one).max(0.0) / (self.area * self.area);
        let value = mean.sqrt();
        // The derivative of a square root is half of its reciprocal.
        let error = if value > 0.0 { variance.sqrt() / (2.0 * value) } else { 0.0 };
        Some(Rms { value, error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_values_have_no_error_and_areas_weigh() {
        let mut sums = MeanSquare::default();
        assert_eq!(sums.rms(), None);
        sums.add(3.0, 2.0);
        sums.add(3.0, 1.0);
        assert_eq!(sums.rms(), Some(Rms { value: 3.0, error: 0.0 }));
        let mut other = MeanSquare::default();
        other.add(0.0, 9.0);
        assert_eq!(sums.with(other).rms().map(|rms| rms.value), Some(1.5));
    }

    #[test]
    fn the_error_is_that_of_random_samples() {
        // Values between 0 and 1, whose squares have the mean 1/3 and the variance 1/5 - 1/9.
        let mut random = fastrand::Rng::with_seed(1);
        let (count, runs) = (400, 300);
        let mut off = 0.0;
        for _ in 0..runs {
            let mut sums = MeanSquare::default();
            (0..count).for_each(|_| sums.add(random.f64(), 1.0));
            let Rms { value, error } = sums.rms().expect("samples");
            let expected = (4.0_f64 / 45.0 / f64::from(count)).sqrt() / (2.0 * (1.0_f64 / 3.0).sqrt());
            assert!((error / expected - 1.0).abs() < 0.2, "{error} for {expected}");
            off += ((value - (1.0_f64 / 3.0).sqrt()) / error).powi(2) / f64::from(runs);
        }
        assert!((0.7..1.4).contains(&off), "{off}");
    }
}
