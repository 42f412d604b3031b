//! A computation beside the interpreter.
//!
//! ```text
//!   Python's thread   waits, and 20 times a second: Ctrl-C? ──▶ the cancel flag;  progress(fraction, stage)
//!   a thread          work(&Exec) ──▶ whole or nothing
//! ```
//!
//! A process that was forked from one that has computed is refused: `fork` copies no threads.
//!
//! The interpreter is free while it waits. Not promised: that a stop comes at once; rooms look for it once per pose.

use crate::refusal::Refusal;
use catchment::exec::Exec;
use pyo3::prelude::*;
use std::panic::resume_unwind;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread;
use std::time::Duration;

/// How long Python's thread waits between two looks.
const PATIENCE: Duration = Duration::from_millis(50);
/// As much as a main thread has.
const STACK_BYTES: usize = 8 << 20;

/// How to run: nothing here changes a bit of a result.
#[derive(FromPyObject)]
pub(crate) struct How {
    /// Worker threads; 0: one per core.
    #[pyo3(item)]
    threads: u16,
    /// Bytes that a result may take; none: three quarters of what is free.
    #[pyo3(item)]
    memory: Option<u64>,
    /// Called with the share that is done and the name of the stage.
    #[pyo3(item)]
    progress: Option<Py<PyAny>>,
}

impl How {
    fn exec(&self) -> Result<Exec, Refusal> {
        let exec = Exec::new().with_threads(usize::from(self.threads))?;
        Ok(match self.memory {
            Some(bytes) => exec.with_memory_budget(bytes),
            None => exec,
        })
    }
}

/// The number of the process that computed first. A fork has its memory and none of its threads: whoever waits for one there waits
/// for ever.
static OWNER: OnceLock<u32> = OnceLock::new();

/// Refuses to compute in a fork.
fn ensure_not_forked() -> Result<(), Refusal> {
    if *OWNER.get_or_init(std::process::id) == std::process::id() {
        return Ok(());
    }
    let message = "this process was forked from one in which catchment had computed, and a fork has none of its threads: start \
                   processes by \"spawn\", as in multiprocessing.get_context(\"spawn\").Pool()";
    Err(Refusal::Compute(message.to_owned()))
}

/// The last thing that was reported.
type LastProgress = Arc<Mutex<Option<(f64, &'static str)>>>;

/// Passes on what was reported, and looks whether Python wants to stop.
fn look(py: Python<'_>, reported: &LastProgress, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    py.check_signals()?;
    let last = reported.lock().unwrap_or_else(PoisonError::into_inner).take();
    if let (Some(progress), Some(last)) = (progress, last) {
        progress.call1(py, last)?;
    }
    Ok(())
}

/// Does work that may take long.
pub(crate) fn work<T: Send>(
    py: Python<'_>,
    how: &How,
    task: impl FnOnce(&Exec) -> Result<T, Refusal> + Send,
) -> PyResult<T> {
    let mut exec = ensure_not_forked().and_then(|()| how.exec()).map_err(|refusal| refusal.raise(py))?;
    let reported = LastProgress::default();
    if how.progress.is_some() {
        let reported = Arc::clone(&reported);
        exec = exec.with_progress(Arc::new(move |fraction, stage| {
            *reported.lock().unwrap_or_else(PoisonError::into_inner) = Some((fraction, stage));
        }));
    }
    let stop = exec.cancel_flag();
    let progress = how.progress.as_ref();
    let (found, raised) = py.detach(|| {
        thread::scope(|scope| {
            let (done, finished) = mpsc::channel::<()>();
            let exec = &exec;
            let task = move || {
                // Gone with the thread, also where it panics: that is what wakes the other.
                let _done = done;
                task(exec)
            };
            let thread = match thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, task) {
                Ok(thread) => thread,
                Err(error) => return (Err(error.into()), None),
            };
            let mut raised: Option<PyErr> = None;
            while let Err(RecvTimeoutError::Timeout) = finished.recv_timeout(PATIENCE) {
                if raised.is_none() {
                    raised = Python::attach(|py| look(py, &reported, progress)).err();
                    if raised.is_some() {
                        stop.store(true, Ordering::Relaxed);
                    }
                }
            }
            (thread.join().unwrap_or_else(|panic| resume_unwind(panic)), raised)
        })
    });
    match (raised, found) {
        (Some(raised), _) => Err(raised),
        (None, found) => {
            look(py, &reported, progress)?;
            found.map_err(|refusal| refusal.raise(py))
        }
    }
}
