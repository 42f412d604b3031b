//! Two moving halves: the approach region, over which they meet.
//!
//! ```text
//!      B's reach, turned to face A              A ⊕ B: positions of B's robot
//!         ╭───╮                                   ╭───────────╮
//!         ╰───╯    d: from A's robot to B's       │     ·     │ ← d
//!           ·                                     ╰───────────╯
//!       ╭───────╮                                       ·
//!       ╰───╳───╯  A's reach                            A's robot
//! ```
//!
//! # Definition
//!
//! A and B are the swept regions of the two halves, each in the frame of its robot. With B's robot at d from
//! A's, they can dock if the two swept regions meet: A ∩ (B' + d) ≠ ∅, which is **d ∈ A ⊕ (−B')**, the
//! Minkowski sum with one region reflected; B' is B as mounted.
//!
//! - [`RegionFrames::Own`]: both are drawn facing +y, and B is mounted by a half turn, as everywhere in catchment:
//!   B' = −B, rotated by the heading, and the result is **A ⊕ B**, without a reflection.
//! - [`RegionFrames::World`]: B is drawn in its position before A: B' = B, and the result is **A ⊕ (−B)**.
//!
//! The plane is the plane of motion of the robots: lateral offset *and gap*. It is not the (x, y) of a pose
//! error, because the approach is inside the region. With a relative heading ψ, B' is rotated by ψ; over a
//! range of headings the result is a stack of regions, and its volume is their area integrated over ψ.
//!
//! **Bodies.** If the robots' bodies overlap they cannot dock: the interior of A's body ⊕ (−B's body) is
//! removed.
//!
//! **Quality.** The area of A ∩ (B' + d) is the convolution proper: 0 on the border of the region, and its integral over all d
//! is area(A)·area(B). See [`RegionOverlap`]; its largest value lies between two bounds ([`peak`]).
//!
//! # Units
//!
//! Millimetres, or D if both regions come from connectors without a unit; areas mm² or D², volumes times rad.
//!
//! # Not promised
//!
//! A single common point counts as meeting: the halves need not hold together. Both motions are treated as
//! swept completely, one after another: timing, and bodies that push each other away, are neglected. Corners
//! are rounded to 2⁻³² mm ([`UNIT`]); arcs lie between an inner and an outer polygon, and areas are given
//! with both.
//!
//! Source: the dissertation, section 2.5 (p. 20–22) and figures 2.4–2.6: a swinging hook and a loop of string
//! between two boats, the acceptance region as the convolution of the two regions. It gives no length, angle
//! or area, and attributes the departures of its experiment to further constraints of the boats, and to their
//! hulls.

pub mod brute;
mod cell;
mod figure;
pub mod measure;
mod overlap;
mod peak;
pub mod read;
mod region;
mod report;
mod sum;
pub mod sweep;
#[cfg(test)]
mod tests;

pub use figure::figure;
pub use overlap::RegionOverlap;
pub use peak::{Peak, peak};
pub use region::{REACH, Region, UNIT};
pub use report::{ComposeBody, ComposeReport, outline_svg, report};
pub use sum::{SumError, minkowski_sum};

use catchment::exec::{Cancelled, Exec};
use glam::DVec2;
use measure::{AxisReach, LargestSquare, largest_square, reach, square_about};
use read::{Measure, ParsedRegion};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use sweep::Bracket;

/// Frames in which the two regions are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum RegionFrames {
    /// Each region in the frame of its own robot, facing +y; a half turn mounts the second.
    #[default]
    Own,
    /// The second region in its position before the first.
    World,
}

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ComposeSettings {
    /// In which frames the regions are drawn.
    pub frames: RegionFrames,
    /// Relative headings of the second robot, in radians, counter-clockwise, evenly spaced; at least one.
    pub headings: Vec<f64>,
    /// Cells of the map of the overlap along the longer side of the region.
    pub map_cells: usize,
}

impl Default for ComposeSettings {
    fn default() -> Self {
        Self { frames: RegionFrames::Own, headings: vec![0.0], map_cells: 96 }
    }
}

/// The approach region at a given heading.
#[derive(Debug, Clone, PartialEq)]
pub struct HeadingSlice {
    /// Relative heading, in radians.
    pub heading: f64,
    /// Places of the second robot, seen from the first.
    pub region: Bracket,
}

/// Area of the overlap over a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct OverlapMap {
    /// Lower left corner of the first cell.
    pub low: DVec2,
    /// Side of a cell.
    pub cell: f64,
    /// Cells along x and y.
    pub cells: [usize; 2],
    /// Overlap at the cells' centres, row by row from below.
    pub values: Vec<f64>,
}

/// The approach region of two halves, with its measures.
#[derive(Debug, Clone, PartialEq)]
pub struct Composition {
    /// The two halves.
    pub halves: [ParsedRegion; 2],
    /// The robots' bodies, if known.
    pub bodies: Option<[ParsedRegion; 2]>,
    /// The settings.
    pub settings: ComposeSettings,
    /// A slice for each heading.
    pub slices: Vec<HeadingSlice>,
    /// The described slice: that nearest to heading 0.
    pub shown: usize,
    /// ∫ area dψ over the headings, in mm²·rad, by the trapezoidal rule; `None` for a single heading.
    pub volume: Option<[f64; 2]>,
    /// The largest square in the inner region shown.
    pub square: Option<LargestSquare>,
    /// Tolerance along each axis from its centre.
    pub reach: Option<AxisReach>,
    /// Side of the largest square about d = 0; `None` if that is outside.
    pub square_about_zero: Option<f64>,
    /// Overlap of the outer regions, at the heading shown; bodies take nothing from it.
    pub map: OverlapMap,
    /// The largest overlap, at the heading shown; the bodies do not reduce it. `None` if a region is empty.
    pub peak: Option<Peak>,
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ComposeError {
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The regions are too fine or too large.
    #[error(transparent)]
    Sum(#[from] SumError),
    /// Lengths in mm and in D do not mix.
    #[error(
        "the units are mixed: {first} is in {} and {second} in {}; give the connector a unit (connector.unit)",
        of_first.symbol(), of_second.symbol()
    )]
    MixedUnits {
        /// Name of the first.
        first: String,
        /// Its unit.
        of_first: Measure,
        /// Name of the second.
        second: String,
        /// Its unit.
        of_second: Measure,
    },
}

/// −B', the second region as it is added to the first: mounted, turned, reflected.
fn added(second: &Bracket, frames: RegionFrames, heading: f64) -> Bracket {
    let angle = match frames {
        // The half turn of the mount and the reflection cancel.
        RegionFrames::Own => heading,
        RegionFrames::World => heading + PI,
    };
    second.map(|region| region.turned(angle))
}

/// Computes the approach region of the two halves.
///
/// # Errors
/// If lengths are in different units, regions too fine or too large, or the computation is cancelled.
pub fn compose(
    halves: [ParsedRegion; 2],
    bodies: Option<[ParsedRegion; 2]>,
    settings: &ComposeSettings,
    exec: &Exec,
) -> Result<Composition, ComposeError> {
    let all: Vec<&ParsedRegion> = halves.iter().chain(bodies.iter().flatten()).collect();
    if let Some(other) = all.iter().find(|read| read.measure != all[0].measure) {
        return Err(ComposeError::MixedUnits {
            first: all[0].name.clone(),
            of_first: all[0].measure,
            second: other.name.clone(),
            of_second: other.measure,
        });
    }
    let slice = |k: usize| -> Result<HeadingSlice, ComposeError> {
        let heading = settings.headings[k];
        let of =
            |pair: &[ParsedRegion; 2]| pair[0].region.sum(&added(&pair[1].region, settings.frames, heading));
        let mut region = of(&halves)?;
        if let Some(bodies) = &bodies {
            region = region.minus(&of(bodies)?);
        }
        Ok(HeadingSlice { heading, region })
    };
    let slices = exec.try_map(settings.headings.len(), slice)?;
    let shown = (0..slices.len())
        .min_by(|a, b| slices[*a].heading.abs().total_cmp(&slices[*b].heading.abs()))
        .unwrap_or_default();
    let volume = (slices.len() > 1).then(|| {
        let areas: Vec<[f64; 2]> = slices.iter().map(|slice| slice.region.area()).collect();
        [0, 1].map(|k| {
            let pairs = slices.windows(2).zip(areas.windows(2));
            pairs.map(|(s, a)| (s[1].heading - s[0].heading) * (a[0][k] + a[1][k]) / 2.0).sum()
        })
    });
    let inner = &slices[shown].region.inner;
    exec.check()?;
    let square = largest_square(inner);
    let (reach, square_about_zero) = (
        square.and_then(|square| reach(inner, square.center)),
        square_about(inner, DVec2::ZERO).map(|h| 2.0 * h),
    );
    let stands = added(&halves[1].region, settings.frames, slices[shown].heading).map(Region::reflected);
    let map = map(&halves[0].region.outer, &stands.outer, settings, exec)?;
    let peak = peak(&halves[0].region, &stands, exec)?;
    Ok(Composition {
        halves,
        bodies,
        settings: settings.clone(),
        slices,
        shown,
        volume,
        square,
        reach,
        square_about_zero,
        map,
        peak,
    })
}

/// The overlap over a grid around all positions at which the first region meets the second in its
/// orientation.
fn map(
    first: &Region,
    stands: &Region,
    settings: &ComposeSettings,
    exec: &Exec,
) -> Result<OverlapMap, ComposeError> {
    let empty = OverlapMap { low: DVec2::ZERO, cell: 0.0, cells: [0; 2], values: Vec::new() };
    let (Some([la, ha]), Some([lb, hb])) = (first.bounds(), stands.bounds()) else { return Ok(empty) };
    let (low, high) = (la - hb, ha - lb);
    let cell = (high - low).max_element() / settings.map_cells as f64;
    if cell <= 0.0 {
        return Ok(empty);
    }
    let cells = [high.x - low.x, high.y - low.y].map(|extent| ((extent / cell).ceil() as usize).max(1));
    let overlap = RegionOverlap::new(first, stands);
    let row = |j: usize| -> Vec<f64> {
        let at = |i: usize| low + DVec2::new(i as f64 + 0.5, j as f64 + 0.5) * cell;
        (0..cells[0]).map(|i| overlap.at(at(i))).collect()
    };
    Ok(OverlapMap { low, cell, cells, values: exec.map(cells[1], row)?.concat() })
}
