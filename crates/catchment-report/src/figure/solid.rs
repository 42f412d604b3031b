//! Both halves in space: parallel projection, shaded facets, a depth buffer.
//!
//! A depth buffer shows touching or overlapping halves correctly, which sorting facets by distance cannot.
//! The image is drawn three times larger than shown and averaged down; lines mark edges at which the surface
//! bends. A point of an edge is drawn if an adjacent facet is visible next to it: depth alone would show
//! edges that lie in a facet of another body, and the ends of receding edges.

use super::depth_buffer::{DepthBuffer, FINER};
use super::draw::colour::{self, Rgb, mix};
use super::draw::layout::{Layout, Panel};
use super::draw::svg::{Rect, Svg};
use super::section::{MovingHalfPose, contact_mark, describe, seen_apart};
use super::{FigureError, Picture, raster};
use catchment_core::connector::{Connector, Surface};
use catchment_core::design::Design;
use glam::{DMat3, DVec3};
use std::collections::BTreeMap;

/// Draws the two halves in space at a pose.
///
/// # Errors
/// If neither half has a facet.
pub fn solids(
    design: &Design,
    connector: &Connector,
    placement: &MovingHalfPose,
) -> Result<Picture, FigureError> {
    let (mut svg, frames) =
        Layout::of(design).story(describe(design, placement)).row([Panel::of([520.0, 440.0])]).open();
    panel(&mut svg, frames[0], design, connector, placement)?;
    Ok(Picture::of(svg))
}

/// The image alone, in a rectangle of another picture.
///
/// # Errors
/// If neither half has a facet.
pub fn panel(
    svg: &mut Svg,
    rect: Rect,
    design: &Design,
    connector: &Connector,
    placement: &MovingHalfPose,
) -> Result<(), FigureError> {
    touching(svg, rect, design, connector, placement, &[])
}

/// The same with the contacts: full if visible, hollow if a half hides them.
///
/// # Errors
/// If neither half has a facet.
pub(super) fn touching(
    svg: &mut Svg,
    rect: Rect,
    design: &Design,
    connector: &Connector,
    placement: &MovingHalfPose,
    points: &[DVec3],
) -> Result<(), FigureError> {
    let (rotation, face) = placement.of(design);
    let halves: Vec<Body> = connector
        .fixed
        .surfaces
        .iter()
        .map(|s| Body::new(s, DMat3::IDENTITY, DVec3::ZERO, [colour::FIXED, colour::FIXED_EDGE]))
        .chain(
            connector
                .moving
                .surfaces
                .iter()
                .map(|s| Body::new(s, rotation, face, [colour::MOVING, colour::MOVING_EDGE])),
        )
        .collect();
    let seen = seen(svg, rect, &halves)?;
    let mut shown = Vec::new();
    for point in points {
        let (at, is_hidden) = seen.place(*point);
        if seen_apart(&mut shown, at) {
            contact_mark(svg, at, !is_hidden);
        }
    }
    Ok(())
}

/// Surfaces in the world frame, as an image in a rectangle of a picture.
///
/// # Errors
/// If no surface has a facet.
pub(super) fn bodies(svg: &mut Svg, rect: Rect, bodies: &[Body]) -> Result<(), FigureError> {
    seen(svg, rect, bodies).map(|_| ())
}

/// Pixels per SVG unit in the finished image.
const PIXELS: f64 = 2.0;

/// The same, with the map from points of the world to the picture.
fn seen(svg: &mut Svg, rect: Rect, bodies: &[Body]) -> Result<RenderedImage, FigureError> {
    let size = [(rect.w * PIXELS) as usize, (rect.h * PIXELS) as usize];
    let (camera, buffer) = draw(bodies, size)?;
    svg.image(rect, &raster::encode(size[0], size[1], true, &buffer.averaged())?, false);
    Ok(RenderedImage { rect, camera, buffer })
}

/// A finished image.
struct RenderedImage {
    rect: Rect,
    camera: Camera,
    buffer: DepthBuffer,
}

impl RenderedImage {
    /// Position of a point in the picture, and whether something is in front of it.
    fn place(&self, point: DVec3) -> ([f64; 2], bool) {
        /// So much in front of a point hides it, in fine pixels: less is the facet that it lies on.
        const HIDES: f64 = 12.0;
        let at = self.camera.project(point);
        let to_svg = 1.0 / (PIXELS * FINER as f64);
        let [column, row] = [(at.x, self.buffer.width), (at.y, self.buffer.height)]
            .map(|(value, most)| (value.max(0.0) as usize).min(most - 1));
        let is_hidden = self.buffer.depth(column + row * self.buffer.width) > at.z + HIDES;
        ([self.rect.x + at.x * to_svg, self.rect.y + at.y * to_svg], is_hidden)
    }
}

/// A surface in the world frame.
pub(super) struct Body<'a> {
    surface: &'a Surface,
    corners: Vec<DVec3>,
    normals: Vec<DVec3>,
    fill: Rgb,
    edge: Rgb,
}

impl<'a> Body<'a> {
    /// A surface, turned and then shifted, in the colours of its facets and edges.
    pub(super) fn new(surface: &'a Surface, rotation: DMat3, shift: DVec3, [fill, edge]: [Rgb; 2]) -> Self {
        Self {
            surface,
            corners: surface.vertices.iter().map(|v| rotation * *v + shift).collect(),
            normals: surface.facets.iter().map(|f| rotation * f.normal).collect(),
            fill,
            edge,
        }
    }

    /// Edges at which two facets meet at more than [`BEND`], with the numbers of these facets.
    fn bends(&self) -> impl Iterator<Item = ([DVec3; 2], Vec<usize>)> + '_ {
        /// Cosine of 20°: the facets of a tessellated cone meet at less, those of a designed edge at more.
        const BEND: f64 = 0.94;
        let mut sides: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
        for (number, facet) in self.surface.facets.iter().enumerate() {
            let n = facet.corners.len();
            for k in 0..n {
                let (a, b) = (facet.corners[k], facet.corners[(k + 1) % n]);
                sides.entry((a.min(b), a.max(b))).or_default().push(number);
            }
        }
        sides.into_iter().filter_map(|((a, b), facets)| {
            let bent = facets.len() != 2 || self.normals[facets[0]].dot(self.normals[facets[1]]) < BEND;
            bent.then(|| ([self.corners[a as usize], self.corners[b as usize]], facets))
        })
    }
}

/// Seen from the front right, somewhat above.
struct Camera {
    right: DVec3,
    up: DVec3,
    towards: DVec3,
    scale: f64,
    shift: [f64; 2],
}

impl Camera {
    const AZIMUTH: f64 = 0.5;
    const ELEVATION: f64 = 0.42;
    /// Share of the image that the halves take: the rest is room for the lines of their edges.
    const FILL: f64 = 0.94;

    fn new(bodies: &[Body], [width, height]: [usize; 2]) -> Result<Self, FigureError> {
        let (sa, ca) = Self::AZIMUTH.sin_cos();
        let (se, ce) = Self::ELEVATION.sin_cos();
        let towards = DVec3::new(ce * sa, -ce * ca, se);
        let right = DVec3::new(ca, sa, 0.0);
        let up = towards.cross(right);
        let (mut lo, mut hi) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in bodies.iter().flat_map(|b| &b.corners) {
            for (k, v) in [p.dot(right), p.dot(up)].into_iter().enumerate() {
                lo[k] = lo[k].min(v);
                hi[k] = hi[k].max(v);
            }
        }
        if lo[0] >= hi[0] || lo[1] >= hi[1] {
            return Err(FigureError::Empty { what: "there are no facets" });
        }
        let size = [width as f64, height as f64];
        let scale = Self::FILL * (size[0] / (hi[0] - lo[0])).min(size[1] / (hi[1] - lo[1]));
        let shift = [0.5 * (size[0] - scale * (lo[0] + hi[0])), 0.5 * (size[1] + scale * (lo[1] + hi[1]))];
        Ok(Self { right, up, towards, scale, shift })
    }

    /// Pixel coordinates, y down, and depth in pixels, growing towards the eye.
    fn project(&self, p: DVec3) -> DVec3 {
        DVec3::new(
            self.shift[0] + self.scale * p.dot(self.right),
            self.shift[1] - self.scale * p.dot(self.up),
            self.scale * p.dot(self.towards),
        )
    }
}

/// Draws an image of so many pixels.
fn draw(bodies: &[Body], size: [usize; 2]) -> Result<(Camera, DepthBuffer), FigureError> {
    let fine = size.map(|n| n * FINER);
    let camera = Camera::new(bodies, fine)?;
    let mut buffer = DepthBuffer::new(fine);
    // Facets are numbered from 1 through all bodies.
    let counts = bodies.iter().scan(1, |next, body| {
        let first = *next;
        *next += body.surface.facets.len();
        Some(first)
    });
    let numbered: Vec<(usize, &Body)> = counts.zip(bodies).collect();
    for (first, body) in &numbered {
        for (number, (facet, normal)) in body.surface.facets.iter().zip(&body.normals).enumerate() {
            if normal.dot(camera.towards) <= 0.0 {
                continue;
            }
            let shade = shade(body.fill, *normal);
            let corners: Vec<DVec3> =
                facet.corners.iter().map(|i| camera.project(body.corners[*i as usize])).collect();
            for k in 1..corners.len() - 1 {
                let number = (first + number) as u32;
                buffer.triangle([corners[0], corners[k], corners[k + 1]], shade, number);
            }
        }
    }
    for (first, body) in &numbered {
        for (ends, facets) in body.bends() {
            let facets: Vec<u32> = facets.into_iter().map(|number| (first + number) as u32).collect();
            buffer.edge(ends.map(|p| camera.project(p)), body.edge, &facets);
        }
    }
    Ok((camera, buffer))
}

/// Light from the upper left front, and a floor of brightness.
fn shade(fill: Rgb, normal: DVec3) -> Rgb {
    let light = DVec3::new(-0.45, -0.55, 0.7) / 0.998_749_2;
    let brightness = normal.dot(light);
    if brightness > 0.0 {
        mix(fill, [255; 3], 0.42 * brightness)
    } else {
        mix(fill, [0x22, 0x2b, 0x3a], -0.45 * brightness)
    }
}

#[cfg(test)]
mod tests {
    use super::super::depth_buffer::packed;
    use super::super::testing::{look, pyramid, v_face, x_face};
    use super::*;
    use crate::schema::testing::design;
    use catchment_core::pose::{DofSet, PoseError};

    #[test]
    fn solids_of_every_kind() {
        let design = design(DofSet::ALL);
        let error = PoseError { x: 0.2, y: -0.1, roll: 0.1, pitch: 0.2, yaw: 0.3 };
        let placement = MovingHalfPose { error, height: 0.75 };
        for (name, connector) in [("solid-v", v_face()), ("solid-x", x_face()), ("solid-pyramid", pyramid())]
        {
            look(name, &solids(&design, &connector, &placement).unwrap());
        }
    }

    #[test]
    fn the_nearer_half_hides_the_other() {
        // The plug sits in its socket: of the plug only the base, facing up, is seen; no pixel of its flanks.
        let connector = pyramid();
        let body = |s, c| Body::new(s, DMat3::IDENTITY, DVec3::ZERO, [c, c]);
        let bodies = [
            body(&connector.fixed.surfaces[0], [0, 0, 200]),
            body(&connector.moving.surfaces[0], [200, 0, 0]),
        ];
        let image = draw(&bodies, [200, 160]).unwrap().1.averaged();
        let red = image.chunks_exact(4).filter(|p| p[3] == 255 && p[0] > p[2]);
        let mut shades: Vec<_> = red.map(|p| [p[0], p[1], p[2]]).collect();
        shades.sort_unstable();
        let most = shades.chunk_by(|a, b| a == b).map(<[_]>::len).max().unwrap();
        assert!(most * 10 > shades.len() * 8, "one facet, one shade: {most} of {}", shades.len());
    }

    /// For two boxes with coplanar fronts, the second showed through the first; so did the ends of receding
    /// edges.
    #[test]
    fn edges_are_seen_where_their_facets_are() {
        let block = |lo: [f64; 3], hi: [f64; 3]| {
            let [[x0, y0, z0], [x1, y1, z1]] = [lo, hi];
            let below = [[x0, y0, z0], [x1, y0, z0], [x1, y1, z0], [x0, y1, z0]];
            let corners = below.into_iter().chain(below.map(|[x, y, _]| [x, y, z1]));
            let mut sides = vec![vec![3, 2, 1, 0], vec![4, 5, 6, 7]];
            sides.extend((0..4u32).map(|k| vec![k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4]));
            Surface::from_polygons(corners.map(DVec3::from_array).collect(), &sides).unwrap()
        };
        let surfaces = [block([0.0, 0.0, 0.0], [1.0, 1.0, 1.0]), block([0.5, 0.0, 0.2], [1.6, 1.0, 0.8])];
        let edges = [[1, 2, 3], [200, 0, 0]];
        let bodies: Vec<Body> = surfaces
            .iter()
            .zip(edges)
            .map(|(s, edge)| Body::new(s, DMat3::IDENTITY, DVec3::ZERO, [[255; 3], edge]))
            .collect();
        let (camera, buffer) = draw(&bodies, [300, 240]).unwrap();
        let near = |point: [f64; 3], colour: Rgb| {
            let at = camera.project(DVec3::from_array(point));
            buffer.around(at).into_iter().filter(|index| buffer.colour[*index] == packed(colour)).count()
        };
        // In front, within the first box and beyond it; its own front edge; the back of the second.
        assert_eq!(near([0.5, 0.0, 0.5], edges[1]), 0);
        assert_eq!(near([0.75, 0.0, 0.8], edges[1]), 0);
        assert!(near([1.3, 0.0, 0.8], edges[1]) > 5 && near([1.6, 0.0, 0.5], edges[1]) > 5);
        assert!(near([0.3, 0.0, 0.0], edges[0]) > 5);
        assert_eq!(near([1.4, 1.0, 0.2], edges[1]), 0);
        // A little behind the lower left corner of the first.
        assert_eq!(near([0.0, 0.06, 0.0], edges[0]), 0);
    }

    #[test]
    fn nothing_cannot_be_drawn() {
        let nothing = Connector::from_halves(
            catchment_core::connector::Half::default(),
            catchment_core::connector::Half::default(),
        );
        let design = design(DofSet::ALL);
        let placement = MovingHalfPose::mated(&design, 0.0);
        assert!(matches!(solids(&design, &nothing, &placement), Err(FigureError::Empty { .. })));
    }
}
