//! The pages in `docs/hostile/`, which list hostile files with the answer that each gets. `PNAEN_UPDATE_PAGES=1` writes them.

use std::path::Path;

use crate::markdown::{plain, table};

/// How many bytes of a longer file are shown from its start, and from its end.
const START: usize = 32;
const END: usize = 48;

/// Compares a page with the stored one. Each row has a file, in Markdown, and the answer that it gets.
pub(crate) fn hold(name: &str, title: &str, rows: &[(String, String)]) {
    hold_with(name, title, rows, &[]);
}

/// Does the same with a page that also says why some of the files are refused, although others open them.
pub(crate) fn hold_with(name: &str, title: &str, rows: &[(String, String)], alone: &[(String, &str)]) {
    let rows: Vec<_> = rows.iter().map(|(file, gets)| vec![file.clone(), plain(gets)]).collect();
    let mut text = format!(
        "# {title}\n\n{} files that the tests make. Each gets the answer beside it, word for word, within a second.\n\n{}",
        rows.len(),
        table(&["file", "answer"], &[0, 1], &rows)
    );
    if !alone.is_empty() {
        let rows: Vec<_> = alone.iter().map(|(file, why)| vec![file.clone(), plain(why)]).collect();
        text += "\n## Refused here, though others open them\n\nAt least two of trimesh 5.2.0, PyMeshLab 2025.7 and f3d 1.3.1 show \
                 triangles of these files. Of the others that are refused, at most one of the three does. \
                 FBX files, which none of them reads, OFF and 3MF files, files above 30 MB, and files beside a document were not tried.\n\n";
        text += &table(&["file", "why it is refused"], &[0, 1], &rows);
    }
    let path = documents::in_repository("docs/hostile").join(name);
    if std::env::var_os("PNAEN_UPDATE_PAGES").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    assert!(
        std::fs::read_to_string(&path).is_ok_and(|kept| kept == text),
        "{name} has other sentences; PNAEN_UPDATE_PAGES=1 writes it"
    );
}

/// Writes a table's file into the folder that `PNAEN_HOSTILE` names, if it does, for a comparison with other programs.
pub(crate) fn keep(name: &str, bytes: &[u8]) {
    if let Some(folder) = std::env::var_os("PNAEN_HOSTILE") {
        std::fs::create_dir_all(&folder).expect("a folder that can be made");
        std::fs::write(Path::new(&folder).join(name), bytes).expect("a file that can be written");
    }
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
