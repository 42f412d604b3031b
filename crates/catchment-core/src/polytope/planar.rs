//! The convex hull of points of the plane, for any kind of number.

/// Corners of the convex hull, counter-clockwise, by Andrew's chains: the lower one from the left, the upper one from the right.
///
/// `sorted` has the points by x and then by y, none twice. `is_left(a, b, c)` says whether c lies to the left of the line from a
/// to b; what it says no to is no corner, so it decides alone what counts as straight, exactly for whole numbers or by a tolerance.
/// Two points are their own hull.
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
