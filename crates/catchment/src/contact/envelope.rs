//! All supported elements of a pair at one rotation: the upper envelope, and the contacts near a position.

use super::brute::SEAM;
use super::element::{Element, Features};
use super::shape::{Plan, Shape, Side};
use super::{Contact, Lattice, Pair};
use glam::{DMat3, DVec2, DVec3};
use std::ops::Range;

/// Below this z-component a normal counts as horizontal: such a facet has no height of its own, its rim
/// speaks for it. Slopes beyond 10⁹ cannot be told from a wall in double precision.
const VERTICAL: f64 = 1e-9;

/// Contacts that pull down are looked for up to this slope (sine, 30°): a tilted plug hooks under the lip of a slot.
/// Facets that lean further back belong to the undersides of the halves.
const OVERHANG: f64 = 0.5;

/// Sine of the angle by which a feature may fail to support a normal and still count: rounding only.
const ROUNDING: f64 = 1e-9;

/// The pair at one rotation: which features can touch, for any position of the COR.
///
/// Reusable: [`Envelope::turn`] replaces the rotation without allocating anew.
#[derive(Debug, Clone)]
pub struct Envelope<'a> {
    pair: &'a Pair,
    moving: Vec<Shape>,
    elements: Vec<Element>,
}

impl<'a> Envelope<'a> {
    /// The envelope at `rotation`.
    pub(super) fn new(pair: &'a Pair, rotation: &DMat3) -> Self {
        let mut envelope = Self { pair, moving: pair.moving_shapes.clone(), elements: Vec::new() };
        envelope.turn(rotation);
        envelope
    }

    /// Moves on to another rotation: everything that can carry the moving half from below, wherever it is.
    pub fn turn(&mut self, rotation: &DMat3) {
        self.turn_within(rotation, ROUNDING, VERTICAL, Window { lateral: DVec2::ZERO, reach: f64::INFINITY });
    }

    /// Moves on to another rotation for questions about the COR at `lateral` alone: keeps what is within `reach` of
    /// touching there in plan view, also walls and features that support a normal only within `slack` radians: what a
    /// motion that turns by up to `slack` may meet.
    pub fn turn_near(&mut self, rotation: &DMat3, slack: f64, lateral: DVec2, reach: f64) {
        self.turn_within(rotation, slack.max(ROUNDING), -OVERHANG, Window { lateral, reach: reach + SEAM });
    }

    fn turn_within(&mut self, rotation: &DMat3, slack: f64, lowest: f64, window: Window) {
        for (turned, shape) in self.moving.iter_mut().zip(&self.pair.moving_shapes) {
            shape.rotate_into(rotation, turned);
            if window.reach.is_finite() {
                turned.draw_plans();
            }
        }
        self.elements.clear();
        for (f, fixed) in self.pair.fixed_shapes.iter().enumerate() {
            for (m, moving) in self.moving.iter().enumerate() {
                let shapes = [f as u32, m as u32];
                collect(fixed, moving, slack, lowest, window, |features, normal, offset| {
                    self.elements.push(Element { shapes, features, normal, offset });
                });
            }
        }
    }

    /// z of the COR at first contact with the COR at `lateral`, in D; `None` where the halves pass each other.
    pub fn height(&self, lateral: DVec2) -> Option<f64> {
        self.height_below(lateral, f64::INFINITY).0
    }

    /// Where a half lowered from `ceiling`, not from far above, is stopped; and whether something above the ceiling
    /// would have stopped it earlier. A half that has slid under an overhang, or beside a wall, is there.
    pub fn height_below(&self, lateral: DVec2, ceiling: f64) -> (Option<f64>, bool) {
        let mut highest = f64::NEG_INFINITY;
        let mut covered = false;
        for element in &self.elements {
            if element.normal.z <= VERTICAL {
                continue;
            }
            let z = element.height(lateral);
            let counts = if z > ceiling { !covered } else { z > highest };
            if counts && self.foot(element, lateral.extend(z)).is_some() {
                if z > ceiling {
                    covered = true;
                } else {
                    highest = z;
                }
            }
        }
        (highest.is_finite().then_some(highest), covered)
    }

    /// Heights over a lattice of *COR* positions, x fastest; −∞ where the halves pass each other by.
    ///
    /// `out` has `x.count · y.count` cells and is overwritten.
    pub fn heights(&self, x: Lattice, y: Lattice, out: &mut [f64]) {
        out.fill(f64::NEG_INFINITY);
        self.rasterise(x, y, |_, plane, cells| {
            for (k, cell) in out[cells].iter_mut().enumerate() {
                *cell = cell.max(plane.at(k));
            }
        });
    }

    /// Heights as by [`Envelope::heights`], and for every cell the number of what carries the moving half there, for
    /// [`Envelope::carried_by`]; [`Envelope::NOTHING`] where the halves pass each other by. Among equals the first
    /// counts.
    pub fn relief(&self, x: Lattice, y: Lattice, heights: &mut [f64], carriers: &mut [u32]) {
        heights.fill(f64::NEG_INFINITY);
        carriers.fill(Self::NOTHING);
        self.rasterise(x, y, |number, plane, cells| {
            let carriers = &mut carriers[cells.clone()];
            for (k, (height, carrier)) in heights[cells].iter_mut().zip(carriers).enumerate() {
                let z = plane.at(k);
                let higher = z > *height;
                *height = if higher { z } else { *height };
                *carrier = if higher { number } else { *carrier };
            }
        });
    }

    /// No carrier: the halves pass each other by.
    pub const NOTHING: u32 = u32::MAX;

    /// The contact by which a carrier of [`Envelope::relief`] carries the moving half with the COR at `lateral`, and
    /// the position of the COR. Both are affine in `lateral`, and defined beyond the cells that it carries.
    ///
    /// # Panics
    /// When no relief at this rotation gave that number.
    pub fn carried_by(&self, carrier: u32, lateral: DVec2) -> (Contact, DVec3) {
        let element = &self.elements[carrier as usize];
        let [f, m] = element.shapes.map(|s| s as usize);
        let cor = lateral.extend(element.height(lateral));
        let point = element.touch(&self.pair.fixed_shapes[f], &self.moving[m], cor);
        (Contact { gap: 0.0, normal: element.normal, point }, cor)
    }

    /// Visits, for every element that faces up, the rows of cells it covers.
    fn rasterise(&self, x: Lattice, y: Lattice, mut visit: impl FnMut(u32, Plane, Range<usize>)) {
        let mut polygon = Vec::new();
        for (number, element) in self.elements.iter().enumerate() {
            if element.normal.z <= VERTICAL {
                continue;
            }
            let [f, m] = element.shapes.map(|s| s as usize);
            element.footprint(&self.pair.fixed_shapes[f], &self.moving[m], &mut polygon);
            let slope = -element.normal.truncate() / element.normal.z;
            let level = -element.offset / element.normal.z;
            super::raster::fill_convex(&polygon, x, y, |row, columns| {
                let first = slope.x * x.at(columns.start) + (slope.y * y.at(row) + level);
                let cells = row * x.count + columns.start..row * x.count + columns.end;
                visit(number as u32, Plane { first, step: slope.x * x.step }, cells);
            });
        }
    }

    /// Everything that touches, or is closer than `reach` along its normal, with the COR at `position`.
    pub fn contacts(&self, position: DVec3, reach: f64, out: &mut Vec<Contact>) {
        out.clear();
        for element in &self.elements {
            let gap = element.gap(position);
            // Deeper than `reach` the halves are not near each other along this normal: they passed.
            if gap.abs() > reach {
                continue;
            }
            let Some(point) = self.foot(element, position) else { continue };
            if !self.is_exposed(element, point, position) {
                continue;
            }
            out.push(Contact { gap, normal: element.normal, point });
        }
    }

    /// Whether an edge of one half pierces a facet of the other with the COR at `position`: they overlap, by more than
    /// touching.
    pub fn is_pierced(&self, position: DVec3) -> bool {
        let fixed_in_moving = |p: DVec3| p - position;
        let moving_in_fixed = |p: DVec3| p + position;
        self.pair.fixed_shapes.iter().any(|fixed| {
            self.moving.iter().any(|moving| {
                fixed.pierces(moving, fixed_in_moving) || moving.pierces(fixed, moving_in_fixed)
            })
        })
    }

    fn foot(&self, element: &Element, position: DVec3) -> Option<DVec3> {
        let [f, m] = element.shapes.map(|s| s as usize);
        element.foot(&self.pair.fixed_shapes[f], &self.moving[m], position)
    }

    /// Whether the contact lies on the surface of both solids, not on a wall between two pieces of one.
    fn is_exposed(&self, element: &Element, point: DVec3, position: DVec3) -> bool {
        /// How far outside its own surface a contact looks for another piece of the same solid, in D.
        const LOOK: f64 = 1e-7;
        let hidden = |shapes: &[Shape], own: u32, point: DVec3| {
            shapes.len() > 1
                && shapes
                    .iter()
                    .enumerate()
                    .any(|(s, shape)| s as u32 != own && shape.contains(point, LOOK * 1e-3))
        };
        let outward = element.normal * LOOK;
        let seen = point + element.normal * element.gap(position) - position;
        !hidden(&self.pair.fixed_shapes, element.shapes[0], point + outward)
            && !hidden(&self.moving, element.shapes[1], seen - outward)
    }
}

/// Heights along a row of cells.
#[derive(Debug, Clone, Copy)]
struct Plane {
    first: f64,
    step: f64,
}

impl Plane {
    fn at(self, k: usize) -> f64 {
        // A row has fewer than 2³² cells; the narrower conversion is a single instruction for several cells at once.
        self.first + self.step * f64::from((k as u32).cast_signed())
    }
}

/// Where the COR is in plan view, and how close features must come to count.
#[derive(Debug, Clone, Copy)]
struct Window {
    lateral: DVec2,
    reach: f64,
}

/// Visits every supported element of two shapes in the window whose normal has a z-component above `lowest`.
fn collect(
    fixed: &Shape,
    moving: &Shape,
    slack: f64,
    lowest: f64,
    window: Window,
    mut visit: impl FnMut(Features, DVec3, f64),
) {
    let everywhere = window.reach.is_infinite();
    let meet = |f: &Plan, m: &Plan| everywhere || f.meets(m, window.lateral, window.reach);
    for (facet, f) in fixed.facets.iter().enumerate().filter(|(_, f)| f.normal.z > lowest) {
        let level = f.normal.dot(fixed.at(f.corners[0]));
        for (corner, plan) in moving.corners.iter().zip(&moving.plans.corners) {
            if meet(&fixed.plans.facets[facet], plan) && moving.supports(corner, f.normal, slack) {
                let features = Features::FacetCorner { facet: facet as u32, vertex: corner.vertex };
                visit(features, f.normal, f.normal.dot(moving.at(corner.vertex)) - level);
            }
        }
    }
    for (facet, m) in moving.facets.iter().enumerate().filter(|(_, m)| -m.normal.z > lowest) {
        let level = m.normal.dot(moving.at(m.corners[0]));
        for (corner, plan) in fixed.corners.iter().zip(&fixed.plans.corners) {
            if meet(plan, &moving.plans.facets[facet]) && fixed.supports(corner, m.normal, slack) {
                let features = Features::CornerFacet { vertex: corner.vertex, facet: facet as u32 };
                visit(features, -m.normal, m.normal.dot(fixed.at(corner.vertex)) - level);
            }
        }
    }
    let low = |m: &Side| moving.steepest(m).0 < -lowest;
    for (f, at) in fixed.sides.iter().zip(&fixed.plans.sides).filter(|(f, _)| fixed.steepest(f).1 > lowest) {
        for (m, plan) in moving.sides.iter().zip(&moving.plans.sides) {
            if !meet(at, plan) || !low(m) {
                continue;
            }
            if let Some(normal) = edge_normal(f, m, slack).filter(|n| n.z > lowest) {
                let offset = normal.dot(moving.at(m.ends[0]) - fixed.at(f.ends[0]));
                visit(Features::EdgeEdge { fixed: f.ends, moving: m.ends }, normal, offset);
            }
        }
    }
}

/// The unit common normal of two edges in the sense that both support, if either does.
fn edge_normal(fixed: &Side, moving: &Side, slack: f64) -> Option<DVec3> {
    let across = fixed.along.cross(moving.along);
    let below = fixed.into.map(|s| across.dot(s));
    let above = moving.into.map(|s| across.dot(s));
    // `across` is at most 1 long, so this rejects nothing that the exact test below accepts.
    let up = below.iter().all(|b| *b <= slack) && above.iter().all(|a| *a >= -slack);
    let down = below.iter().all(|b| *b >= -slack) && above.iter().all(|a| *a <= slack);
    if !(up || down) {
        return None;
    }
    let length = across.length();
    // Parallel edges have no normal of their own: their ends speak for them.
    if length <= ROUNDING {
        return None;
    }
    let slack = slack * length;
    if up && below.iter().all(|b| *b <= slack) && above.iter().all(|a| *a >= -slack) {
        Some(across / length)
    } else if down && below.iter().all(|b| *b >= -slack) && above.iter().all(|a| *a <= slack) {
        Some(across / -length)
    } else {
        None
    }
}
