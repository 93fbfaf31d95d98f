//! The pages in `docs/hostile/`, which list hostile files with the answer that each gets. `PNAEN_UPDATE_PAGES=1` writes them.

use std::path::Path;

use crate::markdown::{plain, table};

/// How many bytes of a longer file are shown from its start, and from its end.
const START: usize = 32;
const END: usize = 48;

/// Compares a page with the stored one. Each row has a file, in Markdown, and the answer that it gets.
pub(crate) fn hold(name: &str, title: &str, rows: &[(String, String)]) {
    let rows: Vec<_> = rows.iter().map(|(file, gets)| vec![file.clone(), plain(gets)]).collect();
    let text = format!(
        "# {title}\n\n{} files that the tests make. Each gets the answer beside it, word for word, within a second.\n\n{}",
        rows.len(),
        table(&["file", "answer"], &[0, 1], &rows)
    );
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/hostile").join(name);
    if std::env::var_os("PNAEN_UPDATE_PAGES").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    assert!(
        std::fs::read_to_string(&path).is_ok_and(|kept| kept == text),
        "{name} has other sentences; PNAEN_UPDATE_PAGES=1 writes it"
    );
}

/// Formats a file on one line, in Markdown: all of it, or its start and end.
pub(crate) fn shown(bytes: &[u8]) -> String {
    let line = |bytes: &[u8]| bytes.escape_ascii().to_string().replace('|', "\\|");
    match bytes.len() {
        0 => "nothing".to_owned(),
        length if length <= START + END => format!("`{}`", line(bytes)),
        length => format!("`{}` ... `{}`", line(&bytes[..START]), line(&bytes[length - END..])),
    }
}
