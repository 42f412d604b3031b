//! Permitted changes to a mesh before use, and a record of the changes made.
//!
//! Repairs change a mesh but not the solid that it bounds, except for the recorded deviation; holes are not
//! closed.

use super::{Design, FileSpec, HalfSpec, Meshed};
use catchment_base::terminal::shown;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Permitted changes to a mesh before use.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MeshPreparation {
    /// Whether a mesh may be repaired, if it clearly bounds a solid. A mesh without defects is not changed.
    #[serde(default = "yes")]
    pub repair: bool,
    /// Largest displacement of the surface by simplification to fewer triangles, in D; `None`: no
    /// simplification.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub simplify: Option<f64>,
    /// Largest distance between the curved faces of a STEP file and their facets, in D; `None`: 0.0002 of the
    /// part's largest side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deflection: Option<f64>,
    /// Number of the separate body of the file to use, from 1, largest bounding box first; `None`: all
    /// bodies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<u16>,
}

const fn yes() -> bool {
    true
}

impl MeshPreparation {
    /// Repair if needed, without simplification.
    pub const DEFAULT: Self = Self { repair: true, simplify: None, deflection: None, body: None };
    /// Taken as it is, or refused.
    pub const AS_IT_IS: Self = Self { repair: false, simplify: None, deflection: None, body: None };

    /// Whether it is the default.
    pub fn is_default(&self) -> bool {
        *self == Self::DEFAULT
    }
}

impl Default for MeshPreparation {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Changes made to a mesh before use.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Repairs {
    /// Triangles without area that were removed; if such a triangle lay along an edge, the edge was split for
    /// its neighbour.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub without_area: usize,
    /// Triangles removed because another triangle has the same corners.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub doubled: usize,
    /// Triangles removed as lids: sheets without thickness across a hole, without which the body is closed.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub lids: usize,
    /// Triangles whose winding was reversed.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub turned: usize,
    /// Edges at which touching solids were separated.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub parted: usize,
    /// Self-intersections of the surface that were united; counted up to a limit.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub united: usize,
    /// Number of triangles before and after simplification, if the mesh was simplified.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub simplified: Option<[usize; 2]>,
    /// Largest distance between the surfaces before and after, in D, measured at corners, edge midpoints and
    /// triangle centres of both.
    pub deviation: f64,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
const fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl Repairs {
    /// Whether nothing was done.
    pub const fn is_none(&self) -> bool {
        self.without_area + self.doubled + self.lids + self.turned + self.parted + self.united == 0
            && self.simplified.is_none()
    }

    /// Adds the changes to another body.
    pub fn add(&mut self, other: &Self) {
        self.without_area += other.without_area;
        self.doubled += other.doubled;
        self.lids += other.lids;
        self.turned += other.turned;
        self.parted += other.parted;
        self.united += other.united;
        if let Some([before, after]) = other.simplified {
            let [all, left] = self.simplified.unwrap_or_default();
            self.simplified = Some([all + before, left + after]);
        }
        self.deviation = self.deviation.max(other.deviation);
    }

    /// As a line, with lengths in D written by `length`.
    pub fn in_words(&self, length: impl Fn(f64) -> String) -> String {
        let mut parts = Vec::new();
        let mut part = |count: usize, one: &str, many: &str| match count {
            0 => {}
            1 => parts.push(format!("1 {one}")),
            count => parts.push(format!("{count} {many}")),
        };
        part(self.without_area, "triangle without area removed", "triangles without area removed");
        part(self.doubled, "duplicate triangle removed", "duplicate triangles removed");
        part(
            self.lids,
            "triangle of a lid without thickness removed",
            "triangles of lids without thickness removed",
        );
        part(self.turned, "triangle flipped", "triangles flipped");
        part(self.parted, "edge separated where solids touch", "edges separated where solids touch");
        part(self.united, "crossing of its facets resolved", "crossings of its facets resolved");
        if let Some([before, after]) = self.simplified {
            parts.push(format!("{before} triangles simplified to {after}"));
        }
        let moved = if self.deviation > 0.0 {
            format!("the surface moved by no more than {}", length(self.deviation))
        } else {
            "its shape is unchanged".to_owned()
        };
        format!("{}; {moved}", parts.join(", "))
    }
}

impl HalfSpec {
    /// Whether repairs moved the surface of one of its meshes.
    pub fn is_altered(&self) -> bool {
        let moved =
            |file: &FileSpec| file.content.as_ref().is_some_and(|content| content.repairs.deviation > 0.0);
        match self {
            Self::Mesh(file) => moved(file),
            Self::Parts(parts) => parts.iter().filter_map(|part| part.shape.file()).any(moved),
            Self::Pieces(_) | Self::Memory { .. } => false,
        }
    }

    /// The changes to its meshes, as a line in the unit of the design; `None` without changes.
    pub fn repairs_in_words(&self, design: &Design) -> Option<String> {
        match self {
            Self::Mesh(file) => repairs_of(file, design),
            Self::Parts(parts) => {
                let mut lines: Vec<String> = Vec::new();
                for file in parts.iter().filter_map(|part| part.shape.file()) {
                    let Some(changes) = repairs_of(file, design) else { continue };
                    let line = format!("{}: {changes}", shown(&file.path));
                    // A file may serve several parts.
                    if !lines.contains(&line) {
                        lines.push(line);
                    }
                }
                (!lines.is_empty()).then(|| lines.join("; "))
            }
            Self::Pieces(_) | Self::Memory { .. } => None,
        }
    }
}

impl HalfSpec {
    /// The meshing of its STEP files, as a line in the unit of the design; `None` without STEP files.
    pub fn meshing_in_words(&self, design: &Design) -> Option<String> {
        match self {
            Self::Mesh(file) => meshing(file, design),
            Self::Parts(parts) => {
                let text: Vec<String> = parts
                    .iter()
                    .filter_map(|part| {
                        let file = part.shape.file()?;
                        Some(format!("{}: {}", shown(&file.path), meshing(file, design)?))
                    })
                    .collect();
                (!text.is_empty()).then(|| text.join("; "))
            }
            Self::Pieces(_) | Self::Memory { .. } => None,
        }
    }
}

/// How a STEP file became triangles.
fn meshing(file: &FileSpec, design: &Design) -> Option<String> {
    let content = file.content.as_ref()?;
    let Meshed { deflection, reached, by, .. } = content.meshed.as_deref()?;
    let stated = if file.treatment.deflection.is_some() { "as written" } else { "0.0002 of its size" };
    let count = content.triangles;
    // If the mesher missed the requested deflection, the reached deflection counts.
    let most = deflection.max(*reached);
    let most = match design.unit {
        Some(unit) => format!("{} {}", rounded_up(most * design.width), unit.symbol()),
        None => format!("{} D", rounded_up(most)),
    };
    Some(format!(
        "its curved faces as {count} triangles, off by at most {most} (deflection, {stated}), by {by}"
    ))
}

/// To three digits, not below the value but for rounding.
fn rounded_up(value: f64) -> f64 {
    const DIGITS: i32 = 3;
    // Share of a value by which rounding may exceed it.
    const ROUNDING: f64 = 1e-9;
    if !(value.is_finite() && value > 0.0) {
        return value;
    }
    let places = DIGITS - 1 - value.log10().floor() as i32;
    let shift = 10f64.powi(places.abs());
    let up = |scaled: f64| (scaled * (1.0 - ROUNDING)).ceil();
    // Multiply or divide by an integer power of ten, which keeps the last digit exact.
    if places >= 0 { up(value * shift) / shift } else { up(value / shift) * shift }
}

/// The changes to a mesh file.
fn repairs_of(file: &FileSpec, design: &Design) -> Option<String> {
    let repairs = &file.content.as_ref()?.repairs;
    (!repairs.is_none()).then(|| repairs.in_words(|d| moved(d, design)))
}

/// Displacement of a surface, in millimetres if the design has a unit, rounded up to two digits.
fn moved(d: f64, design: &Design) -> String {
    let up = |value: f64| {
        let digit = 10f64.powf(value.log10().floor() - 1.0);
        format!("{:.1e}", (value / digit).ceil() * digit)
    };
    match design.unit {
        Some(unit) => format!("{} mm", up(d * design.width * unit.metres() * 1e3)),
        None => format!("{} D", up(d)),
    }
}

impl fmt::Display for Repairs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.in_words(|d| format!("{d:.1e} D")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repairs_are_summarized_in_one_line() {
        let mut repairs = Repairs { without_area: 12, united: 1, deviation: 2e-6, ..Repairs::default() };
        assert_eq!(
            repairs.to_string(),
            "12 triangles without area removed, 1 crossing of its facets resolved; the surface moved by no more than 2.0e-6 D"
        );
        repairs = Repairs { simplified: Some([9, 4]), ..Repairs::default() };
        assert_eq!(repairs.to_string(), "9 triangles simplified to 4; its shape is unchanged");
        assert!(!repairs.is_none() && Repairs::default().is_none());
    }

    #[test]
    fn lengths_are_rounded_up_to_three_digits() {
        for (value, message) in [
            (0.01, "0.01"),
            (0.009_889_1, "0.00989"),
            (0.0048, "0.0048"),
            (12.341, "12.4"),
            (12341.0, "12400"),
        ] {
            assert_eq!(rounded_up(value).to_string(), message);
        }
    }

    #[test]
    fn only_applied_repairs_are_written() {
        let json = serde_json::to_string(&Repairs { turned: 2, ..Repairs::default() }).unwrap();
        assert_eq!(json, r#"{"turned":2,"deviation":0.0}"#);
        assert_eq!(serde_json::from_str::<MeshPreparation>("{}").unwrap(), MeshPreparation::DEFAULT);
    }
}
