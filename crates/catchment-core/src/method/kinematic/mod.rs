//! The dissertation's planar kinematic method (chapter 3): closed bounds for the V-Face and the S-Face, in
//! the form of its printed tables, and for the X-Face a stepping by its single contact.
//!
//! ```text
//!         ● rotation point, r_p half-widths behind mid height
//!         │ ╲θ₀         tip lever  L = (r_p·D + H)/2
//!         │  ╲          the tip starts at  x₀ + L·sin θ₀
//!      ───┼───▼tip      and must meet the face it will slide down:
//!      ╲  ┊  ╱          V: |x₀ + L sin θ₀| < D/2
//!       ╲ ┊ ╱           S: |x₀ + L sin θ₀ + (D/6)(cos θ₀ − 1)| < D/3
//!        ╲ ╱            X: see [`stepping`]
//! ```
//!
//! V and S also need |θ₀| below a right angle less the slope of the outer edge (V: 2H/D, S: 3H/(2D)) and
//! `|x₀| < r_p·D + H/2`. All bounds are strict; D = 1.
//!
//! The starts of the tables are `x₀ = (i − 20)·D/20`, i = 0…40, and θ₀ = j·π/80, j = 0…40: 41 values on [0,
//! π/2]. Each counts (2/40)(π/40) all the same, so that the one-sided count represents ±π/2. Starts are
//! indexed by integers, because accumulated floating-point steps would break ties.
//!
//! The bounds reproduce the printed tables 3.3 and 3.4 in every entry, and depart from a literal reading of
//! the text in three points: the range of θ₀, half dimensions in the lever and in the limit on |x₀|, and the
//! outer edge's angle for S. The tables do not determine the coefficient of `r_p` in that limit: it binds
//! only at `r_p` = 0. Table 3.2, of the X-Face, does not follow from its text; the stepping is provided
//! beside it and does not reproduce it.
//!
//! **As a method** ([`accept`]) it decides pose errors of a planar family: θ₀ = −pitch, x₀ the position of
//! the rotation point, `x₀ = x − cor·sin pitch`, and `r_p = −2·cor`: a rotation point `r_p` half-widths
//! behind mid height is a COR of −`r_p`/2. An accepted pose docks; beyond the limit on |x₀|, or without
//! contact, it misses; all others jam.
//!
//! Not promised: that a start within the bounds succeeds (they are the best case), or that the rotation point
//! keeps its x in a real docking, as it does here. For free motion see [`crate::method::descent`].

pub(super) mod entry;
mod lever;
pub mod stepping;

pub use lever::{Lever, LeverBody, LeverPose};

use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::design::{ConnectorSpec, Design, Docked, Family};
use crate::diagnostic::{Advice, Diagnostic};
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::landscape::Grid;
use crate::pose::{Dof, DofSet, Mount};
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};
use stepping::{Faces, Halt};

/// A planar face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum PlanarFace {
    /// V notch and tip.
    VFace,
    /// Sawtooth of three edges.
    SFace,
    /// Two crossed ramps in two layers.
    XFace,
}

/// The parameters that determine the result; lengths in D.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct KinematicSettings {
    /// The planar face.
    pub face: PlanarFace,
    /// H/D, H from the lowest to the highest point of the face.
    pub aspect_ratio: f64,
    /// Distance of the rotation point behind mid height, in half-widths.
    pub rotation_point: f64,
}

/// Steps of x₀ over ±D, and of θ₀ over [0, π/2].
const STEPS: i32 = 40;

/// Area represented by a successful start, D·rad.
pub const START_MEASURE: f64 = (2.0 / STEPS as f64) * (PI / STEPS as f64);

/// Why the method cannot decide a design.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum UnsuitableDesign {
    /// Another connector.
    #[error("it knows the faces v-face, s-face and x-face alone")]
    Face,
    /// Other errors.
    #[error("x and pitch must be free, and nothing else")]
    Free,
    /// Material behind the face.
    #[error("its faces have no base_thickness")]
    Base,
    /// The rotation point is in front.
    #[error("its rotation point lies at or behind mid height: center_of_rotation must not be above 0")]
    RotationPoint,
    /// Mounted the other way.
    #[error("its halves are mounted about y")]
    Mount,
    /// An error out of the plane.
    #[error("a pose has x and pitch alone: it knows no other error")]
    Pose,
    /// Docked is another set than the mated pose alone.
    #[error("its faces dock in one point: [docked] must leave depth as it is")]
    Docked,
}

/// Why there is no acceptance.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum KinematicError {
    /// The design is not one of the method's families.
    #[error(transparent)]
    Unfit(#[from] UnsuitableDesign),
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl KinematicSettings {
    /// The settings that stand for a design.
    ///
    /// # Errors
    /// See [`UnsuitableDesign`].
    pub fn of(design: &Design) -> Result<Self, UnsuitableDesign> {
        let ConnectorSpec::Family(spec) = &design.connector else { return Err(UnsuitableDesign::Face) };
        let face = match spec.family() {
            Family::VFace => PlanarFace::VFace,
            Family::SFace => PlanarFace::SFace,
            Family::XFace => PlanarFace::XFace,
            _ => return Err(UnsuitableDesign::Face),
        };
        let alignment = &design.alignment;
        if alignment.free != DofSet::EMPTY.with(Dof::X).with(Dof::Pitch) {
            return Err(UnsuitableDesign::Free);
        }
        if spec.base_thickness().is_some_and(|base| base > 0.0) {
            return Err(UnsuitableDesign::Base);
        }
        if alignment.center_of_rotation > 0.0 {
            return Err(UnsuitableDesign::RotationPoint);
        }
        if alignment.mount != Mount::Y {
            return Err(UnsuitableDesign::Mount);
        }
        // Limits change nothing: these seats have no play.
        if alignment.docked.depth.to_bits() != Docked::DEFAULT_DEPTH.to_bits() {
            return Err(UnsuitableDesign::Docked);
        }
        let rotation_point = -2.0 * alignment.center_of_rotation;
        Ok(Self { face, aspect_ratio: spec.aspect_ratio(), rotation_point })
    }

    /// Whether the start (x₀ in D, θ₀ in radians) slides home.
    pub fn succeeds(&self, x0: f64, theta0: f64) -> bool {
        self.starts().outcome(x0, theta0) == Outcome::Aligned
    }

    /// The decision for starts.
    fn starts(&self) -> Starts<'_> {
        let faces =
            (self.face == PlanarFace::XFace).then(|| Faces::new(self.aspect_ratio, self.rotation_point));
        Starts { settings: self, faces }
    }

    /// Number of successful starts of the tables' 41 × 41.
    pub fn successes(&self) -> u32 {
        let starts = self.starts();
        let succeeds = |(i, j): (i32, i32)| {
            let x0 = f64::from(i - STEPS / 2) / f64::from(STEPS / 2);
            starts.outcome(x0, f64::from(j) * PI / f64::from(2 * STEPS)) == Outcome::Aligned
        };
        (0..=STEPS).flat_map(|i| (0..=STEPS).map(move |j| (i, j))).filter(|start| succeeds(*start)).count()
            as u32
    }

    /// The area of acceptance as the tables have it, D·rad.
    pub fn area(&self) -> f64 {
        f64::from(self.successes()) * START_MEASURE
    }
}

/// Starts of a pair of faces.
struct Starts<'a> {
    settings: &'a KinematicSettings,
    /// Of an X-Face.
    faces: Option<Faces>,
}

impl Starts<'_> {
    fn outcome(&self, x0: f64, theta0: f64) -> Outcome {
        let KinematicSettings { face, aspect_ratio: h, rotation_point } = *self.settings;
        if let Some(faces) = &self.faces {
            return match faces.follow(x0, theta0, stepping::STEP) {
                Halt::Success => Outcome::Aligned,
                Halt::Missed => Outcome::Missed,
                Halt::Beside | Halt::Away | Halt::Bound | Halt::AtRest => Outcome::Jammed,
            };
        }
        let lever = f64::midpoint(rotation_point, h);
        let tip = x0 + lever * theta0.sin();
        let (tip, reach, outer_slope) = match face {
            // The base minimum that the tip must find sits D/6 off the axis, and swings with the body.
            PlanarFace::SFace => (tip + (theta0.cos() - 1.0) / 6.0, 1.0 / 3.0, 1.5 * h),
            PlanarFace::VFace | PlanarFace::XFace => (tip, 0.5, 2.0 * h),
        };
        if x0.abs() >= rotation_point + h / 2.0 {
            Outcome::Missed
        } else if tip.abs() < reach && theta0.abs() < FRAC_PI_2 - outer_slope.atan() {
            Outcome::Aligned
        } else {
            Outcome::Jammed
        }
    }
}

/// Decides the cells of an error grid over x and pitch.
///
/// # Errors
/// A design that it does not apply to, a grid that does not fit into memory, a cancelled run.
pub fn accept(design: &Design, grid: &Grid, exec: &Exec) -> Result<Acceptance, KinematicError> {
    let settings = KinematicSettings::of(design)?;
    let cells = grid.checked_len().map_or(u64::MAX, |cells| cells as u64);
    exec.ensure_fits("the outcome of every cell", cells, |_| vec![Advice::CoarserGrid])?;
    let (starts, cor) = (settings.starts(), design.alignment.center_of_rotation);
    let outcome = |cell: usize| {
        let error = grid.pose(cell);
        starts.outcome(error.x - cor * error.pitch.sin(), -error.pitch)
    };
    let outcomes = exec.map(grid.len(), outcome)?;
    let text = match settings.face {
        PlanarFace::VFace | PlanarFace::SFace => {
            "the kinematic bounds are the best case: outside them a start fails, inside it may"
        }
        PlanarFace::XFace => {
            "the kinematic stepping knows one contact at a time, both halves pivot, and their x is kept"
        }
    };
    let warnings = vec![Diagnostic::warning("kinematic-bounds", text)];
    Ok(Acceptance { method: "kinematic", domain: Domain::Grid(grid.clone()), outcomes, warnings })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Alignment, FamilySpec};

    #[test]
    fn without_rotation_the_bounds_are_nilssons() {
        for (face, bound) in [(PlanarFace::VFace, 0.5), (PlanarFace::SFace, 1.0 / 3.0)] {
            let settings = KinematicSettings { face, aspect_ratio: 0.5, rotation_point: 1.0 };
            for side in [-1.0, 1.0] {
                assert!(settings.succeeds(side * (bound - 1e-9), 0.0));
                assert!(!settings.succeeds(side * (bound + 1e-9), 0.0));
            }
        }
    }

    #[test]
    fn the_bound_itself_fails() {
        let settings = KinematicSettings { face: PlanarFace::VFace, aspect_ratio: 0.5, rotation_point: 1.0 };
        assert!(!settings.succeeds(0.5, 0.0));
    }

    #[test]
    fn a_centred_tip_slides_home_up_to_the_outer_edge() {
        for (face, slope) in [(PlanarFace::VFace, 2.0), (PlanarFace::SFace, 1.5)] {
            for h in [0.1, 0.5, 2.0] {
                let settings = KinematicSettings { face, aspect_ratio: h, rotation_point: 2.0 };
                let limit = FRAC_PI_2 - f64::atan(slope * h);
                let centred = |theta: f64| {
                    let swing = if face == PlanarFace::SFace { (theta.cos() - 1.0) / 6.0 } else { 0.0 };
                    settings.succeeds(-(2.0 + h) / 2.0 * theta.sin() - swing, theta)
                };
                assert!(centred(limit - 1e-9) && !centred(limit + 1e-9));
            }
        }
    }

    #[test]
    fn the_s_face_is_chiral_and_the_v_face_is_not() {
        // Centre of the tips that slide home at θ₀ = 1: 0 for V, moved by the swing of the minimum for S.
        let settings = |face| KinematicSettings { face, aspect_ratio: 0.2, rotation_point: 2.0 };
        let lever = 1.1;
        let theta: f64 = 1.0;
        let edges = |face| {
            let reaches = |x: f64| settings(face).succeeds(x - lever * theta.sin(), theta);
            let grid = (-5000..=5000).map(|k| f64::from(k) * 1e-4);
            let hits: Vec<f64> = grid.filter(|x| reaches(*x)).collect();
            hits[0] + hits[hits.len() - 1]
        };
        assert!(edges(PlanarFace::VFace).abs() < 1e-3);
        // Twice (D/6)(1 − cos θ), to the grid's step.
        assert!((edges(PlanarFace::SFace) - (1.0 - theta.cos()) / 3.0).abs() < 3e-4);
    }

    fn design(family: Family, cor: f64) -> Design {
        let alignment = Alignment { center_of_rotation: cor, ..Alignment::default_for(Some(family)) };
        let connector = ConnectorSpec::Family(FamilySpec::new(family).with_aspect_ratio(0.5));
        Design { name: String::new(), connector, width: 1.0, unit: None, alignment }
    }

    #[test]
    fn a_design_is_decided_about_its_own_rotation_point() {
        // The tip of a V whose rotation point lies a width behind mid height (r_p = 2): in D and radians of our frame it
        // is at x − (H/2)·sin(pitch)·(−1): at the face centre plus half the height along the tilted axis.
        let design = design(Family::VFace, -1.0);
        let settings = KinematicSettings::of(&design).unwrap();
        assert_eq!((settings.face, settings.rotation_point), (PlanarFace::VFace, 2.0));
        let grid = Grid::over(&design.alignment, |_| 60);
        let result = accept(&design, &grid, &Exec::new()).unwrap();
        for (cell, outcome) in result.outcomes.iter().enumerate() {
            let e = grid.pose(cell);
            let tip = e.x - 0.25 * e.pitch.sin();
            let rotation_point = e.x + e.pitch.sin();
            let accepted =
                tip.abs() < 0.5 && e.pitch.abs() < FRAC_PI_2 - 1f64.atan() && rotation_point.abs() < 2.25;
            assert_eq!(*outcome == Outcome::Aligned, accepted, "{e:?}");
        }
    }

    #[test]
    fn threads_change_no_outcome_and_unsuitable_designs_are_refused() {
        let x_face = design(Family::XFace, -0.5);
        let grid = Grid::over(&x_face.alignment, |_| 20);
        let with = |threads| accept(&x_face, &grid, &Exec::new().with_threads(threads).unwrap()).unwrap();
        assert_eq!(with(1), with(2));
        let counts = with(1).counts();
        assert!(counts[0] > 20 && counts[1] > 20 && counts[2] > 20, "{counts:?}");
        assert_eq!(KinematicSettings::of(&design(Family::Pyramid, 0.0)), Err(UnsuitableDesign::Face));
        assert_eq!(KinematicSettings::of(&design(Family::XFace, 0.5)), Err(UnsuitableDesign::RotationPoint));
        let mut other = design(Family::SFace, 0.0);
        other.alignment.free = DofSet::ALL;
        assert_eq!(KinematicSettings::of(&other), Err(UnsuitableDesign::Free));
        let mut deep = design(Family::SFace, 0.0);
        deep.alignment.docked.depth = 0.1;
        assert_eq!(KinematicSettings::of(&deep), Err(UnsuitableDesign::Docked));
    }

    /// A sample of the whole set of the tables (11 × 11 designs, 41 × 41 starts), spread by a low-discrepancy sequence.
    #[test]
    fn half_the_step_changes_hardly_any_outcome() {
        const SAMPLE: u32 = 4000;
        let spread = |k: u32, prime: f64| (f64::from(k) * prime.sqrt()).fract();
        let different = (0..SAMPLE)
            .filter(|k| {
                let pick = |prime: f64, n: f64| (spread(*k, prime) * n).floor();
                let faces = Faces::new((0.8 * pick(2.0, 11.0) - 4.0).exp2(), pick(3.0, 11.0));
                let (x0, theta) = ((pick(5.0, 41.0) - 20.0) / 20.0, pick(7.0, 41.0) * PI / 80.0);
                let success = |step| faces.follow(x0, theta, step) == Halt::Success;
                success(stepping::STEP) != success(0.5 * stepping::STEP)
            })
            .count();
        assert!(different * 100 < SAMPLE as usize, "{different} of {SAMPLE}");
    }
}
