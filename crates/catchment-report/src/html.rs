//! HTML that cannot contain raw text.
//!
//! ```text
//!   fixed    &'static str: a fragment from the program's source     as it is
//!   text     &str: names, messages, anything that was read          & < > " ' escaped, control characters replaced
//!   json     a value, inside of <script type="application/json">    every < as \u003c
//!   bytes    packed bytes                                           base64
//!   number   a whole number                                         digits
//! ```
//!
//! The inner string is private to this file and only these five calls extend it: a page is safe because it
//! compiles, not because every call was checked. [`policy`] is the second barrier: a browser runs only the
//! scripts whose hashes it lists.

#[cfg(feature = "page")]
use base64::Engine as _;
#[cfg(feature = "page")]
use base64::engine::general_purpose::STANDARD;
#[cfg(feature = "page")]
use sha2::{Digest, Sha256};

/// A page, or the beginning of a page.
#[derive(Debug, Default)]
pub(crate) struct Html(String);

impl Html {
    /// A fragment that stands in the source of the program.
    pub(crate) fn fixed(mut self, fragment: &'static str) -> Self {
        self.0.push_str(fragment);
        self
    }

    /// Text between tags or inside of a quoted attribute. Characters that steer a reader's eye become question marks.
    pub(crate) fn text(mut self, text: &str) -> Self {
        for c in catchment_core::terminal::printable(text).chars() {
            match c {
                '&' => self.0.push_str("&amp;"),
                '<' => self.0.push_str("&lt;"),
                '>' => self.0.push_str("&gt;"),
                '"' => self.0.push_str("&quot;"),
                '\'' => self.0.push_str("&#39;"),
                c => self.0.push(c),
            }
        }
        self
    }

    /// A value inside of a script element of type `application/json`: in JSON `<` occurs only in strings, in
    /// which `\u003c` is equivalent.
    ///
    /// # Errors
    /// The value has no JSON form.
    #[cfg(feature = "page")]
    pub(crate) fn json(mut self, value: &impl serde::Serialize) -> Result<Self, serde_json::Error> {
        self.0.push_str(&serde_json::to_string(value)?.replace('<', "\\u003c"));
        Ok(self)
    }

    /// Bytes as base64.
    #[cfg(feature = "page")]
    pub(crate) fn bytes(mut self, bytes: &[u8]) -> Self {
        STANDARD.encode_string(bytes, &mut self.0);
        self
    }

    /// A whole number.
    #[cfg(feature = "page")]
    pub(crate) fn number(mut self, number: usize) -> Self {
        self.0.push_str(&number.to_string());
        self
    }

    /// The HTML, UTF-8.
    pub(crate) fn into_string(self) -> String {
        self.0
    }
}

/// The Content-Security-Policy of a page with these inline scripts and styles: they are permitted by their
/// SHA-256, while no other script and no handler in an attribute is; nothing is loaded. The page may start
/// workers from its own text, and WebAssembly. A served page may contact its server.
#[cfg(feature = "page")]
pub fn policy(scripts: &[&str], styles: &[&str], is_served: bool) -> String {
    let hash = |text: &&str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text)));
    let hashes = |texts: &[&str]| texts.iter().map(hash).collect::<Vec<String>>().join(" ");
    let connect = if is_served { "; connect-src 'self'" } else { "" };
    format!(
        "default-src 'none'; script-src {} 'wasm-unsafe-eval'; worker-src blob:; style-src {}; img-src data: blob:; base-uri 'none'; \
         form-action 'none'{connect}",
        hashes(scripts),
        hashes(styles),
    )
}

#[cfg(all(test, feature = "page"))]
mod tests {
    use super::*;

    #[test]
    fn hostile_text_is_escaped() {
        let hostile = "</title><script>\"'&\u{1b}\u{202e}";
        let html = Html::default().fixed("<b title=\"").text(hostile).fixed("\">").number(7).into_string();
        assert_eq!(html, "<b title=\"&lt;/title&gt;&lt;script&gt;&quot;&#39;&amp;??\">7");
    }

    #[test]
    fn json_cannot_end_its_element_and_reads_back_equal() {
        let hostile = serde_json::json!({ "</script>": "<!--<script>", "n": 1 });
        let html = Html::default().json(&hostile).unwrap().into_string();
        assert!(!html.contains('<'), "{html}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&html).unwrap(), hostile);
    }

    /// The hash of the empty text, as published with SHA-256.
    #[test]
    fn the_policy_lists_the_allowed_hashes() {
        let policy = policy(&[""], &["", "a"], false);
        let empty = "'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='";
        assert!(policy.contains(&format!("script-src {empty} 'wasm-unsafe-eval';")), "{policy}");
        assert!(policy.contains(&format!("style-src {empty} 'sha256-")), "{policy}");
        assert!(!policy.contains("unsafe-inline") && !policy.contains("'unsafe-eval'"));
        assert!(!policy.contains("connect-src"));
    }
}
