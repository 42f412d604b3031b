//! The inverse problem: a half from the wanted heights and the other half, by inversion of the Minkowski sum.
//!
//! ```text
//!   h(x) = max over u of  f(x + u) − g(u)        how high the moving half g stops over the fixed half f
//!   g(u) = max over x of  f(x + u) − h*(x)       the lowest g that nowhere stops higher than wanted
//! ```
//!
//! # Definition
//!
//! f is the upper surface of the fixed half, g the lower surface of the moving half as mounted, u the
//! position in the moving half, x the lateral offset, h* the wanted height of the moving face centre at first
//! contact. The two lines are an adjunction: g is the smallest function with h ≤ h*, and h = h* exactly where
//! h* is attainable with this f. The remainder, h* − h ≥ 0, is **unattainable**: every moving half that
//! reaches it stops higher than wanted somewhere else.
//!
//! The second line is itself a height of first contact: that of a body with the lower surface h* over f, at
//! the offset u. So the exact envelope of [`catchment::method::zraa`] computes both lines, as planes over
//! convex polygons; nothing is sampled.
//!
//! **Rotations.** With rotations free, g must also stay out of f at the other rotations R of the pair. The
//! heights are wanted at every combination of the rolls, pitches and yaws of a list, and g is the largest
//! over them of the heights that the fixed half, rotated by R⁻¹, requires: exact at the rotations of the
//! list; between them the excess is bounded, and is computed midway ([`Between`]).
//!
//! **Planar designs** are extruded solids with y locked: h* is taken along x, over a strip that is narrower than the gap of layers.
//!
//! # Units
//!
//! D and radians, as in the library; the mated face centres at the origin.
//!
//! # Not promised
//!
//! The moving half of a pair is recovered from its own heights, at any rotations, if it is solid above its
//! lower surface; a fixed half that reaches over its back when tilted makes g higher at the rim, because the
//! new half is assumed to have no back. Sides of pieces are known to [`SIDEWAYS`], walls of a mesh to
//! [`NARROW`]; wanted heights in a strip narrower than that are ignored, and pieces due to rounding are
//! removed.
//!
//! g is a surface without undercuts, on the plan of the design's own moving half. It is the lowest surface,
//! not necessarily a good part: slopes, widths and the acceptance of the result are reported, not improved.
//! Regions without wanted heights are empty.
//!
//! Source: the dissertation, section 7.2 (p. 108–109), which proposes this and gives no formula: the
//! adjunction, and all that follows from it, is ours.

mod cleaning;
mod figure;
mod file;
mod heights;
mod measure;
mod report;
mod table;
#[cfg(test)]
mod tests;
mod turns;

pub use figure::figure;
pub use file::{MAX_PIECES, design_file};
pub use heights::Heights;
pub use measure::Shortfall;
pub use report::{InvertBody, InvertReport, ManufacturingLimits, report};
pub use table::wanted_from_table;
pub use turns::{Between, MOST_TURNS, list_of_angles};

use catchment::connector::{Connector, Half};
use catchment::contact::Pair;
use catchment::design::Design;
use catchment::diagnostic::Diagnostic;
use catchment::exec::Exec;
use catchment::method::zraa::{HeightFacet, ZraaError, ZraaSettings, heights as first_contact, highest};
use catchment::pose::{Dof, rotation};
use glam::{DMat3, DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// Half the width of the strip along x over which heights of a planar design are requested, in D: half the
/// narrowest gap that a design may give its layers.
const STRIP: f64 = 0.005;
/// Beyond every offset at which halves touch, in D.
const FAR: f64 = 100.0;
/// Heights that are nearer than this, in D, are the same: reached.
pub const REACHED: f64 = 1e-9;
/// Sides of pieces are known to this, in D.
pub const SIDEWAYS: f64 = 2.5e-10;
/// Narrower than this, in D, a piece is rounding of a mesh and no feature of it: 0.2 µm of 40 mm.
pub const NARROW: f64 = 5e-6;
/// Places and planes nearer than this, in D, differ by rounding.
const ROUNDED: f64 = 1e-10;

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct InvertSettings {
    /// Rolls besides 0 at which heights are wanted, in radians. Rotations are all combinations with the
    /// pitches and yaws.
    pub roll: Vec<f64>,
    /// Pitches, in radians. Planar designs have no other rotation.
    pub pitch: Vec<f64>,
    /// Yaws, in radians.
    pub yaw: Vec<f64>,
    /// Thickness of the material behind the deepest point of the moving half, in D.
    pub backing: f64,
}

impl Default for InvertSettings {
    fn default() -> Self {
        // The backing of the families' own sockets.
        Self { roll: Vec::new(), pitch: Vec::new(), yaw: Vec::new(), backing: 0.25 }
    }
}

/// The other half, and how it does.
#[derive(Debug, Clone, PartialEq)]
pub struct Inverse {
    /// The wanted heights.
    pub wanted: Heights,
    /// Lower surface of the moving half, as mounted, over its plan.
    pub moving: Heights,
    /// The connector: the fixed half, and the new moving half, as mounted.
    pub connector: Connector,
    /// Heights of the result.
    pub reached: Heights,
    /// Places at which the result stays below the wanted heights.
    pub shortfalls: Vec<Shortfall>,
    /// Number of rotations besides 0 at which heights were wanted.
    pub turns: usize,
    /// Bounds between these rotations.
    pub between: Option<Between>,
    /// Area of the plan on which the halves touch at offset 0, in D².
    pub patch: f64,
    /// Area of the plan, in D².
    pub plan: f64,
    /// Steepest slope of the new surface: dz per length.
    pub steepest: f64,
    /// Least width of a facet of the new surface, in D.
    pub narrowest: f64,
    /// z of the back of the moving half, as mounted.
    pub back: f64,
    /// The settings.
    pub settings: InvertSettings,
}

/// Why there is no other half.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InvertError {
    /// The heights cannot be computed.
    #[error(transparent)]
    Heights(#[from] ZraaError),
    /// A wanted table covers nothing.
    #[error("no height is wanted at an offset at which the halves could touch")]
    NothingWanted,
    /// A planar design has neither roll nor yaw.
    #[error("a planar design turns in its plane alone: --pitch, not --roll or --yaw")]
    Planar,
    /// Too many rotations.
    #[error(
        "{count} rotations, more than {MOST_TURNS}: give fewer angles, all their combinations are computed"
    )]
    TooManyTurns {
        /// How many.
        count: usize,
    },
    /// A half that lies on its side.
    #[error("at roll {roll:.1}° and pitch {pitch:.1}° the halves stand side by side: tilt by less than 80°")]
    TooFar {
        /// In degrees.
        roll: f64,
        /// In degrees.
        pitch: f64,
    },
}

/// Whether y is not free: the design is a profile along x.
fn is_planar(design: &Design) -> bool {
    !design.alignment.free.contains(Dof::Y)
}

/// The offsets that count: all, or the strip along x.
fn counted(design: &Design, heights: Heights) -> Heights {
    if !is_planar(design) {
        return heights;
    }
    let strip = [(-FAR, -STRIP), (FAR, -STRIP), (FAR, STRIP), (-FAR, STRIP)].map(|(x, y)| DVec2::new(x, y));
    heights.within(&strip)
}

/// Heights of first contact of a connector's face centres, rotated by a rotation.
///
/// # Errors
/// If there are too many contacts, or the computation is cancelled.
pub fn heights_of(
    design: &Design,
    connector: &Connector,
    turn: DMat3,
    exec: &Exec,
) -> Result<Heights, InvertError> {
    let moving = connector.moving.mapped(|p| turn * p);
    let facets = first_contact(&connector.fixed, &moving, &ZraaSettings::default(), exec)?;
    Ok(counted(design, Heights { facets }).merged())
}

/// The plan of a half: the region that its surfaces cover, seen from below, with their lowest heights.
fn lower_surface(half: &Half, exec: &Exec) -> Result<Heights, InvertError> {
    // The half upside down, seen from above: facets that face up.
    let turned = half.mapped(|p| DVec3::new(p.x, -p.y, -p.z));
    let facets = turned.surfaces.iter().flat_map(|surface| {
        surface.facets.iter().filter(|f| f.normal.z > 1e-9).map(|f| {
            let corners: Vec<DVec3> = f.corners.iter().map(|k| surface.vertices[*k as usize]).collect();
            let gradient = DVec2::new(-f.normal.x, -f.normal.y) / f.normal.z;
            HeightFacet {
                offset: corners[0].z - gradient.dot(corners[0].truncate()),
                gradient,
                polygon: corners.iter().map(|c| c.truncate()).collect(),
            }
        })
    });
    let flipped = |f: HeightFacet| HeightFacet {
        polygon: f.polygon.iter().rev().map(|p| DVec2::new(p.x, -p.y)).collect(),
        offset: -f.offset,
        gradient: DVec2::new(-f.gradient.x, f.gradient.y),
    };
    exec.check().map_err(ZraaError::from)?;
    Ok(Heights { facets: facets.map(flipped).collect() })
}

/// The moving half for a fixed half and wanted heights, on the plan of the design's own moving half.
///
/// `wanted` applies at every offset without rotation, and the heights of the pair `turned` at the rotations
/// of the settings.
///
/// # Errors
/// If no heights are wanted, the rotations are not permitted, there are too many contacts, or the computation
/// is cancelled.
pub fn invert(
    design: &Design,
    connector: &Connector,
    wanted: Heights,
    turned: &Connector,
    settings: &InvertSettings,
    exec: &Exec,
) -> Result<Inverse, InvertError> {
    let turns = settings.turns(design)?;
    let plan = lower_surface(&connector.moving, exec)?;
    let over_plan = |fixed: &Half, body: &Half| -> Result<Vec<HeightFacet>, InvertError> {
        let whole = Heights { facets: first_contact(fixed, body, &ZraaSettings::default(), exec)? };
        Ok(plan.facets.iter().flat_map(|face| whole.within(&face.polygon).facets).collect())
    };
    let wanted = counted(design, wanted).merged();
    let (fixed, body) = turns::requested(&connector.fixed, &wanted, DMat3::IDENTITY, 0.0)
        .ok_or(InvertError::NothingWanted)?;
    let mut requested = Heights { facets: over_plan(&fixed, &body)? };
    let [floor, _] = requested.range().ok_or(InvertError::NothingWanted)?;
    for [roll, pitch, yaw] in &turns {
        let turn = rotation(*roll, *pitch, *yaw);
        let there = heights_of(design, turned, turn, exec)?;
        if let Some((fixed, body)) = turns::requested(&connector.fixed, &there, turn, floor) {
            // Rotations in sequence: the heights that a rotation requires are mostly hidden by those of the
            // others.
            requested.facets.extend(over_plan(&fixed, &body)?);
            requested =
                Heights { facets: highest(requested.facets, &ZraaSettings::default(), exec)? }.merged();
        }
    }
    let moving = requested.tidied();
    let Some([_, top]) = moving.range() else { return Err(InvertError::NothingWanted) };
    let back = top + settings.backing;
    let connector = Connector::from_halves(connector.fixed.clone(), moving.above(back));
    let reached = heights_of(design, &connector, DMat3::IDENTITY, exec)?;
    Ok(Inverse {
        shortfalls: measure::shortfalls(&wanted, &reached),
        turns: turns.len(),
        between: turns::between(design, turned, &connector, settings, exec)?,
        patch: measure::patch(&connector.fixed, &moving, reached.at(DVec2::ZERO)),
        plan: moving.area(),
        steepest: moving.facets.iter().map(|f| f.gradient.length()).fold(0.0, f64::max),
        narrowest: moving.facets.iter().map(|f| heights::width(&f.polygon)).fold(f64::INFINITY, f64::min),
        wanted,
        moving,
        connector,
        reached,
        back,
        settings: settings.clone(),
    })
}

/// Warnings about the mated pose of the result, as in `catchment check`, if it is not a rest.
pub fn warnings(design: &Design, inverse: &Inverse) -> Vec<Diagnostic> {
    let pair = Pair::new(&inverse.connector, &design.alignment);
    catchment::contact::mated::problems(&pair)
        .iter()
        .map(|problem| Diagnostic::warning("mated-pose", problem.to_string()))
        .collect()
}
