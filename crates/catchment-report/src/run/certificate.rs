//! Certified results: the three parts of the error box, and the retention of the seat.

use crate::schema::RunBody;
use catchment_core::document::{Document, grouped, percent, rounded_down, significant};
use catchment_core::method::certified::BoxCertificate;
use catchment_core::pose::Dof;

/// Describes a certificate.
pub(super) fn describe(document: &mut Document, found: &BoxCertificate, run: &RunBody) {
    let unit = &run.acceptance.unit;
    let [yes, no, open] = found.measures;
    let boxes = format!("{} boxes", grouped(found.boxes));
    document.row(
        "all dock",
        format!("{} of the error box, {} {unit}   ({boxes})", percent(found.yes), significant(yes)),
    );
    document.row("none docks", format!("{}, {} {unit}", percent(found.no), significant(no)));
    document.row("undecided", format!("{}, {} {unit}", percent(found.undecided), significant(open)));
    if found.window > 0.0 {
        let alignment = &run.design.alignment;
        let side = |dof: Dof| {
            let half = found.window * alignment.half_range(dof);
            let degrees = || format!("{}°", rounded_down(half.to_degrees()));
            let half = if dof.is_rotation() { degrees() } else { format!("{} D", rounded_down(half)) };
            format!("{dof} ±{half}")
        };
        let sides: Vec<String> = alignment.free.iter().map(side).collect();
        document.row("certain window", sides.join(", "));
    }
    let least = significant(found.retention_at_least);
    let most = found.retention_at_most.map_or_else(String::new, |most| format!(" … {}", significant(most)));
    let lift = if most.is_empty() { format!("at least {least}") } else { format!("{least}{most}") };
    document.row("retention", format!("leaves when lifted by {lift} D   (energy per force)"));
}
