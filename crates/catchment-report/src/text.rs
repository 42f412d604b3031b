//! Writers of text files and of tables for programs.

use catchment_core::terminal::printable;

/// Ends a line of text with the printable form of `content`.
pub fn line(text: &mut String, content: &str) {
    text.push_str(printable(content).trim_end());
    text.push('\n');
}

/// Records as CSV, the column names first.
///
/// # Errors
/// If the records have different lengths.
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
    fn records_are_quoted_where_they_must() {
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
