//! How a shader module is put together from the WGSL files of `shaders/`.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::LazyLock;

use super::shader_constants::enum_constants;
use super::wgsl_tokens::{Token, declared, tokens};

/// A shader module: the name of the file with its entry points, without `.wgsl`.
///
/// WGSL has no imports: a module is one text. Declarations may stand in any order, so it is the text of its files, one after
/// another. A file needs those that declare what it uses. Where names can't tell them, since several files declare the same ones
/// or none is used of one with more entry points, a line of the file does: `// With: name, another`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct WgslModule(pub &'static str);

/// What is known of the names in a file.
struct WgslFile {
    declared: BTreeSet<&'static str>,
    /// Names that one other file declares, and that file.
    uses: BTreeMap<&'static str, &'static str>,
    /// The files that a line of it names.
    with: BTreeSet<&'static str>,
}

/// The text of every file, after the numbers of the enums that belong to it.
static TEXTS: LazyLock<BTreeMap<&'static str, String>> = LazyLock::new(|| {
    let whole = |&(name, text): &(&'static str, &str)| (name, enum_constants(name) + text);
    shaders::TEXTS.iter().map(whole).collect()
});

static FILES: LazyLock<HashMap<&'static str, WgslFile>> = LazyLock::new(|| {
    let texts: Vec<_> = TEXTS.iter().map(|(name, text)| (*name, text.as_str(), tokens(text))).collect();
    let mut declaring: HashMap<&str, Vec<(&str, bool)>> = HashMap::new();
    // No file needs a pass.
    for (name, _, all) in texts.iter().filter(|(name, ..)| !name.starts_with("pass_")) {
        for (keyword, own) in declared(all).into_iter().filter(|(keyword, _)| keyword.text != "var") {
            declaring.entry(own.text).or_default().push((name, keyword.text == "fn"));
        }
    }
    let file = |(name, text, all): &(&'static str, &'static str, Vec<Token<'static>>)| {
        let used = used_names(all).filter_map(|(word, is_called)| match declaring.get(word).map(Vec::as_slice) {
            Some(&[(file, is_function)]) if file != *name && (is_called || !is_function) => Some((word, file)),
            _ => None,
        });
        let with = text.lines().filter_map(|line| line.strip_prefix("// With: ")).flat_map(|names| names.split(", "));
        let declared = declared(all).into_iter().map(|(_, own)| own.text).collect();
        (*name, WgslFile { declared, uses: used.collect(), with: with.collect() })
    };
    texts.iter().map(file).collect()
});

/// The names in a text that aren't those of members, and whether each is called.
fn used_names<'a>(all: &[Token<'a>]) -> impl Iterator<Item = (&'a str, bool)> {
    let text = |index: usize| all.get(index).map(|token| token.text);
    let names =
        (0..all.len()).filter(move |&index| all[index].is_word() && (index == 0 || text(index - 1) != Some(".")));
    names.map(move |index| (all[index].text, text(index + 1) == Some("(")))
}

impl WgslModule {
    /// The names of its files. Each is there once, after those that it needs.
    pub fn files(self) -> Vec<&'static str> {
        let mut files = Vec::new();
        self.add(self.0, &mut BTreeSet::new(), &mut files);
        files
    }

    fn add(self, file: &'static str, begun: &mut BTreeSet<&'static str>, files: &mut Vec<&'static str>) {
        if begun.insert(file) {
            self.needs(file).into_iter().for_each(|needed| self.add(needed, begun, files));
            files.push(file);
        }
    }

    /// The files that one of its files needs. What the one with the entry points declares isn't taken from another.
    fn needs(self, file: &str) -> BTreeSet<&'static str> {
        let (own, root) = (&FILES[file], &FILES[self.0]);
        let used = own.uses.iter().filter(|(name, _)| !own.declared.contains(*name) && !root.declared.contains(*name));
        used.map(|(_, file)| *file).chain(own.with.iter().copied()).collect()
    }

    /// Its text.
    pub fn text(self) -> String {
        joined(&self.files())
    }
}

/// One text of these files.
pub fn joined(files: &[&str]) -> String {
    files.iter().map(|name| TEXTS[name].as_str()).collect::<Vec<_>>().join("\n")
}
