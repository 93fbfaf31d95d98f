//! Divides work among the processor's cores, by rayon's threads.

use std::ops::Range;

use rayon::prelude::*;

/// Divides the numbers below `count` into ranges of at least `least` numbers, one for each core, and returns what `work`
/// makes of each range, in the order of the ranges. What is made of all of them together must not depend on where one
/// range ends and the next begins.
pub fn in_ranges<R: Send>(count: usize, least: usize, work: impl Fn(Range<usize>) -> R + Sync) -> Vec<R> {
    ranges(count, least).collect::<Vec<_>>().into_par_iter().map(&work).collect()
}

/// Divides the numbers below `count` into ranges of at least `least` numbers, one for each core; into one range if there are fewer.
pub fn ranges(count: usize, least: usize) -> impl Iterator<Item = Range<usize>> {
    let ranges = rayon::current_num_threads().min(count / least.max(1)).max(1);
    (0..ranges).map(move |number| number * count / ranges..(number + 1) * count / ranges)
}

/// Divides a list into parts of so many items each.
pub fn split<T>(mut list: &mut [T], lengths: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    lengths.map(|length| list.split_off_mut(..length).unwrap_or_default()).collect()
}

/// Does `work` with so many threads in place of one a core.
///
/// # Errors
/// The system can't start another thread.
pub fn on_threads<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> Result<R, rayon::ThreadPoolBuildError> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?.install(work))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_divided_among_as_many_threads_as_there_are() {
        for threads in [1, 2, 7] {
            let ranges = on_threads(threads, || in_ranges(1000, 1, |range| range.len())).expect("threads");
            assert_eq!(ranges.len(), threads);
        }
    }

    #[test]
    fn every_number_is_in_one_range_and_ranges_are_in_order() {
        for (count, least) in [(0, 1), (1, 1), (1, 100), (7, 2), (1000, 1), (1000, 999), (1001, 0)] {
            let ranges = in_ranges(count, least, |range| range);
            assert!(ranges.iter().cloned().flatten().eq(0..count), "{count}, {least}: {ranges:?}");
            assert!(
                ranges.len() == 1 || ranges.iter().all(|range| range.len() >= least),
                "{count}, {least}: {ranges:?}"
            );
        }
    }

    #[test]
    fn a_list_is_split_into_parts_of_so_many_items() {
        let mut list = [0; 10];
        let parts = split(&mut list, [3, 3, 3, 1].into_iter());
        parts.into_iter().enumerate().for_each(|(number, part)| part.fill(number));
        assert_eq!(list, [0, 0, 0, 1, 1, 1, 2, 2, 2, 3]);
    }

    #[test]
    #[should_panic(expected = "the last range")]
    fn a_panic_goes_on_in_the_caller() {
        in_ranges(1000, 1, |range| assert!(range.end < 1000, "the last range"));
    }
}
