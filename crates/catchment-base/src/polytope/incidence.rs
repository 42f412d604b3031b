//! Incidence of vertices and facets: a matrix of bits, a row per vertex.
//!
//! This is all the combinatorial information that a cut needs. Two vertices are joined by an edge if they
//! share at least dimension − 1 facets and no third vertex lies on all the facets they share. A single
//! allocation holds all rows, and the number of facets is not limited; for up to 64 facets a row is one word.

/// Facets in a word.
const WORD: usize = u64::BITS as usize;

/// Rows of bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Incidence {
    /// Words in a row, at least 1.
    width: usize,
    words: Vec<u64>,
}

impl Incidence {
    /// No vertex yet, room for `vertices` of them on `facets` facets.
    pub(super) fn new(vertices: usize, facets: usize) -> Self {
        let width = facets.div_ceil(WORD).max(1);
        Self { width, words: Vec::with_capacity(vertices * width) }
    }

    /// Adds a vertex, on these facets.
    pub(super) fn push(&mut self, facets: impl IntoIterator<Item = usize>) {
        let start = self.words.len();
        self.words.resize(start + self.width, 0);
        for facet in facets {
            self.words[start + facet / WORD] |= 1 << (facet % WORD);
        }
    }

    /// The facets of a vertex.
    pub(super) fn row(&self, vertex: usize) -> &[u64] {
        &self.words[vertex * self.width..(vertex + 1) * self.width]
    }

    /// How many vertices there are.
    pub(super) fn rows(&self) -> usize {
        self.words.len() / self.width
    }

    /// Does this vertex lie on this facet?
    pub(super) fn has(&self, vertex: usize, facet: usize) -> bool {
        self.words[vertex * self.width + facet / WORD] >> (facet % WORD) & 1 == 1
    }

    /// Is there an edge between these vertices of a polytope in this dimension?
    pub(super) fn joined(&self, a: usize, b: usize, dimension: usize) -> bool {
        let (row_a, row_b) = (self.row(a), self.row(b));
        let shared: u32 = row_a.iter().zip(row_b).map(|(a, b)| (a & b).count_ones()).sum();
        shared as usize + 1 >= dimension
            && !self.words.chunks_exact(self.width).enumerate().any(|(third, row)| {
                third != a
                    && third != b
                    && row.iter().zip(row_a).zip(row_b).all(|((row, a), b)| a & b & !row == 0)
            })
    }

    /// Could these be the faces of a polytope of this dimension? Edges and ridges close (see [`Self::joins`]), and up to
    /// four dimensions their numbers obey Euler's relation.
    ///
    /// Vertices that were put on a facet by mistake hide edges from each other, which this finds.
    pub(super) fn is_sound(&self, dimension: usize, facets: usize) -> bool {
        let vertices = self.rows();
        let mut turned = Self::new(facets, vertices);
        for facet in 0..facets {
            turned.push((0..vertices).filter(|vertex| self.has(*vertex, facet)));
        }
        let (Some(edges), Some(ridges)) = (self.joins(dimension, facets), turned.joins(dimension, vertices))
        else {
            return false;
        };
        match dimension {
            2 => vertices == facets,
            3 => edges == ridges && vertices + facets == edges + 2,
            4 => vertices + ridges == edges + facets,
            _ => true,
        }
    }

    /// The number of edges; `None` if a vertex has fewer than dimension of them, or, within a facet, fewer
    /// than dimension − 1 (in three dimensions, other than two). For the transposed matrix, in which ridges
    /// join facets, the same holds for the dual polytope.
    fn joins(&self, dimension: usize, facets: usize) -> Option<usize> {
        let vertices = self.rows();
        let mut within = vec![0usize; vertices * facets];
        let mut degrees = vec![0usize; vertices];
        for a in 0..vertices {
            for b in a + 1..vertices {
                if self.joined(a, b, dimension) {
                    for end in [a, b] {
                        degrees[end] += 1;
                        for facet in ones(self.row(a).iter().zip(self.row(b)).map(|(a, b)| a & b)) {
                            within[end * facets + facet] += 1;
                        }
                    }
                }
            }
        }
        let closed = |vertex: usize, facet: usize| {
            let count = within[vertex * facets + facet] + 1;
            if dimension == 3 { count == dimension } else { count >= dimension }
        };
        let all = degrees.iter().enumerate().all(|(vertex, degree)| {
            *degree >= dimension && ones(self.row(vertex).iter().copied()).all(|facet| closed(vertex, facet))
        });
        (all && vertices > dimension).then(|| degrees.iter().sum::<usize>() / 2)
    }
}

/// The places of the bits that are set.
pub(super) fn ones(words: impl IntoIterator<Item = u64>) -> impl Iterator<Item = usize> {
    words.into_iter().enumerate().flat_map(|(index, word)| {
        std::iter::successors(Some(word), |w| Some(w & w.wrapping_sub(1)))
            .take_while(|w| *w != 0)
            .map(move |w| index * WORD + w.trailing_zeros() as usize)
    })
}
