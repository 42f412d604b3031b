//! The convex hull of points of the plane, for any kind of number.

/// Corners of the convex hull, counter-clockwise, by Andrew's chains: the lower chain from the left, the
/// upper chain from the right.
///
/// `sorted` has the points by x and then by y, without duplicates. `is_left(a, b, c)` decides whether c lies
/// to the left of the line from a to b; a point for which it is false is not a corner, so it alone defines a
/// straight angle, exactly for integers or by a tolerance. Two points are their own hull.
pub fn planar_hull<P: Copy>(sorted: &[P], is_left: impl Fn(P, P, P) -> bool) -> Vec<P> {
    if sorted.len() < 3 {
        return sorted.to_vec();
    }
    let chain = |points: &mut dyn Iterator<Item = &P>| {
        let mut chain: Vec<P> = Vec::new();
        for &p in points {
            while chain.len() > 1 && !is_left(chain[chain.len() - 2], chain[chain.len() - 1], p) {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut sorted.iter());
    hull.extend(chain(&mut sorted.iter().rev()));
    hull
}
