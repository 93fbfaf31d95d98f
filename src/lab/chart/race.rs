//! Compares rows by their cost and error: which ones no other row beats, and which method reaches an error fastest.

use super::{Method, Probe, Row, Subject, distinct};
use geometry::choice::texts;
use geometry::tessellate::Surface;

texts! {
    /// A cost of a setting: time in ms, or triangles.
    #[derive(Default)]
    pub enum Cost, fn name {
        #[default]
        Ms => "Tessellation and drawing, ms",
        Triangles => "Triangles",
    }
}

impl Cost {
    pub fn of(self, probe: &Probe) -> f64 {
        match self {
            Self::Ms => probe.time.total(),
            Self::Triangles => probe.triangles as f64,
        }
    }
}

/// The rows of a mesh that can be compared, with their errors. With a reference surface these are all rows. Without one they
/// are the rows of one surface, since each surface is compared with its own limit.
#[derive(Clone, Debug)]
pub struct Race<'a> {
    /// The surface of all rows; `None` with a reference surface.
    pub surface: Option<Surface>,
    pub entries: Vec<(&'a Row, f64)>,
}

/// The row that reaches an error fastest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Win<'a> {
    pub error: f64,
    pub fastest: &'a Row,
    /// The fastest row of another method; `None` if no other method reaches the error.
    pub next: Option<&'a Row>,
}

/// Returns the front of points with a cost and an error: the indices of the points that no other one beats, by growing cost.
/// Each has less error than all points that cost as much or less. Of equal points the front has the first.
pub fn front(points: &[(f64, f64)]) -> Vec<usize> {
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

/// A setting must have this many times the triangles of a coarser one to show that finer settings come no closer.
const FINER: u64 = 3;

/// An error that falls by more than this part of it counts as closer.
const CLOSER: f64 = 0.05;

/// Whether a method has come as close as it gets, so that finer settings cost more and show nothing new. Of its rows, from
/// coarse to fine, the last must have three times the triangles of another, and each of its errors must be less by at most a
/// twentieth. The distance between triangles and their surface falls at least as fast as their number grows, so finer settings
/// can gain at most half of that twentieth.
pub fn has_converged(rows: &[Row], method: Method) -> bool {
    let mut own = rows.iter().rev().filter(|row| row.setting.method == method);
    let Some(last) = own.next() else { return false };
    let errors = |row: &Row| {
        let [largest, rms, degrees] =
            row.probe.errors.map_or([0.0; 3], |errors| [errors.largest.at_least, errors.rms, errors.normal_degrees]);
        [largest, rms, degrees, row.probe.max_error_px.unwrap_or(0.0)]
    };
    let is_no_closer = |earlier: &Row| {
        let pairs = errors(earlier).into_iter().zip(errors(last));
        pairs.into_iter().all(|(before, now)| now >= (1.0 - CLOSER) * before)
    };
    own.any(|row| row.probe.triangles.saturating_mul(FINER) <= last.probe.triangles && is_no_closer(row))
}

impl Subject {
    /// The rows whose errors are known, grouped so that those of a group can be compared.
    pub fn races(&self) -> Vec<Race<'_>> {
        let mut races: Vec<Race> = Vec::new();
        for (row, error) in self.rows.iter().filter_map(|row| Some((row, self.error(&row.probe)?))) {
            let surface = self.reference_shape.is_none().then_some(row.setting.method.surface);
            match races.iter_mut().find(|race| race.surface == surface) {
                Some(race) => race.entries.push((row, error)),
                None => races.push(Race { surface, entries: vec![(row, error)] }),
            }
        }
        races
    }

    /// All methods, in the order of their first rows.
    pub fn methods(&self) -> Vec<Method> {
        distinct(self.rows.iter().map(|row| row.setting.method))
    }
}

impl<'a> Race<'a> {
    /// The rows that no other one beats, with their errors. `cost` returns the cost of a row.
    pub fn front(&self, cost: impl Fn(&Row) -> f64) -> Vec<(&'a Row, f64)> {
        let points: Vec<_> = self.entries.iter().map(|(row, error)| (cost(row), *error)).collect();
        front(&points).into_iter().map(|index| self.entries[index]).collect()
    }

    /// Errors that some rows reach and others don't, the largest first: up to `count` numbers that are 1, 2 or 5 times a power
    /// of ten, and not smaller than `floor`.
    pub fn levels(&self, count: usize, floor: f64) -> Vec<f64> {
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

    /// The cheapest row that `of` accepts, with an error of at most `error`.
    pub fn cheapest(&self, error: f64, cost: Cost, of: impl Fn(&Row) -> bool) -> Option<&'a Row> {
        let reached = self.entries.iter().filter(|(row, own)| *own <= error && of(row)).map(|(row, _)| *row);
        reached.min_by(|a, b| cost.of(&a.probe).total_cmp(&cost.of(&b.probe)))
    }

    /// The fastest row with an error of at most `error`; `None` if there is none.
    pub(crate) fn win(&self, error: f64) -> Option<Win<'a>> {
        let fastest = self.cheapest(error, Cost::Ms, |_| true)?;
        let next = self.cheapest(error, Cost::Ms, |row| row.setting.method != fastest.setting.method);
        Some(Win { error, fastest, next })
    }
}
