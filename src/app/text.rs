//! Formats numbers and names for the window.

use std::path::Path;

pub(super) use geometry::names::shortened;
use geometry::names::shown_path;
pub(super) use geometry::numbers::{counted, grouped, short};

/// Formats a number and its share of all, in percent.
pub(super) fn part(number: u64, all: u64) -> String {
    let percent = 100.0 * number as f64 / all.max(1) as f64;
    format!("{} ({percent:.1} %)", grouped(number))
}

pub(super) fn mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}

/// Formats a factor with this many decimals. Some kinds of LOD ask for huge factors, which are shortened.
pub(super) fn factor(number: f64, decimals: usize) -> String {
    if number.abs() < 1000.0 { format!("{number:.decimals$}") } else { short(number) }
}

/// A file's name without its folder.
pub(super) fn file_name(path: &Path) -> String {
    shown_path(Path::new(path.file_name().unwrap_or(path.as_os_str())))
}

/// Reads a number that was typed, with or without its unit. The decimal separator may be a comma.
pub(super) fn typed_number(text: &str, unit: &str) -> Option<f64> {
    let text = text.trim();
    let text = text.strip_suffix(unit).unwrap_or(text).trim().replace('\u{2212}', "-").replace(',', ".");
    text.parse().ok().filter(|number: &f64| !number.is_nan())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_they_are_shown_and_as_people_write_them() {
        for text in ["0.7", "0.7 px", " 0,7px ", "7e-1"] {
            assert_eq!(typed_number(text, "px"), Some(0.7), "{text}");
        }
        assert_eq!(typed_number("\u{2212}3", ""), Some(-3.0));
        for text in ["nan", "NaN px", "", "px", "1/4", "0.7 mm", "1.000,5"] {
            assert_eq!(typed_number(text, "px"), None, "{text}");
        }
    }

    #[test]
    fn shares_factors_and_bytes_are_formatted() {
        assert_eq!([part(1234, 10000), part(0, 0)], ["1,234 (12.3 %)", "0 (0.0 %)"]);
        assert_eq!([factor(7.3125, 2), factor(64.0, 3), factor(1.5e9, 2)], ["7.31", "64.000", "1.50e9"]);
        assert_eq!(
            [counted(1, "fold"), counted(0, "crack"), counted(1200, "patch")],
            ["1 fold", "0 cracks", "1,200 patches"]
        );
        assert_eq!(mebibytes(3 << 19), "1.5 MiB");
    }
}
