//! The accuracy table as text, as a page of the documentation, and as records.

use crate::study::accuracy::{Accuracy, AccuracyEntry, AccuracyRow, SumSource};
use std::fmt::{self, Write};

impl AccuracyRow {
    /// The entries of one resolution, in the order of [`SumSource::all`].
    fn by_resolution(&self) -> impl Iterator<Item = &[AccuracyEntry]> {
        self.entries.chunk_by(|a, b| a.resolution == b.resolution)
    }

    /// Half-width of the exact Sum's interval, as a share of the Sum.
    fn doubt(&self) -> f64 {
        let [lo, hi] = self.exact.ci95;
        0.5 * (hi - lo) / self.exact.sum
    }
}

impl fmt::Display for Accuracy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Sum by each method, and how far it is off the exact Sum")?;
        for row in &self.rows {
            let e = &row.exact;
            writeln!(f, "\n{} ({})", row.name, row.free.join(", "))?;
            let poses = format!("{} descents", e.descents);
            writeln!(f, "  exact {:.4} {} ± {:.2} %, {poses}", e.sum, e.unit, 100.0 * row.doubt())?;
            write!(f, "  per axis")?;
            for way in SumSource::all() {
                write!(f, "{:>22}", way.name())?;
            }
            writeln!(f)?;
            for entries in row.by_resolution() {
                write!(f, "  {:>8}", entries.first().map_or(0, |e| e.resolution))?;
                for way in SumSource::all() {
                    match entries.iter().find(|e| e.way == way) {
                        Some(e) => write!(f, "{:>12.4} {:>7} %", e.sum, percent(e.error))?,
                        None => write!(f, "{:>22}", "–")?,
                    }
                }
                writeln!(f)?;
            }
        }
        Ok(())
    }
}

impl Accuracy {
    /// The page of the documentation; `how` states the computing effort.
    ///
    /// # Errors
    /// Never fails: it writes to a string.
    pub fn markdown(&self, how: &str) -> Result<String, fmt::Error> {
        let mut page = String::from(
            "# Accuracy\n\n\
             By how much does the Sum of each method differ from the exact one? On designs from planar to five errors (terms: [glossary](glossary.md)). Other designs may differ more. Written by\n\n    \
             catchment reproduce accuracy --markdown > docs/accuracy.md\n\n",
        );
        writeln!(page, "{how}\n")?;
        page.push_str(
            "- **exact**: the finest grid of confluence, corrected by 100 000 random poses that are followed exactly; unbiased, with\n  \
             its 95 % interval. An error smaller than that interval is not shown to be one.\n\
             - **confluence**, **descent**, **flood**: the measure of the accepted cells. For the first two the error is that of resolution alone: every\n  \
             cell's centre is right, or nearly every one (second table). That of flooding does not go away with resolution, because water flows along the directions\n  \
             of the grid. Descent is left out beyond 400 000 cells. Where centres of cells lie on the border of the set (the pyramid over x, y and yaw, whose border is at\n  \
             x = ±½, at 30 cells per axis), a whole row of them counts or does not.\n\
             - **transport**: the mean arrival fraction over the grid.\n\
             - **corrected**: confluence's grid corrected by as many exact descents as `run` uses, with half its own 95 % interval.\n\n",
        );
        let ways = SumSource::all();
        write!(page, "| design | exact Sum | cells per axis |")?;
        for way in &ways {
            write!(page, " {} |", way.name())?;
        }
        writeln!(page, "\n|---|---|---:|{}", "---:|".repeat(ways.len()))?;
        for row in &self.rows {
            let exact = format!("{:.4} {} ± {:.2} %", row.exact.sum, row.exact.unit, 100.0 * row.doubt());
            for (k, entries) in row.by_resolution().enumerate() {
                let resolution = entries.first().map_or(0, |e| e.resolution);
                if k == 0 {
                    write!(page, "| {}; {} | {exact} | {resolution} |", row.name, row.free.join(", "))?;
                } else {
                    write!(page, "| | | {resolution} |")?;
                }
                for way in &ways {
                    match entries.iter().find(|e| e.way == *way) {
                        Some(e) => write!(page, " {} %{} |", percent(e.error), doubt(e))?,
                        None => write!(page, " – |")?,
                    }
                }
                writeln!(page)?;
            }
        }
        page.push_str("\nThe worst and the typical error at the finest resolution of each design:\n\n");
        writeln!(page, "| method | worst | median | time of all designs |\n|---|---:|---:|---:|")?;
        for way in &ways {
            let finest = |row: &AccuracyRow| -> Option<AccuracyEntry> {
                row.entries.iter().rev().find(|e| e.way == *way).cloned()
            };
            let mut errors: Vec<f64> = self.rows.iter().filter_map(finest).map(|e| e.error).collect();
            errors.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
            let seconds: f64 = self.rows.iter().filter_map(finest).map(|e| e.seconds).sum();
            if let (Some(worst), Some(median)) = (errors.last(), errors.get(errors.len() / 2)) {
                let (worst, median) = (percent(*worst), format!("{:.2}", 100.0 * median.abs()));
                writeln!(page, "| {} | {worst} % | {median} % | {seconds:.1} s |", way.name())?;
            }
        }
        page.push_str("\n## Labels of single cells\n\nCells drawn at random, each beside the exact motion of its own centre.\n\n");
        page.push_str("| design | cells per axis | drawn | accepted wrongly, or not | any other outcome | jams lost | labelled in |\n|---|---:|---:|---:|---:|---:|---:|\n");
        for l in &self.labels {
            let share = |count: usize, of: usize| 100.0 * count as f64 / of.max(1) as f64;
            writeln!(
                page,
                "| {} | {} | {} | {} ({:.4} %) | {} ({:.4} %) | {} of {} ({:.2} %) | {:.1} s |",
                l.name,
                l.resolution,
                l.drawn,
                l.accepted_wrong,
                share(l.accepted_wrong, l.drawn),
                l.wrong,
                share(l.wrong, l.drawn),
                l.jams_lost,
                l.jams,
                share(l.jams_lost, l.jams),
                l.seconds,
            )?;
        }
        Ok(page)
    }

    /// Every entry as a record for programs, after a header record.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head =
            "design free unit exact exact_from exact_to method resolution cells sum error doubt seconds";
        let mut records = vec![head.split(' ').map(str::to_owned).collect::<Vec<String>>()];
        for row in &self.rows {
            let [lo, hi] = row.exact.ci95;
            for e in &row.entries {
                let mut record = vec![row.name.clone(), row.free.join("-"), row.exact.unit.clone()];
                record.extend([row.exact.sum, lo, hi].map(|v| v.to_string()));
                record.push(e.way.name().to_owned());
                record.extend([e.resolution, e.cells].map(|n| n.to_string()));
                record.extend([e.sum, e.error].map(|v| v.to_string()));
                record.push(e.doubt.map_or_else(String::new, |half| half.to_string()));
                record.push(e.seconds.to_string());
                records.push(record);
            }
        }
        records
    }
}

/// ` (± 0.5)`, for a Sum with an interval of its own.
fn doubt(entry: &AccuracyEntry) -> String {
    entry.doubt.map_or_else(String::new, |half| format!(" (± {:.1})", 100.0 * half))
}

/// A share as a signed percentage.
fn percent(share: f64) -> String {
    let text = format!("{:+.2}", 100.0 * share);
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use crate::study::accuracy::{CASES, Case, SumSource, run};
    use catchment::design::Family;
    use catchment::exec::Exec;
    use catchment::pose::Dof;

    #[test]
    fn the_cases_cover_the_stated_range() {
        let has = |test: &dyn Fn(&Case) -> bool| CASES.iter().filter(|case| test(case)).count();
        assert!(CASES.len() >= 8);
        for errors in [2, 3, 5] {
            assert!(has(&|case| case.free.len() == errors) >= 2, "{errors}");
        }
        assert!(has(&|c| c.center_of_rotation == -1.0) >= 1 && has(&|c| c.center_of_rotation == 1.0) >= 1);
        assert!(has(&|case| case.resolutions().iter().all(|n| n % 2 == 0)) == CASES.len());
    }

    #[test]
    fn the_table_has_every_method_at_every_resolution() {
        // Translation alone: quick, and every method agrees with the closed form of the V-Face, 1 D.
        let case = Case {
            family: Family::VFace,
            aspect_ratio: 1.0,
            center_of_rotation: 0.0,
            rotation_length: 1.0,
            free: &[Dof::X],
        };
        let table = run(&[case], &[(case, 9)], 100, &Exec::new()).unwrap();
        let labels = &table.labels[0];
        // No cell jams, so that the number of draws reaches its maximum.
        assert_eq!((labels.drawn, labels.jams, labels.wrong, labels.resolution), (800, 0, 0, 9));
        let ways = SumSource::all().len();
        assert_eq!(table.rows[0].entries.len(), 3 * ways);
        assert!(table.rows[0].entries.iter().all(|e| e.error.abs() < 0.05), "{table:?}");
        let (text, page) = (table.to_string(), table.markdown("In no time.").unwrap());
        for name in ["confluence", "descent", "flood", "transport", "corrected"] {
            assert!(text.contains(name) && page.contains(&format!("| {name} |")), "{name}");
        }
        assert!(page.contains("| v-face, AR 1, COR 0, ρ 1; x | ") && page.contains("In no time."));
        assert_eq!(table.records().len(), 1 + 3 * ways);
    }
}
