//! The outline of a layer, derived from the dissertation's sentences.
//!
//! 1. The arm's profile y = f(x) from the outer edge to the hook at xₑ = L/2 + o/2.
//! 2. The hook: down to y = 0, back under the overhang to L/2 − o/2, down to −h: the trench for the partner's
//!    hook.
//! 3. The same profile rotated by 180° about (L/2, 0), down to −f(0) at x = L.
//! 4. The stop slit, cut into it from above; left of it the neck, left of that the cut-out, open at the outer
//!    edge. Only the neck carries the arm.
//! 5. The body below, to which everything is fixed.
//!
//! The slit lies right of the hook, inside the part, although its distance is stated without a reference: f
//! falls everywhere and its tangent at the hook passes through P (both stated), so that P lies below and to
//! the *right* of the hook. Pressing then pushes the hook outward with the longest lever, tension turns the
//! arm clockwise, closes the slit and drives the hook deeper into the partner's trench, all as stated.
//! Fifteen millimetres from the outer edge would put P on the left.
//!
//! Curves are polylines whose corners lie on the curve; chords deviate by less than [`CHORD`]. Both halves
//! share their corners, so that they mate without gap or overlap.

use super::LatchDesign;
use super::profile::ArmProfile;
use glam::DVec2;

/// Steps of the profile.
const STEPS: usize = 256;
/// Largest distance of a chord from the curve, in mm: a fiftieth of a usual kerf. A test checks it at the
/// defaults.
pub const CHORD: f64 = 0.004;
/// Halvings of the search for the end angle: down to the last bit.
const HALVINGS: usize = 200;
/// The steepest end angle that is tried, in rad: beyond it the profile is a wall.
const STEEPEST: f64 = 89.9 * std::f64::consts::PI / 180.0;

/// Knots closer than this are equal, in mm: rounding.
const SAME: f64 = 1e-9;

/// A closed curve, counter-clockwise, without its first point at the end.
pub type Polygon = Vec<DVec2>;

/// Why there is no outline.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// The pivot is not to the right of the hook.
    #[error(
        "the neck must stand right of the hook: its middle is at x = {pivot:.2} mm, the hook ends at {hook:.2} mm"
    )]
    PivotLeft {
        /// x of the middle of the neck.
        pivot: f64,
        /// x of the end of the hook.
        hook: f64,
    },
    /// The slit leaves the face.
    #[error("the slit lies outside the face: it ends at x = {slit:.2} mm of {width:.2} mm")]
    SlitOutside {
        /// Its far side.
        slit: f64,
        /// The face.
        width: f64,
    },
    /// The tangent that passes through P is flatter than the start: the curve would have to bend upwards.
    #[error(
        "no falling profile of negative curvature ends in a tangent through P: it would start at {start:.1}° and end at no more"
    )]
    NoProfile {
        /// Its angle at the outer edge, in degrees.
        start: f64,
    },
}

impl GeometryError {
    /// The key of the design file that it is about.
    pub const fn key(&self) -> &'static str {
        match self {
            Self::PivotLeft { .. } | Self::SlitOutside { .. } => "slit_distance",
            Self::NoProfile { .. } => "spline_start",
        }
    }

    /// Advice.
    pub const fn help(&self) -> &'static str {
        match self {
            Self::PivotLeft { .. } => "a larger slit_distance moves it; 15 mm was found to be sufficient",
            Self::SlitOutside { .. } => "a smaller slit_distance moves it inward",
            Self::NoProfile { .. } => {
                "start flatter (35 deg was found to be best), or put P lower: cutout_depth and l_eq decide it"
            }
        }
    }
}

/// The outline of a layer in numbers; mm.
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// Width of the face.
    pub width: f64,
    /// Overhang.
    pub overhang: f64,
    /// The arm's profile.
    pub profile: ArmProfile,
    /// The middle of the neck, about which the arm turns.
    pub pivot: DVec2,
    /// Thickness of the neck.
    pub neck: f64,
    /// Near and far side of the stop slit.
    pub slit: [f64; 2],
    /// Its lower end.
    pub slit_end: f64,
    /// Lower and upper side of the cut-out.
    pub cutout: [f64; 2],
    /// The lower edge.
    pub bottom: f64,
    /// Middles of the dowel holes, and their diameter.
    pub dowels: Option<([DVec2; 2], f64)>,
}

impl Geometry {
    /// The outline that follows from the parameters.
    ///
    /// # Errors
    /// No profile meets them.
    pub fn of(latch: &LatchDesign) -> Result<Self, GeometryError> {
        let middle = 0.5 * latch.width;
        let x_end = middle + 0.5 * latch.overhang;
        let near = middle + latch.slit_distance;
        let slit = [near, near + latch.slit_gap];
        let pivot_x = near - 0.5 * latch.neck;
        if pivot_x <= x_end {
            return Err(GeometryError::PivotLeft { pivot: pivot_x, hook: x_end });
        }
        if slit[1] >= latch.width {
            return Err(GeometryError::SlitOutside { slit: slit[1], width: latch.width });
        }
        let face = |profile: &ArmProfile| -profile.height(latch.width - near);
        let pivot_y = |profile: &ArmProfile| face(profile) - latch.cutout_depth + 0.5 * latch.l_eq;
        let end = match latch.spline_end {
            Some(end) => end,
            None => through_pivot(latch, pivot_x, &pivot_y)?,
        };
        let profile = ArmProfile::of(latch, end);
        let (face, bottom) = (face(&profile), -latch.base);
        let slit_end = face - latch.slit_depth;
        let dowels = latch.dowel.map(|diameter| {
            let y = 0.5 * (slit_end + bottom);
            ([DVec2::new(0.2 * latch.width, y), DVec2::new(0.8 * latch.width, y)], diameter)
        });
        Ok(Self {
            width: latch.width,
            overhang: latch.overhang,
            profile,
            pivot: DVec2::new(pivot_x, pivot_y(&profile)),
            neck: latch.neck,
            slit,
            slit_end,
            cutout: [face - latch.cutout_depth, face - latch.cutout_depth + latch.l_eq],
            bottom,
            dowels,
        })
    }

    /// Lever from P to the hook's upper corner: across and up, both positive.
    pub fn lever(&self) -> DVec2 {
        DVec2::new(self.pivot.x - self.profile.x_end, self.profile.hook - self.pivot.y)
    }

    /// Distance at which the tangent at the hook passes P.
    pub fn tangent_miss(&self) -> f64 {
        let lever = self.lever();
        let (sin, cos) = self.profile.end.sin_cos();
        (lever.x * sin - lever.y * cos).abs()
    }

    /// Height of the arm's outer edge, the highest point: f(0).
    pub fn height(&self) -> f64 {
        self.profile.height(0.0)
    }

    /// x of the face's corners, left half: even steps, and the places that the slit cuts in the turned half.
    fn knots(&self) -> Vec<f64> {
        let x_end = self.profile.x_end;
        let mut knots: Vec<f64> = (0..=STEPS).map(|k| x_end * k as f64 / STEPS as f64).collect();
        for x in self.slit {
            let x = self.width - x;
            // A knot that all but coincides would leave an edge without direction.
            knots.retain(|k| (k - x).abs() > 1e-3 * x_end / STEPS as f64 || *k == 0.0 || *k == x_end);
            knots.push(x);
        }
        knots.retain(|x| (0.0..=x_end).contains(x));
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        knots
    }

    /// The profile of the arm from the outer edge to the hook.
    pub fn arm_profile(&self) -> Vec<DVec2> {
        self.knots().into_iter().map(|x| DVec2::new(x, self.profile.height(x))).collect()
    }

    /// The point turned by 180° about the middle of the overhang.
    pub fn turned(&self, p: DVec2) -> DVec2 {
        DVec2::new(self.width - p.x, -p.y)
    }

    /// The face from the outer edge to the lowest point, with the hook.
    pub fn face(&self) -> Vec<DVec2> {
        let arm = self.arm_profile();
        let x_end = self.profile.x_end;
        let mut face = arm.clone();
        face.push(DVec2::new(x_end, 0.0));
        face.push(DVec2::new(self.width - x_end, 0.0));
        face.extend(arm.iter().rev().map(|p| self.turned(*p)));
        face
    }

    /// A layer without slit and cut-out, as if the arm were rigid.
    pub fn solid(&self) -> Polygon {
        let mut around = self.face();
        around.push(DVec2::new(self.width, self.bottom));
        around.push(DVec2::new(0.0, self.bottom));
        around.reverse();
        around
    }

    /// A layer as it is cut.
    pub fn layer(&self) -> Polygon {
        let [near, far] = self.slit;
        let neck = near - self.neck;
        // The upper corners of the slit are knots of the face; the part of the face between them is cut away.
        let face = self.face();
        let left = face.iter().filter(|p| p.y >= 0.0 || p.x < near + SAME);
        let right = face.iter().filter(|p| p.y < 0.0 && p.x > far - SAME);
        let mut around: Polygon = left.copied().collect();
        around.extend([DVec2::new(near, self.slit_end), DVec2::new(far, self.slit_end)]);
        around.extend(right);
        around.push(DVec2::new(self.width, self.bottom));
        around.push(DVec2::new(0.0, self.bottom));
        let [low, high] = self.cutout;
        around.extend([(0.0, low), (neck, low), (neck, high), (0.0, high)].map(|(x, y)| DVec2::new(x, y)));
        around.reverse();
        around
    }

    /// The part of a layer that rotates as a rigid body: above the cut-out, left of the slit.
    pub fn arm(&self) -> Polygon {
        let near = self.slit[0];
        let mut around: Vec<DVec2> =
            self.face().into_iter().filter(|p| p.y >= 0.0 || p.x < near + SAME).collect();
        around.push(DVec2::new(near, self.cutout[1]));
        around.push(DVec2::new(0.0, self.cutout[1]));
        around.reverse();
        around
    }

    /// The rest of it, without the neck: the part that is fixed to the module.
    pub fn body(&self) -> Polygon {
        let far = self.slit[1];
        let mut around: Vec<DVec2> =
            self.face().into_iter().filter(|p| p.y < 0.0 && p.x > far - SAME).collect();
        around.push(DVec2::new(self.width, self.bottom));
        around.push(DVec2::new(0.0, self.bottom));
        around.push(DVec2::new(0.0, self.cutout[0]));
        around.push(DVec2::new(far, self.cutout[0]));
        around.reverse();
        around
    }

    /// The sheet between the layers: the common part of both, without hooks.
    ///
    /// Only this shape leaves the partner's separator free; the union of both layers would protrude 2·f into
    /// it.
    pub fn separator(&self) -> Polygon {
        let middle = 0.5 * self.width;
        let left: Vec<DVec2> = self.arm_profile().into_iter().filter(|p| p.x < middle).collect();
        let mut around: Vec<DVec2> = left.iter().map(|p| DVec2::new(p.x, -p.y)).collect();
        around.push(DVec2::new(middle, -self.profile.height(middle)));
        around.extend(left.iter().rev().map(|p| DVec2::new(self.width - p.x, -p.y)));
        around.push(DVec2::new(self.width, self.bottom));
        around.push(DVec2::new(0.0, self.bottom));
        around.reverse();
        around
    }

    /// The mirror image, counter-clockwise again.
    pub fn mirrored(&self, polygon: &[DVec2]) -> Polygon {
        polygon.iter().rev().map(|p| DVec2::new(self.width - p.x, p.y)).collect()
    }
}

/// The angle at the hook with which the tangent there passes through P. P moves with the angle, because the slit is measured
/// from the face.
fn through_pivot(
    latch: &LatchDesign,
    pivot_x: f64,
    pivot_y: &impl Fn(&ArmProfile) -> f64,
) -> Result<f64, GeometryError> {
    let flatter_than_p = |end: f64| {
        let profile = ArmProfile::of(latch, end);
        end.tan() * (pivot_x - profile.x_end) < profile.hook - pivot_y(&profile)
    };
    // Beyond the steepest angle the tangent is steeper than any line to P.
    let (mut low, mut high) = (latch.spline_start, STEEPEST);
    if !flatter_than_p(low) || flatter_than_p(high) {
        return Err(GeometryError::NoProfile { start: latch.spline_start.to_degrees() });
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if flatter_than_p(middle) { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}

/// Area of a polygon, in mm²: positive counter-clockwise.
pub fn area(polygon: &[DVec2]) -> f64 {
    edges(polygon).map(|(a, b)| 0.5 * a.perp_dot(b)).sum()
}

/// Whether no two edges that are not neighbours touch.
pub fn is_simple(polygon: &[DVec2]) -> bool {
    let all: Vec<(DVec2, DVec2)> = edges(polygon).collect();
    let n = all.len();
    (0..n).all(|i| (i + 2..n).all(|j| (i == 0 && j == n - 1) || !touch(all[i], all[j])))
}

/// The edges, around.
pub fn edges(polygon: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    polygon.iter().enumerate().map(|(k, a)| (*a, polygon[(k + 1) % polygon.len()]))
}

fn touch((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)) -> bool {
    // Boxes that are apart spare most of the work.
    let apart = |k: usize| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k]);
    if apart(0) || apart(1) {
        return false;
    }
    let side = |a: DVec2, b: DVec2, p: DVec2| (b - a).perp_dot(p - a);
    let (p, q) = (side(a, b, c), side(a, b, d));
    let (r, s) = (side(c, d, a), side(c, d, b));
    p * q <= 0.0 && r * s <= 0.0
}

#[cfg(test)]
mod tests;
