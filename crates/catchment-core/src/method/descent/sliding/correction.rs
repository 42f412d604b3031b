//! Correction back to contact, by Newton's method.
//!
//! ```text
//!   δ = argmin |δ|²    subject to   aᵢ·δ  = −gᵢ   for contacts that are kept
//!                                   aᵢ·δ ≥ −gᵢ   for the other active contacts
//! ```
//!
//! with gaps g and rows a of the features treated as planes and lines without borders. Convergence is
//! quadratic: a step of 0.02 D leaves gaps of about 1e-5 D, the third iteration about 1e-13.

use super::super::motion::{Motion, State};
use super::super::projection::MAX_COORDINATES;

/// Gaps below this are 0, in D: rounding of a product of numbers near 1.
const EXACT: f64 = 1e-13;
/// Most passes: those above, and two for contacts that bend sharply.
const PASSES: usize = 5;
/// Largest residual after the last iteration, in D: well below a landing.
const GOOD: f64 = 1e-10;

impl Motion<'_> {
    /// `state` moved by at most `farthest` (ρ-metric and z combined) so that the active contacts number
    /// `held` touch and the others do not overlap; `None` if that is not possible.
    pub(super) fn corrected(&mut self, state: &State, held: &[usize], farthest: f64) -> Option<State> {
        let mut state = *state;
        let mut moved = 0.0;
        for _ in 0..PASSES {
            let worst = self.linearise(&state, held);
            if worst <= EXACT {
                return Some(state);
            }
            let gaps = self.sliding.gaps.iter().copied();
            let still = [0.0; MAX_COORDINATES];
            let delta = self.projection.closest_allowed(&still, &self.sliding.rows, gaps, worst)?;
            moved += delta.iter().map(|x| x * x).sum::<f64>().sqrt();
            if moved > farthest {
                return None;
            }
            state = self.moved(&state, &delta);
        }
        (self.linearise(&state, held) <= GOOD).then_some(state)
    }

    /// Rows and gaps of the active contacts at `state`, those held both ways; returns the largest gap that must close or
    /// open.
    fn linearise(&mut self, state: &State, held: &[usize]) -> f64 {
        let axes = self.axes(state);
        let mut rows = std::mem::take(&mut self.sliding.rows);
        let mut gaps = std::mem::take(&mut self.sliding.gaps);
        rows.clear();
        gaps.clear();
        let mut worst = 0.0f64;
        for (k, (before, meeting)) in self.contacts.iter().enumerate() {
            let contact = self.pair.contact(before, meeting, &state.rotation, state.cor);
            let row = self.row(&contact, state, &axes);
            worst = worst.max(-contact.gap);
            rows.push(row);
            gaps.push(contact.gap);
            if held.contains(&k) {
                worst = worst.max(contact.gap);
                rows.push(row.map(|x| -x));
                gaps.push(-contact.gap);
            }
        }
        (self.sliding.rows, self.sliding.gaps) = (rows, gaps);
        worst
    }
}
