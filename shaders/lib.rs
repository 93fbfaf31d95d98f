//! The WGSL texts of pnaen: each file of this folder, by its name.

/// The name of every file, without `.wgsl`, and its text, in the order of names.
pub const TEXTS: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/texts.rs"));

/// The text of `name.wgsl`. A name without a file doesn't compile where the call is a constant.
///
/// # Panics
/// If there is no such file.
pub const fn text(name: &str) -> &'static str {
    let mut i = 0;
    while i < TEXTS.len() {
        if is_same(TEXTS[i].0.as_bytes(), name.as_bytes()) {
            return TEXTS[i].1;
        }
        i += 1;
    }
    panic!("no such file of WGSL")
}

const fn is_same(a: &[u8], b: &[u8]) -> bool {
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_those_of_the_files() {
        assert!(TEXTS.is_sorted() && TEXTS.iter().all(|(name, own)| text(name) == *own && own.ends_with('\n')));
        assert!(text("types").contains("struct Params"));
    }
}
