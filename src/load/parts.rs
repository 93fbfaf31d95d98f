//! The parts of a file: its objects and groups, or its solids, by name. Those that are hidden are left out.

use std::collections::HashMap;

use serde::Serialize;

use super::memory_budget::Budget;
use super::selection::{Selection, ShownParts, choice};
use geometry::casts::to_u32;
use geometry::mesh::MemoryRefused;

/// The greatest number of parts. The triangles of others belong to none, and are always shown.
const MAX_PARTS: usize = 1 << 16;

/// The name of faces that belong to no part, or to one without a name; the specification of OBJ calls them so.
pub(super) const DEFAULT_PART: &[u8] = b"default";

/// Memory for a part besides its name, which is stored twice, in bytes.
const PER_PART: u64 = 150;

/// Memory for triangles of a part that follow one another, in bytes: while they are collected, and in the mesh.
const PER_RANGE: u64 = 32;

/// A part of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Part {
    pub name: String,
    /// How many triangles it has, also while they are left out.
    pub triangles: u32,
    #[serde(rename = "hidden")]
    pub is_hidden: bool,
}

/// The parts of a file that is being read.
#[derive(Default)]
pub(super) struct Parts {
    shown: ShownParts,
    found: Vec<Part>,
    numbers: HashMap<Vec<u8>, usize>,
    /// The part that the next faces belong to.
    current: Option<usize>,
    /// How often a part was entered that is one too many.
    beyond: usize,
}

impl Parts {
    pub(super) fn new(selected: &Selection) -> Self {
        Self { shown: selected.parts.cloned().unwrap_or_default(), ..Self::default() }
    }

    /// Says which part the next faces belong to, by its name.
    pub(super) fn enter(&mut self, name: &[u8], budget: &Budget) -> Result<(), MemoryRefused> {
        budget.hold(PER_RANGE)?;
        if let Some(&number) = self.numbers.get(name) {
            self.current = Some(number);
            return Ok(());
        }
        if self.found.len() == MAX_PARTS {
            (self.current, self.beyond) = (None, self.beyond + 1);
            return Ok(());
        }
        budget.hold(PER_PART + 2 * name.len() as u64)?;
        let number = self.found.len();
        let (own, ShownParts { hidden, only, .. }) = (String::from_utf8_lossy(name).into_owned(), &self.shown);
        let is_hidden = hidden.contains(&own) || !(only.is_empty() || only.contains(&own));
        self.found.push(Part { name: own, triangles: 0, is_hidden });
        self.numbers.insert(name.to_vec(), number);
        self.current = Some(number);
        Ok(())
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

    /// Whether the next faces are left out.
    pub(super) fn is_hidden(&self) -> bool {
        self.current.is_some_and(|number| self.found[number].is_hidden)
    }

    /// Returns the parts that have triangles, how often one was entered that is one too many, and the places in the list of
    /// the parts that were [current](Self::current).
    pub(super) fn into_list(mut self) -> (Vec<Part>, usize, Vec<u32>) {
        let mut listed = 0;
        let places = self.found.iter().map(|part| {
            listed += u32::from(part.triangles > 0);
            listed.saturating_sub(1)
        });
        let places = places.collect();
        self.found.retain(|part| part.triangles > 0);
        (self.found, self.beyond, places)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_may_be_entered_again_and_one_too_many_belongs_to_none() {
        let budget = Budget::unlimited();
        let shown = ShownParts { hidden: vec!["b".to_owned()], ..ShownParts::default() };
        let mut parts = Parts::new(&Selection { parts: Some(&shown), ..Selection::default() });
        assert!(!parts.leave_out(1), "there is none yet");
        for (name, triangles) in [("a", 2), ("b", 3), ("empty", 0), ("a", 5)] {
            parts.enter(name.as_bytes(), &budget).expect("memory is unlimited");
            assert_eq!(parts.leave_out(triangles), name == "b");
        }
        // A file may say that a part is repeated more often than any could be.
        assert!(!parts.leave_out(1 << 40));
        for i in 0..MAX_PARTS {
            parts.enter(format!("{i}").as_bytes(), &budget).expect("memory is unlimited");
        }
        assert!(!parts.leave_out(7));
        let (found, beyond, places) = parts.into_list();
        assert_eq!(&places[..4], [0, 1, 1, 1], "that without triangles has no place of its own");
        let part = |name: &str, triangles, is_hidden| Part { name: name.to_owned(), triangles, is_hidden };
        assert_eq!((found, beyond), (vec![part("a", u32::MAX, false), part("b", 3, true)], 3));
    }
    #[test]
    fn parts_are_shown_alone_added_and_left_out() {
        let [a, b] = ["a", "b"].map(str::to_owned);
        let is_hidden = |shown: &ShownParts, name: &str| {
            let selected = Selection { parts: Some(shown), ..Selection::default() };
            let mut parts = Parts::new(&selected);
            parts.enter(name.as_bytes(), &Budget::unlimited()).expect("memory is unlimited");
            parts.is_hidden()
        };
        let mut shown = ShownParts::default();
        shown.show_only(vec!["a".to_owned()]);
        assert_eq!(["a", "b", "c"].map(|name| is_hidden(&shown, name)), [false, true, true]);
        shown.set("b", true);
        assert_eq!(shown, ShownParts { only: vec![a.clone(), b.clone()], ..ShownParts::default() });
        shown.set("a", false);
        assert_eq!(["a", "b", "c"].map(|name| is_hidden(&shown, name)), [true, false, true]);
        shown.set("b", false);
        assert_eq!(["a", "b", "c"].map(|name| is_hidden(&shown, name)), [true; 3]);
        shown.set("b", true);
        assert_eq!(shown, ShownParts { only: vec![b], ..ShownParts::default() });
    }
}
