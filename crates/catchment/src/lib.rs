//! How much misalignment does a docking connector forgive?
//!
//! `catchment` takes the geometry of the two halves of a connector and computes which pose errors
//! (x, y, roll, pitch, yaw) their contact passively corrects: the *area of acceptance*, the catchment
//! basin of the mated pose in configuration space.
//!
//! # Ten lines
//!
//! A V-shaped tip docks in its notch, with errors in x and pitch. Which errors does the contact correct?
#![cfg_attr(all(feature = "figure", feature = "zarr"), doc = "```")]
#![cfg_attr(not(all(feature = "figure", feature = "zarr")), doc = "```ignore")]
#![doc = include_str!("../examples/quickstart.rs")]
//! ```
//!
//! The same computation without a file, from triangles in memory:
//!
//! ```
#![doc = include_str!("../examples/in_memory.rs")]
//! ```
//!
//! # Tour: the steps of a run
//!
//! ```
//! use catchment::prelude::*;
//! use catchment::design::SourceText;
//! use catchment::report;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // 1. The design as text. `read` reports every problem at once, each with its place in the text.
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
//! // 2. Two solids whose mated pose is a rest, and a digest of every input of the result.
//! let problem = draft.build()?;
//! assert!(problem.mated_warnings().is_empty() && problem.digest().len() == 64);
//!
//! // 3. A run is data: the method with its settings, the grid, the sampled poses. The default method, confluence, follows
//! //    a cell of the error box until its motion joins another cell's; exactly followed samples then make the Sum unbiased.
//! let run = Run { over: Over::Grid("40".parse()?), ..Run::default() };
//! let plan = run.plan(&problem)?;
//! assert_eq!((plan.method.name(), plan.domain.len()), ("confluence", 1600));
//!
//! // 4. The merit of the accepted set: 2.38 D·rad, 38 % of the error box, with a 95 % confidence interval.
//! let answer = run.on(&problem, &Exec::new())?;
//! let [lo, hi] = answer.sum_ci95().ok_or("random poses were drawn")?;
//! assert!(lo < 2.38 && 2.38 < hi && hi - lo < 0.2, "{lo} {hi}");
//! assert_eq!(answer.unit(), "D·rad");
//! assert!(answer.onaa().is_some_and(|onaa| (onaa.edge - 0.3).abs() < 0.03));
//!
//! // 5. A table in the units of the design.
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
//! # Modules
//!
//! Data flows through the modules in one direction; imports run against it.
//!
//! ```text
//! design ─▶ xml ─▶ poses ─▶ connector ─▶ contact ─▶ problem ─▶ landscape ─▶ acceptance ─▶ method ─▶ merit ─▶ run ─▶ study ─▶ report
//! ```
//!
//! - [`design`]: the typed design file; reports all problems at once, each with line, column and advice.
//! - [`xml`]: streaming XML within limits, and the hidden parts of an SVG picture.
//! - [`poses`]: parsing of pose errors (inline, tables) and their distributions.
//! - [`connector`]: the two halves as closed solids, from a family, convex pieces, mesh files or triangles in memory.
//! - [`contact`]: the exact height of first contact, and the contacts there.
//! - [`problem`]: the alignment problem as one value: geometry, alignment, checked mated pose, digest.
//! - [`landscape`]: the error grid over any of the five errors, and the heights over it.
//! - [`acceptance`]: the outcome of every pose error: the result type that all methods share.
//! - [`method`]: the methods, all with one interface: confluence of exact motions (the default), exact descent, transport, flooding in three forms, the
//!   polyhedral partition, the planar kinematic partition, drop tests, and translation alone.
//! - [`merit`]: measures of an accepted set: Sum, ONAA, tolerances, success probability.
//! - [`document`]: the description of a result, from which text, CSV, Markdown and HTML are rendered.
//! - [`run`]: plan, decide, correct, settle, measure: from a problem to its result, also distributed over
//!   several machines.
//! - [`study`]: studies of many runs, and their combined results.
//! - [`proposal`]: the design that docks two parts from CAD files.
//! - [`report`]: JSON, text, tables, pictures, Zarr: the only module that formats results.
//!
//! [`pose`] owns frames, signs, the order of angles and the metric. [`exec`] owns threads, the clock, cancellation, progress
//! and the memory budget; none of them changes a bit of a result. [`budget`] limits the resources a reader may spend on one
//! input. [`suggest`] finds the intended word for a misspelt one. [`diagnostic`] defines every error, warning and note with
//! its code, place and advice. [`terminal`] sanitises foreign names before they are printed. [`tolerance`] holds the scales
//! below which two lengths count as equal. [`disjoint`] is a union-find structure. [`polygon`] finds what two convex
//! polygons have in common. [`polytope`] is the geometry of convex sets in up to six dimensions. [`prelude`] imports everything that a typical program needs in one `use`.
//!
//! Lengths are in D, the connector's width; angles are in radians.
//!
//! # What is not promised
//!
//! The model is frictionless, quasi-static and overdamped: it leaves out friction, speed, mass and bounce (drop tests have them). A
//! grid samples the centres of its cells and nothing between them. A result carries its own reservations as
//! [`diagnostic::Diagnostic`]s. The file `docs/limits.md` of the source tree has the whole list.

pub mod prelude;

pub use catchment_core::{
    acceptance, budget, connector, contact, design, diagnostic, disjoint, document, exec, landscape, merit,
    method, polygon, polytope, pose, poses, problem, run, suggest, terminal, tolerance, xml,
};
pub use catchment_proposal as proposal;
pub use catchment_report as report;
pub use catchment_study as study;
