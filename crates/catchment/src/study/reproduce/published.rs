//! The printed tables, as data.

use super::{ReproduceError, Table};

/// A printed table.
pub(super) struct Published {
    pub(super) rows: Vec<f64>,
    pub(super) columns: Vec<f64>,
    pub(super) values: Vec<Vec<f64>>,
}

/// Reads a table: a header `aspect_ratio,cor_-1,…` or `aspect_ratio,rp_0,…`, then one line per row. Every row has a
/// positive value in every column.
pub(super) fn read(table: &Table) -> Result<Published, ReproduceError> {
    let bad = |reason: String| ReproduceError::Published { table: table.name, reason };
    let number = |text: &str| text.trim().parse::<f64>().map_err(|e| bad(format!("`{text}`: {e}")));
    let mut lines = table.csv.lines().filter(|l| !l.starts_with('#') && !l.trim().is_empty());
    let header = lines.next().ok_or_else(|| bad("it is empty".to_owned()))?;
    let columns: Vec<f64> = header
        .split(',')
        .skip(1)
        .map(|name| number(name.split_once('_').map_or(name, |(_, value)| value)))
        .collect::<Result<_, _>>()?;
    let mut published = Published { rows: Vec::new(), columns, values: Vec::new() };
    for line in lines {
        let mut cells = line.split(',').map(number);
        published.rows.push(cells.next().unwrap_or_else(|| Err(bad("an empty row".to_owned())))?);
        let values: Vec<f64> = cells.collect::<Result<_, _>>()?;
        if values.len() != published.columns.len() || values.iter().any(|v| *v <= 0.0) {
            return Err(bad(format!("row `{line}` does not fit its header")));
        }
        published.values.push(values);
    }
    if published.values.is_empty() || published.columns.is_empty() {
        return Err(bad("it has no entry".to_owned()));
    }
    Ok(published)
}
