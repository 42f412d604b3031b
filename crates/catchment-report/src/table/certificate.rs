//! What is certain, as text: the three parts of the error box, and how well the seat holds.

use crate::schema::Report;
use crate::text::{grouped, percent, rounded_down, row, significant};
use catchment_core::method::certified::Certificate;
use catchment_core::pose::Dof;

/// Writes a certificate.
pub(super) fn lines(text: &mut String, found: &Certificate, report: &Report) {
    let unit = &report.acceptance.unit;
    let [yes, no, open] = found.measures;
    let boxes = format!("{} boxes", grouped(found.boxes));
    row(
        text,
        "all dock",
        &format!("{} of the error box, {} {unit}   ({boxes})", percent(found.yes), significant(yes)),
    );
    row(text, "none docks", &format!("{}, {} {unit}", percent(found.no), significant(no)));
    row(text, "undecided", &format!("{}, {} {unit}", percent(found.undecided), significant(open)));
    if found.window > 0.0 {
        let alignment = &report.design.alignment;
        let side = |dof: Dof| {
            let half = found.window * alignment.half_range(dof);
            let degrees = || format!("{}°", rounded_down(half.to_degrees()));
            let half = if dof.is_rotation() { degrees() } else { format!("{} D", rounded_down(half)) };
            format!("{dof} ±{half}")
        };
        let sides: Vec<String> = alignment.free.iter().map(side).collect();
        row(text, "certain window", &sides.join(", "));
    }
    let least = significant(found.retention_at_least);
    let most = found.retention_at_most.map_or_else(String::new, |most| format!(" … {}", significant(most)));
    let lift = if most.is_empty() { format!("at least {least}") } else { format!("{least}{most}") };
    row(text, "retention", &format!("leaves when lifted by {lift} D   (energy per force)"));
}
