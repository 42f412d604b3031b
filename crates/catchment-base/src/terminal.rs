//! Safe output of external text on a terminal: names of files, of processes and of columns, and messages that
//! repeat them. Control characters can move the cursor, clear the screen or imitate a line of the program;
//! marks of direction can show a name in another order than it is written.
//!
//! | | for | a line break becomes |
//! |---|---|---|
//! | [`printable`] | tables, whose columns must keep their widths | `?` |
//! | [`escaped`], [`shown`] | messages, which must say which file it is | `\n` |

use std::fmt::{self, Write};
use std::path::Path;

/// Whether a character could steer a terminal, or a reader's eye.
pub fn steers(c: char) -> bool {
    c.is_control() || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// The text with a question mark for every character that [`steers`].
pub fn printable(text: &str) -> String {
    text.chars().map(|c| if steers(c) { '?' } else { c }).collect()
}

/// The text with every character that [`steers`] as a program writes it: `\n`, `\u{1b}`.
pub fn escaped(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if steers(c) {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    shown
}

/// A path for messages: [`escaped`], on a single line.
pub fn shown(path: &Path) -> impl fmt::Display {
    Shown(path)
}

struct Shown<'a>(&'a Path);

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = Escaping(f);
        write!(shown, "{}", self.0.display())
    }
}

/// A writer that escapes its input.
struct Escaping<'a, 'b>(&'a mut fmt::Formatter<'b>);

impl Write for Escaping<'_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.write_str(&escaped(text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_replaced_or_escaped() {
        let name = "a\u{1b}[2J<&\u{0}\u{9b}\n\u{202e}µ";
        assert_eq!(printable(name), "a?[2J<&????µ");
        assert_eq!(escaped(name), "a\\u{1b}[2J<&\\u{0}\\u{9b}\\n\\u{202e}µ");
        assert_eq!(shown(Path::new(name)).to_string(), escaped(name));
        assert_eq!(escaped("plain µ \\ name"), "plain µ \\ name");
    }

    #[cfg(unix)]
    #[test]
    fn non_utf8_paths_are_shown() {
        use std::os::unix::ffi::OsStrExt;
        let name = std::ffi::OsStr::from_bytes(b"a\xff\n");
        assert_eq!(shown(Path::new(name)).to_string(), "a\u{fffd}\\n");
    }
}
