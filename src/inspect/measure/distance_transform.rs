//! Exact Euclidean distances on a grid of samples to the nearest sample of a set.
//!
//! Felzenszwalb and Huttenlocher 2012, "Distance Transforms of Sampled Functions", section 2: first the distances along each
//! column, then in each row the lower envelope of the parabolas that these are the heights of. All of it is computed in integers.

/// The distances to a set of samples, after the pass over columns.
pub(super) struct DistanceTransform {
    width: usize,
    /// The distance along its column from each sample to the nearest one of the set, row by row; [`NONE`] in a column without any.
    columns: Vec<u16>,
}

/// More than any distance along a column: a texture has at most so many rows.
const NONE: u16 = u16::MAX;

impl DistanceTransform {
    /// Goes over the columns of a grid that is `width` samples wide. `is_in_set` says of each sample, by its number row by row,
    /// whether it is in the set.
    pub(super) fn new(width: usize, height: usize, is_in_set: impl Fn(usize) -> bool) -> Self {
        let mut columns = vec![NONE; width * height];
        let mut last = vec![NONE; width];
        for (sample, column) in columns.iter_mut().enumerate() {
            let above = &mut last[sample % width];
            *above = if is_in_set(sample) { 0 } else { above.saturating_add(1) };
            *column = *above;
        }
        last.fill(NONE);
        for (sample, column) in columns.iter_mut().enumerate().rev() {
            let below = &mut last[sample % width];
            *below = if *column == 0 { 0 } else { below.saturating_add(1) };
            *column = (*column).min(*below);
        }
        Self { width, columns }
    }

    /// The squared distance from each sample of a row to the nearest sample of the set; none if the set is empty.
    pub(super) fn row(&self, y: usize) -> Option<Vec<u64>> {
        let columns = &self.columns[y * self.width..(y + 1) * self.width];
        let squared = |x: usize| i64::from(columns[x]).pow(2);
        // The parabolas of the envelope from left to right: where each has its vertex, and from where on it is the lowest.
        let mut envelope: Vec<(usize, i64)> = Vec::new();
        for x in (0..self.width).filter(|&x| columns[x] != NONE) {
            let start = loop {
                let Some(&(vertex, from)) = envelope.last() else { break 0 };
                let rise = squared(x) + (x * x) as i64 - squared(vertex) - (vertex * vertex) as i64;
                // The first whole number at or behind the place where both parabolas meet.
                let start = -(-rise).div_euclid(2 * (x - vertex) as i64);
                if start > from {
                    break start;
                }
                envelope.pop();
            };
            if start < self.width as i64 {
                envelope.push((x, start));
            }
        }
        envelope.first()?;
        let mut place = 0;
        let distance = |x: usize| {
            while envelope.get(place + 1).is_some_and(|next| next.1 <= x as i64) {
                place += 1;
            }
            let vertex = envelope[place].0;
            squared(vertex) as u64 + (x.abs_diff(vertex) as u64).pow(2)
        };
        Some((0..self.width).map(distance).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The distances by comparison with every sample of the set.
    fn compared(width: usize, set: &[bool], y: usize) -> Option<Vec<u64>> {
        let members: Vec<_> = (0..set.len()).filter(|&sample| set[sample]).collect();
        let to = |x: usize| {
            let away =
                members.iter().map(|&sample| (sample % width).abs_diff(x).pow(2) + (sample / width).abs_diff(y).pow(2));
            away.min().map(|squared| squared as u64)
        };
        (0..width).map(to).collect()
    }

    #[test]
    fn distances_are_those_of_a_comparison_with_all_samples() {
        let mut state = 1_u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state >> 33
        };
        for [width, height] in [[1, 1], [1, 9], [13, 1], [17, 11], [40, 33]] {
            for rarity in [1, 2, 7, 60, 100_000] {
                let set: Vec<bool> = (0..width * height).map(|_| random() % rarity == 0).collect();
                let transform = DistanceTransform::new(width, height, |sample| set[sample]);
                for y in 0..height {
                    assert_eq!(
                        transform.row(y),
                        compared(width, &set, y),
                        "row {y} of {width} x {height}, 1 in {rarity}"
                    );
                }
            }
        }
    }

    #[test]
    fn one_sample_is_as_far_as_its_two_offsets_say_also_across_a_large_grid() {
        let (width, height) = (8192, 3);
        let transform = DistanceTransform::new(width, height, |sample| sample == 8191);
        let row = transform.row(2).expect("the set has a sample");
        assert_eq!((row[8191], row[0], row[8188]), (4, 8191 * 8191 + 4, 13));
        assert_eq!(DistanceTransform::new(5, 5, |_| false).row(3), None);
    }
}
