//! Places spread evenly by area over charts that stretch unevenly.

/// Strips a chart, and cells a strip: density is even within a cell.
const CELLS: usize = 64;

/// Charts cut into strips along `s`, and these into cells along `t`, by area.
pub(super) struct Spread {
    /// Area up to the end of each strip of each chart.
    strips: Vec<f64>,
    /// Area within a strip up to the end of each of its cells.
    cells: Vec<[f64; CELLS]>,
}

impl Spread {
    /// `density` says how much area a chart has at a place for the unit square's.
    pub fn new(charts: usize, density: impl Fn(usize, f64, f64) -> f64) -> Self {
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

    pub fn area(&self) -> f64 {
        self.strips.last().copied().unwrap_or(0.0)
    }

    /// The chart and place of a point of the unit square: parts of the square take parts of the area.
    pub fn place(&self, x: f64, y: f64) -> (usize, f64, f64) {
        let (strip, s) = find(&self.strips, x);
        let (cell, t) = find(&self.cells[strip], y);
        let along = |i: usize, rest: f64| (i as f64 + rest) / CELLS as f64;
        (strip / CELLS, along(strip % CELLS, s), along(cell, t))
    }
}

/// In which step of rising sums a part (0 to 1) of the whole lies, and how far into it.
pub(super) fn find(sums: &[f64], part: f64) -> (usize, f64) {
    let whole = sums.last().copied().unwrap_or(0.0);
    let at = part * whole;
    let step = sums.partition_point(|sum| *sum <= at).min(sums.len().saturating_sub(1));
    let start = if step == 0 { 0.0 } else { sums[step - 1] };
    let width = sums[step] - start;
    let rest = if width > 0.0 { ((at - start) / width).clamp(0.0, 1.0) } else { 0.5 };
    (step, rest)
}

/// The digits of `i` mirrored at the point: evenly spread over 0 to 1 however many are taken (van der Corput 1935; Halton
/// 1960).
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
    fn digits_are_mirrored() {
        assert_eq!([1, 2, 3, 4].map(|i| radical_inverse(2, i)), [0.5, 0.25, 0.75, 0.125]);
    }
}
