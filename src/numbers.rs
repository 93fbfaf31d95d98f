//! Numbers as people read them, in the window and on pages.

/// With a comma between thousands.
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

/// Three significant digits, in scientific notation where plain digits would be long.
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

/// Two decimals, for a column of px or ms: 0 as 0, and what is less than the decimals show as that.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!([grouped(0), grouped(999), grouped(31600), grouped(1234567)], ["0", "999", "31,600", "1,234,567"]);
        assert_eq!([short(0.0), short(0.0123456), short(1.5), short(1234.5)], ["0", "0.0123", "1.50", "1234"]);
        assert_eq!([short(1.25e-7), short(123456.0)], ["1.25e-7", "1.23e5"]);
        assert_eq!([hundredths(0.0), hundredths(1e-9), hundredths(0.0149)], ["0", "< 0.01", "0.01"]);
        assert_eq!([hundredths(7.999), hundredths(1234.5), hundredths(2e7)], ["8.00", "1,234.50", "2.00e7"]);
        assert_eq!(hundredths(f64::INFINITY), "inf");
    }
}
