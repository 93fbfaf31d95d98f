//! What hostile files get, as pages to read: `docs/hostile/`. `PNAEN_UPDATE_PAGES=1` writes them again.

use std::path::Path;

use crate::markdown::{plain, table};

/// Bytes that are shown of a longer file.
const START: usize = 32;
const END: usize = 48;

/// Holds a page against the one that is kept: its title, and a row a file, in Markdown, with what it gets.
pub fn hold(name: &str, title: &str, rows: &[(String, String)]) {
    let rows: Vec<_> = rows.iter().map(|(file, gets)| vec![file.clone(), plain(gets)]).collect();
    let text = format!(
        "# {title}\n\n{} files that the tests make. Each gets what stands beside it, within a second, word for word.\n\n{}",
        rows.len(),
        table(&["file", "gets"], &[0, 1], &rows)
    );
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/hostile").join(name);
    if std::env::var_os("PNAEN_UPDATE_PAGES").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    assert!(std::fs::read_to_string(&path).is_ok_and(|kept| kept == text), "{name} says something else");
}

/// A file on one line, in Markdown: all of it, or how it starts and ends.
pub fn shown(bytes: &[u8]) -> String {
    let line = |bytes: &[u8]| bytes.escape_ascii().to_string().replace('|', "\\|");
    match bytes.len() {
        0 => "nothing".to_owned(),
        length if length <= START + END => format!("`{}`", line(bytes)),
        length => format!("`{}` ... `{}`", line(&bytes[..START]), line(&bytes[length - END..])),
    }
}
