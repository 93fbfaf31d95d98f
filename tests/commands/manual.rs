//! README, the manual and the other pages: their links are valid, the options that they name exist, and their
//! pictures are what their commands draw.

mod links;
mod options;
mod pictures;

use std::path::{Path, PathBuf};

/// A Markdown file of the repository.
struct Page {
    /// Relative to the repository, such as `docs/manual/lod.md`.
    name: String,
    path: PathBuf,
    text: String,
}

impl Page {
    fn read(name: &str) -> Self {
        Self::read_from(name, root().join(name))
    }

    fn read_from(name: &str, path: PathBuf) -> Self {
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
        Self { name: name.to_owned(), path, text }
    }

    /// A path that the page names, which is relative to the page.
    fn resolve(&self, target: &str) -> PathBuf {
        self.path.with_file_name("").join(target)
    }

    /// The lines without code blocks, which are fenced or indented by four spaces.
    fn prose(&self) -> Vec<&str> {
        let mut is_fenced = false;
        let outside = |line: &&str| {
            let is_fence = line.trim_start().starts_with("```");
            is_fenced ^= is_fence;
            !is_fence && !is_fenced && !line.starts_with("    ")
        };
        self.text.lines().filter(outside).collect()
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Whether the tests run in a package made by `cargo package`, which has no pictures of the stability cases: see `exclude` in
/// Cargo.toml. Cargo keeps the original manifest in every package.
fn is_package() -> bool {
    root().join("Cargo.toml.orig").exists()
}

/// Every page below `docs`, and those beside it.
fn all_pages() -> Vec<Page> {
    let mut names = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(str::to_owned).to_vec();
    let mut folders = vec!["docs".to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(root().join(&folder)).expect("a folder of pages") {
            let entry = entry.expect("a file");
            let name = format!("{folder}/{}", entry.file_name().to_str().expect("a name in UTF-8"));
            if entry.path().is_dir() {
                folders.push(name);
            } else if name.ends_with(".md") {
                names.push(name);
            }
        }
    }
    names.sort();
    assert!(names.len() > 10, "{names:?}");
    names.iter().map(|name| Page::read(name)).collect()
}

/// README and the manual.
fn user_pages() -> Vec<Page> {
    let is_for_users = |page: &Page| page.name == "README.md" || page.name.starts_with("docs/manual/");
    all_pages().into_iter().filter(is_for_users).collect()
}

#[test]
fn readme_and_architecture_are_short() {
    for (name, most) in [("README.md", 900), ("ARCHITECTURE.md", 1800)] {
        let words = Page::read(name).text.split_whitespace().count();
        assert!(words <= most, "{name} has {words} words, and at most {most} are allowed");
    }
}
