//! Whether robots dock: as versioned JSON, as records for programs. Its text is `success/text.rs`.

mod text;

#[cfg(feature = "figure")]
pub(crate) use text::chance;

use super::envelope::{Body, Envelope};
use super::schema::{Timing, WarningReport};
use super::text::number;
use super::trajectory::TouchReport;
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::{Matrix, Moments};
use catchment_study::success::{
    AlongAxis, AtFactor, AxisFit, Docking, Factor, Fit, Improvement, Settings, Stratum, Success,
};
use serde::Serialize;

/// Whether robots dock, with its head.
pub type SuccessesReport = Envelope<SuccessesBody>;

/// Whether robots dock.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SuccessesBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// How it was asked for.
    pub settings: Settings,
    /// The robot that docks most seldom: what one asks for first.
    pub success: Headline,
    /// Each robot, in the order of their file.
    pub robots: Vec<DockingReport>,
    /// Exact motions in all, those of grids left out.
    pub motions: usize,
}

/// The robot that docks most seldom.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Headline {
    /// What it is called.
    pub robot: String,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// By how much all its σ may be multiplied for the success that is required.
    pub tolerable: f64,
}

/// Whether a robot docks. Lengths in D, angles in radians.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DockingReport {
    /// What it is called.
    pub robot: String,
    /// Which errors are expected of it.
    pub errors: ErrorsReport,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Exact motions that this took.
    pub motions: usize,
    /// How many of them could not be followed to their end: they count as failures.
    pub undecided: usize,
    /// Plain motions of random errors whose interval would be as wide.
    pub plain_motions: f64,
    /// The grid that said where to look.
    pub grid: GridCost,
    /// Share of the errors that lie outside of the design's error box.
    pub outside_box: f64,
    /// What was seen of each stratum.
    pub strata: Vec<Stratum>,
    /// What fails.
    pub failures: FailuresReport,
    /// What it helps to improve each error, the most helpful first.
    pub improve: Vec<ImprovementReport>,
    /// How much larger σ may be.
    pub tolerable: TolerableReport,
    /// The probability with all σ multiplied by some factors, in ascending order.
    pub curve: Vec<AtFactor>,
    /// Of measured errors, whether they are normal; null of others, and of fewer than eight rows.
    pub fit: Option<FitReport>,
}

/// Which errors are expected.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ErrorsReport {
    /// `normal`, `uniform` or `measured`.
    pub kind: &'static str,
    /// Rows, of measured errors; else null.
    pub rows: Option<usize>,
    /// Mean of each error.
    pub mean: PoseError,
    /// Standard deviation of each error.
    pub sigma: PoseError,
    /// Correlations, in the order x, y, roll, pitch, yaw.
    pub correlation: Matrix,
}

/// What the grid took.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GridCost {
    /// Cells that were decided; 0 where there was no grid.
    pub cells: usize,
    /// Motions that this took, to their end or not.
    pub motions: usize,
}

/// What fails.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FailuresReport {
    /// Share of all errors, in [0, 1].
    pub share: f64,
    /// Of the failures the share that jams.
    pub jammed: f64,
    /// The share that misses.
    pub missed: f64,
    /// The share that could not be followed to its end.
    pub undecided: f64,
    /// The error that is larger, in σ, where docking fails than where it does not, by more than any other; null where nothing fails.
    pub dominating: Option<Dof>,
    /// Where failures lie, error by error.
    pub along: Vec<AlongAxis>,
    /// The likeliest failure that was found; null where nothing failed.
    pub first: Option<FirstReport>,
}

/// The failing error that is nearest to the mean.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FirstReport {
    /// The pose error.
    pub error: PoseError,
    /// The same in σ from the mean (half-widths of uniform errors).
    pub sigmas: PoseError,
    /// Mahalanobis' distance from the mean.
    pub distance: f64,
    /// What becomes of it.
    pub outcome: Outcome,
    /// Where it ends.
    pub end: PoseError,
    /// What touches there, in the world frame of the fixed face centre, in D, with the normal towards the moving half.
    pub touches: Vec<TouchReport>,
}

/// What it helps to improve an error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ImprovementReport {
    /// Which.
    pub axis: Dof,
    /// Its standard deviation, in D or radians.
    pub sigma: f64,
    /// dP/dσ (by the half-width of uniform errors), in 1/D or 1/rad; null where it is not known.
    pub slope: Option<f64>,
    /// Its 95 % interval.
    pub slope_ci95: Option<[f64; 2]>,
    /// Probability of docking with this σ halved.
    pub halved: f64,
    /// Its 95 % interval.
    pub halved_ci95: [f64; 2],
    /// What that gains.
    pub gain: f64,
    /// Its 95 % interval.
    pub gain_ci95: [f64; 2],
}

/// How much larger σ may be.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TolerableReport {
    /// The success that is required.
    pub required: f64,
    /// All of them together.
    #[serde(flatten)]
    pub all: Factor,
    /// Each alone.
    pub alone: Vec<AloneReport>,
}

/// How much larger one σ may be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AloneReport {
    /// Which.
    pub axis: Dof,
    /// The standard deviation then, in D or radians.
    pub sigma: f64,
    /// The factor.
    #[serde(flatten)]
    pub factor: Factor,
}

/// A normal fit to measured errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FitReport {
    /// Whether it is rejected at 5 %.
    pub rejected: bool,
    /// Chance of normal errors to look so little normal.
    pub p_value: f64,
    /// Each error by itself.
    pub axes: Vec<AxisFit>,
    /// Mardia's kurtosis.
    pub kurtosis: Option<f64>,
    /// Its p-value.
    pub kurtosis_p_value: Option<f64>,
    /// Errors of which neighbouring rows are alike.
    pub trending: Vec<Dof>,
    /// Probability of docking if errors were as the fit has them.
    pub probability: Option<f64>,
    /// Its 95 % interval.
    pub ci95: Option<[f64; 2]>,
}

impl Body for SuccessesBody {
    const KIND: &'static str = "success";
}

/// Beyond this share of errors outside of the error box it is said.
const MUCH_OUTSIDE: f64 = 0.01;

impl SuccessesReport {
    /// Of a design.
    pub fn new(
        design: &Design,
        found: &Success,
        mut doubts: Vec<WarningReport>,
        timing: Option<Timing>,
    ) -> Self {
        let robots: Vec<DockingReport> =
            found.robots.iter().map(|robot| docking(robot, found.settings.required)).collect();
        let many = found.robots.len() > 1;
        for robot in &found.robots {
            let name = if many { format!("{}: ", robot.robot) } else { String::new() };
            doubts.extend(
                warnings(robot).into_iter().map(|text| WarningReport::note(&format!("{name}{text}"))),
            );
        }
        let worst = found.worst();
        let success = Headline {
            robot: worst.map_or_else(String::new, |robot| robot.robot.clone()),
            probability: worst.map_or(0.0, |robot| robot.probability),
            ci95: worst.map_or([0.0, 1.0], |robot| robot.ci95),
            tolerable: worst.map_or(0.0, |robot| robot.tolerable.factor),
        };
        let body = SuccessesBody {
            design: design.clone(),
            settings: found.settings.clone(),
            success,
            robots,
            motions: found.motions,
        };
        Self::of(body, doubts, timing)
    }

    /// Probability, gains and factors as records for programs, a row per robot and error, the names of the columns first; D and radians.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = [
            "robot",
            "probability",
            "low",
            "high",
            "axis",
            "sigma",
            "slope",
            "halved",
            "gain",
            "tolerable_factor",
            "tolerable_sigma",
        ];
        let mut records = vec![head.map(str::to_owned).to_vec()];
        for robot in &self.robots {
            for improve in &robot.improve {
                let alone = robot.tolerable.alone.iter().find(|alone| alone.axis == improve.axis);
                records.push(vec![
                    robot.robot.clone(),
                    number(robot.probability),
                    number(robot.ci95[0]),
                    number(robot.ci95[1]),
                    improve.axis.name().to_owned(),
                    number(improve.sigma),
                    improve.slope.map_or_else(String::new, number),
                    number(improve.halved),
                    number(improve.gain),
                    alone.map_or_else(String::new, |alone| number(alone.factor.factor)),
                    alone.map_or_else(String::new, |alone| number(alone.sigma)),
                ]);
            }
        }
        records
    }
}

fn docking(robot: &Docking, required: f64) -> DockingReport {
    let Moments { mean, sigma, correlation } = robot.moments;
    let failures = &robot.failures;
    let excess = |along: &AlongAxis| Some(along.failed? - along.docked.unwrap_or(0.0));
    let dominating = failures.along.iter().filter_map(|along| Some((along.axis, excess(along)?)));
    let first = failures.first.as_ref().map(|first| FirstReport {
        error: first.error,
        sigmas: PoseError::from_array(first.sigmas),
        distance: first.distance,
        outcome: first.outcome,
        end: first.end,
        touches: first
            .touches
            .iter()
            .map(|touch| TouchReport { point_d: touch.point.to_array(), normal: touch.normal.to_array() })
            .collect(),
    });
    DockingReport {
        robot: robot.robot.clone(),
        errors: ErrorsReport { kind: robot.kind, rows: robot.rows, mean, sigma, correlation },
        probability: robot.probability,
        ci95: robot.ci95,
        motions: robot.motions,
        undecided: robot.undecided,
        plain_motions: robot.plain_motions,
        grid: GridCost { cells: robot.grid[0], motions: robot.grid[1] },
        outside_box: robot.outside,
        strata: robot.strata.clone(),
        failures: FailuresReport {
            share: failures.share,
            jammed: failures.jammed,
            missed: failures.missed,
            undecided: failures.undecided,
            dominating: dominating.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(axis, _)| axis),
            along: failures.along.clone(),
            first,
        },
        improve: robot.improve.iter().map(improvement).collect(),
        tolerable: TolerableReport {
            required,
            all: robot.tolerable,
            alone: robot
                .tolerable_alone
                .iter()
                .map(|(axis, factor)| AloneReport {
                    axis: *axis,
                    sigma: factor.factor * sigma.to_array()[axis.index()],
                    factor: *factor,
                })
                .collect(),
        },
        curve: robot.curve.clone(),
        fit: robot.fit.as_ref().map(fit),
    }
}

fn improvement(improve: &Improvement) -> ImprovementReport {
    ImprovementReport {
        axis: improve.axis,
        sigma: improve.sigma,
        slope: improve.slope.map(|slope| slope.slope),
        slope_ci95: improve.slope.map(|slope| slope.ci95),
        halved: improve.halved,
        halved_ci95: improve.halved_ci95,
        gain: improve.gain,
        gain_ci95: improve.gain_ci95,
    }
}

fn fit(fit: &Fit) -> FitReport {
    FitReport {
        rejected: fit.rejected,
        p_value: fit.p_value,
        axes: fit.axes.clone(),
        kurtosis: fit.kurtosis,
        kurtosis_p_value: fit.kurtosis_p_value,
        trending: fit.trending.clone(),
        probability: fit.success.map(|(probability, _)| probability),
        ci95: fit.success.map(|(_, ci95)| ci95),
    }
}

/// What speaks against the numbers of a robot.
fn warnings(robot: &Docking) -> Vec<String> {
    let mut said = Vec::new();
    let first = robot.failures.first.as_ref();
    if first.is_some_and(|first| first.distance == 0.0) {
        said.push("its mean error alone does not dock: smaller standard deviations do not help".to_owned());
    }
    if robot.undecided > 0 {
        said.push(format!(
            "{} of {} motions could not be followed to their end: they count as failures, and the interval reaches to where they \
             are not",
            robot.undecided, robot.motions
        ));
    }
    if robot.outside > MUCH_OUTSIDE {
        said.push(format!(
            "{:.1} % of its errors lie outside of the design's error box: they were followed like all others, while an area of \
             acceptance ends at the box",
            100.0 * robot.outside
        ));
    }
    if let Some(fit) = &robot.fit {
        if fit.rejected {
            said.push(format!(
                "its measured errors are not normal (p = {:.2}): the probability rests on the rows alone, and the normal fit beside \
                 it is not to be trusted",
                fit.p_value
            ));
        }
        if !fit.trending.is_empty() {
            let names: Vec<&str> = fit.trending.iter().map(|dof| dof.name()).collect();
            said.push(format!(
                "neighbouring rows are alike in {}: they are fewer independent measurements than rows, and the interval is too narrow",
                names.join(", ")
            ));
        }
    }
    said
}

impl SuccessesBody {
    /// The robot that docks most seldom.
    pub fn worst(&self) -> Option<&DockingReport> {
        self.robots.iter().find(|robot| robot.robot == self.success.robot)
    }
}
