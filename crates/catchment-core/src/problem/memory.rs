//! A problem from values in memory: no file, no path.

use super::{Draft, Problem, ProblemError, defect_keys};
use crate::connector::{Connector, Half, HalfSource};
use crate::design::{Alignment, ConnectorSpec, Design, HalfSpec, MeshContent, OwnSpec};
use glam::DVec3;

impl Problem {
    /// The problem of two halves, both drawn facing +z from their face centres, in D.
    ///
    /// # Errors
    /// Everything that is wrong with the geometry or the mated pose.
    pub fn new(fixed: HalfSource, moving: HalfSource, alignment: Alignment) -> Result<Self, ProblemError> {
        const FACE_HEIGHT: f64 = 0.0;
        let connector = Connector::from_sources(&fixed, &moving, FACE_HEIGHT, alignment.mount)
            .map_err(|problems| defect_keys::diagnostics(&problems))?;
        let contents = connector.contents.clone();
        let own = OwnSpec::new(
            FACE_HEIGHT,
            spec(fixed, &contents.fixed, &connector.fixed),
            spec(moving, &contents.moving, &connector.moving),
        );
        let name = "in memory".to_owned();
        let design = Design { name, connector: ConnectorSpec::Own(own), width: 1.0, unit: None, alignment };
        Draft::from(design).with_halves(connector, &crate::exec::Exec::new())
    }

    /// The problem of a design whose halves were built before, for example by the program that wrote a page:
    /// no file is read. The halves are in the frames of a [`Connector`]; the original coordinates are lost,
    /// so that [`Problem::drawn`] only knows those frames.
    ///
    /// # Errors
    /// Errors of the mated pose.
    pub fn of_halves(design: Design, fixed: Half, moving: Half) -> Result<Self, ProblemError> {
        Draft::from(design).with_halves(Connector::from_halves(fixed, moving), &crate::exec::Exec::new())
    }
}

/// Description of a half from a source for a design.
fn spec(source: HalfSource, contents: &[MeshContent], built: &Half) -> HalfSpec {
    match source {
        HalfSource::Pieces(pieces) => {
            HalfSpec::Pieces(pieces.iter().map(|piece| piece.iter().map(DVec3::to_array).collect()).collect())
        }
        HalfSource::Mesh { spec, .. } => HalfSpec::Mesh(spec),
        HalfSource::Parts(parts) => HalfSpec::Parts(parts.into_iter().map(|(part, _)| part).collect()),
        // A design of custom halves cannot name a half of a family, so its triangles are stored.
        HalfSource::Triangles(_) | HalfSource::Surface(_) | HalfSource::Family(_) => {
            HalfSpec::Memory { content: contents.first().cloned().unwrap_or_else(|| content_of(built)) }
        }
    }
}

/// The triangles of a half, as a mesh would hold them.
fn content_of(half: &Half) -> MeshContent {
    let (mut bytes, mut count) = (Vec::new(), 0);
    for surface in half.surfaces.iter().chain(&half.pieces) {
        for triangle in surface.triangles() {
            let corners = triangle.iter().flat_map(|k| surface.vertices[*k as usize].to_array());
            bytes.extend(corners.flat_map(f64::to_le_bytes));
            count += 1;
        }
    }
    MeshContent::of(&bytes, count)
}
