//! Selection and order of the catalogue's rows.

use super::attribute::CatalogAttribute;
use super::data::{Catalog, RowSource, System};
use catchment::design::nearest;
use std::collections::BTreeSet;

/// An attribute and a value that a row must have: as printed, or in its normal form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Condition {
    /// The attribute.
    pub attribute: CatalogAttribute,
    /// The value, as the table or the normal form spells it.
    pub value: String,
}

/// The order of the rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowOrder {
    /// As printed, which is by date; rows without a date last.
    Introduced,
    /// By area, the largest first; rows without an area last.
    Zraa,
}

/// A word that the catalogue does not know, with those that it knows.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum UnknownError {
    /// It is not of the form `attribute=value`.
    #[error("`{text}` is no condition: write attribute=value, such as gendering=Ungendered")]
    Form {
        /// The text as written.
        text: String,
    },
    /// There is no such attribute.
    #[error("there is no attribute `{written}`{}", suggested(.meant.as_deref()))]
    Attribute {
        /// The text as written.
        written: String,
        /// The name that was probably meant.
        meant: Option<String>,
        /// Every attribute.
        known: Vec<String>,
    },
    /// No row has the value.
    #[error("no system has the {attribute} `{written}`{}", suggested(.meant.as_deref()))]
    Value {
        /// Of this attribute.
        attribute: &'static str,
        /// The text as written.
        written: String,
        /// The name that was probably meant.
        meant: Option<String>,
        /// Every value.
        known: Vec<String>,
    },
    /// There is no such system.
    #[error("there is no system `{written}`{}", suggested(.meant.as_deref()))]
    System {
        /// The text as written.
        written: String,
        /// The name that was probably meant.
        meant: Option<String>,
        /// Every system.
        known: Vec<String>,
    },
}

impl UnknownError {
    /// The known names.
    pub fn help(&self) -> Option<String> {
        let (Self::Attribute { known, .. } | Self::Value { known, .. } | Self::System { known, .. }) = self
        else {
            return None;
        };
        Some(format!("known are {}", known.join(", ")))
    }
}

fn suggested(word: Option<&str>) -> String {
    word.map_or_else(String::new, |word| format!(", did you mean `{word}`?"))
}

fn likely(written: &str, known: &[String]) -> Option<String> {
    nearest(written, known.iter().map(String::as_str)).map(str::to_owned)
}

impl Catalog {
    /// Reads `attribute=value`; case is ignored.
    ///
    /// # Errors
    /// If either is unknown, with the known names.
    pub fn condition(&self, text: &str) -> Result<Condition, UnknownError> {
        let Some((name, value)) = text.split_once('=') else {
            return Err(UnknownError::Form { text: text.to_owned() });
        };
        let (name, value) = (name.trim(), value.trim());
        let Some(attribute) = CatalogAttribute::named(name) else {
            let known: Vec<String> = CatalogAttribute::ALL.map(|a| a.key().to_owned()).to_vec();
            let (written, meant) = (name.to_owned(), likely(name, &known));
            return Err(UnknownError::Attribute { written, meant, known });
        };
        let known = self.values(attribute);
        if let Some(value) = known.iter().find(|known| known.eq_ignore_ascii_case(value)) {
            return Ok(Condition { attribute, value: value.clone() });
        }
        let (written, meant) = (value.to_owned(), likely(value, &known));
        Err(UnknownError::Value { attribute: attribute.title(), written, meant, known })
    }

    /// Every value of an attribute, printed or normal, sorted.
    pub fn values(&self, attribute: CatalogAttribute) -> Vec<String> {
        let of = |system: &System| {
            [system.printed(attribute), system.normal(attribute)]
                .into_iter()
                .flatten()
                .map(str::to_owned)
                .collect()
        };
        let values: BTreeSet<String> = self.systems.iter().flat_map(|s| -> Vec<String> { of(s) }).collect();
        values.into_iter().collect()
    }

    /// The row of a name.
    ///
    /// # Errors
    /// If there is none, with all names.
    pub fn named(&self, name: &str) -> Result<&System, UnknownError> {
        self.find(name.trim()).ok_or_else(|| {
            let known: Vec<String> = self.systems.iter().map(|system| system.name.clone()).collect();
            UnknownError::System { written: name.to_owned(), meant: likely(name, &known), known }
        })
    }

    /// The rows that meet all conditions; conditions on the same attribute are alternatives.
    #[must_use]
    pub fn filtered(mut self, conditions: &[Condition]) -> Self {
        let holds = |system: &System, wanted: &Condition| {
            let is = |value: Option<&str>| value == Some(wanted.value.as_str());
            is(system.printed(wanted.attribute)) || is(system.normal(wanted.attribute))
        };
        self.systems.retain(|system| {
            conditions.iter().all(|condition| {
                let same = |other: &&Condition| other.attribute == condition.attribute;
                conditions.iter().filter(same).any(|alternative| holds(system, alternative))
            })
        });
        self
    }

    /// The rows in another order; equal rows keep theirs.
    #[must_use]
    pub fn sorted(mut self, order: RowOrder) -> Self {
        match order {
            RowOrder::Introduced => self.systems.sort_by_key(|system| {
                let date = system
                    .printed(CatalogAttribute::Introduced)
                    .filter(|_| system.source != RowSource::Appended);
                (date.is_none(), date.map(str::to_owned))
            }),
            RowOrder::Zraa => self.systems.sort_by(|a, b| {
                let area = |system: &System| system.area().unwrap_or(f64::NEG_INFINITY);
                area(b).total_cmp(&area(a))
            }),
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn catalog() -> Catalog {
        Catalog::published().unwrap()
    }

    fn names(conditions: &[&str]) -> Vec<String> {
        let catalog = catalog();
        let conditions: Vec<Condition> =
            conditions.iter().map(|text| catalog.condition(text).unwrap()).collect();
        catalog.filtered(&conditions).systems.into_iter().map(|system| system.name).collect()
    }

    #[test]
    fn attributes_combine_by_and_their_values_by_or() {
        assert_eq!(names(&["gendering=Ungendered", "degree=High"]), ["DRAGON", "SINGO", "Vacuubes", "DFA"]);
        assert_eq!(names(&["TYPE=magnet"]), ["Fracta 2D"]);
        // The normal form takes its odd spelling along.
        assert_eq!(names(&["type=Magnetic"]).len(), 9);
        assert_eq!(names(&["degree=none"]).len(), 8);
        assert_eq!(names(&["degree=High", "degree=Low", "gendering=Gendered"]).len(), 10);
    }

    #[test]
    fn unknown_names_list_the_known_ones() {
        let refusal = |error: &UnknownError| format!("{error} {}", error.help().unwrap_or_default());
        let condition = |text: &str| refusal(&catalog().condition(text).unwrap_err());
        assert!(condition("gendering").contains("write attribute=value"));
        let attribute = condition("gendring=Ungendered");
        assert!(
            attribute.contains("did you mean `gendering`?") && attribute.contains("approach_angle"),
            "{attribute}"
        );
        let value = condition("gendering=Hermaphroditic");
        assert!(value.ends_with("known are Gendered, Ungendered"), "{value}");
        let system = refusal(catalog().named("Dragn").as_ref().unwrap_err());
        assert!(system.contains("did you mean `DRAGON`?") && system.contains("GENFA"), "{system}");
    }

    #[test]
    fn rows_are_sorted_by_area_and_by_date() {
        let by_area = catalog().sorted(RowOrder::Zraa);
        let first: Vec<&str> = by_area.systems.iter().take(4).map(|system| system.name.as_str()).collect();
        assert_eq!(first, ["3-D X-Face", "amour", "DRAGON", "SINGO"]);
        assert_eq!(catalog().sorted(RowOrder::Introduced), catalog());
        let dates: Vec<_> = by_area.sorted(RowOrder::Introduced).systems;
        let dates: Vec<_> =
            dates.iter().filter_map(|system| system.printed(CatalogAttribute::Introduced)).collect();
        assert!(dates.is_sorted());
    }
}
