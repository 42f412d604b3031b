//! The two published tables, and the list of names that joins them.

use super::attribute::CatalogAttribute;
use serde::Serialize;

/// The tables, as they were printed; dates are ISO months.
const CONNECTORS: &str = include_str!("../../data/table-1.1-connectors.csv");
const ZRAA: &str = include_str!("../../data/table-2.1-zraa.csv");

/// The same system in table 1.1 and in table 2.1, if both list it. Names are joined only by this list.
pub const ALIASES: [(&str, &str); 8] = [
    ("I-Cubes", "I-Cubes"),
    ("CONRO", "CONRO"),
    ("DRAGON", "DRAGON"),
    ("Polybot G3", "Polybot"),
    ("amour", "amour"),
    ("M-TRAN III", "M-TRAN III"),
    ("SINGO", "SINGO Connector"),
    ("Vacuubes", "Vacuubes"),
];

/// Other names of a system that users may enter, and the name in the catalogue.
const ASKED: [(&str, &str); 9] = [
    ("PolyBot", "Polybot G3"),
    ("PolyBot G3", "Polybot G3"),
    ("GENFA", "GENFA Connector"),
    ("ACOR", "ACOR (unpaired)"),
    ("X-Face", "3-D X-Face"),
    ("x-face-3d", "3-D X-Face"),
    ("CEBOT", "CEBOT Mark II"),
    ("CKBot", "CKBot (SAE)"),
    ("Catom", "GHC (Catom)"),
];

/// The row that neither table has.
const X_FACE: &str = "3-D X-Face";
/// Its zero-rotation area, in D² (section 4.1.2).
const X_FACE_AREA: f64 = 2.0;

/// The published tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PublishedTable {
    /// Table 1.1, connectors and their attributes.
    Connectors,
    /// Table 2.1, zero-rotation areas of acceptance.
    Zraa,
}

impl PublishedTable {
    /// Its number.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Connectors => "1.1",
            Self::Zraa => "2.1",
        }
    }
}

/// Source of a row.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case", tag = "kind", content = "name")]
pub enum RowSource {
    /// Table 1.1, and table 2.1 under the given name if it lists the system.
    Connectors(Option<String>),
    /// Only table 2.1.
    ZraaAlone,
    /// Section 4.1.2.
    Section412,
    /// A design that was classified here.
    Appended,
}

/// A zero-rotation area of acceptance as the dissertation states it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PublishedZraa {
    /// Its area, in D².
    pub area_d2: f64,
    /// The number as printed.
    pub printed: String,
    /// Whether it is marked as estimated.
    pub estimated: bool,
}

/// A row of the catalogue.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    /// Its name: that of table 1.1 if listed there.
    pub name: String,
    /// Source of the row.
    pub source: RowSource,
    /// The printed values by [`CatalogAttribute::index`]; `None` if table 1.1 does not list it.
    pub attributes: Option<[String; 11]>,
    /// The published area.
    pub published: Option<PublishedZraa>,
    /// The area that was computed of an appended design, in D².
    pub computed: Option<f64>,
}

impl System {
    /// The printed value of an attribute.
    pub fn printed(&self, attribute: CatalogAttribute) -> Option<&str> {
        self.attributes.as_ref().map(|values| values[attribute.index()].as_str())
    }

    /// The value in the terms that the text defines.
    pub fn normal(&self, attribute: CatalogAttribute) -> Option<&str> {
        self.printed(attribute).map(|printed| attribute.normal(printed))
    }

    /// The published area, or the computed area of an appended design, in D².
    pub fn area(&self) -> Option<f64> {
        self.published.as_ref().map(|zraa| zraa.area_d2).or(self.computed)
    }

    /// Its name in table 2.1.
    pub fn zraa_name(&self) -> Option<&str> {
        match &self.source {
            RowSource::Connectors(name) => name.as_deref(),
            RowSource::ZraaAlone => Some(&self.name),
            RowSource::Section412 | RowSource::Appended => None,
        }
    }
}

/// An error in the data of a table.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the data of table {table} cannot be read, line {line}: {reason}")]
pub struct DataError {
    /// Which table.
    pub table: &'static str,
    /// Line of its file, from 1.
    pub line: u64,
    /// Description.
    pub reason: String,
}

/// The systems, in the order of the tables.
#[derive(Debug, Clone, PartialEq)]
pub struct Catalog {
    /// Rows of table 1.1, then those of table 2.1 alone, then the 3-D X-Face, then appended designs.
    pub systems: Vec<System>,
    /// Names of table 2.1, in its order.
    zraa_order: Vec<String>,
}

impl Catalog {
    /// The published catalogue.
    ///
    /// # Errors
    /// If the data of a table is malformed.
    pub fn published() -> Result<Self, DataError> {
        let mut areas = zraa_rows(ZRAA)?;
        let zraa_order = areas.iter().map(|(name, _)| name.clone()).collect();
        let mut systems = Vec::new();
        for record in records(PublishedTable::Connectors, CONNECTORS, 1 + CatalogAttribute::ALL.len())? {
            let (name, values) = (record.fields[0].clone(), &record.fields[1..]);
            let attributes: [String; 11] = std::array::from_fn(|k| values[k].clone());
            let alias = ALIASES.iter().find(|(own, _)| *own == name).map(|(_, alias)| *alias);
            let at = alias.and_then(|alias| areas.iter().position(|(other, _)| other == alias));
            let (alias, published) = at.map(|at| areas.remove(at)).unzip();
            let source = RowSource::Connectors(alias);
            systems.push(System { name, source, attributes: Some(attributes), published, computed: None });
        }
        let alone = |name: String, source, zraa| System {
            name,
            source,
            attributes: None,
            published: Some(zraa),
            computed: None,
        };
        systems.extend(areas.into_iter().map(|(name, zraa)| alone(name, RowSource::ZraaAlone, zraa)));
        let printed = format!("{X_FACE_AREA:.1}");
        let x_face = PublishedZraa { area_d2: X_FACE_AREA, printed, estimated: false };
        systems.push(alone(X_FACE.to_owned(), RowSource::Section412, x_face));
        Ok(Self { systems, zraa_order })
    }

    /// The row of a name: that of either table, or a common name for it; case is ignored.
    pub fn find(&self, name: &str) -> Option<&System> {
        let meant = ASKED
            .iter()
            .find(|(requested, _)| requested.eq_ignore_ascii_case(name))
            .map_or(name, |(_, of)| of);
        self.systems.iter().find(|system| {
            let is = |known: &str| known.eq_ignore_ascii_case(meant);
            is(&system.name) || system.zraa_name().is_some_and(is)
        })
    }

    /// A published table, byte for byte.
    ///
    /// # Errors
    /// Never at present: every record has the columns of its table.
    pub fn as_printed(&self, table: PublishedTable) -> Result<Vec<u8>, csv::Error> {
        let mut rows: Vec<Vec<String>> = Vec::new();
        match table {
            PublishedTable::Connectors => {
                rows.push(
                    std::iter::once("connector")
                        .chain(CatalogAttribute::ALL.map(CatalogAttribute::key))
                        .map(str::to_owned)
                        .collect(),
                );
                for system in &self.systems {
                    if let (RowSource::Connectors(_), Some(values)) = (&system.source, &system.attributes) {
                        rows.push(std::iter::once(&system.name).chain(values).cloned().collect());
                    }
                }
            }
            PublishedTable::Zraa => {
                rows.push(["system", "normalized_zraa_sum", "estimated"].map(str::to_owned).to_vec());
                for name in &self.zraa_order {
                    let system = self.systems.iter().find(|system| system.zraa_name() == Some(name));
                    if let Some(zraa) = system.and_then(|system| system.published.as_ref()) {
                        let estimated = u8::from(zraa.estimated).to_string();
                        rows.push(vec![name.clone(), zraa.printed.clone(), estimated]);
                    }
                }
            }
        }
        catchment::report::csv(&rows)
    }
}

/// A record and its line.
struct Record {
    fields: Vec<String>,
    line: u64,
}

fn records(table: PublishedTable, text: &str, columns: usize) -> Result<Vec<Record>, DataError> {
    let refused = |line, reason| DataError { table: table.name(), line, reason };
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let mut result = Vec::new();
    for record in reader.records() {
        let record = record
            .map_err(|error| refused(error.position().map_or(1, csv::Position::line), error.to_string()))?;
        let line = record.position().map_or(1, csv::Position::line);
        if record.len() != columns {
            return Err(refused(line, format!("it has {} columns where {columns} are wanted", record.len())));
        }
        result.push(Record { fields: record.iter().map(str::to_owned).collect(), line });
    }
    Ok(result)
}

fn zraa_rows(text: &str) -> Result<Vec<(String, PublishedZraa)>, DataError> {
    let row = |record: Record| {
        let [name, printed, estimated]: [String; 3] =
            record.fields.try_into().map_err(|_| (record.line, "it has no three columns".to_owned()))?;
        let area_d2: f64 =
            printed.parse().map_err(|_| (record.line, format!("`{printed}` is not a number")))?;
        let estimated = match estimated.as_str() {
            "0" => false,
            "1" => true,
            other => return Err((record.line, format!("`{other}` is neither 0 nor 1"))),
        };
        Ok((name, PublishedZraa { area_d2, printed, estimated }))
    };
    records(PublishedTable::Zraa, text, 3)?
        .into_iter()
        .map(|record| {
            row(record).map_err(|(line, reason)| DataError {
                table: PublishedTable::Zraa.name(),
                line,
                reason,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn catalog() -> Catalog {
        Catalog::published().unwrap()
    }

    #[test]
    fn both_tables_come_back_byte_for_byte() {
        for (table, text, rows) in
            [(PublishedTable::Connectors, CONNECTORS, 27), (PublishedTable::Zraa, ZRAA, 11)]
        {
            let again = String::from_utf8(catalog().as_printed(table).unwrap()).unwrap();
            assert_eq!((again.as_str(), text.lines().count()), (text, 1 + rows), "{}", table.name());
        }
    }

    #[test]
    fn rows_stand_in_the_order_of_their_dates() {
        let dates: Vec<String> = catalog()
            .systems
            .iter()
            .filter_map(|system| system.printed(CatalogAttribute::Introduced).map(str::to_owned))
            .collect();
        assert!(dates.len() == 27 && dates.is_sorted());
        assert_eq!((dates[0].as_str(), dates[26].as_str()), ("1989-05", "2014-06"));
    }

    /// How often each value is printed: the table of the specification.
    #[test]
    fn every_value_is_printed_as_often_as_in_the_source() {
        let counts = |attribute| {
            let mut counts: BTreeMap<String, usize> = BTreeMap::new();
            for system in catalog().systems {
                if let Some(value) = system.printed(attribute) {
                    *counts.entry(value.to_owned()).or_default() += 1;
                }
            }
            counts
        };
        let expected: [(CatalogAttribute, &[(&str, usize)]); 10] = [
            (CatalogAttribute::SelfAligningDegree, &[("High", 9), ("Low", 10), ("None", 7), ("Active", 1)]),
            (CatalogAttribute::Gendering, &[("Gendered", 14), ("Ungendered", 13)]),
            (CatalogAttribute::ConnectionActivity, &[("Active", 17), ("Passive", 9), ("N/A", 1)]),
            (CatalogAttribute::DisconnectionActivity, &[("Active", 18), ("Passive", 8), ("Manual", 1)]),
            (
                CatalogAttribute::ConnectionAgency,
                &[
                    ("Double End", 9),
                    ("Male End", 7),
                    ("Single End", 5),
                    ("Female End", 3),
                    ("-", 2),
                    ("N/A", 1),
                ],
            ),
            (
                CatalogAttribute::DisconnectionAgency,
                &[("Double End", 7), ("Male End", 7), ("Single End", 7), ("Female End", 3), ("-", 3)],
            ),
            (
                CatalogAttribute::ConnectionType,
                &[
                    ("Latching", 14),
                    ("Magnetic", 8),
                    ("Magnet", 1),
                    ("Velcro", 1),
                    ("Electrostatic", 1),
                    ("Air Pressure", 1),
                    ("Mag/Latching", 1),
                ],
            ),
            (
                CatalogAttribute::ConnectionMaintenance,
                &[("Zero-Power", 23), ("Powered", 2), ("Low Power", 1), ("Single Pump per Cluster", 1)],
            ),
            (CatalogAttribute::Compliance, &[("Rigid", 17), ("Compliant", 10)]),
            (CatalogAttribute::ApproachAngle, &[("Perpendicular", 18), ("Non-Perpendicular", 8), ("N/A", 1)]),
        ];
        for (attribute, values) in expected {
            let expected = values.iter().map(|(value, count)| ((*value).to_owned(), *count)).collect();
            assert_eq!(counts(attribute), expected, "{}", attribute.title());
        }
    }

    #[test]
    fn every_odd_value_is_printed_somewhere_and_has_a_defined_normal_form() {
        for oddity in super::super::ODDITIES {
            let catalog = catalog();
            let holds = |system: &System| system.printed(oddity.attribute) == Some(oddity.printed);
            let odd = catalog.systems.iter().find(|system| holds(system)).unwrap();
            assert_eq!(odd.normal(oddity.attribute), Some(oddity.normal));
            assert_ne!(oddity.printed, oddity.normal);
        }
    }

    #[test]
    fn eight_systems_are_in_both_tables_and_three_in_the_second_alone() {
        let catalog = catalog();
        for (first, second) in ALIASES {
            let system = catalog.find(first).unwrap();
            assert_eq!((system.zraa_name(), system.published.is_some()), (Some(second), true), "{first}");
            assert_eq!(catalog.find(second).unwrap(), system);
        }
        let of = |source: &RowSource| catalog.systems.iter().filter(|s| s.source == *source).count();
        assert_eq!(
            (of(&RowSource::ZraaAlone), of(&RowSource::Connectors(None)), of(&RowSource::Section412)),
            (3, 19, 1)
        );
        assert_eq!(catalog.systems.len(), 31);
        for (requested, name) in ASKED {
            assert_eq!(catalog.find(&requested.to_uppercase()).unwrap().name, name);
        }
        // Nothing is found by likeness.
        assert!(catalog.find("Polybo").is_none() && catalog.find("SMORE").is_none());
    }

    #[test]
    fn broken_data_is_reported_with_its_line() {
        let refused = |text: &str| zraa_rows(text).unwrap_err().to_string();
        let head = "system,normalized_zraa_sum,estimated\n";
        assert!(
            refused(&format!("{head}a,1.5,0\nb,x,0\n"))
                .contains("table 2.1 cannot be read, line 3: `x` is not")
        );
        assert!(refused(&format!("{head}a,1.5,2\n")).contains("line 2: `2` is neither 0 nor 1"));
        assert!(refused(&format!("{head}a,1.5\n")).contains("line 2"));
    }
}
