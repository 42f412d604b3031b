//! Text form of a run.

mod basins;
mod certificate;
mod limits;
mod seat;

pub use limits::first_look;

use super::document::{Printed, setup};
use super::schema::{AcceptanceReport, RunBody};
use catchment_core::design::{ConnectorSpec, Design};
use catchment_core::document::{
    DesignUnits, Document, exact_motions, grouped, percent, significant, tenths, with_error, with_interval,
};
use catchment_core::merit::onaa::Onaa;
use catchment_core::pose::Dof;
use catchment_core::run::jams::{Jams, contacts_in_words};
use std::borrow::Cow;

/// Jams that are shown.
const JAMS: usize = 3;

impl Printed for RunBody {
    fn title(&self) -> Cow<'_, str> {
        (&self.design.name).into()
    }

    fn document(&self) -> Document {
        let mut document = Document::default();
        self.describe_outcomes(&mut document);
        self.describe_limits(&mut document);
        document.append(setup(&self.design, true));
        self.describe_method(&mut document);
        if let Some(found) = &self.seat {
            seat::describe(&mut document, found, &self.design);
        }
        document.section(None);
        self.describe_acceptance(&mut document);
        self.describe_by_products(&mut document);
        if let Some(found) = &self.window {
            document.section(None);
            found.details.describe(&mut document, &self.design);
        }
        if let Some(found) = &self.jams {
            document.section(None);
            describe_jams(&mut document, found, &self.design);
        }
        document
    }
}

impl RunBody {
    /// The first lines: shares of the error box, and the success of a robot.
    fn describe_outcomes(&self, document: &mut Document) {
        let a = &self.acceptance;
        let docked = match (upper_end(a), a.sum_ci95.filter(|_| a.sum > 0.0)) {
            (Some(hi), _) => {
                let most = percent(hi / self.design.alignment.error_box_measure());
                format!("below {most} of the error box (too few sampled poses docked for more)")
            }
            (None, Some([lo, hi])) => {
                let [lo, hi] = [lo, hi].map(|end| percent(end * a.fraction / a.sum));
                format!("{} of the error box (95 % CI {lo} … {hi})", percent(a.fraction))
            }
            (None, None) => format!("{} of the error box", percent(a.fraction)),
        };
        document.row("docked", docked);
        document.row("not docked", self.failures_in_words());
        if let Some(success) = &self.success {
            let [lo, hi] = success.ci95.unwrap_or(success.bracket).map(percent);
            let what =
                if success.ci95.is_some() { "95 % CI" } else { "if the grid is off by a cell at its border" };
            document.row(
                "success",
                format!("{} of the given errors dock ({what} {lo} … {hi})", percent(success.probability)),
            );
            if success.outside > 0.0 {
                document.more(format!(
                    "{} of the given errors lie outside the error box: they count as failures",
                    percent(success.outside)
                ));
            }
        }
    }

    /// How the poses that do not dock end: by the poses themselves, or by the grid unless its Sum lies outside the
    /// confidence interval.
    fn failures_in_words(&self) -> String {
        let a = &self.acceptance;
        let share =
            |n: usize| format!("{:.1} %", if a.cells == 0 { 0.0 } else { 100.0 * n as f64 / a.cells as f64 });
        let o = &a.outcomes;
        let open =
            if o.undecided > 0 { format!(", undecided {}", share(o.undecided)) } else { String::new() };
        let split = format!("jammed {}, missed {}{open}", share(o.jammed), share(o.missed));
        // A certificate has poses that neither dock nor fail for certain.
        if self.certificate.is_some() {
            return split;
        }
        let all = match upper_end(a) {
            Some(hi) => format!("above {}", percent(1.0 - hi / self.design.alignment.error_box_measure())),
            None => percent(1.0 - a.fraction),
        };
        if self.axes.is_empty() {
            format!("{all}; of the sampled poses {split}")
        } else if a.sum_ci95.is_some_and(|[lo, hi]| !(lo..=hi).contains(&a.sum_grid)) {
            format!("{all}; the grid is too coarse to tell jams from misses")
        } else {
            format!("{all}; by the grid {split}")
        }
    }

    /// The method and what it did to the halves, below the heading.
    fn describe_method(&self, document: &mut Document) {
        document.row("method", self.method_in_words());
        let friction = self.friction();
        if friction > 0.0 && !matches!(self.method.as_str(), "descent" | "confluence") {
            document.row("friction", format!("μ = {friction} between the halves (Coulomb)"));
        }
        if let Some(slope) = self.of_motions("slope_threshold").filter(|slope| *slope > 0.0) {
            document.row("slope threshold", format!("{slope}: motion ends on gentler slopes"));
        }
        self.describe_meshes(document, true);
    }

    /// How its meshes were made or repaired: either what moved their surfaces, or the rest.
    fn describe_meshes(&self, document: &mut Document, altered: bool) {
        let ConnectorSpec::Own(own) = &self.design.connector else { return };
        for (name, half) in [("fixed half", &own.fixed), ("moving half", &own.moving)] {
            if let Some(meshed) = half.meshing_in_words(&self.design).filter(|_| altered) {
                document.row(name, meshed);
            }
            if let Some(repaired) =
                half.repairs_in_words(&self.design).filter(|_| half.is_altered() == altered)
            {
                document.row(name, repaired);
            }
        }
    }

    /// The by-products of its method.
    fn describe_by_products(&self, document: &mut Document) {
        if let Some(found) = &self.basins {
            document.section(None);
            basins::describe(document, found, self);
        }
        if let Some(found) = &self.watersheds {
            let [first, merged, dams] =
                [found.counts.first, found.counts.merged, found.counts.dams].map(grouped);
            let dams = if found.counts.dams > 0 { format!(" (and {dams} dam cells)") } else { String::new() };
            document.row("watersheds", format!("{first} first labels{dams}, {merged} after merging"));
            document.more(format!("{} of the cells changed basin by merging", percent(found.moved_share)));
        }
        if let Some(found) = &self.inherited {
            let [inherited, cells, tried] = [found.inherited, found.cells, found.tried].map(grouped);
            document.row(
                "inherited",
                format!("{inherited} of {cells} contact cells inherit a neighbour's outcome;"),
            );
            let most = percent(found.wrong_ci95[1]);
            document.more(match found.tried {
                0 => "without a re-check".to_owned(),
                _ => {
                    format!("{} of {tried} re-checked differ (95 % CI: at most {most})", grouped(found.wrong))
                }
            });
        }
        if let Some(found) = &self.partition {
            let counts = found.counts;
            let [polytopes, cells, parts, rests] =
                [counts.polytopes, counts.cells, counts.parts, counts.rests].map(grouped);
            let sum = format!("{:.4} {} accepted, exactly", found.sum, self.acceptance.unit);
            document.section(None).row("partition", sum);
            document
                .more(format!("{polytopes} polytopes, {cells} cells, {parts} parts, {rests} places of rest"));
        }
        if let Some(found) = &self.certificate {
            document.section(None);
            certificate::describe(document, found, self);
        }
    }

    /// The two methods that follow exact motions say so; the name stands beside it.
    fn method_in_words(&self) -> String {
        let domain = self.domain();
        match self.method.as_str() {
            "descent" => exact_motions(&domain, self.friction()),
            "confluence" => {
                let motions = exact_motions(&domain, self.friction());
                format!("{motions}; paths that merge are computed once (confluence)")
            }
            other => format!("{other}, of {domain}"),
        }
    }

    /// Its cells or poses.
    fn domain(&self) -> String {
        if self.axes.is_empty() {
            return format!("{} random poses", grouped(self.acceptance.cells));
        }
        let cells: Vec<String> = self.axes.iter().map(|a| a.cells.to_string()).collect();
        format!("a grid of {} = {} poses", cells.join(" × "), grouped(self.acceptance.cells))
    }

    fn describe_acceptance(&self, document: &mut Document) {
        let a = &self.acceptance;
        let poses = a.sample.as_ref().map_or(a.cells, |sample| sample.descents);
        document.row("AA (Sum)", sum_in_words(a));
        let means = "area of acceptance, in the literature the Sum: the volume of all pose errors that dock";
        document.more(match (a.sum_ci95, self.axes.is_empty()) {
            (None, _) => means.to_owned(),
            (_, true) => format!("{means}; by {} poses sampled in the error box", grouped(poses)),
            (_, false) => format!(
                "{means}; estimated by the grid, and corrected by the exact outcomes of {} poses sampled in the error box",
                grouped(poses)
            ),
        });
        let border = a.sum_bracket.map(|ends| ends.map(significant));
        match (&border, self.certificate.is_some(), a.sample.is_some()) {
            (Some([lo, hi]), true, _) => _ = document.more(format!("certified: {lo} … {hi}")),
            (Some([lo, hi]), _, false) => {
                _ = document.more(format!("{lo} … {hi} if the grid is off by a cell at its border"));
            }
            _ => {}
        }
        document.details();
        self.describe_meshes(document, false);
        if let (Some([lo, hi]), false, true) = (border, self.certificate.is_some(), a.sample.is_some()) {
            let grid = significant(a.sum_grid);
            document.row(
                "Sum by grid",
                format!("{grid}; {lo} … {hi} if the grid is off by a cell at its border"),
            );
        }
        if let Some(onaa) = &self.onaa {
            document.row("ONAA edge", edge(onaa));
        }
        if let Some(sample) = &a.sample {
            let [lo, hi] = sample.misclassified_ci95.map(percent);
            let share = percent(sample.misclassified);
            document
                .row("misclassified", format!("{share} of the error box, by the grid (95 % CI {lo} … {hi})"));
        }
    }
}

/// The Sum with its unit, and half its interval, if any: `12.587 ± 0.023 D²·rad³`. If half the interval
/// exceeds the Sum, only its upper end: too few sampled poses docked for an estimate.
pub(super) fn sum(a: &AcceptanceReport) -> String {
    let sum = match (upper_end(a), a.sum_ci95) {
        (Some(hi), _) => format!("below {}", significant(hi)),
        (None, Some(ci95)) => with_error(a.sum, ci95),
        (None, None) => significant(a.sum),
    };
    format!("{sum} {}", a.unit)
}

/// The same with both ends of the interval: `12.587 D²·rad³ (95 % CI 12.564 … 12.610)`.
fn sum_in_words(a: &AcceptanceReport) -> String {
    match a.sum_ci95 {
        Some(ci95) if upper_end(a).is_none() => {
            let [sum, lo, hi] = with_interval(a.sum, ci95);
            format!("{sum} {} (95 % CI {lo} … {hi})", a.unit)
        }
        Some(_) => format!("{} (95 % CI)", sum(a)),
        None => sum(a),
    }
}

/// The upper end of an interval that is wider than twice the Sum.
pub(super) fn upper_end(a: &AcceptanceReport) -> Option<f64> {
    a.sum_ci95.and_then(|[lo, hi]| (hi - lo > 2.0 * a.sum).then_some(hi))
}

fn edge(onaa: &Onaa) -> String {
    if onaa.bounds.is_empty() {
        return "0   no cell docks".to_owned();
    }
    format!("{:.4} of every range: the largest box that docks, anywhere", onaa.edge)
}

/// Summary of the rests outside the seat.
fn describe_jams(document: &mut Document, found: &Jams, design: &Design) {
    let count = found.jams.len();
    let places = match count {
        0 => "no place".to_owned(),
        1 => "1 place".to_owned(),
        count => format!("{} places", grouped(count)),
    };
    document.row("jams", format!("{places}, by {} random poses", grouped(found.motions)));
    for (number, jam) in (1..).zip(found.jams.iter().take(JAMS)) {
        let touching = contacts_in_words(&jam.contacts).join("; ");
        let [of_box, of_failures] = [jam.of_box.share, jam.of_failures].map(tenths);
        let place = DesignUnits::of(design).pose(&jam.pose);
        document.row(
            format!("jam {number}"),
            format!("{of_box} of the error box, {of_failures} of failures, at {place}: {touching}"),
        );
    }
    if count > JAMS {
        let poses: usize = found.jams[JAMS..].iter().map(|jam| jam.of_box.count).sum();
        let share = tenths(poses as f64 / found.motions as f64);
        document.more(format!("and {} more, {share} of the error box together", grouped(count - JAMS)));
    }
}

/// Names of the axes of the error grid.
fn axes(body: &RunBody) -> Vec<Dof> {
    body.axes.iter().map(|axis| axis.axis).collect()
}

#[cfg(test)]
mod tests {
    use crate::Report;
    use crate::schema::testing::*;
    use catchment_core::contact::Play;
    use catchment_core::design::LengthUnit;
    use catchment_core::diagnostic::Warning;
    use catchment_core::exec::Exec;
    use catchment_core::pose::{Dof, DofSet};
    use catchment_core::run::{Residual, Seating};

    fn text(free: DofSet, cells: usize) -> String {
        let design = design(free);
        let mut blob = blob(&design, cells);
        blob.warnings.push(Warning::Undecided { cells: 3 }.into());
        Report::new(&design, &blob, serde_json::Value::Null, None, &Exec::new()).unwrap().table()
    }

    #[test]
    fn it_fits_in_eighty_columns_and_names_the_units() {
        let text = text(DofSet::ALL, 8);
        for line in text.lines() {
            assert!(line.chars().count() <= 80 && line == line.trim_end(), "{line:?}");
        }
        for word in
            ["pyramid, AR 1/2", "D = 50 mm", "D²·rad³", "32 768 poses", "ONAA", "mm", "°", "warning: "]
        {
            assert!(text.contains(word), "{word} is missing in\n{text}");
        }
    }

    #[test]
    fn tolerances_stand_in_the_unit_of_the_design() {
        // x: aligned while 1.96 x² < 0.7, so to the border of the cell with centre 0.59: 0.6 D = 30 mm.
        let text = text([Dof::X].into_iter().collect(), 100);
        let row = text.lines().find(|l| l.starts_with("  x ")).unwrap();
        assert_eq!(row.split_whitespace().collect::<Vec<_>>(), ["x", "±30.000", "mm", "±30.000", "mm"]);
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
        let text = report.table();
        let row = |start: &str| text.lines().find(|l| l.trim_start().starts_with(start)).unwrap();
        assert_eq!(
            row("x  ").split_whitespace().collect::<Vec<_>>(),
            ["x", "±0.00960", "m", "±0.00960", "m"]
        );
        assert!(row("seat").contains("within 0.00003 m of"), "{text}");
        for amount in ["±0.00080 m", "0.00032 m", "0.00064 m"] {
            assert!(text.contains(amount), "{text}");
        }
    }
}
