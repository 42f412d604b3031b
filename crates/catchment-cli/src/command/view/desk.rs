//! What is served: the newest page, and the one that is being computed.

use crate::args::DesignArgs;
use crate::command::report::MadeArgs;
use crate::failure::Failure;
use catchment::exec::Exec;
use catchment::landscape::Resolution;
use catchment::terminal::printable;
use serde_json::json;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The newest page, and how far the next one is.
pub(super) struct Desk {
    design: DesignArgs,
    made: MadeArgs,
    threads: usize,
    state: Mutex<State>,
    stop: Mutex<Option<Arc<AtomicBool>>>,
}

#[derive(Default)]
struct State {
    page: Option<String>,
    running: bool,
    share: f64,
    stage: String,
    failed: Option<String>,
}

/// What a browser sees until there is a page: it asks how far it is, and comes again.
const WAITING: &str = "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>catchment</title>\
    <style>:root{color-scheme:light dark}body{font:16px system-ui,sans-serif;margin:20vh auto;max-width:40rem;padding:0 1rem;\
    white-space:pre-wrap}</style><p id=\"said\" role=\"status\">computing …</p><script>\
    const said=document.getElementById('said');\
    const ask=async()=>{const p=await(await fetch('progress')).json();\
    if(p.state==='ready')location.reload();\
    else{said.textContent=p.state==='failed'?p.message+'\\n\\nChange the design file and load this page again.':\
    `computing … ${p.stage} ${Math.round(100*p.share)} %`;\
    setTimeout(ask,300)}};ask();</script></html>";

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Desk {
    pub(super) fn new(design: DesignArgs, made: MadeArgs, threads: usize) -> Self {
        Self { design, made, threads, state: Mutex::default(), stop: Mutex::default() }
    }

    /// The newest page. Where the last one could not be computed, loading it asks again.
    pub(super) fn page(self: &Arc<Self>) -> String {
        let state = locked(&self.state);
        if let Some(page) = &state.page {
            return page.clone();
        }
        let again = !state.running && state.failed.is_some();
        drop(state);
        if again {
            self.start(None);
        }
        WAITING.to_owned()
    }

    /// How far it is, as JSON.
    pub(super) fn progress(&self) -> String {
        let State { running, share, stage, failed, .. } = &*locked(&self.state);
        let state = match (running, failed) {
            (true, _) => "running",
            (false, Some(_)) => "failed",
            (false, None) => "ready",
        };
        json!({ "state": state, "share": share, "stage": stage, "message": failed }).to_string()
    }

    /// A page asks for another: over so many cells, or as before.
    pub(super) fn ask(self: &Arc<Self>, cells: &str) -> Result<(), String> {
        let resolution = match cells.trim() {
            "" => None,
            text => Some(text.parse::<Resolution>().map_err(|error| error.to_string())?),
        };
        if self.start(resolution) { Ok(()) } else { Err("one is being computed already".to_owned()) }
    }

    /// Computes another page, unless one is being computed.
    pub(super) fn start(self: &Arc<Self>, resolution: Option<Resolution>) -> bool {
        let mut state = locked(&self.state);
        if state.running {
            return false;
        }
        (state.running, state.share, state.failed) = (true, 0.0, None);
        "design".clone_into(&mut state.stage);
        drop(state);
        let desk = Arc::clone(self);
        let computing =
            std::thread::Builder::new().name("page".to_owned()).spawn(move || desk.compute(resolution));
        if let Err(error) = computing {
            let mut state = locked(&self.state);
            (state.running, state.failed) = (false, Some(error.to_string()));
        }
        true
    }

    fn compute(self: &Arc<Self>, resolution: Option<Resolution>) {
        let made = self.made.over(resolution);
        let told = Arc::downgrade(self);
        let found = (|| -> Result<String, Failure> {
            let exec =
                Exec::new().with_threads(self.threads)?.with_progress(Arc::new(move |share, stage| {
                    if let Some(desk) = told.upgrade() {
                        let mut state = locked(&desk.state);
                        state.share = share;
                        stage.clone_into(&mut state.stage);
                    }
                }));
            *locked(&self.stop) = Some(exec.cancel_flag());
            let parts = made.parts(&self.design.problem()?, &exec)?;
            let mut page = parts.page();
            page.is_served = true;
            Ok(page.html(&exec)?)
        })();
        let mut state = locked(&self.state);
        state.running = false;
        match found {
            Ok(page) => state.page = Some(page),
            Err(failure) => {
                state.failed = Some(failure.text().lines().map(printable).collect::<Vec<_>>().join("\n"));
            }
        }
    }

    /// Gives up what is being computed.
    pub(super) fn stop(&self) {
        if let Some(stop) = &*locked(&self.stop) {
            stop.store(true, Ordering::Relaxed);
        }
    }
}
