//! How much misalignment does a docking connector forgive?
//!
//! `catchment` takes the geometry of the two halves of a connector and computes which pose errors
//! (x, y, roll, pitch, yaw) their contact passively corrects: the *area of acceptance*, the catchment
//! basin of the mated pose in configuration space.
//!
//! # Ten lines
//!
//! A V-shaped tip meets its notch, free to be wrong in x and pitch. Which errors does it forgive?
#![cfg_attr(all(feature = "figure", feature = "zarr"), doc = "```")]
#![cfg_attr(not(all(feature = "figure", feature = "zarr")), doc = "```ignore")]
#![doc = include_str!("../examples/quickstart.rs")]
//! ```
//!
//! The same without a file, from triangles in memory:
//!
//! ```
#![doc = include_str!("../examples/in_memory.rs")]
//! ```
//!
//! # The tour: what a run does
//!
//! ```
//! use catchment::prelude::*;
//! use catchment::design::SourceText;
//! use catchment::report;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // 1. What a person wrote. Every problem comes back at once, each with its place in the text.
//! let text = r#"
//!     schema = 1
//!     name = "V-Face"
//!     [connector]
//!     family = "v-face"
//!     aspect_ratio = 1.0
//!     width = 50.0
//!     unit = "mm"
//!     [alignment]
//!     rotation_length = 1.0
//!     [errors]
//!     x = "50 mm"
//!     pitch = "90 deg"
//! "#;
//! let draft = Draft::read(SourceText::new("v-face.toml", text))?;
//!
//! // 2. Two solids that hold in the mated pose, and a digest of all that an answer depends on.
//! let problem = draft.build()?;
//! assert!(problem.mated_warnings().is_empty() && problem.digest().len() == 64);
//!
//! // 3. A run is data: the method with its settings, the grid, the random poses. The default method, confluence, follows
//! //    the cells of the error box until they join others; random poses, followed exactly, then make the Sum unbiased.
//! let run = Run { over: Over::Grid("40".parse()?), ..Run::default() };
//! let plan = run.plan(&problem)?;
//! assert_eq!((plan.method.name(), plan.domain.len()), ("confluence", 1600));
//!
//! // 4. What the accepted set is worth: 2.38 D·rad, 38 % of the error box, with a 95 % interval.
//! let answer = run.on(&problem, &Exec::new())?;
//! let [lo, hi] = answer.sum_ci95().ok_or("random poses were drawn")?;
//! assert!(lo < 2.38 && 2.38 < hi && hi - lo < 0.2, "{lo} {hi}");
//! assert_eq!(answer.unit(), "D·rad");
//! assert!(answer.onaa().is_some_and(|onaa| (onaa.edge - 0.3).abs() < 0.03));
//!
//! // 5. For people, in their own units.
//! let table = Report::of_answer(&answer).table();
//! assert!(table.contains("mm") && table.contains('°'), "{table}");
//!
//! // 6. Another method has the same interface; its settings have names.
//! let flood: Method = "flood".parse()?;
//! assert!(Run { over: run.over, ..Run::by(flood) }.on(&problem, &Exec::new())?.by_products.basins.is_some());
//! # Ok(())
//! # }
//! ```
//!
//! # The rooms
//!
//! Data walks through them in one direction; imports run against it.
//!
//! ```text
//! design ─▶ xml ─▶ poses ─▶ connector ─▶ contact ─▶ problem ─▶ landscape ─▶ acceptance ─▶ method ─▶ merit ─▶ run ─▶ study ─▶ report
//! ```
//!
//! - [`design`]: the design file, typed; all its problems at once, each with line, column and advice.
//! - [`xml`]: XML piece by piece within limits, and what an SVG picture hides.
//! - [`poses`]: parsing of pose errors (inline, tables) and their distributions.
//! - [`connector`]: the two halves as closed solids, from a family, convex pieces, mesh files or triangles in memory.
//! - [`contact`]: the height of first contact, exactly, and what touches there.
//! - [`problem`]: the alignment problem as one value: geometry, alignment, mated pose checked, digest.
//! - [`landscape`]: the error grid over any of the five errors, and the heights over it.
//! - [`acceptance`]: the outcome of every pose error: the result that all methods share.
//! - [`method`]: ways to decide, all with one interface: confluence of exact motions (the default), exact descent, transport, flooding in three forms, the
//!   polyhedral partition, the planar kinematic one, drop tests; and translation alone.
//! - [`merit`]: what an accepted set is worth: Sum, ONAA, tolerances, success probability.
//! - [`document`]: the description of a result, from which text, CSV, Markdown and HTML are rendered.
//! - [`run`]: plan, decide, correct, settle, measure: from a problem to its answer. Over many machines, too.
//! - [`study`]: many runs, and what they say together.
//! - [`report`]: JSON, text, tables, pictures, Zarr: the one place that tells results.
//!
//! [`pose`] owns frames, signs, the order of angles and the metric; [`exec`] owns threads, the clock, cancelling, progress and the
//! memory budget, none of which changes a bit of a result; [`budget`] limits what a reader may spend on one input; [`suggest`] knows what a
//! misspelt word meant, [`diagnostic`] every error, warning and note with its code, place and advice, [`terminal`] what may be shown of foreign names, [`tolerance`] the scales
//! below which two lengths count as one, [`disjoint`] sets that are joined. [`polytope`] is the
//! geometry of convex sets in up to six dimensions. [`prelude`] is one `use` for
//! all that a program needs.
//!
//! Lengths are in D, the connector's width; angles are in radians.
//!
//! # What is not promised
//!
//! The model is frictionless, quasi-static and overdamped: friction, speed, mass and bounce are left out (drop tests have them). A grid
//! sees the centres of its cells and nothing between. What speaks against a result travels inside it, as
//! [`diagnostic::Diagnostic`]s. The file `docs/limits.md` of the source tree has the whole list.

pub mod prelude;

pub use catchment_core::{
    acceptance, budget, connector, contact, design, diagnostic, disjoint, document, exec, landscape, merit,
    method, polytope, pose, poses, problem, run, suggest, terminal, tolerance, xml,
};
pub use catchment_report as report;
pub use catchment_study as study;
