//! The complete result of a run.

use super::jams::Jams;
use super::window::{ToleranceWindow, WindowError};
use super::{Run, Seating, Upright};
use crate::acceptance::Acceptance;
use crate::diagnostic::{Diagnostic, Warning};
use crate::landscape::Grid;
use crate::merit::Merits;
use crate::merit::onaa::Onaa;
use crate::merit::success::SuccessProbability;
use crate::method::{ByProducts, correction};
use crate::problem::Problem;
use serde_json::Value;

/// The answer of a run: outcomes, the corrected Sum, figures of merit and by-products, with the problem and the run that
/// they belong to.
#[derive(Debug)]
pub struct Answer {
    /// The decided problem.
    pub problem: Problem,
    /// How.
    pub run: Run,
    /// Outcomes over the grid or the listed poses.
    pub acceptance: Acceptance,
    /// The settings of the method as they were used.
    pub settings: Value,
    /// The Sum corrected by samples, if any were drawn.
    pub corrected: Option<RunCorrection>,
    /// Other results of the method.
    pub by_products: ByProducts,
    /// Figures of merit of the accepted cells.
    pub merits: Merits,
    /// The same with roll and pitch locked, of problems with all five errors free that exact motions answer.
    pub upright: Option<Upright>,
    /// The success probability for the given errors.
    pub success: Option<SuccessProbability>,
    /// Rests outside the seat, if requested.
    pub jams: Option<Jams>,
    /// The tolerance window, or the reason for its absence, if requested.
    pub window: Option<Result<ToleranceWindow, WindowError>>,
    /// The seat, and the residual misalignment of accepted poses.
    pub seating: Seating,
    /// Wall-clock time, in seconds.
    pub seconds: f64,
    /// Worker threads.
    pub threads: usize,
}

/// An unbiased Sum, with the method that followed its samples.
#[derive(Debug, Clone, PartialEq)]
pub struct RunCorrection {
    /// The estimate with its interval and strata.
    pub estimate: correction::UnbiasedSum,
    /// Seed of the poses.
    pub seed: u64,
    /// Name of the method that followed them.
    pub method: &'static str,
    /// Its settings.
    pub settings: Value,
}

impl Answer {
    /// Measure of the accepted set, Dᵃ·radᵇ: the unbiased estimate if available.
    pub fn sum(&self) -> f64 {
        self.corrected.as_ref().map_or(self.merits.sum.sum, |corrected| corrected.estimate.sum)
    }

    /// Its 95 % interval; `None` without samples.
    pub fn sum_ci95(&self) -> Option<[f64; 2]> {
        self.corrected.as_ref().map_or(self.merits.sum.ci95, |corrected| Some(corrected.estimate.ci95))
    }

    /// The unit of the Sum, such as `D·rad`.
    pub fn unit(&self) -> String {
        self.merits.sum.unit()
    }

    /// The largest axis-oriented cube in the accepted cells; `None` for listed poses.
    pub fn onaa(&self) -> Option<&Onaa> {
        self.merits.onaa.as_ref()
    }

    /// The grid, if a grid was decided.
    pub const fn grid(&self) -> Option<&Grid> {
        self.acceptance.grid()
    }

    /// Everything that speaks against the numbers, in the order in which it was found.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        let mut warnings = self.merits.warnings.clone();
        let descended = self.run.method.follows().is_some() && self.run.method.name() == "descent";
        // A certified result states its own undecided share.
        let is_certain = self.by_products.certificate.is_some();
        match &self.corrected {
            Some(corrected) => {
                let ([lo, hi], sum_grid) = (corrected.estimate.ci95, self.merits.sum.sum);
                if !is_certain && !(lo..=hi).contains(&sum_grid) {
                    warnings.push(Warning::OutsideSample { sum_grid, ci95: [lo, hi] }.into());
                }
                let motions = corrected.estimate.strata.iter().map(|stratum| stratum.undecided).sum();
                if motions > 0 {
                    warnings
                        .push(Warning::UndecidedSample { motions, of: corrected.estimate.descents }.into());
                }
            }
            None if !(descended || is_certain) && self.grid().is_some() => {
                warnings.push(Warning::NoInterval.into());
            }
            None => {}
        }
        if let Some(Err(error)) = &self.window {
            warnings.push(Diagnostic::warning("no-window", format!("there is no window: {error}")));
        }
        warnings.extend(self.seating.warnings(&self.problem));
        warnings.extend(self.problem.warnings());
        warnings
    }
}
