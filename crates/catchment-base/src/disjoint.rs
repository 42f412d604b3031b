//! Disjoint sets of numbers (union-find with path halving; Tarjan and van Leeuwen, *J. ACM* 31, 1984).
//!
//! ```text
//!   0   1   2   3      join(1, 3), join(0, 3)      0   2        the least member of a set leads it, so that
//!                      ───────────────────▶       ╱ ╲            results do not depend on the order of joins
//!                                                1   3
//! ```

/// Sets of the numbers from 0 on; each has the least of its members as its leader.
#[derive(Debug, Clone)]
pub struct DisjointSets(Vec<u32>);

impl DisjointSets {
    /// So many numbers, each in a set of its own.
    #[inline]
    pub fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// The leader of the set of a member.
    #[inline]
    pub fn find(&mut self, mut member: u32) -> u32 {
        while self.0[member as usize] != member {
            let above = self.0[self.0[member as usize] as usize];
            self.0[member as usize] = above;
            member = above;
        }
        member
    }

    /// Merges the sets of two members: returns the leader that stays and the leader that is removed, or
    /// nothing if they are already in the same set.
    #[inline]
    pub fn join(&mut self, a: u32, b: u32) -> Option<(u32, u32)> {
        let (a, b) = (self.find(a), self.find(b));
        if a == b {
            return None;
        }
        let (stays, goes) = (a.min(b), a.max(b));
        self.0[goes as usize] = stays;
        Some((stays, goes))
    }

    /// Puts the set of a leader under another leader, whichever is less.
    #[inline]
    pub fn put_under(&mut self, leader: u32, other: u32) {
        self.0[leader as usize] = other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Against components found by walking over all pairs again and again.
        #[test]
        fn sets_are_the_components_of_the_pairs_joined(pairs in proptest::collection::vec((0u32..20, 0u32..20), 0..30)) {
            let mut sets = DisjointSets::new(20);
            for (a, b) in &pairs {
                sets.join(*a, *b);
            }
            let mut least: Vec<u32> = (0..20).collect();
            for _ in 0..20 {
                for (a, b) in &pairs {
                    let low = least[*a as usize].min(least[*b as usize]);
                    (least[*a as usize], least[*b as usize]) = (low, low);
                }
            }
            prop_assert_eq!((0..20).map(|k| sets.find(k)).collect::<Vec<_>>(), least);
        }
    }
}
