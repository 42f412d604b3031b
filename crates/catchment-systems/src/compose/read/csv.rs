//! Rings as a table: `x,y` or `x,y,ring`, a corner per line. Lines that begin with `#` are ignored.

use super::rings::{MOST_CORNERS, Ring, region, too_many};
use super::{Measure, ParsedRegion, ReadError};
use catchment::design::{LengthUnit, Quantity, QuantityUnit, SourceText, nearest};
use catchment::diagnostic::{Diagnostic, DiagnosticCollector};
use catchment::suggest::{number_help, odd};
use glam::DVec2;
use std::collections::HashSet;
use std::ops::Range;

/// A record: its fields with their places.
struct Record {
    fields: Vec<(String, Range<usize>)>,
    span: Range<usize>,
}

/// Number of columns examined: more than three have no use.
const MOST_COLUMNS: usize = 100;

/// The records of a text: the column names and, if there are that many, one corner more than allowed.
fn records(text: &str) -> Result<Vec<Record>, Diagnostic> {
    let mut reader = ::csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(::csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut records = Vec::new();
    for record in reader.records().take(MOST_CORNERS + 2) {
        let record = record.map_err(|error| Diagnostic::error("region", error.to_string(), None))?;
        let start = record.position().map_or(0, |p| p.byte() as usize);
        // The reader may report the end of the previous line.
        let start = start + text[start..].len() - text[start..].trim_start_matches(['\r', '\n']).len();
        let end = text[start..].find(['\r', '\n']).map_or(text.len(), |length| start + length);
        let mut from = start;
        let fields = record
            .iter()
            .take(MOST_COLUMNS)
            .map(|field| {
                // A quoted field differs from its text in the file; its position is then that of the record.
                let place =
                    text[from..end].find(field).map(|offset| from + offset..from + offset + field.len());
                from = place.as_ref().map_or(from, |place| place.end);
                (field.to_owned(), place.unwrap_or(start..end))
            })
            .collect();
        records.push(Record { fields, span: start..end });
    }
    Ok(records)
}

/// Name of a column of coordinates, without its unit, and the unit.
fn unit_of(name: &str) -> (String, Option<String>) {
    let bracketed = |open: char, close: char| {
        let (base, unit) = name.strip_suffix(close)?.split_once(open)?;
        Some((base.trim().to_lowercase(), Some(unit.trim().to_owned())))
    };
    bracketed('[', ']')
        .or_else(|| bracketed('(', ')'))
        .or_else(|| name.split_once('_').map(|(base, unit)| (base.to_lowercase(), Some(unit.to_owned()))))
        .unwrap_or_else(|| (name.to_lowercase(), None))
}

/// Columns of x, of y, of the ring, and the unit of the coordinates.
struct Columns {
    x: usize,
    y: usize,
    ring: Option<usize>,
    unit: QuantityUnit,
}

fn columns(header: &Record, found: &mut DiagnosticCollector) -> Option<Columns> {
    const HELP: &str = "the first line names the columns: x,y or x,y,ring; units in brackets: x [cm], y [cm]";
    let mut places: [Option<(usize, Option<String>)>; 3] = [const { None }; 3];
    let before = found.len();
    for (k, (name, span)) in header.fields.iter().enumerate() {
        let (base, unit) = unit_of(name);
        match ["x", "y", "ring"].iter().position(|known| *known == base) {
            Some(which) if places[which].is_none() => places[which] = Some((k, unit)),
            Some(_) => {
                found.push(
                    Diagnostic::error("region", format!("`{name}` is a second column of {base}"), None)
                        .at(Some(span.clone())),
                );
            }
            None => {
                let help = nearest(&base, ["x", "y", "ring"])
                    .map_or_else(|| HELP.to_owned(), |meant| format!("did you mean `{meant}`?"));
                found.push(
                    Diagnostic::error("region", format!("unknown column `{name}`{}", odd(name)), Some(help))
                        .at(Some(span.clone())),
                );
            }
        }
    }
    if found.len() > before {
        return None;
    }
    let [Some((x, first)), Some((y, second)), ring] = places else {
        let message = "the table has no columns x and y";
        found.push(Diagnostic::error("region", message, Some(HELP.to_owned())).at(Some(header.span.clone())));
        return None;
    };
    let named = |unit: &Option<String>| match unit {
        None => Some(QuantityUnit::Bare),
        Some(text) => format!("1 {text}").parse::<Quantity>().ok().map(|q| q.unit),
    };
    let (Some(of_x), Some(of_y)) = (named(&first), named(&second)) else {
        let message = "the unit of a column is none of mm, cm, m, um, in, D";
        found.push(Diagnostic::error("region", message, Some(HELP.to_owned())).at(Some(header.span.clone())));
        return None;
    };
    if matches!(of_x, QuantityUnit::Degrees | QuantityUnit::Radians) || of_x != of_y {
        let text = |unit: &Option<String>| unit.clone().unwrap_or_else(|| "mm".to_owned());
        let message = format!("the units are mixed: x is in {} and y in {}", text(&first), text(&second));
        let help = "give both in one unit of length".to_owned();
        found.push(Diagnostic::error("region", message, Some(help)).at(Some(header.span.clone())));
        return None;
    }
    Some(Columns { x, y, ring: ring.map(|(k, _)| k), unit: of_x })
}

pub(super) fn read(source: SourceText, stem: String) -> Result<ParsedRegion, ReadError> {
    let mut found = DiagnosticCollector::default();
    let mut rings: Vec<Ring> = Vec::new();
    let mut measure = Measure::Millimetres;
    let all = records(&source.text).unwrap_or_else(|diagnostic| {
        found.push(diagnostic);
        Vec::new()
    });
    if let Some((header, rows)) = all.split_first() {
        if rows.len() > MOST_CORNERS {
            found.push(too_many());
        } else if let Some(columns) = columns(header, &mut found) {
            if columns.unit == QuantityUnit::D {
                measure = Measure::Widths;
            }
            fill(rows, &columns, &mut rings, &mut found);
        }
    } else if found.is_empty() {
        let help = Some("it has a line for the names of the columns and one for each corner".to_owned());
        found.push(Diagnostic::error("region", "the table is empty", help));
    }
    region(source, stem, measure, rings, found, Vec::new())
}

fn fill(rows: &[Record], columns: &Columns, rings: &mut Vec<Ring>, found: &mut DiagnosticCollector) {
    let factor = match columns.unit {
        QuantityUnit::Length(unit) => unit.metres() / LengthUnit::Mm.metres(),
        _ => 1.0,
    };
    // The rings so far by their labels, of which the last is still open.
    let mut begun: HashSet<&str> = HashSet::new();
    let mut open = None;
    for row in rows {
        let label = columns.ring.and_then(|k| row.fields.get(k)).map_or("", |(text, _)| text.as_str());
        let coordinates = [columns.x, columns.y].map(|k| {
            let Some((text, span)) = row.fields.get(k) else {
                let message = "a coordinate is missing in this line";
                found.push_with(|| Diagnostic::error("region", message, None).at(Some(row.span.clone())));
                return None;
            };
            number(text, span).map_err(|diagnostic| found.push(diagnostic)).ok()
        });
        let [Some(x), Some(y)] = coordinates else { continue };
        if open != Some(label) {
            if !begun.insert(label) {
                let message =
                    format!("ring `{label}` was left open: another ring began before it went on here");
                let help = "the corners of a ring follow each other".to_owned();
                found.push(Diagnostic::error("region", message, Some(help)).at(Some(row.span.clone())));
                continue;
            }
            open = Some(label);
            rings.push(Ring::default());
        }
        if let Some(ring) = rings.last_mut() {
            ring.corners.push((DVec2::new(x, y) * factor, row.span.clone()));
        }
    }
    if found.is_empty() && rings.is_empty() {
        found.push(Diagnostic::error("region", "the table has no corners", None));
    }
}

fn number(text: &str, span: &Range<usize>) -> Result<f64, Diagnostic> {
    let diagnostic = |message: String, help: &str| {
        Diagnostic::error("region", message, Some(help.to_owned())).at(Some(span.clone()))
    };
    match text.parse::<Quantity>() {
        Ok(Quantity { value, unit: QuantityUnit::Bare }) => Ok(value),
        Ok(_) => Err(diagnostic(
            format!("the units are mixed: `{text}` has one of its own"),
            "give the unit once, in the names of the columns: x [cm], y [cm]",
        )),
        Err(defect) => {
            let help = number_help(text).unwrap_or_else(|| "a coordinate is a finite number".to_owned());
            Err(diagnostic(defect.to_string(), &help))
        }
    }
}
