//! The names and sentences in a chart.

use super::{Method, Race, Row, Subject, Win};
use geometry::numbers::{grouped, short};
use inspect::settings::Choice;

/// The number of errors for which the fastest method is named.
const LEVELS: usize = 3;

/// Errors below these are caused by rounding: as parts of the diagonal, and in px.
const LEAST_PART: f64 = 1e-7;
const LEAST_PX: f64 = 1e-3;

impl Subject {
    /// Errors up to this count as 0.
    pub fn floor(&self) -> f64 {
        if self.reference_shape.is_some() { LEAST_PART } else { LEAST_PX }
    }

    /// The factor by which errors are multiplied to be shown: 100 for percent, or 1 for px.
    pub fn unit(&self) -> f64 {
        if self.reference_shape.is_some() { 100.0 } else { 1.0 }
    }

    /// An error in the unit in which errors are shown. As in the charts, one that is due to rounding is 0.
    pub fn shown_error(&self, error: f64) -> String {
        if error > self.floor() { short(error * self.unit()) } else { "0".into() }
    }

    /// The label of the error axis, with its unit.
    pub(crate) fn error_name(&self) -> &'static str {
        match self.reference_shape {
            Some(_) => "Largest error, % of the diagonal",
            None => "Largest error, px",
        }
    }

    /// The facts above the panels: the reference surface, the size of the view, and the adapter.
    pub fn facts(&self) -> String {
        let against = match &self.reference_shape {
            Some(reference_shape) => format!("against {reference_shape}"),
            None => "against each surface's own limit".to_owned(),
        };
        let [width, height] = self.size;
        format!("{against}; {width} x {height} px; {}", self.adapter)
    }

    /// The sentences below the panels: which method is fastest at which error, and how close the closest comes.
    pub fn sentences(&self) -> Vec<String> {
        let mut all = Vec::new();
        for race in self.races() {
            let levels = race.levels(LEVELS, self.floor());
            let wins: Vec<_> = levels.into_iter().filter_map(|level| race.win(level)).collect();
            all.extend(wins.iter().map(|win| self.says(win)));
            all.extend(self.closest(&race));
        }
        all
    }

    fn says(&self, win: &Win) -> String {
        let Win { error, fastest, next } = *win;
        let (name, ms) = (self.named(fastest), fastest.probe.time.total());
        let cost = format!("{} ms, {} triangles", short(ms), grouped(fastest.probe.triangles));
        let rest = match next {
            Some(next) => {
                let times = if ms > 0.0 { next.probe.time.total() / ms } else { 1.0 };
                format!("{times:.1} times faster than {}", self.named(next))
            }
            None => "and nothing else reaches it".to_owned(),
        };
        format!("At {} {name} is fastest: {cost}; {rest}.", self.amount(error))
    }

    /// Names the row that comes closest to the reference surface.
    fn closest(&self, race: &Race) -> Option<String> {
        self.reference_shape.as_ref()?;
        let (row, error) = race.entries.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let percent = short(error * 100.0);
        Some(format!("Closest comes {}, to {percent} % of the diagonal.", self.named(row)))
    }

    /// The name of a row's method, and its setting.
    pub fn named(&self, row: &Row) -> String {
        format!("{} ({})", self.name(row.setting.method), row.setting.label())
    }

    /// A method's name, with the partitioning and normals where other methods of the subject differ in them.
    pub fn name(&self, method: Method) -> String {
        let mut name = method.to_string();
        let others = self.methods();
        if others.iter().any(|other| other.lod == method.lod && other.partitioning != method.partitioning) {
            name += &format!(", {}", method.partitioning.name());
        }
        if others.iter().any(|other| other.normals != method.normals) {
            name += &format!(", {} normals", method.normals.name());
        }
        name
    }

    /// An error with its unit.
    fn amount(&self, error: f64) -> String {
        match self.reference_shape {
            Some(_) => format!("{} % of the diagonal", plain(error * 100.0)),
            None => format!("{} px", plain(error)),
        }
    }
}

/// Formats a number with one significant digit.
pub(super) fn plain(number: f64) -> String {
    let digit = (number.log10() + 1e-9).floor();
    if !(-6.0..6.0).contains(&digit) {
        return format!("{number:.0e}");
    }
    let decimals = (-digit).max(0.0) as usize;
    format!("{number:.decimals$}")
}
