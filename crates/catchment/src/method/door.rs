//! The one door through which every method is entered.
//!
//! ```text
//!                 ┌ info       name, what it does, where it belongs
//!   Method ───────┤ settings   what changes its answer: read, changed and stored as JSON
//!  (any of the    ├ applies_to, cost, defaults            before anything is computed
//!   registry)     ├ decide(problem, domain) ──▶ Decided   outcomes · doubts · by-products · settings as used
//!                 └ follow(problem, poses)  ──▶ ends      only methods that decide each pose by itself
//! ```
//!
//! A method is a type that implements [`Decide`], in a folder of its own, and one line in [`REGISTRY`](super::REGISTRY). Everything else, the
//! command line, the run and the studies, knows only this door. A trait and not an enum, because an enum of all methods
//! would have to be taken apart wherever a method is asked something, which is what the door is there to end.
//!
//! What decides translation alone ([`zraa`](super::zraa)) is not forced in.

use super::descent::{self, End};
use crate::acceptance::{Acceptance, Domain, Warning};
use crate::advice::Advice;
use crate::contact::Pair;
use crate::design::{Design, nearest};
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::landscape::{Grid, Landscape, Resolution};
use crate::method::certified::Certificate;
use crate::method::confluence::Joined;
use crate::method::flood::{Hierarchy, Watersheds};
use crate::method::partition::Partition;
use crate::problem::Problem;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Map, Value, json};
use std::fmt;
use std::ops::Deref;
use std::str::FromStr;
use std::sync::Arc;

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
pub trait Decide: fmt::Debug + Send + Sync {
    /// What is known of it beforehand.
    fn info(&self) -> &'static Info;

    /// What changes its answer, as JSON: what [`Method`] reads and writes.
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
    fn decide(&self, problem: &Problem, domain: &Domain, exec: &Exec) -> Result<Decided, DecideError>;

    /// How it follows motions, and how random poses beside it are followed.
    fn motions(&self) -> descent::Settings {
        descent::Settings::default()
    }

    /// The same method pose by pose, where each is decided by itself.
    fn follows(&self) -> Option<&dyn Follow> {
        None
    }
}

/// Told the number of a pose and where it ends, from any thread and in any order, once for each.
pub type Finished<'a> = &'a (dyn Fn(usize, End) + Sync);

/// A method that decides each pose by itself.
pub trait Follow: Decide {
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
    /// As for [`Follow::follow`].
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
    /// As for [`Follow::follow`].
    fn rest_told(
        &self,
        problem: &Problem,
        domain: Domain,
        exec: &Exec,
        finished: Finished<'_>,
    ) -> Result<(Acceptance, Vec<End>), DecideError> {
        let found = self.rest(problem, domain, exec)?;
        found.1.iter().enumerate().for_each(|(number, end)| finished(number, *end));
        Ok(found)
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
pub trait Doubts: fmt::Debug + Send + Sync {
    /// Share of the cell that is accepted, by the method's own estimate, in [0, 1]; accepted above ½.
    fn fraction(&self, cell: usize) -> f64;
    /// Whether the method cannot tell what becomes of the cell.
    fn is_ambiguous(&self, cell: usize) -> bool;
    /// Mean fraction over the grid: the method's own estimate of the accepted share of the box.
    fn mean(&self) -> f64;
}

/// What a method found.
#[derive(Debug)]
pub struct Decided {
    /// Outcomes over the domain.
    pub acceptance: Acceptance,
    /// How sure it is of them, where it can say.
    pub doubts: Option<Box<dyn Doubts>>,
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
    pub certificate: Option<Certificate>,
    /// How many cells were decided by others, and how often that was wrong.
    pub joined: Option<Joined>,
}

impl Decided {
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

/// A line of the registry.
#[derive(Debug)]
pub struct Entry {
    /// What is known of the method.
    pub info: &'static Info,
    read: fn(Value) -> Result<Method, serde_json::Error>,
}

impl Entry {
    /// The line of a method whose settings are read as `M`, missing ones being those of `{}`.
    pub const fn of<M: Decide + DeserializeOwned + 'static>(info: &'static Info) -> Self {
        Self::by(info, |settings| Ok(Method::new(serde_json::from_value::<M>(settings)?)))
    }

    /// The line of a method whose settings are read by `read`.
    pub const fn by(info: &'static Info, read: fn(Value) -> Result<Method, serde_json::Error>) -> Self {
        Self { info, read }
    }

    /// The method with its default settings.
    ///
    /// # Panics
    /// If a registered method cannot be read from no settings at all, which a test of the registry rules out.
    pub fn method(&self) -> Method {
        match (self.read)(json!({})) {
            Ok(method) => method,
            Err(error) => panic!("{} has no default settings: {error}", self.info.name),
        }
    }
}

/// Under this name a method has the settings of the motions that it follows.
pub(super) const MOTIONS: &str = "descent";

/// Any of the registered methods, with its settings.
///
/// As text its name; as JSON `{"name": …, "settings": {…}}`, settings that are missing being the defaults.
#[derive(Debug, Clone)]
pub struct Method(Arc<dyn Decide>);

impl Method {
    /// A method of one's own making, registered or not.
    pub fn new(method: impl Decide + 'static) -> Self {
        Self(Arc::new(method))
    }

    /// The lower-case name used in files, reports and options.
    pub fn name(&self) -> &'static str {
        self.info().name
    }

    /// This method with some of its settings changed.
    ///
    /// # Errors
    /// A setting that it does not have, that does not read, or that nothing can be decided with.
    pub fn with(&self, changes: &Map<String, Value>) -> Result<Self, MethodError> {
        if changes.is_empty() {
            return Ok(self.clone());
        }
        let mut settings = match self.settings() {
            Value::Object(settings) => settings,
            _ => Map::new(),
        };
        for (key, value) in changes {
            // Also of the motions that it follows.
            let motions = settings.get_mut(MOTIONS).and_then(Value::as_object_mut);
            if let Some(motions) = motions.filter(|motions| motions.contains_key(key)) {
                motions.insert(key.clone(), value.clone());
                continue;
            }
            if !settings.contains_key(key) {
                let owners = super::REGISTRY.iter().filter(|e| e.method().has(key));
                return Err(MethodError::NoSuchSetting {
                    method: self.name(),
                    setting: key.clone(),
                    owners: owners.map(|entry| entry.info.name).collect(),
                });
            }
            settings.insert(key.clone(), value.clone());
        }
        let method = Self::read(self.name(), Value::Object(settings))?;
        method
            .check()
            .map_err(|error| MethodError::Refused { method: method.name(), reason: error.to_string() })?;
        Ok(method)
    }

    /// Whether it has a setting of this name, or its motions have.
    pub fn has(&self, setting: &str) -> bool {
        let settings = self.settings();
        settings.get(setting).or_else(|| settings.get(MOTIONS)?.get(setting)).is_some()
    }

    fn read(name: &str, settings: Value) -> Result<Self, MethodError> {
        let Some(entry) = super::REGISTRY.iter().find(|entry| entry.info.name == name) else {
            let names = super::REGISTRY.iter().map(|entry| entry.info.name);
            let meant = nearest(name, names.clone()).map(str::to_owned);
            return Err(MethodError::Unknown { name: name.to_owned(), known: names.collect(), meant });
        };
        (entry.read)(settings)
            .map_err(|error| MethodError::Refused { method: entry.info.name, reason: error.to_string() })
    }
}

impl Deref for Method {
    type Target = dyn Decide;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl PartialEq for Method {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name() && self.settings() == other.settings()
    }
}

impl Default for Method {
    /// The first of the registry.
    fn default() -> Self {
        super::REGISTRY[0].method()
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Method {
    type Err = MethodError;

    fn from_str(name: &str) -> Result<Self, MethodError> {
        Self::read(name, json!({}))
    }
}

/// The form of a method in JSON.
#[derive(Serialize, Deserialize)]
struct Written {
    name: String,
    #[serde(default = "Value::default")]
    settings: Value,
}

impl Serialize for Method {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Written { name: self.name().to_owned(), settings: self.settings() }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Method {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Written { name, settings } = Written::deserialize(deserializer)?;
        let settings = if settings.is_null() { json!({}) } else { settings };
        let method = Self::read(&name, settings).map_err(serde::de::Error::custom)?;
        method.check().map_err(serde::de::Error::custom)?;
        Ok(method)
    }
}

/// Why there is no such method.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MethodError {
    /// Nothing of that name is registered.
    #[error("there is no method `{name}`; {}", match meant {
        Some(meant) => format!("did you mean {meant}?"),
        None => format!("there are {}", known.join(", ")),
    })]
    Unknown {
        /// What was asked for.
        name: String,
        /// What there is.
        known: Vec<&'static str>,
        /// The nearest of these.
        meant: Option<String>,
    },
    /// A setting of other methods, or of none.
    #[error("`{setting}` is {}; {method} has none", match owners.as_slice() {
        [] => "no setting of any method".to_owned(),
        owners => format!("a setting of {}", owners.join(" and ")),
    })]
    NoSuchSetting {
        /// The method.
        method: &'static str,
        /// What was to be set.
        setting: String,
        /// The methods that have it.
        owners: Vec<&'static str>,
    },
    /// A setting that does not read, or is out of its range.
    #[error("{method}: {reason}")]
    Refused {
        /// The method.
        method: &'static str,
        /// Why.
        reason: String,
    },
}

/// Seconds of one descent between simple halves, on one core: what cost estimates count in.
pub(super) const DESCENT_SECONDS: f64 = 1e-4;

/// Bytes per pose while poses are decided one by one: the end and the outcome of each, and the ends once more while the
/// parts of the threads are put together.
pub(super) const POSE_BYTES: u64 = (2 * size_of::<End>() + size_of::<crate::acceptance::Outcome>()) as u64;

/// How many descents can be afforded, as a share of what simple halves allow: the time of a descent grows with about the cube of the
/// number of facets, and where the trees are asked as measured of funnels of 600 to 6000 facets.
pub fn affordable(pair: &Pair) -> f64 {
    const SIMPLE: f64 = 64.0;
    let facets = |half: &crate::connector::Half| half.surfaces.iter().map(|s| s.facets.len()).sum::<usize>();
    let facets = (facets(&pair.fixed) + facets(&pair.moving)) as f64;
    let listed = (SIMPLE / facets.max(SIMPLE)).powi(3);
    if pair.asks_trees() { listed.max(by_trees(facets)) } else { listed }
}

/// The same of halves that are searched by trees, by the number of their facets.
fn by_trees(facets: f64) -> f64 {
    /// Seconds of a descent of so many facets, and with which power of their number they grow.
    const SECONDS: f64 = 4e-3;
    const MEASURED: f64 = 600.0;
    const POWER: f64 = 0.71;
    (DESCENT_SECONDS / SECONDS * (MEASURED / facets).powf(POWER)).min(1.0)
}

/// Refuses what would not fit into memory, with the resolution that would.
pub fn ensure_fits(
    what: &'static str,
    needed: u64,
    per_cell: u64,
    axes: usize,
    exec: &Exec,
) -> Result<(), OutOfBudget> {
    exec.ensure_fits(what, needed, |budget| {
        let fits = Resolution::largest_that_fits(budget, per_cell, axes);
        vec![Advice::AtMostResolution(fits), Advice::MoreMemory]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Connector;
    use crate::design::family::Cone;
    use crate::design::{Alignment, FamilySpec};
    use crate::pose::{DofSet, Mount};

    #[test]
    fn halves_of_many_facets_are_searched_and_not_listed() {
        let share = |chord_error: f64| {
            let spec = FamilySpec::Cone(Cone { chord_error, ..Cone::default() });
            let connector = Connector::of_family(&spec, Mount::X).unwrap();
            affordable(&Pair::new(&connector, &Alignment::new(DofSet::ALL, Mount::X)))
        };
        // Hundreds of facets take milliseconds: by the cube of their number it would be a tenth of a second and more.
        let (coarse, fine) = (share(1e-2), share(1e-5));
        assert!(coarse > fine, "{coarse} {fine}");
        let milliseconds = |share: f64| 1e3 * DESCENT_SECONDS / share;
        assert!((2.0..10.0).contains(&milliseconds(fine)), "{}", milliseconds(fine));
    }

    #[test]
    fn the_time_of_a_descent_is_the_measured_one() {
        let milliseconds = |facets: f64| 1e3 * DESCENT_SECONDS / by_trees(facets);
        assert!((milliseconds(600.0) - 4.0).abs() < 1e-9);
        // Ten times as many facets take 10^0.71 times as long.
        assert!((milliseconds(6000.0) / milliseconds(600.0) - 5.13).abs() < 0.01);
        assert_eq!(by_trees(1.0), 1.0);
    }
}
