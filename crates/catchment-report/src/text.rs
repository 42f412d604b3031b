//! Text for terminals and tables for programs: what every kind of report is told with.

pub use catchment_core::document::{
    decimals, fixed, grouped, length, number, percent, rounded, rounded_down, significant, tenths,
    tenths_between, with_error,
};
use catchment_core::terminal::printable;

/// Width of a line.
pub const COLUMNS: usize = 80;
/// Width of the column of names.
const NAMES: usize = 17;

/// Ends a line of text with what may be printed of `content`.
pub fn line(text: &mut String, content: &str) {
    text.push_str(printable(content).trim_end());
    text.push('\n');
}

/// A line that starts with a name; a space stands between the two, however long the name is.
pub fn row(text: &mut String, name: &str, value: &str) {
    line(text, &format!("  {name:<width$} {value}", width = NAMES - 3));
}

/// Breaks `content` between words; later lines are indented by the width of `first`.
pub fn wrapped(text: &mut String, first: &str, content: &str) {
    let indent = first.chars().count();
    let mut current = first.to_owned();
    let mut used = indent;
    for word in content.split_whitespace() {
        let length = word.chars().count();
        if used > indent && used + 1 + length > COLUMNS {
            line(text, &current);
            current = " ".repeat(indent);
            used = indent;
        }
        if used > indent {
            current.push(' ');
            used += 1;
        }
        current.push_str(word);
        used += length;
    }
    line(text, &current);
}

/// Records as CSV, the names of the columns first.
///
/// # Errors
/// If the records are not of one length.
pub fn csv(records: &[Vec<String>]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for record in records {
        writer.write_record(record)?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_name_does_not_touch_its_value() {
        let mut text = String::new();
        for name in ["free errors", "largest square", "slope threshold", "remote centre of rotation"] {
            row(&mut text, name, "0.5");
        }
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "  free errors    0.5");
        assert_eq!(lines[1], "  largest square 0.5");
        assert_eq!(lines[2], "  slope threshold 0.5");
        assert_eq!(lines[3], "  remote centre of rotation 0.5");
    }

    #[test]
    fn programs_get_every_digit() {
        let records = [["a", "b, c"], ["1", "\"x\""]].map(|record| record.map(str::to_owned).to_vec());
        assert_eq!(csv(&records).unwrap(), b"a,\"b, c\"\n1,\"\"\"x\"\"\"\n");
    }

    #[test]
    fn a_name_cannot_steer_the_terminal() {
        let mut text = String::new();
        line(&mut text, "a\u{1b}[2J<&\u{0}\u{9b}\n\u{202e}µ ");
        assert_eq!(text, "a?[2J<&????µ\n");
    }
}
