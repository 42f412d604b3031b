//! Pose errors in text form: single lines, tables, and distributions.
//!
//! ```text
//!   x=0.2,pitch=10 deg       one pose error                     parse_pose          ──▶ PoseError
//!
//!   part, x_mm, pitch_deg    a table: x, y, roll, pitch, yaw,   PoseTable::parse    ──▶ PoseError per row,
//!   A17,   2.5,        10    other columns carried through                              columns carried through
//!
//!   trial, x_mm, outcome     results of robot trials      TriedTable::parse   ──▶ Tried per row
//!
//!   x=5,y=5  0..45:2.25 deg  counts, angles               parse_counts, parse_angles
//!
//!   x=1 mm,yaw=2 deg         expected errors                    Distribution::normal, Distribution::uniform
//!
//!   [[robot]] sigma = { … }  robots, and the distributions      read_robots         ──▶ Robot { name, errors: Spread }
//!                            of their errors: a TOML file
//!
//!   [dynamics] speed = …     distributions of speed, mass, …    read_dynamics       ──▶ Dynamics
//! ```
//!
//! Bare numbers are in D and radians. x and y are the offset of the moving face centre, unless [`OffsetsAt`]
//! selects the centre of rotation. A text is read completely or rejected with all its errors ([`Diagnostics`](catchment_base::diagnostic::Diagnostics)),
//! each [`Diagnostic`] with its byte range in the text.
//!
//! Not promised: that a pose can be reached, or that the halves meet there. Only values of locked errors, and
//! values outside any sensible unit, are rejected.

pub mod covariance;
mod distribution;
pub(crate) mod dynamics;
mod fields;
mod header;
mod lists;
mod offsets;
mod robot_trials;
mod robots;
mod rows;
mod table;
mod terms;
mod text;
mod written;

pub use covariance::Matrix;
pub use distribution::{Distribution, parse_sizes};
pub use dynamics::{Circumstance, Dynamics, ScalarDistribution, parse_draw, read_dynamics};
pub use lists::{MOST_ANGLES, parse_angles, parse_counts, parse_length};
pub use offsets::OffsetsAt;
pub use robot_trials::{ObservedOutcome, RobotTrial, RobotTrialTable};
pub use robots::{MOST_ROBOTS, Moments, NotACovariance, Robot, Spread, read_robots};
pub use rows::check_rows;
pub use table::{MOST_POSES, PoseTable};
pub use terms::parse_pose;
pub use text::{LARGEST_TEXT, TextError, read_text};

use catchment_base::diagnostic::Diagnostic;

/// The family of errors of this room.
const FAMILY: &str = "poses";

/// An error, before its place is known.
fn defect(message: impl Into<String>, help: impl Into<String>) -> Diagnostic {
    Diagnostic::error(FAMILY, message, Some(help.into()))
}

/// The first characters, without control characters and invisible characters.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    text.chars().take(LONGEST).map(|c| if is_hidden(c) { '\u{fffd}' } else { c }).collect()
}

/// Whether a character is a control character or invisible: a byte order mark, a blank without width, a mark
/// that changes the direction of writing.
fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}
