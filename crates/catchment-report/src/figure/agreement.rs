//! Agreement of each pair of methods for a design.

use super::Picture;
use super::draw::layout::Layout;
use super::number_map::{Colouring, Digits, NumberMap, number_maps};
use crate::AgreementReport;
use catchment_study::agreement::PairAgreement;

/// Draws how each two methods of a design agree: left the share of cells, right the overlap of the accepted sets.
pub fn agreement(report: &AgreementReport) -> Picture {
    let names: Vec<String> = report.results().map(|(name, _)| name.to_owned()).collect();
    let map = |title, of: fn(&PairAgreement) -> f64| NumberMap {
        title,
        rows: &names,
        columns: &names,
        values: report.agreement.iter().map(|row| row.iter().map(of).collect()).collect(),
        digits: Digits::Decimals(4),
        marks: Vec::new(),
        // Agreement of half the cells is no better than chance.
        colouring: Colouring::Deficit([0.5, 1.0]),
    };
    let cells: Vec<String> = report.cells.iter().map(ToString::to_string).collect();
    let head = Layout::of(&report.design)
        .story(format!("every method that applies, on {} cells", cells.join(" × ")));
    number_maps(
        head,
        [76.0, 40.0],
        &[
            map("share of the cells that both accept or both reject", |a| a.agreement),
            map("Jaccard: accepted by both, of all that one accepts", |a| a.jaccard),
        ],
    )
}
