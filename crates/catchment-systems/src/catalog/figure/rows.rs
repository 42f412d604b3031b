//! The rows of figure 2.1: connectors with a known region.

use super::super::data::PublishedZraa;
use super::super::facts::{AcceptanceShape, Fact};
use super::super::{Catalog, GEOMETRY};
use super::cells::{ACCEPTED, View, corners, dashed, dotted, face, filled};
use super::{DrawError, NAMES, problem};
use catchment::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use catchment::exec::Exec;
use catchment::method::zraa::{AcceptedSquare, Zraa, ZraaSettings, run};
use catchment::pose::PoseError;
use catchment::problem::Problem;
use catchment::report::figure::draw::colour::{NOTHING, hex, mix};
use catchment::report::figure::draw::layout::Panel;
use catchment::report::figure::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TICK};
use catchment::report::figure::{MovingHalfPose, solid_panel};
use glam::DVec2;
use std::f64::consts::SQRT_2;

/// Cells of a row.
pub(super) const CELLS: usize = 3;
/// Side of a cell.
const CELL: f64 = 116.0;
/// Offsets that a cell shows, in D.
const REACH: f64 = 1.08;
/// Half the width of a cross-section, in D.
const SECTION: f64 = 0.76;
/// Distance at which the halves are drawn apart, in D.
const APART: f64 = 0.9;
/// Height of the strip that stands for an interval, in D.
const STRIP: f64 = 0.16;

/// The panels of a row, the first after its names; the first row has headings.
pub(super) fn panels(has_headings: bool) -> impl Iterator<Item = Panel> {
    ["the two halves", "along the approach", "area of acceptance"].into_iter().enumerate().map(
        move |(k, heading)| {
            let names = if k == 0 { NAMES } else { 0.0 };
            let panel = Panel::of([CELL; 2]).with_room([names, 0.0, 0.0, 0.0]);
            if has_headings { panel.over(heading) } else { panel }
        },
    )
}

/// A connector with its region.
pub(super) struct Row {
    name: &'static str,
    words: Vec<String>,
    problem: Option<Problem>,
    /// How wide it is, in D.
    width: f64,
    region: Region,
}

enum Region {
    Computed(Zraa, AcceptedSquare),
    Closed(AcceptanceShape),
    /// The circle of a printed area.
    OfNumber(AcceptanceShape),
}

/// Families, their names here, and how wide they are drawn.
const FAMILIES: [(Family, &str, f64, &str); 7] = [
    (Family::Cone, "cone, around", SQRT_2, "around the unit square"),
    (Family::Cone, "cone, inside", 1.0, "inside the unit square"),
    (Family::Pyramid, "pyramid", 1.0, "square, gendered"),
    (Family::XFace3d, "3-D X-Face", 1.0, "|x| + |y| < D"),
    (Family::XFace3dLocking, "locking 3-D X-Face", 1.0, "a lip takes the corners"),
    (Family::VFace, "V-Face", 1.0, "planar, ±D/2"),
    (Family::XFace, "X-Face", 1.0, "planar, ±D"),
];

/// Every row, in order.
pub(super) fn all(catalog: &Catalog, exec: &Exec) -> Result<Vec<Row>, DrawError> {
    let mut rows = Vec::new();
    for (family, name, width, words) in FAMILIES {
        rows.push(of_family(family, name, width, words, exec)?);
    }
    let shape =
        |system: &str| GEOMETRY.iter().find(|fact| fact.system == system).and_then(|f: &Fact| f.shape);
    if let Some((shape, _)) = shape("Polybot G3") {
        let words = ["π · (2/50)² D²", "4 pairs of pins, Ø 4 mm", "on a face of 50 mm"];
        rows.insert(
            5,
            Row {
                name: "PolyBot",
                words: lines(&words, shape.area(), shape.onaa()),
                problem: Some(problem("polybot")?),
                width: 1.0,
                region: Region::Closed(shape),
            },
        );
    }
    let dragon = catalog.find("DRAGON").and_then(|system| system.published.as_ref());
    if let Some(&PublishedZraa { area_d2, .. }) = dragon {
        let shape = AcceptanceShape::Disc((area_d2 / std::f64::consts::PI).sqrt());
        let words = ["circle of the published", "area: drawn from the", "number, not from geometry"];
        rows.insert(
            6,
            Row {
                name: "DRAGON",
                words: lines(&words, area_d2, shape.onaa()),
                problem: None,
                width: 1.0,
                region: Region::OfNumber(shape),
            },
        );
    }
    rows.push(of_family(Family::SFace, "S-Face", 1.0, "planar, ±D/3", exec)?);
    Ok(rows)
}

/// The words of a row: its name, its area and edge.
fn lines(words: &[&str], area: f64, edge: f64) -> Vec<String> {
    let mut lines = vec![format!("{} D²", trimmed(area, 6)), format!("ONAA {} D", trimmed(edge, 4))];
    lines.extend(words.iter().map(|&words| words.to_owned()));
    lines
}

/// A number without zeros at its end.
fn trimmed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn of_family(
    family: Family,
    name: &'static str,
    width: f64,
    words: &str,
    exec: &Exec,
) -> Result<Row, DrawError> {
    /// Finer than the default, so that the printed number is the circle's to three digits.
    const CHORD_ERROR: f64 = 0.0004;
    let connector = ConnectorSpec::Family(FamilySpec::new(family).with_chord_error(CHORD_ERROR));
    let alignment = Alignment::default_for(Some(family));
    let design = Design { name: name.to_owned(), connector, width: 1.0, unit: None, alignment };
    let problem = Problem::of(design)?;
    let zraa = run(problem.pair(), &ZraaSettings::default(), exec)?;
    let square = AcceptedSquare::of(&zraa, exec)?;
    let words = match (&zraa, family) {
        (Zraa::Interval { from, to, .. }, _) => {
            vec![format!("{} D long", trimmed(to - from, 4)), words.to_owned()]
        }
        // The printed values are those of the circle.
        (Zraa::Region { .. }, Family::Cone) => {
            let shape = AcceptanceShape::Disc(0.5 * width);
            let area = if width > 1.0 { "π/2, as amour is published" } else { "π/4" };
            lines(&[area, words], shape.area(), shape.onaa())
        }
        (Zraa::Region { area, .. }, _) => lines(&[words], *area, square.edge),
    };
    Ok(Row { name, words, problem: Some(problem), width, region: Region::Computed(zraa, square) })
}

impl Row {
    /// Draws the row into its cells, its names before them.
    pub(super) fn draw(&self, svg: &mut Svg, cells: &[Rect; CELLS]) -> Result<(), DrawError> {
        let [halves, section, region] = cells;
        let (x, y) = (halves.x - NAMES, halves.y);
        svg.bold([x, y + 18.0], LABEL + 1.0, Anchor::Start, self.name);
        for (k, words) in self.words.iter().enumerate() {
            let (size, fill) = if k < 2 { (LABEL, INK) } else { (TICK, SOFT) };
            svg.text([x, y + 37.0 + 16.0 * k as f64], size, Anchor::Start, fill, words);
        }
        match &self.problem {
            Some(problem) => {
                let height = APART - problem.alignment().center_of_rotation;
                let placement = MovingHalfPose { error: PoseError::default(), height };
                solid_panel(svg, *halves, problem.design(), problem.connector(), &placement)?;
                let view = View::new(*section, SECTION);
                face(svg, &view, &problem.connector().fixed, self.width);
                view.square(svg, DVec2::ZERO, 1.0, &dotted());
            }
            None => {
                for cell in [halves, section] {
                    let middle = [cell.x + cell.w / 2.0, cell.y + cell.h / 2.0];
                    svg.text(middle, TICK, Anchor::Middle, SOFT, "not stated");
                }
            }
        }
        self.region(svg, *region);
        Ok(())
    }

    fn region(&self, svg: &mut Svg, rect: Rect) {
        svg.rect(rect, &format!(r#"fill="{}""#, hex(mix(NOTHING, [255; 3], 0.4))));
        let view = View::new(rect, REACH);
        let style = filled(ACCEPTED);
        match &self.region {
            Region::Computed(Zraa::Region { polygons, .. }, square) => {
                for polygon in polygons {
                    let corners: Vec<DVec2> = polygon.iter().map(|p| self.width * *p).collect();
                    view.path(svg, &corners, &style);
                }
                view.square(svg, self.width * square.center, self.width * square.edge, &dashed());
            }
            Region::Computed(Zraa::Interval { from, to, .. }, _) => {
                let half = STRIP / 2.0;
                let corners = [(*from, -half), (*to, -half), (*to, half), (*from, half)].map(DVec2::from);
                view.path(svg, &corners, &style);
            }
            Region::Closed(shape) => {
                view.path(svg, &corners(*shape), &style);
                view.square(svg, DVec2::ZERO, shape.onaa(), &dashed());
            }
            Region::OfNumber(shape) => {
                view.path(svg, &corners(*shape), &filled(mix(ACCEPTED, [255; 3], 0.5)));
                view.square(svg, DVec2::ZERO, shape.onaa(), &dashed());
            }
        }
        view.square(svg, DVec2::ZERO, 1.0, &dotted());
    }
}
