//! Formats numbers and times for people.

use std::time::{SystemTime, UNIX_EPOCH};

/// Formats a number of things, as "1 fold" or "947 folds".
pub fn counted(number: u64, thing: &str) -> String {
    let plural = match number {
        1 => "",
        _ if thing.ends_with("ch") || thing.ends_with("sh") => "es",
        _ => "s",
    };
    format!("{} {thing}{plural}", grouped(number))
}

/// Puts a number into a text, in which `#` stands for it. Of `[one|several]` the part stays that suits the number.
pub fn numbered(number: u64, text: &str) -> String {
    // Of three parts one is text for any number, one for 1 and one for others.
    let left_out = if number == 1 { 2 } else { 1 };
    let parts = text.split(['[', '|', ']']).enumerate().filter(|(index, _)| index % 3 != left_out);
    parts.map(|(_, part)| part).collect::<String>().replace('#', &grouped(number))
}

/// Formats a number with commas between groups of three digits.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Formats a number with three significant digits; numbers below 0.001 or from 10,000 on are in scientific notation.
pub fn short(number: f64) -> String {
    let magnitude = number.abs();
    if number == 0.0 {
        "0".into()
    } else if (1e-3..1e4).contains(&magnitude) {
        let decimals = (2 - magnitude.log10().floor() as i32).clamp(0, 5) as usize;
        format!("{number:.decimals$}")
    } else {
        format!("{number:.2e}")
    }
}

/// Formats an f32 with all its digits; numbers below 1e-5 or from 1e9 on are in scientific notation.
pub fn exact(number: f32) -> String {
    if number == 0.0 || (1e-5..1e9).contains(&number.abs()) { number.to_string() } else { format!("{number:e}") }
}

/// Formats a number that isn't negative with two decimals, for columns of px or ms. Returns "0" for 0 and "< 0.01" for
/// any smaller number.
pub fn hundredths(number: f64) -> String {
    if number == 0.0 {
        "0".into()
    } else if number < 0.01 {
        "< 0.01".into()
    } else if number < 1e6 {
        let hundredths = (100.0 * number).round() as u64;
        format!("{}.{:02}", grouped(hundredths / 100), hundredths % 100)
    } else {
        short(number)
    }
}

/// Formats a time as date, hour and minute, in UTC.
pub fn utc(moment: SystemTime) -> String {
    let seconds = moment.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (days, minutes) = (seconds / 86_400, seconds / 60 % 1440);
    let (year, month, day) = date(days);
    format!("{year}-{month:02}-{day:02} {:02}:{:02} UTC", minutes / 60, minutes % 60)
}

/// Returns the year, month and day that lie `days` after 1 January 1970. The calculation counts years from March, so
/// that a leap day is the last day of its year.
fn date(days: u64) -> (u64, u64, u64) {
    /// Days from 1 March of the year 0 to 1 January 1970.
    const BEFORE: u64 = 719_468;
    /// Days in 400 years.
    const ERA: u64 = 146_097;
    let days = days + BEFORE;
    let (era, day) = (days / ERA, days % ERA);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    (400 * era + year + next, month, day)
}

/// One unit in the last place of a coordinate, in the coordinate's own units.
pub fn ulp_at(coordinate: f32) -> f64 {
    f64::from(coordinate.next_up()) - f64::from(coordinate)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn exact_numbers_have_all_digits_and_no_rows_of_zeros() {
        assert_eq!([0.0, -0.1, 12345.679, 1e36, 1.5e-7].map(exact), ["0", "-0.1", "12345.679", "1e36", "1.5e-7"]);
    }

    #[test]
    fn days_have_their_dates() {
        let at = |seconds: u64| utc(UNIX_EPOCH + Duration::from_secs(seconds));
        assert_eq!([at(0), at(951_782_399)], ["1970-01-01 00:00 UTC", "2000-02-28 23:59 UTC"]);
        assert_eq!([at(951_782_400), at(951_868_800)], ["2000-02-29 00:00 UTC", "2000-03-01 00:00 UTC"]);
        assert_eq!([at(1_798_761_599), at(4_107_542_400)], ["2026-12-31 23:59 UTC", "2100-03-01 00:00 UTC"]);
    }

    #[test]
    fn a_number_decides_the_words_around_it() {
        let text = "# patch[ is|es are] far from [its|their] surface";
        assert_eq!(numbered(1, text), "1 patch is far from its surface");
        assert_eq!([0, 1000].map(|n| numbered(n, "take # byte[|s]")), ["take 0 bytes", "take 1,000 bytes"]);
        assert_eq!([1, 2].map(|n| numbered(n, "# px show[s|]")), ["1 px shows", "2 px show"]);
    }

    #[test]
    fn numbers_are_grouped_and_rounded() {
        assert_eq!([grouped(0), grouped(999), grouped(31600), grouped(1234567)], ["0", "999", "31,600", "1,234,567"]);
        assert_eq!([short(0.0), short(0.0123456), short(1.5), short(1234.5)], ["0", "0.0123", "1.50", "1234"]);
        assert_eq!([short(1.25e-7), short(123456.0)], ["1.25e-7", "1.23e5"]);
        assert_eq!([hundredths(0.0), hundredths(1e-9), hundredths(0.0149)], ["0", "< 0.01", "0.01"]);
        assert_eq!([hundredths(7.999), hundredths(1234.5), hundredths(2e7)], ["8.00", "1,234.50", "2.00e7"]);
        assert_eq!(hundredths(f64::INFINITY), "inf");
    }
}
