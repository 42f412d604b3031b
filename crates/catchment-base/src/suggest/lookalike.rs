//! Lookalike characters in names: `х` (U+0445, Cyrillic) for `x`, `１` for `1`, `−` for `-`. Keyboards,
//! spreadsheets and copied text insert them, and they are invisible to a reader.
//!
//! *Not promised:* completeness. Unicode lists thousands (UTS 39, confusables); this table has the scripts of
//! common keyboards, and the blocks of styled letters.

/// Lookalike characters, the ASCII character first.
const ALIKE: [(char, &str); 46] = [
    ('a', "аɑ"),
    ('c', "сⅽ"),
    ('d', "ԁⅾ"),
    ('e', "еҽ"),
    ('g', "ɡ"),
    ('h', "һ"),
    ('i', "іıιⅰ"),
    ('j', "ј"),
    ('k', "кκ"),
    ('l', "ӏⅼ"),
    ('m', "мⅿ"),
    ('o', "оοօ"),
    ('p', "рρ"),
    ('q', "ԛ"),
    ('s', "ѕ"),
    ('t', "тτ"),
    ('u', "υս"),
    ('v', "ѵνⅴ"),
    ('w', "ԝѡ"),
    ('x', "хχⅹˣₓ"),
    ('y', "уүʸ"),
    ('A', "АΑ"),
    ('B', "ВΒ"),
    ('C', "СⅭ"),
    ('D', "Ⅾ"),
    ('E', "ЕΕ"),
    ('H', "НΗ"),
    ('I', "ІΙ"),
    ('J', "Ј"),
    ('K', "КΚ"),
    ('M', "МΜⅯ"),
    ('N', "Ν"),
    ('O', "ОΟ"),
    ('P', "РΡ"),
    ('S', "Ѕ"),
    ('T', "ТΤ"),
    ('X', "ХΧⅩ"),
    ('Y', "УΥҮ"),
    ('Z', "Ζ"),
    ('-', "‐‑‒–—−"),
    ('_', "‗"),
    ('.', "·․"),
    (',', "‚٬"),
    ('/', "⁄∕"),
    ('\'', "’‘"),
    (' ', "\u{a0}\u{2007}\u{2009}\u{202f}"),
];

/// ASCII in full width, as East Asian keyboards write it: `！` to `～`.
const WIDE: std::ops::RangeInclusive<u32> = 0xff01..=0xff5e;
/// From a character in full width to that of ASCII.
const WIDE_OFFSET: u32 = 0xff01 - '!' as u32;
/// Letters of formulas, bold, italic, …: alphabets of capitals and small letters in sequence.
const FORMULA_LETTERS: std::ops::RangeInclusive<u32> = 0x1d400..=0x1d6a3;
/// The same of digits.
const FORMULA_DIGITS: std::ops::RangeInclusive<u32> = 0x1d7ce..=0x1d7ff;

/// The ASCII character that a character looks like.
fn looks_like(c: char) -> Option<char> {
    if c.is_ascii() {
        return None;
    }
    let nth = |from: u32, number: u32| char::from_u32(from + number);
    match u32::from(c) {
        code if WIDE.contains(&code) => char::from_u32(code - WIDE_OFFSET),
        code if FORMULA_LETTERS.contains(&code) => match (code - FORMULA_LETTERS.start()) % 52 {
            capital @ 0..26 => nth('A'.into(), capital),
            small => nth('a'.into(), small - 26),
        },
        code if FORMULA_DIGITS.contains(&code) => nth('0'.into(), (code - FORMULA_DIGITS.start()) % 10),
        _ => ALIKE.iter().find(|(_, others)| others.contains(c)).map(|(ascii, _)| *ascii),
    }
}

/// The text as it appears to a reader: with lookalikes replaced by ASCII.
///
/// # Examples
/// ```
/// assert_eq!(catchment_base::suggest::as_it_looks("\u{445}_mm"), "x_mm");
/// ```
pub fn as_it_looks(text: &str) -> String {
    text.chars().map(|c| looks_like(c).unwrap_or(c)).collect()
}

/// Note on a name that is no known key or column: its first lookalike character, as a clause that ends a
/// message; empty without a lookalike.
///
/// # Examples
/// ```
/// let odd = catchment_base::suggest::odd("\u{445}_mm");
/// assert_eq!(odd, "; its character 1, `\u{445}` (U+0445), only looks like the ASCII `x`");
/// ```
pub fn odd(name: &str) -> String {
    let first = name.chars().zip(1..).find_map(|(c, number)| Some((c, number, looks_like(c)?)));
    first.map_or_else(String::new, |(c, number, ascii)| {
        format!(
            "; its character {number}, `{c}` (U+{:04X}), only looks like the ASCII `{ascii}`",
            u32::from(c)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lookalikes_of_ascii_read_as_ascii() {
        for (written, read) in [
            ("х", "x"),
            ("уаԝ", "yaw"),
            ("ｘ＿ｍｍ", "x_mm"),
            ("𝑥", "x"),
            ("𝐑𝟎", "R0"),
            ("−5", "-5"),
            ("θz", "θz"),
            ("Prüfer µ δ γ", "Prüfer µ δ γ"),
        ] {
            assert_eq!(as_it_looks(written), read, "{written}");
        }
        assert_eq!(odd("plain name"), "");
        assert_eq!(odd("rоll"), "; its character 2, `о` (U+043E), only looks like the ASCII `o`");
    }

    #[test]
    fn lookalikes_are_unique_and_printable() {
        let all: Vec<char> = ALIKE.iter().flat_map(|(_, others)| others.chars()).collect();
        for (k, c) in all.iter().enumerate() {
            assert!(!all[..k].contains(c) && !c.is_ascii() && !crate::terminal::steers(*c), "{c}");
        }
    }
}
