//! The basins as text: the largest of them, and what the depth tolerance decides.

use crate::schema::{BasinsReport, Report};
use crate::text::{grouped, line, percent, rounded, significant, wrapped};
use catchment_core::method::flood::Reason;

/// How many basins a person wants to see.
const SHOWN: usize = 6;
/// How many steps.
const STEPS: usize = 8;

/// Writes the basins of a report.
pub(super) fn lines(text: &mut String, basins: &BasinsReport, report: &Report) {
    let axes: Vec<_> = report.axes.iter().map(|axis| axis.axis).collect();
    let names: Vec<&str> = axes.iter().map(|dof| dof.name()).collect();
    let at = format!("lowest at {} [D, °]", names.join(", "));
    line(text, &format!("  {:<10}{:>9}{:>9}{:>9}   {at}", "basin", "share", "depth", "escape"));
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
        // Where nothing touches there is no lowest place.
        let place = basin.height.map_or_else(|| "no contact".to_owned(), |_| place.join(", "));
        line(
            text,
            &format!(
                "  {:<10}{:>9}{:>9}{:>9}   {place}",
                basin.outcome.name(),
                percent(basin.fraction),
                depth(basin.depth),
                depth(basin.escape),
            ),
        );
    }
    if basins.merged > SHOWN {
        line(text, &format!("  and {} more", grouped(basins.merged - SHOWN)));
    }
    let used = significant(basins.tolerance.depth);
    let why = match basins.tolerance.reason {
        Reason::Given => "as given".to_owned(),
        Reason::WidestGap { between: [low, high], .. } => {
            format!("no depth lies between {} and {}", significant(low), significant(high))
        }
    };
    let (minima, merged) = (grouped(basins.minima), grouped(basins.merged));
    let what = format!("basins shallower than {used} D; {why}. {minima} minima became {merged} basins.");
    wrapped(text, "  merged    ", &what);
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
        wrapped(text, "  accepted by tolerance: ", &steps.join(", "));
    }
}

#[cfg(test)]
mod tests {
    use crate::schema::basins::tests::flooded;
    use crate::{Report, table};
    use catchment_core::exec::Exec;
    use catchment_core::method::flood::Flooding;

    #[test]
    fn basins_and_tolerance_are_told_in_eighty_columns() {
        let (design, Flooding { acceptance, hierarchy, .. }) = flooded();
        let report = Report::new(&design, &acceptance, serde_json::Value::Null, None, &Exec::new()).unwrap();
        let text = table(&report.with_basins(&acceptance, &hierarchy));
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        for word in ["aligned", "no contact", "no depth lies between", "accepted by tolerance"] {
            assert!(text.contains(word), "{word} is missing in\n{text}");
        }
    }
}
