//! The eleven attributes of table 1.1, and their values that the text does not define.

use serde::Serialize;

/// A column of table 1.1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum CatalogAttribute {
    /// Month of its publication.
    Introduced,
    /// Degree of passive alignment by contact or magnets.
    SelfAligningDegree,
    /// Whether a half pairs with any other half, or only with the other kind.
    Gendering,
    /// Whether connecting needs an action by a module.
    ConnectionActivity,
    /// Whether disconnecting needs an action by a module.
    DisconnectionActivity,
    /// Modules that must act to connect.
    ConnectionAgency,
    /// Modules that must act to disconnect.
    DisconnectionAgency,
    /// Mechanism that holds the halves together.
    ConnectionType,
    /// Power needed to stay connected.
    ConnectionMaintenance,
    /// Whether the connection is compliant.
    Compliance,
    /// The usual direction of approach to the face.
    ApproachAngle,
}

/// Attribute, name in the table's file, other names, heading for people.
type Named = (CatalogAttribute, &'static str, &'static [&'static str], &'static str);

const NAMES: [Named; 11] = [
    (CatalogAttribute::Introduced, "introduced", &["date"], "introduced"),
    (CatalogAttribute::SelfAligningDegree, "self_aligning_degree", &["degree"], "self-aligning degree"),
    (CatalogAttribute::Gendering, "gendering", &[], "gendering"),
    (CatalogAttribute::ConnectionActivity, "connection_activity", &[], "connection activity"),
    (CatalogAttribute::DisconnectionActivity, "disconnection_activity", &[], "disconnection activity"),
    (CatalogAttribute::ConnectionAgency, "connection_agency", &[], "connection agency"),
    (CatalogAttribute::DisconnectionAgency, "disconnection_agency", &[], "disconnection agency"),
    (CatalogAttribute::ConnectionType, "connection_type", &["type"], "connection type"),
    (
        CatalogAttribute::ConnectionMaintenance,
        "connection_maintenance",
        &["maintenance"],
        "connection maintenance",
    ),
    (CatalogAttribute::Compliance, "compliance", &[], "compliance"),
    (CatalogAttribute::ApproachAngle, "approach_angle", &["approach"], "approach angle"),
];

impl CatalogAttribute {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 11] = [
        Self::Introduced,
        Self::SelfAligningDegree,
        Self::Gendering,
        Self::ConnectionActivity,
        Self::DisconnectionActivity,
        Self::ConnectionAgency,
        Self::DisconnectionAgency,
        Self::ConnectionType,
        Self::ConnectionMaintenance,
        Self::Compliance,
        Self::ApproachAngle,
    ];

    /// Its place in the table.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Its name in files and on the command line.
    pub const fn key(self) -> &'static str {
        NAMES[self.index()].1
    }

    /// Its name for people.
    pub const fn title(self) -> &'static str {
        NAMES[self.index()].3
    }

    /// The attribute of a name; short names count, upper and lower case do not.
    pub fn named(name: &str) -> Option<Self> {
        let is = |known: &str| known.eq_ignore_ascii_case(name);
        NAMES.iter().find(|(_, key, others, _)| is(key) || others.iter().any(|o| is(o))).map(|named| named.0)
    }

    /// The value in the terms that the text defines: the printed value, except for [`ODDITIES`].
    pub fn normal(self, printed: &str) -> &str {
        self.oddity(printed).map_or(printed, |oddity| oddity.normal)
    }

    /// The oddity of a printed value, if any.
    pub fn oddity(self, printed: &str) -> Option<&'static Oddity> {
        ODDITIES.iter().find(|oddity| oddity.attribute == self && oddity.printed == printed)
    }
}

/// A printed value that the text does not define or that is spelt in two ways, with our reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Oddity {
    /// Attribute in which it occurs.
    pub attribute: CatalogAttribute,
    /// Printed value.
    pub printed: &'static str,
    /// Our reading.
    pub normal: &'static str,
    /// Reason for our reading.
    pub reason: &'static str,
}

/// Name of a value that the table leaves open.
const UNSTATED: &str = "unstated";
/// Name of a value that does not apply according to the table.
const NOT_APPLICABLE: &str = "not applicable";
const NO_AGENCY: &str = "a dash is printed, and the text does not say what it means";
const PEBBLES: &str = "its row is a passive system that assembles itself";

const fn odd(
    attribute: CatalogAttribute,
    printed: &'static str,
    normal: &'static str,
    reason: &'static str,
) -> Oddity {
    Oddity { attribute, printed, normal, reason }
}

/// Every printed value that has another normal form. The readings are ours.
pub const ODDITIES: [Oddity; 11] = [
    odd(
        CatalogAttribute::SelfAligningDegree,
        "Active",
        "None",
        "none of the three degrees that the text defines; a mechanism that aligns falls under its \"None\"",
    ),
    odd(CatalogAttribute::DisconnectionActivity, "Manual", "Passive", "a hand undoes it: no module acts"),
    odd(
        CatalogAttribute::ConnectionType,
        "Magnet",
        "Magnetic",
        "the same mechanism is Magnetic in eight other rows",
    ),
    odd(
        CatalogAttribute::ConnectionType,
        "Mag/Latching",
        "Magnetic and latching",
        "both mechanisms; which of them carries the load is not stated",
    ),
    odd(CatalogAttribute::ConnectionMaintenance, "Low Power", "Powered", "it needs power, if little"),
    odd(
        CatalogAttribute::ConnectionMaintenance,
        "Single Pump per Cluster",
        "Powered",
        "the pump that holds it runs on power, once for all modules",
    ),
    odd(CatalogAttribute::ConnectionAgency, "-", UNSTATED, NO_AGENCY),
    odd(CatalogAttribute::DisconnectionAgency, "-", UNSTATED, NO_AGENCY),
    odd(CatalogAttribute::ConnectionActivity, "N/A", NOT_APPLICABLE, PEBBLES),
    odd(CatalogAttribute::ConnectionAgency, "N/A", NOT_APPLICABLE, PEBBLES),
    odd(CatalogAttribute::ApproachAngle, "N/A", NOT_APPLICABLE, PEBBLES),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_attribute_resolves_by_its_names() {
        for (k, (attribute, key, others, _)) in NAMES.iter().enumerate() {
            assert_eq!((attribute.index(), CatalogAttribute::ALL[k]), (k, *attribute));
            assert_eq!(CatalogAttribute::named(&key.to_uppercase()), Some(*attribute));
            assert!(others.iter().all(|other| CatalogAttribute::named(other) == Some(*attribute)));
        }
        assert_eq!(CatalogAttribute::named("colour"), None);
    }
}
