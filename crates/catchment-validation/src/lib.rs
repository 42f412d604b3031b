//! Published numbers computed again, and how far the methods of [`catchment`] can be trusted.
//!
//! ```text
//!   published ──▶ recipe ──▶ tables ──▶ study ──▶ report
//!   (printed       (how an     (which,     (compare,    (text, CSV, JSON,
//!    numbers)       entry is    and where   accuracy,    Markdown, pictures)
//!                   computed)   they differ) coverage)
//! ```
//!
//! Imports run against that flow. The library knows nothing of this crate.
//!
//! - [`published`]: the printed tables, as data.
//! - [`recipe`]: how an entry is computed, by the method of its table and exactly; [`recipe::dissertation`] holds the
//!   conventions that reproduce the discrete tables.
//! - [`tables`]: which tables there are, and where they are known to differ.
//! - [`study`]: the tables beside ours, a figure drawn again, the accuracy of every method, the coverage of stated intervals.
//! - [`report`]: what a person or a program reads of them.
//!
//! **Not promised:** that published numbers are right. Many were reproduced with conventions fitted to these very numbers; each
//! result says which.

pub mod published;
pub mod recipe;
pub mod report;
pub mod study;
pub mod tables;
