//! The common interface of all methods.
//!
//! ```text
//!                 ┌ info       name, what it does, where it belongs
//!   Method ───────┤ settings   what changes its answer: read, changed and stored as JSON
//!  (any of the    ├ applies_to, cost, defaults            before anything is computed
//!   registry)     ├ decide(problem, domain) ──▶ MethodOutput   outcomes · doubts · by-products · settings as used
//!                 └ follow(problem, poses)  ──▶ ends      only methods that decide each pose by itself
//! ```
//!
//! A method is a type that implements [`Decide`], in its own folder, and a line in
//! [`REGISTRY`](super::REGISTRY). All other code, the command line, the run and the studies, uses only this
//! interface. It is a trait and not an enum, because every use of an enum of all methods would have to match
//! on the method, which this interface avoids.
//!
//! A method for translation alone ([`zraa`](super::zraa)) stands outside of it.

use super::descent::{self, End};
use crate::acceptance::{Acceptance, Domain, Warning};
use crate::contact::Pair;
use crate::design::Design;
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::landscape::{Grid, Landscape};
use crate::method::certified::BoxCertificate;
use crate::method::confluence::Joined;
use crate::method::flood::{Hierarchy, Watersheds};
use crate::method::partition::Partition;
use crate::method::registry::Method;
use crate::problem::Problem;
use serde_json::Value;
use std::fmt;
use std::time::Duration;

/// What is known of a method without asking it anything.
#[derive(Debug, PartialEq, Eq)]
pub struct Info {
    /// The lower-case name used in files, reports and options.
    pub name: &'static str,
    /// What it does, in a line.
    pub summary: &'static str,
    /// Whether its answer depends on nothing but the grid and its resolution: what studies of resolution compare.
    pub on_grids: bool,
    /// Whether it departs from exact frictionless motion on purpose, so that pictures show its own cells and no slices followed
    /// exactly.
    pub departs: bool,
}

/// What a decision will take, estimated before it is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// What it is that needs the memory.
    pub what: &'static str,
    /// Bytes per cell at the peak.
    pub bytes_per_cell: u64,
    /// Core-seconds, to a factor of a few: threads share them.
    pub seconds: f64,
}

/// A way to decide what becomes of pose errors.
pub trait DecisionMethod: fmt::Debug + Send + Sync {
    /// What is known of it beforehand.
    fn info(&self) -> &'static Info;

    /// What changes its answer, as JSON: what [`Method`](super::Method) reads and writes.
    fn settings(&self) -> Value;

    /// The same for one problem, with everything filled in that depends on it; as stored with the result.
    fn settings_for(&self, _problem: &Problem) -> Value {
        self.settings()
    }

    /// Refuses settings that nothing can be decided with.
    ///
    /// # Errors
    /// The first setting that is out of its range.
    fn check(&self) -> Result<(), DecideError> {
        Ok(())
    }

    /// Whether it can decide a design.
    ///
    /// # Errors
    /// When it cannot, with the reason.
    fn applies_to(&self, _design: &Design) -> Result<(), NotApplicable> {
        Ok(())
    }

    /// Cells per axis when nothing was said, for one to five axes: an answer within seconds.
    fn default_cells(&self, pair: &Pair) -> [usize; 5];

    /// Random poses followed exactly to correct the Sum when nothing was said.
    fn default_samples(&self, _pair: &Pair) -> usize {
        0
    }

    /// What deciding a grid will take.
    fn cost(&self, problem: &Problem, grid: &Grid) -> Cost;

    /// What it knows beside the outcomes, by the names of [`ByProducts`].
    fn by_products(&self) -> &'static [&'static str] {
        &[]
    }

    /// Decides every pose of a domain.
    ///
    /// # Errors
    /// See [`DecideError`].
    fn decide(&self, problem: &Problem, domain: &Domain, exec: &Exec) -> Result<MethodOutput, DecideError>;

    /// How it follows motions, and how random poses beside it are followed.
    fn motions(&self) -> descent::DescentSettings {
        descent::DescentSettings::default()
    }

    /// The same method for so much time, where it has something to tell when the time is over; what takes its time anyway has not.
    fn within(&self, _budget: Duration) -> Option<Method> {
        None
    }

    /// The same method pose by pose, where each is decided by itself.
    fn follows(&self) -> Option<&dyn PoseMethod> {
        None
    }
}

/// Told the number of a pose and where it ends, from any thread and in any order, once for each.
pub type PoseObserver<'a> = &'a (dyn Fn(usize, End) + Sync);

/// A method that decides each pose by itself.
pub trait PoseMethod: DecisionMethod {
    /// Where every pose of a domain ends, in its order, and their outcomes.
    ///
    /// # Errors
    /// See [`DecideError`].
    fn follow(
        &self,
        problem: &Problem,
        domain: Domain,
        exec: &Exec,
    ) -> Result<(Acceptance, Vec<End>), DecideError>;

    /// The same, each until it has come to rest, also where it is known before what becomes of it.
    ///
    /// # Errors
    /// As for [`PoseMethod::follow`].
    fn rest(
        &self,
        problem: &Problem,
        domain: Domain,
        exec: &Exec,
    ) -> Result<(Acceptance, Vec<End>), DecideError> {
        self.follow(problem, domain, exec)
    }

    /// The same; `finished` is told of every pose as soon as it is decided.
    ///
    /// # Errors
    /// As for [`PoseMethod::follow`].
    fn rest_told(
        &self,
        problem: &Problem,
        domain: Domain,
        exec: &Exec,
        finished: PoseObserver<'_>,
    ) -> Result<(Acceptance, Vec<End>), DecideError> {
        let found = self.rest(problem, domain, exec)?;
        found.1.iter().enumerate().for_each(|(number, end)| finished(number, *end));
        Ok(found)
    }

    /// Whether its motions are those of exact descent.
    fn is_descent(&self) -> bool {
        false
    }

    /// How deep the halves overlap where they press on each other in the ends that it finds, in D: contacts of an engine are springs.
    fn give(&self) -> f64 {
        0.0
    }

    /// What the method itself doubts about its motions on this problem, tried on random poses.
    ///
    /// # Errors
    /// See [`DecideError`].
    fn doubt(&self, _problem: &Problem, _seed: u64, _exec: &Exec) -> Result<Option<Warning>, DecideError> {
        Ok(None)
    }
}

/// How sure a method is of the cells of a grid.
pub trait CellFractions: fmt::Debug + Send + Sync {
    /// Share of the cell that is accepted, by the method's own estimate, in [0, 1]; accepted above ½.
    fn fraction(&self, cell: usize) -> f64;
    /// Whether the method cannot tell what becomes of the cell.
    fn is_ambiguous(&self, cell: usize) -> bool;
    /// Mean fraction over the grid: the method's own estimate of the accepted share of the box.
    fn mean(&self) -> f64;
}

/// What a method found.
#[derive(Debug)]
pub struct MethodOutput {
    /// Outcomes over the domain.
    pub acceptance: Acceptance,
    /// How sure it is of them, where it can say.
    pub doubts: Option<Box<dyn CellFractions>>,
    /// What else it knows now.
    pub by_products: ByProducts,
    /// Its settings as they were used, everything filled in.
    pub settings: Value,
}

/// What a method knows beside the outcomes.
#[derive(Debug, Default)]
pub struct ByProducts {
    /// Heights over the grid.
    pub landscape: Option<Landscape>,
    /// The basins and how they merge.
    pub basins: Option<Hierarchy>,
    /// The label of every cell before merging and after.
    pub watersheds: Option<Watersheds>,
    /// The polytopes of the contact space.
    pub partition: Option<Partition>,
    /// What is certain.
    pub certificate: Option<BoxCertificate>,
    /// How many cells were decided by others, and how often that was wrong.
    pub joined: Option<Joined>,
}

impl MethodOutput {
    /// Outcomes and nothing else.
    pub fn plain(acceptance: Acceptance, settings: Value) -> Self {
        Self { acceptance, doubts: None, by_products: ByProducts::default(), settings }
    }
}

/// A method that cannot decide a design.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{method} does not apply to this design: {reason}")]
pub struct NotApplicable {
    /// The method.
    pub method: &'static str,
    /// Why.
    pub reason: String,
}

/// Why nothing was decided.
#[derive(Debug, thiserror::Error)]
pub enum DecideError {
    /// The method is not made for the design.
    #[error(transparent)]
    NotApplicable(#[from] NotApplicable),
    /// Listed poses, given to a method that decides the cells of a grid from one another.
    #[error("{method} decides the cells of a grid from one another, not listed poses")]
    NeedsGrid {
        /// The method.
        method: &'static str,
    },
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// It was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Anything else, in the method's own words.
    #[error(transparent)]
    Method(Box<dyn std::error::Error + Send + Sync>),
}

impl DecideError {
    /// An error of a method that is neither of the others.
    pub fn method(error: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self::Method(Box::new(error))
    }
}

/// The grid of a domain, for methods that need one.
pub(super) fn grid_of<'a>(info: &Info, domain: &'a Domain) -> Result<&'a Grid, DecideError> {
    match domain {
        Domain::Grid(grid) => Ok(grid),
        Domain::Poses(_) => Err(DecideError::NeedsGrid { method: info.name }),
    }
}
