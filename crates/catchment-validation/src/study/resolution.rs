//! Figure 5.13: Sum and computing time of each method over the resolution, for the V-Face at H/D ¼, COR −½.
//!
//! ```text
//!   Sum ▲  ○__                     the dissertation: its Sum begins larger, slowly decreases, and its time grows like N²
//!       │     ○──○──○  preset      (its figure is lost, no point of it is stored)
//!       │  ●──●──●──●  exact       here: its own method, and every general method of this program, at the same rotation
//!       └────────────▶ N           point, with the exact Sum and its 95 % interval
//! ```
//!
//! Samples or cells per axis N over x in ±2 D and θ in ±90°. Seconds are wall-clock time and differ between runs.

use crate::recipe::dissertation::{self, SampledErrors};
use crate::recipe::{PLANAR_BASE, RHO, RecipeError, design};
use catchment::design::{Design, Family};
use catchment::exec::Exec;
use catchment::method::Method;
use catchment::method::correction::{self, Stop};
use catchment::pose::Dof;
use catchment::problem::Problem;
use catchment::study::refinement::GridDecision;
use serde::Serialize;
use std::time::Instant;

/// Settings that affect the result.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ResolutionStudySettings {
    /// Samples or cells per axis, coarse to fine; even.
    pub resolutions: Vec<usize>,
    /// The finest resolution of descent, which is slow.
    pub finest_descent: usize,
    /// Number of random descents for the exact Sum.
    pub descents: usize,
    /// Seed of the random descents.
    pub seed: u64,
}

impl Default for ResolutionStudySettings {
    fn default() -> Self {
        Self { resolutions: vec![26, 50, 100, 200, 400, 800], finest_descent: 200, descents: 20_000, seed: 1 }
    }
}

/// One method.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MethodCurve {
    /// Its name.
    pub name: &'static str,
    /// Coarse to fine.
    pub points: Vec<MethodPoint>,
}

/// One method at one resolution.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MethodPoint {
    /// Samples or cells per axis.
    pub resolution: usize,
    /// The Sum, D·rad.
    pub sum: f64,
    /// Wall-clock time.
    pub seconds: f64,
}

/// The figure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResolutionFigure {
    /// The settings that affect the result.
    pub settings: ResolutionStudySettings,
    /// The exact Sum, D·rad.
    pub exact: f64,
    /// Its 95 % interval.
    pub exact_ci95: [f64; 2],
    /// ρ of the methods that use it, in D.
    pub rotation_length: f64,
    /// One per method, the dissertation's own first.
    pub curves: Vec<MethodCurve>,
}

/// The figure's design: H/D, and COR in the dissertation's sense.
const ASPECT_RATIO: f64 = 0.25;
const COR: f64 = -0.5;

/// Name of the dissertation's own method.
const PRESET: &str = "dissertation's";

/// Computes the figure.
///
/// # Errors
/// When it is cancelled, or does not fit into memory.
pub fn run(settings: &ResolutionStudySettings, exec: &Exec) -> Result<ResolutionFigure, RecipeError> {
    let failed = |error: &dyn std::error::Error| RecipeError::Exact { reason: error.to_string() };
    let preset =
        dissertation::DissertationSettings::new(Family::VFace, SampledErrors::XTheta, ASPECT_RATIO, COR);
    let free = [Dof::X, Dof::Pitch].into_iter().collect();
    let cor = preset.center_of_rotation();
    let design: Design = design(Family::VFace, ASPECT_RATIO, Some(PLANAR_BASE), cor, free);
    let problem = Problem::of(design).map_err(|error| failed(&error))?;
    let mut own = MethodCurve { name: PRESET, points: Vec::new() };
    for &resolution in &settings.resolutions {
        exec.check()?;
        let started = Instant::now();
        // Both ends are samples: one sample more than intervals.
        let at = dissertation::DissertationSettings { planar_samples: resolution + 1, ..preset };
        let sum = dissertation::accept(&at, exec)?.sum();
        own.points.push(MethodPoint { resolution, sum, seconds: started.elapsed().as_secs_f64() });
    }
    let mut curves = vec![own];
    let mut finest = None;
    for method in Method::on_grids() {
        let mut curve = MethodCurve { name: method.name(), points: Vec::new() };
        for &resolution in &settings.resolutions {
            if method.name() == "descent" && resolution > settings.finest_descent {
                continue;
            }
            let decided =
                GridDecision::by(&method, &problem, resolution, exec).map_err(|error| failed(&error))?;
            let trial = decided.refinement(&problem, exec).map_err(|error| failed(&error))?;
            curve.points.push(MethodPoint { resolution, sum: trial.sum, seconds: trial.seconds });
            if method == Method::default() {
                finest = Some(decided);
            }
        }
        curves.push(curve);
    }
    let Some(finest) = finest else {
        return Err(RecipeError::Exact { reason: "no resolution was given".to_owned() });
    };
    let sample =
        correction::CorrectionSettings { seed: settings.seed, stop: Stop::Samples(settings.descents) };
    let exact = finest.correct(&problem, &sample, exec).map_err(|error| failed(&error))?;
    let settings = settings.clone();
    Ok(ResolutionFigure { settings, exact: exact.sum, exact_ci95: exact.ci95, rotation_length: RHO, curves })
}

impl ResolutionFigure {
    /// Every point as a record for programs, after a header record.
    pub fn records(&self) -> Vec<Vec<String>> {
        let mut records =
            vec![["method", "resolution", "sum", "seconds", "exact"].map(str::to_owned).to_vec()];
        for curve in &self.curves {
            for point in &curve.points {
                let mut record = vec![curve.name.to_owned(), point.resolution.to_string()];
                record.extend([point.sum, point.seconds, self.exact].map(|value| value.to_string()));
                records.push(record);
            }
        }
        records
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_methods_come_nearer() {
        let settings = ResolutionStudySettings {
            resolutions: vec![20, 40, 80],
            finest_descent: 80,
            descents: 2000,
            ..ResolutionStudySettings::default()
        };
        let result = run(&settings, &Exec::new()).unwrap();
        let last = |name: &str| result.curves.iter().find(|c| c.name == name).unwrap().points[2].sum;
        assert!((last("descent") / result.exact - 1.0).abs() < 0.03, "{result:?}");
        assert!(result.curves[0].points.iter().all(|p| p.sum > 0.2 && p.sum < 1.0), "{result:?}");
        assert_eq!(result.records().len(), 1 + 6 * 3);
    }
}
