//! Wanted heights as a table `x,y,height`, in D, over a grid; planes over triangles between its points.

use super::Heights;
use catchment::design::SourceText;
use catchment::diagnostic::{Diagnostic, DiagnosticCollector, Diagnostics};
use catchment::method::zraa::HeightFacet;
use catchment::suggest::number_help;
use catchment::terminal::escaped;
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use std::ops::Range;

/// Most places: each gives two planes, and their contacts with the fixed half are many.
const MOST: usize = 900;

/// Reads wanted heights. The places make a whole grid: every x with every y. Every square of it is cut into two triangles.
///
/// # Errors
/// Everything that is wrong with the table, in its place.
pub fn wanted_from_table(source: SourceText) -> Result<Heights, Diagnostics> {
    let mut found = DiagnosticCollector::default();
    let (rows, count) = rows(&source.text, &mut found);
    if count > MOST {
        let help = format!("at most {MOST} are taken");
        found.push(Diagnostic::error("heights", format!("the grid has {count} places"), Some(help)));
    }
    let heights = if found.is_empty() { grid(&rows, &mut found) } else { Heights::default() };
    if found.is_empty() { Ok(heights) } else { Err(found.of(source)) }
}

/// The first rows, of which no more are kept than are taken, and how many there are.
fn rows(text: &str, found: &mut DiagnosticCollector) -> (Vec<(DVec3, Range<usize>)>, usize) {
    const COLUMNS: [&str; 3] = ["x", "y", "height"];
    let (mut rows, mut count) = (Vec::new(), 0);
    let mut start = 0;
    let mut named = false;
    for line in text.split_inclusive('\n') {
        let span = start..start + line.trim_end().len();
        start += line.len();
        // An extra field shows that there are too many.
        let fields: Vec<&str> = line.trim().splitn(COLUMNS.len() + 1, ',').map(str::trim).collect();
        if line.trim().is_empty() || line.starts_with('#') {
            continue;
        }
        let mut refuse = |message: String, help: &str| {
            found.push_with(|| {
                Diagnostic::error("heights", message, Some(help.to_owned())).at(Some(span.clone()))
            });
        };
        if !named {
            named = true;
            if fields != COLUMNS {
                refuse(format!("the columns are not {}", COLUMNS.join(",")), "the first line is: x,y,height");
                return (rows, count);
            }
            continue;
        }
        let numbers: Vec<f64> =
            fields.iter().filter_map(|f| f.parse().ok()).filter(|v: &f64| v.is_finite()).collect();
        match numbers[..] {
            [x, y, z] if fields.len() == COLUMNS.len() => {
                count += 1;
                if rows.len() < MOST {
                    rows.push((DVec3::new(x, y, z), span));
                }
            }
            _ => {
                let is_number = |field: &&&str| field.parse().is_ok_and(f64::is_finite);
                let odd = fields.iter().find(|field| !is_number(field)).copied();
                let named = odd.map_or_else(String::new, |odd| format!(": `{}`", escaped(odd)));
                let help = odd.and_then(number_help).unwrap_or_else(|| "x, y and height, in D".to_owned());
                refuse(format!("the line is not three finite numbers{named}"), &help);
            }
        }
    }
    (rows, count)
}

fn grid(rows: &[(DVec3, Range<usize>)], found: &mut DiagnosticCollector) -> Heights {
    // Numbers of the same bits are the same place; −0 is 0.
    let key = |v: f64| (v + 0.0).to_bits();
    let mut places: BTreeMap<(u64, u64), f64> = BTreeMap::new();
    let (mut xs, mut ys): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for (p, span) in rows {
        if places.insert((key(p.x), key(p.y)), p.z).is_some() {
            found.push(
                Diagnostic::error("heights", format!("({}, {}) is there twice", p.x, p.y), None)
                    .at(Some(span.clone())),
            );
        }
        xs.push(p.x);
        ys.push(p.y);
    }
    for values in [&mut xs, &mut ys] {
        values.sort_by(f64::total_cmp);
        values.dedup();
    }
    if xs.len() < 2 || ys.len() < 2 || xs.len() * ys.len() != places.len() {
        let message =
            format!("{} places do not make a grid of {} x by {} y", places.len(), xs.len(), ys.len());
        let help =
            "give every x with every y, two of each at least; for a planar design y = -1 and y = 1 alike";
        found.push(Diagnostic::error("heights", message, Some(help.to_owned())));
    }
    if !found.is_empty() {
        return Heights::default();
    }
    let at = |x: f64, y: f64| DVec3::new(x, y, places.get(&(key(x), key(y))).copied().unwrap_or_default());
    let mut facets = Vec::new();
    for x in xs.windows(2) {
        for y in ys.windows(2) {
            let [a, b, c, d] = [at(x[0], y[0]), at(x[1], y[0]), at(x[1], y[1]), at(x[0], y[1])];
            facets.extend([triangle([a, b, c]), triangle([a, c, d])]);
        }
    }
    Heights { facets }.merged()
}

fn triangle(corners: [DVec3; 3]) -> HeightFacet {
    let n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let gradient = -n.truncate() / n.z;
    HeightFacet {
        polygon: corners.map(|c: DVec3| -> DVec2 { c.truncate() }).to_vec(),
        offset: corners[0].z - gradient.dot(corners[0].truncate()),
        gradient,
    }
}
