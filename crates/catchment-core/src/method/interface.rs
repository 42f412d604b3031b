//! The common interface of all methods.
//!
//! ```text
//!                 ┌ info       name, description, category
//!   Method ───────┤ settings   values that change its result: read, changed and stored as JSON
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
use crate::acceptance::{Acceptance, Domain};
use crate::contact::Pair;
use crate::design::Design;
use crate::diagnostic::Warning;
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::landscape::{Grid, Landscape};
use crate::method::certified::BoxCertificate;
use crate::method::confluence::InheritedLabels;
use crate::method::flood::{Hierarchy, Watersheds};
use crate::method::partition::Partition;
use crate::method::registry::Method;
use crate::problem::Problem;
use serde_json::Value;
use std::fmt;
use std::time::Duration;

/// Static description of a method.
#[derive(Debug, PartialEq, Eq)]
pub struct Info {
    /// The lower-case name used in files, reports and options.
    pub name: &'static str,
    /// Its function, in a line.
    pub summary: &'static str,
    /// Whether its result depends only on the grid and its resolution: the methods of resolution studies.
    pub on_grids: bool,
    /// Whether it departs from exact frictionless motion on purpose, so that pictures show its own cells and no slices followed
    /// exactly.
    pub departs: bool,
}

/// Cost of a decision, estimated in advance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// The data that needs the memory.
    pub what: &'static str,
    /// Bytes per cell at the peak.
    pub bytes_per_cell: u64,
    /// Core-seconds, to a factor of a few: threads share them.
    pub seconds: f64,
}

/// A method that decides the outcomes of pose errors.
pub trait DecisionMethod: fmt::Debug + Send + Sync {
    /// Its static description.
    fn info(&self) -> &'static Info;

    /// Its settings that change the result, as JSON: the form that [`Method`](super::Method) reads and
    /// writes.
    fn settings(&self) -> Value;

    /// The same for a given problem, with all values that depend on it filled in; as stored with the result.
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

    /// Default cells per axis, for one to five axes: a result within seconds.
    fn default_cells(&self, pair: &Pair) -> [usize; 5];

    /// Default number of sampled poses, followed exactly, that correct the Sum.
    fn default_samples(&self, _pair: &Pair) -> usize {
        0
    }

    /// Cost of deciding a grid.
    fn cost(&self, problem: &Problem, grid: &Grid) -> Cost;

    /// Its results besides the outcomes, by the names of [`ByProducts`].
    fn by_products(&self) -> &'static [&'static str] {
        &[]
    }

    /// Decides every pose of a domain.
    ///
    /// # Errors
    /// See [`DecideError`].
    fn decide(&self, problem: &Problem, domain: &Domain, exec: &Exec) -> Result<MethodOutput, DecideError>;

    /// Settings of its exact motions, and of those of the samples.
    fn motions(&self) -> descent::DescentSettings {
        descent::DescentSettings::default()
    }

    /// The same method with a time limit, if it has a partial result when the time is over; `None` if it
    /// cannot stop early.
    fn within(&self, _budget: Duration) -> Option<Method> {
        None
    }

    /// The same method pose by pose, if each is decided separately.
    fn follows(&self) -> Option<&dyn PoseMethod> {
        None
    }
}

/// Called with the number of a pose and its end, from any thread and in any order, once for each.
pub type PoseObserver<'a> = &'a (dyn Fn(usize, End) + Sync);

/// A method that decides each pose by itself.
pub trait PoseMethod: DecisionMethod {
    /// The ends of all poses of a domain, in its order, with their outcomes.
    ///
    /// # Errors
    /// See [`DecideError`].
    fn follow(
        &self,
        problem: &Problem,
        domain: Domain,
        exec: &Exec,
    ) -> Result<(Acceptance, Vec<End>), DecideError>;

    /// The same, each until it has come to rest, even if its outcome is known before.
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

    /// The same; `finished` is called for every pose as soon as it is decided.
    ///
    /// # Errors
    /// As for [`PoseMethod::follow`].
    fn rest_observed(
        &self,
        problem: &Problem,
        domain: Domain,
        exec: &Exec,
        finished: PoseObserver<'_>,
    ) -> Result<(Acceptance, Vec<End>), DecideError> {
        let result = self.rest(problem, domain, exec)?;
        result.1.iter().enumerate().for_each(|(number, end)| finished(number, *end));
        Ok(result)
    }

    /// Whether its motions are those of exact descent.
    fn is_descent(&self) -> bool {
        false
    }

    /// Overlap of the halves under contact force in the ends that it finds, in D: contacts of an engine are
    /// springs.
    fn give(&self) -> f64 {
        0.0
    }

    /// The method's own warning about its motions on this problem, tested on sampled poses.
    ///
    /// # Errors
    /// See [`DecideError`].
    fn step_warning(
        &self,
        _problem: &Problem,
        _seed: u64,
        _exec: &Exec,
    ) -> Result<Option<Warning>, DecideError> {
        Ok(None)
    }
}

/// How sure a method is of the cells of a grid.
pub trait CellFractions: fmt::Debug + Send + Sync {
    /// Share of the cell that is accepted, by the method's own estimate, in [0, 1]; accepted above ½.
    fn fraction(&self, cell: usize) -> f64;
    /// Whether the method cannot decide the outcome of the cell.
    fn is_ambiguous(&self, cell: usize) -> bool;
    /// Mean fraction over the grid: the method's own estimate of the accepted share of the box.
    fn mean(&self) -> f64;
}

/// Result of a method.
#[derive(Debug)]
pub struct MethodOutput {
    /// Outcomes over the domain.
    pub acceptance: Acceptance,
    /// Reliability of the outcomes, if the method provides it.
    pub doubts: Option<Box<dyn CellFractions>>,
    /// Its other results.
    pub by_products: ByProducts,
    /// Its settings as they were used, everything filled in.
    pub settings: Value,
}

/// Results of a method besides the outcomes.
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
    /// Certified results.
    pub certificate: Option<BoxCertificate>,
    /// How many cells were decided by others, and how often that was wrong.
    pub inherited: Option<InheritedLabels>,
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
    /// Listed poses, for a method whose cells depend on each other.
    #[error("{method} decides the cells of a grid from one another, not listed poses")]
    NeedsGrid {
        /// The method.
        method: &'static str,
    },
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
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

/// The grid of a domain, for methods that need a grid.
pub(super) fn grid_of<'a>(info: &Info, domain: &'a Domain) -> Result<&'a Grid, DecideError> {
    match domain {
        Domain::Grid(grid) => Ok(grid),
        Domain::Poses(_) => Err(DecideError::NeedsGrid { method: info.name }),
    }
}
