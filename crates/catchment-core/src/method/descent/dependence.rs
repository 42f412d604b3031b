//! Test whether outcomes depend on the step: sampled poses are followed twice, with the step and with half of
//! it.
//!
//! ```text
//!   share = changed / of          with Wilson's 95 % interval
//! ```
//!
//! Used for tight fits ([`Pair::is_tight`]); in other pairs small errors of the motion decay.
//!
//! Not detected: errors that both steps share.

use super::{DescentSettings, run};
use crate::acceptance::Domain;
use crate::contact::Pair;
use crate::diagnostic::Warning;
use crate::exec::{Cancelled, Exec};
use crate::method::correction::wilson95;
use crate::method::{affordable, motions_in};

/// Number of poses for simple halves: a single change is 0.3 %, the interval without a change ends at 1.3 %.
/// A second or less.
const SIMPLE: f64 = 300.0;
/// Number of poses for other halves: the interval without a change ends at 4 %; fewer if they would take
/// longer than this on one core, in seconds.
const LEAST: usize = 100;
const LONGEST: f64 = 8.0;

/// The warning that outcomes of a tight pair depend on the step, if any of the poses drawn by `seed` has
/// another outcome at half the step; `None` if none has, or if the fit is not tight.
///
/// # Errors
/// [`Cancelled`] if a stop is requested.
pub fn step_dependence(
    pair: &Pair,
    settings: &DescentSettings,
    seed: u64,
    exec: &Exec,
) -> Result<Option<Warning>, Cancelled> {
    if !pair.is_tight() {
        return Ok(None);
    }
    let of = ((SIMPLE * affordable(pair)) as usize).max(LEAST.min(motions_in(LONGEST, pair)));
    let poses = || Domain::random(&pair.alignment, of, seed);
    let half = DescentSettings {
        step: settings.step / 2.0,
        max_steps: settings.max_steps.saturating_mul(2),
        ..*settings
    };
    let (whole, _) = run(pair, poses(), settings, exec)?;
    let (halved, _) = run(pair, poses(), &half, exec)?;
    let changed = whole.outcomes.iter().zip(&halved.outcomes).filter(|(a, b)| a != b).count();
    let ci95 = wilson95(changed as f64 / of as f64, of as f64);
    Ok((changed > 0).then_some(Warning::StepDependence { changed, of, ci95 }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Connector;
    use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};

    fn pair(family: Family) -> Pair {
        let alignment = Alignment::default_for(Some(family));
        let connector = ConnectorSpec::Family(FamilySpec::new(family));
        let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
        Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
    }

    #[test]
    fn nothing_is_followed_where_nothing_is_tight() {
        // Steps of the size of the halves would change something.
        let coarse = DescentSettings { step: 1.0, ..DescentSettings::default() };
        let none = step_dependence(&pair(Family::Pyramid), &coarse, 1, &Exec::new());
        assert_eq!(none, Ok(None));
    }

    #[test]
    fn a_dependence_is_reported_with_its_interval() {
        // A limit on steps that suffices for some motion, but not at half the step length.
        let pair = pair(Family::XFace3dLocking);
        let short = |max_steps: usize| DescentSettings { max_steps, ..DescentSettings::default() };
        let warning = (4..16).find_map(|most| step_dependence(&pair, &short(most), 1, &Exec::new()).unwrap());
        let Some(Warning::StepDependence { changed, of, ci95 }) = warning else {
            panic!("some motion must need more")
        };
        let share = changed as f64 / of as f64;
        assert!(
            changed <= of && of >= 100 && ci95[0] < share && share < ci95[1],
            "{changed} of {of}: {ci95:?}"
        );
    }
}
