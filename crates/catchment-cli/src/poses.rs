//! A table of pose errors: CSV with a header, read whole or refused with everything that is wrong with it.
//!
//! ```text
//!   part, x_mm, pitch_deg        x, y, roll, pitch, yaw, with the unit after an underscore where it is not D or rad
//!   A17,   2.5,        10        columns that are no pose error are carried through
//! ```

use crate::errors::{Objection, checked};
use crate::failure::Failure;
use catchment::problem::{Finding, Findings, SourceText};
use catchment::design::{Design, LengthUnit, Quantity, Unit, nearest};
use catchment::pose::{Dof, PoseError};
use csv::StringRecord;
use std::fs::File;
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;

/// Largest table, in bytes: read whole, so that its problems can be shown in place.
const LARGEST: u64 = 64 << 20;
/// Most poses: minutes of computing, and far below any memory.
const MOST_POSES: usize = 1_000_000;
/// Most problems that are spelled out.
const MOST_FINDINGS: usize = 20;
/// Units that a column's name may end in.
const UNITS: [(&str, Unit); 8] = [
    ("um", Unit::Length(LengthUnit::Um)),
    ("mm", Unit::Length(LengthUnit::Mm)),
    ("cm", Unit::Length(LengthUnit::Cm)),
    ("m", Unit::Length(LengthUnit::M)),
    ("in", Unit::Length(LengthUnit::In)),
    ("D", Unit::D),
    ("deg", Unit::Degrees),
    ("rad", Unit::Radians),
];

/// A table of pose errors that was read.
pub(crate) struct Poses {
    source: SourceText,
    /// The column of each error in the order of [`Dof::ALL`], where there is one.
    columns: [Option<Column>; 5],
    /// The pose errors, one per row, in D and radians.
    pub errors: Vec<PoseError>,
}

/// A column that holds an error.
#[derive(Debug, Clone)]
struct Column {
    index: usize,
    name: String,
    unit: Unit,
}

/// Problems, of which only the first are spelled out.
#[derive(Default)]
struct Found {
    list: Vec<Finding>,
    omitted: usize,
}

impl Found {
    fn push(&mut self, span: Range<usize>, objection: Objection) {
        if self.list.len() < MOST_FINDINGS {
            let Objection { message, help } = objection;
            self.list.push(Finding { message, help, span: Some(span) });
        } else {
            self.omitted += 1;
        }
    }
}

impl Poses {
    /// Reads a file, or stdin for `-`.
    pub(crate) fn read(path: &Path, design: &Design) -> Result<Self, Failure> {
        Self::parse(load(path)?, design).map_err(Failure::from)
    }

    fn parse(source: SourceText, design: &Design) -> Result<Self, Findings> {
        let mut found = Found::default();
        let mut columns = Default::default();
        let mut errors = Vec::new();
        let mut width = None;
        let mut locked_said = [false; 5];
        for (start, record) in records(&source.text) {
            let span = |k: usize| field(&source.text, start, k);
            let Some(width) = width else {
                width = Some(record.len());
                columns = header(&record, &span, design, &mut found);
                continue;
            };
            if record.len() != width {
                let row = span(0).start..span(record.len() - 1).end;
                let message = format!("{} values under {width} column names", record.len());
                found.push(
                    row,
                    Objection::new(message, "every row has as many values as the header has names"),
                );
                continue;
            }
            if errors.len() == MOST_POSES {
                let message = format!("more than {MOST_POSES} poses");
                found.push(span(0), Objection::new(message, "split the table"));
                break;
            }
            let mut error = [0.0; 5];
            for (k, (column, dof)) in columns.iter().zip(Dof::ALL).enumerate() {
                let Some(Column { index, unit, .. }) = column else { continue };
                let read = number(&record[*index]).and_then(|value| {
                    let locked = value != 0.0 && !design.alignment.free.contains(dof);
                    if locked && std::mem::replace(&mut locked_said[k], true) {
                        return Ok(0.0);
                    }
                    checked(dof, Quantity { value, unit: *unit }, design)
                });
                match read {
                    Ok(value) => error[k] = value,
                    Err(objection) => found.push(span(*index), objection),
                }
            }
            errors.push(PoseError::from_array(error));
        }
        if errors.is_empty() && found.list.is_empty() {
            let message = if width.is_none() { "the table is empty" } else { "the table has no rows" };
            let help = "write a header such as x,pitch_deg and one row per pose";
            found.list.push(Finding { message: message.to_owned(), help: Some(help.to_owned()), span: None });
        }
        found.list.sort_by_key(|finding| finding.span.as_ref().map(|span| span.start));
        if found.list.is_empty() {
            Ok(Self { source, columns, errors })
        } else {
            Err(Findings { source: Some(source), list: found.list, omitted: found.omitted })
        }
    }

    /// The header and the rows as they were written.
    pub(crate) fn records(&self) -> impl Iterator<Item = StringRecord> {
        records(&self.source.text).map(|(_, record)| record)
    }

    /// The columns that are carried through: their place and name.
    pub(crate) fn carried(&self) -> Vec<(usize, String)> {
        let header = self.records().next().unwrap_or_default();
        let is_error = |k: usize| self.columns.iter().flatten().any(|column| column.index == k);
        header.iter().enumerate().filter(|(k, _)| !is_error(*k)).map(|(k, n)| (k, n.to_owned())).collect()
    }

    /// Names of the columns of final pose errors, in the order of [`Dof::ALL`].
    pub(crate) fn final_names(&self) -> [String; 5] {
        final_names(&self.columns)
    }

    /// An error in the units of its column, in the order of [`Dof::ALL`].
    pub(crate) fn in_units(&self, error: &PoseError, design: &Design) -> [f64; 5] {
        let mut values = error.to_array();
        for (value, column) in values.iter_mut().zip(&self.columns) {
            match (column.as_ref().map(|column| column.unit), design.unit) {
                (Some(Unit::Degrees), _) => *value = value.to_degrees(),
                (Some(Unit::Length(unit)), Some(own)) => {
                    *value *= design.width * own.metres() / unit.metres();
                }
                _ => {}
            }
        }
        values
    }
}

fn final_names(columns: &[Option<Column>; 5]) -> [String; 5] {
    let name = |dof: Dof| columns[dof.index()].as_ref().map_or(dof.name(), |column| &column.name);
    Dof::ALL.map(|dof| format!("final_{}", name(dof)))
}

/// Reads the text of a file, or of stdin for `-`.
fn load(path: &Path) -> Result<SourceText, Failure> {
    let stdin = path.as_os_str() == "-";
    let shown = if stdin { Path::new("stdin") } else { path };
    let failed =
        |error: &io::Error| Failure::with_help(format!("cannot read {}: {error}", shown.display()), None);
    let mut bytes = Vec::new();
    let reader: &mut dyn Read =
        if stdin { &mut io::stdin().lock() } else { &mut File::open(path).map_err(|e| failed(&e))? };
    reader.take(LARGEST + 1).read_to_end(&mut bytes).map_err(|e| failed(&e))?;
    if bytes.len() as u64 > LARGEST {
        let message = format!("{} is larger than {} MiB", shown.display(), LARGEST >> 20);
        return Err(Failure::with_help(message, Some("split the table".to_owned())));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..valid].split(|b| *b == b'\n').count();
        let help = Some("save it as UTF-8".to_owned());
        Failure::with_help(format!("{}, line {line}: not UTF-8 text", shown.display()), help)
    })?;
    // Spreadsheets begin with a byte order mark.
    let text = text.strip_prefix('\u{feff}').map(ToOwned::to_owned).unwrap_or(text);
    Ok(SourceText::new(shown, text))
}

/// The records of a table, each with the byte it starts at. Blank lines are none.
fn records(text: &str) -> impl Iterator<Item = (usize, StringRecord)> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    std::iter::from_fn(move || {
        let mut record = StringRecord::new();
        // Text in memory that is UTF-8 and may be ragged has nothing left to fail on.
        reader.read_record(&mut record).ok().filter(|more| *more)?;
        let start = record.position().map_or(0, |p| p.byte() as usize).min(text.len());
        let blank = text[start..].bytes().take_while(|b| matches!(b, b'\r' | b'\n')).count();
        Some((start + blank, record))
    })
}

/// The bytes of the `k`-th field of the record at `start`, without the blanks around it.
fn field(text: &str, start: usize, k: usize) -> Range<usize> {
    let bytes = text.as_bytes();
    let (mut from, mut at, mut seen, mut quoted) = (start, start, 0, false);
    while at < bytes.len() {
        match bytes[at] {
            b'"' => quoted = !quoted,
            b',' if !quoted => {
                if seen == k {
                    break;
                }
                seen += 1;
                from = at + 1;
            }
            b'\r' | b'\n' if !quoted => break,
            _ => {}
        }
        at += 1;
    }
    let inside = &text[from..at];
    let end = from + inside.trim_end().len();
    let begin = from + (inside.len() - inside.trim_start().len());
    if begin < end { begin..end } else { from..at }
}

/// Finds the columns of the errors.
fn header(
    record: &StringRecord,
    span: &impl Fn(usize) -> Range<usize>,
    design: &Design,
    found: &mut Found,
) -> [Option<Column>; 5] {
    let mut columns: [Option<Column>; 5] = Default::default();
    let mut wrong = false;
    for (index, name) in record.iter().enumerate() {
        match column(name, design) {
            Ok(None) => {}
            Ok(Some((dof, unit))) => {
                let place = &mut columns[dof.index()];
                if let Some(first) = place {
                    let message = format!("a second column for {}, after {}", dof.name(), first.name);
                    found.push(span(index), Objection::new(message, "keep one of them"));
                } else {
                    *place = Some(Column { index, name: name.to_owned(), unit });
                }
            }
            Err(objection) => {
                wrong = true;
                found.push(span(index), objection);
            }
        }
    }
    if columns.iter().all(Option::is_none) && !wrong {
        let help = if record.len() == 1 && record[0].contains([';', '\t']) {
            "separate the columns with commas"
        } else {
            "the first line names the columns: x, y, roll, pitch, yaw, in D and radians, or with a unit as in \
             x_mm and pitch_deg"
        };
        found.push(
            span(0).start..span(record.len() - 1).end,
            Objection::new("no column is a pose error", help),
        );
    }
    let ours = final_names(&columns);
    for (index, name) in record.iter().enumerate() {
        if name == "outcome" || ours.iter().any(|final_name| final_name == name) {
            let message = format!("`{name}` is a column that the answer adds");
            found.push(span(index), Objection::new(message, "rename it"));
        }
    }
    columns
}

/// The error and the unit that a column holds; `None` for one that is carried through.
fn column(name: &str, design: &Design) -> Result<Option<(Dof, Unit)>, Objection> {
    let named = |name: &str| Dof::ALL.into_iter().find(|dof| dof.name() == name);
    if let Some(dof) = named(name) {
        return Ok(Some((dof, Unit::Bare)));
    }
    let (base, suffix) = name.rsplit_once('_').unwrap_or((name, ""));
    let unit = UNITS.iter().find(|(symbol, _)| *symbol == suffix).map(|(_, unit)| *unit);
    let Some(dof) = named(base) else {
        let base = if unit.is_some() { base } else { name };
        // x and y are too short to be misspelt but in capitals.
        let meant = Dof::ALL.into_iter().find(|dof| dof.name().eq_ignore_ascii_case(base)).map(Dof::name);
        let meant = meant.or_else(|| nearest(base, ["roll", "pitch", "yaw"]));
        return meant.map_or(Ok(None), |meant| {
            let help = format!("did you mean {meant}? A column to be carried through needs another name");
            Err(Objection::new(format!("`{}` is no pose error", shortened(name)), help))
        });
    };
    match unit {
        Some(unit @ (Unit::Degrees | Unit::Radians)) if dof.is_rotation() => Ok(Some((dof, unit))),
        Some(Unit::D) if !dof.is_rotation() => Ok(Some((dof, Unit::D))),
        Some(unit @ Unit::Length(_)) if !dof.is_rotation() => {
            if design.unit.is_some() {
                return Ok(Some((dof, unit)));
            }
            let help = format!(
                "name the column {base} and give it in D, or give the design a unit (connector.unit)"
            );
            Err(Objection::new(format!("{name}: the design has no unit of length"), help))
        }
        Some(_) if dof.is_rotation() => {
            Err(Objection::new(format!("{name}: {base} is an angle"), format!("{base}_deg or {base}_rad")))
        }
        Some(_) => {
            Err(Objection::new(format!("{name}: {base} is a length"), format!("{base} (in D), {base}_mm, …")))
        }
        None => {
            let units = UNITS.map(|(symbol, _)| symbol);
            let known = format!("units are {}", units.join(", "));
            let help = nearest(suffix, units).map_or(known, |meant| format!("did you mean {base}_{meant}?"));
            Err(Objection::new(format!("`{}`: unknown unit", shortened(name)), help))
        }
    }
}

fn number(text: &str) -> Result<f64, Objection> {
    if text.is_empty() {
        return Err(Objection::new("a value is missing", "write 0 for an error that does not occur"));
    }
    let value: f64 = text.parse().map_err(|_| {
        let help = "a number with a decimal point; its unit belongs into the name of the column, as in x_mm";
        Objection::new(format!("`{}` is no number", shortened(text)), help)
    })?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Objection::new(format!("`{}` is not finite", shortened(text)), "leave the row out"))
    }
}

/// The first characters, none of which steers the terminal.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    text.chars().take(LONGEST).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment::design::read;

    fn design() -> Design {
        let text = "[connector]\nfamily = \"pyramid\"\nwidth = 50\nunit = \"mm\"\n[alignment]\nfree = [\"x\", \"pitch\"]\n";
        read(text, Path::new("")).unwrap().design
    }

    fn parse(text: &str) -> Result<Poses, Vec<(String, String)>> {
        let source = SourceText::new(Path::new("p.csv"), text.to_owned());
        Poses::parse(source, &design()).map_err(|error| match error {
            InputError::Findings { findings, source, .. } => findings
                .into_iter()
                .map(|f| (source.text[f.span.unwrap_or(0..0)].to_owned(), f.message))
                .collect(),
            InputError::Load(error) => panic!("{error}"),
        })
    }

    #[test]
    fn units_come_from_the_header_and_rows_may_be_quoted() {
        let poses = parse("id,pitch_deg,\"x_mm\"\r\n\r\n\"a,1\",90, 5 \r\nb,-180,\"-2.5\"\r\n").unwrap();
        assert_eq!(poses.errors.len(), 2);
        assert_eq!(poses.errors[0].pitch, 90f64.to_radians());
        // One multiplication and one division.
        assert!((poses.errors[0].x - 0.1).abs() < 1e-15 && (poses.errors[1].x + 0.05).abs() < 1e-15);
        assert_eq!(poses.final_names()[0], "final_x_mm");
        assert_eq!(poses.carried(), [(0, "id".to_owned())]);
        let back = poses.in_units(&poses.errors[1], &design());
        assert!((back[0] + 2.5).abs() < 1e-12 && (back[3] + 180.0).abs() < 1e-12);
    }

    #[test]
    fn fields_are_found_where_they_stand() {
        let text = "a,\"b,\"\"c\nd\" ,  e\r\n";
        let fields: Vec<&str> = (0..3).map(|k| &text[field(text, 0, k)]).collect();
        assert_eq!(fields, ["a", "\"b,\"\"c\nd\"", "e"]);
    }

    #[test]
    fn every_cell_is_complained_about_in_its_place() {
        let places = |text: &str| parse(text).map(|_| ()).unwrap_err();
        let found = places("x,pitch,y\n1,2\nnan,,0\n1e9,4,0.5\n0,0,0.5\n1 mm,0,0\n");
        let cells: Vec<&str> = found.iter().map(|(cell, _)| cell.as_str()).collect();
        // The second value of the locked y says nothing new.
        assert_eq!(cells, ["1,2", "nan", "", "1e9", "4", "0.5", "1 mm"]);
        assert_eq!(places("x_ft,Pitch,rol,x,x_mm,final_x\n0,0,0,0,0,0\n").len(), 5);
        assert_eq!(places("time,part\n1,2\n")[0].1, "no column is a pose error");
        assert_eq!(places("")[0].1, "the table is empty");
        assert_eq!(places("x\n\n")[0].1, "the table has no rows");
        assert_eq!(places(&("x\n".to_owned() + &"?\n".repeat(50))).len(), MOST_FINDINGS);
    }
}
