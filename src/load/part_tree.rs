//! The tree of a file's parts: groups, what lies in them, and materials.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::parts::{Part, ends};
use super::selection::{ShownParts, hides, is_material};

/// The greatest number of groups. What lies in others is in the last one before them, or in none.
const MOST_GROUPS: usize = 1 << 14;

/// The length of a name, in bytes, from which on it is taken to mean something else too.
const LONGEST: usize = 1 << 11;

/// A part, or a group of parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Branch {
    /// Its path. One that ends in `/.` is that of a part whose name is a group's too, without what lies in it.
    pub path: String,
    /// A name that means it and nothing else: its path, after a slash if the path has this meaning elsewhere too.
    pub name: String,
    /// In how many groups it lies.
    pub depth: usize,
    /// Its place in the list of parts; none for a group.
    pub part: Option<usize>,
    /// How many parts it consists of, how many of them are shown, and how many triangles all have.
    pub parts: usize,
    pub shown: usize,
    pub triangles: u64,
    /// How much of its path is that of another level of detail than the first, as [`Part::level`].
    level: usize,
}

/// Returns the groups and parts: groups before what lies in them, otherwise in the order of the file.
pub fn tree(parts: &[Part]) -> Vec<Branch> {
    let names = parts.iter().map(|part| &*part.name);
    let above = names.flat_map(|name| ends(name).filter(|end| *end < name.len()).map(|end| &name[..end]));
    let mut groups: HashSet<&str> = HashSet::new();
    for group in above {
        if groups.len() < MOST_GROUPS {
            groups.insert(group);
        }
    }
    let (mut numbers, mut branches) = (HashMap::new(), BTreeMap::new());
    for (place, part) in parts.iter().enumerate() {
        let path = part.name.clone() + if groups.contains(&*part.name) { "/." } else { "" };
        let mut key = Vec::new();
        for end in ends(&path).filter(|end| *end == path.len() || groups.contains(&path[..*end])) {
            let next = numbers.len();
            key.push(*numbers.entry(path[..end].to_owned()).or_insert(next));
            let branch = branches.entry(key.clone()).or_insert_with(|| Branch {
                path: path[..end].to_owned(),
                name: String::new(),
                depth: key.len() - 1,
                part: (end == path.len()).then_some(place),
                parts: 0,
                shown: 0,
                triangles: 0,
                level: if part.level <= end { part.level } else { 0 },
            });
            branch.parts += 1;
            branch.shown += usize::from(!part.is_hidden);
            branch.triangles += u64::from(part.triangles);
        }
    }
    named(branches.into_values().collect())
}

/// Gives branches their names.
fn named(mut tree: Vec<Branch>) -> Vec<Branch> {
    let paths: Vec<String> = leaves(&tree).map(|leaf| format!("{}/./", leaf.path)).collect();
    let paths = paths.iter().filter(|path| !is_material(path));
    // What paths are after each of their first names, sorted.
    let rests = paths.flat_map(|path| path.match_indices('/').map(|(slash, _)| &path.as_bytes()[slash + 1..]));
    let mut rests: Vec<&[u8]> = rests.map(|rest| &rest[..rest.len().min(LONGEST)]).collect();
    rests.sort_unstable();
    for branch in &mut tree {
        let own = format!("{}/", branch.path).into_bytes();
        let place = rests.partition_point(|rest| *rest < &own[..]);
        let is_elsewhere = own.len() > LONGEST || rests.get(place).is_some_and(|rest| rest.starts_with(&own));
        let slash = if is_elsewhere && !is_material(&branch.path) { "/" } else { "" };
        branch.name = [slash, &branch.path].concat();
    }
    tree
}

/// Returns the parts of a tree.
pub fn leaves(tree: &[Branch]) -> impl Iterator<Item = &Branch> {
    tree.iter().filter(|branch| branch.part.is_some())
}

/// Returns where what lies in a branch ends.
pub fn end(tree: &[Branch], at: usize) -> usize {
    at + 1 + tree[at + 1..].iter().take_while(|branch| branch.depth > tree[at].depth).count()
}

impl ShownParts {
    /// Shows a branch, or leaves it out. Further levels of detail are shown only if the branch is one, or lies in one.
    pub fn set(&mut self, tree: &[Branch], at: usize, is_shown: bool) {
        let (branch, changed, before) = (&tree[at], at..end(tree, at), self.names());
        let is_changed = |i: usize| changed.contains(&i) && (!is_shown || branch.level > 0 || tree[i].level == 0);
        let is_hidden = |i: usize| hides(&before, &tree[i].path, tree[i].level);
        let shown = |i: usize| if is_changed(i) { is_shown } else { !is_hidden(i) };
        let shown: Vec<bool> = (0..tree.len()).map(shown).collect();
        let is_other = |name: &String| is_material(name) != is_material(&branch.path);
        let lists_shown = is_shown && branch.level > 0 || !self.only.iter().all(is_other);
        // Names of what the tree doesn't have stay, such as those of materials of parts that are hidden.
        for (names, all) in [&mut self.hidden, &mut self.only].into_iter().zip(&before) {
            let known: HashSet<&String> = leaves(tree).flat_map(|leaf| all.meaning(&leaf.path)).collect();
            names.retain(|name| is_other(name) || !known.contains(name));
        }
        let names = |mut whole: Vec<usize>| {
            whole.retain(|at| is_material(&tree[*at].path) == is_material(&branch.path));
            whole.into_iter().map(|at| tree[at].name.clone())
        };
        // A group that is named doesn't show other levels.
        let only = whole(tree, |group, i| shown[i] && tree[i].level == group.level);
        let mut only = names(only).peekable();
        // Without a name all parts would be shown.
        if lists_shown && only.peek().is_some() {
            self.only.extend(only);
        } else {
            let mut hidden = whole(tree, |_, i| !shown[i]);
            hidden.retain(|at| tree[*at].level == 0);
            self.hidden.extend(names(hidden));
        }
    }
}

/// Returns the largest branches of which all parts fit, each with a branch that it lies in.
fn whole(tree: &[Branch], fits: impl Fn(&Branch, usize) -> bool) -> Vec<usize> {
    let (mut whole, mut at) = (Vec::new(), 0);
    while at < tree.len() {
        let end = end(tree, at);
        let is_whole = (at..end).all(|i| tree[i].part.is_none() || fits(&tree[at], i));
        whole.extend(is_whole.then_some(at));
        at = if is_whole { end } else { at + 1 };
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parts with these names, of 1, 2, 3 and so on triangles, of which `shown` says what is left out.
    fn parts(names: &[&str], shown: &ShownParts) -> Vec<Part> {
        let part = |(i, name): (u32, &&str)| Part {
            name: (*name).to_owned(),
            triangles: i,
            is_hidden: hides(&shown.names(), name, 0),
            level: 0,
        };
        (1..).zip(names).map(part).collect()
    }

    #[test]
    fn groups_come_before_what_lies_in_them_and_a_part_that_is_a_group_has_a_row_of_its_own() {
        let tree = tree(&parts(&["Car/Wheel", "Hat", "Car", "Car/Door/Knob", "material:Red"], &ShownParts::default()));
        let rows = tree.iter().map(|own| (own.path.as_str(), own.depth, own.part, own.parts, own.triangles));
        assert_eq!(
            rows.collect::<Vec<_>>(),
            [
                ("Car", 0, None, 3, 8),
                ("Car/Wheel", 1, Some(0), 1, 1),
                ("Car/.", 1, Some(2), 1, 3),
                ("Car/Door", 1, None, 1, 4),
                ("Car/Door/Knob", 2, Some(3), 1, 4),
                ("Hat", 0, Some(1), 1, 2),
                ("material:Red", 0, Some(4), 1, 5),
            ]
        );
        assert_eq!([0, 1, 3, 5].map(|at| end(&tree, at)), [5, 2, 5, 6]);
    }

    #[test]
    fn a_branch_has_a_name_that_means_nothing_else() {
        let tree = tree(&parts(&["a/b", "b", "a", "c/a"], &ShownParts::default()));
        let names: Vec<_> = tree.iter().map(|branch| (branch.path.as_str(), branch.name.clone())).collect();
        let named = |path, name: &str| (path, name.to_owned());
        assert_eq!(
            names,
            [
                named("a", "/a"),
                named("a/b", "a/b"),
                named("a/.", "/a/."),
                named("b", "/b"),
                named("c", "c"),
                named("c/a", "c/a"),
            ]
        );
    }

    #[test]
    fn parts_and_groups_are_shown_alone_added_and_left_out() {
        let names = ["g/a", "g/b", "c"];
        let mut shown = ShownParts::default();
        shown.show_only(vec!["g".to_owned()]);
        let mut set = |path: &str, is_shown: bool| {
            let parts = parts(&names, &shown);
            let tree = tree(&parts);
            let at = tree.iter().position(|branch| branch.path == path).expect("a branch");
            shown.set(&tree, at, is_shown);
            (shown.clone(), names.map(|name| !hides(&shown.names(), name, 0)))
        };
        let lists = |hidden: &[&str], only: &[&str]| {
            let [hidden, only] = [hidden, only].map(|names| names.iter().map(|name| (*name).to_owned()).collect());
            ShownParts { hidden, only, ..ShownParts::default() }
        };
        assert_eq!(set("c", true), (lists(&[], &["g", "c"]), [true; 3]));
        assert_eq!(set("g", false), (lists(&[], &["c"]), [false, false, true]));
        assert_eq!(set("c", false), (lists(&["g", "c"], &[]), [false; 3]), "without the last name all would be shown");
        assert_eq!(set("c", true), (lists(&["g"], &[]), [false, false, true]));
        shown_is_whole_again(&names);
    }

    /// A part of a group that is hidden is shown, and the group is hidden and shown as one.
    fn shown_is_whole_again(names: &[&str]) {
        let mut shown = ShownParts::default();
        let mut set = |at: usize, is_shown: bool| {
            let tree = tree(&parts(names, &shown));
            shown.set(&tree, at, is_shown);
            shown.hidden.clone()
        };
        assert_eq!(set(1, false), ["g/a"]);
        assert_eq!(set(0, false), ["g"], "the group has the part");
        assert_eq!(set(2, true), ["g/a"], "the rest of the group stays hidden");
        assert_eq!(set(0, true), [""; 0]);
    }

    #[test]
    fn another_level_is_shown_beside_what_is_shown_and_a_group_shows_only_the_first() {
        let names = ["Car/Car_LOD0", "Car/Car_LOD1", "Hat"];
        let mut shown = ShownParts::default();
        let mut set = |path: &str, is_shown: bool| {
            let level = |name: &str| if name.ends_with('1') { name.len() } else { 0 };
            let part = |name: &&str| Part {
                name: (*name).to_owned(),
                triangles: 1,
                is_hidden: hides(&shown.names(), name, level(name)),
                level: level(name),
            };
            let tree = tree(&names.iter().map(part).collect::<Vec<_>>());
            let at = tree.iter().position(|branch| branch.path == path).expect("a branch");
            shown.set(&tree, at, is_shown);
            (names.map(|name| !hides(&shown.names(), name, level(name))), shown.clone())
        };
        assert_eq!(set("Car", false).0, [false, false, true]);
        let (now, lists) = set("Car", true);
        assert_eq!((now, lists), ([true, false, true], ShownParts::default()));
        let (now, lists) = set("Car/Car_LOD1", true);
        assert_eq!((now, lists.only), ([true; 3], ["Car/Car_LOD0", "Car/Car_LOD1", "Hat"].map(str::to_owned).to_vec()));
        assert_eq!(set("Car/Car_LOD0", false).0, [false, true, true]);
        assert_eq!(set("Hat", false).0, [false, true, false]);
    }

    #[test]
    fn names_of_what_the_tree_does_not_have_stay() {
        let mut shown = ShownParts { hidden: vec!["material:Red".to_owned(), "a".to_owned()], ..ShownParts::default() };
        let tree = tree(&parts(&["a", "b", "material:Blue"], &shown));
        shown.set(&tree, 2, false);
        assert_eq!(shown.hidden, ["material:Red", "a", "material:Blue"]);
        shown.set(&tree, 2, true);
        shown.set(&tree, 0, true);
        assert_eq!(shown.hidden, ["material:Red"]);
    }

    #[test]
    fn many_parts_and_names_are_quick_and_groups_are_limited() {
        let names: Vec<String> = (0..20_000).map(|i| format!("group {}/part {i}/end", i / 2)).collect();
        let start = std::time::Instant::now();
        let mut shown = ShownParts { hidden: names.iter().step_by(2).cloned().collect(), ..ShownParts::default() };
        let before = shown.names();
        let part =
            |name: &String| Part { name: name.clone(), triangles: 1, is_hidden: hides(&before, name, 0), level: 0 };
        let found: Vec<Part> = names.iter().map(part).collect();
        let tree = tree(&found);
        assert_eq!((leaves(&tree).count(), tree.len()), (20_000, 20_000 + MOST_GROUPS));
        assert!(tree.iter().all(|branch| branch.name == branch.path));
        shown.set(&tree, end(&tree, 0), false);
        let after = shown.names();
        let hidden: Vec<_> = (0..).zip(&names).filter(|(_, name)| hides(&after, name, 0)).map(|(i, _)| i).collect();
        // Every second one, and both of the second group.
        let expected: Vec<_> = (0..20_000).filter(|i| i % 2 == 0 || *i == 3).collect();
        assert_eq!(hidden, expected);
        assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
    }
}
