//! Pins and chamfered holes on a circle, on a square plate of width D.
//!
//! ```text
//!      pin             hole
//!       ╱╲ ┬       ─╲        ╱─    chamfer: width `chamfer`, 45°
//!      │  ││ H       │      │      radius `pin_radius` + `clearance`
//!  ────┘  └┴───       ╲    ╱       bottom: seat of the pin's point
//!                      ╲  ╱
//! ```
//!
//! Pins end in a 45° point of width `chamfer` (a whole cone once that reaches the radius), and the bottom of a
//! hole has the same 45°, so that a seated pin is centred although it has play along its straight part. H is
//! the length of a pin. Gendered: all pins on the moving half, profile from z = 0 to H. Hermaphroditic: pins
//! and holes alternate on both halves, hole bottoms at z = 0, the plate at H, tips at 2H.

use super::fan::{circle, corners_of_circle};
use super::{Check, Draw, Halves, SOCKET_THICKNESS};
use crate::{Surface, SurfaceError};
use catchment_base::tolerance::COINCIDENT;
use catchment_design::design::family::PinHole;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Most corners over all circles of a half: about 8 facets each keep it within the limit of a mesh half.
const MAX_CORNERS: f64 = 2048.0;

#[derive(Clone, Copy, PartialEq)]
enum Feature {
    Pin,
    Hole,
}

impl Draw for PinHole {
    /// Refuses layouts that overlap, leave the plate or leave no straight part.
    fn check(&self, check: &mut Check) {
        let s = self;
        let outer = mouth(s);
        let features = features(s);
        check.require("pins", f64::from(s.pins), s.pins >= 1, "give at least one pin");
        check.require("pin_radius", s.pin_radius, s.pin_radius > 0.0, "give a number above 0");
        check.require("clearance", s.clearance, s.clearance >= 0.0, "give 0 or more");
        check.require("chamfer", s.chamfer, s.chamfer > 0.0, "give a number above 0");
        let needed = s.chamfer + point(s) + s.clearance;
        check.require(
            "aspect_ratio",
            s.aspect_ratio,
            s.aspect_ratio > needed,
            format!("chamfer, point and clearance leave no straight part: give more than {needed:.4}"),
        );
        check.require(
            "circle_radius",
            s.circle_radius,
            s.circle_radius >= 0.0 && s.circle_radius + outer < 0.5,
            format!("holes with their chamfers leave the plate: give less than {:.4}", 0.5 - outer),
        );
        let spacing = s.circle_radius * (PI / f64::from(features.max(2))).sin();
        check.require(
            "circle_radius",
            s.circle_radius,
            features < 2 || spacing > outer,
            format!(
                "neighbours on the circle overlap: they are {:.4} apart and need {:.4}",
                2.0 * spacing,
                2.0 * outer
            ),
        );
        let corners = corners_of_circle(outer, s.chord_error) * f64::from(features);
        check.require(
            "chord_error",
            s.chord_error,
            s.chord_error > 0.0 && corners <= MAX_CORNERS,
            format!("this takes {corners} corners, more than {MAX_CORNERS}: give a larger one"),
        );
    }

    /// The plate with its pins and holes; gendered: holes on the fixed half, pins on the moving half.
    fn halves(&self) -> Halves {
        let m = features(self);
        let all =
            |feature| (0..m).map(|k| (f64::from(k) * 2.0 * PI / f64::from(m), feature)).collect::<Vec<_>>();
        let h = self.aspect_ratio;
        if self.hermaphroditic {
            // Between the axes: mirrored about x, every pin finds a hole.
            let layout: Vec<_> = (0..m)
                .map(|k| {
                    let angle = (f64::from(k) + 0.5) * 2.0 * PI / f64::from(m);
                    (angle, if k % 2 == 0 { Feature::Pin } else { Feature::Hole })
                })
                .collect();
            let half = vec![plate(self, &layout, h)];
            [half.clone(), half]
        } else {
            [vec![plate(self, &all(Feature::Hole), h)], vec![plate(self, &all(Feature::Pin), 0.0)]]
        }
    }

    fn face_height(&self) -> Option<f64> {
        Some(if self.hermaphroditic { self.aspect_ratio } else { self.aspect_ratio / 2.0 })
    }
}

/// Pins and holes per half.
fn features(spec: &PinHole) -> u32 {
    if spec.hermaphroditic { spec.pins.saturating_mul(2) } else { spec.pins }
}

/// Radius of a hole's mouth.
fn mouth(spec: &PinHole) -> f64 {
    spec.pin_radius + spec.clearance + spec.chamfer
}

/// Width of a pin's point.
fn point(spec: &PinHole) -> f64 {
    spec.chamfer.min(spec.pin_radius)
}

/// A plate whose upper face lies at `top`, with its features at the given angles in increasing order.
fn plate(spec: &PinHole, layout: &[(f64, Feature)], top: f64) -> Result<Surface, SurfaceError> {
    let base = spec.base_thickness.unwrap_or(SOCKET_THICKNESS);
    let corners = corners_of_circle(mouth(spec), spec.chord_error) as usize;
    let mut mesh = Mesh::default();
    let mut outline = Vec::new();
    for (k, &(angle, feature)) in layout.iter().enumerate() {
        let half_sector = PI / layout.len() as f64;
        let centre = spec.circle_radius * DVec2::from_angle(angle);
        let sector: Vec<u32> = if layout.len() == 1 {
            border_between(0.0, 2.0 * PI).into_iter().map(|p| mesh.vertex(p.extend(top))).collect()
        } else {
            let border = border_between(angle - half_sector, angle + half_sector);
            let arc: Vec<u32> = border.into_iter().map(|p| mesh.vertex(p.extend(top))).collect();
            std::iter::once(mesh.vertex(DVec3::new(0.0, 0.0, top))).chain(arc).collect()
        };
        let skip = usize::from(layout.len() > 1);
        outline.extend(
            sector[skip..].iter().copied().take(sector.len() - skip - usize::from(k + 1 < layout.len())),
        );
        let rings: Vec<Vec<u32>> = profile(spec, feature)
            .into_iter()
            .map(|(radius, z)| {
                let ring = if radius > 0.0 { circle(radius, corners) } else { vec![DVec2::ZERO] };
                ring.into_iter().map(|p| mesh.push((centre + p).extend(top + z))).collect()
            })
            .collect();
        mesh.between(&sector, &rings[0]);
        for pair in rings.windows(2) {
            mesh.band(&pair[0], &pair[1]);
        }
        if let Some(last) = rings.last().filter(|ring| ring.len() > 1) {
            mesh.polygons.push(last.clone());
        }
    }
    outline.dedup();
    if outline.len() > 1 && outline.first() == outline.last() {
        outline.pop();
    }
    let floor: Vec<u32> =
        outline.iter().map(|&k| mesh.push(mesh.vertices[k as usize].truncate().extend(-base))).collect();
    mesh.band(&floor, &outline);
    mesh.polygons.push(floor.into_iter().rev().collect());
    Surface::from_polygons(mesh.vertices, &mesh.polygons)
}

/// (radius, height over the plate) of a feature's rings, from the plate inwards.
fn profile(spec: &PinHole, feature: Feature) -> Vec<(f64, f64)> {
    let (h, r, bore) = (spec.aspect_ratio, spec.pin_radius, spec.pin_radius + spec.clearance);
    let (point, tip) = (point(spec), r - point(spec));
    match feature {
        Feature::Pin => vec![(r, 0.0), (r, h - point), (tip, h)],
        Feature::Hole => {
            vec![(mouth(spec), 0.0), (bore, -spec.chamfer), (bore, point + spec.clearance - h), (tip, -h)]
        }
    }
}

/// The border of the plate from one direction to another, counter-clockwise: both ends and the corners
/// between them. A full turn starts in a corner and does not repeat it.
fn border_between(from: f64, to: f64) -> Vec<DVec2> {
    let corner = |k: i32| {
        let k = k.rem_euclid(4);
        DVec2::new(if k == 0 || k == 3 { 0.5 } else { -0.5 }, if k < 2 { 0.5 } else { -0.5 })
    };
    if to - from > 2.0 * PI - COINCIDENT {
        return (0..4).map(corner).collect();
    }
    let exit = |angle: f64| {
        let d = DVec2::from_angle(angle);
        let p = d * (0.5 / d.abs().max_element());
        let snap =
            |v: f64| [-0.5, 0.0, 0.5].into_iter().find(|s: &f64| (s - v).abs() < COINCIDENT).unwrap_or(v);
        DVec2::new(snap(p.x), snap(p.y))
    };
    let mut points = vec![exit(from)];
    let first = ((from / PI * 2.0) - 0.5).floor() as i32;
    points.extend(
        (first..first + 5)
            .map(|k| (k, (f64::from(k) + 0.5) * PI / 2.0))
            .filter(|&(_, angle)| angle > from && angle < to)
            .map(|(k, _)| corner(k)),
    );
    points.push(exit(to));
    points.dedup();
    points
}

/// Vertices and polygons in the making.
#[derive(Default)]
struct Mesh {
    vertices: Vec<DVec3>,
    polygons: Vec<Vec<u32>>,
}

impl Mesh {
    fn push(&mut self, p: DVec3) -> u32 {
        self.vertices.push(p);
        self.vertices.len() as u32 - 1
    }

    /// The vertex at `p`, shared with the neighbouring sector.
    fn vertex(&mut self, p: DVec3) -> u32 {
        match self.vertices.iter().position(|q| q.distance(p) < COINCIDENT) {
            Some(k) => k as u32,
            None => self.push(p),
        }
    }

    /// Facets between two rings of equal length, or a ring and a single point, counter-clockwise from outside
    /// when the first ring is counter-clockwise around the direction to the second.
    fn band(&mut self, from: &[u32], to: &[u32]) {
        let n = from.len();
        for k in 0..n {
            let next = (k + 1) % n;
            self.polygons.push(match to {
                [apex] => vec![from[k], from[next], *apex],
                _ => vec![from[k], from[next], to[next], to[k]],
            });
        }
    }

    /// Triangles between a convex ring and a convex ring inside it, both counter-clockwise from above.
    ///
    /// Each outer corner takes the inner edges that are visible from it; after the last visible one, the next
    /// corner continues from the last inner corner, which is visible to it because the inner ring lies behind
    /// their common edge.
    fn between(&mut self, outer: &[u32], inner: &[u32]) {
        let at = |mesh: &Self, k: u32| mesh.vertices[k as usize].truncate();
        let start = at(self, outer[0]);
        let nearest = (0..inner.len())
            .min_by(|&a, &b| {
                let distance = |k: usize| at(self, inner[k]).distance_squared(start);
                distance(a).total_cmp(&distance(b))
            })
            .unwrap_or(0);
        let inner_at = |k: usize| inner[(nearest + k) % inner.len()];
        let mut taken = 0;
        for j in 0..=outer.len() {
            let corner = outer[j % outer.len()];
            while taken < inner.len() {
                let (a, b) = (inner_at(taken), inner_at(taken + 1));
                let (pa, pb) = (at(self, a), at(self, b));
                let visible = (pb - pa).perp_dot(at(self, corner) - pa) < 0.0;
                // `taken` wraps past the first inner corner for the edges that precede the nearest inner
                // corner.
                if !visible {
                    break;
                }
                self.polygons.push(vec![a, corner, b]);
                taken += 1;
            }
            if j < outer.len() {
                self.polygons.push(vec![inner_at(taken), corner, outer[(j + 1) % outer.len()]]);
            }
        }
    }
}
