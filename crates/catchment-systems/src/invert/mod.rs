//! Wanted heights and one half give the other: the Minkowski sum undone.
//!
//! ```text
//!   h(x) = max over u of  f(x + u) − g(u)        how high the moving half g stops over the fixed half f
//!   g(u) = max over x of  f(x + u) − h*(x)       the lowest g that nowhere stops higher than wanted
//! ```
//!
//! # Definition
//!
//! f is the upper surface of the fixed half, g the lower surface of the moving one as mounted, u the place in the moving half, x the
//! lateral offset, h* the wanted height of the moving face centre at first contact. The two lines are an adjunction: g is the
//! smallest function with h ≤ h*, and h = h* exactly where h* can be reached at all with this f. What
//! remains, h* − h ≥ 0, is **unattainable**: no moving half reaches it without stopping higher than wanted somewhere else.
//!
//! The second line is itself a height of first contact: that of a body with the lower surface h* over f, at the offset u. So the
//! exact envelope of [`catchment::method::zraa`] computes both lines, as planes over convex polygons; nothing is sampled.
//!
//! **Rotations.** With rotations free, g must also stay out of f at the other rotations R of the pair. For a list of rotations the
//! wanted heights are asked at each, and g is the largest over them of what f turned by R⁻¹ asks: exact for the rotations of
//! the list, and nothing is promised between them.
//!
//! **Planar designs** are extruded solids with y locked: h* is taken along x, over a strip that is narrower than the gap of layers.
//!
//! # Units
//!
//! D and radians, as in the library; the mated face centres at the origin.
//!
//! # What is not promised
//!
//! g is a surface without undercuts, on the plan of the design's own moving half. It is the lowest surface, not a
//! good part: slopes, widths and what the result accepts are reported, not improved. Where nothing is wanted, nothing is kept.
//!
//! Source: the dissertation, section 7.2 (p. 108–109), which wishes for this and gives no formula: the adjunction, and all that
//! follows from it, is ours.

mod heights;
mod report;
mod table;
#[cfg(test)]
mod tests;

pub use heights::Heights;
pub use report::{InvertBody, InvertReport, Limits, MAX_PIECES, design_file, report};
pub use table::wanted_from_table;

use catchment::connector::{Connector, Half};
use catchment::contact::Pair;
use catchment::design::Design;
use catchment::exec::Exec;
use catchment::method::zraa::{HeightFacet, Settings as Exactness, ZraaError, heights as envelope};
use catchment::pose::Dof;
use glam::{DMat3, DVec2, DVec3};
use heights::{SAME_PLANE, area, common};
use serde::{Deserialize, Serialize};

/// Half the strip along x over which a planar design is asked, in D: half the narrowest gap that a design may give its layers.
const STRIP: f64 = 0.005;
/// Beyond every offset at which halves touch, in D.
const FAR: f64 = 100.0;
/// What is nearer to zero, in D, is reached.
pub const REACHED: f64 = 1e-9;

/// What changes the answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Turns about z at which the heights are wanted beside 0, in radians. Spatial designs only.
    pub yaw: Vec<f64>,
    /// Material behind the deepest point of the moving half, in D.
    pub backing: f64,
}

impl Default for Settings {
    fn default() -> Self {
        // The backing of the families' own sockets.
        Self { yaw: Vec::new(), backing: 0.25 }
    }
}

/// Where heights are wanted that no moving half reaches.
#[derive(Debug, Clone, PartialEq)]
pub struct Shortfall {
    /// Offsets, a convex polygon, in D.
    pub polygon: Vec<DVec2>,
    /// Largest h* − h over it, in D.
    pub most: f64,
    /// Where.
    pub at: DVec2,
}

/// The other half, and how it does.
#[derive(Debug, Clone, PartialEq)]
pub struct Inverse {
    /// What was wanted.
    pub wanted: Heights,
    /// Lower surface of the moving half, as mounted, over its plan.
    pub moving: Heights,
    /// The connector: the fixed half, and the new moving one, as mounted.
    pub connector: Connector,
    /// Heights of the result.
    pub reached: Heights,
    /// Where the result stays below what was wanted.
    pub shortfalls: Vec<Shortfall>,
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
    /// What was asked.
    pub settings: Settings,
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
    /// A planar design has no yaw.
    #[error("turns about z are for spatial designs; this one is planar")]
    Planar,
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

/// Heights of first contact of a connector's face centres, turned by a rotation.
///
/// # Errors
/// Where the contacts are too many, or the run was stopped.
pub fn heights_of(
    design: &Design,
    connector: &Connector,
    turn: DMat3,
    exec: &Exec,
) -> Result<Heights, InvertError> {
    let moving = connector.moving.mapped(|p| turn * p);
    let facets = envelope([(&connector.fixed, &moving)], &Exactness::default(), exec)?;
    Ok(counted(design, Heights { facets }).merged())
}

/// The plan of a half: what its surfaces cover, seen from below, and how low they are there.
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

/// The moving half that a fixed half and wanted heights ask for, on the plan of the design's own moving half.
///
/// `wanted` is asked at offset by offset without rotation; with [`Settings::yaw`], the design's own heights are wanted at those
/// turns as well.
///
/// # Errors
/// Where nothing is wanted, contacts are too many, or the run was stopped.
pub fn invert(
    design: &Design,
    connector: &Connector,
    wanted: Heights,
    settings: &Settings,
    exec: &Exec,
) -> Result<Inverse, InvertError> {
    if is_planar(design) && !settings.yaw.is_empty() {
        return Err(InvertError::Planar);
    }
    let wanted = counted(design, wanted).merged();
    let Some([_, highest]) = wanted.range() else { return Err(InvertError::NothingWanted) };
    // A body whose lower surface is what is wanted.
    let mut asked: Vec<(Half, Half)> = vec![(connector.fixed.clone(), wanted.above(highest + 1.0))];
    for yaw in &settings.yaw {
        let back = DMat3::from_rotation_z(-yaw);
        let there = heights_of(design, connector, DMat3::from_rotation_z(*yaw), exec)?;
        let Some([_, top]) = there.range() else { continue };
        asked.push((connector.fixed.mapped(|p| back * p), there.above(top + 1.0).mapped(|p| back * p)));
    }
    let pairs = asked.iter().map(|(fixed, body)| (fixed, body));
    let whole = Heights { facets: envelope(pairs, &Exactness::default(), exec)? };
    let plan = lower_surface(&connector.moving, exec)?;
    let mut facets = Vec::new();
    for face in &plan.facets {
        facets.extend(whole.within(&face.polygon).facets);
    }
    let moving = Heights { facets }.merged();
    let Some([_, top]) = moving.range() else { return Err(InvertError::NothingWanted) };
    let back = top + settings.backing;
    let connector = Connector::from_halves(connector.fixed.clone(), moving.above(back));
    let reached = heights_of(design, &connector, DMat3::IDENTITY, exec)?;
    let shortfalls = shortfalls(&wanted, &reached);
    let patch = patch(&connector.fixed, &moving, reached.at(DVec2::ZERO));
    let steepest = moving.facets.iter().map(|f| f.gradient.length()).fold(0.0, f64::max);
    let narrowest = moving.facets.iter().map(|f| width(&f.polygon)).fold(f64::INFINITY, f64::min);
    let plan = moving.facets.iter().map(|f| area(&f.polygon)).sum();
    let settings = settings.clone();
    Ok(Inverse {
        wanted,
        moving,
        connector,
        reached,
        shortfalls,
        patch,
        plan,
        steepest,
        narrowest,
        back,
        settings,
    })
}

/// Where the heights that are reached stay below those that are wanted, polygon by polygon, the deepest first.
fn shortfalls(wanted: &Heights, reached: &Heights) -> Vec<Shortfall> {
    let mut found = Vec::new();
    for want in &wanted.facets {
        for got in &reached.facets {
            let Some(polygon) = common(&want.polygon, &got.polygon) else { continue };
            let short = |p: &DVec2| want.height(*p) - got.height(*p);
            let (at, most) =
                polygon.iter().map(|p| (*p, short(p))).fold((polygon[0], f64::NEG_INFINITY), |best, next| {
                    if next.1 > best.1 { next } else { best }
                });
            if most > REACHED {
                found.push(Shortfall { polygon, most, at });
            }
        }
    }
    found.sort_by(|a, b| b.most.total_cmp(&a.most));
    found
}

/// Area of the plan on which both surfaces are in contact at offset 0 and this height.
fn patch(fixed: &Half, moving: &Heights, height: Option<f64>) -> f64 {
    let Some(height) = height else { return 0.0 };
    let mut touching = 0.0;
    for surface in &fixed.surfaces {
        for facet in surface.facets.iter().filter(|f| f.normal.z > 1e-9) {
            let corners: Vec<DVec3> = facet.corners.iter().map(|k| surface.vertices[*k as usize]).collect();
            let plan: Vec<DVec2> = corners.iter().map(|c| c.truncate()).collect();
            let level = facet.normal.dot(corners[0]);
            let top = |p: DVec2| (level - facet.normal.truncate().dot(p)) / facet.normal.z;
            for own in &moving.facets {
                let Some(polygon) = common(&own.polygon, &plan) else { continue };
                if polygon.iter().all(|p| (top(*p) - own.height(*p) - height).abs() <= 10.0 * SAME_PLANE) {
                    touching += area(&polygon);
                }
            }
        }
    }
    touching
}

/// The least width of a convex polygon.
fn width(polygon: &[DVec2]) -> f64 {
    let n = polygon.len();
    (0..n)
        .map(|k| {
            let along = (polygon[(k + 1) % n] - polygon[k]).normalize_or_zero();
            polygon.iter().map(|p| along.perp_dot(*p - polygon[k])).fold(0.0, f64::max)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Whether the mated pose of the result is a rest, as `catchment check` asks; a doubt in words otherwise.
pub fn doubts(design: &Design, inverse: &Inverse) -> Vec<String> {
    let pair = Pair::new(&inverse.connector, &design.alignment);
    catchment::contact::mated::problems(&pair).iter().map(ToString::to_string).collect()
}
