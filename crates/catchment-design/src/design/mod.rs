//! The user's design, typed: the connector and the alignment problem that it must solve.
//!
//! ```text
//! design.toml ──load──▶ text ──read──▶ DesignFile { design, sources }
//!                              └─────▶ Problems: all of them, each with line, column and advice
//! ```
//!
//! A [`Design`] is resolved: all units are converted (lengths in D, angles in radians), defaults are filled
//! in, and every number has been checked. The next crate, `catchment-connector`, builds geometry from it and
//! checks that geometry; this module does not know whether halves fit.
//!
//! The table [`keys`] lists the content of a design file; the reader, the JSON schema for editors
//! ([`json_schema`]) and the commented starting points ([`template`]) all derive from it.

mod alignment;
mod content;
mod defect;
mod digest;
mod docked;
mod edit;
pub mod family;
pub mod keys;
mod load;
mod located_defect;
mod mesh_preparation;
mod model;
mod name;
mod overrides;
mod part;
mod placed;
mod quantity;
mod read;
mod read_half;
mod reader;
mod schema;
mod section;
mod template;
#[cfg(test)]
mod tests;

pub use alignment::Alignment;
pub use catchment_base::diagnostic::{FilesInMemory, SourceText};
pub use catchment_base::suggest::nearest;
pub use content::hex;
pub use content::{Contents, MeshContent, Meshed};
pub use defect::{DesignDefect, Dimension};
pub use docked::Docked;
pub use edit::{key_path, with_key};
pub use family::{Family, FamilySpec};
pub use load::{LoadError, load};
pub use located_defect::{LocatedDefect, LocatedDefects, Sources};
pub use mesh_preparation::{MeshPreparation, Repairs};
pub use model::{ConnectorSpec, Design, HalfSpec, LengthUnit, OwnSpec, WidthFrom};
pub use name::DesignParameter;
pub use overrides::parse_dofs;
pub use part::{FileSpec, FileUnit, OutlineSpec, PartSpec, ShapeSpec};
pub use placed::{DrawnFrames, PartPlacement};
pub use quantity::shortened;
pub use quantity::{LengthScale, Quantity, QuantityUnit};
pub use read::{DesignFile, LARGEST_FILE, Width, read, read_as};
pub use schema::json_schema;
pub use template::template;
