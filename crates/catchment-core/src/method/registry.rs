//! The methods by name: each is a line of the registry, and a value that can be read, changed and stored.

use super::interface::{DecisionMethod, Info};
use crate::design::nearest;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Map, Value, json};
use std::fmt;
use std::ops::Deref;
use std::str::FromStr;
use std::sync::Arc;

/// Every method, the default first.
pub static REGISTRY: &[RegistryEntry] = &[
    super::confluence::entry::ENTRY,
    super::descent::entry::ENTRY,
    super::flood::entry::ENTRY,
    super::flood::entry::ENTRY_STEEPEST,
    super::flood::meyer::entry::ENTRY,
    super::partition::entry::ENTRY,
    super::kinematic::entry::ENTRY,
    super::certified::entry::ENTRY,
    #[cfg(feature = "drop")]
    super::drop::entry::ENTRY,
    super::transport::entry::ENTRY,
];

/// A line of the registry.
#[derive(Debug)]
pub struct RegistryEntry {
    /// Description of the method.
    pub info: &'static Info,
    read: fn(Value) -> Result<Method, serde_json::Error>,
}

impl RegistryEntry {
    /// The registry line of a method whose settings are read as `M`, with missing settings as in `{}`.
    pub const fn of<M: DecisionMethod + DeserializeOwned + 'static>(info: &'static Info) -> Self {
        Self::by(info, |settings| Ok(Method::new(serde_json::from_value::<M>(settings)?)))
    }

    /// The line of a method whose settings are read by `read`.
    pub const fn by(info: &'static Info, read: fn(Value) -> Result<Method, serde_json::Error>) -> Self {
        Self { info, read }
    }

    /// The method with its default settings.
    ///
    /// # Panics
    /// If a registered method cannot be read from no settings at all, which a test of the registry rules out.
    pub fn method(&self) -> Method {
        match (self.read)(json!({})) {
            Ok(method) => method,
            Err(error) => panic!("{} has no default settings: {error}", self.info.name),
        }
    }
}

/// Under this name a method has the settings of the motions that it follows.
pub(super) const MOTIONS: &str = "descent";

/// Any of the registered methods, with its settings.
///
/// As text its name; as JSON `{"name": …, "settings": {…}}`, settings that are missing being the defaults.
#[derive(Debug, Clone)]
pub struct Method(Arc<dyn DecisionMethod>);

impl Method {
    /// Every registered method with its default settings, the default method first.
    pub fn all() -> impl ExactSizeIterator<Item = Self> {
        REGISTRY.iter().map(RegistryEntry::method)
    }

    /// Methods whose result depends only on the grid and its resolution: the methods of resolution studies.
    pub fn on_grids() -> Vec<Self> {
        REGISTRY.iter().filter(|entry| entry.info.on_grids).map(RegistryEntry::method).collect()
    }

    /// A custom method, registered or not.
    pub fn new(method: impl DecisionMethod + 'static) -> Self {
        Self(Arc::new(method))
    }

    /// The lower-case name used in files, reports and options.
    pub fn name(&self) -> &'static str {
        self.info().name
    }

    /// This method with some of its settings changed.
    ///
    /// # Errors
    /// A setting that it does not have, that does not read, or that nothing can be decided with.
    pub fn with(&self, changes: &Map<String, Value>) -> Result<Self, MethodError> {
        if changes.is_empty() {
            return Ok(self.clone());
        }
        let mut settings = match self.settings() {
            Value::Object(settings) => settings,
            _ => Map::new(),
        };
        for (key, value) in changes {
            // Also of the motions that it follows.
            let motions = settings.get_mut(MOTIONS).and_then(Value::as_object_mut);
            if let Some(motions) = motions.filter(|motions| motions.contains_key(key)) {
                motions.insert(key.clone(), value.clone());
                continue;
            }
            if !settings.contains_key(key) {
                let owners = REGISTRY.iter().filter(|e| e.method().has(key));
                return Err(MethodError::NoSuchSetting {
                    method: self.name(),
                    setting: key.clone(),
                    owners: owners.map(|entry| entry.info.name).collect(),
                });
            }
            settings.insert(key.clone(), value.clone());
        }
        let method = Self::read(self.name(), Value::Object(settings))?;
        method
            .check()
            .map_err(|error| MethodError::Refused { method: method.name(), reason: error.to_string() })?;
        Ok(method)
    }

    /// Whether it has a setting of this name, or its motions have.
    pub fn has(&self, setting: &str) -> bool {
        let settings = self.settings();
        settings.get(setting).or_else(|| settings.get(MOTIONS)?.get(setting)).is_some()
    }

    fn read(name: &str, settings: Value) -> Result<Self, MethodError> {
        let Some(entry) = REGISTRY.iter().find(|entry| entry.info.name == name) else {
            let names = REGISTRY.iter().map(|entry| entry.info.name);
            let meant = nearest(name, names.clone()).map(str::to_owned);
            return Err(MethodError::Unknown { name: name.to_owned(), known: names.collect(), meant });
        };
        (entry.read)(settings)
            .map_err(|error| MethodError::Refused { method: entry.info.name, reason: error.to_string() })
    }
}

impl Deref for Method {
    type Target = dyn DecisionMethod;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl PartialEq for Method {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name() && self.settings() == other.settings()
    }
}

impl Default for Method {
    /// The first of the registry.
    fn default() -> Self {
        REGISTRY[0].method()
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Method {
    type Err = MethodError;

    fn from_str(name: &str) -> Result<Self, MethodError> {
        Self::read(name, json!({}))
    }
}

/// The form of a method in JSON.
#[derive(Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct Written {
    name: String,
    #[serde(default = "Value::default")]
    settings: Value,
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for Method {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Method".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Written::json_schema(generator)
    }
}

impl Serialize for Method {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Written { name: self.name().to_owned(), settings: self.settings() }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Method {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Written { name, settings } = Written::deserialize(deserializer)?;
        let settings = if settings.is_null() { json!({}) } else { settings };
        let method = Self::read(&name, settings).map_err(serde::de::Error::custom)?;
        method.check().map_err(serde::de::Error::custom)?;
        Ok(method)
    }
}

/// Why there is no such method.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MethodError {
    /// Nothing of that name is registered.
    #[error("there is no method `{name}`; {}", match meant {
        Some(meant) => format!("did you mean {meant}?"),
        None => format!("there are {}", known.join(", ")),
    })]
    Unknown {
        /// The requested name.
        name: String,
        /// The known names.
        known: Vec<&'static str>,
        /// The nearest of these.
        meant: Option<String>,
    },
    /// A setting of other methods, or an unknown setting.
    #[error("`{setting}` is {}; {method} has none", match owners.as_slice() {
        [] => "no setting of any method".to_owned(),
        owners => format!("a setting of {}", owners.join(" and ")),
    })]
    NoSuchSetting {
        /// The method.
        method: &'static str,
        /// The setting.
        setting: String,
        /// The methods that have it.
        owners: Vec<&'static str>,
    },
    /// A setting that does not read, or is out of its range.
    #[error("{method}: {reason}")]
    Refused {
        /// The method.
        method: &'static str,
        /// Why.
        reason: String,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Family;
    use crate::landscape::Resolution;
    use crate::pose::DofSet;
    use crate::problem::testing::problem;

    /// The accepted set may end at a simple fraction of the half range, so no default grid has centres there:
    /// for up to four axes up to sixths, for five at halves to fourths.
    #[test]
    fn centres_of_default_grids_keep_clear_of_simple_fractions() {
        let simple = problem(Family::Pyramid, DofSet::ALL);
        for method in Method::all() {
            for (axes, cells) in (1..).zip(method.default_cells(simple.pair())) {
                for denominator in 2..=(if axes < 5 { 6 } else { 4 }) {
                    assert!(
                        !Resolution::is_centred_on(cells, denominator),
                        "{}: {cells}, {denominator}",
                        method.name()
                    );
                }
            }
        }
    }
}
