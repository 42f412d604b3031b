//! The newest page, and the computation of the next page.
//!
//! ```text
//!   request ──▶ next: only the newest request ───▶ one thread: compute ──▶ page
//!            │                                     ▲
//!            └── cancels the running computation ──┘
//! ```
//!
//! At most one computation runs. A newer request cancels the previous one and replaces it; requests between
//! the two are dropped.

use catchment::exec::Exec;
use catchment::landscape::Resolution;
use catchment::report::page::policy;
use serde_json::json;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};

/// HTML with its content security policy.
#[derive(Debug, Clone)]
pub(super) struct ServedPage {
    pub(super) html: Arc<str>,
    pub(super) policy: Arc<str>,
}

/// Computes a page at a given resolution, or at the default resolution of the design; the error is its
/// message.
type Compute = Box<dyn Fn(Option<Resolution>, &Exec) -> Result<ServedPage, String> + Send + Sync>;

/// The current page and the running computation.
pub(super) struct LivePage {
    compute: Compute,
    threads: usize,
    state: Mutex<State>,
}

/// A requested computation.
struct Request {
    /// Cells per error; `None` for the default of the design.
    resolution: Option<Resolution>,
}

#[derive(Default)]
struct State {
    page: Option<ServedPage>,
    /// The request that has not begun.
    next: Option<Request>,
    /// Cancels the running computation.
    running: Option<Arc<AtomicBool>>,
    is_closed: bool,
    share: f64,
    stage: String,
    failed: Option<String>,
}

const WAITING_STYLE: &str = ":root{color-scheme:light dark}body{font:16px system-ui,sans-serif;margin:20vh auto;max-width:40rem;padding:0 1rem;\
    white-space:pre-wrap}";
const WAITING_SCRIPT: &str = "const note=document.getElementById('note');\
    const poll=async()=>{const p=await(await fetch('progress')).json();\
    if(p.state==='ready')location.reload();\
    else{note.textContent=p.state==='failed'?p.message+'\\n\\nChange the design file and load this page again.':\
    `computing … ${p.stage} ${Math.round(100*p.share)} %`;\
    setTimeout(poll,300)}};poll();";

/// Placeholder page before the first result: it polls the progress and loads the page once it is ready.
static WAITING: LazyLock<ServedPage> = LazyLock::new(|| {
    let html = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>catchment</title><style>{WAITING_STYLE}</style>\
         <p id=\"note\" role=\"status\">computing …</p><script>{WAITING_SCRIPT}</script></html>"
    );
    ServedPage { html: html.into(), policy: policy(&[WAITING_SCRIPT], &[WAITING_STYLE], true).into() }
});

impl LivePage {
    /// Computes nothing before the first request; each computation uses `threads` threads, 0 meaning one per
    /// core.
    pub(super) fn new(
        threads: usize,
        compute: impl Fn(Option<Resolution>, &Exec) -> Result<ServedPage, String> + Send + Sync + 'static,
    ) -> Self {
        Self { compute: Box::new(compute), threads, state: Mutex::default() }
    }

    fn locked(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The newest page. If no page exists because the last computation failed, this call computes again.
    pub(super) fn page(self: &Arc<Self>) -> ServedPage {
        let state = self.locked();
        if let Some(page) = &state.page {
            return page.clone();
        }
        let again = state.running.is_none() && state.failed.is_some();
        drop(state);
        if again {
            self.start(None);
        }
        WAITING.clone()
    }

    /// State (`running`, `ready`, `failed`), completed share, stage and error message, as JSON.
    pub(super) fn progress(&self) -> String {
        let State { running, share, stage, failed, .. } = &*self.locked();
        let state = match (running, failed) {
            (Some(_), _) => "running",
            (None, Some(_)) => "failed",
            (None, None) => "ready",
        };
        json!({ "state": state, "share": share, "stage": stage, "message": failed }).to_string()
    }

    /// Requests another page: at the given resolution, or at the previous one. Returns whether it replaces a
    /// running computation.
    ///
    /// # Errors
    /// The text is not a number of cells.
    pub(super) fn request(self: &Arc<Self>, cells: &str) -> Result<bool, String> {
        let resolution = match cells.trim() {
            "" => None,
            text => Some(text.parse::<Resolution>().map_err(|error| error.to_string())?),
        };
        Ok(self.start(resolution))
    }

    /// Starts a computation and cancels the running one. Returns whether one was running.
    pub(super) fn start(self: &Arc<Self>, resolution: Option<Resolution>) -> bool {
        let mut state = self.locked();
        if state.is_closed {
            return false;
        }
        (state.next, state.share, state.failed) = (Some(Request { resolution }), 0.0, None);
        "design".clone_into(&mut state.stage);
        if let Some(older) = &state.running {
            older.store(true, Ordering::Relaxed);
            return true;
        }
        state.running = Some(Arc::default());
        drop(state);
        let desk = Arc::clone(self);
        let started = std::thread::Builder::new().name("page".to_owned()).spawn(move || desk.work());
        if let Err(error) = started {
            let mut state = self.locked();
            (state.running, state.next, state.failed) = (None, None, Some(error.to_string()));
        }
        false
    }

    /// Processes the newest request until no request remains.
    fn work(self: &Arc<Self>) {
        loop {
            let mut state = self.locked();
            let Some(Request { resolution }) = state.next.take() else {
                state.running = None;
                return;
            };
            let exec = Exec::new();
            state.running = Some(exec.cancel_flag());
            drop(state);
            let result = self.compute(resolution, exec);
            let mut state = self.locked();
            // Discard the result of a replaced computation, whatever its outcome.
            if state.next.is_some() {
                continue;
            }
            match result {
                Ok(page) => state.page = Some(page),
                Err(why) => state.failed = Some(why),
            }
        }
    }

    fn compute(self: &Arc<Self>, resolution: Option<Resolution>, exec: Exec) -> Result<ServedPage, String> {
        let desk = Arc::downgrade(self);
        let progress = move |share: f64, stage: &str| {
            let Some(desk) = desk.upgrade() else { return };
            let mut state = desk.locked();
            if state.next.is_none() {
                state.share = share;
                stage.clone_into(&mut state.stage);
            }
        };
        let exec = exec.with_threads(self.threads).map_err(|error| error.to_string())?;
        let exec = exec.with_progress(Arc::new(progress));
        // The panic hook has printed the location; the server continues.
        catch_unwind(AssertUnwindSafe(|| (self.compute)(resolution, &exec))).unwrap_or_else(|_| {
            Err("a bug of the program ended the computation; the terminal shows where".to_owned())
        })
    }

    /// Cancels the running computation and accepts no further requests.
    pub(super) fn close(&self) {
        let mut state = self.locked();
        (state.is_closed, state.next) = (true, None);
        if let Some(running) = &state.running {
            running.store(true, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;

    fn served(text: &str) -> ServedPage {
        ServedPage { html: text.into(), policy: "".into() }
    }

    fn cells(resolution: Option<Resolution>) -> String {
        resolution.map_or_else(|| "own".to_owned(), |resolution| resolution.to_string())
    }

    /// Waits for a state; the waiting time does not affect the result.
    fn until(desk: &LivePage, state: &str) {
        while !desk.progress().contains(&format!("\"state\":\"{state}\"")) {
            std::thread::yield_now();
        }
    }

    /// The first computation ends only by cancellation, and the intermediate requests never begin.
    #[test]
    fn a_newer_request_cancels_the_older_one_and_takes_its_place() {
        let (begun, begins) = mpsc::channel();
        let desk = Arc::new(LivePage::new(1, move |resolution, exec: &Exec| {
            let name = cells(resolution);
            begun.send(name.clone()).unwrap();
            while name == "own" && !exec.is_cancelled() {
                std::thread::yield_now();
            }
            // The result of a cancelled computation is discarded.
            Ok(served(&name))
        }));
        assert!(!desk.start(None));
        assert_eq!(begins.recv().unwrap(), "own");
        assert!(desk.progress().contains("\"running\""));
        assert!(desk.request("many").is_err());
        let (older, newer) = (desk.request("7"), desk.request("9"));
        assert!(older.unwrap() && newer.is_ok());
        until(&desk, "ready");
        assert_eq!(&*desk.page().html, "9");
        let rest: Vec<String> = begins.try_iter().collect();
        // 7 may have begun before the request for 9.
        assert!(rest == ["9"] || rest == ["7", "9"], "{rest:?}");
        assert!(!desk.request("").unwrap(), "nothing ran");
        desk.close();
    }

    #[test]
    fn a_failure_is_reported_and_the_last_page_stays() {
        let desk = Arc::new(LivePage::new(1, |resolution, _: &Exec| match cells(resolution).as_str() {
            "own" => Err("no design".to_owned()),
            "13" => panic!("a bug"),
            name => Ok(served(name)),
        }));
        desk.start(None);
        until(&desk, "failed");
        assert!(desk.progress().contains("no design"));
        desk.request("5").unwrap();
        until(&desk, "ready");
        desk.request("13").unwrap();
        until(&desk, "failed");
        assert!(desk.progress().contains("a bug of the program"));
        assert_eq!(&*desk.page().html, "5");
        desk.close();
        desk.start(None);
        assert!(desk.progress().contains("a bug of the program"), "nothing begins any more");
    }
}
