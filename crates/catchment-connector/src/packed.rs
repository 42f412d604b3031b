//! Binary form of a half, exact to the bit: for a page or process that computes with halves built elsewhere.
//!
//! ```text
//!   u32 surfaces, then of each:
//!     u32 vertices, facets, corners, edges, convex (0 or 1)
//!     f64 × 3 of each vertex, in D · f64 × 3 of each facet's normal
//!     u32 of each facet: its corners · u32 of each corner: its vertex · u32 × 4 of each edge: its ends, its facets
//! ```
//!
//! All values are little-endian, without padding. Reading checks that all values are in range, not that they
//! bound a solid.

use super::{Edge, Facet, Half, Surface};
use glam::DVec3;

/// Why bytes are no half.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum PackedError {
    /// There are fewer than announced, or more.
    #[error("the bytes of a half end too early or too late")]
    Length,
    /// A number of a vertex or of a facet is larger than there are.
    #[error("the bytes of a half name a corner or a facet that it does not have")]
    Index,
}

impl Half {
    /// Its surface as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let count = |bytes: &mut Vec<u8>, count: usize| bytes.extend((count as u32).to_le_bytes());
        count(&mut bytes, self.surfaces.len());
        for surface in &self.surfaces {
            let corners = surface.facets.iter().map(|facet| facet.corners.len()).sum();
            let Surface { vertices, facets, edges, convex } = surface;
            for number in [vertices.len(), facets.len(), corners, edges.len(), usize::from(*convex)] {
                count(&mut bytes, number);
            }
            let points = vertices.iter().copied().chain(facets.iter().map(|facet| facet.normal));
            bytes.extend(points.flat_map(|point| point.to_array()).flat_map(f64::to_le_bytes));
            for facet in facets {
                count(&mut bytes, facet.corners.len());
            }
            let corners = facets.iter().flat_map(|facet| facet.corners.iter().copied());
            let edges = edges.iter().flat_map(|edge| edge.ends.into_iter().chain(edge.facets));
            bytes.extend(corners.chain(edges).flat_map(u32::to_le_bytes));
        }
        bytes
    }

    /// A half from the bytes of its surface.
    ///
    /// # Errors
    /// The bytes are of no half.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PackedError> {
        let mut rest = Rest(bytes);
        let surfaces = (0..rest.count()?).map(|_| rest.surface()).collect::<Result<_, _>>()?;
        if rest.0.is_empty() { Ok(Self::of(surfaces)) } else { Err(PackedError::Length) }
    }
}

/// The bytes that are not read yet.
struct Rest<'a>(&'a [u8]);

impl Rest<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], PackedError> {
        let (first, rest) = self.0.split_first_chunk().ok_or(PackedError::Length)?;
        self.0 = rest;
        Ok(*first)
    }

    fn count(&mut self) -> Result<u32, PackedError> {
        self.take().map(u32::from_le_bytes)
    }

    fn point(&mut self) -> Result<DVec3, PackedError> {
        let mut number = || self.take().map(f64::from_le_bytes);
        Ok(DVec3::new(number()?, number()?, number()?))
    }

    /// A number below `end`.
    fn index(&mut self, end: u32) -> Result<u32, PackedError> {
        let index = self.count()?;
        if index < end { Ok(index) } else { Err(PackedError::Index) }
    }

    fn surface(&mut self) -> Result<Surface, PackedError> {
        let [vertices, facets, corners, edges, convex] =
            [self.count()?, self.count()?, self.count()?, self.count()?, self.count()?];
        let points = (0..vertices).map(|_| self.point()).collect::<Result<Vec<_>, _>>()?;
        let normals = (0..facets).map(|_| self.point()).collect::<Result<Vec<_>, _>>()?;
        let counts = (0..facets).map(|_| self.count()).collect::<Result<Vec<_>, _>>()?;
        if counts.iter().map(|count| u64::from(*count)).sum::<u64>() != u64::from(corners) {
            return Err(PackedError::Length);
        }
        let facet = |(normal, count): (DVec3, u32)| {
            let corners = (0..count).map(|_| self.index(vertices)).collect::<Result<Vec<_>, _>>()?;
            Ok(Facet { corners, normal })
        };
        let list = normals.into_iter().zip(counts).map(facet).collect::<Result<Vec<_>, _>>()?;
        let edge = |_| {
            let ends = [self.index(vertices)?, self.index(vertices)?];
            Ok(Edge { ends, facets: [self.index(facets)?, self.index(facets)?] })
        };
        let edges = (0..edges).map(edge).collect::<Result<Vec<_>, _>>()?;
        Ok(Surface { vertices: points, facets: list, edges, convex: convex != 0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Connector;
    use catchment_base::pose::Mount;
    use catchment_design::design::{Family, FamilySpec};

    #[test]
    fn packed_halves_unpack_equal() {
        for family in Family::ALL {
            let connector = Connector::of_family(&FamilySpec::new(family), Mount::X).unwrap();
            for half in [connector.fixed, connector.moving] {
                let bytes = half.to_bytes();
                assert_eq!(Half::from_bytes(&bytes), Ok(half));
                for length in [0, 3, 4, 23, bytes.len() / 2, bytes.len() - 1] {
                    assert_eq!(Half::from_bytes(&bytes[..length]), Err(PackedError::Length), "{length}");
                }
                let longer = [&bytes[..], &[0]].concat();
                assert_eq!(Half::from_bytes(&longer), Err(PackedError::Length));
                let mut spoilt = bytes.clone();
                let last = spoilt.len() - 4;
                spoilt[last..].copy_from_slice(&u32::MAX.to_le_bytes());
                assert_eq!(Half::from_bytes(&spoilt), Err(PackedError::Index));
            }
        }
    }

    #[test]
    fn announced_sizes_beyond_the_data_take_no_memory() {
        let huge = [1, u32::MAX, u32::MAX, u32::MAX, u32::MAX, 1].map(u32::to_le_bytes).concat();
        assert_eq!(Half::from_bytes(&huge), Err(PackedError::Length));
    }
}
