//! Tolerances of a connector that cannot tilt: x, y and yaw free, roll and pitch locked.
//!
//! ```text
//!   all five errors free          roll and pitch locked
//!        ╱▔▔╱                          ▔▔▔▔            a mount compliant in tilt accepts more x and y:
//!     ──┘  ╱ ┌──                    ──┐    ┌──          the half tips into its seat
//!        ╲╱  │                        └────┘
//! ```
//!
//! The window has the proportions of the single-axis limits, so that its corners show the share of these
//! limits that holds simultaneously.
//!
//! Not promised: more than [`window`](super::window) promises for the same number of samples. Lengths in D,
//! angles in radians.

use super::RunError;
use super::window::{Effort, WindowSettings, window_of, within};
use crate::acceptance::Domain;
use crate::exec::Exec;
use crate::landscape::Grid;
use crate::merit::centered::CenteredBox;
use crate::merit::tolerance::{Tolerance, followed};
use crate::method::descent;
use crate::pose::{Dof, DofSet, PoseError};
use crate::problem::Problem;
use serde::{Deserialize, Serialize};

/// Figures of merit of the connector with roll and pitch locked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Upright {
    /// The largest box around zero in which every sampled pose docks, in the proportions of the tolerances;
    /// its edge is a multiple of these.
    pub window: CenteredBox,
    /// Single-axis limits of each error.
    pub tolerances: Vec<Tolerance>,
}

/// Errors that stay free.
const LEVEL: [Dof; 3] = [Dof::X, Dof::Y, Dof::Yaw];

impl Upright {
    /// For a problem with all five errors free; `None` for others, and if the mated pose is not stable with
    /// roll and pitch locked.
    ///
    /// # Errors
    /// The computation was cancelled.
    pub(super) fn of(
        problem: &Problem,
        steps: usize,
        by: &Effort<'_>,
        exec: &Exec,
    ) -> Result<Option<Self>, RunError> {
        if problem.alignment().free != DofSet::ALL {
            return Ok(None);
        }
        let mut design = problem.design().clone();
        design.alignment.free = LEVEL.into_iter().collect();
        let held = problem.with(design).ok().filter(|problem| problem.ensure_held().is_ok());
        let Some(problem) = held else { return Ok(None) };
        let axes = Grid::over(problem.alignment(), |_| 1);
        let tolerances = followed(&axes, steps, |poses| {
            let decided = descent::run(problem.pair(), Domain::Poses(poses), by.motions, exec)?;
            Ok::<_, RunError>(decided.0.outcomes)
        })?;
        let mut proportions = [0.0; 5];
        for tolerance in &tolerances {
            proportions[tolerance.axis.index()] = tolerance.symmetric();
        }
        let settings = WindowSettings {
            proportions: Some(PoseError::from_array(proportions)),
            seed: by.seed,
            friction: by.motions.friction,
            ..WindowSettings::default()
        };
        let window = window_of(&problem, &settings, by, exec)?;
        Ok(window.map(|window| Self { window: within(&window, &tolerances), tolerances }))
    }
}
