//! Holds the structure within the crates: no files import each other. What a crate may import is in its manifest.
//!
//! Modules side by side don't import each other in a circle, whether directly or through modules below them; a module and those
//! inside it may. Test modules may import what they like.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::LazyLock;

use syn::visit::Visit;
use syn::{Item, UseTree};

/// The crates, by the folders of their code below `src`. The package's own is the last.
const CRATES: [(&str, &str); 6] =
    [("geometry", "geometry"), ("gpu", "gpu"), ("load", "load"), ("inspect", "inspect"), ("lab", "lab"), ("pnaen", "")];

/// A module's path, such as `["geometry", "mesh", "topology"]`.
type ModulePath = Vec<String>;

/// What a module's file says.
#[derive(Default)]
struct Module {
    /// Every path that it names, from the crate, through `use` or in its code.
    paths: BTreeSet<ModulePath>,
    /// What it hands on under a name: the path that the name stands for.
    reexports: BTreeMap<String, ModulePath>,
}

/// All modules but those of tests.
static MODULES: LazyLock<BTreeMap<ModulePath, Module>> = LazyLock::new(|| {
    let mut modules = BTreeMap::new();
    for (name, folder) in CRATES {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(folder);
        read_module(&source.join("lib.rs"), &source, vec![name.to_owned()], &mut modules);
    }
    modules
});

/// Reads a module's file, and those of the modules that it declares, which lie in `folder`.
fn read_module(file: &Path, folder: &Path, path: ModulePath, modules: &mut BTreeMap<ModulePath, Module>) {
    let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    let parsed = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    let mut reader = Reader { path: &path, module: Module::default(), children: Vec::new() };
    reader.visit_file(&parsed);
    let Reader { module, children, .. } = reader;
    modules.insert(path.clone(), module);
    for child in children {
        let below = folder.join(&child);
        let candidates = [folder.join(format!("{child}.rs")), below.join("mod.rs")];
        let child_file = candidates.iter().find(|candidate| candidate.is_file());
        let child_file = child_file.unwrap_or_else(|| panic!("no file of module {child} in {}", folder.display()));
        read_module(child_file, &below, path.iter().cloned().chain([child]).collect(), modules);
    }
}

/// Collects what a file names.
struct Reader<'a> {
    path: &'a ModulePath,
    module: Module,
    children: Vec<String>,
}

impl Reader<'_> {
    /// A path from a crate; none if it leads to one that isn't ours.
    fn path_in_crate(&self, segments: &[String]) -> Option<ModulePath> {
        let mut base = match segments.first()?.as_str() {
            "crate" => self.path[..1].to_vec(),
            "self" | "super" => self.path.clone(),
            first if self.children.iter().any(|child| child == first) => {
                return Some(self.path.iter().cloned().chain(segments.iter().cloned()).collect());
            }
            first if CRATES.iter().any(|(name, _)| *name == first) => return Some(segments.to_vec()),
            _ => return None,
        };
        let mut rest = segments;
        while let Some((first, tail)) = rest.split_first() {
            match first.as_str() {
                "crate" | "self" => {}
                "super" => drop(base.pop()),
                _ => break,
            }
            rest = tail;
        }
        Some(base.into_iter().chain(rest.iter().cloned()).collect())
    }

    fn add_use(&mut self, before: &mut Vec<String>, tree: &UseTree, is_public: bool) {
        let mut add = |before: &[String], last: &str, name: String| {
            let segments: Vec<String> = before.iter().cloned().chain([last.to_owned()]).collect();
            let segments = if last == "self" { before.to_vec() } else { segments };
            let Some(path) = self.path_in_crate(&segments) else { return };
            if is_public {
                self.module.reexports.insert(name, path.clone());
            }
            self.module.paths.insert(path);
        };
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.add_use(before, &path.tree, is_public);
                before.pop();
            }
            UseTree::Name(name) => add(before, &name.ident.to_string(), name.ident.to_string()),
            UseTree::Rename(rename) => add(before, &rename.ident.to_string(), rename.rename.to_string()),
            UseTree::Glob(_) => add(before, "self", String::new()),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.add_use(before, tree, is_public)),
        }
    }
}

/// Whether an item is compiled for tests only.
fn is_for_tests(item: &Item) -> bool {
    let attributes = match item {
        Item::Mod(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        _ => return false,
    };
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg") && attribute.parse_args::<syn::Path>().is_ok_and(|path| path.is_ident("test"))
    })
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_file(&mut self, file: &'ast syn::File) {
        let declared = file.items.iter().filter(|item| !is_for_tests(item)).filter_map(|item| match item {
            Item::Mod(item) if item.content.is_none() => Some(item.ident.to_string()),
            _ => None,
        });
        self.children = declared.collect();
        file.items.iter().for_each(|item| self.visit_item(item));
    }

    fn visit_item(&mut self, item: &'ast Item) {
        if !is_for_tests(item) {
            syn::visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        let is_public = !matches!(item.vis, syn::Visibility::Inherited);
        self.add_use(&mut Vec::new(), &item.tree, is_public);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let segments: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if segments.len() > 1 {
            self.module.paths.extend(self.path_in_crate(&segments));
        }
        syn::visit::visit_path(self, path);
    }
}

/// The module that declares what a path names, through as many re-exports as there are.
fn declared_in(modules: &BTreeMap<ModulePath, Module>, path: &[String]) -> ModulePath {
    let mut path = path.to_vec();
    // A re-export of a re-export; more than a few in a row would be a circle.
    for _ in 0..8 {
        let depth = (1..=path.len()).rev().find(|&depth| modules.contains_key(&path[..depth])).expect("a crate");
        let module = &modules[&path[..depth]];
        let Some(target) = path.get(depth).and_then(|name| module.reexports.get(name)) else {
            return path[..depth].to_vec();
        };
        path = target.iter().chain(&path[depth + 1..]).cloned().collect();
    }
    panic!("{} is re-exported in a circle", path.join("::"));
}

/// Which module imports from which, by the modules that declare what is imported.
fn imports() -> BTreeSet<(ModulePath, ModulePath)> {
    let modules = &*MODULES;
    let mut imports = BTreeSet::new();
    for (from, module) in modules {
        let own: BTreeSet<&ModulePath> = module.reexports.values().collect();
        // What a module hands on from its own insides is no import of its own.
        for path in module.paths.iter().filter(|path| !(own.contains(path) && path.starts_with(from))) {
            let to = declared_in(modules, path);
            if to != *from {
                imports.insert((from.clone(), to));
            }
        }
    }
    imports
}

/// Items that import each other in a circle, if there are any.
fn circle(arrows: &BTreeSet<(String, String)>) -> Vec<String> {
    let mut left: BTreeSet<&String> = arrows.iter().flat_map(|(from, to)| [from, to]).collect();
    loop {
        let stays = |(from, to): &&(String, String)| left.contains(from) && left.contains(to);
        let [from, to]: [BTreeSet<&String>; 2] = [
            arrows.iter().filter(stays).map(|(from, _)| from).collect(),
            arrows.iter().filter(stays).map(|(_, to)| to).collect(),
        ];
        // Whoever imports nothing that is left, or is imported by nothing that is left, is in no circle.
        let before = left.len();
        left.retain(|item| from.contains(item) && to.contains(item));
        if left.len() == before {
            return left.into_iter().cloned().collect();
        }
    }
}

#[test]
fn modules_side_by_side_import_each_other_in_no_circle() {
    let mut levels: BTreeMap<ModulePath, BTreeSet<(String, String)>> = BTreeMap::new();
    for (from, to) in imports() {
        let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
        if let (Some(own), Some(other)) = (from.get(shared), to.get(shared)) {
            levels.entry(from[..shared].to_vec()).or_default().insert((own.clone(), other.clone()));
        }
    }
    let circles = levels.iter().map(|(level, arrows)| (level, circle(arrows))).filter(|(_, circle)| !circle.is_empty());
    let said: Vec<String> =
        circles.map(|(level, circle)| format!("{}: {}", level.join("::"), circle.join(", "))).collect();
    assert!(said.is_empty(), "modules that import each other in a circle:\n{}", said.join("\n"));
}

#[test]
fn a_circle_is_found_and_a_chain_is_none() {
    let arrows = |pairs: &[(&str, &str)]| pairs.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect();
    assert!(circle(&arrows(&[("a", "b"), ("b", "c"), ("a", "c")])).is_empty());
    assert_eq!(circle(&arrows(&[("a", "b"), ("b", "c"), ("c", "b"), ("c", "d")])), ["b", "c"]);
}

#[test]
fn a_reexport_leads_to_where_it_is_declared() {
    let path = |text: &str| -> ModulePath { text.split("::").map(str::to_owned).collect() };
    assert_eq!(declared_in(&MODULES, &path("geometry::mesh::Topology")), path("geometry::mesh::topology"));
    assert_eq!(declared_in(&MODULES, &path("geometry::mesh::rig::Clip")), path("geometry::mesh::rig::clip"));
    assert_eq!(declared_in(&MODULES, &path("geometry::mesh::Mesh")), path("geometry::mesh"));
}

#[test]
fn plain_commands_of_cargo_are_for_all_crates() {
    let manifest = include_str!("../Cargo.toml");
    let list = |name: &str| {
        let line = manifest.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(" = ["));
        let names = line.and_then(|line| line.strip_suffix(']')).expect("a list on one line").split(", ");
        names.map(str::to_owned).collect::<BTreeSet<_>>()
    };
    let own = "\".\"".to_owned();
    assert_eq!(list("default-members"), list("members").into_iter().chain([own]).collect());
    let folders: Vec<_> = CRATES.iter().filter(|(_, folder)| !folder.is_empty()).collect();
    assert!(folders.iter().all(|(_, folder)| list("members").contains(&format!("\"src/{folder}\""))));
}
