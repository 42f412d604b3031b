//! The basins: the largest of them, and the effect of the depth tolerance.

use crate::schema::{BasinsReport, RunBody};
use catchment_core::document::{
    Column, ColumnFormat, Document, Table, grouped, percent, rounded, significant,
};
use catchment_core::method::flood::ToleranceReason;

/// Basins that are shown.
const SHOWN: usize = 6;
/// Steps that are shown.
const STEPS: usize = 8;

/// Describes the basins of a run.
pub(super) fn describe(document: &mut Document, basins: &BasinsReport, run: &RunBody) {
    let axes = super::axes(run);
    let names: Vec<&str> = axes.iter().map(|dof| dof.name()).collect();
    let mut table = Table::new([
        Column::new("basin").left(),
        Column::new("of the error box").format(ColumnFormat::Percent),
        Column::new("depth"),
        Column::new("escape"),
        Column::new(format!("lowest at {} [D, °]", names.join(", "))).left(),
    ]);
    for basin in basins.largest.iter().take(SHOWN) {
        let depth = |depth: Option<f64>| depth.map_or_else(|| "∞".to_owned(), significant);
        let pose = basin.minimum.to_array();
        let place: Vec<String> = axes
            .iter()
            .map(|dof| match (pose[dof.index()], dof.is_rotation()) {
                (angle, true) => format!("{}°", rounded((angle.to_degrees() * 10.0).round() / 10.0)),
                (offset, false) => rounded((offset * 1e3).round() / 1e3),
            })
            .collect();
        // Without contact there is no lowest pose.
        let place = basin.height.map_or_else(|| "no contact".to_owned(), |_| place.join(", "));
        table.push([
            basin.outcome.name().into(),
            basin.fraction.into(),
            depth(basin.depth).into(),
            depth(basin.escape).into(),
            place.into(),
        ]);
    }
    document.table(table);
    if basins.merged > SHOWN {
        document.paragraph(format!("and {} more", grouped(basins.merged - SHOWN)));
    }
    let used = significant(basins.tolerance.depth);
    let why = match basins.tolerance.reason {
        ToleranceReason::Given => "as given".to_owned(),
        ToleranceReason::WidestGap { between: [low, high], .. } => {
            format!("no depth lies between {} and {}", significant(low), significant(high))
        }
    };
    let (minima, merged) = (grouped(basins.minima), grouped(basins.merged));
    document.row(
        "merged",
        format!("basins shallower than {used} D; {why}. {minima} minima became {merged} basins."),
    );
    let mut steps: Vec<String> = Vec::new();
    for step in basins.staircase.iter().take(STEPS) {
        let share = if step.cells == 0 { "nothing".to_owned() } else { percent(step.fraction) };
        steps.push(if step.above == 0.0 {
            share
        } else {
            format!("{share} above {}", significant(step.above))
        });
    }
    if basins.staircase.len() > STEPS {
        steps.push("…".to_owned());
    }
    if !steps.is_empty() {
        document.paragraph(format!("accepted by tolerance: {}", steps.join(", ")));
    }
}

#[cfg(test)]
mod tests {
    use crate::Report;
    use crate::schema::basins::tests::flooded;
    use catchment_core::exec::Exec;
    use catchment_core::method::flood::Flooding;

    #[test]
    fn basins_and_tolerance_fit_in_eighty_columns() {
        let (design, Flooding { acceptance, hierarchy, .. }) = flooded();
        let report = Report::new(&design, &acceptance, serde_json::Value::Null, None, &Exec::new()).unwrap();
        let text = report.with_basins(&acceptance, &hierarchy).table();
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        for word in ["aligned", "no contact", "no depth lies between", "accepted by tolerance"] {
            assert!(text.contains(word), "{word} is missing in\n{text}");
        }
    }
}
