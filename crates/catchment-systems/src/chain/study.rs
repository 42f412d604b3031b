//! From a chain file to its results.
//!
//! ```text
//!   straight chain ─▶ error of its last face ─▶ does it dock?
//!   sequence ─▶ folds, latches, collides ─▶ error at every latch ─▶ does it dock?
//!   2..20 modules × joint errors ─▶ the same for each, and how many modules still dock
//! ```
//!
//! The same chains are drawn for every number of modules and every size of error, so that rows differ by
//! their parameters and not by chance. A chain that folds docks if it docks at every latch.

use super::accumulation::{ChainErrors, Closing, Covariance};
use super::docking::{Probability, as_chain_uses_it, docks, lateral_probability, offsets_without_rotation};
use super::file::ChainFile;
use super::fold::{FoldError, FoldSettings, Folded, fold};
use super::ring::{self, Corners};
use super::shape::{ChainShape, LatchingPair};
use catchment::diagnostic::Diagnostics;
use catchment::exec::{Cancelled, Exec};
use catchment::problem::{Draft, Problem, ProblemError};
use serde::{Deserialize, Serialize};

/// Settings that change the result, besides the file.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainSettings {
    /// Random chains.
    pub chains: u64,
    /// Their seed.
    pub seed: u64,
    /// Numbers of modules for the table; empty without a table.
    pub modules: Vec<usize>,
    /// Joint errors for the table, in radians; empty for the file's own.
    pub joint_sigmas: Vec<f64>,
}

impl Default for ChainSettings {
    fn default() -> Self {
        Self { chains: 1000, seed: 1, modules: Vec::new(), joint_sigmas: Vec::new() }
    }
}

/// Errors of a face at its arrival.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ArrivalErrors {
    /// The latch; null for the last face of a straight chain.
    pub latch: Option<LatchingPair>,
    /// Joints that contribute errors.
    pub joints: Vec<usize>,
    /// Standard deviation across the face, to first order, in mm.
    pub lateral_sigma_mm: f64,
    /// Standard deviation across the face, to first order, in D.
    pub lateral_sigma_d: f64,
    /// Standard deviation of the gap, which is not in the area of acceptance, in mm.
    pub normal_sigma_mm: f64,
    /// Standard deviation of the angle, in radians.
    pub angle_sigma_rad: f64,
    /// Correlation of lateral offset and angle.
    pub correlation: f64,
    /// Mean and covariance to first order: lateral mm, normal mm, angle rad.
    pub first_order: Covariance,
    /// Mean and covariance over the sampled chains, by exact kinematics.
    pub exact: Covariance,
    /// Share of the chains that dock here.
    pub docking: Option<Probability>,
    /// Probability, to first order, that the lateral offset alone is corrected without rotation.
    pub offset_probability: Option<f64>,
    /// Pressing force along the normal that the joints can hold, in N.
    pub press_n: f64,
    /// Lateral mm, normal mm and angle rad of every sampled chain.
    #[serde(skip)]
    pub cloud: Vec<[f64; 3]>,
    /// Whether each of them docks.
    #[serde(skip)]
    pub docked: Option<Vec<bool>>,
}

/// A row of the table over numbers of modules.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Length {
    /// Standard deviation of a joint's angle, in radians.
    pub joint_sigma_rad: f64,
    /// Number of modules of the straight chain.
    pub modules: usize,
    /// Standard deviation of the last face across, to first order, in D.
    pub lateral_sigma_d: f64,
    /// Standard deviation of its heading, in radians.
    pub heading_sigma_rad: f64,
    /// Share of the chains that dock.
    pub docking: Option<Probability>,
    /// Probability, to first order, that the lateral offset alone is corrected without rotation.
    pub offset_probability: Option<f64>,
}

/// The connector of a chain.
#[derive(Debug, Clone)]
pub struct ChainConnector {
    /// The problem, with the chain's centre of rotation.
    pub problem: Problem,
    /// Centre of rotation of the design, in D.
    pub own_center_of_rotation: f64,
    /// Offsets that are corrected without rotation, in D; a sentence if they have no exact result.
    pub offsets: Result<[f64; 2], String>,
}

/// Everything that was found.
#[derive(Debug, Clone)]
pub struct Study {
    /// The file.
    pub file: ChainFile,
    /// The settings.
    pub settings: ChainSettings,
    /// The connector, if named.
    pub docking: Option<ChainConnector>,
    /// The last face of the straight chain.
    pub straight: ArrivalErrors,
    /// Every latch, in the order of the sequence.
    pub arrivals: Vec<ArrivalErrors>,
    /// How the chain folds by its sequence.
    pub folded: Option<Folded>,
    /// The choices of corners, for an O.
    pub corners: Vec<Corners>,
    /// Share of the chains that dock, everywhere they have to.
    pub probability: Option<Probability>,
    /// The table over numbers of modules.
    pub lengths: Vec<Length>,
}

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
pub enum ChainError {
    /// Something in the file.
    #[error(transparent)]
    Diagnostics(#[from] Diagnostics),
    /// Something in its connector's design.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Computes the results of a chain file.
///
/// # Errors
/// A connector that cannot be read or cannot be free in x and pitch, a sequence that collides, a cancelled
/// computation.
pub fn run(file: &ChainFile, settings: &ChainSettings, exec: &Exec) -> Result<Study, ChainError> {
    let folded = follow(file, exec)?;
    let docking = docking(file, exec)?;
    let work = Work { file, settings, docking: docking.as_ref(), exec };
    let straight = Closing::straight(file.body, file.modules);
    let straight = work.arrival(None, &straight, file.folding.is_none())?;
    let mut arrivals: Vec<ArrivalErrors> = Vec::new();
    if let Some(folding) = &file.folding {
        let latches = &folding.sequence.latches;
        for (k, latch) in latches.iter().enumerate() {
            let closing = Closing::latch(file.body, &folding.lattice, latch, &latches[..k]);
            arrivals.push(work.arrival(Some(*latch), &closing, true)?);
        }
    }
    let corners = match file.folding.as_ref().and_then(|folding| folding.shape) {
        Some(ChainShape::O { .. }) => ring::choices(&file.body, &file.errors, file.servo.torque),
        _ => Vec::new(),
    };
    let docked: Vec<&Vec<bool>> =
        std::iter::once(&straight).chain(&arrivals).filter_map(|a| a.docked.as_ref()).collect();
    let everywhere = |k: usize| docked.iter().all(|docked| docked[k]);
    let probability = (!docked.is_empty())
        .then(|| Probability::of(&(0..settings.chains as usize).map(everywhere).collect::<Vec<_>>()));
    let lengths = work.lengths()?;
    Ok(Study {
        file: file.clone(),
        settings: settings.clone(),
        docking,
        straight,
        arrivals,
        folded,
        corners,
        probability,
        lengths,
    })
}

fn follow(file: &ChainFile, exec: &Exec) -> Result<Option<Folded>, ChainError> {
    let Some(folding) = &file.folding else { return Ok(None) };
    let settings = FoldSettings { servo: file.servo, hooks: file.hooks, ..FoldSettings::default() };
    match fold(&file.body, file.modules, &folding.sequence, &settings, exec) {
        Ok(folded) => Ok(Some(folded)),
        Err(FoldError::Cancelled(cancelled)) => Err(cancelled.into()),
        Err(error @ (FoldError::Cell { step, .. } | FoldError::Collision { step, .. })) => {
            Err(file.refuse_step(step, error.to_string()).into())
        }
    }
}

fn docking(file: &ChainFile, exec: &Exec) -> Result<Option<ChainConnector>, ChainError> {
    let Some(line) = &file.connector else { return Ok(None) };
    let draft = match Draft::open(&line.path) {
        Ok(draft) => draft,
        Err(ProblemError::Load(error)) => {
            let help = "the path is taken from the folder of the chain file".to_owned();
            return Err(file.refuse_connector(error.to_string(), Some(help)).into());
        }
        Err(error) => return Err(error.into()),
    };
    let own_center_of_rotation = draft.design().alignment.center_of_rotation;
    let change = |design| as_chain_uses_it(design, &file.body, line.rotation_length);
    let problem = draft.change("[connector] of the chain", change)?.build()?;
    let offsets = offsets_without_rotation(&problem, exec);
    Ok(Some(ChainConnector { problem, own_center_of_rotation, offsets }))
}

struct Work<'a> {
    file: &'a ChainFile,
    settings: &'a ChainSettings,
    docking: Option<&'a ChainConnector>,
    exec: &'a Exec,
}

impl Work<'_> {
    fn offset_probability(&self, errors: &Covariance) -> Option<f64> {
        let offsets = self.docking?.offsets.as_ref().ok()?;
        Some(lateral_probability(&self.file.body, errors, *offsets))
    }

    fn cloud(&self, closing: &Closing, errors: &ChainErrors) -> Result<Vec<[f64; 3]>, Cancelled> {
        closing.cloud(errors, self.settings.seed, self.settings.chains, self.exec)
    }

    fn docks(&self, cloud: &[[f64; 3]]) -> Result<Option<Vec<bool>>, Cancelled> {
        self.docking.map(|d| docks(&d.problem, &self.file.body, cloud, self.exec)).transpose()
    }

    fn arrival(
        &self,
        latch: Option<LatchingPair>,
        closing: &Closing,
        decide: bool,
    ) -> Result<ArrivalErrors, Cancelled> {
        let cloud = self.cloud(closing, &self.file.errors)?;
        let first_order = closing.first_order(&self.file.errors);
        let [lateral_sigma_mm, normal_sigma_mm, angle_sigma_rad] = first_order.sigmas();
        let docked = if decide { self.docks(&cloud)? } else { None };
        Ok(ArrivalErrors {
            latch,
            joints: closing.joints(),
            lateral_sigma_mm,
            lateral_sigma_d: lateral_sigma_mm / self.file.body.face,
            normal_sigma_mm,
            angle_sigma_rad,
            correlation: first_order.correlation(),
            first_order,
            exact: Covariance::of(&cloud),
            docking: docked.as_deref().map(Probability::of),
            offset_probability: self.offset_probability(&first_order),
            press_n: ring::forces(closing, self.file.servo.torque, &[]).0,
            cloud,
            docked,
        })
    }

    fn lengths(&self) -> Result<Vec<Length>, Cancelled> {
        let (settings, own) = (self.settings, &self.file.errors);
        if settings.modules.is_empty() && settings.joint_sigmas.is_empty() {
            return Ok(Vec::new());
        }
        let or_own = |empty: bool, given: &[f64]| if empty { vec![own.joint_sigma] } else { given.to_vec() };
        let sigmas = or_own(settings.joint_sigmas.is_empty(), &settings.joint_sigmas);
        let modules =
            if settings.modules.is_empty() { vec![self.file.modules] } else { settings.modules.clone() };
        let mut result = Vec::new();
        let count = (sigmas.len() * modules.len()) as f64;
        for joint_sigma in sigmas {
            let errors = ChainErrors { joint_sigma, ..*own };
            for modules in &modules {
                self.exec.report(result.len() as f64 / count, "chains");
                let closing = Closing::straight(self.file.body, *modules);
                let first_order = closing.first_order(&errors);
                let docked = match self.docking {
                    Some(_) => self.docks(&self.cloud(&closing, &errors)?)?,
                    None => None,
                };
                let [lateral_sigma, _, heading_sigma_rad] = first_order.sigmas();
                result.push(Length {
                    joint_sigma_rad: joint_sigma,
                    modules: *modules,
                    lateral_sigma_d: lateral_sigma / self.file.body.face,
                    heading_sigma_rad,
                    docking: docked.as_deref().map(Probability::of),
                    offset_probability: self.offset_probability(&first_order),
                });
            }
        }
        Ok(result)
    }
}
