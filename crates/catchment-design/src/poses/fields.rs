//! Records of a CSV text, and the positions of their fields in it.

use csv::StringRecord;
use std::ops::Range;

/// The records of a table, each with its first byte. Blank lines are skipped, and blanks around fields are
/// removed.
pub(super) fn records(text: &str) -> impl Iterator<Item = (usize, StringRecord)> {
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

/// The byte ranges of all fields of the record that starts at `start`, without the blanks around them. A
/// single pass over the record.
pub(super) fn spans(text: &str, start: usize) -> Vec<Range<usize>> {
    #[derive(Clone, Copy)]
    enum State {
        Begin,
        Plain,
        Quoted,
        Closed,
    }
    let (mut result, mut from, mut end, mut state) = (Vec::new(), start, text.len(), State::Begin);
    for (at, byte) in text.bytes().enumerate().skip(start) {
        state = match (state, byte) {
            (State::Quoted, b'"') => State::Closed,
            (State::Quoted, _) | (State::Begin | State::Closed, b'"') => State::Quoted,
            (_, b',') => {
                result.push(trimmed(text, from..at));
                from = at + 1;
                State::Begin
            }
            (_, b'\r' | b'\n') => {
                end = at;
                break;
            }
            _ => State::Plain,
        };
    }
    result.push(trimmed(text, from..end));
    result
}

/// The range without the blanks at its ends; the whole range if it is blank.
fn trimmed(text: &str, range: Range<usize>) -> Range<usize> {
    let inside = &text[range.clone()];
    let begin = range.start + (inside.len() - inside.trim_start().len());
    let end = range.start + inside.trim_end().len();
    if begin < end { begin..end } else { range }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn spans_match_the_fields_as_written() {
        let fields = |text: &str| spans(text, 0).into_iter().map(|s| text[s].to_owned()).collect::<Vec<_>>();
        assert_eq!(fields("a,\"b,\"\"c\nd\" ,  e\r\n"), ["a", "\"b,\"\"c\nd\"", "e"]);
        // A quote inside a field is a character like any other.
        assert_eq!(fields("5\" pipe,x\n"), ["5\" pipe", "x"]);
    }

    proptest! {
        #[test]
        fn spans_agree_with_the_csv_reader(text in "[a,\" \r\n]{0,40}") {
            for (start, record) in records(&text) {
                let result = spans(&text, start);
                prop_assert_eq!(result.len(), record.len());
                for (span, field) in result.into_iter().zip(&record) {
                    let written = &text[span];
                    prop_assert!(written.contains('"') || written.trim() == field, "{written:?} {field:?}");
                }
            }
        }
    }
}
