//! Back to touching, by Newton's method.
//!
//! ```text
//!   δ = argmin |δ|²    subject to   aᵢ·δ  = −gᵢ   for contacts that are held
//!                                   aᵢ·δ ≥ −gᵢ   for the other active ones
//! ```
//!
//! with gaps g and rows a of the features seen as planes and lines without borders. Quadratic: a step of 0.02 D leaves
//! gaps of some 1e-5 D, the third pass some 1e-13.

use super::super::motion::{Motion, State};

/// Gaps below this are 0, in D: rounding of a product of numbers near 1.
const EXACT: f64 = 1e-13;
/// Most passes: see above, and one more.
const PASSES: usize = 5;
/// What is left after the last pass may be as large as this, in D: below a landing.
const GOOD: f64 = 1e-10;

impl Motion<'_> {
    /// `state` moved by at most `farthest` (ρ-metric and z together) so that the active contacts number `held` touch and
    /// the others do not overlap; `None` where that is not possible.
    pub(super) fn corrected(&mut self, state: &State, held: &[usize], farthest: f64) -> Option<State> {
        let mut state = *state;
        let mut moved = 0.0;
        let mut sliding = self.sliding.take()?;
        let mut worst = f64::INFINITY;
        for pass in 0..=PASSES {
            let axes = self.axes(&state);
            sliding.rows.clear();
            sliding.gaps.clear();
            worst = 0.0;
            for (k, (before, meeting)) in self.contacts.iter().enumerate() {
                let contact = self.pair.contact(before, meeting, &state.rotation, state.cor);
                let row = self.row(&contact, &state, &axes);
                worst = f64::max(worst, -contact.gap);
                sliding.rows.push(row);
                sliding.gaps.push(contact.gap);
                if held.contains(&k) {
                    worst = worst.max(contact.gap);
                    sliding.rows.push(row.map(|x| -x));
                    sliding.gaps.push(-contact.gap);
                }
            }
            if std::env::var("DBG").is_ok() && held.len() > 0 {
                eprintln!("         pass {pass} worst {worst:.3e} moved {moved:.3e}");
            }
            if worst <= EXACT || pass == PASSES {
                break;
            }
            let gaps = sliding.gaps.iter().copied();
            let Some(delta) = self.projection.closest_allowed(&[0.0; 6], &sliding.rows, gaps, worst) else {
                worst = f64::INFINITY;
                break;
            };
            moved += delta.iter().map(|x| x * x).sum::<f64>().sqrt();
            if moved > farthest {
                worst = f64::INFINITY;
                break;
            }
            state = self.moved(&state, &delta);
        }
        self.sliding = Some(sliding);
        (worst <= GOOD).then_some(state)
    }
}
