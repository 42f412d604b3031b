//! Volume and centroid.
//!
//! A face is the union of the cones from one of its vertices over its own facets that do not contain that
//! vertex, and so on down to simplices, whose volumes are determinants, all taken positive, so that nothing
//! cancels. Errors are a few units of the last place of the volume of the bounding box.
//!
//! The facets of a face are its intersections with the polytope's facets that are maximal by inclusion.

use super::incidence::ones;
use super::{MAX_DIMENSION, Polytope, PolytopePoint};

/// Simplices, summed up.
#[derive(Default)]
struct Sum {
    volume: f64,
    /// Volume times centroid.
    moment: PolytopePoint,
}

impl Polytope {
    /// Length, area or volume, in D and rad to the power of the dimension.
    pub fn volume(&self) -> f64 {
        self.measured().volume
    }

    /// The centre of mass.
    pub fn centroid(&self) -> PolytopePoint {
        let sum = self.measured();
        sum.moment.map(|c| c / sum.volume)
    }

    fn measured(&self) -> Sum {
        let mut sum = Sum::default();
        let all: Vec<usize> = (0..self.vertices.len()).collect();
        self.measure(&all, self.dimension, &mut Vec::with_capacity(MAX_DIMENSION + 1), &mut sum);
        sum
    }

    /// Adds the cones from the chosen apexes over a face of this dimension.
    fn measure(&self, face: &[usize], dimension: usize, apexes: &mut Vec<usize>, sum: &mut Sum) {
        if face.len() <= dimension + 1 {
            let first = apexes.len();
            apexes.extend(face);
            self.add(apexes, sum);
            apexes.truncate(first);
            return;
        }
        let apex = face[0];
        let counts: Vec<usize> = (0..self.facets.len())
            .map(|facet| face.iter().filter(|v| self.incidence.has(**v, facet)).count())
            .collect();
        apexes.push(apex);
        for (facet, &count) in counts.iter().enumerate() {
            if count < dimension || count == face.len() || self.incidence.has(apex, facet) {
                continue;
            }
            let side: Vec<usize> =
                face.iter().copied().filter(|vertex| self.incidence.has(*vertex, facet)).collect();
            // All facets that contain the side. The side is a facet of the face if none of them contains more
            // vertices of the face, except those that contain the whole face; it is counted for the first of
            // them.
            let mut holding = self.incidence.row(side[0]).to_vec();
            for vertex in &side[1..] {
                for (all, word) in holding.iter_mut().zip(self.incidence.row(*vertex)) {
                    *all &= word;
                }
            }
            let mut others = ones(holding.iter().copied()).filter(|f| counts[*f] != face.len());
            if others.all(|f| counts[f] == count && f >= facet) {
                self.measure(&side, dimension - 1, apexes, sum);
            }
        }
        apexes.pop();
    }

    /// Adds the simplex with these corners.
    fn add(&self, corners: &[usize], sum: &mut Sum) {
        let origin = &self.vertices[corners[0]];
        let mut rows = [[0.0; MAX_DIMENSION]; MAX_DIMENSION];
        let mut middle = *origin;
        for (row, corner) in rows.iter_mut().zip(&corners[1..]) {
            let vertex = &self.vertices[*corner];
            *row = std::array::from_fn(|axis| vertex[axis] - origin[axis]);
            for (middle, c) in middle.iter_mut().zip(vertex) {
                *middle += c;
            }
        }
        let factorial: f64 = (1..=self.dimension).map(|k| k as f64).product();
        let volume = determinant(&mut rows[..self.dimension]).abs() / factorial;
        sum.volume += volume;
        for (moment, c) in sum.moment.iter_mut().zip(middle) {
            *moment += volume * c / corners.len() as f64;
        }
    }
}

/// The determinant of the leading square, by elimination with the largest pivot of each column.
fn determinant(rows: &mut [PolytopePoint]) -> f64 {
    let mut product = 1.0;
    for column in 0..rows.len() {
        let mut pivot = column;
        for row in column + 1..rows.len() {
            if rows[row][column].abs() > rows[pivot][column].abs() {
                pivot = row;
            }
        }
        rows.swap(column, pivot);
        let (done, rest) = rows.split_at_mut(column + 1);
        let top = &done[column];
        if top[column] == 0.0 {
            return 0.0;
        }
        product *= if pivot == column { top[column] } else { -top[column] };
        for row in rest {
            let factor = row[column] / top[column];
            for (c, t) in row.iter_mut().zip(top).skip(column) {
                *c -= factor * t;
            }
        }
    }
    product
}
