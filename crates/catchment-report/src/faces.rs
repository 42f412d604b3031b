//! Several designs side by side with the offsets that they correct without rotation.

use super::document::Printed;
use super::envelope::{ReportBody, ReportEnvelope};
use super::zraa::{AcceptedOffsets, ZraaBody};
use catchment_core::document::{Document, Table};
use catchment_core::pose::Dof;
use serde::Serialize;
use std::borrow::Cow;

/// Designs side by side, with their head.
pub type FacesReport = ReportEnvelope<FacesBody>;

/// Designs side by side.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FacesBody {
    /// The offsets along x that each design corrects, in the given order.
    pub faces: Vec<ZraaBody>,
}

impl ReportBody for FacesBody {
    const KIND: &'static str = "zraa-faces";
}

/// Why designs do not stand side by side.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FacesError {
    /// A design has other free offsets than x.
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

    /// From designs whose offsets along x are known.
    ///
    /// # Errors
    /// Too many designs, or a design with other free offsets than x.
    pub fn new(faces: Vec<ZraaBody>) -> Result<Self, FacesError> {
        if faces.len() > Self::MOST {
            return Err(FacesError::TooMany { count: faces.len() });
        }
        let along_x =
            |face: &&ZraaBody| matches!(face.result, AcceptedOffsets::Interval { axis: Dof::X, .. });
        if let Some(other) = faces.iter().find(|face| !along_x(face)) {
            return Err(FacesError::NotAlongX { name: other.design.name.clone() });
        }
        Ok(Self::of(FacesBody { faces }, Vec::new(), None))
    }
}

impl Printed for FacesBody {
    fn title(&self) -> Cow<'_, str> {
        "offsets along x that are corrected without rotation".into()
    }

    /// A section per design; the table for programs has a bound if the halves meet along a single profile.
    fn document(&self) -> Document {
        let mut document = Document::default();
        let mut table = Table::data("name from to nilsson_bound nilsson_both");
        for face in &self.faces {
            face.result.describe(document.titled(Some(face.design.name.clone())), &face.design);
            if let AcceptedOffsets::Interval { from_d, to_d, nilsson, .. } = &face.result {
                let [bound, both] = [
                    nilsson.as_ref().map(|results| results.bound_d),
                    nilsson.as_ref().map(|results| results.both_d),
                ];
                table.push([
                    face.design.name.as_str().into(),
                    (*from_d).into(),
                    (*to_d).into(),
                    bound.into(),
                    both.into(),
                ]);
            }
        }
        document.table(table);
        document
    }
}
