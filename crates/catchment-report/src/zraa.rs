//! Report of the offsets that are corrected without rotation.

use super::document::OfDesign;
use catchment_core::design::Design;
use catchment_core::document::rounded;
use catchment_core::document::{Document, Subject, Table};
use catchment_core::method::zraa::{AcceptedSquare, Catch, Nilsson, Zraa, circle_bounds, circle_square};
use catchment_core::pose::Dof;
use serde::Serialize;

/// The zero-rotation area of acceptance of a design.
pub type ZraaBody = OfDesign<AcceptedOffsets>;

/// Offsets that contact corrects without rotation, in D. The bounds of a circle are those of the round design
/// that a polygon approximates; null without round features.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum AcceptedOffsets {
    /// A single free translation.
    Interval {
        /// x or y.
        axis: Dof,
        /// Lower end.
        from_d: f64,
        /// Upper end.
        to_d: f64,
        /// Length of the interval.
        length_d: f64,
        /// Bounds of the length for the circle.
        circle_length_d: Option<[f64; 2]>,
        /// The ONAA in D: for a single translation the length itself.
        onaa_d: f64,
        /// Nilsson's bounds; null if the halves do not meet along a single profile.
        nilsson: Option<NilssonReport>,
    },
    /// Both translations.
    Region {
        /// Area, in D².
        area_d2: f64,
        /// Bounds of the area for the circle.
        circle_area_d2: Option<[f64; 2]>,
        /// The ONAA in D: edge of the largest axis-parallel square inside.
        onaa_d: f64,
        /// Centre of that square.
        onaa_center_d: [f64; 2],
        /// Edge of the largest square around zero.
        onaa_centered_d: f64,
        /// Bounds of the edge for the circle.
        circle_onaa_d: Option<[f64; 2]>,
        /// Convex polygons that tile it: x and y of their corners, counter-clockwise.
        polygons_d: Vec<Vec<[f64; 2]>>,
    },
}

/// Offsets that a profile corrects to both sides, compared with the bound for its kind.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NilssonReport {
    /// Whether both halves have the same profile.
    pub ungendered: bool,
    /// Width of the profile.
    pub width_d: f64,
    /// Largest offset that any profile of this kind and width corrects to both sides.
    pub bound_d: f64,
    /// Offset that this profile corrects to both sides.
    pub both_d: f64,
    /// Limit of offsets towards −x; null if nothing is corrected.
    pub from: Option<CatchReport>,
    /// Limit of offsets towards +x; null if nothing is corrected.
    pub to: Option<CatchReport>,
}

/// A limit: the offset at which the moving half's minimum stands over the fixed half's maximum; below it the
/// minimum slides into the seat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CatchReport {
    /// The offset at the limit.
    pub offset_d: f64,
    /// x of the minimum, mated.
    pub minimum_d: f64,
    /// x of the maximum.
    pub maximum_d: f64,
}

impl From<&Nilsson> for NilssonReport {
    fn from(result: &Nilsson) -> Self {
        let side = |side: &Catch| CatchReport {
            offset_d: side.reach(),
            minimum_d: side.minimum,
            maximum_d: side.maximum,
        };
        let [from, to] = &result.catches;
        Self {
            ungendered: result.ungendered,
            width_d: result.width,
            bound_d: result.bound(),
            both_d: result.both(),
            from: from.as_ref().map(side),
            to: to.as_ref().map(side),
        }
    }
}

impl NilssonReport {
    /// The bound in a few words.
    pub fn bound(&self) -> String {
        let share = if self.ungendered { 3 } else { 2 };
        if (self.width_d - 1.0).abs() < AcceptedSquare::TOLERANCE {
            format!("D/{share}")
        } else {
            format!("{} D/{share}", rounded(self.width_d))
        }
    }

    fn describe(&self, document: &mut Document) {
        let kind = if self.ungendered { "both halves alike" } else { "halves of two kinds" };
        document
            .row("nilsson", format!("{} to both sides is the most for one profile, {kind}", self.bound()))
            .more(format!("{:.9} D to both sides is what this profile corrects", self.both_d));
        for (side, catch) in [("−x", &self.from), ("+x", &self.to)] {
            let words = catch.map_or_else(
                || "nothing is corrected".to_owned(),
                |CatchReport { minimum_d, maximum_d, .. }| {
                    let [minimum, maximum] = [minimum_d, maximum_d].map(|x| rounded(x + 0.0));
                    format!("the minimum at x = {minimum} slides home short of the maximum at {maximum}")
                },
            );
            document.more(format!("to {side} {words}"));
        }
    }
}

impl AcceptedOffsets {
    /// Report for a design; `nilsson` belongs to its profile, if any.
    pub fn new(design: &Design, zraa: &Zraa, square: &AcceptedSquare, nilsson: Option<&Nilsson>) -> Self {
        let bounds = circle_bounds(design, zraa);
        match zraa {
            Zraa::Interval { axis, from, to } => Self::Interval {
                axis: *axis,
                from_d: *from,
                to_d: *to,
                length_d: to - from,
                circle_length_d: bounds,
                onaa_d: square.edge,
                nilsson: nilsson.map(NilssonReport::from),
            },
            Zraa::Region { polygons, area, .. } => Self::Region {
                area_d2: *area,
                circle_area_d2: bounds,
                onaa_d: square.edge,
                onaa_center_d: square.center.to_array(),
                onaa_centered_d: square.centered_edge,
                circle_onaa_d: circle_square(design, zraa, square),
                polygons_d: polygons.iter().map(|p| p.iter().map(|v| [v.x, v.y]).collect()).collect(),
            },
        }
    }

    /// Its rows, without its table for programs.
    pub(super) fn describe(&self, document: &mut Document, design: &Design) {
        let circle = |document: &mut Document, bounds: Option<[f64; 2]>, unit: &str| {
            if let Some([lower, upper]) = bounds {
                let polygon = "a polygon stands for it, see chord_error";
                document.row("circle", format!("{lower:.9} … {upper:.9} {unit}: {polygon}"));
            }
        };
        match self {
            Self::Interval { axis, from_d, to_d, length_d, circle_length_d, nilsson, .. } => {
                document.row("corrected", format!("offsets in {} without rotation", axis.name()));
                for (name, value) in [("from", from_d), ("to", to_d), ("length", length_d)] {
                    document.row(name, format!("{value:.9} D{}", in_unit(design, *value, 1)));
                }
                circle(document, *circle_length_d, "D");
                if let Some(nilsson) = nilsson {
                    nilsson.describe(document);
                }
            }
            Self::Region {
                area_d2,
                circle_area_d2,
                onaa_d,
                onaa_center_d: [x, y],
                onaa_centered_d,
                circle_onaa_d,
                polygons_d,
            } => {
                document.row("corrected", "offsets in x and y without rotation");
                document.row("area", format!("{area_d2:.9} D²{}", in_unit(design, *area_d2, 2)));
                circle(document, *circle_area_d2, "D²");
                // The edge is exact to 1e-8 D: more digits would be noise.
                document.row("onaa", format!("{onaa_d:.7} D{}", in_unit(design, *onaa_d, 1)));
                document.more(format!("edge of the largest square, {}", around(*x, *y)));
                if onaa_d - onaa_centered_d > AcceptedSquare::TOLERANCE {
                    document.more(format!("{onaa_centered_d:.7} D for the largest around zero"));
                }
                if let Some([lower, upper]) = circle_onaa_d {
                    document.row("circle", format!("{lower:.7} … {upper:.7} D"));
                }
                document.row("tiled by", format!("{} convex polygons", polygons_d.len()));
            }
        }
    }

    /// The corners, in D; an interval has its two ends.
    fn corners(&self) -> Table {
        match self {
            Self::Interval { axis, from_d, to_d, .. } => {
                let mut table = Table::data(axis.name());
                table.push([(*from_d).into()]);
                table.push([(*to_d).into()]);
                table
            }
            Self::Region { polygons_d, .. } => {
                let mut table = Table::data("polygon x y");
                for (k, polygon) in polygons_d.iter().enumerate() {
                    for [x, y] in polygon {
                        table.push([k.into(), (*x).into(), (*y).into()]);
                    }
                }
                table
            }
        }
    }
}

impl Subject for AcceptedOffsets {
    const KIND: &'static str = "zraa";

    fn document(&self, design: &Design) -> Document {
        let mut document = Document::default();
        self.describe(&mut document, design);
        document.table(self.corners());
        document
    }
}

/// Position of a square.
fn around(x: f64, y: f64) -> String {
    if x.abs().max(y.abs()) < AcceptedSquare::TOLERANCE {
        "around zero".to_owned()
    } else {
        format!("around x = {}, y = {} D", rounded(x), rounded(y))
    }
}

/// ` = 25 mm`, if the design has a unit.
fn in_unit(design: &Design, value: f64, power: i32) -> String {
    let square = if power == 2 { "²" } else { "" };
    design.unit.map_or_else(String::new, |unit| {
        format!(" = {:.6} {}{square}", value * design.width.powi(power), unit.symbol())
    })
}

#[cfg(test)]
mod tests {
    use super::super::schema::testing::design;
    use super::*;
    use crate::ZraaReport;
    use catchment_core::pose::DofSet;
    use glam::DVec2;

    #[test]
    fn an_area_and_an_interval_have_fields_of_their_own() {
        let mut design = design(DofSet::ALL);
        design.name = "\u{1b}[2Jx".to_owned();
        let corners = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
        let center = DVec2::new(0.25, 0.25);
        let square = AcceptedSquare { edge: 0.5, center, centered_edge: 0.0 };
        let of = |design: &Design, zraa: &Zraa, square: &AcceptedSquare| {
            let offsets = AcceptedOffsets::new(design, zraa, square, None);
            ZraaReport::new(design, offsets, Vec::new(), None)
        };
        let region = of(&design, &Zraa::Region { polygons: vec![corners], area: 0.5, seam: 0.0 }, &square);
        let json: serde_json::Value = serde_json::from_str(&region.to_json().unwrap()).unwrap();
        assert_eq!(
            (&json["kind"], &json["area_d2"], &json["polygons_d"][0][1][0]),
            (&"zraa".into(), &0.5.into(), &1.0.into())
        );
        assert!(json["circle_area_d2"].is_null() && json.get("axis").is_none());
        assert_eq!((&json["onaa_d"], &json["onaa_center_d"][1]), (&0.5.into(), &0.25.into()));
        let text = region.table();
        assert!(text.contains("onaa           0.5000000 D = 25.000000 mm\n"), "{text}");
        assert!(
            text.contains("around x = 0.25, y = 0.25 D\n                 0.0000000 D for the largest around"),
            "{text}"
        );
        assert!(
            region.table().starts_with("?[2Jx\n")
                && region.table().contains("0.500000000 D² = 1250.000000 mm²")
        );
        assert_eq!(region.records()[1..], [["0", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]]);
        let square = AcceptedSquare { edge: 0.75, center: DVec2::ZERO, centered_edge: 0.5 };
        let interval = of(&design, &Zraa::Interval { axis: Dof::X, from: -0.5, to: 0.25 }, &square);
        let json: serde_json::Value = serde_json::from_str(&interval.to_json().unwrap()).unwrap();
        assert_eq!((&json["axis"], &json["length_d"]), (&"x".into(), &0.75.into()));
        assert_eq!(json["onaa_d"], json["length_d"]);
        assert_eq!(interval.records(), [["x"], ["-0.5"], ["0.25"]]);
    }
}
