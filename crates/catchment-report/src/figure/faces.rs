//! Planar designs side by side at a common scale: mated, and at the largest offset that contact corrects.
//!
//! ```text
//!    ▓╲  ╱▓   ▓╱╲  ▓      row 1: mated, with H and D
//!    ░░╲╱░░   ░  ╲╱░
//!
//!      ▓▓╲  ╱▓▓           row 2: shifted to the end of the exact interval (method::zraa), at the height of first contact
//!    ░░╲  ╲╱
//!      │←─→│ 0.5 D        the offset, from face centre to face centre
//! ```
//!
//! The scale is the same in D, so that faces of different sizes are comparable.

use super::super::zraa::NilssonReport;
use super::draw::arrow::dimension;
use super::draw::axis::{AxisScale, PlotFrame, ShownUnits, short};
use super::draw::layout::{Layout, Panel};
use super::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, width_of};
use super::section::{MovingHalfPose, View, approach_axis};
use super::{FigureError, Picture};
use catchment_core::connector::Connector;
use catchment_core::contact::Pair;
use catchment_core::design::{ConnectorSpec, Design};
use catchment_core::document::rounded;
use catchment_core::method::zraa::Nilsson;
use catchment_core::pose::{CorPose, PoseError};
use glam::{DMat3, DVec2};

/// Longest D, in SVG units.
const LARGEST: f64 = 150.0;
/// Width that all faces share, in SVG units, gaps included.
const WIDTH: f64 = 1000.0;
/// Between two faces: room for H.
const GAP: f64 = 48.0;
/// Room on either side of a face, above it for its name, and below it for a length.
const SIDE: f64 = 12.0;
const HEAD: f64 = 40.0;
const BELOW: f64 = 24.0;
/// Least width of a column: room for words.
const COLUMN: f64 = 150.0;
/// Bold letters are wider by this, about.
const BOLD: f64 = 1.14;
/// The largest offset itself is a border, at which contacts inside it may open.
const INSIDE: f64 = 1.0 - 1e-9;

/// A design of the picture.
#[derive(Debug, Clone, Copy)]
pub struct PicturedDesign<'a> {
    /// The design.
    pub design: &'a Design,
    /// Its halves.
    pub connector: &'a Connector,
    /// Its halves as they touch.
    pub pair: &'a Pair,
    /// Offsets along x that are corrected without rotation, in D.
    pub reach: [f64; 2],
    /// Bounds of its profile, if it has one.
    pub nilsson: Option<Nilsson>,
}

impl PicturedDesign<'_> {
    /// The larger of the two offsets.
    fn offset(&self) -> f64 {
        let [from, to] = self.reach;
        if to >= -from { to } else { from }
    }

    /// Pose of the moving half in contact at the largest offset.
    fn shifted(&self) -> Result<MovingHalfPose, FigureError> {
        let x = self.offset() * INSIDE;
        let pose = CorPose { lateral: DVec2::new(x, 0.0), rotation: DMat3::IDENTITY };
        let height =
            self.pair.height(&pose).ok_or(FigureError::Empty { what: "the halves pass each other by" })?;
        Ok(MovingHalfPose { error: PoseError { x, ..PoseError::default() }, height })
    }
}

/// A view that lies in a column of the picture.
struct Column<'a> {
    face: &'a PicturedDesign<'a>,
    rows: [(View<'a>, MovingHalfPose); 2],
    width: f64,
}

/// Draws designs side by side.
///
/// # Errors
/// If a design cannot be cut along the approach axis, or its halves pass each other by.
pub fn faces(faces: &[PicturedDesign<'_>]) -> Result<Picture, FigureError> {
    let mut columns = Vec::new();
    for face in faces {
        let mated = MovingHalfPose::mated(face.design, 0.0);
        let shifted = face.shifted()?;
        let view = |placement: &MovingHalfPose| {
            View::new(face.design, face.connector, std::slice::from_ref(placement))
        };
        let rows = [(view(&mated)?, mated), (view(&shifted)?, shifted)];
        columns.push(Column { face, rows, width: 0.0 });
    }
    let widest = |column: &Column<'_>| column.rows.iter().map(|(view, _)| view.size()[0]).fold(0.0, f64::max);
    let all: f64 = columns.iter().map(widest).sum();
    let gaps = GAP * (columns.len() + 1) as f64;
    let scale = ((WIDTH - gaps) / all).clamp(LARGEST / 4.0, LARGEST);
    for column in &mut columns {
        column.width = (widest(column) * scale).max(COLUMN);
    }
    // The face centres of a row are at the same height.
    let rows = [0, 1].map(|k| {
        let spans = columns.iter().map(|column| column.rows[k].0.span());
        spans.fold([f64::INFINITY, f64::NEG_INFINITY], |a, b| [a[0].min(b[0]), a[1].max(b[1])])
    });
    let tall = rows.map(|[lo, hi]| (hi - lo) * scale);
    let row = |k: usize| {
        let room = [SIDE, if k == 0 { HEAD } else { 0.0 }, SIDE, BELOW];
        columns
            .iter()
            .map(move |column| Panel::of([column.width, tall[k]]).with_room(room))
            .collect::<Vec<_>>()
    };
    let (mut svg, frames) = Layout::titled("Offsets that slide home without rotation")
        .story("mated, and at the largest offset that still does; D is as long in all")
        .row(row(0))
        .row(row(1))
        .open();
    let (mated, shifted) = frames.split_at(columns.len());
    for (column, frames) in columns.iter().zip(mated.iter().zip(shifted)) {
        let middle = frames.0.x + column.width / 2.0;
        let name = fitted(&column.face.design.name, BOLD * LABEL, column.width);
        svg.bold([middle, frames.0.y - 30.0], LABEL, Anchor::Middle, &name);
        let bound = column.face.nilsson.as_ref().map_or_else(
            || "not one profile".to_owned(),
            |nilsson| format!("one profile: at most {}", NilssonReport::from(nilsson).bound()),
        );
        svg.text([middle, frames.0.y - 13.0], LABEL - 1.0, Anchor::Middle, SOFT, &bound);
        for (k, rect) in [*frames.0, *frames.1].into_iter().enumerate() {
            let (view, placement) = &column.rows[k];
            let frame = frame_of(column.face, view, rect, scale, rows[k]);
            approach_axis(&mut svg, &frame);
            view.fixed(&mut svg, &frame);
            view.moving(&mut svg, &frame, placement);
            if k == 0 {
                size(&mut svg, column.face, view, &frame);
            } else {
                offset(&mut svg, column.face, view, &frame);
            }
        }
    }
    Ok(Picture::of(svg))
}

/// The frame of a view in its column: `scale` SVG units to the D, the face centre at the height of the row.
fn frame_of(
    face: &PicturedDesign<'_>,
    view: &View<'_>,
    rect: Rect,
    scale: f64,
    [lo, hi]: [f64; 2],
) -> PlotFrame {
    let factor = ShownUnits::of(face.design).lengths();
    let half = rect.w / scale / 2.0;
    let range = |lo: f64, hi: f64| AxisScale::new(String::new(), lo * factor, hi * factor, false);
    PlotFrame { rect, x: range(view.middle() - half, view.middle() + half), y: range(lo, hi) }
}

/// D below the mated halves, and H beside them.
fn size(svg: &mut Svg, face: &PicturedDesign<'_>, view: &View<'_>, frame: &PlotFrame) {
    let below = frame.rect.y + frame.rect.h + 4.0;
    let [left, right] = [-0.5, 0.5].map(|x| view.place(frame, [x, 0.0])[0]);
    dimension(svg, [left, below], [right, below], INK);
    let units = ShownUnits::of(face.design);
    let length = face
        .design
        .unit
        .map_or_else(|| "D".to_owned(), |_| format!("D = {} {}", short(units.lengths()), units.symbol()));
    svg.text([0.5 * (left + right), below + 16.0], LABEL - 1.0, Anchor::Middle, INK, &length);
    if let ConnectorSpec::Family(spec) = &face.design.connector {
        let h = spec.aspect_ratio() / 2.0;
        let [low, high] = [-h, h].map(|z| view.place(frame, [0.5, z])[1]);
        let beside = right + 12.0;
        dimension(svg, [beside, low], [beside, high], INK);
        svg.text([beside + 6.0, 0.5 * (low + high) + 4.0], LABEL - 1.0, Anchor::Start, INK, "H");
    }
}

/// The offset below the shifted halves, from face centre to face centre.
fn offset(svg: &mut Svg, face: &PicturedDesign<'_>, view: &View<'_>, frame: &PlotFrame) {
    let shift = face.offset();
    let below = frame.rect.y + frame.rect.h + 6.0;
    let [fixed, moving] = [0.0, shift].map(|x| view.place(frame, [x, 0.0])[0]);
    let style = format!(r#"stroke="{INK}" stroke-width="0.9" stroke-dasharray="3 3""#);
    for x in [fixed, moving] {
        svg.line([x, frame.rect.y], [x, below + 4.0], &style);
    }
    dimension(svg, [fixed, below], [moving, below], INK);
    let units = ShownUnits::of(face.design);
    let in_d = rounded(shift).replace('-', "−");
    let length = face.design.unit.map_or_else(
        || format!("{in_d} D"),
        |_| format!("{in_d} D = {} {}", short(shift * units.lengths()), units.symbol()),
    );
    svg.text([0.5 * (fixed + moving), below + 18.0], LABEL, Anchor::Middle, INK, &length);
}

/// As much of a name as fits.
fn fitted(name: &str, size: f64, width: f64) -> String {
    if width_of(name, size) <= width {
        return name.to_owned();
    }
    let mut kept: String = name.to_owned();
    while !kept.is_empty() && width_of(&kept, size) + size > width {
        kept.pop();
    }
    kept + "…"
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use catchment_core::design::{Alignment, Family, FamilySpec};

    #[test]
    fn three_faces_stand_at_one_scale() {
        let given = [(Family::SFace, 1.0 / 3.0), (Family::VFace, 0.5), (Family::XFace, 1.0)];
        let made: Vec<(Design, Connector, f64)> = given
            .into_iter()
            .map(|(family, reach)| {
                let spec = FamilySpec::new(family);
                let design = Design {
                    name: format!("a face named {} with more words than fit", family.name()),
                    connector: ConnectorSpec::Family(spec),
                    width: 1.0,
                    unit: None,
                    alignment: Alignment::default_for(Some(family)),
                };
                let connector = Connector::build(&design).unwrap();
                (design, connector, reach)
            })
            .collect();
        let pairs: Vec<Pair> = made.iter().map(|(d, c, _)| Pair::new(c, &d.alignment)).collect();
        let shown: Vec<PicturedDesign<'_>> = made
            .iter()
            .zip(&pairs)
            .map(|((design, connector, reach), pair)| PicturedDesign {
                design,
                connector,
                pair,
                reach: [-reach, *reach],
                nilsson: None,
            })
            .collect();
        let picture = faces(&shown).unwrap();
        look("faces", &picture);
        let svg = picture.svg();
        for length in ["0.3333 D", "0.5 D", "1 D", ">H<", "…<", "a face named ", "not one profile"] {
            assert!(svg.contains(length), "{length}");
        }
        assert!(!svg.contains("NaN") && faces(&shown[..1]).unwrap().svg().contains("0.3333 D"));
    }
}
