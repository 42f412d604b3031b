//! Published numbers recomputed, and the accuracy of the methods of [`catchment`].
//!
//! ```text
//!   published ──▶ recipe ──▶ tables ──▶ study ──▶ report
//!   (printed       (how an     (which,     (compare,    (text, CSV, JSON,
//!    numbers)       entry is    and where   accuracy,    Markdown, pictures)
//!                   computed)   they differ) coverage)
//! ```
//!
//! Imports run against that flow. The library does not depend on this crate.
//!
//! - [`published`]: the printed tables, as data.
//! - [`recipe`]: computation of an entry, by the method of its table and exactly; [`recipe::dissertation`] holds the
//!   conventions that reproduce the discrete tables.
//! - [`tables`]: the reproducible tables and their known differences.
//! - [`study`]: published and recomputed tables, a recomputed figure, the accuracy of every method, the coverage of stated
//!   intervals.
//! - [`report`]: output for people and programs.
//!
//! **Not promised:** that published numbers are right. Many were reproduced with conventions fitted to these very numbers; each
//! result names its conventions.

pub mod published;
pub mod recipe;
pub mod report;
pub mod study;
pub mod tables;
