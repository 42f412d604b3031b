//! Drawing primitives: a thin writer of SVG, frames with round ticks, charts, colours.
//!
//! The module is public, so that other pictures can have the style of this crate:
//!
//! ```
//! use catchment_report::figure::Picture;
//! use catchment_report::figure::draw::axis::{PlotFrame, AxisScale};
//! use catchment_report::figure::draw::svg::{Rect, Svg};
//!
//! let mut svg = Svg::new(300.0, 240.0);
//! let rect = Rect { x: 60.0, y: 20.0, w: 220.0, h: 160.0 };
//! let length = |name: &str| AxisScale::new(format!("{name} [mm]"), 0.0, 50.0, false);
//! let frame = PlotFrame { rect, x: length("x"), y: length("y") };
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
