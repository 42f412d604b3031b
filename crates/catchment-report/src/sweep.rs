//! A sweep as versioned JSON, as a table, as records for programs.

use super::envelope::{Body, Envelope};
use super::schema::Timing;
use super::table::heading;
use super::text::{grouped, line, number, percent, row, significant, with_error, wrapped};
use catchment_core::design::Design;
use catchment_study::sweep::{Figures, Found, Sweep, Trial};
use serde::Serialize;
use std::collections::BTreeMap;

/// What a sweep has to say, with its head.
pub type SweepReport = Envelope<SweepBody>;

/// What a sweep has to say.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepBody {
    /// The design as its file has it, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// Every combination and what it is worth.
    #[serde(flatten)]
    pub found: Sweep,
}

impl Body for SweepBody {
    const KIND: &'static str = "sweep";
}

/// Columns of a matrix in a table of 80 columns.
const WIDEST_MATRIX: usize = 6;
/// Lines of a list; a longer one is for programs.
const LONGEST_LIST: usize = 40;

impl SweepReport {
    /// Of a design.
    pub fn new(design: &Design, found: Sweep, timing: Option<Timing>) -> Self {
        Self::of(SweepBody { design: design.clone(), found }, Vec::new(), timing)
    }

    /// The unit of every Sum.
    pub fn unit(&self) -> &str {
        let figures = self.found.designs.iter().find_map(|trial| trial.found.figures());
        figures.map_or("", |figures| &figures.unit)
    }

    /// ▲ the largest Sum, ▼ the smallest.
    pub(super) fn mark(&self, number: usize) -> &'static str {
        match number {
            _ if self.found.largest == Some(number) => "▲",
            _ if self.found.smallest == Some(number) => "▼",
            _ => "",
        }
    }

    /// The values of a design in words: `aspect_ratio 0.5, center_of_rotation 1`.
    pub(super) fn named(&self, trial: &Trial) -> String {
        let axes = &self.found.settings.axes;
        axes.iter()
            .zip(&trial.values)
            .map(|(axis, v)| format!("{} {v}", axis.name()))
            .collect::<Vec<_>>()
            .join(", ")
    }

    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        let (found, unit) = (&self.found, self.unit());
        heading(&mut text, &self.design);
        for axis in &found.settings.axes {
            wrapped(&mut text, &format!("  {:<20}", axis.name()), &axis.values.join(", "));
        }
        let count = grouped(found.designs.len());
        row(&mut text, "designs", &format!("{count}, each by {}", found.settings.run.method.name()));
        text.push('\n');
        match &found.settings.axes[..] {
            [_, columns] if columns.values.len() <= WIDEST_MATRIX => self.matrix(&mut text),
            _ => self.list(&mut text),
        }
        text.push('\n');
        for (what, number) in [("largest Sum ▲", found.largest), ("smallest Sum ▼", found.smallest)] {
            if let Some((trial, figures)) =
                number.map(|k| &found.designs[k]).and_then(|t| Some((t, t.found.figures()?)))
            {
                let onaa =
                    figures.onaa_edge.map_or_else(String::new, |edge| format!(", ONAA edge {edge:.4}"));
                row(
                    &mut text,
                    what,
                    &format!("{} {unit}, {}{onaa}", sum(figures), percent(figures.fraction)),
                );
                wrapped(&mut text, &" ".repeat(17), &self.named(trial));
            }
        }
        self.doubts(&mut text);
        text
    }

    /// The Sum over two axes, rows by the first.
    fn matrix(&self, text: &mut String) {
        let [rows, columns] = &self.found.settings.axes[..] else { return };
        let cell = |content: &str, mark: &str| format!("{content:>9}{mark:<1}");
        line(text, &format!("  Sum [{}]; rows {}, columns {}", self.unit(), rows.name(), columns.name()));
        let head: String = columns.values.iter().map(|value| cell(value, "")).collect();
        line(text, &format!("  {:<13}{head}", ""));
        for (j, value) in rows.values.iter().enumerate() {
            let cells: String = (0..columns.values.len())
                .map(|k| {
                    let number = j * columns.values.len() + k;
                    let figures = self.found.designs[number].found.figures();
                    cell(&figures.map_or("–".to_owned(), |f| significant(f.sum)), self.mark(number))
                })
                .collect();
            line(text, &format!("  {value:<13}{cells}"));
        }
    }

    /// A line per design.
    fn list(&self, text: &mut String) {
        line(text, &format!("  {:<46}{:>20}    share", "", format!("Sum [{}]", self.unit())));
        for (number, trial) in self.found.designs.iter().enumerate().take(LONGEST_LIST) {
            let values = trial.values.join("  ");
            match &trial.found {
                Found::Figures(f) => {
                    let share = percent(f.fraction);
                    line(text, &format!("  {values:<46}{:>20}{:<1} {share:>8}", sum(f), self.mark(number)));
                }
                Found::Refused(_) => line(text, &format!("  {values:<46}{:>20}", "–")),
            }
        }
        let more = self.found.designs.len().saturating_sub(LONGEST_LIST);
        if more > 0 {
            line(text, &format!("  … and {} more, in JSON and CSV", grouped(more)));
        }
    }

    /// What could not be computed, and what speaks against the numbers, each said once.
    fn doubts(&self, text: &mut String) {
        let mut said: BTreeMap<(bool, &str), Vec<String>> = BTreeMap::new();
        for trial in &self.found.designs {
            match &trial.found {
                Found::Refused(reason) => said.entry((false, reason)).or_default().push(self.named(trial)),
                Found::Figures(figures) => {
                    for warning in &figures.warnings {
                        said.entry((true, warning)).or_default().push(self.named(trial));
                    }
                }
            }
        }
        if !said.is_empty() {
            text.push('\n');
        }
        let mut omitted = 0;
        for (number, ((computed, sentence), designs)) in said.iter().enumerate() {
            if number >= LONGEST_LIST / 4 {
                omitted += designs.len();
                continue;
            }
            let more = match designs.len() {
                1 => String::new(),
                n => format!(" and {} more", n - 1),
            };
            let first = if *computed { "warning: " } else { "not computed: " };
            wrapped(text, first, &format!("{}{more}: {sentence}", designs[0]));
        }
        if omitted > 0 {
            line(text, &format!("and {} more, in JSON and CSV", grouped(omitted)));
        }
    }

    /// Every design as a record for programs, the names of the columns first.
    pub fn records(&self) -> Vec<Vec<String>> {
        let found = &self.found;
        let mut head: Vec<String> = found.settings.axes.iter().map(|axis| axis.key.clone()).collect();
        head.extend(["sum", "sum_lo", "sum_hi", "fraction", "onaa_edge", "centered_edge"].map(str::to_owned));
        let errors: Vec<_> = found
            .designs
            .iter()
            .find_map(|trial| trial.found.figures())
            .map_or_else(Vec::new, |figures| figures.tolerances.iter().map(|along| along.axis).collect());
        head.extend(errors.iter().flat_map(|e| ["minus", "plus"].map(|side| format!("{}_{side}", e.name()))));
        head.extend(["success", "warnings", "refused"].map(str::to_owned));
        let mut records = vec![head];
        for trial in &found.designs {
            let mut record = trial.values.clone();
            let optional = |value: Option<f64>| value.map_or_else(String::new, number);
            match &trial.found {
                Found::Figures(f) => {
                    let [lo, hi] = f.sum_ci95.map_or([None; 2], |ci| ci.map(Some));
                    record.push(number(f.sum));
                    record.extend([lo, hi, Some(f.fraction), f.onaa_edge, f.centered_edge].map(optional));
                    for error in &errors {
                        let along = f.tolerances.iter().find(|along| along.axis == *error);
                        record.extend([along.map(|a| a.minus), along.map(|a| a.plus)].map(optional));
                    }
                    record.extend([optional(f.success), f.warnings.join("; "), String::new()]);
                }
                Found::Refused(reason) => {
                    record.extend(vec![String::new(); 6 + 2 * errors.len() + 2]);
                    record.push(reason.clone());
                }
            }
            records.push(record);
        }
        records
    }
}

/// `2.387 ± 0.021`, or without the interval where there is none.
fn sum(figures: &Figures) -> String {
    figures.sum_ci95.map_or_else(|| significant(figures.sum), |ci95| with_error(figures.sum, ci95))
}

#[cfg(all(feature = "figure", feature = "zarr"))]
mod kept {
    //! Finished designs in a folder beside the result, until that is complete.

    use crate::write;
    use catchment_study::sweep::{Found, Keep};
    use std::collections::BTreeSet;
    use std::fs;
    use std::io;
    use std::path::{Path, PathBuf};

    /// What stands behind the name of the result.
    const ENDING: &str = ".parts";
    /// Digits of a key.
    const DIGITS: usize = 64;
    /// Largest file that is read back.
    const LARGEST: u64 = 64 << 20;

    /// `OUT.parts`, which holds a JSON file per finished design, named by the digest of all that its figures depend on. A file that
    /// cannot be read is as good as none: the design is computed again.
    #[derive(Debug, Clone)]
    pub struct Parts {
        folder: PathBuf,
    }

    impl Parts {
        /// The parts of a result.
        pub fn beside(result: &Path) -> Self {
            let mut name = result.file_name().unwrap_or_default().to_owned();
            name.push(ENDING);
            Self { folder: result.with_file_name(name) }
        }

        /// The folder.
        pub fn folder(&self) -> &Path {
            &self.folder
        }

        fn file(&self, key: &str) -> PathBuf {
            self.folder.join(format!("{key}.json"))
        }

        /// How many designs are kept.
        pub fn count(&self) -> usize {
            self.places().iter().filter(|place| place.exists()).count()
        }

        /// Where designs are kept, or were to be kept by a process that was killed meanwhile.
        fn places(&self) -> BTreeSet<PathBuf> {
            let Ok(entries) = fs::read_dir(&self.folder) else { return BTreeSet::new() };
            let place = |name: &str| {
                let (key, _) = name.strip_prefix('.').unwrap_or(name).split_once(".json")?;
                let is_key = key.len() == DIGITS && key.bytes().all(|b| b.is_ascii_hexdigit());
                is_key.then(|| self.file(key))
            };
            entries.filter_map(|entry| place(entry.ok()?.file_name().to_str()?)).collect()
        }

        /// Removes them, what killed processes left of them, and the folder if nothing else is in it.
        pub fn clear(&self) {
            for place in self.places() {
                // Kept for the next time if it cannot be removed.
                let _ = fs::remove_file(&place);
                let _ = write::sweep(&place);
            }
            let _ = fs::remove_dir(&self.folder);
        }
    }

    impl Keep for Parts {
        fn find(&self, key: &str) -> Option<Found> {
            let path = self.file(key);
            let small = fs::metadata(&path).is_ok_and(|of| of.is_file() && of.len() <= LARGEST);
            small.then(|| serde_json::from_slice(&fs::read(path).ok()?).ok())?
        }

        fn keep(&self, key: &str, found: &Found) -> io::Result<()> {
            fs::create_dir_all(&self.folder)?;
            let text = serde_json::to_vec(found)?;
            write::file(&self.file(key), &text, true).map_err(io::Error::other)
        }
    }

    #[cfg(test)]
    mod tests {
        use super::*;
        use crate::write::faults::{self, Fault};

        #[test]
        fn what_is_kept_is_found_and_what_is_spoilt_is_not() {
            let home = tempfile::tempdir().unwrap();
            let parts = Parts::beside(&home.path().join("out"));
            let (key, found) = ("a".repeat(DIGITS), Found::Refused("no".to_owned()));
            assert_eq!(parts.find(&key), None);
            parts.keep(&key, &found).unwrap();
            assert_eq!((parts.find(&key), parts.count()), (Some(found), 1));
            fs::write(parts.file(&key), "{\"figures\":").unwrap();
            assert_eq!(parts.find(&key), None);
            fs::write(parts.folder().join("mine.txt"), "mine").unwrap();
            parts.clear();
            assert_eq!(fs::read_dir(parts.folder()).unwrap().count(), 1, "what is not ours stays");
            fs::remove_file(parts.folder().join("mine.txt")).unwrap();
            parts.clear();
            assert!(!parts.folder().exists());
        }

        #[test]
        fn what_a_killed_process_left_goes_with_it() {
            let home = tempfile::tempdir().unwrap();
            let parts = Parts::beside(&home.path().join("out"));
            let (key, found) = ("b".repeat(DIGITS), Found::Refused("no".to_owned()));
            for after in 0.. {
                faults::set(home.path(), Fault::Crash, after, true);
                let kept = parts.keep(&key, &found).is_ok();
                if !faults::clear(home.path()) {
                    assert!(kept && after > 3);
                    break;
                }
                parts.clear();
                assert!(!parts.folder().exists(), "dead after {after} steps");
            }
        }
    }
}
#[cfg(all(feature = "figure", feature = "zarr"))]
pub use kept::Parts;
