//! Which rows nobody beats, and which method is the fastest to reach an error.

use super::{Cost, Method, Row, Subject};
use crate::tessellate::Surface;

/// Rows of a mesh that can be compared, with their errors: all, if they were held against one truth; otherwise those of one
/// surface, as each is off from its own limit.
#[derive(Clone, Debug)]
pub(crate) struct Race<'a> {
    /// The one that all are of, without a truth.
    pub surface: Option<Surface>,
    pub entries: Vec<(&'a Row, f64)>,
}

/// The fastest to reach an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Win<'a> {
    pub error: f64,
    pub fastest: &'a Row,
    /// The fastest of another method; none if no other reaches it.
    pub next: Option<&'a Row>,
}

/// Of points with a cost and an error, the indices of those that no other one beats, by growing cost: each has less error
/// than all that cost as much or less. Of equal points it is the first.
pub(crate) fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        let ((cost_a, error_a), (cost_b, error_b)) = (points[a], points[b]);
        cost_a.total_cmp(&cost_b).then(error_a.total_cmp(&error_b))
    });
    let mut least = f64::INFINITY;
    order.retain(|&index| {
        let better = points[index].1 < least;
        least = least.min(points[index].1);
        better
    });
    order
}

/// How many times the triangles of an earlier setting a later one has, that comes no closer: finer ones won't either.
const FINER: u64 = 3;

/// Which part of an error must be gone for a setting to be closer.
const CLOSER: f64 = 0.05;

/// Whether a method has come as close as it gets, so that finer settings cost more and show nothing new: of the rows of it, from
/// coarse to fine, the last has three times the triangles of another, and each of its errors is less by a twentieth at most.
/// What triangles are off from their surface falls as their number grows, or faster, so that half of that twentieth at most is
/// left to gain.
pub(crate) fn has_converged(rows: &[Row], method: Method) -> bool {
    let mut own = rows.iter().rev().filter(|row| row.setting.method == method);
    let Some(last) = own.next() else { return false };
    let errors = |row: &Row| {
        let [largest, rms, degrees] =
            row.errors.map_or([0.0; 3], |errors| [errors.largest, errors.rms, errors.normal_degrees]);
        [largest, rms, degrees, row.max_error_px.unwrap_or(0.0)]
    };
    let is_no_closer = |earlier: &Row| {
        let pairs = errors(earlier).into_iter().zip(errors(last));
        pairs.into_iter().all(|(before, now)| now >= (1.0 - CLOSER) * before)
    };
    own.any(|row| row.triangles.saturating_mul(FINER) <= last.triangles && is_no_closer(row))
}

impl Subject {
    /// Rows whose error is known, as they can be compared.
    pub(crate) fn races(&self) -> Vec<Race<'_>> {
        let mut races: Vec<Race> = Vec::new();
        for (row, error) in self.rows.iter().filter_map(|row| Some((row, self.error(row)?))) {
            let surface = self.truth.is_none().then_some(row.setting.method.surface);
            match races.iter_mut().find(|race| race.surface == surface) {
                Some(race) => race.entries.push((row, error)),
                None => races.push(Race { surface, entries: vec![(row, error)] }),
            }
        }
        races
    }

    /// Every method once, in the order of rows.
    pub(crate) fn methods(&self) -> Vec<Method> {
        let mut methods = Vec::new();
        for row in &self.rows {
            if !methods.contains(&row.setting.method) {
                methods.push(row.setting.method);
            }
        }
        methods
    }
}

impl<'a> Race<'a> {
    /// The rows that no other one beats, with their errors; `cost` is what a row costs.
    pub(crate) fn front(&self, cost: impl Fn(&Row) -> f64) -> Vec<(&'a Row, f64)> {
        let points: Vec<_> = self.entries.iter().map(|(row, error)| (cost(row), *error)).collect();
        front(&points).into_iter().map(|index| self.entries[index]).collect()
    }

    /// Errors to ask for, the largest first: up to `count` of 1, 2 and 5 times powers of ten, no smaller than `floor`, that
    /// some rows reach and others don't.
    pub(crate) fn levels(&self, count: usize, floor: f64) -> Vec<f64> {
        let errors = self.entries.iter().map(|(_, error)| error.max(floor));
        let [least, most] = errors.fold([f64::INFINITY, 0.0], |[a, b], error| [a.min(error), b.max(error)]);
        if least >= most {
            return Vec::new();
        }
        let decades = least.log10().floor() as i32..=most.log10().ceil() as i32;
        let mut levels: Vec<f64> = decades
            .flat_map(|decade| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(decade)))
            .filter(|level| (least..most).contains(level))
            .collect();
        levels.reverse();
        if levels.len() <= count {
            return levels;
        }
        (0..count).map(|k| levels[k * (levels.len() - 1) / (count - 1).max(1)]).collect()
    }

    /// The row that is off by no more than `error` at the least cost.
    pub(crate) fn cheapest(&self, error: f64, cost: Cost, of: impl Fn(&Row) -> bool) -> Option<&'a Row> {
        let reached = self.entries.iter().filter(|(row, own)| *own <= error && of(row)).map(|(row, _)| *row);
        reached.min_by(|a, b| cost.of(a).total_cmp(&cost.of(b)))
    }

    /// Who is the fastest to be off by no more than `error`; nobody, if no row is.
    pub(crate) fn win(&self, error: f64) -> Option<Win<'a>> {
        let fastest = self.cheapest(error, Cost::Ms, |_| true)?;
        let next = self.cheapest(error, Cost::Ms, |row| row.setting.method != fastest.setting.method);
        Some(Win { error, fastest, next })
    }
}
