//! Numbers and names as people read them.

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

/// A number and its share of all.
pub fn part(number: u64, all: u64) -> String {
    let percent = 100.0 * number as f64 / all.max(1) as f64;
    format!("{} ({percent:.1} %)", grouped(number))
}

/// Bytes in MiB.
pub fn mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
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

/// A name that someone else gave, in so many characters at most.
pub fn shortened(name: &str, most: usize) -> String {
    if name.chars().count() <= most {
        return name.to_owned();
    }
    name.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}

/// A factor with so many decimals; some forms of LOD ask for huge ones.
pub fn factor(number: f64, decimals: usize) -> String {
    if number.abs() < 1000.0 { format!("{number:.decimals$}") } else { short(number) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!([grouped(0), grouped(999), grouped(31600), grouped(1234567)], ["0", "999", "31,600", "1,234,567"]);
        assert_eq!([part(1234, 10000), part(0, 0)], ["1,234 (12.3 %)", "0 (0.0 %)"]);
        assert_eq!([short(0.0), short(0.0123456), short(1.5), short(1234.5)], ["0", "0.0123", "1.50", "1234"]);
        assert_eq!([short(1.25e-7), short(123456.0)], ["1.25e-7", "1.23e5"]);
        assert_eq!([factor(7.3125, 2), factor(64.0, 3), factor(1.5e9, 2)], ["7.31", "64.000", "1.50e9"]);
        assert_eq!([shortened("Walk", 4), shortened("Walking", 4)], ["Walk", "Wal…"]);
        assert_eq!(mebibytes(3 << 19), "1.5 MiB");
    }
}
