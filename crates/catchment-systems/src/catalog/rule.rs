//! The degree of self-alignment as a computable rule.
//!
//! ```text
//!            y
//!            │ ░░░
//!      ──────╎░0░░░╎───── x      extent along x: length of the region through zero without a gap
//!            ░░│
//!             ░
//!   High  more than 0.20 D along the better of x and y      Low  less, but something      None  nothing
//! ```
//!
//! The text states "approximately greater than 20 %" of the face's characteristic size "in one offset
//! direction", and leaves open whether this is the distance to one side or the total extent. The total extent
//! is our reading: then five of the six systems with both a published area and a degree of High or Low agree
//! with the printed degree (taken as squares of their areas), and CONRO, an estimate, is just over; with the
//! distance to one side Vacuubes would be Low, although High is printed. M-TRAN III and I-Cubes have areas
//! and the degree None: their correction needs an action, which the degree excludes. Source: section 1.1.

use catchment::method::zraa::Zraa;
use catchment::pose::Dof;
use catchment::tolerance::COINCIDENT;
use glam::DVec2;
use serde::Serialize;

/// The extent above which the degree is High, in D.
pub const HIGH: f64 = 0.20;

/// Degree of self-alignment by contact alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Degree {
    /// Contact corrects more than a fifth of the face.
    High,
    /// Contact corrects less.
    Low,
    /// Contact corrects nothing.
    None,
}

impl Degree {
    /// The degree of an extent from side to side, in D.
    pub fn of(extent: f64) -> Self {
        if extent > HIGH {
            Self::High
        } else if extent > COINCIDENT {
            Self::Low
        } else {
            Self::None
        }
    }

    /// As the table prints it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::High => "High",
            Self::Low => "Low",
            Self::None => "None",
        }
    }
}

/// Extent of a region on the axes through zero, in D: lower and upper end. `None` for a locked axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Extents {
    /// Along x.
    pub x: Option<[f64; 2]>,
    /// Along y.
    pub y: Option<[f64; 2]>,
}

impl Extents {
    /// Of a zero-rotation area of acceptance.
    pub fn of(zraa: &Zraa) -> Self {
        match zraa {
            Zraa::Interval { axis: Dof::Y, from, to } => Self { x: None, y: Some([*from, *to]) },
            Zraa::Interval { from, to, .. } => Self { x: Some([*from, *to]), y: None },
            Zraa::Region { polygons, .. } => {
                Self { x: Some(through_zero(polygons, DVec2::X)), y: Some(through_zero(polygons, DVec2::Y)) }
            }
        }
    }

    /// The longer of the two, from side to side.
    pub fn longest(&self) -> f64 {
        [self.x, self.y].into_iter().flatten().map(|[from, to]| to - from).fold(0.0, f64::max)
    }

    /// The degree by the rule.
    pub fn degree(&self) -> Degree {
        Degree::of(self.longest())
    }
}

/// The part without a gap around zero of a region on an axis.
fn through_zero(polygons: &[Vec<DVec2>], axis: DVec2) -> [f64; 2] {
    let mut stretches: Vec<[f64; 2]> = polygons.iter().filter_map(|polygon| on_axis(polygon, axis)).collect();
    stretches.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for [from, to] in stretches {
        match joined.last_mut() {
            Some(last) if from <= last[1] + COINCIDENT => last[1] = last[1].max(to),
            _ => joined.push([from, to]),
        }
    }
    joined.into_iter().find(|[from, to]| *from <= COINCIDENT && *to >= -COINCIDENT).unwrap_or([0.0; 2])
}

/// Intersection of a convex polygon with an axis.
fn on_axis(polygon: &[DVec2], axis: DVec2) -> Option<[f64; 2]> {
    let mut result: Option<[f64; 2]> = None;
    let mut meet = |t: f64| {
        let [from, to] = result.unwrap_or([t; 2]);
        result = Some([from.min(t), to.max(t)]);
    };
    for (k, &a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let (da, db) = (axis.perp_dot(a), axis.perp_dot(b));
        if da.abs() <= COINCIDENT {
            meet(axis.dot(a));
        }
        if (da > COINCIDENT && db < -COINCIDENT) || (da < -COINCIDENT && db > COINCIDENT) {
            meet(axis.dot(a.lerp(b, da / (da - db))));
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::super::{Catalog, CatalogAttribute};
    use super::*;

    fn region(parts: &[[f64; 4]]) -> Zraa {
        let tile = |[x, y, w, h]: [f64; 4]| {
            vec![DVec2::new(x, y), DVec2::new(x + w, y), DVec2::new(x + w, y + h), DVec2::new(x, y + h)]
        };
        let area = parts.iter().map(|part| part[2] * part[3]).sum();
        Zraa::Region { polygons: parts.iter().copied().map(tile).collect(), area, seam: 0.0 }
    }

    #[test]
    fn an_extent_ends_at_the_first_gap_and_passes_seams() {
        // Two tiles that share a border, a tile after a gap, and a tile that does not meet the axis.
        let parts =
            [[-0.1, -0.2, 0.1, 0.3], [0.0, -0.05, 0.05, 0.3], [0.3, -0.1, 0.2, 0.2], [-1.0, 0.5, 2.0, 0.1]];
        let extents = Extents::of(&region(&parts));
        let near = |result: Option<[f64; 2]>, expected: [f64; 2]| {
            result.unwrap().iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        assert!(near(extents.x, [-0.1, 0.05]) && near(extents.y, [-0.2, 0.25]), "{extents:?}");
        assert_eq!(extents.degree(), Degree::High);
        assert_eq!(Extents::of(&region(&[[0.1, 0.1, 1.0, 1.0]])).degree(), Degree::None);
        assert_eq!(Extents::of(&region(&[[-0.1, -0.05, 0.2, 0.1]])).degree(), Degree::Low);
        let interval = Zraa::Interval { axis: Dof::X, from: -1.0 / 3.0, to: 1.0 / 3.0 };
        assert_eq!((Extents::of(&interval).degree(), Extents::of(&interval).y), (Degree::High, None));
    }

    /// The rule on published areas, each as the square of its area, against the printed degrees.
    #[test]
    fn five_of_six_published_degrees_come_out() {
        let catalog = Catalog::published().unwrap();
        let printed = |share: f64| -> Vec<(String, bool)> {
            let judged = catalog.systems.iter().filter_map(|system| {
                let area = system.published.as_ref()?.area_d2;
                let printed =
                    system.printed(CatalogAttribute::SelfAligningDegree).filter(|d| *d != "None")?;
                Some((system.name.clone(), Degree::of(share * area.sqrt()).name() == printed))
            });
            judged.collect()
        };
        let full = printed(1.0);
        let wrong: Vec<&str> =
            full.iter().filter(|(_, holds)| !holds).map(|(name, _)| name.as_str()).collect();
        assert_eq!((full.len(), wrong), (6, vec!["CONRO"]));
        // With half the extent Vacuubes would not be High.
        let half = printed(0.5);
        assert!(half.iter().any(|(name, holds)| name == "Vacuubes" && !holds));
    }
}
