//! The boundary as polygons, for pictures and files.

use super::{MAX_DIMENSION, Polytope, PolytopePoint, dot};

impl Polytope {
    /// The boundary as closed walks along edges, each a list of vertex indices: in three dimensions every facet,
    /// counter-clockwise seen from outside, in the order of [`Polytope::facets`]; in two the polygon itself, from the first
    /// axis towards the second. Nothing in other dimensions.
    ///
    /// Every edge of a polytope in three dimensions is walked twice, once each way.
    pub fn boundary(&self) -> Vec<Vec<usize>> {
        match self.dimension {
            2 => vec![
                self.walk(&(0..self.vertices.len()).collect::<Vec<_>>(), &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
            ],
            3 => (self.facets.iter().enumerate())
                .map(|(k, facet)| self.walk(&self.facet_vertices(k).collect::<Vec<_>>(), &facet.normal))
                .collect(),
            _ => Vec::new(),
        }
    }

    /// The vertices of a polygon in the order in which its edges join them, counter-clockwise against its `normal`.
    fn walk(&self, corners: &[usize], normal: &PolytopePoint) -> Vec<usize> {
        let mut left = corners.to_vec();
        let mut walked: Vec<usize> = left.pop().into_iter().collect();
        while let Some(&last) = walked.last()
            && let Some(next) = left.iter().position(|corner| self.is_edge(last, *corner))
        {
            walked.push(left.swap_remove(next));
        }
        let mut area = [0.0; MAX_DIMENSION];
        for pair in walked.windows(2) {
            let [origin, a, b] = [walked[0], pair[0], pair[1]].map(|k| &self.vertices[k]);
            for (k, sum) in area.iter_mut().enumerate().take(3) {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                *sum += (a[i] - origin[i]) * (b[j] - origin[j]) - (a[j] - origin[j]) * (b[i] - origin[i]);
            }
        }
        if dot(&area, normal) < 0.0 {
            walked.reverse();
        }
        walked
    }
}
