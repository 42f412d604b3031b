//! Published docking systems with the facts about their areas of acceptance, and the rank of a design among
//! them.
//!
//! ```text
//!   table 1.1   27 systems × 11 attributes ─┐ joined by a list of names,
//!   table 2.1   11 areas of acceptance ─────┤ never by likeness
//!   section 4.1 the 3-D X-Face, 2.0 ────────┴──▶ Catalog ──▶ table, CSV, JSON, Markdown, figures 2.1 and 4.2
//!                                                  ▲
//!   a design ──▶ classify ── degree, gendering ────┘ a row of its own
//! ```
//!
//! Areas are in D², D the characteristic length of the face, edges in D. Printed values are kept unchanged:
//! if a value is not among those that the text defines, a normal form is added with its reason ([`Oddity`]).
//! Every number has its provenance ([`Provenance`]): stated by the dissertation, computed here from stated
//! numbers, or our reading.
//!
//! Not promised: that an area computed here is that of the built system. Three geometries are specified well
//! enough to compute ([`GEOMETRY`]); for all others only the printed number exists. Source: the dissertation,
//! sections 1.1 (table 1.1), 2.1.1 (table 2.1, figure 2.1) and 4.1 (figure 4.2).

mod attribute;
mod classify;
mod data;
mod designs;
mod facts;
pub mod figure;
mod filter;
pub mod report;
mod rule;

pub use attribute::{CatalogAttribute, ODDITIES, Oddity};
pub use classify::{Classified, ClassifyError, Ratio, classify};
pub use data::{ALIASES, Catalog, DataError, PublishedTable, PublishedZraa, RowSource, System};
pub use designs::{DESIGNS, DesignText};
pub use facts::{AcceptanceShape, Fact, GEOMETRY, Number, Provenance, numbers};
pub use filter::{Condition, RowOrder, UnknownError};
pub use rule::{Degree, Extents, HIGH};
