//! The text of a table, from any source.

use std::io::{self, Read};

/// Largest text, in bytes: it is read completely, so that errors in it can be shown in place.
pub const LARGEST_TEXT: u64 = 64 << 20;

/// Why there is no text.
#[derive(Debug, thiserror::Error)]
pub enum TextError {
    /// It cannot be read.
    #[error(transparent)]
    Read(#[from] io::Error),
    /// It is larger than [`LARGEST_TEXT`].
    #[error("larger than {} MiB", LARGEST_TEXT >> 20)]
    TooLarge,
    /// It is no text.
    #[error("line {line}: not UTF-8 text")]
    NotUtf8 {
        /// The first line that is not text, from 1.
        line: usize,
    },
}

/// Reads a text to its end, without the byte order mark of spreadsheets.
///
/// # Errors
/// See [`TextError`]. A text that is too large is rejected at the limit, not at its end.
pub fn read_text(reader: impl Read) -> Result<String, TextError> {
    let mut bytes = Vec::new();
    reader.take(LARGEST_TEXT + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST_TEXT {
        return Err(TextError::TooLarge);
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        TextError::NotUtf8 { line: error.as_bytes()[..valid].split(|b| *b == b'\n').count() }
    })?;
    Ok(text.strip_prefix('\u{feff}').map(ToOwned::to_owned).unwrap_or(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_utf8_and_endless_input_are_refused() {
        assert_eq!(read_text("\u{feff}x\n1\n".as_bytes()).unwrap(), "x\n1\n");
        assert!(matches!(read_text(&b"x\n1\n\xff\n"[..]), Err(TextError::NotUtf8 { line: 3 })));
        assert!(matches!(read_text(io::repeat(b'x')), Err(TextError::TooLarge)));
    }
}
