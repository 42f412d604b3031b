//! Exact motions in a web page: the core of the library as plain functions that any WebAssembly host can call.
//!
//! ```text
//!   input(n) ─▶ address of n bytes    the page writes there:  design (JSON) · fixed half · moving half   (Half::to_bytes)
//!   load(design, fixed) ─▶ 0 or 1     lengths of the first two; 1: output is the error message
//!   trace(x, y, roll, pitch, yaw, friction) ─▶ 0 or 1
//!   output() · output_length()        the JSON of `catchment trace`, or the error message, UTF-8
//! ```
//!
//! A trace has the numbers of the library, computed by the same code. Not promised: the last bits, where another machine rounds
//! sines and cosines differently. Memory is passed by address and length in safe code. A panic ends the module, and the page
//! starts another.

use catchment::connector::Half;
use catchment::design::Design;
use catchment::method::descent::DescentSettings;
use catchment::pose::PoseError;
use catchment::problem::Problem;
use catchment::report::TraceReport;
use std::fmt::Display;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Input from the page, output to the page, and the loaded problem.
struct Desk {
    input: Vec<u8>,
    output: Vec<u8>,
    problem: Option<Problem>,
}

static DESK: Mutex<Desk> = Mutex::new(Desk { input: Vec::new(), output: Vec::new(), problem: None });

fn desk() -> MutexGuard<'static, Desk> {
    DESK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Success: the output holds the result.
const DONE: u32 = 0;
/// Failure: the output holds the reason.
const REFUSED: u32 = 1;

impl Desk {
    fn answer(&mut self, stated: Result<String, String>) -> u32 {
        let (text, status) = match stated {
            Ok(text) => (text, DONE),
            Err(text) => (text, REFUSED),
        };
        self.output = text.into_bytes();
        status
    }
}

fn message(error: impl Display) -> String {
    error.to_string()
}

/// Parses the problem in the input.
fn problem(input: &[u8], design: usize, fixed: usize) -> Result<Problem, String> {
    let cut = || format!("the input has {} bytes, fewer than announced", input.len());
    let (design, halves) = input.split_at_checked(design).ok_or_else(cut)?;
    let (fixed, moving) = halves.split_at_checked(fixed).ok_or_else(cut)?;
    let design: Design = serde_json::from_slice(design).map_err(message)?;
    let [fixed, moving] = [fixed, moving].map(Half::from_bytes);
    Problem::of_halves(design, fixed.map_err(message)?, moving.map_err(message)?).map_err(message)
}

/// Address of `length` bytes of input.
#[expect(unsafe_code, reason = "a name for the page to call by")]
#[unsafe(no_mangle)]
pub extern "C" fn input(length: usize) -> usize {
    let mut desk = desk();
    desk.input = vec![0; length];
    desk.input.as_ptr().addr()
}

/// Loads the problem from the input: the design in the first bytes, then the halves.
#[expect(unsafe_code, reason = "a name for the page to call by")]
#[unsafe(no_mangle)]
pub extern "C" fn load(design: usize, fixed: usize) -> u32 {
    let mut desk = desk();
    let input = std::mem::take(&mut desk.input);
    match problem(&input, design, fixed) {
        Ok(problem) => {
            desk.problem = Some(problem);
            desk.answer(Ok(String::new()))
        }
        Err(error) => desk.answer(Err(error)),
    }
}

/// Follows a pose error, in D and radians, to its end.
#[expect(unsafe_code, reason = "a name for the page to call by")]
#[unsafe(no_mangle)]
pub extern "C" fn trace(x: f64, y: f64, roll: f64, pitch: f64, yaw: f64, friction: f64) -> u32 {
    let mut desk = desk();
    let start = PoseError { x, y, roll, pitch, yaw };
    let traced = || -> Result<String, String> {
        let problem = desk.problem.as_ref().ok_or("no problem was loaded")?;
        if !start.to_array().into_iter().all(f64::is_finite) {
            return Err("a pose error is no number".to_owned());
        }
        let settings = DescentSettings::with_friction(friction).map_err(message)?;
        let (path, reason) = problem.trace(&start, &settings);
        TraceReport::new(problem, &settings, start, &path, reason).to_json().map_err(message)
    };
    let stated = traced();
    desk.answer(stated)
}

/// Address of the output.
#[expect(unsafe_code, reason = "a name for the page to call by")]
#[unsafe(no_mangle)]
pub extern "C" fn output() -> usize {
    desk().output.as_ptr().addr()
}

/// Length of the output in bytes.
#[expect(unsafe_code, reason = "a name for the page to call by")]
#[unsafe(no_mangle)]
pub extern "C" fn output_length() -> usize {
    desk().output.len()
}
