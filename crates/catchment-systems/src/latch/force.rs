//! Force to latch, and force to break.
//!
//! ```text
//!   latch    F = F₀ + c·s·o·t³       fit to table 6.1, s = k / k of the tested sheet and neck
//!            θ = (o/2)/b   N = k·θ/√(a² + b²)   F = N·(cos φ + μ·sin φ)   per layer: the spring alone
//!   break    F = min( 213.6 N/mm · t , tip(o, t) )
//! ```
//!
//! Source: section 6.2. The spring alone gives less than half of the measured force, and t³ instead of the
//! measured t^1.5 to t^2.2: the data refute it, and it is reported beside the fit. The tip of the overhang is
//! known only at o = 2.5; there its force falls with t, because a stiff neck keeps the tip from turning into
//! the partner's trench.

use super::fit::{ForceFit, ForceLaw, latching, neck_line};
use super::measured::{Measured, Mode, table};
use super::{Geometry, LatchDesign, stiffness};
use serde::Serialize;

/// The tip's overhang, in mm, and how near another must be to be the same.
const TIP: (f64, f64) = (2.5, 0.05);
/// Necks and overhangs that were measured, in mm.
const MEASURED: ([f64; 2], [f64; 2]) = ([2.5, 5.1], [2.3, 4.6]);
/// Slack on them.
const SLACK: f64 = 0.05;
/// Every design with t ≤ o broke at the neck; every design with t ≥ 1.2·o at the tip.
const NECK_BELOW: f64 = 1.0;
/// See [`NECK_BELOW`].
const TIP_FROM: f64 = 1.2;

/// The fits that predictions rest on.
#[derive(Debug, Clone, PartialEq)]
pub struct Forces {
    /// Table 6.1.
    pub rows: Vec<Measured>,
    /// All laws of the force to latch, the law in use first.
    pub fits: Vec<ForceFit>,
    /// Force per thickness of neck of a design that breaks there, in N/mm, both layers.
    pub neck_line: f64,
}

/// A latching force with its derivation.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Latching {
    /// Force by the fit, in N, for a pair of both layers.
    pub force_n: f64,
    /// The force plus and minus one standard error of a new design, by leave-one-out, in N.
    pub interval_n: [f64; 2],
    /// Force of the spring alone, per layer: a lower bound without the constant.
    pub spring_n: f64,
    /// The normal force at the hook, per layer.
    pub normal_n: f64,
    /// Swing of each arm, in degrees.
    pub swing_deg: f64,
    /// Reasons why it is an extrapolation, if it is.
    pub doubts: Vec<String>,
}

/// A force to break with its failure mode.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Failure {
    /// Force in N; an upper bound if the tip may fail first.
    pub force_n: f64,
    /// Failure mode.
    pub mode: Mode,
    /// Whether the force is only an upper bound.
    pub upper_bound: bool,
    /// Reasons why it is an extrapolation, if it is.
    pub doubts: Vec<String>,
}

impl Forces {
    /// Fits everything to the table.
    ///
    /// # Errors
    /// Never: the table is part of the program.
    pub fn new() -> Result<Self, csv::Error> {
        let rows = table()?;
        let points = latching(&rows);
        let fits = ForceLaw::ALL.iter().map(|law| ForceFit::of(*law, &points)).collect();
        let neck_line = neck_line(&rows);
        Ok(Self { rows, fits, neck_line })
    }

    /// The fit in use.
    pub fn fit(&self) -> &ForceFit {
        &self.fits[0]
    }

    /// The force to latch a pair as tested, by o and t, in N.
    pub fn latching_at(&self, o: f64, t: f64) -> f64 {
        self.fit().at(o, t)
    }

    /// The force to latch a pair.
    pub fn latching(&self, latch: &LatchDesign, geometry: &Geometry) -> Latching {
        let tested = LatchDesign { neck: latch.neck, overhang: latch.overhang, ..LatchDesign::default() };
        let k = stiffness::torsional(latch);
        let scale = k / stiffness::torsional(&tested);
        let parameters = &self.fit().parameters;
        let (o, t) = (latch.overhang, latch.neck);
        let force_n = parameters[0] + parameters[1] * scale * o * t.powi(3);
        let spread = self.fit().left_out_rms.exp();
        let lever = geometry.lever();
        let swing = super::rules::swing(geometry);
        let normal_n = k * swing / lever.length();
        let (sin, cos) = geometry.profile.end.sin_cos();
        let mut doubts = outside(o, t);
        if (scale - 1.0).abs() > 1e-3 {
            doubts.push(format!(
                "the neck is {scale:.2} times as stiff as one of ABS, {} mm wide and {} mm long: the spring's share was scaled by it, the constant not",
                tested.sheet, tested.l_eq
            ));
        }
        if latch.layers == 1 {
            doubts.push("measured were pairs of two layers that latched one after the other".to_owned());
        }
        Latching {
            force_n,
            interval_n: [force_n / spread, force_n * spread],
            spring_n: normal_n * (cos + latch.press.friction * sin),
            normal_n,
            swing_deg: swing.to_degrees(),
            doubts,
        }
    }

    /// The prototype with a latch's overhang and neck, if one was measured.
    pub fn prototype(&self, latch: &LatchDesign) -> Option<&Measured> {
        let near = |a: f64, b: f64| (a - b).abs() <= SLACK;
        self.rows.iter().find(|row| near(row.overhang_mm, latch.overhang) && near(row.neck_mm, latch.neck))
    }

    /// The part that fails first, by o and t alone.
    pub fn mode(o: f64, t: f64) -> Mode {
        if t <= NECK_BELOW * o {
            Mode::Neck
        } else if t >= TIP_FROM * o {
            Mode::Tip
        } else {
            Mode::Undecided
        }
    }

    /// The force to break a pair as tested at its neck or at its tip, and whether it is only an upper bound.
    pub fn failure_at(&self, o: f64, t: f64) -> (f64, Mode, bool) {
        let neck = self.neck_line * t;
        match Self::mode(o, t) {
            Mode::Neck => (neck, Mode::Neck, false),
            Mode::Tip => match self.tip(o, t) {
                // The nearest to a tie broke at the tip with a little more than the neck's line has.
                Some(tip) => (tip.min(neck), Mode::Tip, false),
                None => (neck, Mode::Tip, true),
            },
            Mode::Undecided => (neck, Mode::Undecided, true),
        }
    }

    /// The force at which a tip yields: between the measured values at their overhang, unknown elsewhere.
    fn tip(&self, o: f64, t: f64) -> Option<f64> {
        let (overhang, near) = TIP;
        if (o - overhang).abs() > near {
            return None;
        }
        let tips: Vec<&Measured> = self.rows.iter().filter(|row| row.mode() == Mode::Tip).collect();
        let pair =
            tips.windows(2).find(|pair| (pair[0].neck_mm - SLACK..=pair[1].neck_mm + SLACK).contains(&t))?;
        let share = (t - pair[0].neck_mm) / (pair[1].neck_mm - pair[0].neck_mm);
        Some(pair[0].failure_force_n + share * (pair[1].failure_force_n - pair[0].failure_force_n))
    }

    /// The force to break a pair.
    pub fn failure(&self, latch: &LatchDesign) -> Failure {
        let (o, t) = (latch.overhang, latch.neck);
        let (as_tested, mode, upper_bound) = self.failure_at(o, t);
        let tested = LatchDesign::default();
        let section = latch.sheet * f64::from(latch.layers) / (tested.sheet * f64::from(tested.layers));
        let mut doubts = outside(o, t);
        if upper_bound {
            doubts.push(format!(
                "t/o is {:.2}: the tip of the overhang may give way first, and its strength is known at o = 2.5 mm only; the neck's is an upper bound",
                t / o
            ));
        }
        if (latch.modulus - tested.modulus).abs() > 1e-9 {
            doubts.push(
                "the strength is that of the tested ABS; another modulus means another material".to_owned(),
            );
        }
        if (section - 1.0).abs() > 1e-9 {
            doubts.push(format!(
                "scaled by the section of the necks, {section:.2} times the tested one, at the same stress"
            ));
        }
        Failure { force_n: as_tested * section, mode, upper_bound, doubts }
    }

    /// Mean stress in the necks when they break, in `MPa`.
    pub fn neck_stress(&self) -> f64 {
        let tested = LatchDesign::default();
        self.neck_line / (f64::from(tested.layers) * tested.sheet)
    }
}

/// Reasons why o and t are outside the measured range.
pub fn outside(o: f64, t: f64) -> Vec<String> {
    let ([o_least, o_most], [t_least, t_most]) = MEASURED;
    let mut doubts = Vec::new();
    if !(o_least - SLACK..=o_most + SLACK).contains(&o) {
        doubts.push(format!("an overhang of {o:.2} mm is outside the measured {o_least} to {o_most} mm"));
    }
    if !(t_least - SLACK..=t_most + SLACK).contains(&t) {
        doubts.push(format!("a neck of {t:.2} mm is outside the measured {t_least} to {t_most} mm"));
    }
    doubts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_measured_designs_break_as_they_did() {
        let forces = Forces::new().unwrap();
        for row in &forces.rows {
            let (force, mode, bound) = forces.failure_at(row.overhang_mm, row.neck_mm);
            assert_eq!((mode, bound), (row.mode(), false), "{row:?}");
            assert!((force / row.failure_force_n - 1.0).abs() < 0.04, "{row:?} {force}");
        }
        // Between neck and tip nothing was measured, and elsewhere the tip is not known.
        assert_eq!(forces.failure_at(2.5, 2.7).1, Mode::Undecided);
        let (force, mode, bound) = forces.failure_at(3.0, 4.6);
        assert!(mode == Mode::Tip && bound && (force - forces.neck_line * 4.6).abs() < 1e-9);
        assert_eq!(format!("{:.1}", forces.neck_stress()), "16.8");
    }

    /// Section 4 of the model: 3.6 N per layer with friction 0.3, while 16.36 and 9.61 N were measured.
    #[test]
    fn the_spring_alone_is_too_weak() {
        let latch = LatchDesign { overhang: 5.1, ..LatchDesign::default() };
        let forces = Forces::new().unwrap();
        let result = forces.latching(&latch, &Geometry::of(&latch).unwrap());
        assert_eq!(format!("{:.1}", result.spring_n), "3.6");
        assert_eq!(format!("{:.1}", 2.0 * result.spring_n), "7.2");
        assert_eq!(format!("{:.1}", result.force_n), "13.4");
        assert!((result.interval_n[1] / result.force_n - 1.208).abs() < 1e-3 && result.doubts.is_empty());
        // The three-sided part is softer: 28 % less than the fit.
        let less = 1.0 - super::super::measured::THREE_SIDED_LATCHING / result.force_n;
        assert_eq!(format!("{less:.2}"), "0.28");
    }

    #[test]
    fn other_sheets_scale_the_spring_and_are_called_an_extrapolation() {
        let forces = Forces::new().unwrap();
        let force = |latch: &LatchDesign| forces.latching(latch, &Geometry::of(latch).unwrap());
        let usual = force(&LatchDesign::default());
        let twice = force(&LatchDesign { modulus: 4200.0, ..LatchDesign::default() });
        let constant = forces.fit().parameters[0];
        assert!((twice.force_n - constant - 2.0 * (usual.force_n - constant)).abs() < 1e-9);
        assert_eq!(twice.doubts.len(), 1);
        let thin = forces.failure(&LatchDesign { layers: 1, ..LatchDesign::default() });
        assert!((thin.force_n - 0.5 * forces.neck_line * 3.0).abs() < 1e-9 && thin.doubts.len() == 1);
    }
}
