//! Do 95 % intervals contain the true value 95 times in 100, on real designs?
//!
//! ```text
//!   exact  ────────────┼────────────   a large plain sample of exact descents; its own error is included
//!   repeat 1      ├────┼──────┤        held
//!   repeat 2  ├──────┤ │               missed
//!   …
//! ```
//!
//! The study runs every design with three partitions of its error box: a single stratum, which is plain sampling;
//! by accepted cells and their neighbours; and by arrival fraction, which `run` uses. Each uses the same number of
//! descents, so the widths of the intervals compare the partitions.
//!
//! Not promised: a share of 100 repeats is itself known to ± 4 % only.

use super::accuracy::Case;
use catchment::acceptance::{Domain, Outcome};
use catchment::connector::Connector;
use catchment::contact::Pair;
use catchment::design::Family;
use catchment::exec::{Cancelled, Exec, OutOfBudget};
use catchment::landscape::Grid;
use catchment::method::correction::{self, ByFraction, ByNeighbours, CorrectionError, Stop, Stratify, Z95};
use catchment::method::descent;
use catchment::method::transport::{self, TransportError};
use catchment::pose::Dof;
use serde::Serialize;

/// Settings that affect the result.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CoverageSettings {
    /// Intervals per design and partition.
    pub repeats: u64,
    /// Descents per interval.
    pub descents: usize,
    /// Descents of the plain sample that gives the exact value.
    pub exact: usize,
}

impl Default for CoverageSettings {
    /// A few minutes on two cores.
    fn default() -> Self {
        Self { repeats: 100, descents: 1000, exact: 400_000 }
    }
}

/// Reasons why the study fails.
#[derive(Debug, thiserror::Error)]
pub enum CoverageError {
    /// A design has no halves.
    #[error("{design}: {problem}")]
    Design {
        /// The design.
        design: &'static str,
        /// Its first problem.
        problem: String,
    },
    /// The grid failed.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// The interval failed.
    #[error(transparent)]
    Correction(#[from] CorrectionError),
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// One design with one partition.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CoverageRow {
    /// The design.
    pub design: &'static str,
    /// The partition of its error box.
    pub strata: &'static str,
    /// The share of the error box that is accepted, from the plain sample.
    pub exact: f64,
    /// Half the 95 % interval of `exact`.
    pub exact_error: f64,
    /// Share of the repeats whose interval, widened by `exact_error`, contains `exact`.
    pub held: f64,
    /// Mean of the estimates over `exact`, less 1.
    pub bias: f64,
    /// Mean half-width of the intervals over `exact`.
    pub half_width: f64,
    /// Number of plain descents that one of these replaces, by the spread of the estimates.
    pub worth: f64,
}

/// The whole study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coverage {
    /// Its settings.
    pub settings: CoverageSettings,
    /// Its rows.
    pub rows: Vec<CoverageRow>,
}

/// A design and the resolution of its partition.
struct Parted {
    name: &'static str,
    case: Case,
    cells: usize,
}

/// A planar design, one with three free errors and one with five.
fn cases() -> [Parted; 3] {
    let pyramid = |name, free, cells| {
        let case = Case {
            family: Family::Pyramid,
            aspect_ratio: 0.5,
            center_of_rotation: 0.5,
            rotation_length: 0.5,
            free,
        };
        Parted { name, case, cells }
    };
    let v_face = Case {
        family: Family::VFace,
        aspect_ratio: 1.0,
        center_of_rotation: 0.0,
        rotation_length: 1.0,
        free: &[Dof::X, Dof::Pitch],
    };
    [
        Parted { name: "v-face, x pitch, 101² cells", case: v_face, cells: 101 },
        pyramid("pyramid, x y yaw, 41³ cells", &[Dof::X, Dof::Y, Dof::Yaw], 41),
        pyramid("pyramid, all five, 13⁵ cells", &Dof::ALL, 13),
    ]
}

impl Parted {
    fn pair(&self) -> Result<Pair, CoverageError> {
        let design = self.case.design();
        let built = Connector::build(&design).map_err(|problems| CoverageError::Design {
            design: self.name,
            problem: problems.first().map_or_else(String::new, ToString::to_string),
        })?;
        Ok(Pair::new(&built, &design.alignment))
    }
}

/// Repeats the correction of every design and counts the intervals that contain the exact value.
///
/// # Errors
/// See [`CoverageError`].
pub fn coverage(settings: &CoverageSettings, exec: &Exec) -> Result<Coverage, CoverageError> {
    let cases = cases();
    let mut rows = Vec::new();
    for (k, case) in cases.iter().enumerate() {
        let at = |part: f64| (k as f64 + part / 4.0) / cases.len() as f64;
        let pair = case.pair()?;
        let grid = Grid::over(&pair.alignment, |_| case.cells);
        let arrival = transport::run(
            &pair,
            &grid,
            &transport::TransportSettings::default(),
            &exec.part([at(0.0); 2], STAGE),
        )?;
        let outcomes = arrival.acceptance(exec)?.outcomes;
        let exact = plain(&pair, settings.exact, &exec.part([at(0.0), at(1.0)], STAGE))?;
        let nothing = vec![Outcome::Missed; grid.len()];
        let plain = ByNeighbours::new(&nothing, grid.shape());
        let neighbours = ByNeighbours::new(&outcomes, grid.shape());
        let fraction = ByFraction::new(|cell| arrival.fraction(cell), grid.shape());
        let try_out = Trial { case, pair: &pair, grid: &grid, settings, exact, exec };
        rows.push(try_out.row("none", &plain, at(1.0))?);
        rows.push(try_out.row("neighbours", &neighbours, at(2.0))?);
        rows.push(try_out.row("fraction", &fraction, at(3.0))?);
    }
    Ok(Coverage { settings: *settings, rows })
}

const STAGE: &str = "coverage";
/// Seed of the plain samples; those of the repeats are 1, 2, 3, …
const EXACT_SEED: u64 = 0;
/// Poses of a plain sample that are drawn at a time, which bounds the memory.
const CHUNK: usize = 10_000;

/// Accepted share of the error box, by `count` plain random poses.
fn plain(pair: &Pair, count: usize, exec: &Exec) -> Result<f64, Cancelled> {
    let settings = descent::DescentSettings::default();
    let chunks = count.div_ceil(CHUNK);
    let mut aligned = 0;
    for chunk in 0..chunks {
        // Seeds that differ from those of the repeats.
        let domain = Domain::random(&pair.alignment, CHUNK, EXACT_SEED.wrapping_sub(chunk as u64));
        let span = [chunk, chunk + 1].map(|k| k as f64 / chunks as f64);
        aligned += descent::run(pair, domain, &settings, &exec.part(span, STAGE))?.0.counts()[0];
    }
    Ok(aligned as f64 / (chunks * CHUNK) as f64)
}

struct Trial<'a> {
    case: &'a Parted,
    pair: &'a Pair,
    grid: &'a Grid,
    settings: &'a CoverageSettings,
    exact: f64,
    exec: &'a Exec,
}

impl Trial<'_> {
    fn row(&self, strata: &'static str, by: &impl Stratify, at: f64) -> Result<CoverageRow, CoverageError> {
        let CoverageSettings { repeats, descents, exact: plain } = *self.settings;
        let silent = self.exec.part([at; 2], STAGE);
        let one = |number: usize, exec: &Exec| {
            let settings =
                correction::CorrectionSettings { seed: number as u64 + 1, stop: Stop::Samples(descents) };
            correction::correct(
                self.pair,
                self.grid,
                by,
                &settings,
                &descent::DescentSettings::default(),
                exec,
            )
        };
        let result = silent.each(repeats as usize, usize::MAX, STAGE, one);
        let result = result.into_iter().collect::<Result<Vec<_>, _>>()?;
        let exact = self.exact;
        let exact_error = Z95 * (exact * (1.0 - exact) / plain as f64).sqrt();
        let measure = self.grid.measure();
        let mean =
            |f: &dyn Fn(&correction::UnbiasedSum) -> f64| result.iter().map(f).sum::<f64>() / repeats as f64;
        let held = mean(&|c| {
            let [down, up] = [c.sum - c.ci95[0], c.ci95[1] - c.sum].map(|w| (w / measure).hypot(exact_error));
            f64::from(u8::from(c.fraction - down <= exact && exact <= c.fraction + up))
        });
        let average = mean(&|c| c.fraction);
        let variance = mean(&|c| (c.fraction - average).powi(2)) * repeats as f64 / (repeats as f64 - 1.0);
        Ok(CoverageRow {
            design: self.case.name,
            strata,
            exact,
            exact_error,
            held,
            bias: average / exact - 1.0,
            half_width: mean(&|c| (c.ci95[1] - c.ci95[0]) / 2.0 / measure) / exact,
            worth: exact * (1.0 - exact) / (variance * mean(&|c| c.descents as f64)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_study_has_a_row_for_every_partition() {
        let settings = CoverageSettings { repeats: 3, descents: 100, exact: 10_000 };
        let result = coverage(&settings, &Exec::new()).unwrap();
        assert_eq!(result.rows.len(), 9);
        // Intervals of a hundred descents are wide, and three of three may miss by chance once in 10⁴.
        assert!(result.rows.iter().all(|r| r.held > 0.0 && r.half_width < 1.0), "{result}");
        assert_eq!(result.to_string().lines().count(), 11);
    }
}
