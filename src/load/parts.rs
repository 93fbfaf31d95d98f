//! The parts of a file by name: objects and groups, solids, nodes and materials. Those that are hidden are left out.
//!
//! A part's name is its path: the names of what it lies in, from the outermost, and its own, with slashes between them. A name
//! that has a slash is therefore several. Names that are empty don't count, and parts of one path are one part.

use std::collections::{BTreeMap, HashMap};

use serde::Serialize;

use super::memory_budget::Budget;
use super::notes::{Notes, counted};
use super::selection::{MATERIAL, Names, Selection, ShownParts, choice, hides, is_material, is_part_of};
use geometry::casts::to_u32;
use geometry::mesh::mesh_builder::MeshBuilder;
use geometry::mesh::{Material, MemoryRefused, Mesh, PartStyle};

/// The greatest number of parts. The triangles of others belong to none, and are always shown.
const MAX_PARTS: usize = 1 << 16;

/// The name of faces that belong to no part, or to one without a name; the specification of OBJ calls them so.
pub(super) const DEFAULT_PART: &str = "default";

/// How many names above a part's own are looked at, and how long they may be together, in bytes.
pub(super) const MOST_ABOVE: usize = 64;
const LONGEST_ABOVE: usize = 1024;

/// Memory for a part besides its name, and for each byte of that, in bytes: here, and in the tree of parts.
const PER_PART: u64 = 400;
const PER_LETTER: u64 = 16;

/// Memory for triangles of a part that follow one another, in bytes: while they are collected, and in the mesh.
const PER_RANGE: u64 = 32;

/// A part of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Part {
    /// Its path. That of a material begins with [`MATERIAL`].
    pub name: String,
    /// How many triangles it has, also while they are left out.
    pub triangles: u32,
    #[serde(rename = "hidden")]
    pub is_hidden: bool,
    /// The length in bytes of that start of the name that is the path of a level of detail other than the first, or 0.
    #[serde(skip)]
    pub level: usize,
}

/// The parts of a file that is being read.
#[derive(Debug, Default)]
pub(super) struct Parts {
    selected: ShownParts,
    names: [Names; 2],
    found: Vec<Part>,
    /// What each has in place of what is said for all; empty if styles weren't selected.
    styles: Vec<PartStyle>,
    /// The numbers of parts by their paths: of materials, of others, and of what is known to be a further level of detail.
    numbers: [HashMap<Vec<u8>, usize>; 3],
    /// Whether the parts that are entered are materials.
    are_materials: bool,
    /// The number of the first level of detail, by what the names of levels have in common.
    first_levels: HashMap<String, String>,
    /// The part that the next faces belong to.
    current: Option<usize>,
    /// How often a part was entered that is one too many.
    beyond: usize,
}

impl Parts {
    pub(super) fn new(selected: &Selection) -> Self {
        let selected = selected.parts.cloned().unwrap_or_default();
        Self { names: selected.names(), selected, ..Self::default() }
    }

    /// Says which part the next faces belong to, by its path, and how much of that is known to be the path of a further
    /// [level](Part::level).
    pub(super) fn enter(&mut self, name: &[u8], mut level: usize, budget: &Budget) -> Result<(), MemoryRefused> {
        budget.hold(PER_RANGE)?;
        let numbers = &mut self.numbers[if self.are_materials { 0 } else { 1 + usize::from(level > 0) }];
        if let Some(&number) = numbers.get(name) {
            self.current = Some(number);
            return Ok(());
        }
        if self.found.len() == MAX_PARTS {
            (self.current, self.beyond) = (None, self.beyond + 1);
            return Ok(());
        }
        budget.hold(PER_PART + PER_LETTER * name.len() as u64)?;
        let mut path = String::new();
        join(&mut path, &String::from_utf8_lossy(name), DEFAULT_PART);
        if is_material(&path) && !self.are_materials {
            // Only materials have such paths. A space keeps others apart: `material :Red`.
            path.insert(MATERIAL.len() - 1, ' ');
            level += usize::from(level > 0);
        }
        let number = *numbers.entry(path.clone().into_bytes()).or_insert(self.found.len());
        numbers.insert(name.to_vec(), number);
        if number == self.found.len() {
            let level = if level > 0 || is_material(&path) { level } else { self.named_level(&path) };
            let is_hidden = hides(&self.names, &path, level);
            self.styles.extend((!self.selected.styles.is_empty()).then(|| self.style_at(&path)));
            self.found.push(Part { name: path, triangles: 0, is_hidden, level });
        }
        self.current = Some(number);
        Ok(())
    }

    /// How much of a path is that of a further level by its names: `Car_LOD1`, if there was another level of `Car_LOD` before.
    fn named_level(&mut self, path: &str) -> usize {
        let is_further = |end: &usize| {
            let common = path[..*end].trim_end_matches(|c: char| c.is_ascii_digit());
            let (number, before) = (&path[common.len()..*end], common.len().saturating_sub(3));
            let is_lod = common.get(before..).is_some_and(|end| end.eq_ignore_ascii_case("lod"));
            if number.is_empty() || !is_lod || common[..before].ends_with(char::is_alphanumeric) {
                return false;
            }
            *self.first_levels.entry(common.to_owned()).or_insert_with(|| number.to_owned()) != *number
        };
        ends(path).find(is_further).unwrap_or(0)
    }

    /// The style of a path. That of what lies in a group wins over that of the group, and the last one among equals.
    fn style_at(&self, path: &str) -> PartStyle {
        let mut own: Vec<_> = self.selected.styles.iter().filter(|(name, _)| is_part_of(path, name)).collect();
        own.sort_by_cached_key(|(name, _)| closeness(path, name));
        own.into_iter().fold(PartStyle::default(), |others, (_, style)| style.or(others))
    }

    /// The style of faces of a part whose material has this one.
    pub(super) fn style(&self, part: Option<u32>, of_material: PartStyle) -> PartStyle {
        part.and_then(|part| self.styles.get(part as usize)).map_or(of_material, |own| own.or(of_material))
    }

    /// Gives a material its style.
    pub(super) fn give_style(&self, material: &mut Material) {
        let mut path = String::new();
        join(&mut path, &[MATERIAL, &material.name].concat(), DEFAULT_PART);
        material.style = self.style_at(&path);
    }

    /// Enters the materials as parts, if there are several or some are selected, and leaves out triangles of hidden ones. Gives
    /// the builder the styles of the other parts.
    pub(super) fn enter_materials(&mut self, builder: &mut MeshBuilder, budget: &Budget) -> Result<(), MemoryRefused> {
        builder.part_styles.clone_from(&self.styles);
        let ShownParts { hidden, only, styles, morphs: _ } = &self.selected;
        let mut selected = hidden.iter().chain(only).chain(styles.iter().map(|(name, _)| name));
        if builder.used_materials() < 2 && !selected.any(|name| is_material(name)) {
            return Ok(());
        }
        self.are_materials = true;
        builder.leave_out(|name, triangles| {
            self.enter([MATERIAL, name].concat().as_bytes(), 0, budget)?;
            Ok(self.leave_out(triangles as usize))
        })
    }

    /// The part that the next faces belong to.
    pub(super) fn current(&self) -> Option<u32> {
        self.current.map(to_u32)
    }

    /// Whether any part was entered.
    pub(super) fn have_begun(&self) -> bool {
        !self.found.is_empty()
    }

    /// Counts triangles of the current part. Returns whether they are left out.
    pub(super) fn leave_out(&mut self, triangles: usize) -> bool {
        let Some(part) = self.current.map(|number| &mut self.found[number]) else { return false };
        part.triangles = part.triangles.saturating_add(u32::try_from(triangles).unwrap_or(u32::MAX));
        part.is_hidden
    }

    /// Returns the parts that have triangles, and makes the mesh's ranges, which name parts that were [current](Self::current),
    /// places among them. `notes` gets how often a part too many was entered, and how many levels of detail are left out.
    pub(super) fn finish(mut self, mesh: &mut Mesh, notes: &mut Notes) -> Vec<Part> {
        let mut listed = 0;
        let places = self.found.iter().map(|part| {
            listed += u32::from(part.triangles > 0);
            listed.saturating_sub(1)
        });
        let places: Vec<u32> = places.collect();
        mesh.part_ranges.iter_mut().for_each(|range| range.part = places[range.part as usize]);
        let styles = self.styles.into_iter().zip(&self.found).filter(|(_, part)| part.triangles > 0);
        mesh.part_styles = styles.map(|(own, _)| own).collect();
        self.found.retain(|part| part.triangles > 0);
        let is_level = |part: &&Part| part.level > 0 && part.is_hidden && self.selected.only.is_empty();
        notes.extend(counted([
            (self.beyond, "parts beyond the first 65,536, which can't be hidden"),
            (
                self.found.iter().filter(is_level).count(),
                "parts of levels of detail other than the first, left out (`pnaen info` lists them, and --show-part shows one)",
            ),
        ]));
        self.found
    }

    /// Says which parts there are, as the end of a message.
    pub(super) fn names(&self) -> String {
        let with_triangles = self.found.iter().filter(|part| part.triangles > 0);
        choice(&with_triangles.map(|part| part.name.clone()).collect::<Vec<_>>(), "it has no named parts")
    }

    /// Whether triangles are left out.
    pub(super) fn are_hidden(&self) -> bool {
        self.found.iter().any(|part| part.is_hidden && part.triangles > 0)
    }
}

/// How closely a name means a path, which it is known to mean: the greatest wins, so that what lies in a group wins over it.
pub(super) fn closeness(path: &str, name: &str) -> (Option<usize>, usize) {
    let begins = ends(path).position(|end| is_part_of(&path[..end], name));
    (begins, name.trim_start_matches('/').len())
}

/// Adds the names that a name consists of to a path; `default` if there are none.
fn join(path: &mut String, name: &str, default: &str) {
    let names = if name.trim_matches('/').is_empty() { default } else { name };
    for name in names.split('/').filter(|name| !name.is_empty()) {
        if !path.is_empty() {
            path.push('/');
        }
        path.push_str(name);
    }
}

/// Returns a node's path, and how much of it is that of a further [level](Part::level). `nodes` are the node and those that it
/// lies in, from the innermost: their names, and whether each is such a level.
pub(super) fn node_path<'a>(nodes: impl Iterator<Item = (&'a str, bool)>) -> (String, usize) {
    let nodes: Vec<_> = nodes.take(MOST_ABOVE).collect();
    let (mut path, mut level) = (String::new(), 0);
    for (i, &(name, is_level)) in nodes.iter().enumerate().rev() {
        if i == 0 || path.len() + name.len() < LONGEST_ABOVE {
            join(&mut path, name, if i == 0 || is_level { DEFAULT_PART } else { "" });
        }
        if is_level && level == 0 {
            level = path.len();
        }
    }
    (path, level)
}

/// Returns the names in paths of nodes that are further [levels](Part::level), of which `levels` has the numbers. `nodes` are all nodes
/// with their own names. One that a first level has too, or a level of another number, gets its number, so that it can be named alone.
pub(super) fn level_names<'a>(
    levels: &BTreeMap<usize, usize>,
    nodes: impl Iterator<Item = (usize, &'a str)>,
) -> HashMap<usize, String> {
    let nodes = nodes.map(|(node, name)| (node, if name.is_empty() { DEFAULT_PART } else { name }));
    let (further, first): (Vec<_>, Vec<_>) = nodes.partition(|(node, _)| levels.contains_key(node));
    let mut taken: HashMap<&str, usize> = first.into_iter().map(|(_, name)| (name, 0)).collect();
    let own = further.into_iter().map(|(node, name)| match levels[&node] {
        number if *taken.entry(name).or_insert(number) == number => (node, name.to_owned()),
        number => (node, format!("{name} (level {number})")),
    });
    own.collect()
}

/// Returns where the names in a path end, from the outermost. Beyond so many, and so far, the rest is one name.
pub(super) fn ends(path: &str) -> impl Iterator<Item = usize> {
    let above = path.match_indices('/').map(|(end, _)| end).take(MOST_ABOVE);
    above.take_while(|end| *end <= LONGEST_ABOVE).chain([path.len()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::PartRange;

    fn entered(parts: &mut Parts, name: &str, triangles: usize) -> bool {
        parts.enter(name.as_bytes(), 0, &Budget::unlimited()).expect("memory is unlimited");
        parts.leave_out(triangles)
    }

    fn hiding(hidden: &[&str], only: &[&str]) -> Parts {
        let [hidden, only] =
            [hidden, only].map(|names| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>());
        let shown = ShownParts { hidden, only, ..ShownParts::default() };
        Parts::new(&Selection { parts: Some(&shown), ..Selection::default() })
    }

    #[test]
    fn a_part_may_be_entered_again_and_one_too_many_belongs_to_none() {
        let mut parts = hiding(&["b"], &[]);
        assert!(!parts.leave_out(1), "there is none yet");
        for (name, triangles) in [("a", 2), ("b", 3), ("empty", 0), ("a", 5)] {
            assert_eq!(entered(&mut parts, name, triangles), name == "b");
        }
        // A file may say that a part is repeated more often than any could be.
        assert!(!parts.leave_out(1 << 40));
        for i in 0..MAX_PARTS {
            entered(&mut parts, &format!("{i}"), 0);
        }
        assert!(!parts.leave_out(7));
        let range = |part| PartRange { triangles: 0..1, part };
        let mut mesh = Mesh { part_ranges: [0, 1, 3].map(range).to_vec(), ..Mesh::default() };
        let mut notes = Notes::default();
        let found = parts.finish(&mut mesh, &mut notes);
        let places: Vec<_> = mesh.part_ranges.iter().map(|range| range.part).collect();
        assert_eq!(places, [0, 1, 1], "that without triangles has no place of its own");
        let part = |name: &str, triangles, is_hidden| Part { name: name.to_owned(), triangles, is_hidden, level: 0 };
        assert_eq!(found, [part("a", u32::MAX, false), part("b", 3, true)]);
        assert_eq!(notes.into_warnings(), ["parts beyond the first 65,536, which can't be hidden: 3."]);
    }

    #[test]
    fn empty_names_do_not_count_and_slashes_are_those_of_paths() {
        let mut parts = hiding(&[], &[]);
        for name in ["a/b", "/a//b/", "", "//", "b"] {
            entered(&mut parts, name, 1);
        }
        let found = parts.finish(&mut Mesh::default(), &mut Notes::default());
        let found: Vec<_> = found.iter().map(|part| (part.name.as_str(), part.triangles)).collect();
        assert_eq!(found, [("a/b", 2), ("default", 2), ("b", 1)]);
        let chain = [("own", false), ("", false), ("high/low", true), ("top", false)];
        assert_eq!(node_path(chain.into_iter()), ("top/high/low/own".to_owned(), "top/high/low".len()));
        assert_eq!(node_path([("", true), ("top", true)].into_iter()), ("top/default".to_owned(), 3));
        let deep = std::iter::repeat_n(("node", false), 1 << 20);
        assert_eq!(node_path(deep).0.matches("node").count(), MOST_ABOVE);
    }

    #[test]
    fn a_level_is_no_part_of_the_same_path_and_a_name_makes_no_material() {
        let mut parts = hiding(&[], &[]);
        for (name, level) in [("Car", 3), ("Car", 0), ("/Car", 3), ("material:Red", 0), ("//material:Red/a", 12)] {
            parts.enter(name.as_bytes(), level, &Budget::unlimited()).expect("memory is unlimited");
            assert_eq!(parts.leave_out(1), level > 0, "{name} with {level}");
        }
        let found = parts.finish(&mut Mesh::default(), &mut Notes::default());
        let found: Vec<_> = found.iter().map(|part| (part.name.as_str(), part.level, part.triangles)).collect();
        assert_eq!(
            found,
            [("Car", 3, 2), ("Car", 0, 1), ("material :Red", 0, 1), ("material :Red/a", "material :Red".len(), 1)]
        );
    }

    #[test]
    fn levels_whose_names_are_taken_have_their_numbers() {
        let nodes = ["near", "", "group", "near", "", "far", "far", "far"];
        let levels = [(3, 1), (4, 2), (5, 1), (6, 1), (7, 2)].into();
        let names = level_names(&levels, nodes.into_iter().enumerate());
        let expected = [(3, "near (level 1)"), (4, "default (level 2)"), (5, "far"), (6, "far"), (7, "far (level 2)")];
        assert_eq!(names, expected.map(|(node, name)| (node, name.to_owned())).into());
    }

    #[test]
    fn a_name_means_parts_groups_and_paths_from_the_first_name_or_to_the_last() {
        let paths = ["Body", "Body/Arm", "Body/Arm/Hand", "Arm", "Armour", "material:Arm"];
        let meant = |name: &str| paths.map(|path| is_part_of(path, name));
        assert_eq!(meant("Arm"), [false, true, true, true, false, false]);
        assert_eq!(meant("/Arm"), [false, false, false, true, false, false]);
        assert_eq!(meant("Body/Arm"), [false, true, true, false, false, false]);
        assert_eq!(meant("Body/."), [true, false, false, false, false, false]);
        assert_eq!(meant("Arm/Hand"), [false, false, true, false, false, false]);
        assert_eq!(meant("material:Arm"), [false, false, false, false, false, true]);
        assert_eq!(meant("arm"), [false; 6]);
    }

    fn parsed(styles: &[(&str, &str)]) -> ShownParts {
        let style = |(name, style): &(&str, &str)| ((*name).to_owned(), style.parse().expect("a style"));
        ShownParts { styles: styles.iter().map(style).collect(), ..ShownParts::default() }
    }

    /// The styles of three parts, in the order of the file, and of a material.
    fn styled(styles: &[(&str, &str)]) -> (String, String) {
        let shown = parsed(styles);
        let mut parts = Parts::new(&Selection { parts: Some(&shown), ..Selection::default() });
        for name in ["Car", "empty", "Car/Wheel", "Hat"] {
            entered(&mut parts, name, usize::from(name != "empty"));
        }
        let mut red = Material::plain("Red", [1.0; 4]);
        parts.give_style(&mut red);
        let mut mesh = Mesh::default();
        parts.finish(&mut mesh, &mut Notes::default());
        (mesh.part_styles.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "), red.style.to_string())
    }

    #[test]
    fn styles_of_what_lies_in_a_group_win_over_those_of_the_group_each_for_what_it_says() {
        let own = |styles: &[(&str, &str)]| styled(styles).0;
        let wheel = ("Wheel", "surface=flat,crease=30");
        for styles in [[wheel, ("Car", "detail=2,surface=pn")], [("Car", "detail=2,surface=pn"), wheel]] {
            assert_eq!(own(&styles), "surface=pn,detail=2 surface=flat,detail=2,crease=30 ");
        }
        assert_eq!(own(&[("Car", "detail=2"), ("/Car", "detail=4")]), "detail=4 detail=4 ", "the last");
        assert_eq!(
            own(&[("Car", "detail=2"), ("Car", "normals=made")]),
            "detail=2,normals=made detail=2,normals=made "
        );
        assert_eq!(own(&[("Car/Wheel", "detail=2"), ("Wheel", "detail=4")]), " detail=2 ", "longer");
        assert_eq!(own(&[("Car/.", "detail=2"), ("Car", "detail=4")]), "detail=2 detail=4 ");
        assert_eq!(own(&[("Car/Wheel", "detail=1"), ("Car", "detail=4")]), "detail=4 detail=1 ", "1 is said too");
        assert_eq!(own(&[("material:Red", "detail=2")]), "  ", "no part has one");
        assert_eq!(own(&[]), "");
    }

    #[test]
    fn materials_have_styles_where_their_parts_say_nothing() {
        let red = ("material:Red", "surface=flat,normals=made");
        assert_eq!(styled(&[red, ("Red", "detail=2")]).1, "surface=flat,normals=made");
        let shown = parsed(&[red, ("Hat", "normals=file"), ("Car", "detail=2")]);
        let mut parts = Parts::new(&Selection { parts: Some(&shown), ..Selection::default() });
        let mut material = Material::plain("Red", [1.0; 4]);
        parts.give_style(&mut material);
        let style = |parts: &Parts| parts.style(parts.current(), material.style).to_string();
        assert_eq!(style(&parts), "surface=flat,normals=made", "in no part");
        for (name, expected) in [
            ("Car", "surface=flat,detail=2,normals=made"),
            ("Hat", "surface=flat,normals=file"),
            ("Tie", "surface=flat,normals=made"),
        ] {
            entered(&mut parts, name, 1);
            assert_eq!(style(&parts), expected, "{name}");
        }
    }

    #[test]
    fn only_the_first_level_of_detail_is_shown_unless_another_is_named() {
        let names = [
            "Car_LOD0",
            "Car_LOD1/Wheel",
            "Car_LOD2",
            "set/Car_LOD1",
            "Fold1",
            "LOD_3",
            "set/hat-lod0",
            "set/hat-lod1",
        ];
        let shown = |hidden: &[&str], only: &[&str]| {
            let mut parts = hiding(hidden, only);
            let shown = names.map(|name| !entered(&mut parts, name, 1));
            let mut notes = Notes::default();
            parts.finish(&mut Mesh::default(), &mut notes);
            (shown, notes.into_warnings().len())
        };
        assert_eq!(shown(&[], &[]), ([true, false, false, true, true, true, true, false], 1));
        assert_eq!(shown(&[], &["Car_LOD1"]), ([false, true, false, true, false, false, false, false], 0));
        assert_eq!(shown(&[], &["/Car_LOD1"]), ([false, true, false, false, false, false, false, false], 0));
        assert_eq!(shown(&[], &["set"]), ([false, false, false, true, false, false, true, false], 0), "not all levels");
        assert_eq!(shown(&[], &["set", "hat-lod1"]), ([false, false, false, true, false, false, true, true], 0));
        assert_eq!(shown(&["Car_LOD0"], &[]), ([false, false, false, true, true, true, true, false], 1));
    }
}
