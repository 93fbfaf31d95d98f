//! Building blocks of the Markdown pages that commands write.

use geometry::names::joined;

/// Formats a table. The columns whose indices are in `words` are aligned to the left, all others to the right.
pub fn table(columns: &[&str], words: &[usize], rows: &[Vec<String>]) -> String {
    let line = |cells: &mut dyn Iterator<Item = &str>| {
        let cell = |text: &str| if text.is_empty() { " |".to_owned() } else { format!(" {text} |") };
        format!("|{}\n", cells.map(cell).collect::<String>())
    };
    let mut text = line(&mut columns.iter().copied());
    text += &line(&mut (0..columns.len()).map(|column| if words.contains(&column) { "---" } else { "---:" }));
    text.extend(rows.iter().map(|row| line(&mut row.iter().map(String::as_str))));
    text
}

/// Joins words with commas, and with "and" before the last.
pub fn listed(words: &[String]) -> String {
    joined(words, "and")
}

/// Escapes a text so that Markdown shows all its characters as they are.
pub fn plain(text: &str) -> String {
    let mut out = String::new();
    for letter in text.chars() {
        if matches!(letter, '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '|' | '#') {
            out.push('\\');
        }
        out.push(letter);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_aligned_left_and_numbers_right() {
        let text = table(&["", "n"], &[0], &[vec!["a".into(), "1".into()], vec![String::new(), "22".into()]]);
        assert_eq!(text, "| | n |\n| --- | ---: |\n| a | 1 |\n| | 22 |\n");
    }

    #[test]
    fn words_are_joined_with_and_and_special_characters_are_escaped() {
        let words = ["a", "b", "c"].map(str::to_owned);
        assert_eq!([listed(&words[..1]), listed(&words[..2]), listed(&words)], ["a", "a and b", "a, b and c"]);
        assert_eq!(plain("low_poly|2.glb"), "low\\_poly\\|2.glb");
    }
}
