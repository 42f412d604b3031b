//! The five components of a pose error, and sets of them.

use crate::suggest::nearest;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// One of the five components of a pose error.
///
/// Written and read ([`FromStr`]) by its lower-case name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Dof {
    /// Lateral offset along x, in D.
    X,
    /// Lateral offset along y, in D.
    Y,
    /// Rotation about x, in radians; applied first.
    Roll,
    /// Rotation about y, in radians; applied second.
    Pitch,
    /// Rotation about the approach axis z, in radians; applied last.
    Yaw,
}

impl Dof {
    /// All five, in the order used by every array of five numbers.
    pub const ALL: [Self; 5] = [Self::X, Self::Y, Self::Roll, Self::Pitch, Self::Yaw];

    /// Position in [`Dof::ALL`].
    #[inline]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The lower-case name used in files and reports.
    #[inline]
    pub const fn name(self) -> &'static str {
        ["x", "y", "roll", "pitch", "yaw"][self.index()]
    }

    /// Whether this is an angle (radians) rather than a length (D).
    #[inline]
    pub const fn is_rotation(self) -> bool {
        self.index() >= 2
    }
}

impl fmt::Display for Dof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A word that names no degree of freedom.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownDof {
    /// The text as written, cut to [`UnknownDof::LONGEST`] characters.
    pub name: String,
    /// The name that was probably meant.
    pub meant: Option<Dof>,
}

impl UnknownDof {
    /// Number of characters that are kept of the text.
    pub const LONGEST: usize = 64;
}

impl fmt::Display for UnknownDof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "there is no axis `{}`; ", self.name)?;
        match self.meant {
            Some(dof) => write!(f, "did you mean {dof}?"),
            None => f.write_str("the axes are x, y, roll, pitch and yaw"),
        }
    }
}

impl std::error::Error for UnknownDof {}

impl FromStr for Dof {
    type Err = UnknownDof;

    /// The degree of freedom with exactly this name.
    fn from_str(name: &str) -> Result<Self, UnknownDof> {
        Self::ALL.into_iter().find(|dof| dof.name() == name).ok_or_else(|| {
            let meant = nearest(name, Self::ALL.map(Self::name));
            // Any single letter has edit distance 1 from x.
            let near = |dof: &Self| {
                meant == Some(dof.name()) && (name.len() > 1 || name.eq_ignore_ascii_case(dof.name()))
            };
            UnknownDof {
                name: name.chars().take(UnknownDof::LONGEST).collect(),
                meant: Self::ALL.into_iter().find(near),
            }
        })
    }
}

/// A set of degrees of freedom.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DofSet(u8);

impl DofSet {
    /// No degree of freedom.
    pub const EMPTY: Self = Self(0);
    /// All five.
    pub const ALL: Self = Self(0b1_1111);

    /// Whether `dof` belongs to the set.
    #[inline]
    pub const fn contains(self, dof: Dof) -> bool {
        self.0 & (1 << dof.index()) != 0
    }

    /// This set with `dof` added.
    #[must_use]
    #[inline]
    pub const fn with(self, dof: Dof) -> Self {
        Self(self.0 | (1 << dof.index()))
    }

    /// This set with `dof` removed.
    #[must_use]
    #[inline]
    pub const fn without(self, dof: Dof) -> Self {
        Self(self.0 & !(1 << dof.index()))
    }

    /// The members in the order of [`Dof::ALL`].
    #[inline]
    pub fn iter(self) -> impl Iterator<Item = Dof> {
        Dof::ALL.into_iter().filter(move |d| self.contains(*d))
    }

    /// How many members.
    #[inline]
    pub const fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether there is no member.
    #[inline]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// How many of roll, pitch and yaw belong to the set.
    #[inline]
    pub const fn rotations(self) -> usize {
        (self.0 >> 2).count_ones() as usize
    }
}

/// Names with commas: `x, y, yaw`.
impl fmt::Display for DofSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.iter().map(Dof::name).collect();
        f.pad(&names.join(", "))
    }
}

impl FromIterator<Dof> for DofSet {
    fn from_iter<I: IntoIterator<Item = Dof>>(iter: I) -> Self {
        iter.into_iter().fold(Self::EMPTY, Self::with)
    }
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for DofSet {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "DofSet".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Vec::<Dof>::json_schema(generator)
    }
}

impl Serialize for DofSet {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

impl<'de> Deserialize<'de> for DofSet {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Vec::<Dof>::deserialize(deserializer)?.into_iter().collect())
    }
}

/// Unit of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum ErrorUnit {
    /// Widths of the connector.
    D,
    /// Radians.
    #[serde(rename = "rad")]
    Rad,
}

impl ErrorUnit {
    /// The unit of an error.
    #[inline]
    pub const fn of(dof: Dof) -> Self {
        if dof.is_rotation() { Self::Rad } else { Self::D }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for dof in Dof::ALL {
            assert_eq!(dof.to_string().parse(), Ok(dof));
        }
        assert_eq!(format!("{:>6}|{:<4}|", Dof::Yaw, Dof::X), "   yaw|x   |");
    }

    #[test]
    fn a_misspelt_axis_gets_a_suggestion() {
        let error = |name: &str| name.parse::<Dof>().unwrap_err();
        assert_eq!(error("ptich").meant, Some(Dof::Pitch));
        assert_eq!(error("Yaw").to_string(), "there is no axis `Yaw`; did you mean yaw?");
        assert_eq!((error("z").meant, error("X").meant), (None, Some(Dof::X)));
        assert_eq!(
            error("surge").to_string(),
            "there is no axis `surge`; the axes are x, y, roll, pitch and yaw"
        );
        assert_eq!(error(&"ü".repeat(100_000)).name.chars().count(), UnknownDof::LONGEST);
    }
}
