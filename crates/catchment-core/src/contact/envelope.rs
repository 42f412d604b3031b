//! The upper envelope of all elements at one rotation: heights for any lateral position of the moving half.
//!
//! All elements that can carry are listed once for a rotation; if the list would be too long, the trees are
//! searched for every position.

use super::brute::SEAM;
use super::candidates::{Candidates, Counts, FLUSH, Sieve};
use super::element::Element;
use super::search::Gaps;
use super::turned::{Turned, VERTICAL};
use super::{Contact, Lattice, Pair};
use glam::{DMat3, DVec2, DVec3};
use std::collections::BTreeMap;
use std::ops::Range;

/// The pair at a given rotation: everything that can carry the moving half from below, for any position of
/// the COR.
///
/// Reusable: [`HeightEnvelope::turn`] replaces the rotation without allocating anew.
#[derive(Debug, Clone)]
pub struct HeightEnvelope<'a> {
    turned: Turned<'a>,
    candidates: Candidates,
    /// Vertices of the moving shapes at the rotation.
    moving: Vec<Vec<DVec3>>,
    /// The carriers found by search, if nothing is listed.
    carriers: Vec<Element>,
}

impl<'a> HeightEnvelope<'a> {
    /// The envelope at `rotation`.
    pub(super) fn new(pair: &'a Pair, rotation: &DMat3) -> Self {
        let mut envelope = Self {
            turned: Turned::new(pair),
            candidates: Candidates::default(),
            moving: Vec::new(),
            carriers: Vec::new(),
        };
        envelope.turn(rotation);
        envelope
    }

    /// Moves on to another rotation.
    pub fn turn(&mut self, rotation: &DMat3) {
        let counts = Counts { slack: FLUSH, lowest: VERTICAL };
        let pair = self.turned.pair;
        if let Some(trees) = pair.searched() {
            self.turned.turn_trees(rotation, trees, counts);
        } else {
            let sieve = Sieve { slack: counts.slack, lowest: counts.lowest, skin: 0.0, window: None };
            self.candidates.collect(pair, rotation, &sieve);
            self.turned.turn(rotation, &self.candidates, counts);
        }
        let shapes = &self.turned.pair.moving_shapes;
        self.moving.resize_with(shapes.len(), Vec::new);
        for (turned, shape) in self.moving.iter_mut().zip(shapes) {
            turned.clear();
            turned.extend(shape.vertices.iter().map(|v| *rotation * *v));
        }
    }

    /// z of the COR at first contact with the COR at `lateral`, in D; `None` if the halves pass each other
    /// by.
    pub fn height(&mut self, lateral: DVec2) -> Option<f64> {
        self.turned.height_below(lateral, f64::INFINITY).0
    }

    /// Everything that carries the moving half, or is closer than `reach` along its normal, with the COR at `position`.
    pub fn contacts(&mut self, position: DVec3, reach: f64, out: &mut Vec<Contact>) {
        out.clear();
        self.turned.contacts(position, Gaps::within(reach), SEAM, |(contact, _)| out.push(contact));
    }

    /// Heights over a lattice of *COR* positions, x fastest; −∞ where the halves pass each other by.
    ///
    /// `out` has `x.count · y.count` cells and is overwritten.
    pub fn heights(&mut self, x: Lattice, y: Lattice, out: &mut [f64]) {
        out.fill(f64::NEG_INFINITY);
        if self.turned.pair.is_large() {
            return self.search(x, y, |cell, _, height| out[cell] = height);
        }
        self.rasterise(x, y, |_, plane, cells| {
            for (k, cell) in out[cells].iter_mut().enumerate() {
                *cell = cell.max(plane.at(k));
            }
        });
    }

    /// Heights as by [`HeightEnvelope::heights`], and for every cell the number of the element that carries the
    /// moving half there, for [`HeightEnvelope::carried_by`]; [`HeightEnvelope::NOTHING`] if the halves pass each other
    /// by. Among equals the first counts.
    pub fn heights_and_carriers(
        &mut self,
        x: Lattice,
        y: Lattice,
        heights: &mut [f64],
        carriers: &mut [u32],
    ) {
        heights.fill(f64::NEG_INFINITY);
        carriers.fill(Self::NOTHING);
        if self.turned.pair.is_large() {
            return self
                .search(x, y, |cell, number, height| (heights[cell], carriers[cell]) = (height, number));
        }
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

    /// The contact by which a carrier of [`HeightEnvelope::heights_and_carriers`] carries the moving half with the COR at `lateral`, and
    /// the position of the COR. Both are affine in `lateral`, and defined beyond the cells that it carries.
    ///
    /// # Panics
    /// When no heights at this rotation gave that number.
    pub fn carried_by(&self, carrier: u32, lateral: DVec2) -> (Contact, DVec3) {
        let elements = if self.turned.pair.is_large() { &self.carriers } else { &self.turned.elements };
        let element = &elements[carrier as usize];
        let [f, m] = element.meeting.shapes.map(|s| s as usize);
        let cor = lateral.extend(element.height(lateral));
        let point = element.touch(&self.turned.pair.fixed_shapes[f], &self.moving[m], cor);
        (Contact { gap: 0.0, normal: element.normal, point }, cor)
    }

    /// Visits every cell in which an element carries the half, with its number.
    fn search(&mut self, x: Lattice, y: Lattice, mut visit: impl FnMut(usize, u32, f64)) {
        let Self { turned, carriers, .. } = self;
        carriers.clear();
        let mut numbers = BTreeMap::new();
        for cell in 0..x.count * y.count {
            let lateral = DVec2::new(x.at(cell % x.count), y.at(cell / x.count));
            if let Some((element, number, height)) = turned.carried_by(lateral) {
                let number = *numbers.entry(number).or_insert_with(|| {
                    carriers.push(element);
                    carriers.len() as u32 - 1
                });
                visit(cell, number, height);
            }
        }
    }

    /// Visits, for every element that faces up, the rows of cells it covers.
    fn rasterise(&self, x: Lattice, y: Lattice, mut visit: impl FnMut(u32, Plane, Range<usize>)) {
        let mut polygon = Vec::new();
        for (number, element) in self.turned.elements.iter().enumerate() {
            if element.normal.z <= VERTICAL {
                continue;
            }
            let [f, m] = element.meeting.shapes.map(|s| s as usize);
            let (fixed, moving) = (&self.turned.pair.fixed_shapes[f], &self.turned.pair.moving_shapes[m]);
            element.footprint(fixed, moving, &self.moving[m], &mut polygon);
            let slope = -element.normal.truncate() / element.normal.z;
            let level = -element.offset / element.normal.z;
            super::raster::fill_convex(&polygon, x, y, |row, columns| {
                let first = slope.x * x.at(columns.start) + (slope.y * y.at(row) + level);
                let cells = row * x.count + columns.start..row * x.count + columns.end;
                visit(number as u32, Plane { first, step: slope.x * x.step }, cells);
            });
        }
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
