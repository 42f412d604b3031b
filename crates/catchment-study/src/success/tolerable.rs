//! Largest factor on all errors, or on a single error, with the required success.
//!
//! ```text
//!   P ▲──╲_                    P(t): every σ multiplied by t; the same sampled errors at every t
//!     │    ╲ ┬                 tested factors: powers of √2 until P and its interval have crossed the required R,
//!   R ┼─ ─ ─┼●┼─ ─             then bisection between the two factors around it
//!     │       ┴╲_              ● the factor; its interval: the crossings of the ends of the interval of P with R
//!     └──────────────▶ t
//! ```
//!
//! The crossing is the first from below: with every smaller tried factor the success is at least the
//! required success. Between the two last tried factors around it, some percent apart, log t is interpolated linearly in
//! P; the ends of the interval are tried factors.

use super::estimate::{Sample, sample};
use super::source::Source;
use super::strata::Strata;
use super::{AtFactor, Factor};
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::problem::Problem;
use std::f64::consts::SQRT_2;

/// Steps of √2 down and up from 1 that are tried at most: from 1/16 to 4.
const DOWN: i32 = 8;
const UP: i32 = 4;
/// Number of bisections between two factors around the crossing, of the probability and of both ends of its
/// interval: √2 apart at first, then 4 % and 9 %.
const HALVINGS: [usize; 3] = [3, 2, 2];

/// The probability at some factors, in ascending order, and how many motions that took.
pub(super) struct Curve<'a> {
    problem: &'a Problem,
    source: &'a Source<'a>,
    strata: &'a Strata,
    motions: usize,
    /// Which factors change.
    changed: [bool; 5],
    points: Vec<AtFactor>,
    followed: usize,
}

impl<'a> Curve<'a> {
    pub(super) fn new(
        problem: &'a Problem,
        source: &'a Source<'a>,
        strata: &'a Strata,
        motions: usize,
        changed: [bool; 5],
    ) -> Self {
        Self { problem, source, strata, motions, changed, points: Vec::new(), followed: 0 }
    }

    pub(super) const fn followed(&self) -> usize {
        self.followed
    }

    pub(super) fn points(&self) -> &[AtFactor] {
        &self.points
    }

    /// Adopts the known result for the errors as given.
    pub(super) fn know(&mut self, found: &Sample) {
        self.put(1.0, found);
    }

    fn put(&mut self, factor: f64, found: &Sample) {
        let place = self.points.partition_point(|point| point.factor < factor);
        let point = AtFactor { factor, probability: found.probability, ci95: found.ci95 };
        self.points.insert(place, point);
    }

    /// Evaluates a factor, unless it is known.
    pub(super) fn look(&mut self, factor: f64, exec: &Exec) -> Result<AtFactor, Cancelled> {
        if let Some(known) = self.points.iter().find(|point| point.factor == factor) {
            return Ok(*known);
        }
        let factors = self.changed.map(|changed| if changed { factor } else { 1.0 });
        let found = sample(self.problem, self.source, &factors, self.strata, self.motions, exec)?;
        self.followed += found.motions;
        self.put(factor, &found);
        Ok(AtFactor { factor, probability: found.probability, ci95: found.ci95 })
    }

    /// The largest factor with which the success is at least `required`, and its interval.
    pub(super) fn factor(&mut self, required: f64, exec: &Exec) -> Result<Factor, Cancelled> {
        let one = self.look(1.0, exec)?;
        // Down until even the lower end is high enough, up until even the upper end is too low.
        let mut lowest = one;
        for k in 1..=DOWN {
            // A success rate of 1 does not rise with smaller errors.
            if lowest.ci95[0] >= required || lowest.probability >= 1.0 {
                break;
            }
            lowest = self.look(step(-k), exec)?;
        }
        let mut highest = one;
        for k in 1..=UP {
            if highest.ci95[1] < required {
                break;
            }
            highest = self.look(step(k), exec)?;
        }
        let values: [fn(&AtFactor) -> f64; 3] =
            [|point| point.probability, |point| point.ci95[0], |point| point.ci95[1]];
        for (value, halvings) in values.into_iter().zip(HALVINGS) {
            for _ in 0..halvings {
                if let Some([before, after]) = bracket(&self.points, required, value) {
                    self.look((before.factor * after.factor).sqrt(), exec)?;
                }
            }
        }
        let [middle, low, high] = values;
        let factor = crossing(&self.points, required, middle);
        // The ends are tested factors outside the interval, so that no interpolation of P is needed.
        let surely = bracket(&self.points, required, low).map(|[before, _]| before.factor);
        let at_most = bracket(&self.points, required, high).map(|[_, after]| after.factor);
        let beyond = |value| crossing(&self.points, required, value).value(&self.points);
        Ok(Factor {
            factor: factor.value(&self.points),
            ci95: [surely.unwrap_or_else(|| beyond(low)), at_most.unwrap_or_else(|| beyond(high))],
            is_more: factor == Crossing::Beyond,
            is_less: factor == Crossing::Never,
        })
    }
}

/// √2 to a power; even powers exactly.
fn step(power: i32) -> f64 {
    let whole = 2f64.powi(power.div_euclid(2));
    if power.rem_euclid(2) == 1 { whole * SQRT_2 } else { whole }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Crossing {
    At(f64),
    /// Even the largest factor that was tried is not too large.
    Beyond,
    /// It is missed even at the smallest factor.
    Never,
}

impl Crossing {
    fn value(self, points: &[AtFactor]) -> f64 {
        match self {
            Self::At(factor) => factor,
            Self::Beyond => points.last().map_or(0.0, |point| point.factor),
            Self::Never => 0.0,
        }
    }
}

/// The two factors between which a value first falls below the required value.
fn bracket(points: &[AtFactor], required: f64, value: fn(&AtFactor) -> f64) -> Option<[AtFactor; 2]> {
    let after = points.iter().position(|point| value(point) < required)?;
    Some([*points.get(after.checked_sub(1)?)?, points[after]])
}

/// The factor at which a value first falls below the required value.
fn crossing(points: &[AtFactor], required: f64, value: impl Fn(&AtFactor) -> f64) -> Crossing {
    let Some(k) = points.iter().position(|point| value(point) < required) else { return Crossing::Beyond };
    if k == 0 {
        return Crossing::Never;
    }
    let (before, after) = (&points[k - 1], &points[k]);
    let (high, low) = (value(before), value(after));
    let part = (high - required) / (high - low);
    Crossing::At(before.factor * libm::pow(after.factor / before.factor, part))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(factor: f64, probability: f64) -> AtFactor {
        AtFactor { factor, probability, ci95: [probability - 0.02, probability + 0.02] }
    }

    #[test]
    fn the_first_crossing_counts() {
        let points = [point(0.5, 1.0), point(1.0, 0.96), point(2.0, 0.8), point(4.0, 0.95)];
        let at = |required: f64| crossing(&points, required, |point| point.probability);
        // Half of the way from 0.96 to 0.8 is √2 times 1.
        let Crossing::At(factor) = at(0.88) else { panic!() };
        assert!((factor - 2f64.sqrt()).abs() < 1e-12);
        assert_eq!(at(0.7), Crossing::Beyond);
        let low = [point(0.5, 0.6)];
        assert_eq!(crossing(&low, 0.7, |point| point.probability), Crossing::Never);
        let Crossing::At(factor) = at(1.0) else { panic!() };
        assert_eq!(factor, 0.5);
    }
}
