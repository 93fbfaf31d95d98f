//! Sentences about what was repaired or left out.

use std::fmt::Display;

/// The greatest number of warnings about a document.
pub(super) const MAX_WARNINGS: usize = 100;

/// Sentences, of which only so many are kept: a small document can be wrong in very many places. Those that differ only in the
/// names of materials and files have one cause, and are one sentence with their number.
#[derive(Debug, Default)]
pub(super) struct Notes {
    kept: Vec<Kept>,
    /// How many more there were.
    more: usize,
}

#[derive(Debug)]
struct Kept {
    sentence: String,
    /// How often it was pushed.
    times: usize,
    /// How many sentences of the same cause have other names.
    others: usize,
}

impl Notes {
    /// Adds a sentence about a mesh, unless it is there: a mesh may be shown several times.
    pub(super) fn push_once(&mut self, sentence: String) {
        if self.kept.iter().all(|kept| kept.sentence != sentence) {
            self.push(sentence);
        }
    }

    pub(super) fn push(&mut self, sentence: String) {
        self.add(Kept { sentence, times: 1, others: 0 });
    }

    fn add(&mut self, added: Kept) {
        let has_room = self.kept.len() < MAX_WARNINGS;
        match self.kept.iter_mut().find(|kept| is_same_cause(&kept.sentence, &added.sentence)) {
            Some(kept) if kept.sentence == added.sentence => {
                kept.times += added.times;
                kept.others += added.others;
            }
            Some(kept) => kept.others += added.times + added.others,
            None if has_room => self.kept.push(added),
            None => self.more += added.times + added.others,
        }
    }

    pub(super) fn extend(&mut self, sentences: impl IntoIterator<Item = String>) {
        sentences.into_iter().for_each(|sentence| self.push(sentence));
    }

    /// Adds those of others.
    pub(super) fn append(&mut self, others: Self) {
        others.kept.into_iter().for_each(|kept| self.add(kept));
        self.more += others.more;
    }

    /// Returns the sentences that were kept, with their number where it isn't one, and one about those that weren't.
    pub(super) fn into_warnings(self) -> Vec<String> {
        let counted = |Kept { sentence, times, others }: Kept| match (sentence.trim_end_matches('.'), times, others) {
            (_, 1, 0) => sentence,
            (said, _, 0) => format!("{said} ({times} times)."),
            (said, _, _) => format!("{said} (and {} more like it).", times - 1 + others),
        };
        let mut warnings: Vec<_> = self.kept.into_iter().map(counted).collect();
        if self.more > 0 {
            warnings.push(format!("{} more such sentences are left out.", self.more));
        }
        warnings
    }
}

/// Declares a type of counts of what was repaired or left out, each with its sentence.
macro_rules! counts {
    ($(#[$about:meta])* $seen:vis struct $name:ident { $($field:ident => $sentence:literal;)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, Default)]
        $seen struct $name { $(pub $field: usize,)* }

        impl $name {
            /// Returns a sentence for each count that isn't 0.
            $seen fn sentences(&self) -> impl Iterator<Item = String> + use<> {
                $crate::notes::counted([$((self.$field, $sentence)),*])
            }
        }

        impl std::ops::AddAssign for $name {
            fn add_assign(&mut self, other: Self) {
                $(self.$field += other.$field;)*
            }
        }
    };
}

pub(super) use counts;

/// Returns a sentence for each count that isn't 0.
pub(super) fn counted<S: Display>(sentences: impl IntoIterator<Item = (usize, S)>) -> impl Iterator<Item = String> {
    let found = sentences.into_iter().filter(|(count, _)| *count > 0);
    found.map(|(count, sentence)| format!("{sentence}: {count}."))
}

/// Whether two sentences differ in nothing but quoted names, paths of files, and places in a document with the name there:
/// `/images/3 (wood.png)`.
fn is_same_cause(a: &str, b: &str) -> bool {
    let words = |sentence| {
        let unquoted = str::split(sentence, '"').step_by(2);
        unquoted.flat_map(str::split_whitespace).filter(|word| !word.contains(['/', '(']))
    };
    words(a).eq(words(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_sentences_are_one_with_their_number() {
        let mut notes = Notes::default();
        ["A is wrong.", "B is odd.", "A is wrong."].into_iter().for_each(|sentence| notes.push(sentence.to_owned()));
        notes.push_once("B is odd.".to_owned());
        let mut others = Notes::default();
        others.extend(["A is wrong.".to_owned(), "C.".to_owned()]);
        notes.append(others);
        assert_eq!(notes.into_warnings(), ["A is wrong (3 times).", "B is odd.", "C."]);
    }

    #[test]
    fn sentences_that_differ_in_names_are_one_with_their_number() {
        let missing =
            |name| format!("the map of \"{name}\" is left out: \"{name}.png\" can't be read: there is no such file.");
        let mut notes = Notes::default();
        notes.extend(["Hose", "Left lens", "Hose", "Wood"].map(missing));
        notes.push("the map of \"Hose\" is left out: /images/1: it is broken.".to_owned());
        let first =
            "the map of \"Hose\" is left out: \"Hose.png\" can't be read: there is no such file (and 3 more like it).";
        assert_eq!(notes.into_warnings(), [first, "the map of \"Hose\" is left out: /images/1: it is broken."]);
    }

    #[test]
    fn only_so_many_different_sentences_are_kept() {
        let mut notes = Notes::default();
        notes.extend((0..MAX_WARNINGS + 5).flat_map(|i| [format!("{i}."), format!("{i}.")]));
        let warnings = notes.into_warnings();
        assert_eq!((warnings.len(), warnings[3].as_str()), (MAX_WARNINGS + 1, "3 (2 times)."));
        assert_eq!(warnings[MAX_WARNINGS], "10 more such sentences are left out.");
    }
}
