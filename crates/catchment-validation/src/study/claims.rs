//! Statements of the dissertation's text about its own numbers, counted in them.
//!
//! ```text
//!   "a more positive COR generally means a higher AA"
//!
//!       0.123  0.248  0.55  1.23  1.56      neighbours along a row that rise: 4 of 4
//!            ↗      ↗     ↗     ↗           … in the printed tables, in ours by the same method, and in the exact ones
//! ```
//!
//! Each sentence becomes a reproducible count: how many neighbours rise, how many entries are larger. A number in the text is recomputed. Every claim is
//! counted three times, which separates facts of docking (exact) from properties of the method (ours) and of the printed numbers alone.
//!
//! Not promised: that the counts express the author's meaning of "often" or "generally".

use super::reproduce::{ReproducedEntry, TableComparison};
use serde::Serialize;
use std::f64::consts::PI;

/// A sentence of the dissertation, and the share of cases in which it holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Claim {
    /// Its section.
    pub section: &'static str,
    /// The statement, shortened.
    pub says: &'static str,
    /// The counted or computed quantity.
    pub counted: &'static str,
    /// In the printed numbers.
    pub printed: ClaimCheck,
    /// In ours by the same method; null if an entry is not computed.
    pub ours: Option<ClaimCheck>,
    /// In the exact values; null if an entry is not computed, or if the claim is about the method.
    pub exact: Option<ClaimCheck>,
}

/// Result of a check.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ClaimCheck {
    /// A count out of a total.
    Count {
        /// Number of cases in which it holds.
        holds: usize,
        /// Number of cases.
        of: usize,
    },
    /// A number.
    Number {
        /// Its value, in the unit of `counted`.
        value: f64,
    },
}

/// Rows of numbers.
type Rows = Vec<Vec<f64>>;

/// A check of a claim on the numbers of some tables.
struct ClaimQuestion {
    section: &'static str,
    says: &'static str,
    counted: &'static str,
    tables: &'static [&'static str],
    check: fn(&[Rows]) -> ClaimCheck,
    /// Whether the claim applies to the exact values as well.
    of_docking: bool,
}

/// In chapter 5 aspect ratios rise from row to row, centres of rotation from column to column: −1, −½, 0, ½, 1.
const CLAIMS: &[ClaimQuestion] = &[
    ClaimQuestion {
        section: "3.1.3",
        says: "the X-Face accepts more than the V-Face in almost every case, but near r_p = 0 and H/D = 1",
        counted: "entries of 3.2 above those of 3.3",
        tables: &["3.3", "3.2"],
        check: |t| each(t, |v, x| x > v),
        of_docking: true,
    },
    ClaimQuestion {
        section: "3.1.3",
        says: "and more than the S-Face",
        counted: "entries of 3.2 above those of 3.4",
        tables: &["3.4", "3.2"],
        check: |t| each(t, |s, x| x > s),
        of_docking: true,
    },
    ClaimQuestion {
        section: "5.2",
        says: "most areas are larger for the X-Face than for the V-Face, four are not",
        counted: "entries of 5.3 above those of 5.2",
        tables: &["5.2", "5.3"],
        check: |t| each(t, |v, x| x > v),
        of_docking: true,
    },
    ClaimQuestion {
        section: "5.2",
        says: "by a factor of up to two",
        counted: "entries of 5.3 at most twice those of 5.2",
        tables: &["5.2", "5.3"],
        check: |t| each(t, |v, x| x <= 2.0 * v),
        of_docking: true,
    },
    ClaimQuestion {
        section: "5.3.2",
        says: "with few exceptions the discrete results are within 80 % of those of partitioning",
        counted: "entries of 5.4, 5.5 that differ from 5.2, 5.3 by at most 80 %",
        tables: &["5.2", "5.3", "5.4", "5.5"],
        check: |t| each(t, |slices, discrete| (discrete / slices - 1.0).abs() <= 0.8),
        of_docking: false,
    },
    ClaimQuestion {
        section: "5.3.2",
        says: "more than half are within 20 %",
        counted: "entries that differ by at most 20 %",
        tables: &["5.2", "5.3", "5.4", "5.5"],
        check: |t| each(t, |slices, discrete| (discrete / slices - 1.0).abs() <= 0.2),
        of_docking: false,
    },
    ClaimQuestion {
        section: "5.3.2",
        says: "and typically larger",
        counted: "entries of 5.4, 5.5 above those of 5.2, 5.3",
        tables: &["5.2", "5.3", "5.4", "5.5"],
        check: |t| each(t, |slices, discrete| discrete > slices),
        of_docking: false,
    },
    ClaimQuestion {
        section: "5.3.2",
        says: "the ONAA is smaller than the Sum",
        counted: "entries of 5.6, 5.7 below those of 5.4, 5.5",
        tables: &["5.4", "5.5", "5.6", "5.7"],
        check: |t| each(t, |sum, onaa| onaa < sum),
        of_docking: true,
    },
    ClaimQuestion {
        section: "5.3.2",
        says: "the ONAA reaches its maximum in the right-hand column",
        counted: "rows of 5.6, 5.7 whose largest entry is the last",
        tables: &["5.6", "5.7"],
        check: |t| count(t.iter().flatten().map(|row| row.iter().all(|value| value <= &row[row.len() - 1]))),
        of_docking: true,
    },
    ClaimQuestion {
        section: "5.3.2",
        says: "a more positive COR generally means a higher AA",
        counted: "neighbours along the rows of 5.8 to 5.11 that rise",
        tables: PYRAMIDS,
        check: |t| count(t.iter().flatten().flat_map(|row| rises(row))),
        of_docking: true,
    },
    ClaimQuestion {
        section: "5.3.2",
        says: "higher AR often increases AA for high COR",
        counted: "neighbours down the last columns of 5.8 to 5.11 that rise",
        tables: PYRAMIDS,
        check: |t| count(t.iter().flat_map(|rows| rises(&column(rows, 4)))),
        of_docking: true,
    },
    ClaimQuestion {
        section: "5.3.2",
        says: "but decreases AA for negative COR",
        counted: "neighbours down the columns COR −1 and −½ of 5.8 to 5.11 that fall",
        tables: PYRAMIDS,
        check: |t| {
            let falls =
                |rows: &Rows, k| rises(&column(rows, k)).into_iter().map(|rises| !rises).collect::<Vec<_>>();
            count(t.iter().flat_map(|rows| [falls(rows, 0), falls(rows, 1)].concat()))
        },
        of_docking: true,
    },
    ClaimQuestion {
        section: "5.3.2",
        says: "lower AR values yield AA that vary less with COR",
        counted: "rows of 5.8 to 5.11 whose largest entry is fewer times the least than in the next row",
        tables: PYRAMIDS,
        check: |t| {
            count(
                t.iter().flat_map(|rows| {
                    rises(&rows.iter().map(|row| most(row) / least(row)).collect::<Vec<_>>())
                }),
            )
        },
        of_docking: true,
    },
    ClaimQuestion {
        section: "5.3.2",
        says: "in (x, y, pitch) the minimum occurs at low AR rather than high AR",
        counted: "tables of 5.8 whose least entry is in the first row",
        tables: &["5.8"],
        check: |t| count(t.iter().map(|rows| lowest_row(rows) == 0)),
        of_docking: true,
    },
    ClaimQuestion {
        section: "5.3.2",
        says: "in the other cases at high AR",
        counted: "tables 5.9 to 5.11 whose least entry is in the last row",
        tables: &["5.9", "5.10", "5.11"],
        check: |t| count(t.iter().map(|rows| lowest_row(rows) + 1 == rows.len())),
        of_docking: true,
    },
    ClaimQuestion {
        section: "5.3.2",
        says: "the largest value of (x, y, pitch) is 42 points above the one at the highest COR and AR",
        counted: "their difference, in cells of 16π/31³",
        tables: &["5.8"],
        check: |t| {
            let most = t[0].iter().map(|row| most(row)).fold(0.0, f64::max);
            ClaimCheck::Number { value: (most - t[0][4][4]) / (16.0 * PI / f64::from(31 * 31 * 31)) }
        },
        of_docking: false,
    },
];

/// The tables of the pyramid, each over three errors.
const PYRAMIDS: &[&str] = &["5.8", "5.9", "5.10", "5.11"];

/// The claims of the text whose tables were all computed.
pub fn claims(tables: &[TableComparison]) -> Vec<Claim> {
    let named = |name: &str| tables.iter().find(|table| table.table == name);
    CLAIMS
        .iter()
        .filter_map(|claim| {
            let used: Vec<_> = claim.tables.iter().map(|name| named(name)).collect::<Option<_>>()?;
            let number = |value: fn(&ReproducedEntry) -> Option<f64>| {
                let rows = |table: &&TableComparison| {
                    table.entries.iter().map(|row| row.iter().map(value).collect()).collect::<Option<Rows>>()
                };
                used.iter().map(rows).collect::<Option<Vec<Rows>>>().map(|tables| (claim.check)(&tables))
            };
            let exact = || number(|entry| entry.exact.map(|exact| exact.value));
            Some(Claim {
                section: claim.section,
                says: claim.says,
                counted: claim.counted,
                printed: number(|entry| Some(entry.published))?,
                ours: number(|entry| entry.ours),
                exact: claim.of_docking.then(exact).flatten(),
            })
        })
        .collect()
}

fn count(holds: impl Iterator<Item = bool>) -> ClaimCheck {
    let (holds, of) = holds.fold((0, 0), |(holds, of), is| (holds + usize::from(is), of + 1));
    ClaimCheck::Count { holds, of }
}

/// Counts the entries of the second half of some tables that compare with those at the same places of the
/// first half.
fn each(tables: &[Rows], is: fn(f64, f64) -> bool) -> ClaimCheck {
    let (first, second) = tables.split_at(tables.len() / 2);
    let flat = |tables: &[Rows]| tables.concat().concat();
    count(flat(first).into_iter().zip(flat(second)).map(|(a, b)| is(a, b)))
}

/// Whether each number is followed by a larger one.
fn rises(values: &[f64]) -> Vec<bool> {
    values.windows(2).map(|pair| pair[1] > pair[0]).collect()
}

fn column(rows: &Rows, k: usize) -> Vec<f64> {
    rows.iter().map(|row| row[k]).collect()
}

fn most(row: &[f64]) -> f64 {
    row.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

fn least(row: &[f64]) -> f64 {
    row.iter().copied().fold(f64::INFINITY, f64::min)
}

fn lowest_row(rows: &Rows) -> usize {
    let lows: Vec<f64> = rows.iter().map(|row| least(row)).collect();
    lows.iter().position(|low| *low == least(&lows)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::reproduce::{ReproduceSettings, reproduce};
    use catchment::exec::Exec;

    fn tables(names: &[&str]) -> Vec<TableComparison> {
        names
            .iter()
            .map(|name| reproduce(name, &ReproduceSettings::default(), &Exec::new()).unwrap())
            .collect()
    }

    fn claim<'a>(claims: &'a [Claim], says: &str) -> &'a Claim {
        claims.iter().find(|claim| claim.says.contains(says)).unwrap()
    }

    #[test]
    fn missing_tables_yield_no_claims() {
        assert_eq!(claims(&tables(&["3.3", "5.2"])), []);
    }

    /// Counted by hand in the printed tables.
    #[test]
    fn claims_about_the_planar_tables_are_checked() {
        let claims = claims(&tables(&["5.4", "5.5", "5.6", "5.7"]));
        let onaa = claim(&claims, "smaller than the Sum");
        // AR 2, COR −1 of the V-Face: 0.061575 after 0.0339; AR 4, COR −½: 0.045239 after 0.0440: the printed numbers
        // contradict the claim.
        assert_eq!(onaa.printed, ClaimCheck::Count { holds: 48, of: 50 });
        // X-Face, AR 1/4: 0.7854 at COR −½.
        let right = claim(&claims, "right-hand column");
        assert_eq!(right.printed, ClaimCheck::Count { holds: 9, of: 10 });
        assert_eq!(right.ours, Some(right.printed));
        assert_eq!(right.exact, None);
    }

    /// Counted by hand in the printed tables: five entries of 3.2 are below 3.3; four of 3.4 are above, and one is equal.
    #[test]
    fn claims_about_the_kinematic_tables_are_checked() {
        let claims = claims(&tables(&["3.2", "3.3", "3.4"]));
        let [v, s] = ["than the V-Face in almost every", "than the S-Face"].map(|says| claim(&claims, says));
        assert_eq!(v.printed, ClaimCheck::Count { holds: 116, of: 121 });
        assert_eq!(s.printed, ClaimCheck::Count { holds: 116, of: 121 });
        // Stepped by one contact, the X-Face is below the bounds of the other two far more often.
        assert_eq!(v.ours, Some(ClaimCheck::Count { holds: 55, of: 121 }));
        assert_eq!(s.ours, Some(ClaimCheck::Count { holds: 80, of: 121 }));
        assert_eq!((v.exact, s.exact), (None, None));
    }

    #[test]
    fn claims_about_the_pyramid_are_checked() {
        let claims = claims(&tables(&["5.8"]));
        assert_eq!(claims.len(), 2);
        let ClaimCheck::Number { value } = claim(&claims, "42 points").printed else { panic!("a number") };
        assert!((value - 42.0).abs() < 1.0, "{value}");
        let low = claim(&claims, "at low AR");
        assert_eq!((low.printed, low.ours), (ClaimCheck::Count { holds: 1, of: 1 }, Some(low.printed)));
    }
}
