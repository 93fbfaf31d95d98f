//! Sentences about what was repaired or left out.

/// The greatest number of warnings about a document.
pub(super) const MAX_WARNINGS: usize = 100;

/// Sentences, of which only so many are kept: a small document can be wrong in very many places. Equal ones are one sentence.
#[derive(Debug, Default)]
pub(super) struct Notes {
    /// With how often each was pushed.
    kept: Vec<(String, usize)>,
    /// How many more there were.
    more: usize,
}

impl Notes {
    /// Adds a sentence about a mesh, unless it is there: a mesh may be shown several times.
    pub(super) fn push_once(&mut self, sentence: String) {
        if self.kept.iter().all(|(kept, _)| *kept != sentence) {
            self.push(sentence);
        }
    }

    pub(super) fn push(&mut self, sentence: String) {
        self.add(sentence, 1);
    }

    fn add(&mut self, sentence: String, times: usize) {
        match self.kept.iter().position(|(kept, _)| *kept == sentence) {
            Some(known) => self.kept[known].1 += times,
            None if self.kept.len() < MAX_WARNINGS => self.kept.push((sentence, times)),
            None => self.more += times,
        }
    }

    pub(super) fn extend(&mut self, sentences: impl IntoIterator<Item = String>) {
        sentences.into_iter().for_each(|sentence| self.push(sentence));
    }

    /// Adds those of others.
    pub(super) fn append(&mut self, others: Self) {
        others.kept.into_iter().for_each(|(sentence, times)| self.add(sentence, times));
        self.more += others.more;
    }

    /// Returns the sentences that were kept, with how often each was pushed if it wasn't once, and one about the others if there are
    /// any.
    pub(super) fn into_warnings(self) -> Vec<String> {
        let counted = |(sentence, times): (String, usize)| match times {
            1 => sentence,
            _ => format!("{} ({times} times).", sentence.trim_end_matches('.')),
        };
        let mut warnings: Vec<_> = self.kept.into_iter().map(counted).collect();
        if self.more > 0 {
            warnings.push(format!("{} more such sentences are left out.", self.more));
        }
        warnings
    }
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
    fn only_so_many_different_sentences_are_kept() {
        let mut notes = Notes::default();
        notes.extend((0..MAX_WARNINGS + 5).flat_map(|i| [format!("{i}."), format!("{i}.")]));
        let warnings = notes.into_warnings();
        assert_eq!((warnings.len(), warnings[3].as_str()), (MAX_WARNINGS + 1, "3 (2 times)."));
        assert_eq!(warnings[MAX_WARNINGS], "10 more such sentences are left out.");
    }
}
