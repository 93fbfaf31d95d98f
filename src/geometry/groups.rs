//! Lists of things in the order of groups that they belong to, such as the corners on each point.

/// Returns where each group's things begin in such a list, and the end of the last. `groups` has the group of each thing, in any order,
/// and each is below `count`, the number of groups.
pub fn group_starts(count: usize, groups: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut starts = vec![0; count + 1];
    for group in groups {
        starts[group as usize + 1] += 1;
    }
    for group in 0..count {
        starts[group + 1] += starts[group];
    }
    starts
}

/// Puts things, each with its group, in the order of `count` groups; those of one group stay in their order. Returns where each group's
/// things begin, with the end of the last, and the things.
pub fn in_groups<T: Clone + Default>(
    count: usize,
    things: impl Iterator<Item = (u32, T)> + Clone,
) -> (Vec<u32>, Vec<T>) {
    let starts = group_starts(count, things.clone().map(|(group, _)| group));
    let (mut next, mut sorted) = (starts.clone(), vec![T::default(); starts[count] as usize]);
    for (group, thing) in things {
        let place = &mut next[group as usize];
        sorted[*place as usize] = thing;
        *place += 1;
    }
    (starts, sorted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_group_begins_where_the_one_before_it_ends() {
        assert_eq!(group_starts(4, [2, 0, 2, 2].into_iter()), [0, 1, 1, 4, 4]);
        assert_eq!(group_starts(0, [].into_iter()), [0]);
    }

    #[test]
    fn things_of_a_group_stay_in_their_order() {
        let things = [(2, 'a'), (0, 'b'), (2, 'c'), (2, 'd')];
        assert_eq!(in_groups(4, things.into_iter()), (vec![0, 1, 1, 4, 4], vec!['b', 'a', 'c', 'd']));
    }
}
