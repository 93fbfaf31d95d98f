//! Jobs that run on threads of their own while the window goes on. A job that panics ends with an error; the window isn't
//! affected.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, channel};
use std::thread::JoinHandle;

use thiserror::Error;

use crate::app::text::shortened;

/// The greatest length of a panic's message that is shown, in characters.
const MAX_REASON: usize = 200;

/// Why a job ended without a result.
#[derive(Debug, Error)]
#[error("stopped unexpectedly ({0})")]
pub(crate) struct Stopped(String);

pub(crate) struct BackgroundJob<T>(Receiver<Result<T, Stopped>>);

impl<T: Send + 'static> BackgroundJob<T> {
    /// Starts a job. The window is repainted when it ends, even if it panics.
    pub(crate) fn start(context: &egui::Context, job: impl FnOnce() -> T + Send + 'static) -> Self {
        Self(sent(Some(context), || Some(caught(job))))
    }

    /// Returns the result once the job has ended, and only once.
    pub(crate) fn take(&self) -> Option<Result<T, Stopped>> {
        self.0.try_recv().ok()
    }
}

/// Starts a thread that sends a result, if there is one, and repaints a window. If the system refuses, that is the result.
pub(super) fn sent<T: Send + 'static>(
    context: Option<&egui::Context>,
    result: impl FnOnce() -> Option<Result<T, Stopped>> + Send + 'static,
) -> Receiver<Result<T, Stopped>> {
    let (sender, done) = channel();
    let (refused, context) = (sender.clone(), context.cloned());
    let thread = spawn(move || {
        // The receiver is gone if the result is no longer wanted.
        let _ = result().map(|result| sender.send(result));
        context.iter().for_each(egui::Context::request_repaint);
    });
    if thread.is_none() {
        let _ = refused.send(Err(Stopped("the system can't start another thread".into())));
    }
    done
}

/// Starts a thread. Returns none if the system refuses.
pub(crate) fn spawn(job: impl FnOnce() + Send + 'static) -> Option<JoinHandle<()>> {
    std::thread::Builder::new().spawn(job).ok()
}

/// Runs a job that may panic.
///
/// # Errors
/// The panic's message.
pub(crate) fn caught<T>(job: impl FnOnce() -> T) -> Result<T, Stopped> {
    // A panic can't leave shared state half changed: jobs share nothing with the window but what they send.
    catch_unwind(AssertUnwindSafe(job)).map_err(|panic| Stopped(words(panic.as_ref())))
}

fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    let first = text.and_then(|text| text.lines().next()).unwrap_or("no reason given");
    shortened(first, MAX_REASON)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::{Duration, Instant};

    use super::*;

    /// A job's result, and how often the window was asked to repaint.
    fn ended<T: Send + 'static>(job: impl FnOnce() -> T + Send + 'static) -> (Result<T, Stopped>, usize) {
        let context = egui::Context::default();
        let repaints = Arc::new(AtomicUsize::new(0));
        let counted = repaints.clone();
        context.set_request_repaint_callback(move |_| {
            counted.fetch_add(1, Ordering::SeqCst);
        });
        let (beside, start) = (BackgroundJob::start(&context, job), Instant::now());
        // The result is sent before the window is asked to repaint.
        while repaints.load(Ordering::SeqCst) == 0 {
            assert!(start.elapsed() < Duration::from_secs(30), "it hasn't ended");
            std::thread::sleep(Duration::from_millis(1));
        }
        (beside.take().expect("an end"), repaints.load(Ordering::SeqCst))
    }

    #[test]
    fn a_job_returns_its_result_and_repaints_the_window() {
        let (result, repaints) = ended(|| 6 * 7);
        assert_eq!((result.ok(), repaints), (Some(42), 1));
    }

    #[test]
    fn a_result_is_taken_once() {
        let (go, wait) = channel::<()>();
        let job = BackgroundJob::start(&egui::Context::default(), move || wait.recv().is_ok());
        assert!(job.take().is_none(), "it is under way");
        drop(go);
        let result = loop {
            match job.take() {
                Some(result) => break result,
                None => std::thread::yield_now(),
            }
        };
        assert!(result.is_ok_and(|went| !went));
        assert!(job.take().is_none(), "nothing more is to come");
    }

    #[test]
    fn a_job_that_panics_returns_its_message_and_repaints_the_window() {
        let (result, repaints) = ended(|| [1, 2, 3][std::hint::black_box(5)]);
        let said = result.expect_err("it panicked").to_string();
        assert_eq!(said, "stopped unexpectedly (index out of bounds: the len is 3 but the index is 5)");
        assert_eq!(repaints, 1);
        let (result, _) = ended(|| std::panic::panic_any(7));
        assert!(result.is_err_and(|stopped: Stopped| stopped.to_string().ends_with("(no reason given)")));
        let long = caught(|| panic!("{}\nand more", "x".repeat(1000))).expect_err("it panicked").to_string();
        assert!(long.chars().count() < 240 && !long.contains("more"), "{long}");
    }
}
