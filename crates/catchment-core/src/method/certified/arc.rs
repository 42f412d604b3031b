//! The normals of a contact between a moving and a fixed ridge: an arc between the normals of the two facets
//! of the fixed ridge.
//!
//! ```text
//!      s₂ ╲   ╱ s₁      the moving ridge; its facets lead away along s₁, s₂
//!          ╲ ╱
//!     n₁ ◝  ●  ◜ n₂     n(φ) = cos φ·n₁ + sin φ·e₂     0 ≤ φ ≤ Φ,  n(Φ) = n₂
//!         ╱   ╲         supported if      n·s₁ ≥ 0  and  n·s₂ ≥ 0
//! ```
//!
//! If the ridges are nearly parallel their cross product may have any direction, while the range that the
//! facets support is narrow if they lie flush.
//!
//! Not promised: the smallest arc. Its ends are accurate to 2⁻²⁰ of the whole.

use super::body::Ridge;
use super::interval::{Interval, Vector, dot, thin};
use super::placed::Placed;
use super::touch::SLACK;
use glam::DVec3;

/// How often the part that is tried next is halved.
const HALVINGS: usize = 20;
/// Facets that are nearer than this to lying back to back or flat (sine) make no arc.
const FLAT: f64 = 1e-3;

/// The arc of a fixed ridge.
pub(super) struct Arc {
    first: Vector,
    across: Vector,
    most: f64,
}

impl Arc {
    /// Between the facets of a ridge; `None` if they lie back to back.
    pub(super) fn of(own: &Ridge) -> Option<Self> {
        let [first, last] = own.normals;
        let (cosine, across) = (first.dot(last), last - first * first.dot(last));
        let sine = across.length();
        (sine > FLAT).then(|| Self {
            first: thin(first),
            across: thin(across / sine),
            most: sine.atan2(cosine).next_up() + SLACK,
        })
    }

    /// All normals of the arc that a moving ridge may support; `None` if it supports none of them.
    pub(super) fn normal(&self, its: &Ridge, at: &Placed) -> Option<Vector> {
        let [left, right] = its.normals;
        let leads = [left.cross(its.along), its.along.cross(right)].map(|s: DVec3| {
            let s = at.turn(s);
            [dot(&s, &self.first), dot(&s, &self.across)]
        });
        let none = |from: f64, to: f64| {
            let [sine, cosine] = Interval::new(from, to).sin_cos();
            leads.iter().any(|[a, b]| (*a * cosine + *b * sine).up < -SLACK)
        };
        let (mut lo, mut up) = (0.0, self.most);
        let mut part = self.most;
        for _ in 0..HALVINGS {
            if lo + part <= up && none(lo, lo + part) {
                lo += part;
            } else {
                part *= 0.5;
            }
        }
        if lo >= up {
            return None;
        }
        part = up - lo;
        for _ in 0..HALVINGS {
            if up - part >= lo && none(up - part, up) {
                up -= part;
            } else {
                part *= 0.5;
            }
        }
        let [sine, cosine] = Interval::new(lo, up.max(lo)).sin_cos();
        // Normals of facets are rounded, and may fail to be supported by as much.
        Some([0, 1, 2].map(|k| (self.first[k] * cosine + self.across[k] * sine).widened(SLACK)))
    }
}
