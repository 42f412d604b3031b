//! Tables of values, with their forms for people and for programs.
//!
//! ```text
//!   column   title "docks"   format Tenths   keys aligned, aligned_lo, aligned_hi
//!   cell     Interval 0.9915, [0.983, 0.996]
//!      text  99.2 % (98.3 … 99.6)                CSV   0.9915,0.983,0.996
//! ```

use super::number::{fixed, grouped, number, percent, significant, tenths};

/// How people read the numbers of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColumnFormat {
    /// Every digit.
    #[default]
    Plain,
    /// So many decimals.
    Fixed(usize),
    /// Four significant digits.
    Significant,
    /// A share of 1 as `16.32 %`.
    Percent,
    /// A share of 1 as `16.3 %`.
    Tenths,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Column {
    /// Its heading; a column without a heading is only for programs.
    pub title: Option<String>,
    /// The names of its values for programs: one, three for intervals (value, lower end, upper end), or an
    /// empty list for a column only for people.
    pub keys: Vec<String>,
    /// How its numbers are shown.
    pub format: ColumnFormat,
    /// Whether its text is aligned to the left; numbers are aligned to the right.
    pub left: bool,
}

/// A value of a table.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Cell {
    /// Nothing.
    #[default]
    Empty,
    /// A number.
    Number(f64),
    /// A count.
    Count(usize),
    /// True or false.
    Flag(bool),
    /// Text.
    Text(String),
    /// A number with the interval of its estimate.
    Interval(f64, [f64; 2]),
    /// A value for programs that people see as this text.
    Shown(String, Box<Cell>),
}

/// Rows of values under columns.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// The columns.
    pub columns: Vec<Column>,
    /// The rows; each has a cell for every column.
    pub rows: Vec<Vec<Cell>>,
}

impl Column {
    /// A column that people see.
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: Some(title.into()), ..Self::default() }
    }

    /// A column for programs alone.
    pub fn data(key: impl Into<String>) -> Self {
        Self::default().key(key)
    }

    /// With the name of its values for programs.
    #[must_use]
    pub fn key(mut self, key: impl Into<String>) -> Self {
        self.keys = vec![key.into()];
        self
    }

    /// With three names for programs: the value's, and those of the ends of its interval.
    #[must_use]
    pub fn interval(mut self, key: &str) -> Self {
        self.keys = vec![key.to_owned(), format!("{key}_lo"), format!("{key}_hi")];
        self
    }

    /// With a format for its numbers.
    #[must_use]
    pub const fn format(mut self, format: ColumnFormat) -> Self {
        self.format = format;
        self
    }

    /// Aligned to the left.
    #[must_use]
    pub const fn left(mut self) -> Self {
        self.left = true;
        self
    }

    /// Text of a cell for people.
    pub fn shown(&self, cell: &Cell) -> String {
        match cell {
            Cell::Empty => String::new(),
            Cell::Number(value) => self.format.of(*value),
            Cell::Count(count) => grouped(*count),
            Cell::Flag(flag) => if *flag { "yes" } else { "no" }.to_owned(),
            Cell::Text(text) | Cell::Shown(text, _) => text.clone(),
            Cell::Interval(value, [lo, hi]) if self.format == ColumnFormat::Tenths => {
                format!("{} ({:.1} … {:.1})", tenths(*value), 100.0 * lo, 100.0 * hi)
            }
            Cell::Interval(value, [lo, hi]) => {
                format!("{} ({} … {})", self.format.of(*value), self.format.of(*lo), self.format.of(*hi))
            }
        }
    }
}

impl ColumnFormat {
    /// A number in this format.
    pub fn of(self, value: f64) -> String {
        match self {
            Self::Plain => number(value),
            Self::Fixed(decimals) => fixed(value, decimals),
            Self::Significant => significant(value),
            Self::Percent => percent(value),
            Self::Tenths => tenths(value),
        }
    }
}

impl Cell {
    /// A value that people see as this text.
    pub fn shown(text: impl Into<String>, value: impl Into<Self>) -> Self {
        Self::Shown(text.into(), Box::new(value.into()))
    }

    /// Values of a cell for programs, in as many fields as its column has keys.
    fn records(&self, fields: usize) -> Vec<String> {
        let mut values = match self {
            Self::Empty => Vec::new(),
            Self::Number(value) => vec![number(*value)],
            Self::Count(count) => vec![count.to_string()],
            Self::Flag(flag) => vec![flag.to_string()],
            Self::Text(text) => vec![text.clone()],
            Self::Interval(value, [lo, hi]) => [value, lo, hi].map(|value| number(*value)).to_vec(),
            Self::Shown(_, value) => value.records(fields),
        };
        values.resize(fields, String::new());
        values
    }
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        Self::Count(count)
    }
}

impl From<bool> for Cell {
    fn from(flag: bool) -> Self {
        Self::Flag(flag)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<super::Share> for Cell {
    fn from(share: super::Share) -> Self {
        Self::Interval(share.share, share.ci95)
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Empty, Into::into)
    }
}

impl Table {
    /// A table without rows.
    pub fn new(columns: impl IntoIterator<Item = Column>) -> Self {
        Self { columns: columns.into_iter().collect(), rows: Vec::new() }
    }

    /// A table for programs alone: a column under each of the keys, which are separated by spaces.
    pub fn data(keys: &str) -> Self {
        Self::new(keys.split_whitespace().map(Column::data))
    }

    /// Adds a row.
    ///
    /// # Panics
    /// If it has not a cell for every column.
    pub fn push(&mut self, row: impl IntoIterator<Item = Cell>) {
        let row: Vec<Cell> = row.into_iter().collect();
        assert_eq!(row.len(), self.columns.len(), "a row has a cell for every column");
        self.rows.push(row);
    }

    /// Whether programs read some of it.
    pub fn has_keys(&self) -> bool {
        self.columns.iter().any(|column| !column.keys.is_empty())
    }

    /// Whether people see some of it.
    pub fn is_shown(&self) -> bool {
        self.columns.iter().any(|column| column.title.is_some())
    }

    /// The names of its values for programs.
    pub fn keys(&self) -> Vec<String> {
        self.columns.iter().flat_map(|column| column.keys.iter().cloned()).collect()
    }

    /// Its values for programs, under their names.
    pub fn records(&self) -> Vec<Vec<String>> {
        let row = |row: &Vec<Cell>| -> Vec<String> {
            let fields = self.columns.iter().zip(row);
            fields.flat_map(|(column, cell)| cell.records(column.keys.len())).collect()
        };
        std::iter::once(self.keys()).chain(self.rows.iter().map(row)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_read_formats_and_programs_every_digit() {
        let mut table = Table::new([
            Column::new("friction").key("mu"),
            Column::new("docks").interval("aligned").format(ColumnFormat::Tenths),
            Column::data("seed"),
            Column::new("at").left(),
        ]);
        table.push([
            0.1.into(),
            Cell::Interval(0.99151, [0.983, 0.9961]),
            7usize.into(),
            Cell::shown("here", 3.0),
        ]);
        assert_eq!(
            table.records(),
            [
                ["mu", "aligned", "aligned_lo", "aligned_hi", "seed"],
                ["0.1", "0.99151", "0.983", "0.9961", "7"]
            ]
        );
        let shown: Vec<String> =
            table.columns.iter().zip(&table.rows[0]).map(|(column, cell)| column.shown(cell)).collect();
        assert_eq!(shown, ["0.1", "99.2 % (98.3 … 99.6)", "7", "here"]);
        // Of nothing a program reads as many empty fields.
        table.push([Cell::Empty, Cell::Empty, Cell::Empty, Cell::Empty]);
        assert_eq!(table.records()[2], ["", "", "", "", ""]);
    }
}
