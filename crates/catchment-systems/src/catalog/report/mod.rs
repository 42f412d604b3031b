//! Reports of the catalogue, of a single system, and of a design among them.

use super::attribute::{CatalogAttribute, Oddity};
use super::classify::{Classified, Ratio};
use super::data::{Catalog, RowSource, System};
use super::facts::{Fact, Number, numbers};
use super::rule::{Extents, HIGH};
use catchment::design::Design;
use catchment::document::{Cell, Column, Document, Subject, Table, significant};
use catchment::report::document::Printed;
use catchment::report::text::line;
use catchment::report::{ReportBody, ReportEnvelope, ReportOf};
use catchment::terminal::printable;
use serde::Serialize;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The catalogue, with its head.
pub type CatalogReport = ReportEnvelope<CatalogBody>;
/// A design among the published systems, with its head.
pub type ClassifyReport = ReportOf<ClassifyBody>;
/// A system, with its head.
pub type SystemReport = ReportEnvelope<SystemBody>;

/// Text for an unknown value.
const NOTHING: &str = "–";

/// Meaning of the star.
const ESTIMATED: &str = "* marked as an estimate in the source";

/// The most informative attributes.
const OVERVIEW: [CatalogAttribute; 4] = [
    CatalogAttribute::Introduced,
    CatalogAttribute::SelfAligningDegree,
    CatalogAttribute::Gendering,
    CatalogAttribute::ConnectionType,
];

/// Rows of the catalogue.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CatalogBody {
    /// The rows.
    pub systems: Vec<SystemBody>,
}

/// A row of the catalogue.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SystemBody {
    /// Its name.
    pub system: String,
    /// Source of the row.
    pub source: RowSource,
    /// Values of table 1.1 by attribute; null if the table does not list the system.
    pub attributes: Option<BTreeMap<&'static str, ValueReport>>,
    /// Stated area in D², or the computed area of an appended design; null without an area.
    pub zraa_d2: Option<f64>,
    /// Whether the stated area is marked as estimated.
    pub estimated: bool,
    /// Every known number of the area, with its provenance: D stated, R computed here, I our reading.
    pub numbers: Vec<Number>,
    /// Contradictions among the numbers, or open questions.
    pub doubt: Option<&'static str>,
}

/// A value as printed, and in the terms that the text defines.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ValueReport {
    /// As printed.
    pub printed: String,
    /// In the terms of the text; our reading if the two differ.
    pub normal: String,
    /// Reason for the difference.
    pub reason: Option<&'static str>,
}

/// A design compared with the published systems.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ClassifyBody {
    /// Degree of self-alignment by the rule.
    pub degree: &'static str,
    /// Extent of the accepted offsets on the axes through zero, in D.
    pub extents_d: Extents,
    /// The larger total extent, in D.
    pub longest_d: f64,
    /// Extent above which the degree is High, in D.
    pub high_above_d: f64,
    /// Gendering: whether the halves are the same solid.
    pub gendering: &'static str,
    /// Zero-rotation area of acceptance, in D²; null if one translation is locked.
    pub zraa_d2: Option<f64>,
    /// Edge of the largest axis-parallel square inside, in D; the length of the corrected interval if one
    /// translation is locked.
    pub onaa_d: f64,
    /// Comparison of the design with published areas.
    pub ratios: Vec<Ratio>,
}

impl ReportBody for CatalogBody {
    const KIND: &'static str = "catalog";
}

impl ReportBody for SystemBody {
    const KIND: &'static str = "catalog-system";
}

impl SystemBody {
    /// Of a row.
    pub fn of(system: &System) -> Self {
        let value = |attribute: CatalogAttribute, printed: &str| ValueReport {
            printed: printed.to_owned(),
            normal: attribute.normal(printed).to_owned(),
            reason: attribute.oddity(printed).map(|oddity| oddity.reason),
        };
        let attributes = system.attributes.as_ref().map(|values| {
            CatalogAttribute::ALL
                .into_iter()
                .zip(values)
                .map(|(a, printed)| (a.key(), value(a, printed)))
                .collect()
        });
        Self {
            system: system.name.clone(),
            source: system.source.clone(),
            attributes,
            zraa_d2: system.area(),
            estimated: system.published.as_ref().is_some_and(|zraa| zraa.estimated),
            numbers: numbers(system),
            doubt: Fact::of(system).and_then(|fact| fact.doubt),
        }
    }

    fn value(&self, attribute: CatalogAttribute) -> Option<&ValueReport> {
        self.attributes.as_ref()?.get(attribute.key())
    }

    /// The oddity of a printed value that has another normal form. Open values of an appended design are not
    /// oddities of the source.
    fn oddity(&self, attribute: CatalogAttribute) -> Option<&'static Oddity> {
        attribute.oddity(self.printed(attribute)).filter(|_| self.source != RowSource::Appended)
    }

    fn printed(&self, attribute: CatalogAttribute) -> &str {
        self.value(attribute).map_or(NOTHING, |value| value.printed.as_str())
    }

    /// The area for people, with a star for an estimate.
    fn zraa(&self) -> String {
        let star = if self.estimated { "*" } else { "" };
        self.zraa_d2.map_or_else(|| NOTHING.to_owned(), |area| format!("{}{star}", shown(area)))
    }
}

/// Significant digits without zeros at the end.
fn shown(value: f64) -> String {
    let text = significant(value);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

impl Printed for CatalogBody {
    fn title(&self) -> Cow<'_, str> {
        "Published docking systems".into()
    }

    fn document(&self) -> Document {
        let mut document = Document::default();
        document.table(self.overview()).paragraph(format!("{} systems", self.systems.len()));
        if self.systems.iter().any(|system| system.estimated) {
            document.paragraph(ESTIMATED);
        }
        let mut odd: Vec<&Oddity> = Vec::new();
        let all = self.systems.iter().flat_map(|system| OVERVIEW.map(|attribute| system.oddity(attribute)));
        for oddity in all.flatten() {
            if !odd.contains(&oddity) {
                odd.push(oddity);
            }
        }
        for Oddity { attribute, printed, normal, reason } in odd {
            let attribute = attribute.title();
            document.paragraph(format!("! {printed} ({attribute}) is read as {normal} [I]: {reason}"));
        }
        if self.systems.iter().any(|system| system.source == RowSource::Appended) {
            document.paragraph("The area, degree and gendering of an appended design are computed.");
        }
        document.table(self.data());
        document
    }
}

impl CatalogBody {
    /// The report of a catalogue.
    pub fn report(catalog: &Catalog) -> CatalogReport {
        let systems = catalog.systems.iter().map(SystemBody::of).collect();
        ReportEnvelope::of(Self { systems }, Vec::new(), None)
    }

    /// The most informative attributes, for people.
    fn overview(&self) -> Table {
        /// The longest name that is shown in full.
        const NAME: usize = 17;
        let column = |title: &str| Column::new(title).left();
        let titles = ["system", "introduced", "degree", "gendering", "type"].map(column);
        let mut table = Table::new(titles.into_iter().chain([Column::new("ZRAA [D²]")]));
        for system in &self.systems {
            let attributes = OVERVIEW.map(|attribute| {
                let mark = if system.oddity(attribute).is_some() { "!" } else { "" };
                Cell::from(format!("{}{mark}", system.printed(attribute)))
            });
            let name = Cell::from(cut(&system.system, NAME));
            table.push([name].into_iter().chain(attributes).chain([system.zraa().into()]));
        }
        table
    }

    /// Every attribute as printed and in its normal form, and the area, for programs.
    fn data(&self) -> Table {
        let attributes = CatalogAttribute::ALL
            .into_iter()
            .flat_map(|a| [a.key().to_owned(), format!("{}_normal", a.key())]);
        let first = ["system", "source"].map(str::to_owned);
        let last = ["zraa_d2", "estimated", "provenance", "stated_onaa_d"].map(str::to_owned);
        let mut table = Table::new(first.into_iter().chain(attributes).chain(last).map(Column::data));
        for system in &self.systems {
            let values = CatalogAttribute::ALL.into_iter().flat_map(|attribute| -> [Cell; 2] {
                let value = system.value(attribute);
                [value.map(|v| v.printed.clone()).into(), value.map(|v| v.normal.clone()).into()]
            });
            let stated = system.numbers.iter().find(|n| n.name == "ONAA" && n.basis.starts_with("section"));
            let first = [printable(&system.system).into(), source(&system.source).into()];
            let last = [
                system.zraa_d2.into(),
                usize::from(system.estimated).into(),
                system.numbers.first().map_or("", |n| n.provenance.mark()).into(),
                stated.map(|n| n.value).into(),
            ];
            table.push(first.into_iter().chain(values).chain(last));
        }
        table
    }

    /// Every attribute as a table in Markdown; a normal form that differs stands behind an arrow.
    pub fn markdown(&self) -> String {
        let text = &mut String::new();
        let titles: Vec<&str> = CatalogAttribute::ALL.map(CatalogAttribute::title).to_vec();
        line(text, &format!("| system | {} | ZRAA [D²] |", titles.join(" | ")));
        line(text, &format!("|{}", " --- |".repeat(titles.len() + 2)));
        for system in &self.systems {
            let cell = |attribute| match system.value(attribute) {
                None => NOTHING.to_owned(),
                Some(value) if value.normal == value.printed || system.source == RowSource::Appended => {
                    value.printed.clone()
                }
                Some(value) => format!("{} → {}", value.printed, value.normal),
            };
            let mut cells = vec![system.system.clone()];
            cells.extend(CatalogAttribute::ALL.map(cell));
            cells.push(system.zraa().replace('*', "\\*"));
            let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
            line(text, &format!("| {} |", cells.join(" | ")));
        }
        std::mem::take(text)
    }
}

/// The source of a row, in a word.
const fn source(source: &RowSource) -> &'static str {
    match source {
        RowSource::Connectors(None) => "table 1.1",
        RowSource::Connectors(Some(_)) => "tables 1.1 and 2.1",
        RowSource::ZraaAlone => "table 2.1",
        RowSource::Section412 => "section 4.1.2",
        RowSource::Appended => "design",
    }
}

/// The name, cut to at most `most` characters.
fn cut(name: &str, most: usize) -> String {
    if name.chars().count() <= most {
        return name.to_owned();
    }
    name.chars().take(most - 1).chain(std::iter::once('…')).collect()
}

impl SystemBody {
    /// The report of a row.
    pub fn report(system: &System) -> SystemReport {
        ReportEnvelope::of(Self::of(system), Vec::new(), None)
    }

    fn attribute_table(&self) -> Table {
        let mut table = Table::new(["attribute", "value"].map(|title| Column::new(title).left()));
        for attribute in CatalogAttribute::ALL {
            let Some(ValueReport { printed, normal, reason }) = self.value(attribute) else { continue };
            let value = match reason {
                None => printed.clone(),
                Some(reason) => format!("{printed}, read as {normal} [I]: {reason}"),
            };
            table.push([attribute.title().into(), value.into()]);
        }
        table
    }

    fn number_table(&self) -> Table {
        let mut table = Table::new(["number", "value", "source"].map(|title| Column::new(title).left()));
        for Number { name, value, unit, provenance, basis } in &self.numbers {
            let (value, source) =
                (format!("{} {unit}", shown(*value)), format!("{} {basis}", provenance.mark()));
            table.push([(*name).into(), value.into(), source.into()]);
        }
        table
    }
}

impl Printed for SystemBody {
    fn title(&self) -> Cow<'_, str> {
        let other = match &self.source {
            RowSource::Connectors(Some(name)) if *name != self.system => format!(" (as {name})"),
            _ => String::new(),
        };
        format!("{}: {}{other}", self.system, source(&self.source)).into()
    }

    fn document(&self) -> Document {
        let mut document = Document::default();
        if self.attributes.is_some() {
            document.table(self.attribute_table());
        } else {
            let known = match self.source {
                RowSource::Section412 => "section 4.1 calls it ungendered and states nothing else",
                _ => "its attributes are not stated",
            };
            document.paragraph(format!("table 1.1 does not have it: {known}"));
        }
        document.section(None);
        if self.numbers.is_empty() {
            document.paragraph("table 2.1 does not have it: its area is not stated");
        } else {
            document
                .table(self.number_table())
                .paragraph("[D] stated by the dissertation  [R] computed here from that  [I] our reading");
        }
        if let Some(doubt) = self.doubt {
            document.section(None).row("note", doubt);
        }
        document
    }
}

impl ClassifyBody {
    /// The report of a design that was classified.
    pub fn report(design: &Design, found: &Classified, catalog: &Catalog) -> ClassifyReport {
        let body = Self {
            degree: found.degree.name(),
            extents_d: found.extents,
            longest_d: found.extents.longest(),
            high_above_d: HIGH,
            gendering: found.gendering(),
            zraa_d2: found.area(),
            onaa_d: found.square.edge,
            ratios: found.ratios(catalog),
        };
        ReportOf::new(design, body, Vec::new(), None)
    }

    fn ratio_table(&self) -> Table {
        let mut table = Table::new([
            Column::new("beside").left(),
            Column::new("stated area").left(),
            Column::new("× area"),
            Column::new("stated ONAA").left(),
            Column::new("× ONAA"),
        ]);
        for ratio in &self.ratios {
            let star = if ratio.estimated { "*" } else { "" };
            let some = |value: Option<f64>| value.map_or_else(|| NOTHING.to_owned(), shown);
            table.push([
                ratio.system.as_str().into(),
                format!("{} D²{star}", shown(ratio.area_d2)).into(),
                some(ratio.area_ratio).into(),
                ratio.onaa_d.map_or_else(|| NOTHING.to_owned(), |onaa| format!("{} D", shown(onaa))).into(),
                some(ratio.onaa_ratio).into(),
            ]);
        }
        table
    }
}

impl Subject for ClassifyBody {
    const KIND: &'static str = "classify";

    fn document(&self, _: &Design) -> Document {
        let reach = |axis: &str, extent: Option<[f64; 2]>| {
            extent.map(|[from, to]| format!("{axis} {} … {} D", shown(from), shown(to)))
        };
        let reaches: Vec<String> =
            [reach("x", self.extents_d.x), reach("y", self.extents_d.y)].into_iter().flatten().collect();
        let halves = if self.gendering == "Ungendered" { "the fixed half" } else { "not the fixed half" };
        let mut document = Document::default();
        document
            .row("degree", self.degree)
            .more(format!("corrected through zero: {}", reaches.join(", ")))
            .more(format!("High is more than {HIGH:.2} D from side to side [I]"))
            .row("gendering", self.gendering)
            .more(format!("the moving half, half turned, is {halves}"));
        let onaa = shown(self.onaa_d);
        let Some(area) = self.zraa_d2 else {
            document
                .row("ONAA", format!("{onaa} D, length of the corrected interval"))
                .section(None)
                .paragraph("One translation is locked, so the region is an interval, not an area.")
                .paragraph("A length has no ratio to published areas.");
            return document;
        };
        document
            .row("ZRAA", format!("{} D²", shown(area)))
            .row("ONAA", format!("{onaa} D, edge of the largest axis-parallel square"))
            .section(None)
            .table(self.ratio_table())
            .paragraph(ESTIMATED);
        document
    }
}

#[cfg(test)]
mod tests;
