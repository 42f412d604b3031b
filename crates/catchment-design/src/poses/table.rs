//! A table of pose errors: CSV with a header, read completely or rejected with all its errors.

use super::fields::{records, spans};
use super::written::{Written, from_d, resolve};
use super::{OffsetsAt, defect, header, shortened};
use crate::design::{Design, Quantity, QuantityUnit};
use catchment_base::diagnostic::{Diagnostic, DiagnosticCollector, Diagnostics};
use catchment_base::pose::{Dof, PoseError};
use catchment_base::suggest::number_help;
use csv::StringRecord;
use std::ops::Range;

/// Most poses of a table: minutes of computing, and far below any memory.
pub const MOST_POSES: usize = 1_000_000;
/// Largest number of columns of a table: five are errors, and a table with more than this is another kind of
/// file.
const MOST_COLUMNS: usize = 1000;

/// A table of pose errors that was read.
#[derive(Debug)]
pub struct PoseTable<'a> {
    text: &'a str,
    design: &'a Design,
    at: OffsetsAt,
    columns: Columns,
    errors: Vec<PoseError>,
}

/// The column of each error in the order of [`Dof::ALL`], if present.
type Columns = [Option<Column>; 5];

/// A column that holds an error.
#[derive(Debug, Clone)]
struct Column {
    index: usize,
    name: String,
    unit: QuantityUnit,
}

impl<'a> PoseTable<'a> {
    /// Reads a table whose offsets are measured `at` a point. The header names the columns x, y, roll, pitch
    /// and yaw in any order, in D and radians or in the unit that follows: `x_mm`, `x [mm]`, `x (mm)`.
    /// Missing errors are 0. Other columns are passed through, unless their names are near those of errors.
    ///
    /// # Errors
    /// All errors of the text, of which the first 20 are given in full. More than 1000 columns or
    /// [`MOST_POSES`] rows are not read. A locked error with another value than its lock is reported once.
    pub fn parse(text: &'a str, design: &'a Design, at: OffsetsAt) -> Result<Self, Diagnostics> {
        Self::parse_beside(text, design, at, &[])
    }

    /// The same of a table with columns of these names, which its reader knows: they are no errors.
    pub(super) fn parse_beside(
        text: &'a str,
        design: &'a Design,
        at: OffsetsAt,
        known: &[&str],
    ) -> Result<Self, Diagnostics> {
        let mut result = DiagnosticCollector::default();
        let mut rows = records(text);
        let Some((start, names)) = rows.next() else {
            return Err(empty("the table is empty"));
        };
        let width = names.len();
        if width > MOST_COLUMNS {
            let fault = defect(
                format!("{width} columns"),
                format!("a table has at most {MOST_COLUMNS}; is it one of poses?"),
            );
            result.push_at(fault, || spans(text, start).into_iter().next());
            return Err(result.sorted());
        }
        if width == 1 && names[0].contains([';', '\t']) {
            let fault = defect("one column alone", "separate the columns with commas");
            result.push_at(fault, || spans(text, start).into_iter().next());
            return Err(result.sorted());
        }
        let columns = columns(&names, &spans(text, start), design, known, &mut result);
        let mut errors = Vec::new();
        let mut locked_before = [false; 5];
        for (start, record) in rows {
            if record.len() != width {
                let message = format!("{} values under {width} column names", record.len());
                let help = "every row has as many values as the header has names";
                result.push_at(defect(message, help), || whole(&spans(text, start)));
            } else if errors.len() == MOST_POSES {
                let fault = defect(format!("more than {MOST_POSES} poses"), "split the table");
                result.push_at(fault, || spans(text, start).into_iter().next());
                break;
            } else {
                let error = row(&record, &columns, at, design).unwrap_or_else(|faults| {
                    // Once for all diagnostics to the row, and only if there are any.
                    let spans = spans(text, start);
                    for (dof, fault, locked) in faults {
                        let stated = locked && std::mem::replace(&mut locked_before[dof.index()], true);
                        if !stated {
                            let column = columns[dof.index()].as_ref();
                            result.push_at(fault, || column.map(|column| spans[column.index].clone()));
                        }
                    }
                    PoseError::default()
                });
                errors.push(error);
            }
        }
        if errors.is_empty() && result.is_empty() {
            return Err(empty("the table has no rows"));
        }
        result.refuse()?;
        Ok(Self { text, design, at, columns, errors })
    }

    /// The text that was read.
    pub const fn text(&self) -> &str {
        self.text
    }

    /// The pose errors of the face centre, for each row, in D and radians.
    pub fn errors(&self) -> &[PoseError] {
        &self.errors
    }

    /// The point at which offsets were measured.
    pub const fn offsets_at(&self) -> OffsetsAt {
        self.at
    }

    /// The header as it was written.
    pub fn header(&self) -> Vec<String> {
        self.records().next().map_or_else(Vec::new, |names| names.iter().map(ToOwned::to_owned).collect())
    }

    /// The cells of every row as they were written.
    pub fn rows(&self) -> impl Iterator<Item = Vec<String>> {
        self.records().skip(1).map(|record| record.iter().map(ToOwned::to_owned).collect())
    }

    /// The columns that are carried through: their place and name. No name steers a terminal.
    pub fn carried(&self) -> Vec<(usize, String)> {
        let is_error = |k: usize| self.columns.iter().flatten().any(|column| column.index == k);
        self.header().into_iter().enumerate().filter(|(k, _)| !is_error(*k)).collect()
    }

    /// Whether a column of this error was written.
    pub(super) const fn has(&self, dof: Dof) -> bool {
        self.columns[dof.index()].is_some()
    }

    /// Names of the error columns, in the order of [`Dof::ALL`]; the plain name of a missing column.
    pub fn names(&self) -> [&str; 5] {
        Dof::ALL.map(|dof| self.columns[dof.index()].as_ref().map_or(dof.name(), |column| &column.name))
    }

    /// A pose error (of the face centre, in D and radians) in the units of the table's columns and at its point, in the
    /// order of [`Dof::ALL`].
    pub fn in_units(&self, error: &PoseError) -> [f64; 5] {
        let mut values = self.at.measure(error, &self.design.alignment).to_array();
        for (value, column) in values.iter_mut().zip(&self.columns) {
            match column.as_ref().map_or(QuantityUnit::Bare, |column| column.unit) {
                QuantityUnit::Degrees => *value = value.to_degrees(),
                unit => *value = from_d(*value, unit, self.design),
            }
        }
        values
    }

    fn records(&self) -> impl Iterator<Item = StringRecord> {
        records(self.text).map(|(_, record)| record)
    }
}

fn empty(message: &str) -> Diagnostics {
    defect(message, "write a header such as x,pitch_deg and one row per pose").into()
}

/// The bytes from the first field to the last.
fn whole(spans: &[Range<usize>]) -> Option<Range<usize>> {
    Some(spans.first()?.start..spans.last()?.end)
}

/// Finds the columns of the errors.
fn columns(
    names: &StringRecord,
    spans: &[Range<usize>],
    design: &Design,
    known: &[&str],
    result: &mut DiagnosticCollector,
) -> Columns {
    let mut columns = Columns::default();
    let mut wrong = false;
    for (index, name) in names.iter().enumerate().filter(|(_, name)| !known.contains(name)) {
        let fault = match header::column(name, design) {
            Ok(None) => continue,
            Ok(Some((dof, unit))) => {
                let place = &mut columns[dof.index()];
                let Some(first) = place else {
                    *place = Some(Column { index, name: name.to_owned(), unit });
                    continue;
                };
                let message = format!("a second column for {}, after {}", dof.name(), first.name);
                defect(message, "keep one of them")
            }
            Err(fault) => fault,
        };
        wrong = true;
        result.push_at(fault, || spans.get(index).cloned());
    }
    if columns.iter().all(Option::is_none) && !wrong {
        let help = "the first line names the columns: x, y, roll, pitch, yaw, in D and radians, or with a unit as in \
                    x_mm and pitch_deg";
        result.push_at(defect("no column is a pose error", help), || whole(spans));
    }
    columns
}

/// The pose error of a row, or its error and whether that is about a lock.
fn row(
    record: &StringRecord,
    columns: &Columns,
    at: OffsetsAt,
    design: &Design,
) -> Result<PoseError, Vec<(Dof, Diagnostic, bool)>> {
    let mut written = Written::default();
    let mut faults = Vec::new();
    for (dof, column) in Dof::ALL.into_iter().zip(columns) {
        let Some(Column { index, unit, .. }) = column else { continue };
        match number(&record[*index]) {
            Ok(value) => written[dof.index()] = Some(Quantity { value, unit: *unit }),
            Err(fault) => faults.push((dof, fault, false)),
        }
    }
    let locked = |dof: Dof| !design.alignment.free.contains(dof);
    if faults.iter().any(|(dof, ..)| dof.is_rotation()) {
        // The target of a locked offset depends on the rotation.
        OffsetsAt::LATERAL.into_iter().filter(|dof| locked(*dof)).for_each(|dof| written[dof.index()] = None);
    }
    match resolve(&written, at, design) {
        Ok(error) if faults.is_empty() => Ok(error),
        resolved => {
            let more = resolved.err().into_iter().flatten();
            faults.extend(more.map(|(dof, fault)| (dof, fault, locked(dof))));
            Err(faults)
        }
    }
}

fn number(text: &str) -> Result<f64, Diagnostic> {
    if text.is_empty() {
        return Err(defect("a value is missing", "write 0 for an error that does not occur"));
    }
    let value: f64 = text.parse().map_err(|_| {
        let help = number_help(text).unwrap_or_else(|| {
            "a number with a decimal point; its unit belongs into the name of the column, as in x_mm"
                .to_owned()
        });
        defect(format!("`{}` is no number", shortened(text)), help)
    })?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(defect(format!("`{}` is not finite", shortened(text)), "leave the row out"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;
    use std::time::{Duration, Instant};

    fn design() -> Design {
        let text = "[connector]\nfamily = \"pyramid\"\nwidth = 50\nunit = \"mm\"\n[alignment]\n\
                    free = [\"x\", \"pitch\"]\ncenter_of_rotation = 0.5\n";
        crate::design::read(text, Path::new("")).unwrap().design
    }

    /// The places and messages of the errors.
    fn wrong(text: &str) -> Vec<(String, String)> {
        let refusal = PoseTable::parse(text, &design(), OffsetsAt::Face).unwrap_err();
        let place = |span: Option<Range<usize>>| text[span.unwrap_or(0..0)].to_owned();
        refusal.list.into_iter().map(|o| (place(o.span), o.message)).collect()
    }

    #[test]
    fn units_come_from_the_header_and_rows_may_be_quoted() {
        let text = "id,pitch (deg),\"x [mm]\"\r\n\r\n\"a,1\",90, 5 \r\nb,-180,\"-2.5\"\r\n";
        let design = design();
        let table = PoseTable::parse(text, &design, OffsetsAt::Face).unwrap();
        let errors = table.errors();
        assert_eq!(errors.len(), 2);
        assert_eq!(errors[0].pitch, 90f64.to_radians());
        // A multiplication and a division.
        assert!((errors[0].x - 0.1).abs() < 1e-15 && (errors[1].x + 0.05).abs() < 1e-15);
        assert_eq!(table.names(), ["x [mm]", "y", "roll", "pitch (deg)", "yaw"]);
        assert_eq!(table.carried(), [(0, "id".to_owned())]);
        assert_eq!(table.rows().next().unwrap(), ["a,1", "90", "5"]);
        let back = table.in_units(&errors[1]);
        assert!((back[0] + 2.5).abs() < 1e-12 && (back[3] + 180.0).abs() < 1e-12);
    }

    #[test]
    fn a_pose_comes_back_at_the_point_where_it_was_measured() {
        let design = design();
        let table = PoseTable::parse("x_mm,pitch,y_mm\n5,0.3,0\n", &design, OffsetsAt::Cor).unwrap();
        let error = table.errors()[0];
        // The face centre is cor·sin(pitch) beside the centre of rotation; two roundings.
        assert!((error.x - 0.1 - 0.5 * 0.3f64.sin()).abs() < 1e-15);
        let back = table.in_units(&error);
        assert!((back[0] - 5.0).abs() < 1e-12 && back[1] == 0.0 && back[3] == 0.3);
    }

    #[test]
    fn every_cell_is_complained_about_in_its_place() {
        let result = wrong("x,pitch,y\n1,2\nnan,,0\n1e9,4,0.5\n0,0,0.5\n0,0,0.6\n1 mm,0,0\n");
        let cells: Vec<&str> = result.iter().map(|(cell, _)| cell.as_str()).collect();
        // The second value of the locked y adds no new error.
        assert_eq!(cells, ["1,2", "nan", "", "1e9", "4", "0.5", "1 mm"]);
        assert_eq!(wrong("x_ft,Pitch,rol,x,x_mm,final_x\n0,0,0,0,0,0\n").len(), 5);
        assert_eq!(wrong("time,part\n1,2\n")[0].1, "no column is a pose error");
        assert_eq!(wrong("")[0].1, "the table is empty");
        assert_eq!(wrong("x\n\n")[0].1, "the table has no rows");
        assert_eq!(wrong(&("x\n".to_owned() + &"?\n".repeat(50))).len(), Diagnostics::MOST);
    }

    #[test]
    fn wide_tables_take_no_more_time_than_their_bytes() {
        let begin = Instant::now();
        let header = "x,".to_owned() + &"a,".repeat(500_000) + "a";
        assert_eq!(wrong(&format!("{header}\n{header}\n"))[0].1, "500002 columns");
        // As many columns as there may be, each cell of many rows wrong.
        let header = "x,".to_owned() + &"dx,".repeat(998) + "pitch";
        let rows = (",".repeat(999) + "\n").repeat(10_000);
        assert_eq!(wrong(&format!("{header}\n{rows}")).len(), Diagnostics::MOST);
        // Looking for each cell from the start of its record takes minutes.
        assert!(begin.elapsed() < Duration::from_secs(20), "{:?}", begin.elapsed());
    }
}
