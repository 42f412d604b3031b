//! The report of a composition: JSON, text, outlines for other programs.

use super::measure::LargestSquare;
use super::read::ParsedRegion;
use super::{ComposeSettings, Composition, HeadingSlice, RegionFrames};
use catchment::diagnostic::Diagnostic;
use catchment::document::{Cell, Column, Document, Table, number, significant};
use catchment::report::document::Printed;
use catchment::report::{ReportBody, ReportEnvelope};
use glam::DVec2;
use serde::Serialize;
use std::borrow::Cow;
use std::fmt::Write;

/// A composition with its head.
pub type ComposeReport = ReportEnvelope<ComposeBody>;

/// Approach region of two halves. Lengths in `unit`, angles in radians; areas as [inner, outer], between
/// which the true area lies.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ComposeBody {
    /// mm or D.
    pub unit: &'static str,
    /// The settings.
    pub settings: ComposeSettings,
    /// The two halves.
    pub halves: [HalfReport; 2],
    /// The two bodies that must not overlap.
    pub keep_out: Option<[HalfReport; 2]>,
    /// The heading that is described.
    pub heading_rad: f64,
    /// The region at that heading.
    pub acceptance: RegionReport,
    /// The largest axis-parallel square in it.
    pub largest_square: Option<LargestSquare>,
    /// Tolerance towards −x, +x, −y, +y from the centre of that square.
    pub tolerance: Option<[f64; 4]>,
    /// Side of the largest square about d = 0; null if the halves do not meet there.
    pub square_about_zero: Option<f64>,
    /// Area of every slice.
    pub slices: Vec<HeadingReport>,
    /// ∫ area dψ by the trapezoidal rule.
    pub volume: Option<[f64; 2]>,
    /// Overlap of the two regions as a function of the second robot's position.
    pub overlap: OverlapReport,
    /// Outlines of the inner region: outer outlines counter-clockwise, holes clockwise.
    pub outlines: Vec<Vec<[f64; 2]>>,
}

/// An input region.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct HalfReport {
    /// Name of the region.
    pub name: String,
    /// Measures of the region.
    #[serde(flatten)]
    pub region: RegionReport,
    /// Notes about the region.
    pub notes: Vec<String>,
}

/// Measures of a region.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RegionReport {
    /// Area of the inner and of the outer region.
    pub area: [f64; 2],
    /// Lower and upper corner of the inner region's bounding box: the true region reaches at least as far.
    pub bounds: Option<[[f64; 2]; 2]>,
    /// Lower and upper corner of the outer region's bounding box: the true region lies inside.
    pub bounds_outer: Option<[[f64; 2]; 2]>,
    /// Number of connected polygons of the inner region.
    pub parts: usize,
    /// Number of holes of the inner region.
    pub holes: usize,
}

/// The region at one heading.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct HeadingReport {
    /// Heading.
    pub heading_rad: f64,
    /// Area of the inner and of the outer region.
    pub area: [f64; 2],
    /// Outlines of its inner region.
    #[serde(skip)]
    outlines: Vec<Vec<[f64; 2]>>,
}

/// The overlap: its largest value, and its values on a grid. The bodies that must not overlap do not reduce
/// it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OverlapReport {
    /// Largest value that was found, for the inner regions.
    pub largest: f64,
    /// Upper bound on the overlap at any position.
    pub at_most: f64,
    /// Position of the largest value.
    pub at: [f64; 2],
    /// Lower left corner of the grid.
    pub low: [f64; 2],
    /// Side of a cell.
    pub cell: f64,
    /// Values at the centres of the cells, rows from bottom to top.
    pub rows: Vec<Vec<f64>>,
}

impl ReportBody for ComposeBody {
    const KIND: &'static str = "compose";
}

fn region(bracket: &super::sweep::Bracket) -> RegionReport {
    let ends = |region: &super::Region| region.bounds().map(|ends| ends.map(|p| p.to_array()));
    RegionReport {
        area: bracket.area(),
        bounds: ends(&bracket.inner),
        bounds_outer: ends(&bracket.outer),
        parts: bracket.inner.parts(),
        holes: bracket.inner.holes(),
    }
}

fn half(read: &ParsedRegion) -> HalfReport {
    HalfReport { name: read.name.clone(), region: region(&read.region), notes: read.notes.clone() }
}

impl ComposeBody {
    fn new(result: &Composition) -> Self {
        let map = &result.map;
        let slice = &result.slices[result.shown];
        Self {
            unit: result.halves[0].measure.symbol(),
            settings: result.settings.clone(),
            halves: [half(&result.halves[0]), half(&result.halves[1])],
            keep_out: result.bodies.as_ref().map(|[a, b]| [half(a), half(b)]),
            heading_rad: slice.heading,
            acceptance: region(&slice.region),
            largest_square: result.square,
            tolerance: result.reach.map(|reach| [reach.x[0], reach.x[1], reach.y[0], reach.y[1]]),
            square_about_zero: result.square_about_zero,
            slices: result
                .slices
                .iter()
                .map(|slice| HeadingReport {
                    heading_rad: slice.heading,
                    area: slice.region.area(),
                    outlines: outlines(slice),
                })
                .collect(),
            volume: result.volume,
            overlap: OverlapReport {
                largest: result.peak.map_or(0.0, |peak| peak.value),
                at_most: result.peak.map_or(0.0, |peak| peak.at_most),
                at: result.peak.map_or([0.0; 2], |peak| peak.at.to_array()),
                low: map.low.to_array(),
                cell: map.cell,
                rows: map.values.chunks(map.cells[0].max(1)).map(<[f64]>::to_vec).collect(),
            },
            outlines: outlines(slice),
        }
    }
}

fn outlines(slice: &HeadingSlice) -> Vec<Vec<[f64; 2]>> {
    let inner = slice.region.inner.outlines();
    inner.into_iter().map(|outline| outline.into_iter().map(|p| p.to_array()).collect()).collect()
}

/// A single number if both ends agree to four digits, else both.
pub(super) fn bracket([inner, outer]: [f64; 2]) -> String {
    let [a, b] = [inner, outer].map(|v| format!("{v:.1}"));
    let [a, b] = if outer < 1000.0 { [inner, outer].map(significant) } else { [a, b] };
    if a == b { a } else { format!("{a} … {b}") }
}

/// The report of a composition.
pub fn report(result: &Composition) -> ComposeReport {
    let mut warnings = Vec::new();
    if result.slices[result.shown].region.inner.parts() == 0 {
        let message = match result.bodies {
            Some(_) => "the bodies keep the halves apart everywhere",
            None => "the region has no area: the halves meet on a line at most",
        };
        warnings.push(Diagnostic::warning(ComposeBody::KIND, message));
    }
    ReportEnvelope::of(ComposeBody::new(result), warnings, None)
}

impl Printed for ComposeBody {
    fn title(&self) -> Cow<'_, str> {
        format!("{} and {}: approach region", self.halves[0].name, self.halves[1].name).into()
    }

    fn document(&self) -> Document {
        let mut document = Document::default();
        self.describe_regions(&mut document);
        self.describe_acceptance(&mut document);
        if let Some(volume) = self.volume {
            let [from, to] =
                [self.slices.first(), self.slices.last()].map(|s| degrees(s.map_or(0.0, |s| s.heading_rad)));
            document
                .titled(Some(format!("over {} headings, {from} to {to}", self.slices.len())))
                .row("volume", format!("{} {}²·rad", bracket(volume), self.unit));
        }
        if self.halves.iter().any(|half| !half.notes.is_empty()) {
            document.section(None);
        }
        for half in &self.halves {
            for note in &half.notes {
                document.row("note", format!("{}: {note}", half.name));
            }
        }
        document.table(self.outline_table());
        document
    }
}

impl ComposeBody {
    fn describe_regions(&self, document: &mut Document) {
        let frames = match self.settings.frames {
            RegionFrames::Own => "own: both face +y, the second is mounted by a half turn",
            RegionFrames::World => "world: the second is drawn as it stands before the first",
        };
        document.row("frames", frames);
        let bodies = self.keep_out.iter().flatten();
        let names = ["A", "B", "body of A", "body of B"];
        for (name, half) in names.into_iter().zip(self.halves.iter().chain(bodies)) {
            document.row(name, format!("{}  ({})", self.shape(&half.region), half.name));
        }
    }

    fn describe_acceptance(&self, document: &mut Document) {
        let unit = self.unit;
        document
            .titled(Some(format!("at heading {}", degrees(self.heading_rad))))
            .row("acceptance", self.shape(&self.acceptance));
        let bounds = |[[x0, y0], [x1, y1]]: [[f64; 2]; 2]| {
            let [x0, y0, x1, y1] = [x0, y0, x1, y1].map(significant);
            format!("x {x0} … {x1}, y {y0} … {y1} {unit}")
        };
        if let Some(inner) = self.acceptance.bounds.map(bounds) {
            let outer = self.acceptance.bounds_outer.map(bounds).filter(|outer| *outer != inner);
            document.row("bounds", inner);
            if let Some(outer) = outer {
                document.row("no farther than", outer);
            }
        }
        match (self.largest_square, self.tolerance) {
            (Some(square), Some(reach)) => {
                let [x, y] = square.center.to_array().map(significant);
                let side = significant(square.side);
                let [a, b, c, d] = reach.map(significant);
                document
                    .row("largest square", format!("{side} {unit} about x {x}, y {y}"))
                    .row("from there", format!("x -{a} … +{b}, y -{c} … +{d} {unit}"));
            }
            _ => {
                document.row("largest square", "none");
            }
        }
        if let Some(side) = self.square_about_zero {
            document.row("about d = 0", format!("a square of {} {unit}", significant(side)));
        }
        let [x, y] = self.overlap.at.map(significant);
        let largest = bracket([self.overlap.largest, self.overlap.at_most]);
        document.row("overlap", format!("largest {largest} {unit}², at x {x}, y {y}"));
    }

    fn shape(&self, region: &RegionReport) -> String {
        let plural = |n: usize, name: &str| format!("{n} {name}{}", if n == 1 { "" } else { "s" });
        let (parts, holes) = (plural(region.parts, "part"), plural(region.holes, "hole"));
        format!("{} {}²  in {parts} with {holes}", bracket(region.area), self.unit)
    }

    /// Outlines of the inner region, which can be read again: `x,y,ring`, and the heading if there are
    /// several.
    fn outline_table(&self) -> Table {
        let unit = self.unit;
        let mut columns = vec![format!("x [{unit}]"), format!("y [{unit}]"), "ring".to_owned()];
        let several = self.slices.len() > 1;
        if several {
            columns.push("heading_deg".to_owned());
        }
        let mut table = Table::new(columns.into_iter().map(Column::data));
        let rings = self.slices.iter().flat_map(|slice| slice.outlines.iter().map(move |ring| (slice, ring)));
        for (k, (slice, ring)) in rings.enumerate() {
            let heading = several.then(|| slice.heading_rad.to_degrees().into());
            for [x, y] in ring {
                table
                    .push([Cell::from(*x), Cell::from(*y), Cell::from(k)].into_iter().chain(heading.clone()));
            }
        }
        table
    }
}

fn degrees(angle: f64) -> String {
    format!("{}°", significant(angle.to_degrees()))
}

/// Outlines of the inner region at the heading shown as a drawing of that size, to be read again.
pub fn outline_svg(result: &Composition) -> String {
    let measure = result.halves[0].measure;
    let [low, high] = result.slices[result.shown].region.inner.bounds().unwrap_or([DVec2::ZERO, DVec2::ONE]);
    let (size, unit) = (high - low, measure.symbol());
    let physical = if measure == super::Measure::Millimetres { unit } else { "" };
    let mut data = String::new();
    for outline in outlines(&result.slices[result.shown]) {
        for (k, [x, y]) in outline.into_iter().enumerate() {
            // Writing to a String cannot fail. Up is +y, and down the picture is not.
            let _ = write!(data, "{}{} {}", if k == 0 { "M" } else { "L" }, number(x), number(-y));
        }
        data.push('Z');
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}{physical}\" height=\"{h}{physical}\" viewBox=\"{x} {y} {w} {h}\" \
         data-unit=\"{unit}\">\n<path fill=\"#4b95c9\" fill-rule=\"evenodd\" d=\"{data}\"/>\n</svg>\n",
        w = number(size.x),
        h = number(size.y),
        x = number(low.x),
        y = number(-high.y),
    )
}
