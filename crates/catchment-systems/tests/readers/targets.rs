//! What must hold of the readers of this crate, whatever they read: for the tests beside, and for the fuzzer.

use catchment::design::SourceText;
use catchment::diagnostic::Diagnostics;
use catchment::exec::Exec;
use catchment_systems::chain::{ChainFile, sequence};
use catchment_systems::compose::read::{ReadError, read};
use catchment_systems::invert::wanted_from_table;
use catchment_systems::latch::LatchDesign;

/// The first line names what the rest is: `latch`, `chain`, `steps`, `heights`, or `csv`, `svg`, `toml` for a region. What is refused has its
/// places in the text.
pub(crate) fn file(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let (kind, text) = text.split_once('\n').unwrap_or((&text, ""));
    let source = |ending: &str| SourceText::new(format!("file.{ending}"), text);
    let exec = Exec::new().with_memory_budget(32 << 20);
    let refused = match kind.trim() {
        "latch" => LatchDesign::read(source("toml")).err(),
        "chain" => ChainFile::read(source("toml")).err(),
        "steps" => sequence::table(&source("csv")).err(),
        "heights" => wanted_from_table(source("csv")).err(),
        // A connector is another reader's, and takes as long as its geometry.
        "toml" if text.contains("connector") => None,
        kind @ ("csv" | "svg" | "toml") => match read(source(kind), &exec) {
            Err(ReadError::Diagnostics(diagnostics)) => Some(diagnostics),
            Ok(_) | Err(_) => None,
        },
        _ => None,
    };
    if let Some(Diagnostics { list, .. }) = refused {
        assert!(!list.is_empty());
        for diagnostic in &list {
            assert!(!diagnostic.message.is_empty());
            let in_text = diagnostic.span.clone().is_none_or(|span| text.get(span).is_some());
            assert!(in_text, "{diagnostic:?} is not a piece of the text");
        }
    }
}
