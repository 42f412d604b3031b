//! Runs a computation in a thread beside the interpreter.
//!
//! ```text
//!   Python's thread   waits, and 20 times a second: Ctrl-C? ──▶ cancel flag;  progress(fraction, stage)
//!   a thread          work(&Exec) ──▶ complete result or nothing
//! ```
//!
//! A process that was forked after a computation is refused: `fork` copies no threads.
//!
//! The interpreter is released during the wait. Not promised: an immediate stop; computations check the cancel flag once per pose.

use crate::refusal::Refusal;
use catchment::exec::Exec;
use pyo3::prelude::*;
use std::panic::resume_unwind;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread;
use std::time::Duration;

/// Interval at which Python's thread checks for Ctrl-C and progress.
const PATIENCE: Duration = Duration::from_millis(50);
/// Stack of the computing thread: the size of the stack of a main thread.
const STACK_BYTES: usize = 8 << 20;

/// Execution settings: they change no bit of a result.
#[derive(FromPyObject)]
pub(crate) struct How {
    /// Worker threads; 0 uses every core.
    #[pyo3(item)]
    threads: u16,
    /// Memory budget of a result, in bytes; `None`: three quarters of the free memory.
    #[pyo3(item)]
    memory: Option<u64>,
    /// Callback that takes the completed share and the name of the stage.
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

/// Id of the first process that computed. A fork has its memory and no threads: a wait for a thread in the fork never
/// ends.
static OWNER: OnceLock<u32> = OnceLock::new();

/// Returns an error in a forked process.
fn ensure_not_forked() -> Result<(), Refusal> {
    if *OWNER.get_or_init(std::process::id) == std::process::id() {
        return Ok(());
    }
    let message = "this process was forked from one in which catchment had computed, and a fork has none of its threads: start \
                   processes by \"spawn\", as in multiprocessing.get_context(\"spawn\").Pool()";
    Err(Refusal::Compute(message.to_owned()))
}

/// The last reported progress.
type LastProgress = Arc<Mutex<Option<(f64, &'static str)>>>;

/// Passes the reported progress to the callback, and checks for signals such as Ctrl-C.
fn look(py: Python<'_>, reported: &LastProgress, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    py.check_signals()?;
    let last = reported.lock().unwrap_or_else(PoisonError::into_inner).take();
    if let (Some(progress), Some(last)) = (progress, last) {
        progress.call1(py, last)?;
    }
    Ok(())
}

/// Runs a long task; the interpreter stays responsive.
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
    let (result, raised) = py.detach(|| {
        thread::scope(|scope| {
            let (done, finished) = mpsc::channel::<()>();
            let exec = &exec;
            let task = move || {
                // Dropped when the thread ends, even by a panic; the drop wakes the waiting thread.
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
    match (raised, result) {
        (Some(raised), _) => Err(raised),
        (None, result) => {
            look(py, &reported, progress)?;
            result.map_err(|refusal| refusal.raise(py))
        }
    }
}
