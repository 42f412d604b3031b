//! A neighbourhood of the mated pose without rests outside the seat: a single argument covers all of it, in
//! place of arbitrarily small boxes.
//!
//! ```text
//!     h │ ╲         ╱      an active contact at q has a plane, whose height f is h(q) at q and at most h₀ at the mated pose 0
//!       │  ╲       ╱       towards 0 it falls by at least h(q) − h₀, minus the change of its slope on the path: Σ W|q|
//!       │   ╲     ╱        points of either half that are certainly over facets of the other:  h(q) ≥ h₀ + max Gⱼ·q
//!    ───┼────╲___╱────     if  max Gⱼ·q > Σ W|q|  every active contact opens towards 0: nothing rests
//!       └─────0───── q     below the least h on the border nothing leaves: level
//! ```
//!
//! Gⱼ and W are bounds over the whole neighbourhood, so the last line must be shown only on its border; it
//! then holds for every multiple. After Delanoue 2015, who shows the same for a smooth vector field.
//!
//! Not promised: that it exists. Seats with play have no such neighbourhood, and for halves that may tip over
//! their own rims it is small.

use super::body::{Meeting, Ridge};
use super::interval::{Interval, Vector, cross, dot, thin};
use super::placed::{Bodies, Placed, PoseBox};
use super::survey::{ROUNDING, Survey};
use super::touch::{Touch, Touching, holds, plan};
use crate::contact::Nearby;
use crate::exec::{Cancelled, Exec};
use crate::pose::{Dof, ROTATIONS};
use glam::DVec3;

/// Certified facts about the mated pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Home {
    /// Nothing rests in it but in the seat.
    pub(super) poses: PoseBox,
    /// Below this height nothing leaves it, in D.
    pub(super) level: f64,
}

/// How often the error box is halved before and at most.
const HALVINGS: std::ops::RangeInclusive<i32> = 2..=8;
/// Amount by which the height must rise on the border beyond the possible change of the slopes, in D. The
/// rounding of heights is so much smaller that the argument holds to within a ten-thousandth of the distance
/// to the mated pose: there everything is in the seat.
const LEAST: f64 = 1e5 * ROUNDING;
/// Distances of test points over facets from their corners, as parts of the distance to the middle: the
/// larger, the larger the neighbourhood over which they certainly lie over the facet, and the weaker their
/// bounds on rotations.
const INSETS: [f64; 3] = [0.06, 0.15, 0.35];
/// Cosine above which facets lie flush: rounding of normals.
const FLUSH: f64 = 1.0 - 1e-9;
/// Pieces into which the border is cut at most.
const PIECES: usize = 100_000;

impl Home {
    /// The largest neighbourhood found around the mated pose, whose height is `mated`; sizes are the error
    /// box repeatedly halved.
    ///
    /// # Errors
    /// [`Cancelled`] if a stop is requested.
    pub(super) fn find(
        bodies: &Bodies,
        errors: &PoseBox,
        mated: f64,
        nearby: &mut Nearby<'_>,
        exec: &Exec,
    ) -> Result<Option<Self>, Cancelled> {
        for halvings in HALVINGS {
            exec.check()?;
            let poses = errors.map(|range| {
                let reach = range.up.min(-range.lo) * 0.5f64.powi(halvings);
                if reach > 0.0 { Interval::new(-reach, reach) } else { Interval::ZERO }
            });
            let result = Self::about(bodies, &poses, mated, nearby, exec)?;
            if result.is_some() {
                return Ok(result);
            }
        }
        Ok(None)
    }

    fn about(
        bodies: &Bodies,
        poses: &PoseBox,
        mated: f64,
        nearby: &mut Nearby<'_>,
        exec: &Exec,
    ) -> Result<Option<Self>, Cancelled> {
        let all: Vec<u32> = (0..bodies.meetings.len() as u32).collect();
        let survey = Survey::of(bodies, poses, &all, nearby);
        if survey.walled || survey.ends {
            return Ok(None);
        }
        let Some(changes) = changes(bodies, poses, mated, &survey.touches) else { return Ok(None) };
        let least = least(bodies, &rises(bodies, poses, mated), &changes, exec)?;
        Ok(least.map(|least| Self { poses: *poses, level: mated + least }))
    }

    /// Whether it holds all poses of a box.
    pub(super) fn holds(&self, poses: &PoseBox) -> bool {
        poses.iter().zip(&self.poses).all(|(part, own)| own.lo <= part.lo && part.up <= own.up)
    }
}

/// Largest change of the slopes of the carrying contacts over a neighbourhood, each error in units of its
/// extent; `None` if a plane may lie above the mated pose.
fn changes(bodies: &Bodies, poses: &PoseBox, mated: f64, touches: &[Touch]) -> Option<[f64; 5]> {
    let at = Placed::new(bodies, poses);
    let mut most = [0.0f64; 5];
    for touch in touches.iter().filter(|touch| touch.height.up >= mated - ROUNDING) {
        let slides = if let Meeting::RidgeRidge(own, its) = bodies.meetings[touch.number as usize] {
            let (own, its) = (&bodies.fixed.ridges[own as usize], &bodies.moving.ridges[its as usize]);
            lies_along(bodies, own, its, mated).then(|| along(bodies, &at, its, touch)).flatten()
        } else {
            None
        };
        let slopes = if let Some(slopes) = slides {
            slopes
        } else {
            let plane = touch.plane.filter(|plane| plane.middle.up <= mated + ROUNDING)?;
            let mut slopes = [Interval::ZERO; 5];
            for dof in bodies.free.iter() {
                slopes[dof.index()] = plane.rates[dof.index()].over(touch.rise)?;
            }
            slopes
        };
        for (most, (slope, range)) in most.iter_mut().zip(slopes.iter().zip(poses)) {
            *most = most.max((slope.width() * range.up).next_up());
        }
    }
    Some(most)
}

/// Whether a moving ridge lies on the line of a fixed ridge in the mated pose: for each of its contact
/// points, and each normal, the plane then contains that line.
fn lies_along(bodies: &Bodies, own: &Ridge, its: &Ridge, mated: f64) -> bool {
    let start = bodies.fixed.at(own.ends[0]);
    its.ends.iter().all(|end| {
        let off = bodies.moving.at(*end) + DVec3::new(0.0, 0.0, mated) - start;
        off.reject_from_normalized(own.along).length() <= 0.1 * ROUNDING
    })
}

/// Change of the slopes of a point of a moving ridge over a neighbourhood that touches a fixed line with a
/// common normal: intervals of that width.
fn along(bodies: &Bodies, at: &Placed, its: &Ridge, touch: &Touch) -> Option<PoseBox> {
    let change = |range: Interval| {
        Interval::new(-0.5 * range.width(), 0.5 * range.width()).widened(ROUNDING * ROUNDING)
    };
    let ends = its.ends.map(|end| at.turned[end as usize].map(change));
    let arm: Vector = [0, 1, 2].map(|k| ends[0][k].hull(ends[1][k]));
    let turned = cross(&arm, &touch.normal);
    let face = at.face.map(change);
    let mut slopes = [Interval::ZERO; 5];
    for (k, dof) in ROTATIONS.into_iter().enumerate() {
        if !bodies.free.contains(dof) {
            continue;
        }
        let axis = at.axes[k].map(change);
        let swing = [cross(&axis, &at.face), cross(&at.axes[k], &face)];
        let swung =
            (0..2).filter(|j| bodies.slides(*j)).map(|j| touch.normal[j] * (swing[0][j] + swing[1][j]));
        let swung = swung.fold(Interval::ZERO, |sum, part| sum + part);
        let rate = dot(&axis, &touch.torque) + dot(&at.axes[k], &turned) - swung;
        slopes[dof.index()] = rate.over(touch.rise)?;
    }
    Some(slopes)
}

/// How steeply the height rises at least from the mated pose, by every point that lies over a facet for certain and touches it there: per error
/// in units of its reach.
fn rises(bodies: &Bodies, poses: &PoseBox, mated: f64) -> Vec<PoseBox> {
    let (mut bodies, mut points) = (bodies.clone(), bodies.fixed.vertices.clone());
    let flush: Vec<(usize, usize)> = (0..bodies.fixed.facets.len())
        .flat_map(|f| (0..bodies.moving.facets.len()).map(move |m| (f, m)))
        .filter(|(f, m)| bodies.fixed.facets[*f].normal.dot(-bodies.moving.facets[*m].normal) >= FLUSH)
        .collect();
    for (f, m) in flush {
        let inset = |corners: Vec<DVec3>| {
            let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
            INSETS.into_iter().flat_map(move |inset| {
                corners.clone().into_iter().map(move |corner| corner.lerp(middle, inset))
            })
        };
        let (own, its) = (&bodies.fixed.facets[f], &bodies.moving.facets[m]);
        points.extend(inset(own.corners.iter().map(|k| bodies.fixed.at(*k)).collect()));
        let its: Vec<DVec3> = inset(its.corners.iter().map(|k| bodies.moving.at(*k)).collect()).collect();
        bodies.moving.vertices.extend(its);
    }
    let bodies = &bodies;
    let touching = Touching::new(bodies, poses);
    let (over, middle) = (&touching.over, &touching.middle);
    let mut rises = Vec::new();
    let mut add = |normal: Vector, arm: Vector| {
        let rates = over.gap_rates(bodies, &normal, &cross(&arm, &normal));
        let mut rise = [Interval::ZERO; 5];
        for dof in bodies.free.iter() {
            let k = dof.index();
            let Some(slope) = (-rates[k]).over(normal[2]) else { return };
            rise[k] = slope * poses[k].up;
        }
        rises.push(rise);
    };
    let touches = |height: Option<Interval>| height.is_some_and(|height| height.lo >= mated - ROUNDING);
    for facet in bodies.fixed.facets.iter().filter(|facet| facet.normal.z > 0.0) {
        let polygon: Vec<[Interval; 2]> = facet.corners.iter().map(|k| plan(bodies.fixed.at(*k))).collect();
        let normal = thin(facet.normal);
        for vertex in 0..bodies.moving.vertices.len() {
            let start = bodies.fixed.at(facet.corners[0]);
            if holds(&polygon, over.lateral[vertex]) && touches(middle.closing(&normal, start, vertex)) {
                add(normal, over.turned[vertex]);
            }
        }
    }
    for facet in &bodies.moving.facets {
        let polygon: Vec<[Interval; 2]> = facet.corners.iter().map(|k| over.lateral[*k as usize]).collect();
        let (normal, there) = (over.turn(-facet.normal), middle.turn(-facet.normal));
        let corner = facet.corners[0] as usize;
        for point in &points {
            if holds(&polygon, plan(*point))
                && touches(middle.closing(&there, *point, corner))
                && let Some(height) = over.closing(&normal, *point, corner)
            {
                add(normal, over.arm_to(bodies, thin(*point), height));
            }
        }
    }
    rises
}

/// Smallest rise of the height over the border; `None` if it may be no larger than the change of the slopes.
///
/// # Errors
/// [`Cancelled`] if a stop is requested.
fn least(
    bodies: &Bodies,
    rises: &[PoseBox],
    changes: &[f64; 5],
    exec: &Exec,
) -> Result<Option<f64>, Cancelled> {
    let axes: Vec<usize> = bodies.free.iter().map(Dof::index).collect();
    let rise = |at: &PoseBox| {
        let own = |rise: &PoseBox| axes.iter().fold(Interval::ZERO, |sum, k| sum + rise[*k] * at[*k]).lo;
        rises.iter().map(own).fold(f64::NEG_INFINITY, f64::max)
    };
    let lost =
        |at: &PoseBox| axes.iter().map(|k| changes[*k] * at[*k].lo.abs().max(at[*k].up.abs())).sum::<f64>();
    let mut open: Vec<PoseBox> = Vec::new();
    for k in &axes {
        for end in [-1.0, 1.0] {
            let mut side = [Interval::ZERO; 5];
            for k in &axes {
                side[*k] = Interval::new(-1.0, 1.0);
            }
            side[*k] = Interval::thin(end);
            open.push(side);
        }
    }
    let (mut least, mut pieces) = (f64::INFINITY, 0);
    while let Some(piece) = open.pop() {
        let rises = rise(&piece);
        if rises > lost(&piece) + LEAST {
            least = least.min(rises);
            continue;
        }
        let middle = piece.map(|part| Interval::thin(part.middle()));
        pieces += 1;
        if pieces > PIECES || rise(&middle) <= lost(&middle) + LEAST {
            return Ok(None);
        }
        exec.check()?;
        let widest = axes.iter().max_by(|a, b| piece[**a].width().total_cmp(&piece[**b].width()));
        let Some(&k) = widest else { return Ok(None) };
        for half in
            [Interval::new(piece[k].lo, piece[k].middle()), Interval::new(piece[k].middle(), piece[k].up)]
        {
            let mut part = piece;
            part[k] = half;
            open.push(part);
        }
    }
    Ok(least.is_finite().then_some(least - 2.0 * ROUNDING))
}
