//! The heading of texts that no document makes yet.

use super::document::{Described, Style, heading as described, text};
use catchment_core::design::Design;

/// The heading of a design.
pub(super) fn heading(out: &mut String, design: &Design) {
    let document = described(design);
    out.push_str(&text(
        &Described { title: (&design.name).into(), document, warnings: Vec::new() },
        Style::default(),
    ));
}
