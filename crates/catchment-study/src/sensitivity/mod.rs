//! Sensitivity of the Sum to the parameters of a design: ρ, the centre of rotation, the aspect ratio.
//!
//! ```text
//!   the same N sampled poses, followed exactly at p − h and at p + h
//!
//!   dSum     V   gained − lost          gained: poses aligned only at p + h
//!   ──── ≈  ── · ─────────────          lost:   poses aligned only at p − h
//!    dp     2h         N
//! ```
//!
//! V is the measure of the error box. Poses with equal outcomes on both sides cancel, so the noise is that of
//! the few poses that change sides and not of the Sum. The interval is that of Agresti and Min for paired
//! proportions (Statistics in Medicine 24, 2005, 729): half a pose is added to each outcome.
//!
//! ρ is an input that is hard to measure, so the spread of the Sum over ρ = 0.25 … 2 is reported with the
//! slopes.
//!
//! Not promised: that the Sum is smooth; a slope is the mean slope between p − h and p + h, which are
//! reported. Undecided poses count as rejected on both sides. Lengths in D, the Sum in Dᵃ·radᵇ.

mod report;

use super::pose_bytes;
use catchment_core::acceptance::{Acceptance, Domain, Outcome};
use catchment_core::design::{ConnectorSpec, Design, DesignDefect, Quantity, QuantityUnit};
use catchment_core::diagnostic::Advice;
use catchment_core::exec::{Cancelled, Exec, OutOfBudget};
use catchment_core::merit::sum::Sum;
use catchment_core::method::correction::Z95;
use catchment_core::method::{DecisionMethod, descent};
use catchment_core::pose::PoseError;
use catchment_core::problem::Problem;
use serde::{Deserialize, Serialize};

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct SensitivitySettings {
    /// Number of samples. Default: three times as many as a run with `descent` draws, because slopes need
    /// more.
    pub poses: Option<usize>,
    /// Seed of the samples.
    pub seed: u64,
    /// Step h as a share of ρ and of the aspect ratio.
    pub relative_step: f64,
    /// Step h of the centre of rotation, in D.
    pub cor_step: f64,
    /// Values of ρ over which the spread is taken, in D.
    pub rotation_lengths: Vec<f64>,
    /// Settings of the exact motions.
    pub descent: descent::DescentSettings,
}

impl SensitivitySettings {
    /// Least and greatest ρ of the spread, in D.
    pub const RHO: [f64; 2] = [0.25, 2.0];
    /// Values of ρ from the least to the greatest, each a fixed factor (the fourth root of two) above the last.
    const RHOS: usize = 13;
    /// How many of them double ρ.
    const RHOS_PER_OCTAVE: f64 = 4.0;
}

impl Default for SensitivitySettings {
    fn default() -> Self {
        let [least, _] = Self::RHO;
        // The system's power, folded by the compiler or not, has other last bits.
        let rho = |k: usize| least * libm::exp2(k as f64 / Self::RHOS_PER_OCTAVE);
        Self {
            poses: None,
            seed: 1,
            relative_step: 0.1,
            cor_step: 0.05,
            rotation_lengths: (0..Self::RHOS).map(rho).collect(),
            descent: descent::DescentSettings::default(),
        }
    }
}

/// The parameter that is varied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum VariedParameter {
    /// ρ, in D.
    RotationLength,
    /// Distance of the COR in front of the face centre, in D.
    CenterOfRotation,
    /// H/D of a family.
    AspectRatio,
}

/// Derivative of the Sum with respect to a parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Slope {
    /// The parameter.
    pub parameter: VariedParameter,
    /// Its value in the design.
    pub value: f64,
    /// The two values on either side that were compared.
    pub between: [f64; 2],
    /// d(Sum)/d(parameter): Dᵃ·radᵇ per D, or per unit of a ratio.
    pub slope: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Number of poses that dock only at the upper value.
    pub gained: usize,
    /// Number of poses that dock only at the lower value.
    pub lost: usize,
}

/// The Sum at a given ρ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AtRho {
    /// ρ, in D.
    pub rotation_length: f64,
    /// The Sum, Dᵃ·radᵇ.
    pub sum: f64,
    /// Its 95 % interval. Intervals at different ρ use the same poses and so are correlated.
    pub ci95: [f64; 2],
}

/// Sensitivity of the Sum to the parameters of a design.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sensitivity {
    /// Settings that change the result.
    pub settings: SensitivitySettings,
    /// Unit of the Sum, like `D²·rad³`.
    pub unit: String,
    /// The Sum of the design itself, from the same poses.
    pub sum: f64,
    /// Its 95 % interval.
    pub sum_ci95: [f64; 2],
    /// The slope for each parameter of the design.
    pub slopes: Vec<Slope>,
    /// The Sum over ρ, ascending.
    pub over_rho: Vec<AtRho>,
    /// The ρ of the smallest Sum.
    pub least: AtRho,
    /// The ρ of the largest Sum.
    pub greatest: AtRho,
    /// Largest Sum minus smallest Sum.
    pub spread: f64,
    /// Its 95 % interval, from the poses whose outcomes differ between the two.
    pub spread_ci95: [f64; 2],
    /// Undecided poses over all runs; they count as rejected.
    pub undecided: usize,
}

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
pub enum SensitivityError {
    /// The design does not allow a value that was to be tried.
    #[error("cannot try a value beside the design's: {0}")]
    Value(#[from] DesignDefect),
    /// A changed aspect ratio gives no halves.
    #[error("the halves at aspect ratio {aspect_ratio} cannot be built: {problem}")]
    Geometry {
        /// The ratio.
        aspect_ratio: f64,
        /// Description of the error.
        problem: String,
    },
    /// Nothing to compare.
    #[error("a sensitivity needs at least one pose and one value of rho")]
    Nothing,
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Computes slopes and spread of a design.
///
/// # Errors
/// See [`SensitivityError`].
pub fn run(
    problem: &Problem,
    settings: &SensitivitySettings,
    exec: &Exec,
) -> Result<Sensitivity, SensitivityError> {
    /// As a multiple of those of a run.
    const POSES_PER_SAMPLE: usize = 3;
    let design = problem.design();
    let default = || POSES_PER_SAMPLE * descent::DescentSettings::default().default_samples(problem.pair());
    let poses = settings.poses.unwrap_or_else(default);
    let settings = &SensitivitySettings { poses: Some(poses), ..settings.clone() };
    if poses == 0 || settings.rotation_lengths.is_empty() {
        return Err(SensitivityError::Nothing);
    }
    let per_pose = pose_bytes() + 2 * size_of::<PoseError>() as u64 + settings.rotation_lengths.len() as u64;
    exec.ensure_fits("the random poses", per_pose.saturating_mul(poses as u64), |budget| {
        vec![Advice::AtMostSamples(budget / per_pose)]
    })?;
    let mut common = CommonPoses::new(problem, settings, exec);
    let own = common.follow(design.clone())?;
    let slopes = VariedParameter::ALL
        .into_iter()
        .filter_map(|parameter| Some((parameter, parameter.of(design)?)))
        .map(|(parameter, value)| common.slope(parameter, value))
        .collect::<Result<Vec<Slope>, _>>()?;
    let mut rhos = settings.rotation_lengths.clone();
    rhos.sort_by(f64::total_cmp);
    let runs = rhos
        .iter()
        .map(|rho| common.follow(VariedParameter::RotationLength.set(design.clone(), *rho)?))
        .collect::<Result<Vec<Acceptance>, SensitivityError>>()?;
    let measured = |acceptance: &Acceptance| {
        let sum = Sum::of(acceptance, &design.alignment);
        (sum.sum, sum.ci95.unwrap_or([sum.sum; 2]))
    };
    let over_rho: Vec<AtRho> = rhos
        .iter()
        .zip(&runs)
        .map(|(rho, run)| {
            let (sum, ci95) = measured(run);
            AtRho { rotation_length: *rho, sum, ci95 }
        })
        .collect();
    let by_sum = |a: &usize, b: &usize| over_rho[*a].sum.total_cmp(&over_rho[*b].sum);
    let low = (0..runs.len()).min_by(by_sum).unwrap_or(0);
    let high = (0..runs.len()).max_by(by_sum).unwrap_or(0);
    let spread = Discordance::of(&runs[low], &runs[high]);
    let (sum, sum_ci95) = measured(&own);
    Ok(Sensitivity {
        settings: settings.clone(),
        unit: Sum::of(&own, &design.alignment).unit(),
        sum,
        sum_ci95,
        slopes,
        least: over_rho[low],
        greatest: over_rho[high],
        spread: spread.difference() * common.measure,
        spread_ci95: spread.ci95().map(|end| end * common.measure),
        undecided: common.undecided,
        over_rho,
    })
}

impl VariedParameter {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::RotationLength, Self::CenterOfRotation, Self::AspectRatio];

    /// Its name in design files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::RotationLength => "rotation_length",
            Self::CenterOfRotation => "center_of_rotation",
            Self::AspectRatio => "aspect_ratio",
        }
    }

    /// The value that a design has; own halves have no aspect ratio to change.
    fn of(self, design: &Design) -> Option<f64> {
        match self {
            Self::RotationLength => Some(design.alignment.rotation_length),
            Self::CenterOfRotation => Some(design.alignment.center_of_rotation),
            Self::AspectRatio => match &design.connector {
                ConnectorSpec::Family(spec) => Some(spec.aspect_ratio()),
                ConnectorSpec::Own(_) => None,
            },
        }
    }

    fn set(self, design: Design, value: f64) -> Result<Design, DesignDefect> {
        let quantity = Quantity { value, unit: QuantityUnit::Bare };
        match self {
            Self::RotationLength => design.with_rotation_length(quantity),
            Self::CenterOfRotation => design.with_center_of_rotation(quantity),
            Self::AspectRatio => design.with_aspect_ratio(value),
        }
    }
}

/// The same poses, followed again and again.
struct CommonPoses<'a> {
    problem: &'a Problem,
    settings: &'a SensitivitySettings,
    exec: &'a Exec,
    poses: Domain,
    /// Of the error box, Dᵃ·radᵇ.
    measure: f64,
    done: usize,
    undecided: usize,
}

impl<'a> CommonPoses<'a> {
    fn new(problem: &'a Problem, settings: &'a SensitivitySettings, exec: &'a Exec) -> Self {
        let alignment = problem.alignment();
        Self {
            problem,
            settings,
            exec,
            poses: Domain::random(alignment, settings.poses.unwrap_or_default(), settings.seed),
            measure: alignment.free.iter().map(|dof| 2.0 * alignment.half_range(dof)).product(),
            done: 0,
            undecided: 0,
        }
    }

    /// Follows every pose in a design.
    fn follow(&mut self, design: Design) -> Result<Acceptance, SensitivityError> {
        let aspect_ratio = VariedParameter::AspectRatio.of(&design).unwrap_or(f64::NAN);
        let changed = self
            .problem
            .with(design)
            .map_err(|error| SensitivityError::Geometry { aspect_ratio, problem: error.to_string() })?;
        let total = 1 + 2 * VariedParameter::ALL.len() + self.settings.rotation_lengths.len();
        let share = |k: usize| k as f64 / total as f64;
        let part = self.exec.part([share(self.done), share(self.done + 1)], "sensitivity");
        let (acceptance, _) =
            descent::run(changed.pair(), self.poses.clone(), &self.settings.descent, &part)?;
        self.done += 1;
        self.undecided += acceptance.counts()[Outcome::Undecided as usize - 1];
        Ok(acceptance)
    }

    fn slope(&mut self, parameter: VariedParameter, value: f64) -> Result<Slope, SensitivityError> {
        let step = match parameter {
            VariedParameter::CenterOfRotation => self.settings.cor_step,
            VariedParameter::RotationLength | VariedParameter::AspectRatio => {
                self.settings.relative_step * value
            }
        };
        let between = [value - step, value + step];
        let below = self.follow(parameter.set(self.problem.design().clone(), between[0])?)?;
        let above = self.follow(parameter.set(self.problem.design().clone(), between[1])?)?;
        let discordance = Discordance::of(&below, &above);
        let scale = self.measure / (between[1] - between[0]);
        Ok(Slope {
            parameter,
            value,
            between,
            slope: scale * discordance.difference(),
            standard_error: scale * discordance.standard_error(),
            ci95: discordance.ci95().map(|end| scale * end),
            gained: discordance.gained,
            lost: discordance.lost,
        })
    }
}

/// The poses with different outcomes under two conditions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Discordance {
    poses: usize,
    gained: usize,
    lost: usize,
}

impl Discordance {
    fn of(before: &Acceptance, after: &Acceptance) -> Self {
        let pairs = || before.accepted().zip(after.accepted());
        Self {
            poses: before.outcomes.len(),
            gained: pairs().filter(|(before, after)| !before && *after).count(),
            lost: pairs().filter(|(before, after)| *before && !after).count(),
        }
    }

    /// Increase of the accepted share of the poses.
    fn difference(self) -> f64 {
        (self.gained as f64 - self.lost as f64) / self.poses as f64
    }

    /// After half a pose is added to each of the four ways of faring.
    fn standard_error(self) -> f64 {
        let n = self.poses as f64 + 2.0;
        let (gained, lost) = (self.gained as f64 + 0.5, self.lost as f64 + 0.5);
        ((gained + lost - (gained - lost).powi(2) / n) / (n * n)).sqrt()
    }

    fn ci95(self) -> [f64; 2] {
        let center = (self.gained as f64 - self.lost as f64) / (self.poses as f64 + 2.0);
        let half = Z95 * self.standard_error();
        [center - half, center + half]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment_core::design::Family;
    use catchment_core::pose::{Dof, DofSet};

    fn planar() -> Design {
        Design::of_family(Family::VFace, [Dof::X, Dof::Pitch].into_iter().collect())
    }

    #[test]
    fn every_fourth_rho_is_twice_the_last_to_the_bit() {
        let rhos = SensitivitySettings::default().rotation_lengths;
        assert_eq!(rhos.iter().copied().step_by(4).collect::<Vec<_>>(), [0.25, 0.5, 1.0, 2.0]);
        assert_eq!([rhos[0], rhos[SensitivitySettings::RHOS - 1]], SensitivitySettings::RHO);
        assert_eq!(rhos[1..4], [0.297_301_778_750_680_26, 0.353_553_390_593_273_8, 0.420_448_207_626_857_25]);
    }

    #[test]
    fn poses_with_equal_outcomes_cancel() {
        // Ten of a thousand poses change sides, eight to the better: (8 − 2)/1000, and the variance of that.
        let discordance = Discordance { poses: 1000, gained: 8, lost: 2 };
        assert_eq!(discordance.difference(), 0.006);
        // √(11 − 36/1002)/1002, by hand.
        assert!(
            (discordance.standard_error() - 0.003_304_6).abs() < 1e-7,
            "{}",
            discordance.standard_error()
        );
        let [lo, hi] = discordance.ci95();
        assert!(lo < 0.0 && 0.006 < hi, "ten poses do not show a slope: {lo} {hi}");
        // No pose changed sides: not known to better than some three in a thousand.
        let [lo, hi] = Discordance { poses: 1000, gained: 0, lost: 0 }.ci95();
        assert!(lo == -hi && (0.001..0.004).contains(&hi), "{hi}");
    }

    #[test]
    fn threads_change_nothing_and_every_parameter_is_varied() {
        let settings = SensitivitySettings {
            poses: Some(200),
            rotation_lengths: vec![2.0, 0.25],
            ..SensitivitySettings::default()
        };
        let with = |threads| {
            let exec = Exec::new().with_threads(threads).unwrap();
            run(&Problem::of(planar()).unwrap(), &settings, &exec).unwrap()
        };
        let one = with(1);
        assert_eq!(one, with(3));
        assert_eq!(one.unit, "D·rad");
        assert_eq!(one.slopes.iter().map(|s| s.parameter).collect::<Vec<_>>(), VariedParameter::ALL);
        assert_eq!(one.slopes[0].between, [0.45, 0.55]);
        assert_eq!(one.over_rho[0].rotation_length, 0.25, "ascending");
        assert!(one.spread >= 0.0 && (one.spread - (one.greatest.sum - one.least.sum)).abs() < 1e-12);
        assert!(one.sum_ci95[0] < one.sum && one.sum < one.sum_ci95[1]);
    }

    #[test]
    fn without_rotation_rho_does_not_matter() {
        // Translation alone: ρ weighs nothing, the Sum is ZRAA's 1 D of the V-Face, and no pose changes sides.
        let design = Design::of_family(Family::VFace, DofSet::EMPTY.with(Dof::X));
        let result = run(
            &Problem::of(design).unwrap(),
            &SensitivitySettings { poses: Some(300), ..SensitivitySettings::default() },
            &Exec::new(),
        )
        .unwrap();
        assert_eq!((result.slopes[0].gained, result.slopes[0].lost, result.spread), (0, 0, 0.0));
        assert!(result.sum_ci95[0] < 1.0 && 1.0 < result.sum_ci95[1], "{:?}", result.sum_ci95);
    }

    #[test]
    fn invalid_settings_are_refused() {
        let refused = |settings: SensitivitySettings, exec: &Exec| {
            run(&Problem::of(planar()).unwrap(), &settings, exec).unwrap_err()
        };
        let none = SensitivitySettings { poses: Some(0), ..SensitivitySettings::default() };
        assert!(matches!(refused(none, &Exec::new()), SensitivityError::Nothing));
        let small = Exec::new().with_memory_budget(1000);
        assert!(matches!(refused(SensitivitySettings::default(), &small), SensitivityError::OutOfBudget(_)));
        let beyond = SensitivitySettings {
            rotation_lengths: vec![1e9],
            poses: Some(2),
            ..SensitivitySettings::default()
        };
        assert!(matches!(refused(beyond, &Exec::new()), SensitivityError::Value(_)));
    }
}
