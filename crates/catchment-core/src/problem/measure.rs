//! Default D of a design: measured from its halves, before any length in D can be resolved.
//!
//! ```text
//!   text ──read, lengths in the unit──▶ halves, mated ──width──▶ D ──read again──▶ the design, as if D were written
//!              └── again with D approximately known, for round parts: their facets depend on D
//! ```
//!
//! D is the larger lateral extent of the facets that can touch when the halves are at first contact at zero
//! error ([`width`]), at least the minimum for the size of the halves, rounded to 10⁻⁸ of itself. Lengths
//! that draw or place the halves cannot be in D then; the reader rejects them.
//!
//! Not promised: that D is unchanged if halves are moved: it is measured from the content of the file, also
//! in every design of a sweep.

use super::{Draft, ProblemError};
use crate::connector::Connector;
use crate::contact::mated::MatedProblem;
use crate::contact::{Pair, width};
use crate::design::{Alignment, ConnectorSpec, Design, HalfSpec, Width, WidthFrom};
use crate::exec::Exec;
use crate::pose::{DofSet, Mount};

/// Digits of a D that was measured.
const DIGITS: i32 = 9;

/// The design of a draft whose lengths are in its unit, with D measured.
pub(super) fn measured(draft: Draft, exec: &Exec) -> Result<Draft, ProblemError> {
    let Some(source) = draft.source().cloned() else { return Ok(draft) };
    let is_round = is_round(draft.design());
    let (mut result, from) = of(draft, exec)?;
    let mut why = from;
    if is_round {
        let (draft, _) = Draft::read_as(source.clone(), Width::Provisional(Some(result)))?;
        let (share, from) = of(draft, exec)?;
        (result, why) = (result * share, from);
    }
    Draft::read_as(source, Width::Measured(rounded(result), why)).map(|(draft, _)| draft)
}

/// D of the halves of a draft, in the width that the draft was read with.
fn of(draft: Draft, exec: &Exec) -> Result<(f64, WidthFrom), ProblemError> {
    let ConnectorSpec::Own(own) = &draft.design().connector else {
        return Ok((draft.design().width, WidthFrom::Written));
    };
    let (connector, widest) =
        match Connector::unsized_on(own, draft.design().alignment.mount, &draft.files, exec) {
            Ok(built) => built,
            Err(problems) => return Err(draft.unbuilt(&problems).into()),
        };
    // The mated height does not depend on the alignment problem.
    let lift = Pair::new(&connector, &Alignment::new(DofSet::EMPTY, Mount::X)).mated_height();
    let result = lift.is_finite().then(|| width::default(&connector.fixed, &connector.moving, lift, widest));
    result.flatten().ok_or_else(|| draft.unmated(&[MatedProblem::Apart], None).into())
}

/// Whether parts are round, so that how finely they are drawn depends on D.
fn is_round(design: &Design) -> bool {
    let ConnectorSpec::Own(own) = &design.connector else { return false };
    [&own.fixed, &own.moving].into_iter().any(|half| match half {
        HalfSpec::Parts(parts) => parts.iter().any(|part| part.shape.chord_error().is_some()),
        _ => false,
    })
}

/// To [`DIGITS`] digits.
fn rounded(width: f64) -> f64 {
    let places = DIGITS - 1 - width.log10().floor() as i32;
    let shift = 10f64.powi(places.abs());
    // Multiply or divide by an integer power of ten, which keeps the last digit exact.
    if places >= 0 { (width * shift).round() / shift } else { (width / shift).round() * shift }
}
