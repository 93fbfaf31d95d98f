//! Divides work among the processor's cores, by rayon's threads.

use std::io;
use std::ops::Range;
use std::sync::mpsc::{Sender, channel};

use rayon::prelude::*;
use rayon::{ThreadBuilder, ThreadPoolBuildError, ThreadPoolBuilder};

/// Starts the threads that all work is divided among: one a core, or as many as the system starts. A program calls it
/// before any work; where nobody did, the first work starts one a core, and panics if the system refuses one.
///
/// # Errors
/// The system starts no thread at all.
pub fn start() -> Result<(), Box<dyn std::error::Error>> {
    // Rayon's pool can't be built again with fewer threads, so they are started before it.
    let threads = as_many_as_start(std::thread::available_parallelism()?.get(), |work| {
        std::thread::Builder::new().spawn(work).map(drop)
    })?;
    let pool = ThreadPoolBuilder::new().num_threads(threads.len());
    Ok(pool
        .spawn_handler(|thread| threads[thread.index()].send(thread).map_err(|_| io::ErrorKind::Other.into()))
        .build_global()?)
}

/// Starts up to `most` threads, each of which waits for its place in a pool. Fails if none starts.
fn as_many_as_start(
    most: usize,
    start: impl Fn(Box<dyn FnOnce() + Send>) -> io::Result<()>,
) -> io::Result<Vec<Sender<ThreadBuilder>>> {
    let mut threads = Vec::new();
    while threads.len() < most {
        let (thread, place) = channel();
        match start(Box::new(move || place.recv().into_iter().for_each(ThreadBuilder::run))) {
            Ok(()) => threads.push(thread),
            Err(error) if threads.is_empty() => return Err(error),
            Err(_) => break,
        }
    }
    Ok(threads)
}

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

/// Cuts the numbers below `count` into blocks of `size` numbers, which cores take one after another, and returns what `work`
/// makes of each block, in the order of the blocks.
pub fn in_blocks<R: Send>(count: usize, size: usize, work: impl Fn(Range<usize>) -> R + Sync) -> Vec<R> {
    let block = |number: usize| work(number * size..count.min((number + 1) * size));
    (0..count.div_ceil(size)).into_par_iter().map(block).collect()
}

/// Does `work` with each item of a list, on all cores.
///
/// # Errors
/// One of those of `work`. Others may then not be done.
pub fn each<T: Sync, E: Send>(list: &[T], work: impl Fn(&T) -> Result<(), E> + Sync) -> Result<(), E> {
    list.par_iter().try_for_each(&work)
}

/// Replaces each item of a list by what `make` makes of its index, on all cores, each of which has at least `least` items.
pub fn fill<T: Send>(list: &mut [T], least: usize, make: impl Fn(usize) -> T + Sync) {
    list.par_iter_mut().enumerate().with_min_len(least).for_each(|(i, item)| *item = make(i));
}

/// Divides a list into parts of so many items each.
pub fn split<T>(mut list: &mut [T], lengths: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    lengths.map(|length| list.split_off_mut(..length).unwrap_or_default()).collect()
}

/// Does `work` with so many threads in place of one a core.
///
/// # Errors
/// The system can't start another thread.
pub fn on_threads<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> Result<R, ThreadPoolBuildError> {
    if threads == rayon::current_num_threads() {
        return Ok(work());
    }
    Ok(ThreadPoolBuilder::new().num_threads(threads).build()?.install(work))
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn work_is_divided_among_as_many_threads_as_there_are() {
        for threads in [1, 2, 7] {
            let ranges = on_threads(threads, || in_ranges(1000, 1, |range| range.len())).expect("threads");
            assert_eq!(ranges.len(), threads);
        }
    }

    #[test]
    fn lists_are_filled_and_errors_come_back() {
        for threads in [1, 2, 7] {
            let mut list = vec![0; 1000];
            on_threads(threads, || fill(&mut list, 1, |i| 3 * i)).expect("threads");
            assert!(list.iter().enumerate().all(|(i, item)| *item == 3 * i), "{threads}");
            let done = |&item: &usize| if item == 3 * 700 { Err(item) } else { Ok(()) };
            assert_eq!(on_threads(threads, || each(&list, done)).expect("threads"), Err(3 * 700));
            assert_eq!(on_threads(threads, || each(&list[..700], done)).expect("threads"), Ok(()));
        }
    }

    #[test]
    fn as_many_threads_start_as_the_system_gives() {
        for given in 1..=4 {
            let started = Cell::new(0);
            let start = |_| {
                started.set(started.get() + 1);
                if started.get() <= given { Ok(()) } else { Err(io::Error::other("no more")) }
            };
            let threads = as_many_as_start(3, start);
            assert_eq!(threads.expect("one starts").len(), given.min(3));
        }
        assert!(as_many_as_start(3, |_| Err(io::Error::other("none"))).is_err());
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
