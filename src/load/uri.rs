//! Reads the URIs of buffers and images: data in the document itself, or files next to it.

use std::cell::RefCell;
use std::collections::HashSet;
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::memory_budget::Budget;
use crate::files::{FileError, Limits, read_file};
use geometry::names::on_one_line;
use geometry::progress::Progress;

/// The greatest size of a data URI, in bytes of decoded data.
const MAX_DATA: usize = 512 << 20;

/// Reads the files that a document names.
pub(super) struct Files<'a> {
    /// The document's folder.
    folder: &'a Path,
    limits: &'a Limits,
    pub budget: &'a Budget,
    pub progress: &'a Progress,
    /// The files that have been added to the budget.
    counted: RefCell<HashSet<PathBuf>>,
}

impl<'a> Files<'a> {
    pub(super) fn new(folder: &'a Path, limits: &'a Limits, budget: &'a Budget, progress: &'a Progress) -> Self {
        Self { folder, limits, budget, progress, counted: RefCell::default() }
    }

    /// Reads the bytes that a URI stands for. Their memory is held if `is_kept`, and borrowed otherwise.
    ///
    /// Files must lie in the document's folder or below it, also after links are resolved, so that a model can't make
    /// the program read other files.
    ///
    /// # Errors
    /// A clause that says what is wrong and what to do, without the URI.
    pub(super) fn read(&self, uri: &str, is_kept: bool) -> Result<Vec<u8>, String> {
        let take = |bytes| if is_kept { self.budget.hold(bytes) } else { self.budget.borrow(bytes) };
        if let Some((scheme, data)) = uri.split_at_checked(5)
            && scheme.eq_ignore_ascii_case("data:")
        {
            take(data.len() as u64)?;
            return read_data(data, MAX_DATA);
        }
        let path = self.found(&relative_path(uri)?)?;
        // A file that is too large is refused by the limit on files, even if memory is short too.
        let bytes = path.metadata().map_or(0, |about| about.len()).min(self.limits.file);
        // A file that is named many times adds to the budget once.
        if self.counted.borrow_mut().insert(path.clone()) {
            self.budget.allow(bytes);
        }
        take(bytes)?;
        read_file(&path, self.limits, |_| Ok(()), self.progress).map_err(|error: FileError| error.to_string())
    }

    /// Reads a file that another one names by a path, which may be one of Windows or of another machine: of an absolute path the last
    /// name is looked for in the folder. The memory is borrowed.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub(super) fn read_path(&self, path: &str) -> Result<Vec<u8>, String> {
        let path = path.replace('%', "%25").replace('\\', "/");
        let drive =
            path.as_bytes().get(..3).is_some_and(|start| start[0].is_ascii_alphabetic() && &start[1..] == b":/");
        // The path on somebody else's machine doesn't lead anywhere here.
        let shortened = if drive || path.starts_with('/') { path.rsplit('/').next() } else { None };
        self.read(shortened.unwrap_or(&path), false)
    }

    /// Returns the files that were read, sorted by name.
    pub(super) fn named(&self) -> Vec<PathBuf> {
        let mut named: Vec<_> = self.counted.borrow().iter().cloned().collect();
        named.sort();
        named
    }

    /// Returns the path of the file itself, with links resolved.
    fn found(&self, relative: &Path) -> Result<PathBuf, String> {
        let missing = |error: std::io::Error| {
            let reason = match error.kind() {
                ErrorKind::NotFound => "there is no such file".to_owned(),
                _ => error.to_string(),
            };
            format!("{reason}; put it where the document names it, or export as .glb")
        };
        let folder = if self.folder.as_os_str().is_empty() { Path::new(".") } else { self.folder };
        let path = folder.join(relative);
        let in_other_case = || in_other_case(&folder.canonicalize().ok()?, relative);
        let real = path.canonicalize().or_else(|error| in_other_case().ok_or(error));
        let real = real.map_err(missing)?;
        let root = folder.canonicalize().map_err(missing)?;
        if !real.starts_with(&root) {
            return Err(
                "it is a link to a file outside the document's folder, but only files in that folder and below are \
                        read; put the file itself there"
                    .to_owned(),
            );
        }
        // A pipe or a device could block for ever.
        if !real.metadata().map_err(missing)?.is_file() {
            return Err("it is not a file; name one, or export as .glb".to_owned());
        }
        Ok(real)
    }
}

/// Returns the path of a file whose name, or one of the folders that lead to it, has letters in another case than the document says. There
/// is none if several do, nor outside `root`, which is a path without links.
fn in_other_case(root: &Path, relative: &Path) -> Option<PathBuf> {
    let mut found = root.to_owned();
    for part in relative.components() {
        let exact = found.join(part);
        found = exact.canonicalize().ok().or_else(|| only_alike(&found, &part.as_os_str().to_str()?.to_lowercase()))?;
        if !found.starts_with(root) {
            return None;
        }
    }
    Some(found)
}

/// Returns the only entry of a folder that has this name in lower case, with links resolved.
fn only_alike(folder: &Path, name: &str) -> Option<PathBuf> {
    let entries = folder.read_dir().ok()?.filter_map(Result::ok);
    let mut alike = entries.filter(|entry| entry.file_name().to_str().is_some_and(|own| own.to_lowercase() == name));
    let only = alike.next()?.path();
    if alike.next().is_none() { only.canonicalize().ok() } else { None }
}

/// Returns the start of a URI for a message; data URIs are long.
pub(super) fn shown(uri: &str) -> String {
    let (start, rest) = uri.split_at(uri.char_indices().nth(60).map_or(uri.len(), |(i, _)| i));
    // Without control characters.
    let start = on_one_line(start);
    if rest.is_empty() { start } else { format!("{start}...") }
}

fn read_data(data: &str, limit: usize) -> Result<Vec<u8>, String> {
    let (header, body) = data.split_once(',').ok_or("the data URI has no comma; export the model again")?;
    let is_base64 = header.to_ascii_lowercase().ends_with(";base64");
    let size = if is_base64 { body.len() / 4 * 3 } else { body.len() };
    if size > limit {
        return Err(format!("the data URI holds {size} bytes, but at most {limit} are read; export as .glb"));
    }
    if is_base64 { base64(body) } else { Ok(percent_decoded(body)) }
}

/// Returns a URI as a relative path that can't lead outside its folder, on any system.
fn relative_path(uri: &str) -> Result<PathBuf, String> {
    let refused = |reason: &str| Err(format!("{reason}; only files in the document's folder and below are read"));
    let Ok(decoded) = String::from_utf8(percent_decoded(uri)) else {
        return Err("its name is not UTF-8 once its % signs are decoded; rename the file".to_owned());
    };
    // A colon before any slash ends a scheme, a Windows drive, or the name of a file with a hidden stream.
    if let Some((place, _)) = decoded.split('/').next().and_then(|first| first.split_once(':')) {
        return refused(&format!("it names another place, with {}:", shown(place)));
    }
    if decoded.is_empty() {
        return Err("its name is empty; export the model again".to_owned());
    }
    let path = PathBuf::from(&decoded);
    let is_inside = |part: Component| matches!(part, Component::Normal(_) | Component::CurDir);
    let faults = [
        (decoded.starts_with('/'), "it is an absolute path"),
        (decoded.contains('\\'), "it has a backslash instead of a /"),
        (decoded.contains(char::is_control), "it has a control character"),
        (decoded.contains(':'), "it has a colon"),
        (decoded.split('/').any(|part| part == ".."), "it leads out of a folder, with .."),
        (!path.components().all(is_inside), "it leads elsewhere"),
    ];
    let fault = faults.into_iter().find(|(is_wrong, _)| *is_wrong);
    fault.map_or(Ok(path), |(_, reason)| refused(reason))
}

/// Decodes %XX. A % that isn't followed by two hexadecimal digits stays.
pub fn percent_decoded(text: &str) -> Vec<u8> {
    percent_encoding::percent_decode_str(text).collect()
}

/// Base64 by RFC 4648, section 4, without the checks of how the text ends.
const FORGIVING: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_allow_trailing_bits(true)
        .with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The number of digits that are decoded at once, a multiple of 4, which limits the additional memory.
const DIGITS: usize = 4096;

/// Decodes base64. Line breaks are ignored, padding may be missing, and text after the padding is left out.
fn base64(text: &str) -> Result<Vec<u8>, String> {
    let wrong = |byte| format!("the data URI has a character that isn't base64, {byte:?}; export the model again");
    let mut decoded = Vec::with_capacity(text.len() / 4 * 3);
    let mut digits = text.bytes().filter(|byte| !byte.is_ascii_whitespace()).take_while(|&byte| byte != b'=');
    loop {
        let mut block: Vec<u8> = digits.by_ref().take(DIGITS).collect();
        if block.is_empty() {
            return Ok(decoded);
        }
        if let Some(&byte) = block.iter().find(|&&byte| !STANDARD.as_str().as_bytes().contains(&byte)) {
            return Err(wrong(char::from(byte)));
        }
        // A single digit at the end isn't a whole byte.
        if block.len() % 4 == 1 {
            block.pop();
        }
        FORGIVING.decode_vec(&block, &mut decoded).map_err(|error| error.to_string())?;
    }
}

#[cfg(test)]
mod tests {
    use base64::prelude::BASE64_STANDARD;

    use super::*;
    use proptest::prelude::*;

    #[test]
    fn known_base64() {
        for (text, bytes) in [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9v\nYmFy", "foobar")] {
            assert_eq!(base64(text), Ok(bytes.into()));
        }
        assert!(base64("Zm9*").is_err());
    }

    #[test]
    fn percent_signs() {
        assert_eq!(relative_path("a%20b/c.bin"), Ok("a b/c.bin".into()));
        assert_eq!(percent_decoded("100%_%4"), b"100%_%4");
    }

    /// Reads a file of a folder with these files, whose content is their path.
    fn read_among(files: &[&str], uri: &str) -> Result<String, String> {
        let folder = tempfile::tempdir().expect("a folder");
        for file in files {
            let path = folder.path().join(file);
            std::fs::create_dir_all(path.parent().expect("it has one")).expect("a writable folder");
            std::fs::write(path, file).expect("a writable folder");
        }
        let (limits, budget, progress) = (Limits::default(), Budget::unlimited(), Progress::new());
        let inner = folder.path().join("model");
        let bytes = Files::new(&inner, &limits, &budget, &progress).read(uri, false)?;
        Ok(String::from_utf8(bytes).expect("a path"))
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn names_that_differ_in_case_alone_are_found_if_only_one_does() {
        let files = ["model/Wood.PNG", "model/Maps/Größe.png", "model/a.png", "model/A.png", "outside.png"];
        let found = |uri: &str| read_among(&files, uri);
        assert_eq!(found("wood.png").as_deref(), Ok("model/Wood.PNG"));
        assert_eq!(found("maps/GRÖßE.png").as_deref(), Ok("model/Maps/Größe.png"));
        assert_eq!(found("A.png").as_deref(), Ok("model/A.png"), "exactly this name comes first");
        for missing in ["a.PNG", "wood.jpg", "outside.png", "maps", "wood.png/a.png"] {
            assert!(found(missing).is_err(), "{missing}");
        }
        assert!(found("maps.png").unwrap_err().starts_with("there is no such file; "));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn links_in_another_case_lead_nowhere_outside() {
        let folder = tempfile::tempdir().expect("a folder");
        let inner = folder.path().join("model");
        std::fs::create_dir(&inner).expect("a writable folder");
        std::fs::write(folder.path().join("secret.png"), "secret").expect("a writable folder");
        std::os::unix::fs::symlink("../secret.png", inner.join("Link.png")).expect("a link");
        std::os::unix::fs::symlink("..", inner.join("Up")).expect("a link");
        let (limits, budget, progress) = (Limits::default(), Budget::unlimited(), Progress::new());
        let files = Files::new(&inner, &limits, &budget, &progress);
        for uri in ["link.png", "up/secret.png", "up/Secret.png", "Up/Secret.png"] {
            assert!(files.read(uri, false).is_err(), "{uri}");
        }
    }

    #[test]
    fn only_files_below_the_folder() {
        let outside = [
            ("../a", "with .."),
            ("a/%2e%2e/b", "with .."),
            ("%2E%2e%2fa", "with .."),
            ("a/..", "with .."),
            ("/elsewhere/a", "an absolute path"),
            ("%2felsewhere/a", "an absolute path"),
            ("//host/a", "an absolute path"),
            ("file:///elsewhere/a", "with file:"),
            ("FILE:a", "with FILE:"),
            ("https://example.org/a.bin", "with https:"),
            ("C:/a.bin", "with C:"),
            ("c%3A%5Ca.bin", "with c:"),
            ("a%5C..%5Cb", "backslash"),
            ("a\\b", "backslash"),
            ("a/b.bin:c", "colon"),
            ("a%00b", "control character"),
        ];
        for (uri, reason) in outside {
            let said = relative_path(uri).unwrap_err();
            assert!(said.contains(reason) && said.ends_with("folder and below are read"), "{uri}: {said}");
        }
        assert!(relative_path("").unwrap_err().contains("empty"));
        assert!(relative_path("a/%c3%28").unwrap_err().contains("not UTF-8"));
        for uri in ["./textures/a.png", "a..b/c...d", "..a"] {
            assert!(relative_path(uri).is_ok(), "{uri}");
        }
    }

    #[test]
    fn data_has_a_limit() {
        assert_eq!(read_data("application/octet-stream;base64,Zm9v", 3), Ok(b"foo".to_vec()));
        let said = read_data(";base64,Zm9vZm9v", 5).unwrap_err();
        assert!(said.contains("holds 6 bytes, but at most 5 are read"), "{said}");
        assert_eq!(read_data(",a%20b", 5), Ok(b"a b".to_vec()));
        assert!(read_data(";base64Zm9v", 5).unwrap_err().contains("no comma"));
    }

    #[test]
    fn long_data_is_decoded_in_blocks_and_its_line_breaks_and_end_are_forgiven() {
        let bytes: Vec<u8> = (0..10_000_u32).map(|i| (i * i / 8) as u8).collect();
        let text = BASE64_STANDARD.encode(&bytes);
        let lines: Vec<&str> = text.as_bytes().chunks(76).map(|line| std::str::from_utf8(line).unwrap()).collect();
        assert_eq!(base64(&lines.join("\r\n")), Ok(bytes.clone()));
        assert_eq!(base64(text.trim_end_matches('=')), Ok(bytes.clone()));
        assert_eq!(base64("Zm9vY"), Ok(b"foo".to_vec()), "a digit alone is no byte");
        assert_eq!(base64("Zm9=Zm9v"), Ok(b"fo".to_vec()), "what follows the padding is left out");
        let said = base64(&format!("{text}*").replace('=', "")).unwrap_err();
        assert!(said.contains("isn't base64, '*'"), "{said}");
    }

    proptest! {
        #[test]
        fn base64_there_and_back(bytes in prop::collection::vec(any::<u8>(), 0..50)) {
            prop_assert_eq!(base64(&BASE64_STANDARD.encode(&bytes)), Ok(bytes));
        }
    }
}
