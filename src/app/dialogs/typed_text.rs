//! What people type or paste as a path: with quotes around it, as a URI of a file, or with ~ for their home folder.

use std::path::{MAIN_SEPARATOR, Path, is_separator};

use load::percent_decoded;

pub(super) fn path_of(text: &str) -> String {
    let text = text.trim();
    let quoted = ['"', '\''].iter().find_map(|quote| text.strip_prefix(*quote)?.strip_suffix(*quote));
    let text = quoted.unwrap_or(text);
    if let Some(uri) = text.strip_prefix("file://") {
        let path = uri.strip_prefix("localhost").unwrap_or(uri);
        // Before a drive of Windows there is a slash.
        let path = path.strip_prefix('/').filter(|path| path.as_bytes().get(1) == Some(&b':')).unwrap_or(path);
        return String::from_utf8_lossy(&percent_decoded(path)).into_owned();
    }
    match (text.strip_prefix('~'), std::env::home_dir()) {
        (Some(rest), Some(home)) if rest.is_empty() || rest.starts_with(is_separator) => {
            format!("{}{rest}", home.display())
        }
        _ => text.to_owned(),
    }
}

/// How a path that is being typed may go on.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Completion {
    /// The text with as much of a name added as all names in its folder that begin like it share; none if that is nothing.
    pub text: Option<String>,
    /// These names, sorted.
    pub names: Vec<String>,
}

/// How a path may go on.
pub(super) fn completion(text: &str) -> Completion {
    // A quote that isn't closed yet is kept, and closed after the name of a file.
    let opening = ['"', '\'']
        .into_iter()
        .find(|quote| text.trim().starts_with(*quote) && text.trim().matches(*quote).count() == 1);
    let path = path_of(opening.map_or(text, |quote| text.trim().trim_start_matches(quote)));
    let start = path.rfind(is_separator).map_or(0, |at| at + 1);
    let (folder, begun) = path.split_at(start);
    let entries = std::fs::read_dir(if folder.is_empty() { Path::new(".") } else { Path::new(folder) });
    let names = entries.into_iter().flatten().flatten().filter_map(|entry| {
        let mut name = entry.file_name().into_string().ok()?;
        // Hidden files are meant only by those who begin with their dot.
        if !name.starts_with(begun) || (begun.is_empty() && name.starts_with('.')) {
            return None;
        }
        name.extend(entry.path().is_dir().then_some(MAIN_SEPARATOR));
        Some(name)
    });
    let mut names: Vec<String> = names.collect();
    names.sort();
    let both = |a: String, b: String| a.chars().zip(b.chars()).take_while(|(a, b)| a == b).map(|(a, _)| a).collect();
    let shared = names.iter().cloned().reduce(both).filter(|shared| shared.len() > begun.len());
    let text = shared.map(|shared| {
        let is_whole = names.len() == 1 && !shared.ends_with(MAIN_SEPARATOR);
        let quote = opening.map(String::from).unwrap_or_default();
        format!("{quote}{folder}{shared}{}", if is_whole { quote.as_str() } else { "" })
    });
    Completion { text, names }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_uris_and_the_home_folder_are_understood() {
        let home = std::env::home_dir().expect("a home folder").display().to_string();
        for (typed, path) in [
            (" /models/vase.glb ", "/models/vase.glb".to_owned()),
            ("\"/my models/vase.glb\"", "/my models/vase.glb".to_owned()),
            ("'/my models/vase.glb'", "/my models/vase.glb".to_owned()),
            ("file:///my%20models/50%25.glb", "/my models/50%.glb".to_owned()),
            ("file://localhost/vase.glb", "/vase.glb".to_owned()),
            ("file:///C:/models/vase.glb", "C:/models/vase.glb".to_owned()),
            ("~", home.clone()),
            ("~/vase.glb", format!("{home}/vase.glb")),
            ("~vase.glb", "~vase.glb".to_owned()),
            ("shape:torus", "shape:torus".to_owned()),
            ("\"", "\"".to_owned()),
        ] {
            assert_eq!(path_of(typed), path, "{typed}");
        }
    }

    #[test]
    fn names_are_completed_as_far_as_they_agree() {
        let folder = tempfile::tempdir().expect("a writable temporary folder");
        let at = |name: &str| folder.path().join(name).display().to_string();
        for name in ["vase-a.glb", "vase-b.glb", "torus.obj", ".hidden"] {
            std::fs::write(at(name), "").expect("a writable temporary folder");
        }
        std::fs::create_dir(at("models")).expect("a writable temporary folder");
        let completed = |text: &str| completion(text).text;
        assert_eq!(completed(&at("v")), Some(at("vase-")));
        assert_eq!(completed(&at("vase-")), None, "both go on differently");
        assert_eq!(completed(&at("vase-b")), Some(at("vase-b.glb")));
        assert_eq!(completed(&at("m")), Some(at("models") + &String::from(MAIN_SEPARATOR)));
        assert_eq!(completed(&at(".h")), Some(at(".hidden")));
        assert_eq!(completed(&at("x")), None);
        assert_eq!(completed(&at("nowhere/x")), None);
        assert_eq!(completion(&at("vase-")).names, ["vase-a.glb", "vase-b.glb"]);
        assert_eq!(completion(&at("nowhere/x")), Completion::default());
        for quote in ["\"", "'"] {
            assert_eq!(completed(&format!("{quote}{}", at("v"))), Some(format!("{quote}{}", at("vase-"))));
            assert_eq!(completed(&format!(" {quote}{}", at("t"))), Some(format!("{quote}{}{quote}", at("torus.obj"))));
        }
    }
}
