//! The report as aligned text, 80 columns wide, without colour.

mod basins;
mod certificate;
mod jams;
mod seat;

use super::schema::{AcceptanceReport, OnaaReport, Report, ToleranceReport};
use super::text::{
    COLUMNS, decimals, grouped, length, line, percent, rounded, row, significant, with_error, wrapped,
};
use super::window;
use crate::advice::Advice;
use crate::design::{ConnectorSpec, Design};

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
    acceptance(&mut text, report);
    if let Some(onaa) = &report.onaa {
        row(&mut text, "ONAA edge", &cube(onaa));
    }
    if let Some(centered) = &report.centered {
        let more = if centered.reaches_border { ", up to the error box" } else { "" };
        row(&mut text, "centred edge", &format!("{:.4}   around zero{more}", centered.edge));
        if centered.followed {
            row(&mut text, "", "in both all poses that were followed dock");
        }
    }
    if let Some(s) = &report.success {
        let outside = format!("{} of the errors lie outside the error box", percent(s.outside));
        row(&mut text, "success", &format!("{}   ({outside})", percent(s.probability)));
        let [lo, hi] = s.ci95.unwrap_or(s.bracket).map(percent);
        let what = if s.ci95.is_some() { "95 % interval" } else { "one cell of doubt:" };
        row(&mut text, "", &format!("{what} {lo} … {hi}"));
    }
    if !report.tolerances.is_empty() {
        text.push('\n');
        tolerances(&mut text, report);
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
        row(text, "joined", &format!("{joined} of {cells} cells in contact joined others;"));
        let most = percent(found.wrong_ci95[1]);
        let told = match found.tried {
            0 => "none of them was followed to ask whether it ends alike".to_owned(),
            _ => format!("of {tried} tried {} end otherwise (at most {most} of them)", grouped(found.wrong)),
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
    let free: Vec<&str> = alignment.free.iter().map(crate::pose::Dof::name).collect();
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

/// The Sum with its unit, and half its interval where it has one: `12.587 ± 0.023 D²·rad³`.
pub(super) fn sum(a: &AcceptanceReport) -> String {
    let sum = a.sum_ci95.map_or_else(|| significant(a.sum), |ci95| with_error(a.sum, ci95));
    format!("{sum} {}", a.unit)
}

fn acceptance(text: &mut String, report: &Report) {
    let a = &report.acceptance;
    row(text, "Sum", &format!("{}   ({} of the error box)", sum(a), percent(a.fraction)));
    let poses = a.sample.as_ref().map_or(a.cells, |sample| sample.descents);
    if a.sum_ci95.is_some() {
        row(
            text,
            "",
            &format!("± is the 95 % interval of {} random poses, followed exactly", grouped(poses)),
        );
    }
    if let Some([lo, hi]) = a.sum_bracket {
        let cells = if a.sample.is_some() {
            format!("accepted cells: {}, ", significant(a.sum_grid))
        } else {
            String::new()
        };
        let what = if report.certificate.is_some() { "for certain" } else { "one cell of doubt" };
        row(text, "", &format!("{cells}{what}: {} … {}", significant(lo), significant(hi)));
    }
    if let Some(sample) = &a.sample {
        let [lo, hi] = sample.differing_ci95.map(percent);
        let told =
            format!("cells fare otherwise than {} of the box ({lo} … {hi})", percent(sample.differing));
        row(text, "", &told);
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

fn tolerances(text: &mut String, report: &Report) {
    let unit = report.design.unit;
    let own = unit.map_or_else(String::new, |u| format!("{:>22}", u.symbol()));
    line(text, &format!("  {:<9}{:>22}{own}{:>22}", "tolerance", "D, rad", "deg"));
    let mut open = false;
    for t in &report.tolerances {
        let angle = t.axis.is_rotation();
        let base = both(t, 1.0, 4);
        let lengths =
            if angle { String::new() } else { both(t, report.design.width, decimals(report.design.width)) };
        let lengths = if unit.is_none() { String::new() } else { format!("{lengths:>22}") };
        let degrees = if angle { both(t, 1f64.to_degrees(), 2) } else { String::new() };
        line(text, &format!("  {:<9}{base:>22}{lengths}{degrees:>22}", t.axis.name()));
        open |= t.minus_reaches_border || t.plus_reaches_border;
    }
    let half: Vec<String> = report
        .tolerances
        .iter()
        .map(|t| {
            if t.axis.is_rotation() {
                format!("{} {:.2}°", t.axis.name(), t.half_cell.to_degrees())
            } else {
                format!("{} {:.4} D", t.axis.name(), t.half_cell)
            }
        })
        .collect();
    if report.tolerances.iter().all(|t| t.followed) {
        line(text, "  each alone, by poses followed exactly along its axis");
    } else if report.certificate.is_some() {
        line(text, "  each at least, as far as whole cells dock for certain");
    } else {
        wrapped(text, "  each ± half a cell: ", &half.join(", "));
    }
    if open {
        line(text, "  * up to the border of the error box, perhaps further");
    }
}

/// `±0.5` where both sides agree, `−0.5 / +0.3` where they do not; a star where the error box cut it off.
fn both(t: &ToleranceReport, scale: f64, digits: usize) -> String {
    let star = |open: bool| if open { "*" } else { "" };
    let (minus, plus) = (format!("{:.digits$}", t.minus * scale), format!("{:.digits$}", t.plus * scale));
    if minus == plus && t.minus_reaches_border == t.plus_reaches_border {
        return format!("±{plus}{}", star(t.plus_reaches_border));
    }
    format!("−{minus}{} / +{plus}{}", star(t.minus_reaches_border), star(t.plus_reaches_border))
}

#[cfg(test)]
mod tests {
    use super::super::schema::testing::*;
    use super::*;
    use crate::acceptance::Warning;
    use crate::contact::Play;
    use crate::design::LengthUnit;
    use crate::exec::Exec;
    use crate::pose::{Dof, DofSet};
    use crate::run::{Residual, Seating};

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
            ["pyramid, AR 1/2", "D = 50 mm", "D²·rad³", "32 768 cells", "ONAA", "mm", "deg", "warning: "]
        {
            assert!(text.contains(word), "{word} is missing in\n{text}");
        }
    }

    #[test]
    fn tolerances_stand_in_every_unit() {
        // x: aligned while 1.96 x² < 0.7, so to the border of the cell with centre 0.59: 0.6 D = 30 mm.
        let text = text([Dof::X].into_iter().collect(), 100);
        let row = text.lines().find(|l| l.starts_with("  x ")).unwrap();
        assert_eq!(row.split_whitespace().collect::<Vec<_>>(), ["x", "±0.6000", "±30.000"]);
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
        assert_eq!(row("x  ").split_whitespace().collect::<Vec<_>>(), ["x", "±0.6000", "±0.00960"]);
        assert!(row("seat").contains("within 0.00003 m of"), "{text}");
        for told in ["±0.00080 m", "0.00032 m", "0.00064 m"] {
            assert!(text.contains(told), "{text}");
        }
    }
}
