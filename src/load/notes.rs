//! Sentences about what was repaired or left out.

/// The greatest number of warnings about a document.
pub(super) const MAX_WARNINGS: usize = 100;

/// Sentences, of which only so many are kept: a small document can be wrong in very many places.
#[derive(Debug, Default)]
pub(super) struct Notes {
    kept: Vec<String>,
    /// How many more there were.
    more: usize,
}

impl Notes {
    /// Adds a sentence about a mesh, unless it is there: a mesh may be shown several times.
    pub(super) fn push_once(&mut self, sentence: String) {
        if !self.kept.contains(&sentence) {
            self.push(sentence);
        }
    }

    pub(super) fn push(&mut self, sentence: String) {
        if self.kept.len() < MAX_WARNINGS {
            self.kept.push(sentence);
        } else {
            self.more += 1;
        }
    }

    pub(super) fn extend(&mut self, sentences: impl IntoIterator<Item = String>) {
        sentences.into_iter().for_each(|sentence| self.push(sentence));
    }

    /// Adds those of others.
    pub(super) fn append(&mut self, others: Self) {
        self.extend(others.kept);
        self.more += others.more;
    }

    /// Returns the sentences that were kept, and one about the others if there are any.
    pub(super) fn into_warnings(mut self) -> Vec<String> {
        if self.more > 0 {
            self.kept.push(format!("{} more such sentences are left out.", self.more));
        }
        self.kept
    }
}
