//! Medians, and the format of numbers and tables.

use std::fmt;

/// A median, with the least and the greatest number.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spread {
    pub median: f64,
    pub least: f64,
    pub most: f64,
}

impl Spread {
    pub(crate) fn from_times(numbers: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = numbers.collect();
        sorted.sort_by(f64::total_cmp);
        let (Some(&least), Some(&most)) = (sorted.first(), sorted.last()) else { return Self::default() };
        Self { median: sorted[sorted.len() / 2], least, most }
    }
}

impl fmt::Display for Spread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({}..{})", ms(self.median), ms(self.least), ms(self.most))
    }
}

/// Formats ms with three or four digits.
pub(crate) fn ms(number: f64) -> String {
    let digits = if number < 1.0 {
        4
    } else if number < 10.0 {
        3
    } else if number < 100.0 {
        2
    } else {
        1
    };
    format!("{number:.digits$}")
}

/// Formats a whole number in groups of three digits.
pub(crate) fn whole(number: u64) -> String {
    let digits = number.to_string();
    let head = digits.len() % 3;
    let (first, rest) = digits.split_at(head);
    let groups = rest.as_bytes().chunks(3).map(|group| String::from_utf8_lossy(group).into_owned());
    let groups: Vec<String> =
        Some(first.to_owned()).filter(|first| !first.is_empty()).into_iter().chain(groups).collect();
    groups.join(",")
}

/// Formats `whole` divided by `part`.
pub(crate) fn ratio(whole: f64, part: f64) -> String {
    let ratio = whole / part;
    if ratio < 10.0 { format!("{ratio:.2}") } else { format!("{ratio:.1}") }
}

/// Returns a table in Markdown. `head` has the names of the columns, separated by ` | `. The first column is text, and the
/// others are numbers.
pub(crate) fn table(head: &str, rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let columns = head.split(" | ").count();
    let rule: Vec<String> = (0..columns).map(|i| if i == 0 { "---" } else { "---:" }.to_owned()).collect();
    format!("| {head} |\n") + &line(&rule) + &rows.iter().map(|row| line(row)).collect::<String>()
}

/// Returns `none` in place of a missing text.
pub(crate) fn or_none(text: Option<String>) -> String {
    text.unwrap_or_else(|| "none".to_owned())
}
