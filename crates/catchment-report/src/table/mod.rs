//! The report as aligned text, 80 columns wide, without colour.

mod basins;
mod certificate;
mod jams;
mod seat;

use super::resting::Told;
use super::schema::{AcceptanceReport, CenteredReport, OnaaReport, Report, ToleranceReport, UprightReport};
use super::text::{
    COLUMNS, decimals, grouped, length, line, percent, rounded, row, significant, with_error, wrapped,
};
use super::window;
use catchment_core::advice::Advice;
use catchment_core::design::{ConnectorSpec, Design};
use catchment_core::run::Upright;

/// The report for people; ends with a line break.
pub fn table(report: &Report) -> String {
    table_with(report, |_| None)
}

/// The same, and beside every doubt how `controls` says its advice: `--samples 4000`, where there is a command line.
pub fn table_with(report: &Report, controls: impl Fn(Advice) -> Option<String>) -> String {
    let mut text = String::new();
    heading(&mut text, &report.design);
    let method = format!("{}, {}", report.method, tried(report));
    row(&mut text, "method", &method);
    let friction = report.friction();
    if friction > 0.0 {
        row(&mut text, "friction", &format!("{friction} between the halves (Coulomb)"));
    }
    if let Some(slope) = report.of_motions("slope_threshold").filter(|slope| *slope > 0.0) {
        row(&mut text, "slope threshold", &format!("{slope}: motion ends where the height falls less"));
    }
    if let ConnectorSpec::Own(own) = &report.design.connector {
        for (name, half) in [("fixed half", &own.fixed), ("moving half", &own.moving)] {
            if let Some(told) = half.meshing_told(&report.design) {
                wrapped(&mut text, &format!("{name}: "), &told);
            }
            if let Some(done) = half.repairs_told(&report.design) {
                wrapped(&mut text, &format!("{name}: "), &done);
            }
        }
    }
    text.push('\n');
    limits(&mut text, report);
    if let Some(s) = &report.success {
        let outside = format!("{} of the errors lie outside the error box", percent(s.outside));
        row(&mut text, "success", &format!("{}   ({outside})", percent(s.probability)));
        let [lo, hi] = s.ci95.unwrap_or(s.bracket).map(percent);
        let what = if s.ci95.is_some() { "95 % CI" } else { "if the border moves by one cell:" };
        row(&mut text, "", &format!("{what} {lo} … {hi}"));
        text.push('\n');
    }
    acceptance(&mut text, report);
    if let Some(onaa) = &report.onaa {
        row(&mut text, "ONAA edge", &cube(onaa));
    }
    if let Some(found) = &report.seat {
        text.push('\n');
        seat::lines(&mut text, found, &report.design);
    }
    by_products(&mut text, report);
    if let Some(found) = &report.window {
        text.push('\n');
        window::lines(&mut text, &found.found, &report.design);
    }
    if let Some(found) = &report.jams {
        text.push('\n');
        jams::lines(&mut text, found, &report.design);
    }
    if !report.warnings.is_empty() {
        text.push('\n');
        for warning in &report.warnings {
            let how = warning.warning.advice().and_then(&controls);
            let how = how.map_or_else(String::new, |how| format!(" ({how})"));
            wrapped(&mut text, "warning: ", &format!("{}{how}", warning.message));
        }
    }
    text
}

/// What else the method knows.
fn by_products(text: &mut String, report: &Report) {
    if let Some(found) = &report.basins {
        text.push('\n');
        basins::lines(text, found, report);
    }
    if let Some(found) = &report.watersheds {
        let [first, merged, dams] = [found.counts.first, found.counts.merged, found.counts.dams].map(grouped);
        let dams = if found.counts.dams > 0 { format!(" (and {dams} dam cells)") } else { String::new() };
        row(text, "watersheds", &format!("{first} first labels{dams}, {merged} after merging"));
        row(text, "", &format!("{} of the cells joined another", percent(found.moved_share)));
    }
    if let Some(found) = &report.joined {
        let [joined, cells, tried] = [found.joined, found.cells, found.tried].map(grouped);
        row(text, "inherited", &format!("{joined} of {cells} contact cells inherit a neighbour's outcome;"));
        let most = percent(found.wrong_ci95[1]);
        let told = match found.tried {
            0 => "none of them was re-checked".to_owned(),
            _ => format!("{} of {tried} re-checked differ (at most {most} of them)", grouped(found.wrong)),
        };
        row(text, "", &told);
    }
    if let Some(found) = &report.partition {
        text.push('\n');
        let counts = found.counts;
        let [polytopes, cells, parts, rests] =
            [counts.polytopes, counts.cells, counts.parts, counts.rests].map(grouped);
        row(text, "partition", &format!("{:.4} {} accepted, exactly", found.sum, report.acceptance.unit));
        row(
            text,
            "",
            &format!("{polytopes} polytopes, {cells} cells, {parts} parts, {rests} places of rest"),
        );
    }
    if let Some(found) = &report.certificate {
        text.push('\n');
        certificate::lines(text, found, report);
    }
}

pub(super) fn heading(text: &mut String, design: &Design) {
    line(text, &design.name);
    line(text, &"─".repeat(design.name.chars().count().clamp(24, COLUMNS)));
    let kind = match &design.connector {
        ConnectorSpec::Family(f) => {
            format!("{}, aspect ratio {}", f.family().name(), rounded(f.aspect_ratio()))
        }
        ConnectorSpec::Own(_) => "own halves".to_owned(),
    };
    let width =
        design.unit.map_or_else(|| "D = 1".to_owned(), |u| format!("D = {} {}", design.width, u.symbol()));
    row(text, "connector", &format!("{kind}, {width}"));
    let alignment = &design.alignment;
    let free: Vec<&str> = alignment.free.iter().map(catchment_core::pose::Dof::name).collect();
    row(text, "free errors", &free.join(", "));
    row(
        text,
        "motion",
        &format!(
            "COR {} D before the face, rotation length {} D",
            rounded(alignment.center_of_rotation),
            rounded(alignment.rotation_length)
        ),
    );
}

fn tried(report: &Report) -> String {
    if report.axes.is_empty() {
        return format!("{} poses", grouped(report.acceptance.cells));
    }
    let cells: Vec<String> = report.axes.iter().map(|a| a.cells.to_string()).collect();
    format!("{} = {} cells", cells.join(" × "), grouped(report.acceptance.cells))
}

/// The Sum with its unit, and half its interval where it has one: `12.587 ± 0.023 D²·rad³`. Where half the interval is more than the Sum, its upper
/// end alone: too few sampled poses docked to say more.
pub(super) fn sum(a: &AcceptanceReport) -> String {
    let sum = match (upper_end(a), a.sum_ci95) {
        (Some(hi), _) => format!("below {}", significant(hi)),
        (None, Some(ci95)) => with_error(a.sum, ci95),
        (None, None) => significant(a.sum),
    };
    format!("{sum} {}", a.unit)
}

/// The upper end of an interval that is wider than twice the Sum.
pub(super) fn upper_end(a: &AcceptanceReport) -> Option<f64> {
    a.sum_ci95.and_then(|[lo, hi]| (hi - lo > 2.0 * a.sum).then_some(hi))
}

fn acceptance(text: &mut String, report: &Report) {
    let a = &report.acceptance;
    let share = match upper_end(a) {
        Some(_) => "too few sampled poses docked to say more".to_owned(),
        None => format!("{} of the error box", percent(a.fraction)),
    };
    row(text, "AA (Sum)", &format!("{}   ({share})", sum(a)));
    let poses = a.sample.as_ref().map_or(a.cells, |sample| sample.descents);
    if a.sum_ci95.is_some() {
        row(text, "", &format!("95 % CI, {} sampled poses", grouped(poses)));
    }
    if let Some([lo, hi]) = a.sum_bracket {
        let [lo, hi] = [lo, hi].map(significant);
        let told = match (report.certificate.is_some(), a.sample.is_some()) {
            (true, _) => format!("for certain: {lo} … {hi}"),
            (_, true) => {
                let grid = significant(a.sum_grid);
                format!("grid: {grid}; {lo} … {hi} if its border moves by one cell")
            }
            (_, false) => format!("{lo} … {hi} if its border moves by one cell"),
        };
        row(text, "", &told);
    }
    if let Some(sample) = &a.sample {
        let [lo, hi] = sample.differing_ci95.map(percent);
        let share = percent(sample.differing);
        row(text, "misclassified", &format!("{share} of the error box by the grid (95 % CI {lo} … {hi})"));
    }
    let share =
        |n: usize| format!("{:.1} %", if a.cells == 0 { 0.0 } else { 100.0 * n as f64 / a.cells as f64 });
    let o = &a.outcomes;
    row(
        text,
        "outcomes",
        &format!(
            "aligned {}  jammed {}  missed {}  undecided {}",
            share(o.aligned),
            share(o.jammed),
            share(o.missed),
            share(o.undecided)
        ),
    );
}

fn cube(onaa: &OnaaReport) -> String {
    if onaa.bounds.is_empty() {
        return "0   no cell is accepted".to_owned();
    }
    format!("{:.4}   of the error box, along every axis", onaa.edge)
}

/// What an engineer asks first: the tolerance window, and how far each error may go alone.
fn limits(text: &mut String, report: &Report) {
    let centered = report.centered.as_ref();
    if report.tolerances.is_empty() && centered.is_none() {
        return;
    }
    line(
        text,
        &format!("  {:<9}{:>20}{:>25}{:>23}", "error", "tolerance window", "single-axis limit", "D, rad"),
    );
    let mut is_open = limit_rows(text, &report.design, centered, &report.tolerances);
    if let Some(found) = &report.upright {
        line(text, "  with roll and pitch locked");
        is_open |= limit_rows(text, &report.design, Some(&found.window), &found.tolerances);
    }
    match centered {
        Some(found) if found.followed => {
            let all = found.sampled.map_or_else(
                || "every sampled pose docks".to_owned(),
                |poses| format!("all of {} sampled poses dock", grouped(poses)),
            );
            line(text, &format!("  window: largest centred box in which {all}"));
        }
        Some(_) => line(text, "  window: largest centred box of accepted cells"),
        None => {}
    }
    if report.tolerances.iter().all(|t| t.followed) {
        line(text, "  single-axis limit: one error, all others zero");
    } else if report.certificate.is_some() {
        line(text, "  single-axis limit: at least, as far as whole cells dock for certain");
    } else {
        let half = |t: &ToleranceReport| {
            if t.axis.is_rotation() {
                format!("{} {:.2}°", t.axis.name(), t.half_cell.to_degrees())
            } else {
                format!("{} {:.4} D", t.axis.name(), t.half_cell)
            }
        };
        let half: Vec<String> = report.tolerances.iter().map(half).collect();
        line(text, "  single-axis limit: one error, all others zero, ± half a cell:");
        wrapped(text, "    ", &half.join(", "));
    }
    if is_open {
        line(text, "  * ends at the error box, perhaps larger");
    }
    text.push('\n');
}

/// What is known long before the rest of a long run: the tolerances with roll and pitch locked, as lines.
pub fn first_look(design: &Design, found: &Upright) -> Vec<String> {
    let UprightReport { window, tolerances } = found.into();
    let (locked, window_head, limit) =
        ("with roll and pitch locked", "tolerance window", "single-axis limit");
    let mut text =
        format!("first look, {locked}:\n  {:<9}{window_head:>20}{limit:>25}{:>23}\n", "error", "D, rad");
    limit_rows(&mut text, design, Some(&window), &tolerances);
    text.lines().map(ToOwned::to_owned).collect()
}

/// A row per error; says whether the error box ends any of them.
fn limit_rows(
    text: &mut String,
    design: &Design,
    window: Option<&CenteredReport>,
    limits: &[ToleranceReport],
) -> bool {
    let told = Told::of(design);
    let mut is_open = false;
    for axis in design.alignment.free.iter() {
        let half_width = window.and_then(|found| found.bounds.iter().find(|side| side.axis == axis));
        let limit = limits.iter().find(|limit| limit.axis == axis);
        if half_width.is_none() && limit.is_none() {
            continue;
        }
        let box_ends = window.is_some_and(|found| found.reaches_border);
        let half_width = half_width.map_or_else(String::new, |side| {
            format!("{}{}", told.size(axis, side.hi), if box_ends { "*" } else { "" })
        });
        let [own, base] = limit.map_or_else(Default::default, |limit| {
            is_open |= limit.minus_reaches_border || limit.plus_reaches_border;
            [in_own_unit(limit, design), both(limit, 1.0, 4, "")]
        });
        is_open |= box_ends;
        line(text, &format!("  {:<9}{half_width:>20}{own:>25}{base:>23}", axis.name()));
    }
    is_open
}

/// A limit in the unit of the design, or in D; angles in degrees.
fn in_own_unit(limit: &ToleranceReport, design: &Design) -> String {
    if limit.axis.is_rotation() {
        return both(limit, 1f64.to_degrees(), 2, "°");
    }
    match design.unit {
        Some(unit) => format!("{} {}", both(limit, design.width, decimals(design.width), ""), unit.symbol()),
        None => format!("{} D", both(limit, 1.0, 4, "")),
    }
}

/// `±0.5` where both sides agree, `−0.5 / +0.3` where they do not; a star where the error box cut it off.
fn both(t: &ToleranceReport, scale: f64, digits: usize, unit: &str) -> String {
    let side = |value: f64, is_open: bool| {
        format!("{:.digits$}{unit}{}", value * scale, if is_open { "*" } else { "" })
    };
    let (minus, plus) = (side(t.minus, t.minus_reaches_border), side(t.plus, t.plus_reaches_border));
    if minus == plus { format!("±{plus}") } else { format!("−{minus} / +{plus}") }
}

#[cfg(test)]
mod tests {
    use super::super::schema::testing::*;
    use super::*;
    use catchment_core::acceptance::Warning;
    use catchment_core::contact::Play;
    use catchment_core::design::LengthUnit;
    use catchment_core::exec::Exec;
    use catchment_core::pose::{Dof, DofSet};
    use catchment_core::run::{Residual, Seating};

    fn text(free: DofSet, cells: usize) -> String {
        let design = design(free);
        let mut blob = blob(&design, cells);
        blob.warnings.push(Warning::Undecided { cells: 3 });
        table(&Report::new(&design, &blob, serde_json::Value::Null, None, &Exec::new()).unwrap())
    }

    #[test]
    fn it_fits_in_eighty_columns_and_names_the_units() {
        let text = text(DofSet::ALL, 8);
        for line in text.lines() {
            assert!(line.chars().count() <= COLUMNS && line == line.trim_end(), "{line:?}");
        }
        for word in
            ["pyramid, AR 1/2", "D = 50 mm", "D²·rad³", "32 768 cells", "ONAA", "mm", "°", "warning: "]
        {
            assert!(text.contains(word), "{word} is missing in\n{text}");
        }
    }

    #[test]
    fn tolerances_stand_in_every_unit() {
        // x: aligned while 1.96 x² < 0.7, so to the border of the cell with centre 0.59: 0.6 D = 30 mm.
        let text = text([Dof::X].into_iter().collect(), 100);
        let row = text.lines().find(|l| l.starts_with("  x ")).unwrap();
        assert_eq!(
            row.split_whitespace().collect::<Vec<_>>(),
            ["x", "±30.000", "mm", "±30.000", "mm", "±0.6000"]
        );
    }

    /// A part of 16 mm whose design is in metres: nothing in it is 0.000 m.
    #[test]
    fn a_part_in_metres_has_its_digits() {
        let mut design = design([Dof::X].into_iter().collect());
        (design.width, design.unit) = (0.016, Some(LengthUnit::M));
        let blob = blob(&design, 100);
        let mut report = Report::new(&design, &blob, serde_json::Value::Null, None, &Exec::new()).unwrap();
        let play = Play { axis: Dof::X, minus: 0.05, plus: 0.05 };
        let off = Residual { axis: Dof::X, mean: 0.02, p95: 0.04, most: 0.05 };
        report.seat =
            Some(Seating { depth: 0.002, play: vec![play], poses: 11, residual: vec![off], deeper: None });
        let text = table(&report);
        let row = |start: &str| text.lines().find(|l| l.trim_start().starts_with(start)).unwrap();
        assert_eq!(
            row("x  ").split_whitespace().collect::<Vec<_>>(),
            ["x", "±0.00960", "m", "±0.00960", "m", "±0.6000"]
        );
        assert!(row("seat").contains("within 0.00003 m of"), "{text}");
        for told in ["±0.00080 m", "0.00032 m", "0.00064 m"] {
            assert!(text.contains(told), "{text}");
        }
    }
}
