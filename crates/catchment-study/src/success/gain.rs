//! Effect of an improvement of a single error: the slope of the probability by its σ, and the probability with
//! that σ halved.
//!
//! ```text
//!   normal     dP/dσₖ = E[(1_docks − P)·sₖ]              the score of the density: the same motions
//!   uniform    dP/dhₖ = (Pₖ − P)/hₖ                      Pₖ the success on both faces of the box across this error
//!   measured   no slope: a table has no density
//!
//!   gain       P(σₖ/2) − P                               new motions, the same random errors
//! ```

use super::estimate::{Sample, alone, as_expected, sample};
use super::source::Source;
use super::strata::Strata;
use super::{Improvement, Slope};
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::problem::Problem;

/// Factor of the improvement.
const HALF: f64 = 0.5;

/// Effect of an improvement of each error, largest effect first; and the number of motions.
pub(super) fn gains(
    problem: &Problem,
    source: &Source<'_>,
    strata: &Strata,
    found: &Sample,
    motions: usize,
    exec: &Exec,
) -> Result<(Vec<Improvement>, usize), Cancelled> {
    let axes: Vec<_> = source.varying().collect();
    let mut slopes = found.slopes(source, exec)?;
    let mut followed = 0;
    if source.is_uniform() {
        for axis in &axes {
            let faces = as_expected(problem, &source.on_face(*axis), strata, motions, exec)?;
            followed += faces.motions;
            let width = source.scale(*axis);
            let [lo, hi] = difference((faces.probability, faces.ci95), (found.probability, found.ci95));
            slopes.push(Slope {
                axis: *axis,
                value: (faces.probability - found.probability) / width,
                ci95: [lo / width, hi / width],
            });
        }
    }
    let mut improvements = Vec::new();
    for (k, axis) in axes.iter().enumerate() {
        let part = exec.part(
            [k as f64 / axes.len() as f64, (k + 1) as f64 / axes.len() as f64],
            "errors that are halved",
        );
        let halved = sample(problem, source, &alone(*axis, HALF), strata, motions, &part)?;
        followed += halved.motions;
        let slope = slopes.iter().find(|slope| slope.axis == *axis);
        improvements.push(Improvement {
            axis: *axis,
            sigma: source.sigma(*axis),
            slope: slope.map(|slope| slope.value),
            slope_ci95: slope.map(|slope| slope.ci95),
            halved: halved.probability,
            halved_ci95: halved.ci95,
            gain: halved.probability - found.probability,
            gain_ci95: difference((halved.probability, halved.ci95), (found.probability, found.ci95)),
        });
    }
    // A stable sort: equal gains stay in the order of the errors.
    improvements.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    Ok((improvements, followed))
}

/// The interval of the difference of two probabilities (Zou and Donner, Stat. Med. 27 (2008) 1693), as if
/// independent.
fn difference((a, [a_lo, a_hi]): (f64, [f64; 2]), (b, [b_lo, b_hi]): (f64, [f64; 2])) -> [f64; 2] {
    [a - b - (a - a_lo).hypot(b_hi - b), a - b + (a_hi - a).hypot(b - b_lo)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_difference_is_that_of_both() {
        let [lo, hi] = difference((0.9, [0.87, 0.92]), (0.8, [0.79, 0.84]));
        assert!((lo - (0.1 - 0.05)).abs() < 1e-12 && (hi - (0.1 + 0.02f64.hypot(0.01))).abs() < 1e-12);
    }
}
