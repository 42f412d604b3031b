//! Advice for a text that is meant as a number but is not one.

use super::{as_it_looks, odd};

/// Words for a number that there is not.
const NOTHING: [&str; 12] =
    ["nan", "inf", "infinity", "∞", "na", "n/a", "#n/a", "none", "null", "nil", "-", "?"];

/// The correct form in place of `text`, as a sentence: `write 0.5: decimals follow a point`. `None` if no
/// number was meant.
///
/// A unit after the number is kept. Words for missing numbers, and invalid numbers (`nan`, `inf`), give the
/// advice to omit them.
///
/// # Examples
/// ```
/// use catchment_base::suggest::number_help;
/// assert_eq!(number_help("100%").as_deref(), Some("write 1: a share is a plain number, 100 % is 1"));
/// assert_eq!(number_help("5,5 mm").as_deref(), Some("write 5.5 mm: decimals follow a point"));
/// ```
pub fn number_help(text: &str) -> Option<String> {
    /// Longer texts are no numbers.
    const LONGEST: usize = 64;
    let text = text.trim();
    if text.is_empty() || text.len() > LONGEST {
        return None;
    }
    let plain = as_it_looks(text);
    let is_unit = |c: char| c.is_alphabetic() || c == '°';
    let signless = plain.trim_start_matches(['+', '-']);
    if NOTHING.contains(&plain.to_lowercase().as_str()) || NOTHING.contains(&signless.to_lowercase().as_str())
    {
        return Some("write a finite number, or leave it out".to_owned());
    }
    if let Some((value, reason)) = hexadecimal(&plain) {
        return Some(format!("write {value}: {reason}"));
    }
    let number = plain.trim_end_matches(is_unit);
    let unit = &plain[number.len()..];
    let (value, reason) = read(number.trim())?;
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    if plain != text && reason.is_empty() {
        return Some(format!("write {value}{unit}{}", odd(text).replacen(';', ":", 1)));
    }
    (!reason.is_empty()).then(|| format!("write {value}{unit}: {reason}"))
}

/// The same for the value of a key: for the text after the `=` on the line of byte `at`, if the text is not
/// TOML there.
pub fn value_help(text: &str, at: usize) -> Option<String> {
    let (before, behind) = text.split_at_checked(at)?;
    let start = before.rfind('\n').map_or(0, |line| line + 1);
    let end = behind.find('\n').map_or(text.len(), |line| at + line);
    let (_, value) = text[start..end].split_once('=')?;
    let value = value.split('#').next()?.trim();
    number_help(value.trim_matches(['"', '\'']))
}

fn hexadecimal(text: &str) -> Option<(u64, &'static str)> {
    let digits = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"))?;
    Some((u64::from_str_radix(digits, 16).ok()?, "numbers are decimal"))
}

/// The number that was meant, in its correct form, and the reason why it was not read; no reason for a valid
/// number.
fn read(text: &str) -> Option<(String, &'static str)> {
    let is_number = |text: &str| text.parse::<f64>().is_ok_and(f64::is_finite);
    if is_number(text) {
        return Some((text.to_owned(), ""));
    }
    if let Some(percent) = text.strip_suffix('%').map(str::trim) {
        let value: f64 = percent.replace(',', ".").parse().ok().filter(|value: &f64| value.is_finite())?;
        // Rounded as it was written: 0.1 % of binary fractions is not 0.001.
        let share = format!("{:.12}", value / 100.0);
        let share = share.trim_end_matches('0').trim_end_matches('.').to_owned();
        return Some((share, "a share is a plain number, 100 % is 1"));
    }
    if let Some((over, under)) = text.split_once('/') {
        let value = over.trim().parse::<f64>().ok()? / under.trim().parse::<f64>().ok()?;
        return value.is_finite().then(|| (format!("{value}"), "fractions are not computed"));
    }
    let marks = ['~', '<', '>', '≤', '≥', '=', '≈', '±'];
    let bare = text.trim_start_matches(marks).trim_start_matches("+/-").trim_start_matches("+-").trim_start();
    if bare != text && is_number(bare) {
        return Some((bare.to_owned(), "a number stands alone"));
    }
    let joined: String = text.chars().filter(|c| !matches!(c, ' ' | '_' | '\'')).collect();
    if joined != text && is_number(&joined) {
        return Some((joined, "digits are not grouped"));
    }
    let pointed = text.replacen(',', ".", 1);
    (pointed != text && is_number(&pointed)).then_some((pointed, "decimals follow a point"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn malformed_numbers_get_a_suggestion() {
        for (text, help) in [
            ("nan", "write a finite number, or leave it out"),
            ("-inf", "write a finite number, or leave it out"),
            ("n/a", "write a finite number, or leave it out"),
            ("100%", "write 1: a share is a plain number, 100 % is 1"),
            ("0.1 %", "write 0.001: a share is a plain number, 100 % is 1"),
            ("12,5%", "write 0.125: a share is a plain number, 100 % is 1"),
            ("0,5", "write 0.5: decimals follow a point"),
            ("5,5 mm", "write 5.5 mm: decimals follow a point"),
            ("1_000", "write 1000: digits are not grouped"),
            ("1 000 mm", "write 1000 mm: digits are not grouped"),
            ("1/4", "write 0.25: fractions are not computed"),
            ("±2", "write 2: a number stands alone"),
            ("0x10", "write 16: numbers are decimal"),
            ("−5", "write -5: its character 1, `−` (U+2212), only looks like the ASCII `-`"),
            ("１２ mm", "write 12 mm: its character 1, `１` (U+FF11), only looks like the ASCII `1`"),
        ] {
            assert_eq!(number_help(text).as_deref(), Some(help), "{text}");
        }
        assert_eq!(
            value_help("a = 1\nb = 0,5 # half\n", 11).as_deref(),
            Some("write 0.5: decimals follow a point")
        );
        assert_eq!([value_help("a = 1\nb\n", 7), value_help("é", 1), value_help("", 0)], [None, None, None]);
        for text in ["", "mm", "much", "1", "5 mm", "1e-3", "1/0", "%", "1,2,3", &"9".repeat(1000)] {
            assert_eq!(number_help(text), None, "{text}");
        }
    }
}
