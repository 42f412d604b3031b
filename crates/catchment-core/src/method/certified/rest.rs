//! Lower bounds on escape heights: the smallest height to which a half must be lifted before it can come to
//! rest elsewhere.
//!
//! ```text
//!     h │ ╲    ╱ exit      boxes are visited in the order of the lowest path to them by floors, from those about the rest:
//!       │  ╲  ╱            the search ends at the first box that may let a motion leave or rest
//!       │   ╲╱  rest       lifted by less, a half stays in the boxes visited before, so it ends within CORE of its rest
//! ```
//!
//! The walk is that of [`super::flood`], with the boxes around the rest in place of the seat. An almost level
//! rest has escape height 0 here: the half may come to rest slightly beside it.
//!
//! Not promised: a bound close to the true escape height. It improves as boxes become small, and each rest
//! has [`BOXES`] of them.

use super::flood::{EscapeRoute, Seat};
use super::interval::Interval;
use super::placed::{Bodies, PoseBox};
use super::tree::Tree;
use super::{CertifiedError, MOST_MEETINGS, begin, coarse, halve};
use crate::contact::Pair;
use crate::exec::Exec;
use crate::pose::{Dof, DofSet, PoseError};
use std::f64::consts::TAU;

/// Poses within this distance of a rest count as the same place, in the ρ-metric, in D: far above the
/// accuracy of motion ends.
const CORE: f64 = 0.005;
/// Boxes for each rest, beyond those that all share: some seconds in the plane.
const BOXES: usize = 20_000;

/// Lower bounds on the height above each rest (a pose error, and z of the centre of rotation) that a half
/// must reach, in D, before it can come to rest elsewhere or leave; `None` for a rest outside the examined
/// region, or without a known exit.
///
/// # Errors
/// [`CertifiedError::Large`], and [`CertifiedError::Cancelled`] if a stop is requested.
pub(crate) fn depths(
    pair: &Pair,
    rests: &[(PoseError, f64)],
    exec: &Exec,
) -> Result<Vec<Option<f64>>, CertifiedError> {
    let bodies = bodies(pair)?;
    let mut tree = begin(pair, &bodies, exec)?;
    let of = |(k, (error, height)): (usize, &(PoseError, f64))| {
        exec.report(k as f64 / rests.len() as f64, "certified depths");
        Ok(depth(&mut tree, pair, &bodies, error, exec)?.map(|level| (level - height).max(0.0)))
    };
    rests.iter().enumerate().map(of).collect()
}

/// Whether anything can be certified of a pair.
///
/// # Errors
/// [`CertifiedError::Large`].
pub(crate) fn applies(pair: &Pair) -> Result<(), CertifiedError> {
    bodies(pair).map(|_| ())
}

fn bodies(pair: &Pair) -> Result<Bodies, CertifiedError> {
    let bodies = Bodies::of(pair);
    match bodies.meetings.len() {
        meetings if meetings > MOST_MEETINGS => Err(CertifiedError::Large { meetings }),
        _ => Ok(bodies),
    }
}

/// The lowest height at which a half may leave a rest.
fn depth(
    tree: &mut Tree,
    pair: &Pair,
    bodies: &Bodies,
    rest: &PoseError,
    exec: &Exec,
) -> Result<Option<f64>, CertifiedError> {
    let about = About { rest: rest.to_array(), free: bodies.free, rho: bodies.rho };
    if tree.places(&about.rest.map(Interval::thin)).is_none() {
        return Ok(None);
    }
    let (holds, meets) = (|poses: &PoseBox| about.holds(poses), |poses: &PoseBox| about.meets(poses));
    // At any height: only a single rest counts.
    let level = f64::INFINITY;
    let seat = Seat { mated: f64::NEG_INFINITY, level, holds: &holds, home: None, meets: &meets };
    let most = tree.cells.len() + BOXES;
    loop {
        let route = EscapeRoute::find(tree, &seat, exec)?;
        let mut in_the_way = coarse(tree, &route);
        in_the_way.truncate(most.saturating_sub(tree.cells.len()) >> tree.axes.len());
        if in_the_way.is_empty() {
            return Ok(Some(route.level).filter(|level| level.is_finite()));
        }
        halve(tree, &in_the_way, pair, bodies, exec)?;
    }
}

/// The neighbourhood of a rest.
struct About {
    rest: [f64; 5],
    free: DofSet,
    rho: f64,
}

impl About {
    /// Errors against the rest, angles as far as their circle is short, in D.
    fn off(&self, poses: &PoseBox) -> PoseBox {
        Dof::ALL.map(|dof| {
            if !self.free.contains(dof) {
                return Interval::ZERO;
            }
            let (own, rest) = (poses[dof.index()], self.rest[dof.index()]);
            if !dof.is_rotation() {
                return own - Interval::thin(rest);
            }
            let rest = rest + ((own.middle() - rest) / TAU).round() * TAU;
            (own - Interval::thin(rest)).widened(4.0 * f64::EPSILON * rest.abs()) * self.rho
        })
    }

    /// Whether all poses of a box are near it.
    fn holds(&self, poses: &PoseBox) -> bool {
        let square = |part: Interval| part.lo.abs().max(part.up.abs()).powi(2);
        self.off(poses).into_iter().map(square).sum::<f64>() <= (CORE * (1.0 - 1e-9)).powi(2)
    }

    /// Whether some may be.
    fn meets(&self, poses: &PoseBox) -> bool {
        self.off(poses).into_iter().all(|part| part.meets(Interval::new(-CORE, CORE)))
    }
}
