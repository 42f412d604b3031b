//! Warnings about results as data: their codes, numbers, sentences and advice.

use super::Advice;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A warning about a result, with its numbers; `kind` in JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Warning {
    /// The accepted set reaches the border of the error box: part of it may lie outside.
    TouchesBorder {
        /// Names of the axes that the set reaches.
        axes: Vec<String>,
    },
    /// Some poses are undecided.
    Undecided {
        /// Number of undecided poses.
        cells: usize,
    },
    /// Some of the sampled motions behind the Sum are undecided.
    UndecidedSample {
        /// Number of undecided motions.
        motions: usize,
        /// Number of sampled motions.
        of: usize,
    },
    /// The method's direction is quantised by the grid, so its border does not converge to the true one.
    FloodingBias,
    /// Accepted cells lie on level ground, such as the rim of a hole, on which nothing slides.
    LevelGround {
        /// Number of such cells.
        cells: usize,
        /// Number of accepted cells.
        of: usize,
    },
    /// Motions that left the error box were not followed.
    CutOff,
    /// The grid estimate of the Sum lies outside the confidence interval of the sampled exact motions.
    OutsideSample {
        /// Measure of the accepted cells, Dᵃ·radᵇ.
        sum_grid: f64,
        /// 95 % interval of the Sum, Dᵃ·radᵇ.
        ci95: [f64; 2],
    },
    /// No poses were sampled: the Sum is the measure of the accepted cells, without a check.
    NoInterval,
    /// Cells that the method could not decide, too many to follow them exactly.
    Ambiguous {
        /// Number of such cells.
        cells: usize,
        /// Number of all cells.
        of: usize,
    },
    /// Some sampled motions have another outcome if their steps are halved.
    StepDependence {
        /// Number of sampled poses whose outcome changed.
        changed: usize,
        /// Number of sampled poses.
        of: usize,
        /// 95 % interval of the share that changes, in [0, 1].
        ci95: [f64; 2],
    },
    /// Numbers of the dissertation's own conventions, fitted to its tables; not physics.
    DissertationConventions,
    /// The mated pose is not inside the accepted set.
    MatedPoseNotAccepted,
    /// Some cells are undecided, for the stated reason.
    Open {
        /// The reason, as a sentence.
        text: String,
    },
    /// Any other warning, as a sentence.
    Note {
        /// The sentence.
        text: String,
    },
}

impl Warning {
    /// Its stable code: the `kind` of its JSON.
    pub const fn code(&self) -> &'static str {
        match self {
            Self::TouchesBorder { .. } => "touches-border",
            Self::Undecided { .. } => "undecided",
            Self::UndecidedSample { .. } => "undecided-sample",
            Self::FloodingBias => "flooding-bias",
            Self::LevelGround { .. } => "level-ground",
            Self::CutOff => "cut-off",
            Self::OutsideSample { .. } => "outside-sample",
            Self::NoInterval => "no-interval",
            Self::Ambiguous { .. } => "ambiguous",
            Self::StepDependence { .. } => "step-dependence",
            Self::DissertationConventions => "dissertation-conventions",
            Self::MatedPoseNotAccepted => "mated-pose-not-accepted",
            Self::Open { .. } => "open",
            Self::Note { .. } => "note",
        }
    }

    /// Advice for it, if there is any.
    pub(super) const fn advice(&self) -> Option<Advice> {
        match self {
            Self::TouchesBorder { .. } => Some(Advice::EnlargeErrors),
            Self::FloodingBias | Self::LevelGround { .. } => Some(Advice::Method("descent")),
            Self::OutsideSample { .. } => Some(Advice::FinerGrid),
            Self::NoInterval => Some(Advice::Samples),
            _ => None,
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TouchesBorder { axes } => write!(
                f,
                "some poses at the end of the error box along {} still dock, with other errors not zero: enlarge [errors] in the design to see all of them",
                axes.join(", ")
            ),
            Self::Undecided { cells } => {
                let (poses, their) = if *cells == 1 { ("pose", "its") } else { ("poses", "their") };
                write!(f, "{cells} {poses} undecided: {their} motion could not be followed to its end")
            }
            Self::UndecidedSample { motions, of } => write!(
                f,
                "{motions} of {of} sampled motions could not be followed to their end: the Sum counts them as not docked, its \
                 interval includes both cases"
            ),
            Self::FloodingBias => write!(
                f,
                "flooding moves along grid directions only: its Sum may be off by several percent at any resolution, and by \
                 far more on a coarse grid; descent is exact at every pose"
            ),
            Self::LevelGround { cells, of } => write!(
                f,
                "{cells} of {of} accepted cells lie on level ground above the seat, on which no half slides: flooding counts them as \
                 docked, so its Sum is too large by at least these cells"
            ),
            Self::CutOff => write!(
                f,
                "poses whose motion leaves the error box were not followed beyond it on this grid: they count as \
                 missed at a border of x or y, as jammed at one of an angle"
            ),
            Self::OutsideSample { sum_grid, ci95: [lo, hi] } => write!(
                f,
                "the AA by the grid, {sum_grid:.4}, lies outside the 95 % CI {lo:.4} … {hi:.4} of the sampled poses: the grid is too \
                 coarse or its method biased. Slices, pictures and shares of jams and misses use the grid: do not rely on them. The docked \
                 share and the AA (both corrected by the sampled poses), window and limits stay valid"
            ),
            Self::NoInterval => write!(
                f,
                "the Sum is that of the accepted cells, without a confidence interval; sampled poses, followed \
                 exactly, give an unbiased Sum with an interval"
            ),
            Self::Ambiguous { cells, of } => write!(
                f,
                "{cells} of {of} cells are ambiguous, too many to follow each exactly: slices and pictures show \
                 the method's guess for them; the Sum with its interval, ONAA, window and limits do not use it"
            ),
            Self::StepDependence { changed, of, ci95: [lo, hi] } => write!(
                f,
                "{changed} of {of} sampled poses have another outcome if the steps of their motion are halved (95 % CI {:.1} … {:.1} % of all \
                 poses): the fit is tight, and every number is only as accurate as that",
                100.0 * lo,
                100.0 * hi
            ),
            Self::DissertationConventions => {
                write!(
                    f,
                    "the dissertation preset uses conventions fitted to its tables; not for design decisions"
                )
            }
            Self::MatedPoseNotAccepted => {
                write!(
                    f,
                    "the mated pose itself is not accepted: the grid is too coarse, or the pair does not hold there"
                )
            }
            Self::Open { text } | Self::Note { text } => f.write_str(text),
        }
    }
}
