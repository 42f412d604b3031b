//! "Did you mean …?": the known word nearest to a misspelt word; the lookalike character in a name ([`odd`]);
//! the correct form of a malformed number ([`number_help`]).

mod lookalike;
mod number;

pub use lookalike::{as_it_looks, odd};
pub use number::{number_help, value_help};

/// The word of `known` that was most likely meant by `written`: with at most a third of its letters wrong (at
/// least one is allowed). `None` if no word is near; the first of equally near words is returned.
pub fn nearest<'a>(written: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const LONGEST: usize = 64;
    if written.len() > LONGEST {
        return None;
    }
    let written = as_it_looks(written).to_lowercase().replace(['_', ' '], "-");
    let mut best: Option<(usize, &str)> = None;
    for word in known {
        let distance = edits(&written, &word.to_lowercase().replace('_', "-"));
        let allowed = (word.chars().count() / 3).max(1);
        if distance <= allowed && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, word));
        }
    }
    best.map(|(_, word)| word)
}

/// Insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b` (optimal string
/// alignment distance).
fn edits(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let width = b.len() + 1;
    let mut table = vec![0; (a.len() + 1) * width];
    let at = |i: usize, j: usize| i * width + j;
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            table[at(i, j)] = if i == 0 || j == 0 {
                i + j
            } else {
                let substituted = table[at(i - 1, j - 1)] + usize::from(a[i - 1] != b[j - 1]);
                let least = substituted.min(table[at(i - 1, j)] + 1).min(table[at(i, j - 1)] + 1);
                if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                    least.min(table[at(i - 2, j - 2)] + 1)
                } else {
                    least
                }
            };
        }
    }
    table[at(a.len(), b.len())]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_of_textbook_pairs() {
        assert_eq!(edits("kitten", "sitting"), 3);
        assert_eq!(edits("ptich", "pitch"), 1);
        assert_eq!(edits("", "yaw"), 3);
    }

    #[test]
    fn a_slip_is_recognised_and_a_stranger_is_not() {
        let known = ["aspect_ratio", "width", "unit", "x"];
        assert_eq!(nearest("aspectratio", known), Some("aspect_ratio"));
        assert_eq!(nearest("Aspect-Ratio", known), Some("aspect_ratio"));
        assert_eq!(nearest("widht", known), Some("width"));
        assert_eq!(nearest("wіԁtһ", known), Some("width"), "letters that only look alike are right");
        assert_eq!(nearest("colour", known), None);
        assert_eq!(nearest(&"x".repeat(100_000), known), None);
    }
}
