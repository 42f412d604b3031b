//! The committed designs, ready for contact: what every bench measures on.

use catchment_core::connector::Connector;
use catchment_core::contact::Pair;
use catchment_core::design::read;
use std::path::Path;

/// The pair of a file in `designs/`.
pub(crate) fn pair(name: &str) -> Pair {
    let designs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs");
    let text = std::fs::read_to_string(designs.join(name)).expect("a committed design");
    let design = read(&text, &designs).expect("a sound design").design;
    Pair::new(&Connector::build(&design).expect("a sound connector"), &design.alignment)
}
