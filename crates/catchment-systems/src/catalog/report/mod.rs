//! The catalogue as versioned JSON, as text, as CSV and as Markdown.

use super::attribute::{Attribute, Oddity};
use super::classify::{Classified, Ratio};
use super::data::{Catalog, Source, System};
use super::facts::{Fact, Number, numbers};
use super::rule::{Extents, HIGH};
use catchment::design::Design;
use catchment::report::text::{line, number, row, significant, wrapped};
use catchment::report::{Body, Envelope};
use catchment::terminal::printable;
use serde::Serialize;
use std::collections::BTreeMap;

/// The catalogue, with its head.
pub type CatalogReport = Envelope<CatalogBody>;
/// A design among the published systems, with its head.
pub type ClassifyReport = Envelope<ClassifyBody>;
/// One system, with its head.
pub type SystemReport = Envelope<SystemBody>;

/// What stands where nothing is known.
const NOTHING: &str = "–";

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
    /// Where the row comes from.
    pub source: Source,
    /// Values of table 1.1 by attribute; null where it does not have the system.
    pub attributes: Option<BTreeMap<&'static str, ValueReport>>,
    /// Stated area in D², or the area computed of an appended design; null where there is none.
    pub zraa_d2: Option<f64>,
    /// Whether the stated area is marked as estimated.
    pub estimated: bool,
    /// Every number that is known of the area, with its provenance: D stated, R computed here, I our reading.
    pub numbers: Vec<Number>,
    /// What contradicts the numbers, or is open.
    pub doubt: Option<&'static str>,
}

/// A value as printed, and in the terms that the text defines.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ValueReport {
    /// As printed.
    pub printed: String,
    /// In the terms of the text; our reading where it differs.
    pub normal: String,
    /// Why it differs.
    pub reason: Option<&'static str>,
}

/// A design among the published systems.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ClassifyBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// The degree by the rule.
    pub degree: &'static str,
    /// How far the accepted offsets reach through zero, in D.
    pub extents_d: Extents,
    /// The longer of the two, from side to side, in D.
    pub longest_d: f64,
    /// Above this it is High, in D.
    pub high_above_d: f64,
    /// Whether the halves are the same solid.
    pub gendering: &'static str,
    /// Zero-rotation area of acceptance, in D²; null where one translation is locked.
    pub zraa_d2: Option<f64>,
    /// Edge of the largest axis-parallel square inside, in D; the length of the corrected interval where one translation is locked.
    pub onaa_d: f64,
    /// The design beside published areas.
    pub ratios: Vec<Ratio>,
}

impl Body for CatalogBody {
    const KIND: &'static str = "catalog";
}

impl Body for SystemBody {
    const KIND: &'static str = "catalog-system";
}

impl Body for ClassifyBody {
    const KIND: &'static str = "classify";
}

impl SystemBody {
    /// Of a row.
    pub fn of(system: &System) -> Self {
        let value = |attribute: Attribute, printed: &str| ValueReport {
            printed: printed.to_owned(),
            normal: attribute.normal(printed).to_owned(),
            reason: attribute.oddity(printed).map(|oddity| oddity.reason),
        };
        let attributes = system.attributes.as_ref().map(|values| {
            Attribute::ALL.into_iter().zip(values).map(|(a, printed)| (a.key(), value(a, printed))).collect()
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

    fn value(&self, attribute: Attribute) -> Option<&ValueReport> {
        self.attributes.as_ref()?.get(attribute.key())
    }

    fn printed(&self, attribute: Attribute) -> &str {
        self.value(attribute).map_or(NOTHING, |value| value.printed.as_str())
    }

    /// The area as people read it, with a star where it is an estimate.
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

impl CatalogBody {
    /// The report of a catalogue.
    pub fn report(catalog: &Catalog) -> CatalogReport {
        let systems = catalog.systems.iter().map(SystemBody::of).collect();
        Envelope::of(Self { systems }, Vec::new(), None)
    }

    /// For a person: the attributes that say most.
    pub fn table(&self) -> String {
        /// Width of the names.
        const NAME: usize = 17;
        const COLUMNS: [(Attribute, usize); 4] = [
            (Attribute::Introduced, 11),
            (Attribute::SelfAligningDegree, 8),
            (Attribute::Gendering, 11),
            (Attribute::ConnectionType, 14),
        ];
        let text = &mut String::new();
        line(text, "  system            introduced  degree   gendering   type            ZRAA [D²]");
        let mut odd: Vec<&Oddity> = Vec::new();
        for system in &self.systems {
            let mut told = vec![format!("  {:<NAME$}", cut(&system.system, NAME))];
            for (attribute, width) in COLUMNS {
                let printed = system.printed(attribute);
                let oddity = attribute.oddity(printed);
                // What an appended design leaves open is no oddity of the source.
                let mark = oddity.filter(|_| system.source != Source::Appended).map_or("", |_| "!");
                odd.extend(oddity.filter(|oddity| !mark.is_empty() && !odd.contains(oddity)));
                told.push(format!("{:<width$}", format!("{printed}{mark}")));
            }
            told.push(format!("{:>9}", system.zraa()));
            line(text, &told.join(" "));
        }
        line(text, &format!("{} systems", self.systems.len()));
        if self.systems.iter().any(|system| system.estimated) {
            line(text, "* marked as an estimate in the source");
        }
        for Oddity { attribute, printed, normal, reason } in odd {
            let first = format!("! {printed} ");
            wrapped(text, &first, &format!("({}) is read as {normal} [I]: {reason}", attribute.title()));
        }
        if self.systems.iter().any(|system| system.source == Source::Appended) {
            line(text, "The area, degree and gendering of an appended design are computed.");
        }
        std::mem::take(text)
    }

    /// Every attribute as printed and in its normal form, and the area, as records for programs.
    pub fn records(&self) -> Vec<Vec<String>> {
        let mut head = vec!["system".to_owned(), "source".to_owned()];
        for attribute in Attribute::ALL {
            head.extend([attribute.key().to_owned(), format!("{}_normal", attribute.key())]);
        }
        head.extend(["zraa_d2", "estimated", "provenance", "stated_onaa_d"].map(str::to_owned));
        let mut records = vec![head];
        for system in &self.systems {
            let mut record = vec![printable(&system.system), source(&system.source).to_owned()];
            for attribute in Attribute::ALL {
                let value = system.value(attribute);
                record.extend(
                    [value.map(|v| v.printed.clone()), value.map(|v| v.normal.clone())]
                        .map(Option::unwrap_or_default),
                );
            }
            let stated = system.numbers.iter().find(|n| n.name == "ONAA" && n.basis.starts_with("section"));
            record.extend([
                system.zraa_d2.map(number).unwrap_or_default(),
                u8::from(system.estimated).to_string(),
                system.numbers.first().map_or("", |n| n.provenance.mark()).to_owned(),
                stated.map(|n| number(n.value)).unwrap_or_default(),
            ]);
            records.push(record);
        }
        records
    }

    /// Every attribute as a table in Markdown; a normal form that differs stands behind an arrow.
    pub fn markdown(&self) -> String {
        let text = &mut String::new();
        let titles: Vec<&str> = Attribute::ALL.map(Attribute::title).to_vec();
        line(text, &format!("| system | {} | ZRAA [D²] |", titles.join(" | ")));
        line(text, &format!("|{}", " --- |".repeat(titles.len() + 2)));
        for system in &self.systems {
            let cell = |attribute| match system.value(attribute) {
                None => NOTHING.to_owned(),
                Some(value) if value.normal == value.printed || system.source == Source::Appended => {
                    value.printed.clone()
                }
                Some(value) => format!("{} → {}", value.printed, value.normal),
            };
            let mut cells = vec![system.system.clone()];
            cells.extend(Attribute::ALL.map(cell));
            cells.push(system.zraa().replace('*', "\\*"));
            let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
            line(text, &format!("| {} |", cells.join(" | ")));
        }
        std::mem::take(text)
    }
}

/// Where a row comes from, in a word.
const fn source(source: &Source) -> &'static str {
    match source {
        Source::Connectors(None) => "table 1.1",
        Source::Connectors(Some(_)) => "tables 1.1 and 2.1",
        Source::ZraaAlone => "table 2.1",
        Source::Section412 => "section 4.1.2",
        Source::Appended => "design",
    }
}

/// At most so many characters.
fn cut(name: &str, most: usize) -> String {
    if name.chars().count() <= most {
        return name.to_owned();
    }
    name.chars().take(most - 1).chain(std::iter::once('…')).collect()
}

impl SystemBody {
    /// The report of a row.
    pub fn report(system: &System) -> SystemReport {
        Envelope::of(Self::of(system), Vec::new(), None)
    }

    /// For a person: every attribute, every number with its provenance.
    pub fn table(&self) -> String {
        /// Width of the titles of attributes.
        const TITLE: usize = 25;
        let text = &mut String::new();
        let other = match &self.source {
            Source::Connectors(Some(name)) if *name != self.system => format!(" (as {name})"),
            _ => String::new(),
        };
        line(text, &format!("{}: {}{other}", self.system, source(&self.source)));
        if self.attributes.is_none() {
            let known = match self.source {
                Source::Section412 => "section 4.1 calls it ungendered and states nothing else",
                _ => "its attributes are not stated",
            };
            wrapped(text, "  ", &format!("table 1.1 does not have it: {known}"));
        }
        for attribute in Attribute::ALL {
            if let Some(value) = self.value(attribute) {
                let first = format!("  {:<TITLE$}", attribute.title());
                match value.reason {
                    None => line(text, &format!("{first}{}", value.printed)),
                    Some(reason) => {
                        wrapped(
                            text,
                            &first,
                            &format!("{}, read as {} [I]: {reason}", value.printed, value.normal),
                        );
                    }
                }
            }
        }
        for found in &self.numbers {
            let value = format!("{} {}", shown(found.value), found.unit);
            let first = format!("  {:<10}{value:<12}  {} ", found.name, found.provenance.mark());
            wrapped(text, &first, &found.basis);
        }
        if let Some(doubt) = self.doubt {
            wrapped(text, "  note  ", doubt);
        }
        if self.numbers.is_empty() {
            line(text, "  table 2.1 does not have it: its area is not stated");
        } else {
            line(text, "[D] stated by the dissertation  [R] computed here from that  [I] our reading");
        }
        std::mem::take(text)
    }
}

impl ClassifyBody {
    /// The report of a design that was classified.
    pub fn report(design: &Design, found: &Classified, catalog: &Catalog) -> ClassifyReport {
        let body = Self {
            design: design.clone(),
            degree: found.degree.name(),
            extents_d: found.extents,
            longest_d: found.extents.longest(),
            high_above_d: HIGH,
            gendering: found.gendering(),
            zraa_d2: found.area(),
            onaa_d: found.square.edge,
            ratios: found.ratios(catalog),
        };
        Envelope::of(body, Vec::new(), None)
    }

    /// For a person.
    pub fn table(&self) -> String {
        let text = &mut String::new();
        line(text, &self.design.name);
        row(text, "degree", self.degree);
        let reach = |axis: &str, extent: Option<[f64; 2]>| {
            extent.map(|[from, to]| format!("{axis} {} … {} D", shown(from), shown(to)))
        };
        let reaches: Vec<String> =
            [reach("x", self.extents_d.x), reach("y", self.extents_d.y)].into_iter().flatten().collect();
        row(text, "", &format!("corrected through zero: {}", reaches.join(", ")));
        row(text, "", &format!("High is more than {HIGH:.2} D from side to side [I]"));
        row(text, "gendering", self.gendering);
        let halves = if self.gendering == "Ungendered" { "the fixed half" } else { "not the fixed half" };
        row(text, "", &format!("the moving half, half turned, is {halves}"));
        if let Some(area) = self.zraa_d2 {
            row(text, "ZRAA", &format!("{} D²", shown(area)));
        }
        let edge = match self.zraa_d2 {
            Some(_) => "edge of the largest axis-parallel square",
            None => "length of the corrected interval",
        };
        row(text, "ONAA", &format!("{} D, {edge}", shown(self.onaa_d)));
        if self.zraa_d2.is_none() {
            line(text, "  One translation is locked, so the region is an interval, not an area: a");
            line(text, "  length has no ratio to published areas.");
            return std::mem::take(text);
        }
        line(text, "  beside            stated area     × area   stated ONAA    × ONAA");
        for ratio in &self.ratios {
            let star = if ratio.estimated { "*" } else { "" };
            let some = |value: Option<f64>| value.map_or_else(|| NOTHING.to_owned(), shown);
            let area = format!("{} D²{star}", shown(ratio.area_d2));
            let onaa = ratio.onaa_d.map_or_else(|| NOTHING.to_owned(), |onaa| format!("{} D", shown(onaa)));
            let (areas, onaas) = (some(ratio.area_ratio), some(ratio.onaa_ratio));
            line(text, &format!("  {:<18}{area:<12}{areas:>10}   {onaa:<12}{onaas:>9}", ratio.system));
        }
        line(text, "* marked as an estimate in the source");
        std::mem::take(text)
    }
}

#[cfg(test)]
mod tests;
