//! Where the things of each patch begin in a list that is in the order of the patches.

/// The place of each patch's first thing in such a list, and its end. `patches` has the patch of each thing, in any order, and is below
/// `count`, the number of patches.
pub fn patch_starts(patches: impl Iterator<Item = u32>, count: usize) -> Vec<u32> {
    let mut starts = vec![0; count + 1];
    for patch in patches {
        starts[patch as usize + 1] += 1;
    }
    for patch in 1..starts.len() {
        starts[patch] += starts[patch - 1];
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_patch_begins_where_the_one_before_it_ends() {
        assert_eq!(patch_starts([2, 0, 2, 2].into_iter(), 4), [0, 1, 1, 4, 4]);
        assert_eq!(patch_starts([].into_iter(), 0), [0]);
    }
}
