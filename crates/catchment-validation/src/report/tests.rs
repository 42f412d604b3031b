//! Tests of the texts and records of a table.

use super::*;
use crate::study::reproduce::{ReproduceSettings, reproduce};
use catchment::exec::Exec;

fn comparison(table: &str) -> TableComparison {
    reproduce(table, &ReproduceSettings::default(), &Exec::new()).unwrap()
}

#[test]
fn the_text_marks_and_explains_mismatches() {
    let text = comparison("5.6").to_string();
    assert!(text.contains("as printed: 24 of 25"), "{text}");
    assert!(text.contains("1.129*") && text.contains("* (0.5, 0): the square is one cell larger"), "{text}");
}

#[test]
fn the_page_lists_every_table_and_omission() {
    let tables = [comparison("3.3"), comparison("5.2"), comparison("5.6")];
    let page = page(&tables, None, "It took no time.").unwrap();
    for words in ["## 3.3:", "## 5.2:", "0.3828 / 0.3355", "measured forces", "(1.13\\*)", "| 3.3 V-Face"] {
        assert!(page.contains(words), "{words}: {page}");
    }
}

/// Tables 5.8 to 5.11: the largest and the smallest value of each block have a mark, and the columns stay aligned with their
/// headers.
#[test]
fn the_largest_and_the_smallest_value_are_marked() {
    let table = comparison("5.9");
    let text = table.to_string();
    assert!(text.contains("6.650▲") && text.matches("0.003980▼").count() == 2, "{text}");
    // The published and the computed block have marks of their own: one largest value each, and the legend.
    assert_eq!(text.matches('▲').count(), 3, "{text}");
    let end = |word: &str| {
        let line = text.lines().find(|line| line.contains(word)).unwrap();
        line[..line.find(word).unwrap()].chars().count() + word.chars().count()
    };
    assert_eq!(end("6.650"), end("5.190"), "{text}");
    let page = page(&[table], None, "It took no time.").unwrap();
    assert!(page.contains("6.650▲ / ") && page.contains("- ▲ largest, ▼ smallest"), "{page}");
    assert!(!comparison("5.6").to_string().contains('▲'));
}
