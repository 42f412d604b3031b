//! Bounds of a part of a half, singly or four at a time.
//!
//! ```text
//!        ┌───────────┐        the box around its features, the plane across their mean normal that all of them lie
//!        │  ╲__      │ ╲      behind, and the cone of all normals by which they touch
//!        │     ╲__   │  n
//!        └───────────┘
//! ```
//!
//! Stored in single precision, four per instruction: queries must widen their limits by [`rounding`].

use super::cone::Cone;
use super::tree::SLACKS;
use glam::{DMat3, DVec3};
use wide::f32x4;

/// Normals that face up or down by less have steep planes, which bound no height.
const STEEP: f32 = 0.05;
/// Beyond all heights.
const FAR: f32 = 1e30;

/// Bounds of a single part (`f32`) or of four (`f32x4`).
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds<T> {
    center: [T; 3],
    /// Half of the size of the box.
    half: [T; 3],
    /// The same along the axes of its own half.
    own: [T; 3],
    /// Largest distance from the centre.
    radius: T,
    /// Mean normal of the features, unit, or 0 if they cancel.
    normal: [T; 3],
    /// Distance of the plane in front of the centre, across the normal.
    ahead: T,
    /// Height of the plane above the centre, if it is not steep, and its slopes in x and y; else far above a
    /// fixed part and far below a moving part.
    over: T,
    slope: [T; 2],
    /// Cosine and sine of half the angle of the cone around the normal, for each slack; NaN for a wide cone.
    cones: [[T; 2]; SLACKS.len()],
}

/// Four parts.
pub(super) type BoundsOfFour = Bounds<f32x4>;
/// A single part.
pub(super) type BoundsOfOne = Bounds<f32>;

/// By how much coordinates may be wrong of parts that are up to `extent` away, in D: a dozen roundings of single precision, with room. On planes
/// heights are wrong by so much for each of their slopes, too, which [`BoundsOfFour::most`] adds.
pub(super) fn rounding(extent: f64) -> f32 {
    (1e-6 * extent) as f32
}

impl<T: Copy> Bounds<T> {
    #[inline]
    fn map<U>(&self, to: impl Fn(&T) -> U) -> Bounds<U> {
        let two = |[a, b]: &[T; 2]| [to(a), to(b)];
        let three = |[a, b, c]: &[T; 3]| [to(a), to(b), to(c)];
        Bounds {
            center: three(&self.center),
            half: three(&self.half),
            own: three(&self.own),
            radius: to(&self.radius),
            normal: three(&self.normal),
            ahead: to(&self.ahead),
            over: to(&self.over),
            slope: two(&self.slope),
            cones: self.cones.each_ref().map(two),
        }
    }
}

impl BoundsOfOne {
    /// Of features in the box from `low` to `high`, up to `radius` from its middle, up to `level` along `normal`.
    pub(super) fn new(
        [low, high]: [DVec3; 2],
        radius: f64,
        normal: DVec3,
        level: f64,
        cones: [Cone; SLACKS.len()],
    ) -> Self {
        let center = (low + high) / 2.0;
        let single = |v: DVec3| v.as_vec3().to_array();
        let half = single((high - low) / 2.0);
        Self {
            center: single(center),
            half,
            own: half,
            radius: radius as f32,
            normal: single(normal),
            ahead: (level - normal.dot(center)) as f32,
            over: FAR,
            slope: [0.0; 2],
            cones: cones.map(Cone::single),
        }
    }

    /// Nothing.
    pub(super) const NONE: Self = Self {
        center: [0.0; 3],
        half: [-FAR; 3],
        own: [-FAR; 3],
        radius: -FAR,
        normal: [0.0; 3],
        ahead: 0.0,
        over: FAR,
        slope: [0.0; 2],
        cones: [[0.0; 2]; SLACKS.len()],
    };
}

impl BoundsOfFour {
    /// These four.
    pub(super) fn of([a, b, c, d]: &[BoundsOfOne; 4]) -> Self {
        let three = |get: fn(&BoundsOfOne) -> [f32; 3]| {
            let [a, b, c, d] = [get(a), get(b), get(c), get(d)];
            [0, 1, 2].map(|k| f32x4::from([a[k], b[k], c[k], d[k]]))
        };
        let one = |get: fn(&BoundsOfOne) -> f32| f32x4::from([get(a), get(b), get(c), get(d)]);
        let cone = |k: usize| [0, 1].map(|i| f32x4::from([a, b, c, d].map(|part| part.cones[k][i])));
        Self {
            center: three(|part| part.center),
            half: three(|part| part.half),
            own: three(|part| part.own),
            radius: one(|part| part.radius),
            normal: three(|part| part.normal),
            ahead: one(|part| part.ahead),
            over: one(|part| part.over),
            slope: [f32x4::ZERO; 2],
            cones: std::array::from_fn(cone),
        }
    }

    /// Four copies of a lane.
    #[inline]
    pub(super) fn repeated(&self, lane: usize) -> Self {
        self.map(|four| f32x4::splat(four.as_array()[lane]))
    }

    /// Half of the larger side of the box of a lane in plan view.
    #[inline]
    pub(super) fn size(&self, lane: usize) -> f32 {
        let [x, y, _] = self.half.each_ref().map(|half| half.as_array()[lane]);
        x.max(y)
    }

    /// Their planes as heights, of parts that touch from `below` or from above.
    #[inline]
    pub(super) fn with_planes(mut self, below: bool) -> Self {
        let [nx, ny, nz] = self.normal;
        let (gentle, far) = if below {
            (nz.simd_gt(f32x4::splat(STEEP)), FAR)
        } else {
            (nz.simd_lt(f32x4::splat(-STEEP)), -FAR)
        };
        let inverse = f32x4::ONE / nz;
        self.over = gentle.bitselect(self.center[2] + self.ahead * inverse, f32x4::splat(far));
        self.slope = [nx, ny].map(|n| gentle.bitselect(-n * inverse, f32x4::ZERO));
        self
    }

    /// Upper bound on the height at which the fixed part can carry the moving part above its current height,
    /// except for the [`rounding`] of a height, and a mask of the lanes whose boxes are within `reach` of each
    /// other in plan view.
    #[inline]
    pub(super) fn most(&self, moving: &Self, reach: f32, rounding: f32) -> (f32x4, f32x4) {
        let reach = f32x4::splat(reach + rounding);
        let across = |k: usize| {
            let (own, its) = (self.half[k] + reach, moving.half[k]);
            let low = (self.center[k] - own).fast_max(moving.center[k] - its);
            let high = (self.center[k] + own).fast_min(moving.center[k] + its);
            (low, high)
        };
        let ((low_x, high_x), (low_y, high_y)) = (across(0), across(1));
        let beside = low_x.simd_le(high_x) & low_y.simd_le(high_y);
        if beside.to_bitmask() == 0 {
            return (f32x4::ZERO, beside);
        }
        let half = f32x4::splat(0.5);
        let (mid_x, mid_y) = ((low_x + high_x) * half, (low_y + high_y) * half);
        let (wide_x, wide_y) = ((high_x - low_x) * half, (high_y - low_y) * half);
        let (top, bottom) = (self.center[2] + self.half[2], moving.center[2] - moving.half[2]);
        // Highest value of a part over the common rectangle of both boxes: its value at the middle plus its
        // rise from there.
        let over = |part: &Self| {
            part.over + part.slope[0] * (mid_x - part.center[0]) + part.slope[1] * (mid_y - part.center[1])
        };
        let rise = |slope: [f32x4; 2]| slope[0].abs() * wide_x + slope[1].abs() * wide_y;
        let steep = |slope: &[f32x4; 2]| (slope[0].abs() + slope[1].abs()) * f32x4::splat(rounding);
        let (f, m) = (over(self) + steep(&self.slope), over(moving) - steep(&moving.slope));
        let both = f - m + rise([self.slope[0] - moving.slope[0], self.slope[1] - moving.slope[1]]);
        let fixed = f + rise(self.slope) - bottom;
        let other = top - m + rise(moving.slope);
        ((top - bottom).fast_min(both).fast_min(fixed.fast_min(other)), beside)
    }

    /// The least that heights of the two may be.
    #[inline]
    pub(super) fn least(&self, moving: &Self) -> f32x4 {
        self.center[2] - self.half[2] - (moving.center[2] + moving.half[2])
    }

    /// Whether gaps between features of the two parts may be between −`deep` and `front`, with `front` ≤
    /// `deep`, for features that count with a slack. Parts that overlap along a normal of a part's cone do
    /// not lie in front of its plane. Boxes are tested along the axes of both halves: long walls of a rotated
    /// half are thin along its own axes.
    #[inline]
    pub(super) fn is_near(
        &self,
        moving: &Self,
        [front, deep]: [f32; 2],
        slack: Option<usize>,
        (placed, rounding): (&Placed, f32),
    ) -> f32x4 {
        let apart = [0, 1, 2].map(|k| moving.center[k] - self.center[k]);
        let wide = f32x4::splat(deep + 2.0 * rounding);
        let meets = |k: usize| apart[k].abs().simd_le(self.half[k] + moving.half[k] + wide);
        let meets = meets(0) & meets(1) & meets(2);
        if meets.to_bitmask() == 0 {
            return meets;
        }
        let meets_turned = |k: usize| {
            let [axis, size] = [placed.axes[k], placed.sizes[k]];
            let along = apart[0] * axis[0] + apart[1] * axis[1] + apart[2] * axis[2];
            let half = self.half[0] * size[0] + self.half[1] * size[1] + self.half[2] * size[2];
            along.abs().simd_le(moving.own[k] + half + wide)
        };
        let meets = meets & meets_turned(0) & meets_turned(1) & meets_turned(2);
        if meets.to_bitmask() == 0 {
            return meets;
        }
        let (most, beside) = self.most(moving, deep, rounding);
        let [front, reach] = [front, deep].map(|reach| f32x4::splat(reach + 2.0 * rounding));
        let before = |part: &Self| match slack {
            Some(slack) => part.cones[slack][0].simd_gt(f32x4::splat(Cone::ROUNDING)).bitselect(front, reach),
            None => reach,
        };
        let dot = |a: &[f32x4; 3], b: &[f32x4; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let size = |n: &[f32x4; 3], half: &[f32x4; 3]| {
            n[0].abs() * half[0] + n[1].abs() * half[1] + n[2].abs() * half[2]
        };
        // Else in front of the plane that all of the other part lies behind.
        let ahead =
            (dot(&self.normal, &apart) - size(&self.normal, &moving.half)).simd_le(self.ahead + before(self));
        let behind = (-dot(&moving.normal, &apart) - size(&moving.normal, &self.half))
            .simd_le(moving.ahead + before(moving));
        // Or above it by more than the slope of the fixed plane makes of the reach.
        let slope = f32x4::ONE + self.slope[0].abs() + self.slope[1].abs();
        let under = most.simd_ge(-reach * slope);
        meets & beside & ahead & behind & under
    }

    /// Whether features of the two parts may touch by their orientation, with a slack, for normals that may
    /// lean beyond the horizontal by this angle.
    #[inline]
    pub(super) fn may_touch(&self, moving: &Self, slack: usize, overhang: [f32; 2]) -> f32x4 {
        let ([c, s], [d, t]) = (self.cones[slack], moving.cones[slack]);
        let [x, y, z] = [0, 1, 2].map(|k| self.normal[k] * moving.normal[k]);
        let rounding = f32x4::splat(Cone::ROUNDING);
        let apart = (-(x + y + z)).simd_lt(c * d - s * t - rounding);
        let [sine, level] = overhang.map(f32x4::splat);
        let beyond = |[c, s]: [f32x4; 2], away: f32x4| {
            (c * level - s * sine).simd_gt(f32x4::ZERO) & away.simd_gt(s * level + c * sine + rounding)
        };
        !(apart | beyond([c, s], -self.normal[2]) | beyond([d, t], moving.normal[2]))
    }
}

/// Pose of the moving half.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    /// Rows of its rotation, and how boxes grow by it: the same without signs.
    rotation: [[f32; 3]; 3],
    grows: [[f32; 3]; 3],
    position: [f32; 3],
    /// The axes of the moving half in the world, and the same without signs.
    axes: [[f32; 3]; 3],
    sizes: [[f32; 3]; 3],
}

impl Placed {
    pub(super) fn new(rotation: &DMat3, position: DVec3) -> Self {
        let rows = [0, 1, 2].map(|k| rotation.row(k).as_vec3().to_array());
        let axes = [0, 1, 2].map(|k| rotation.col(k).as_vec3().to_array());
        let unsigned = |vectors: [[f32; 3]; 3]| vectors.map(|v| v.map(f32::abs));
        Self {
            rotation: rows,
            grows: unsigned(rows),
            position: position.as_vec3().to_array(),
            axes,
            sizes: unsigned(axes),
        }
    }

    /// Parts of the moving half in the world.
    #[inline]
    pub(super) fn four(&self, own: &BoundsOfFour) -> BoundsOfFour {
        let turned =
            |by: &[[f32; 3]; 3], v: &[f32x4; 3]| by.map(|row| v[0] * row[0] + v[1] * row[1] + v[2] * row[2]);
        let center = turned(&self.rotation, &own.center);
        let placed = BoundsOfFour {
            center: [0, 1, 2].map(|k| center[k] + self.position[k]),
            // The enlarged half extents of a turned box do not exceed the radius of the ball around its
            // content.
            half: turned(&self.grows, &own.half).map(|half| half.fast_min(own.radius)),
            normal: turned(&self.rotation, &own.normal),
            ..*own
        };
        placed.with_planes(false)
    }
}
