//! The triangles at each edge.

/// A side of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Side {
    /// Its ends, the lower number first.
    pub(super) edge: [u32; 2],
    /// Whose side it is.
    pub(super) triangle: u32,
    /// Whether the triangle runs along it from the lower number to the higher.
    pub(super) is_up: bool,
}

/// The sides of all triangles, in the order of their edges and, along each, of the triangles.
#[derive(Debug)]
pub(super) struct Sides(Vec<Side>);

impl Sides {
    pub(super) fn of(triangles: &[[u32; 3]]) -> Self {
        let mut sides = Vec::with_capacity(3 * triangles.len());
        for (k, t) in triangles.iter().enumerate() {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                // A side without length belongs to a triangle without area, which is reported as such.
                if a != b {
                    sides.push(Side { edge: [a.min(b), a.max(b)], triangle: k as u32, is_up: a < b });
                }
            }
        }
        sides.sort_unstable();
        Self(sides)
    }

    /// Edge by edge, the sides along it.
    pub(super) fn edges(&self) -> impl Iterator<Item = &[Side]> {
        self.0.chunk_by(|a, b| a.edge == b.edge)
    }
}
