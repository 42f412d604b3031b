//! Several designs side by side by the offsets that they correct without rotation: JSON, text, a table for programs.

use super::envelope::{Body, Envelope};
use super::text::number;
use super::zraa::{ZraaBody, ZraaFound};
use catchment_core::pose::Dof;
use serde::Serialize;

/// Designs side by side, with their head.
pub type FacesReport = Envelope<FacesBody>;

/// Designs side by side.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FacesBody {
    /// What each corrects along x, in the order given.
    pub faces: Vec<ZraaBody>,
}

impl Body for FacesBody {
    const KIND: &'static str = "zraa-faces";
}

/// Why designs do not stand side by side.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FacesError {
    /// One of them is not about x alone.
    #[error(
        "side by side stand offsets along x alone, and those of {name} are others: let x be its only free offset"
    )]
    NotAlongX {
        /// The name of the design.
        name: String,
    },
    /// They would not fit into a picture.
    #[error("{count} designs do not fit side by side: name at most {}", FacesReport::MOST)]
    TooMany {
        /// How many there are.
        count: usize,
    },
}

impl FacesReport {
    /// Most designs: more would be too small to see.
    pub const MOST: usize = 12;

    /// Of designs whose offsets along x are known.
    ///
    /// # Errors
    /// Too many, or one that is not about x alone.
    pub fn new(faces: Vec<ZraaBody>) -> Result<Self, FacesError> {
        if faces.len() > Self::MOST {
            return Err(FacesError::TooMany { count: faces.len() });
        }
        let along_x = |face: &&ZraaBody| matches!(face.found, ZraaFound::Interval { axis: Dof::X, .. });
        if let Some(other) = faces.iter().find(|face| !along_x(face)) {
            return Err(FacesError::NotAlongX { name: other.design.name.clone() });
        }
        Ok(Self::of(FacesBody { faces }, Vec::new(), None))
    }

    /// One after another for a person.
    pub fn table(&self) -> String {
        let tables: Vec<String> = self.faces.iter().map(ZraaBody::table).collect();
        tables.join("\n")
    }

    /// A record per design for programs, the names of the columns first, in D; a bound is empty where the halves do not
    /// meet along one profile.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = ["name", "from", "to", "nilsson_bound", "nilsson_both"];
        let mut records = vec![head.map(str::to_owned).to_vec()];
        for face in &self.faces {
            let ZraaFound::Interval { from_d, to_d, nilsson, .. } = &face.found else { continue };
            let [bound, both] = nilsson
                .as_ref()
                .map_or_else(<[String; 2]>::default, |found| [found.bound_d, found.both_d].map(number));
            records.push(vec![face.design.name.clone(), number(*from_d), number(*to_d), bound, both]);
        }
        records
    }
}
