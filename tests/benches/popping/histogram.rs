//! Percentiles of millions of numbers.

/// The lower end of the first bin.
const LEAST: f64 = 1e-4;
/// The upper end of a bin over its lower end.
const RATIO: f64 = 1.02;
/// The last bin is that of 100 and more.
const BINS: usize = 700;

/// How many numbers lie in each of many bins, and the largest number.
#[derive(Clone)]
pub(crate) struct Histogram {
    counts: Vec<u64>,
    pub largest: f64,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { counts: vec![0; BINS], largest: 0.0 }
    }
}

impl Histogram {
    pub(crate) fn add(&mut self, number: f64) {
        let bin = ((number / LEAST).max(1.0).ln() / RATIO.ln()) as usize;
        self.counts[bin.min(BINS - 1)] += 1;
        self.largest = self.largest.max(number);
    }

    pub(crate) fn merge(&mut self, other: &Self) {
        for (own, others) in self.counts.iter_mut().zip(&other.counts) {
            *own += others;
        }
        self.largest = self.largest.max(other.largest);
    }

    /// The number that 99 % of all don't exceed, up to 2 % too large.
    pub(crate) fn percentile_99(&self) -> f64 {
        let beyond: u64 = self.counts.iter().sum::<u64>() / 100;
        let mut above = 0;
        for (bin, count) in self.counts.iter().enumerate().rev() {
            above += count;
            if above > beyond {
                return (LEAST * RATIO.powf(bin as f64 + 1.0)).min(self.largest);
            }
        }
        0.0
    }
}
