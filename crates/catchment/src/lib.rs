//! How much misalignment does a docking connector forgive?
//!
//! `catchment` takes the geometry of the two halves of a connector and computes which pose errors
//! (x, y, roll, pitch, yaw) their contact passively corrects: the *area of acceptance*, the catchment
//! basin of the mated pose in configuration space.
//!
//! # The tour: from a design to its numbers
//!
//! A V-shaped tip meets its notch, free to be wrong in x and pitch. Which errors does it forgive?
//!
//! ```
//! use catchment::acceptance::Domain;
//! use catchment::connector::Connector;
//! use catchment::contact::Pair;
//! use catchment::exec::Exec;
//! use catchment::landscape::Grid;
//! use catchment::merit::onaa::Onaa;
//! use catchment::merit::sum::Sum;
//! use catchment::method::descent;
//! use catchment::report::{self, Report};
//! use catchment::design;
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
//! let design = design::read(text, ".".as_ref())?.design;
//!
//! // 2. Two solids, and what happens when one is lowered onto the other: they touch where the notch's two
//! //    corners meet the slopes of the tip. Aligned, the centre of rotation is at the world's origin.
//! let connector = Connector::build(&design).map_err(|problems| problems[0].to_string())?;
//! let pair = Pair::new(&connector, &design.alignment);
//!
//! // 3. Every cell of the error box is followed to its end, exactly and without a grid in between.
//! let grid = Grid::over(&design.alignment, |_| 40);
//! let (settings, exec) = (descent::Settings::default(), Exec::new());
//! let (acceptance, _ends) = descent::run(&pair, Domain::Grid(grid), &settings, &exec)?;
//!
//! // 4. What the accepted set is worth: 2.39 D·rad at full resolution, 38 % of the error box.
//! let sum = Sum::of(&acceptance, &design.alignment);
//! assert!((sum.sum - 2.39).abs() < 0.05, "{}", sum.sum);
//! assert_eq!(sum.unit(), "D·rad");
//! assert!((Onaa::of(&acceptance, &exec)?.edge - 0.3).abs() < 0.03);
//!
//! // 5. For people, in their own units.
//! let report = Report::new(&design, &acceptance, serde_json::to_value(&settings)?, None, &exec)?;
//! let table = report::table(&report);
//! assert!(table.contains("mm") && table.contains("deg"), "{table}");
//! # println!("{table}");
//! # Ok(())
//! # }
//! ```
//!
//! # The rooms
//!
//! Data walks through them in one direction; imports run against it.
//!
//! ```text
//! design ─▶ poses ─▶ connector ─▶ contact ─▶ landscape ─▶ acceptance ─▶ method ─▶ merit ─▶ study ─▶ report
//! ```
//!
//! - [`design`]: the design file, typed; all its problems at once, each with line, column and advice.
//! - [`poses`]: pose errors as people write them, tables of them, and how they are distributed.
//! - [`connector`]: the two halves as closed solids, from a family, convex pieces or STL files.
//! - [`contact`]: the height of first contact, exactly, and what touches there.
//! - [`landscape`]: the error grid over any of the five errors, and the heights over it.
//! - [`acceptance`]: what becomes of every pose error; the one result that all methods share.
//! - [`method`]: ways to decide: exact descent, flooding, the planar kinematic one, translation alone.
//! - [`merit`]: what an accepted set is worth: Sum, ONAA, tolerances, success probability.
//! - [`study`]: many computations of one design: slices, convergence, sensitivity.
//! - [`report`]: JSON, text, pictures, Zarr.
//!
//! [`pose`] owns frames, signs and the order of angles; [`exec`] owns threads, cancelling, progress and the
//! memory budget, none of which changes a bit of a result; [`suggest`] knows what a misspelt word meant, [`advice`] what helps
//! where something is refused. [`polytope`] is the geometry of convex sets in up to six
//! dimensions.
//!
//! Lengths are in D, the connector's width; angles are in radians.
//!
//! # What is not promised
//!
//! The model is frictionless, quasi-static and overdamped: friction, speed, mass and bounce are left out. A grid
//! sees the centres of its cells and nothing between. Doubts about a result travel inside it, as
//! [`acceptance::Warning`]s. The file `docs/limits.md` of the source tree has the whole list.

pub mod acceptance;
pub mod advice;
pub mod connector;
pub mod contact;
pub mod design;
pub mod exec;
pub mod landscape;
pub mod merit;
pub mod method;
pub mod polytope;
pub mod pose;
pub mod poses;
pub mod problem;
pub mod report;
pub mod run;
pub mod study;
pub mod suggest;
