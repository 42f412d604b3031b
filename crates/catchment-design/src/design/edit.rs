//! The text of a design with one key replaced, for a sweep. All other text remains as its author wrote it.

use super::defect::DesignDefect;
use super::keys::{DesignTable, Key, ValueKind};
use catchment_base::suggest::{nearest, value_help};
use toml_edit::{DocumentMut, Item, TableLike, Value};

/// Short names of keys that people know by them.
const ALIASES: [(&str, &str); 2] = [("cor", "center_of_rotation"), ("rho", "rotation_length")];

/// The tables of a table of keys, by their paths.
fn paths_of(table: DesignTable) -> &'static [&'static str] {
    match table {
        DesignTable::Root => &[""],
        DesignTable::Connector => &["connector."],
        DesignTable::Half => &["connector.fixed.", "connector.moving."],
        // They stand in lists, of which a path names no member.
        DesignTable::Part | DesignTable::Sphere | DesignTable::Cylinder | DesignTable::Cone => &[],
        DesignTable::Alignment => &["alignment."],
        DesignTable::Errors => &["errors."],
        DesignTable::Docked => &["docked."],
    }
}

/// Keys whose values a user may replace: those with a single value that changes the result.
fn replaceable() -> impl Iterator<Item = (String, &'static Key)> {
    DesignTable::ALL.into_iter().flat_map(|table| {
        let one_value = |key: &&Key| {
            !matches!(
                key.kind,
                ValueKind::Table(_)
                    | ValueKind::Parts
                    | ValueKind::Later
                    | ValueKind::Pieces
                    | ValueKind::Line
            )
        };
        let keys = table.keys().filter(one_value).filter(|key| key.table != DesignTable::Root);
        keys.flat_map(move |key| paths_of(table).iter().map(move |path| (format!("{path}{}", key.name), key)))
    })
}

/// The path of a key, such as `alignment.center_of_rotation`, from that path, from its last word if that is
/// unique, or from a short name (`cor`, `rho`).
///
/// # Errors
/// The name belongs to no key, or to several.
pub fn key_path(name: &str) -> Result<String, DesignDefect> {
    let name = name.trim();
    let full = ALIASES.iter().find(|(short, _)| *short == name).map_or(name, |(_, full)| *full);
    let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    let found: Vec<String> =
        replaceable().map(|(path, _)| path).filter(|path| path == full || last(path) == full).collect();
    match &found[..] {
        [path] => Ok(path.clone()),
        [] => {
            let paths: Vec<String> = replaceable().map(|(path, _)| path).collect();
            let words: Vec<String> = paths.iter().map(|path| last(path)).collect();
            let meant = nearest(full, paths.iter().chain(&words).map(String::as_str)).map(str::to_owned);
            Err(DesignDefect::NoSuchKey { name: super::quantity::shortened(name), meant })
        }
        _ => Err(DesignDefect::AmbiguousKey { name: super::quantity::shortened(name), paths: found }),
    }
}

/// A value as the design file has it: a number, `true`, a quoted string, a list; anything else is a string without its quotes.
fn value(text: &str) -> Value {
    text.parse::<Value>().unwrap_or_else(|_| Value::from(text))
}

/// `text` with `path` set to `value`, replacing its present value or as a new key of its table.
///
/// # Errors
/// The text is not TOML, or the key's table has another type.
pub fn with_key(text: &str, path: &str, written: &str) -> Result<String, DesignDefect> {
    let syntax = |error: toml_edit::TomlError| DesignDefect::Syntax {
        message: error.message().to_owned(),
        help: error.span().and_then(|span| value_help(text, span.start)),
    };
    let mut document: DocumentMut = text.parse().map_err(syntax)?;
    let mut words: Vec<&str> = path.split('.').collect();
    let last = words.pop().unwrap_or_default();
    let mut table: &mut dyn TableLike = document.as_table_mut();
    for word in words {
        let entry = table.entry(word).or_insert_with(|| Item::Table(toml_edit::Table::new()));
        let not_a_table =
            DesignDefect::WrongType { key: word.to_owned(), expected: "a table", found: entry.type_name() };
        table = entry.as_table_like_mut().ok_or(not_a_table)?;
    }
    let mut value = value(written);
    if let Some(old) = table.get(last).and_then(Item::as_value) {
        *value.decor_mut() = old.decor().clone();
    }
    table.insert(last, Item::Value(value));
    Ok(document.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_resolve_by_path_name_and_short_name() {
        let path = |name: &str| key_path(name).unwrap();
        assert_eq!(path("aspect_ratio"), "connector.aspect_ratio");
        assert_eq!(path("cor"), "alignment.center_of_rotation");
        assert_eq!(path("errors.x"), "errors.x");
        assert_eq!(path("connector.fixed.mesh"), "connector.fixed.mesh");
        assert!(
            matches!(key_path("mesh"), Err(DesignDefect::AmbiguousKey { paths, .. }) if paths.len() == 2)
        );
        assert!(matches!(key_path("x"), Err(DesignDefect::AmbiguousKey { .. })));
        let meant = |name: &str| match key_path(name) {
            Err(DesignDefect::NoSuchKey { meant, .. }) => meant,
            other => panic!("{other:?}"),
        };
        assert_eq!(meant("aspect_ration").as_deref(), Some("aspect_ratio"));
        assert_eq!(meant("connector"), None);
        assert_eq!(meant("pieces"), None, "a list of points is no single value");
    }

    #[test]
    fn one_key_changes_and_nothing_else() {
        let text = "# mine\n[connector]\nfamily = \"pyramid\" # this one\naspect_ratio = 1 # H/D\n";
        let edited = with_key(text, "connector.aspect_ratio", "0.25").unwrap();
        assert_eq!(edited, text.replace("= 1 #", "= 0.25 #"));
        let edited = with_key(text, "alignment.center_of_rotation", "5 mm").unwrap();
        assert_eq!(edited, format!("{text}\n[alignment]\ncenter_of_rotation = \"5 mm\"\n"));
        assert!(with_key(text, "connector.family", "cone").unwrap().contains("family = \"cone\" # this one"));
        assert!(with_key(text, "alignment.free", "[\"x\"]").unwrap().ends_with("free = [\"x\"]\n"));
        let inline = "connector = { family = \"cone\" }\n";
        assert!(with_key(inline, "connector.width", "3").unwrap().contains("width = 3"));
        assert!(with_key("connector = 3", "connector.width", "3").is_err());
        assert!(with_key("[", "connector.width", "3").is_err());
    }
}
