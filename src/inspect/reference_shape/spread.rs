//! Points spread evenly by area over charts that stretch areas unevenly. A chart maps the unit square to a part of a
//! surface.

/// The number of strips in a chart, and of cells in a strip. Within a cell the density counts as constant.
const CELLS: usize = 64;

/// The areas of charts, cut into strips along `s` and these into cells along `t`.
pub(super) struct Spread {
    /// The sum of the areas up to the end of each strip of each chart.
    strips: Vec<f64>,
    /// For each strip, the sum of the areas up to the end of each of its cells.
    cells: Vec<[f64; CELLS]>,
}

impl Spread {
    /// `density` returns the surface's area per area of the unit square, at a place in a chart.
    pub(super) fn new(charts: usize, density: impl Fn(usize, f64, f64) -> f64) -> Self {
        let mut area = 0.0;
        let (mut strips, mut cells) = (Vec::new(), Vec::new());
        let middle = |i: usize| (i as f64 + 0.5) / CELLS as f64;
        for strip in 0..charts * CELLS {
            let mut sum = 0.0;
            cells.push(std::array::from_fn(|j| {
                sum += density(strip / CELLS, middle(strip % CELLS), middle(j)) / (CELLS * CELLS) as f64;
                sum
            }));
            area += sum;
            strips.push(area);
        }
        Self { strips, cells }
    }

    /// Returns the area of all charts.
    pub(super) fn area(&self) -> f64 {
        self.strips.last().copied().unwrap_or(0.0)
    }

    /// Maps a point of the unit square to a chart and a place in it, so that equal areas of the square get equal areas
    /// of the surface.
    pub(super) fn place(&self, x: f64, y: f64) -> (usize, f64, f64) {
        let (strip, s) = find(&self.strips, x);
        let (cell, t) = find(&self.cells[strip], y);
        let along = |i: usize, rest: f64| (i as f64 + rest) / CELLS as f64;
        (strip / CELLS, along(strip % CELLS, s), along(cell, t))
    }
}

/// Returns the step of increasing sums in which a part (0 to 1) of the last sum lies, and how far into the step, from 0
/// to 1.
pub(super) fn find(sums: &[f64], part: f64) -> (usize, f64) {
    let whole = sums.last().copied().unwrap_or(0.0);
    let at = part * whole;
    let step = sums.partition_point(|sum| *sum <= at).min(sums.len().saturating_sub(1));
    let start = if step == 0 { 0.0 } else { sums[step - 1] };
    let width = sums[step] - start;
    let rest = if width > 0.0 { ((at - start) / width).clamp(0.0, 1.0) } else { 0.5 };
    (step, rest)
}

/// Returns the radical inverse of `i`: its digits in `base`, mirrored at the point. The first values of any number are
/// spread evenly from 0 to 1 (van der Corput 1935; Halton 1960).
pub fn radical_inverse(base: usize, mut i: usize) -> f64 {
    let (mut sum, mut digit) = (0.0, 1.0);
    while i > 0 {
        digit /= base as f64;
        sum += digit * (i % base) as f64;
        i /= base;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radical_inverses_mirror_the_digits() {
        assert_eq!([1, 2, 3, 4].map(|i| radical_inverse(2, i)), [0.5, 0.25, 0.75, 0.125]);
    }
}
