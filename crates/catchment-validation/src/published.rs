//! The printed tables, as data.

/// A printed table.
#[derive(Debug, Clone, PartialEq)]
pub struct Published {
    /// Names or values of the rows.
    pub rows: Vec<String>,
    /// Names or values of the columns.
    pub columns: Vec<String>,
    /// The printed values, row by row; all positive.
    pub values: Vec<Vec<f64>>,
}

/// A published file that is not a valid table.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the published table {table} cannot be read: {reason}")]
pub struct PublishedError {
    /// The table.
    pub table: &'static str,
    /// The defect.
    pub reason: String,
}

/// Reads a table: a header `aspect_ratio,cor_-1,…`, `aspect_ratio,rp_0,…` or of plain names, then one line per row that
/// begins with its name. Every row has a positive value in every column.
///
/// # Errors
/// When the text is not such a table.
pub fn read(table: &'static str, csv: &str) -> Result<Published, PublishedError> {
    let bad = |reason: String| PublishedError { table, reason };
    let number = |text: &str| text.trim().parse::<f64>().map_err(|e| bad(format!("`{text}`: {e}")));
    // `1.0` and `1` are the same name.
    let name =
        |text: &str| text.trim().parse::<f64>().map_or_else(|_| text.trim().to_owned(), |v| v.to_string());
    let mut lines = csv.lines().filter(|l| !l.starts_with('#') && !l.trim().is_empty());
    let header = lines.next().ok_or_else(|| bad("it is empty".to_owned()))?;
    let value =
        |head: &str| ["cor_", "rp_"].iter().find_map(|start| head.strip_prefix(start)).map(str::to_owned);
    let columns: Vec<String> =
        header.split(',').skip(1).map(|head| value(head).unwrap_or_else(|| head.replace('_', " "))).collect();
    let mut published = Published { rows: Vec::new(), columns, values: Vec::new() };
    for line in lines {
        let mut cells = line.split(',');
        published.rows.push(name(cells.next().unwrap_or_default()));
        let values: Vec<f64> = cells.map(number).collect::<Result<_, _>>()?;
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
