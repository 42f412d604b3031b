//! Both halves cut by a plane along the approach axis: y = constant in the world frame, or through the
//! contacts ([`super::plane`]).
//!
//! The usual cut is y = 0. If facets lie in that plane or no solid meets it (a connector in two layers), a
//! cut through the middle of either side is drawn, the farther one paler behind the nearer one.

use super::draw::axis::{AxisScale, PlotFrame, ShownUnits, short};
use super::draw::colour::{self, Rgb, hex, mix};
use super::draw::layout::{Layout, Panel};
use super::draw::svg::{Anchor, INK, JOIN, LABEL, Rect, SOFT, Svg, polyline};
use super::plane::{Patch, Plane, Stroke};
use super::{FigureError, Picture};
use catchment_core::connector::{Connector, Half, Surface};
use catchment_core::design::Design;
use catchment_core::pose::{Dof, PoseError, face_from_cor};
use catchment_core::tolerance::COINCIDENT;
use glam::{DMat3, DVec3};
use std::collections::BTreeMap;

/// Pose of the moving half.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingHalfPose {
    /// The pose error of its face centre.
    pub error: PoseError,
    /// z of its centre of rotation in the world frame, in D; aligned it is at −cor.
    pub height: f64,
}

impl MovingHalfPose {
    /// The mated pose lifted by `lift` D.
    pub fn mated(design: &Design, lift: f64) -> Self {
        Self { error: PoseError::default(), height: lift - design.alignment.center_of_rotation }
    }

    /// Rotation, and position of the face centre in the world frame.
    pub(super) fn of(&self, design: &Design) -> (DMat3, DVec3) {
        let rotation = self.error.rotation();
        let face = face_from_cor(&rotation, design.alignment.center_of_rotation);
        (rotation, DVec3::new(self.error.x, self.error.y, self.height + face.z))
    }
}

/// The colour of contacts.
const CONTACT: &str = "#c0262d";
/// Contacts this near to the cut are in it, in D: less than the picture resolves.
const CLOSE: f64 = 5e-3;
/// Contacts closer to each other than this are merged, in SVG units.
const APART: f64 = 3.0;

/// Marks a contact: full, or hollow if it is seen through something.
pub(super) fn contact_mark(svg: &mut Svg, at: [f64; 2], full: bool) {
    let fill = if full { CONTACT } else { "none" };
    svg.circle(at, 5.4, r##"fill="none" stroke="#ffffff" stroke-width="3""##);
    svg.circle(at, 4.4, &format!(r#"fill="{fill}" stroke="{CONTACT}" stroke-width="1.6""#));
}

/// Whether a position differs from all positions shown before; if not, it is merged.
pub(super) fn seen_apart(shown: &mut Vec<[f64; 2]>, at: [f64; 2]) -> bool {
    let is_apart = shown.iter().all(|other| (other[0] - at[0]).hypot(other[1] - at[1]) >= APART);
    if is_apart {
        shown.push(at);
    }
    is_apart
}

/// Draws the two halves in section at a pose.
///
/// # Errors
/// If the cut meets neither half.
pub fn section(
    design: &Design,
    connector: &Connector,
    placement: &MovingHalfPose,
) -> Result<Picture, FigureError> {
    let view = View::new(design, connector, std::slice::from_ref(placement))?;
    let (width, height) = view.fit(460.0, 420.0);
    let (mut svg, frames) =
        Layout::of(design).story(describe(design, placement)).row([Panel::with_axes([width, height])]).open();
    panel(&mut svg, frames[0], design, connector, placement)?;
    Ok(Picture::of(svg))
}

/// The same in a rectangle of another picture, with its axes around it.
///
/// # Errors
/// If the cut meets neither half.
pub fn panel(
    svg: &mut Svg,
    rect: Rect,
    design: &Design,
    connector: &Connector,
    placement: &MovingHalfPose,
) -> Result<(), FigureError> {
    let view = View::new(design, connector, std::slice::from_ref(placement))?;
    let frame = view.frame(rect);
    view.halves(svg, &frame, placement);
    frame.draw(svg);
    Ok(())
}

/// The errors that are not zero, in words.
pub(super) fn describe(design: &Design, placement: &MovingHalfPose) -> String {
    let units = ShownUnits::of(design);
    let words: Vec<String> = Dof::ALL
        .into_iter()
        .zip(placement.error.to_array())
        .filter(|(_, value)| value.abs() > 1e-9)
        .map(|(dof, value)| units.value(dof, value))
        .collect();
    if !words.is_empty() {
        return words.join(", ");
    }
    let apart = placement.height + design.alignment.center_of_rotation;
    if apart > 1e-9 { "mated, drawn apart".to_owned() } else { "mated".to_owned() }
}

/// A section with its extent: shared by the pictures with sections.
pub(super) struct View<'a> {
    design: &'a Design,
    connector: &'a Connector,
    units: ShownUnits,
    /// The cutting plane.
    plane: Plane,
    /// Turns the world so that the cuts are at constant y.
    turn: DMat3,
    lo: [f64; 2],
    hi: [f64; 2],
}

impl<'a> View<'a> {
    /// A view of the fixed half and the moving half at all of `placements`.
    pub(super) fn new(
        design: &'a Design,
        connector: &'a Connector,
        placements: &[MovingHalfPose],
    ) -> Result<Self, FigureError> {
        Self::along(design, connector, placements, Plane::across(connector))
    }

    /// The same, cut along a given plane.
    pub(super) fn along(
        design: &'a Design,
        connector: &'a Connector,
        placements: &[MovingHalfPose],
        plane: Plane,
    ) -> Result<Self, FigureError> {
        let turn = plane.turn();
        let (mut lo, mut hi) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut grow = |loops: Vec<Vec<[f64; 2]>>| {
            for point in loops.into_iter().flatten() {
                for k in 0..2 {
                    lo[k] = lo[k].min(point[k]);
                    hi[k] = hi[k].max(point[k]);
                }
            }
        };
        for y in &plane.offsets {
            grow(cut(&connector.fixed, turn, DVec3::ZERO, *y));
            for placement in placements {
                let (rotation, face) = placement.of(design);
                grow(cut(&connector.moving, turn * rotation, turn * face, *y));
            }
        }
        if lo[0] > hi[0] {
            return Err(FigureError::Empty { what: "the cut meets neither half" });
        }
        let margin = 0.06 * (hi[0] - lo[0]).max(hi[1] - lo[1]);
        Ok(Self {
            design,
            connector,
            units: ShownUnits::of(design),
            plane,
            turn,
            lo: lo.map(|v| v - margin),
            hi: hi.map(|v| v + margin),
        })
    }

    /// The same, grown to show these places in x and z, in D.
    pub(super) fn with(mut self, places: &[[f64; 2]]) -> Self {
        let margin = 0.06 * self.size()[0].max(self.size()[1]);
        for place in places {
            for (k, value) in place.iter().enumerate() {
                self.lo[k] = self.lo[k].min(value - margin);
                self.hi[k] = self.hi[k].max(value + margin);
            }
        }
        self
    }

    /// How wide and how high it is, in D.
    pub(super) fn size(&self) -> [f64; 2] {
        [0, 1].map(|k| self.hi[k] - self.lo[k])
    }

    /// Its middle in x, in D.
    pub(super) fn middle(&self) -> f64 {
        f64::midpoint(self.lo[0], self.hi[0])
    }

    /// The lowest and the highest z, in D.
    pub(super) fn span(&self) -> [f64; 2] {
        [self.lo[1], self.hi[1]]
    }

    /// The largest size with the view's own proportions inside the given size.
    pub(super) fn fit(&self, width: f64, height: f64) -> (f64, f64) {
        let [w, h] = self.size();
        let scale = (width / w).min(height / h);
        (w * scale, h * scale)
    }

    /// Fills a rectangle of any proportions: the view is widened to keep lengths equal in both directions.
    pub(super) fn frame(&self, rect: Rect) -> PlotFrame {
        let [w, h] = self.size();
        let scale = (rect.w / w).min(rect.h / h);
        let [mx, mz] = [0, 1].map(|k| 0.5 * (self.lo[k] + self.hi[k]));
        let [rx, rz] = [0.5 * rect.w / scale, 0.5 * rect.h / scale];
        let axis = |name: &str, lo: f64, hi: f64| -> AxisScale { self.units.length(name, lo, hi) };
        PlotFrame { rect, x: axis(&self.plane.name(), mx - rx, mx + rx), y: axis("z", mz - rz, mz + rz) }
    }

    /// Both halves, the moving half at `placement`, with its face centre and centre of rotation.
    pub(super) fn halves(&self, svg: &mut Svg, frame: &PlotFrame, placement: &MovingHalfPose) {
        svg.begin_clip(frame.rect);
        approach_axis(svg, frame);
        self.fixed(svg, frame);
        self.moving(svg, frame, placement);
        self.marks(svg, frame, placement);
        svg.end();
    }

    pub(super) fn fixed(&self, svg: &mut Svg, frame: &PlotFrame) {
        self.half(
            svg,
            frame,
            &self.connector.fixed,
            (DMat3::IDENTITY, DVec3::ZERO),
            [colour::FIXED, colour::FIXED_EDGE],
        );
    }

    pub(super) fn moving(&self, svg: &mut Svg, frame: &PlotFrame, placement: &MovingHalfPose) {
        let colours = [colour::MOVING, colour::MOVING_EDGE];
        self.half(svg, frame, &self.connector.moving, placement.of(self.design), colours);
    }

    fn half(
        &self,
        svg: &mut Svg,
        frame: &PlotFrame,
        half: &Half,
        (r, face): (DMat3, DVec3),
        [fill, edge]: [Rgb; 2],
    ) {
        let cuts = &self.plane.offsets;
        let (r, face) = (self.turn * r, self.turn * face);
        for (k, y) in cuts.iter().enumerate() {
            let pale = 0.62 * (cuts.len() - 1 - k) as f64;
            let [fill, edge] = [fill, edge].map(|c| hex(mix(c, [255; 3], pale)));
            let data: String = cut(half, r, face, *y)
                .into_iter()
                .map(|outline| polyline(outline.into_iter().map(|p| self.place(frame, p)), true))
                .collect();
            // The outline goes under the fill, so that walls between touching pieces disappear.
            svg.path(&data, &format!(r#"fill="none" stroke="{edge}" stroke-width="3" {JOIN}"#));
            svg.path(&data, &format!(r#"fill="{fill}" stroke="{fill}" stroke-width="0.5" {JOIN}"#));
        }
    }

    /// Visible position of a point of the world.
    pub(super) fn seen(&self, frame: &PlotFrame, point: DVec3) -> [f64; 2] {
        let point = self.turn * point;
        self.place(frame, [point.x, point.z])
    }

    pub(super) fn place(&self, frame: &PlotFrame, [x, z]: [f64; 2]) -> [f64; 2] {
        frame.at([x * self.units.lengths(), z * self.units.lengths()])
    }

    /// The contacts: full in the plane of the cut, hollow if seen through.
    pub(super) fn contacts(&self, svg: &mut Svg, frame: &PlotFrame, patches: &[Patch]) {
        for patch in patches {
            let in_cut = |stroke: &Stroke| self.plane.offsets.iter().any(|y| stroke.holds(*y, CLOSE));
            let mut strokes = patch.strokes(&self.turn);
            strokes.sort_by_key(|stroke| !in_cut(stroke));
            let mut shown: Vec<[f64; 2]> = Vec::new();
            for stroke in strokes {
                let at = self.place(frame, stroke.at);
                if seen_apart(&mut shown, at) {
                    contact_mark(svg, at, in_cut(&stroke));
                }
            }
        }
    }

    /// The cutting plane in words, if it is not the usual plane.
    pub(super) fn words(&self) -> Option<String> {
        let [offset] = self.plane.offsets[..] else { return None };
        self.plane.through_contacts.then(|| {
            let beside = short(offset * self.units.lengths());
            let way = self.plane.name();
            let way = if way == "x" || way == "y" { format!("along {way}") } else { way };
            format!("cut through the contacts: {way}, {beside} {} beside the axis", self.units.symbol())
        })
    }

    /// ● the face centre, ⊕ the centre of rotation, of the moving half.
    fn marks(&self, svg: &mut Svg, frame: &PlotFrame, placement: &MovingHalfPose) {
        let (rotation, face) = placement.of(self.design);
        let cor = face - face_from_cor(&rotation, self.design.alignment.center_of_rotation);
        let [at_face, at_cor] = [face, cor].map(|p| self.seen(frame, p));
        if (face - cor).length() > 1e-9 {
            svg.line(
                at_face,
                at_cor,
                &format!(r#"stroke="{INK}" stroke-width="0.9" stroke-dasharray="2 2.5""#),
            );
        }
        svg.circle(at_cor, 5.0, &format!(r##"fill="#ffffff" stroke="{INK}" stroke-width="1.4""##));
        for [dx, dy] in [[3.4, 0.0], [0.0, 3.4]] {
            let ([x, y], style) = (at_cor, format!(r#"stroke="{INK}" stroke-width="1.1""#));
            svg.line([x - dx, y - dy], [x + dx, y + dy], &style);
        }
        svg.circle(at_face, 2.4, &format!(r#"fill="{INK}""#));
        if at_cor[1] < frame.rect.y + frame.rect.h - 8.0 {
            svg.text([at_cor[0] + 9.0, at_cor[1] + 4.0], LABEL - 1.0, Anchor::Start, INK, "COR");
        }
    }
}

/// The dash-dotted line x = 0.
pub(super) fn approach_axis(svg: &mut Svg, frame: &PlotFrame) {
    let x = frame.px(0.0);
    let style =
        format!(r#"stroke="{SOFT}" stroke-opacity="0.6" stroke-width="0.9" stroke-dasharray="9 3 2 3""#);
    svg.line([x, frame.rect.y], [x, frame.rect.y + frame.rect.h], &style);
}

/// Positions of cuts: y = 0, or either side of it if a half has facets there or does not meet it. From far
/// (+y) to near.
pub(super) fn cuts(connector: &Connector) -> Vec<f64> {
    let lies_in = |s: &Surface| {
        s.facets.iter().any(|f| f.corners.iter().all(|i| s.vertices[*i as usize].y.abs() < COINCIDENT))
    };
    let meets = |s: &Surface| {
        let (lo, hi) = s.bounds();
        lo.y < -COINCIDENT && hi.y > COINCIDENT
    };
    let all = || connector.fixed.surfaces.iter().chain(&connector.moving.surfaces);
    if all().any(meets) && !all().any(lies_in) {
        return vec![0.0];
    }
    let surfaces = &connector.fixed.surfaces;
    let (lo, hi) = surfaces
        .iter()
        .map(Surface::bounds)
        .fold((0.0f64, 0.0f64), |(lo, hi), (a, b)| (lo.min(a.y), hi.max(b.y)));
    [0.5 * hi, 0.5 * lo].into_iter().filter(|y| y.abs() > COINCIDENT).collect()
}

/// The closed outlines, in x and z, of a half rotated by `rotation` and moved by `shift`, cut at `y`.
///
/// A corner on the plane counts as beyond it. Then zero or two edges of every facet cross the plane, and
/// every crossed edge belongs to two facets: the outlines close without any tolerance.
pub(super) fn cut(half: &Half, rotation: DMat3, shift: DVec3, y: f64) -> Vec<Vec<[f64; 2]>> {
    let mut outlines = Vec::new();
    for surface in &half.surfaces {
        let corners: Vec<DVec3> = surface.vertices.iter().map(|v| rotation * *v + shift).collect();
        let beyond = |i: u32| corners[i as usize].y >= y;
        let key = |a: u32, b: u32| (a.min(b), a.max(b));
        let mut next: BTreeMap<(u32, u32), (u32, u32)> = BTreeMap::new();
        for facet in &surface.facets {
            let (mut enters, mut leaves) = (None, None);
            for (k, a) in facet.corners.iter().enumerate() {
                let b = facet.corners[(k + 1) % facet.corners.len()];
                match (beyond(*a), beyond(b)) {
                    (false, true) => enters = Some(key(*a, b)),
                    (true, false) => leaves = Some(key(*a, b)),
                    _ => {}
                }
            }
            if let (Some(from), Some(to)) = (enters, leaves) {
                next.insert(from, to);
            }
        }
        let crossing = |(a, b): (u32, u32)| {
            let (p, q) = (corners[a as usize], corners[b as usize]);
            let point = p + (q - p) * ((y - p.y) / (q.y - p.y));
            [point.x, point.z]
        };
        while let Some((start, mut edge)) = next.pop_first() {
            let mut outline = vec![crossing(start)];
            while edge != start {
                outline.push(crossing(edge));
                let Some(to) = next.remove(&edge) else { break };
                edge = to;
            }
            outlines.push(outline);
        }
    }
    outlines
}

#[cfg(test)]
mod tests {
    use super::super::testing::{look, pyramid, v_face, x_face};
    use super::*;
    use crate::schema::testing::design;
    use catchment_core::pose::DofSet;

    fn area(outline: &[[f64; 2]]) -> f64 {
        let n = outline.len();
        let cross =
            |k: usize| outline[k][0] * outline[(k + 1) % n][1] - outline[k][1] * outline[(k + 1) % n][0];
        (0..n).map(cross).sum::<f64>().abs() / 2.0
    }

    #[test]
    fn a_cut_of_a_pyramid_is_a_triangle_of_known_area() {
        // Height ½ over a base of side 1: at y the triangle's base shrinks by the factor 1 − 2|y|, both ways.
        for y in [0.0, 0.1, -0.3] {
            let outlines = cut(&pyramid().moving, DMat3::IDENTITY, DVec3::ZERO, y);
            assert_eq!(outlines.len(), 1);
            // The trapezium between the section of the slanted faces: ½·(1 + w)·h with top w = 2|y|, h = ½(1 − 2|y|).
            let exact = 0.5 * (1.0 + 2.0 * y.abs()) * 0.5 * (1.0 - 2.0 * y.abs());
            assert!((area(&outlines[0]) - exact).abs() < 1e-12, "{y}: {}", area(&outlines[0]));
        }
        assert_eq!(cut(&pyramid().moving, DMat3::IDENTITY, DVec3::ZERO, 0.7).len(), 0);
    }

    #[test]
    fn layers_are_cut_on_either_side() {
        assert_eq!(cuts(&v_face()), [0.0]);
        assert_eq!(cuts(&x_face()), [0.125, -0.125]);
        // A gap between the layers.
        let apart = |half: &Half| half.mapped(|p| DVec3::new(p.x, 2.0 * p.y + 0.05f64.copysign(p.y), p.z));
        let mut layers = x_face();
        for half in [&mut layers.fixed, &mut layers.moving] {
            half.surfaces.retain(|s| s.bounds().1.y > 1e-9);
            *half = apart(half);
        }
        assert_eq!(cuts(&layers), [0.275]);
    }

    #[test]
    fn sections_of_every_kind() {
        let mut design = design([Dof::X, Dof::Pitch].into_iter().collect::<DofSet>());
        design.alignment.center_of_rotation = 0.5;
        let error = PoseError { x: 0.25, pitch: 0.3, ..PoseError::default() };
        let placement = MovingHalfPose { error, height: 0.05 };
        for (name, connector) in
            [("section-v", v_face()), ("section-x", x_face()), ("section-pyramid", pyramid())]
        {
            let picture = section(&design, &connector, &placement).unwrap();
            look(name, &picture);
            assert!(picture.svg().contains("x = 12.5 mm, pitch = 17.2°"));
        }
    }
}
