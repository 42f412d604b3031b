//! Drawing primitives: a thin writer of SVG, the layout of a page, frames with round ticks, charts, colours.
//!
//! The module is public, so that other pictures can have the style of this crate:
//!
//! ```
//! use catchment_report::figure::Picture;
//! use catchment_report::figure::draw::axis::{PlotFrame, AxisScale};
//! use catchment_report::figure::draw::layout::{Layout, Panel};
//!
//! let (mut svg, frames) = Layout::titled("a lens").row([Panel::with_axes([220.0, 160.0])]).open();
//! let length = |name: &str| AxisScale::new(format!("{name} [mm]"), 0.0, 50.0, false);
//! let frame = PlotFrame { rect: frames[0], x: length("x"), y: length("y") };
//! frame.draw(&mut svg);
//! svg.circle(frame.at([25.0, 10.0]), 3.0, r##"fill="#2d4261""##);
//! assert!(Picture::of(svg).svg().contains("y [mm]"));
//! ```

pub mod arrow;
pub mod axis;
pub mod chart;
pub mod colour;
pub mod layout;
pub mod svg;
