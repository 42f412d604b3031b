//! Errors on a line: `x=0.2,pitch=10 deg`.

use super::written::{Written, resolve};
use super::{FAMILY, OffsetsAt, defect, shortened};
use crate::design::{Design, DesignDefect, Quantity, nearest};
use catchment_base::diagnostic::{Diagnostic, DiagnosticCollector, Diagnostics};
use catchment_base::pose::{Dof, PoseError};
use catchment_base::suggest::odd;
use std::ops::Range;

/// Reads a pose error such as `x=0.2,pitch=10 deg`; errors that are not named are 0. Offsets are those of the
/// face centre.
///
/// # Errors
/// All errors of the text.
///
/// # Examples
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let design = catchment_design::design::read("[connector]\nfamily = \"pyramid\"\n", ".".as_ref())?.design;
/// let error = catchment_design::poses::parse_pose("x=0.2,pitch=10 deg", &design)?;
/// assert_eq!((error.x, error.pitch), (0.2, 10f64.to_radians()));
/// let refusal = catchment_design::poses::parse_pose("x=0.2,pich=10 deg", &design).unwrap_err();
/// assert_eq!(refusal.list[0].span, Some(6..17));
/// # Ok(())
/// # }
/// ```
pub fn parse_pose(text: &str, design: &Design) -> Result<PoseError, Diagnostics> {
    let mut found = DiagnosticCollector::default();
    let (written, spans) = terms(text, &mut found);
    let error = resolve(&written, OffsetsAt::Face, design).unwrap_or_else(|faults| {
        for (dof, fault) in faults {
            found.push_at(fault, || Some(spans[dof.index()].clone()));
        }
        PoseError::default()
    });
    found.refuse()?;
    Ok(error)
}

/// The value of each error, and its byte range in the text. Of an error that is named twice the first value
/// counts.
pub(super) fn terms(text: &str, found: &mut DiagnosticCollector) -> (Written, [Range<usize>; 5]) {
    let (mut written, mut spans) = (Written::default(), <[Range<usize>; 5]>::default());
    let mut start = 0;
    for part in text.split(',') {
        let from = start + (part.len() - part.trim_start().len());
        let span = from..(start + part.trim_end().len()).max(from);
        start += part.len() + 1;
        match term(part.trim()) {
            Ok((dof, _)) if written[dof.index()].is_some() => {
                let fault = defect(format!("{} is given twice", dof.name()), "name it once");
                found.push_at(fault, || Some(span));
            }
            Ok((dof, quantity)) => {
                written[dof.index()] = Some(quantity);
                spans[dof.index()] = span;
            }
            Err(fault) => found.push_at(fault, || Some(span)),
        }
    }
    (written, spans)
}

/// Reads `pitch=10 deg`.
fn term(part: &str) -> Result<(Dof, Quantity), Diagnostic> {
    const FORM: &str = "write errors such as \"x=0.2,pitch=10 deg\"";
    let Some((name, number)) = part.split_once('=') else {
        return Err(defect(format!("`{}` is no error", shortened(part)), FORM));
    };
    let name = name.trim();
    let Some(dof) = Dof::ALL.into_iter().find(|dof| dof.name() == name) else {
        let help = nearest(name, Dof::ALL.map(Dof::name)).map_or_else(
            || "one of x, y, roll, pitch, yaw".to_owned(),
            |meant| format!("did you mean {meant}?"),
        );
        return Err(defect(format!("there is no error `{}`{}", shortened(name), odd(name)), help));
    };
    let quantity = number
        .parse()
        .map_err(|c: DesignDefect| Diagnostic::error(FAMILY, format!("{name}: {c}"), c.help()))?;
    Ok((dof, quantity))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn read(text: &str) -> Result<PoseError, Diagnostics> {
        let design = crate::design::read("[connector]\nfamily = \"v-face\"\n", Path::new("")).unwrap().design;
        parse_pose(text, &design)
    }

    #[test]
    fn errors_are_read_and_mistakes_come_with_their_places() {
        assert_eq!(read(" x = 0.1 , pitch=0.2 ").unwrap().to_array(), [0.1, 0.0, 0.0, 0.2, 0.0]);
        let text = "x=0.1,pich=3,yaw=0.2, pitch=400 deg,x=2,y,roll=1 mm";
        let refusal = read(text).unwrap_err();
        let places: Vec<&str> = refusal.list.iter().map(|o| &text[o.span.clone().unwrap()]).collect();
        assert_eq!(places, ["pich=3", "yaw=0.2", "pitch=400 deg", "x=2", "y", "roll=1 mm"]);
        assert_eq!(read("").unwrap_err().list[0].span, Some(0..0));
        assert_eq!(read("x=0.1, ,").unwrap_err().list.len(), 2);
    }

    #[test]
    fn nothing_that_steers_a_terminal_is_quoted() {
        for text in ["\x1b[2Jx", "\x1b[2J=1", "x=\x1b[2J", "x=1 \u{9b}m", "\u{202e}=1"] {
            let message = read(text).unwrap_err().to_string();
            assert!(!message.chars().any(super::super::is_hidden), "{message:?}");
        }
    }
}
