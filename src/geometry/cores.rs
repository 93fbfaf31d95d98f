//! Divides work among the processor's cores.

use std::iter::once;
use std::num::NonZero;
use std::ops::Range;
use std::panic::resume_unwind;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Divides the numbers below `count` into ranges of at least `least` numbers, one for each core, and returns what `work`
/// makes of each range, in the order of the ranges. What is made of all of them together must not depend on where one
/// range ends and the next begins. Returns after the last range is done.
pub fn in_ranges<R: Send>(count: usize, least: usize, work: impl Fn(Range<usize>) -> R + Sync) -> Vec<R> {
    let (mut ranges, work) = (ranges(count, least), &work);
    thread::scope(|scope| {
        let first = ranges.next().unwrap_or_default();
        let start = |range: Range<usize>| {
            let own = range.clone();
            (range, thread::Builder::new().spawn_scoped(scope, move || work(own)))
        };
        let others: Vec<_> = ranges.map(start).collect();
        let first = work(first);
        let others = others.into_iter().map(|(range, thread)| match thread {
            Ok(thread) => thread.join().unwrap_or_else(|panic| resume_unwind(panic)),
            // The system has no further thread.
            Err(_) => work(range),
        });
        once(first).chain(others).collect()
    })
}

/// Divides the numbers below `count` into ranges of at least `least` numbers, one for each core; into one range if there are fewer.
pub fn ranges(count: usize, least: usize) -> impl Iterator<Item = Range<usize>> {
    let ranges = cores().min(count / least.max(1)).max(1);
    (0..ranges).map(move |number| number * count / ranges..(number + 1) * count / ranges)
}

/// Returns what `work` makes of each part, in the order of the parts, which the cores share. A part may hold what is changed, such as
/// a slice of a list.
pub(crate) fn in_parts<T: Send, R: Send>(parts: Vec<T>, work: impl Fn(&mut T) -> R + Sync) -> Vec<R> {
    // Each lock is taken once.
    let parts: Vec<Mutex<T>> = parts.into_iter().map(Mutex::new).collect();
    let of_part = |part: &Mutex<T>| work(&mut part.lock().unwrap_or_else(PoisonError::into_inner));
    in_ranges(parts.len(), 1, |range| parts[range].iter().map(of_part).collect::<Vec<_>>())
        .into_iter()
        .flatten()
        .collect()
}

/// Divides a list into parts of so many items each.
pub fn split<T>(mut list: &mut [T], lengths: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    lengths.map(|length| list.split_off_mut(..length).unwrap_or_default()).collect()
}

/// Does two works at the same time if there are several cores, and returns what they make.
pub fn both<A: Send, B>(first: impl Fn() -> A + Sync, second: impl FnOnce() -> B) -> (A, B) {
    let first = &first;
    thread::scope(|scope| {
        let other = (cores() > 1).then(|| thread::Builder::new().spawn_scoped(scope, first));
        let made = second();
        match other {
            Some(Ok(thread)) => (thread.join().unwrap_or_else(|panic| resume_unwind(panic)), made),
            // There is one core, or the system has no further thread.
            _ => (first(), made),
        }
    })
}

/// Returns how many threads run at the same time.
fn cores() -> usize {
    #[cfg(test)]
    if let Some(cores) = tests::CORES.get() {
        return cores;
    }
    thread::available_parallelism().map_or(1, NonZero::get)
}

#[cfg(test)]
pub mod tests {
    use std::cell::Cell;

    use super::*;

    thread_local! {
        /// The number of cores that this thread counts on, instead of the machine's.
        pub(super) static CORES: Cell<Option<usize>> = const { Cell::new(None) };
    }

    /// Returns what `work` makes as if the machine had so many cores.
    pub fn on_cores<R>(cores: usize, work: impl FnOnce() -> R) -> R {
        CORES.set(Some(cores));
        let result = work();
        CORES.set(None);
        result
    }

    #[test]
    fn two_works_are_both_done_on_any_number_of_cores() {
        for cores in [1, 2, 7] {
            assert_eq!(on_cores(cores, || both(|| 3, || "b")), (3, "b"), "{cores}");
        }
    }

    #[test]
    fn work_is_divided_among_as_many_cores_as_there_are() {
        for cores in [1, 2, 7] {
            assert_eq!(on_cores(cores, || in_ranges(1000, 1, |range| range.len())).len(), cores);
        }
        assert_eq!(CORES.get(), None);
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
    fn parts_are_changed_on_any_number_of_cores() {
        for cores in [1, 2, 7] {
            let mut list = [0; 10];
            let parts = list.chunks_mut(3).enumerate().collect();
            let lengths = on_cores(cores, || {
                in_parts(parts, |(number, part)| {
                    part.fill(*number);
                    part.len()
                })
            });
            assert_eq!((lengths, list), (vec![3, 3, 3, 1], [0, 0, 0, 1, 1, 1, 2, 2, 2, 3]), "{cores}");
        }
        assert!(in_parts(Vec::new(), |(): &mut ()| ()).is_empty());
    }

    #[test]
    #[should_panic(expected = "the last range")]
    fn a_panic_goes_on_in_the_caller() {
        in_ranges(1000, 1, |range| assert!(range.end < 1000, "the last range"));
    }
}
