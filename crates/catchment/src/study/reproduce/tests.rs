//! Published numbers, with a ratchet: an entry that is listed as not matching must not match.

use super::*;
use crate::method::kinematic::START_MEASURE;

fn comparison(table: &str) -> TableComparison {
    reproduce(table, &Exec::new()).unwrap()
}

#[test]
fn every_entry_matches_unless_it_is_listed_and_every_listed_one_does_not() {
    for table in TABLES {
        let comparison = comparison(table.name);
        for (row, entries) in comparison.rows.iter().zip(&comparison.entries) {
            for (column, entry) in comparison.columns.iter().zip(entries) {
                assert_eq!(
                    entry.matches,
                    entry.known_difference.is_none(),
                    "table {} at ({row}, {column}): {entry:?}",
                    table.name
                );
            }
        }
    }
}

#[test]
fn the_kinematic_tables_are_reproduced_in_all_242_integers() {
    let mut exact = 0;
    for name in ["3.3", "3.4"] {
        for entry in comparison(name).entries.iter().flatten() {
            let counts = [entry.published, entry.ours].map(|v| v / START_MEASURE);
            // The printed values have four digits: never further than an eighth from the integer they stand for.
            assert!((counts[0] - counts[0].round()).abs() < 0.13);
            assert_eq!(counts[0].round(), counts[1].round());
            exact += 1;
        }
    }
    assert_eq!(exact, 242);
}

#[test]
fn the_planar_onaa_tables_are_reproduced_to_the_cell() {
    assert_eq!(comparison("5.7").summary.exact, 25);
    assert!(comparison("5.6").summary.exact >= 24);
}

#[test]
fn the_planar_sum_tables_have_a_median_error_below_one_percent() {
    assert!(comparison("5.4").summary.median_error < 0.006);
    assert!(comparison("5.5").summary.median_error < 0.003);
}

#[test]
fn the_pyramid_tables_are_reproduced_as_far_as_their_conventions_are_known() {
    let summary = comparison("5.8").summary;
    assert!(summary.matching == 20 && summary.mean_log_ratio < 0.0595, "{summary:?}");
    let summary = comparison("5.9").summary;
    assert!(summary.matching >= 11 && summary.mean_log_ratio < 0.43, "{summary:?}");
}

#[test]
fn threads_do_not_change_a_table() {
    let with = |threads| reproduce("5.8", &Exec::new().with_threads(threads).unwrap()).unwrap();
    assert_eq!(with(1), with(2));
}

#[test]
fn an_unknown_table_lists_the_known_ones() {
    let error = reproduce("5.3", &Exec::new()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "there is no table `5.3` to reproduce; known are 3.3, 3.4, 5.4, 5.5, 5.6, 5.7, 5.8, 5.9"
    );
}

#[test]
fn the_text_marks_what_does_not_match_and_says_why() {
    let text = comparison("5.6").to_string();
    assert!(text.contains("exact: 24 of 25"), "{text}");
    assert!(text.contains("1.129*") && text.contains("* (0.5, 0): the square is one cell larger"), "{text}");
}
