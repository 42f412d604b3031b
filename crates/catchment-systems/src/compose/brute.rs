//! The definition in plain loops: the reference for [`super::minkowski_sum`].
//!
//! A ⊕ B is the union of
//!
//! ```text
//!   a side of A ⊕ a side of B, for all pairs       (their outlines touch)
//!   A + b, for a corner b of every outline of B    (an outline of −B + d lies within A)
//!   B + a, for a corner a of every outline of A    (an outline of A lies within −B + d)
//! ```
//!
//! Proof: d is in the sum if A meets C = d − B. If their outlines touch, the first line applies. If they do
//! not and no outline of C lies in A, C has no border in A; then a part of A that meets C lies within it, and
//! with it its outlines: the third line. In the remaining case an outline of C touches none of A's and has a
//! point in A, so it lies within A, and its corner does: the second.

use super::region::{Node, Region, sides};
use super::sum::convex_sum;

/// The Minkowski sum without any decomposition. Takes the product of the numbers of sides, and more.
pub fn minkowski_sum(a: &Region, b: &Region) -> Region {
    let mut regions = Vec::new();
    for (one, other) in [(a, b), (b, a)] {
        for outline in one.nodes() {
            regions.push(moved(other, outline[0]));
        }
    }
    let mut pairs = Vec::new();
    for e in a.nodes().flat_map(sides) {
        pairs.extend(b.nodes().flat_map(sides).map(|f| convex_sum(&e, &f)).filter(|hull| hull.len() > 2));
    }
    regions.push(Region::of_nodes(&pairs));
    Region::union(&regions)
}

fn moved(region: &Region, by: Node) -> Region {
    let shift = |p: &Node| Node::new(p.x + by.x, p.y + by.y);
    Region {
        parts: region
            .parts
            .iter()
            .map(|part| part.iter().map(|o| o.iter().map(shift).collect()).collect())
            .collect(),
        thin: Vec::new(),
    }
}

/// Whether two regions have a point in common, decided from their sides and corners in whole numbers.
pub fn meet(a: &Region, b: &Region) -> bool {
    use super::region::{place, turn};
    let cross = |[p, q]: [Node; 2], [r, s]: [Node; 2]| {
        let side = |v: i128| v.signum();
        let (of_r, of_s) = (side(turn(p, q, r)), side(turn(p, q, s)));
        let (of_p, of_q) = (side(turn(r, s, p)), side(turn(r, s, q)));
        of_r * of_s < 0 && of_p * of_q < 0
    };
    let corner = |one: &Region, other: &Region| one.nodes().flatten().any(|p| other.contains(place(*p)));
    corner(a, b)
        || corner(b, a)
        || a.nodes().flat_map(sides).any(|e| b.nodes().flat_map(sides).any(|f| cross(e, f)))
}
