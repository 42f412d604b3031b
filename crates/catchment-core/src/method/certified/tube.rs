//! A bundle around all motions of a box, followed until it lies in labelled boxes.
//!
//! ```text
//!        c₁ ▲     ┌──────┐         c₀  along the descent in the middle: every contact of the slab pushes in this direction
//!           │  ┌──┤ slab ├──┐      upper face   rises by at most the steepest c₁ per c₀ of the contacts near it
//!           │  │  │      │  │      lower face   falls likewise
//!      box ▪│──┤  │      │  │      so no motion leaves through the sides; all pass the end
//!           │  └──┤      ├──┘
//!           └─────└──────┘──▶ c₀
//! ```
//!
//! A motion goes along a combination, with non-negative weights, of the pushes wᵢ of its contacts. Its slope
//! dc₁/dc₀ is then a mean of their slopes, for any weights: speeds cancel. The bounds on a face depend only
//! on the contacts near it (Müller 1927), so a bundle can follow a valley, into which both sides push,
//! without growing.
//!
//! c is linear in the errors: straight lines of the metric at the centre of rotation, rotated so that c₀
//! points downhill. If the descent bends, the bundle is transformed to new coordinates.
//!
//! Not promised: that a bundle stays narrow. The search stops if the bundle becomes wide, if it may contain a
//! rest, or if it may meet a wall. At most one rotation may be free.

use super::interval::Interval;
use super::placed::{Bodies, PoseBox, middle};
use super::survey::{Survey, shortest};
use super::touch::Touch;
use super::tree::{Cell, Label, Tree};
use crate::contact::Nearby;
use crate::pose::{Dof, ROTATIONS};
use crate::tolerance::ROUNDING;

/// Steps at most.
const STEPS: usize = 600;
/// Bundles wider than this are given up, in D of the metric.
const WIDEST: f64 = 0.3;
/// Length of a step, as a part of the width of the bundle, and at least, in D.
const STEP: f64 = 0.5;
const LEAST_STEP: f64 = 1e-2;
/// Slopes at first, and at least, for which a slab is made wide enough.
const GUESS: f64 = 0.25;
/// Slopes above this call for other coordinates.
const BENT: f64 = 0.6;

/// Linear coordinates about a pose: `c = rows·(q − origin)`, `q = origin + columns·c`.
#[derive(Debug, Clone)]
struct Frame {
    origin: [f64; 5],
    rows: Vec<[f64; 5]>,
    columns: Vec<[f64; 5]>,
}

/// A bundle: an interval for every coordinate.
type Bundle = Vec<Interval>;

impl Frame {
    /// Coordinates about the centre of a box, with the first along the descent of its contacts.
    fn new(bodies: &Bodies, axes: &[Dof], poses: &PoseBox, touches: &[Touch]) -> Option<Self> {
        let origin = middle(poses);
        let metric = Metric::at(bodies, origin.pitch);
        // Gradients in the metric's own coordinates.
        let gradients: Vec<[f64; 5]> = touches
            .iter()
            .map(|touch| {
                let rise = touch.rise.middle().max(f64::MIN_POSITIVE);
                metric.covector(touch.rates.map(|rate| rate.middle() / rise))
            })
            .collect();
        let first = shortest(&gradients)?;
        let mut units: Vec<[f64; 5]> = vec![first];
        for dof in axes {
            let mut unit = [0.0; 5];
            unit[dof.index()] = 1.0;
            units.push(unit);
        }
        let mut basis: Vec<[f64; 5]> = Vec::new();
        // Gram and Schmidt; the axis that is most along the descent is left out.
        let along = |unit: &[f64; 5]| (0..5).map(|k| (unit[k] * first[k]).abs()).sum::<f64>();
        units[1..].sort_by(|a, b| along(a).total_cmp(&along(b)));
        for unit in units.iter().take(axes.len()) {
            let mut rest = *unit;
            for own in &basis {
                let part: f64 = (0..5).map(|k| own[k] * rest[k]).sum();
                rest = std::array::from_fn(|k| rest[k] - part * own[k]);
            }
            let length = rest.iter().map(|x| x * x).sum::<f64>().sqrt();
            if length < 1e-6 {
                return None;
            }
            basis.push(rest.map(|x| x / length));
        }
        let rows = basis.iter().map(|own| metric.row(own)).collect();
        let columns = basis.iter().map(|own| metric.column(own)).collect();
        Some(Self { origin: origin.to_array(), rows, columns })
    }

    /// Coordinates along an error, upwards or downwards.
    fn along(axes: &[Dof], poses: &PoseBox, first: usize, up: bool) -> Self {
        let unit = |k: usize, size: f64| {
            let mut unit = [0.0; 5];
            unit[k] = size;
            unit
        };
        let sign = if up { 1.0 } else { -1.0 };
        let others = axes.iter().map(|dof| dof.index()).filter(|k| *k != first);
        let rows: Vec<[f64; 5]> =
            std::iter::once(unit(first, sign)).chain(others.map(|k| unit(k, 1.0))).collect();
        Self { origin: middle(poses).to_array(), columns: rows.clone(), rows }
    }

    /// The coordinates of all poses of a box.
    fn of_box(&self, poses: &PoseBox) -> Bundle {
        let off: PoseBox = std::array::from_fn(|k| poses[k] - Interval::thin(self.origin[k]));
        self.rows.iter().map(|row| combined(row, &off).widened(ROUNDING)).collect()
    }

    /// The box around all poses with these coordinates.
    fn hull(&self, bundle: &[Interval]) -> PoseBox {
        let mut poses = self.origin.map(Interval::thin);
        for (column, part) in self.columns.iter().zip(bundle) {
            for k in 0..5 {
                poses[k] = poses[k] + *part * column[k];
            }
        }
        std::array::from_fn(|k| {
            if self.columns.iter().all(|column| column[k] == 0.0) {
                poses[k]
            } else {
                poses[k].widened(ROUNDING)
            }
        })
    }

    /// The coordinates of a bundle of another frame.
    fn of_bundle(&self, other: &Self, bundle: &[Interval]) -> Bundle {
        let row = |row: &[f64; 5]| {
            let base: f64 = (0..5).map(|k| row[k] * (other.origin[k] - self.origin[k])).sum();
            let parts = other.columns.iter().zip(bundle).map(|(column, part)| {
                let weight: f64 = (0..5).map(|k| row[k] * column[k]).sum();
                *part * weight
            });
            parts.fold(Interval::thin(base), |sum, part| sum + part).widened(ROUNDING)
        };
        self.rows.iter().map(row).collect()
    }
}

/// The metric of motion about a pose as a linear map: x − s·θ, y − s·θ, ρθ with s the displacement of the
/// face centre per rotation θ.
struct Metric {
    rho: f64,
    turn: Option<usize>,
    swing: [f64; 2],
}

impl Metric {
    fn at(bodies: &Bodies, pitch: f64) -> Self {
        let turn = ROTATIONS.into_iter().find(|dof| bodies.free.contains(*dof)).map(Dof::index);
        // All rotations except the free rotation are 0; only roll and pitch swing the face centre.
        let mut swing = [0.0; 2];
        match turn {
            Some(k) if k == Dof::Pitch.index() && bodies.slides(0) => swing[0] = bodies.cor * pitch.cos(),
            Some(k) if k == Dof::Roll.index() && bodies.slides(1) => swing[1] = -bodies.cor,
            _ => {}
        }
        Self { rho: bodies.rho, turn, swing }
    }

    /// A linear function of the metric's coordinates in terms of the errors.
    fn row(&self, own: &[f64; 5]) -> [f64; 5] {
        let mut row = *own;
        if let Some(k) = self.turn {
            row[k] = self.rho * own[k] - self.swing[0] * own[0] - self.swing[1] * own[1];
        }
        row
    }

    /// A step in the metric's coordinates in terms of the errors.
    fn column(&self, own: &[f64; 5]) -> [f64; 5] {
        let mut column = *own;
        if let Some(k) = self.turn {
            column[k] = own[k] / self.rho;
            column[0] += self.swing[0] * column[k];
            column[1] += self.swing[1] * column[k];
        }
        column
    }

    /// A gradient in the errors in terms of the metric's coordinates.
    fn covector(&self, rates: [f64; 5]) -> [f64; 5] {
        let mut own = rates;
        if let Some(k) = self.turn {
            own[k] = (rates[k] + self.swing[0] * rates[0] + self.swing[1] * rates[1]) / self.rho;
        }
        own
    }
}

/// A linear function of intervals.
fn combined(row: &[f64; 5], parts: &PoseBox) -> Interval {
    (0..5).map(|k| parts[k] * row[k]).fold(Interval::ZERO, |sum, part| sum + part)
}

/// Follows the motions of boxes.
pub(super) struct Tube<'a> {
    pub(super) bodies: &'a Bodies,
    pub(super) tree: &'a Tree,
}

impl Tube<'_> {
    /// Certified label of all motions that begin in a box, if any.
    pub(super) fn follow(&self, cell: &Cell, nearby: &mut Nearby<'_>) -> Option<Label> {
        let poses = cell.poses;
        let first = self.look(&poses, nearby)?;
        let axes = &self.tree.axes;
        let downhill = Frame::new(self.bodies, axes, &poses, &first.touches);
        if let Some(label) = downhill.and_then(|frame| self.follow_in(frame, &poses, &first, nearby)) {
            return Some(label);
        }
        // A box is no wider than itself along an error that all pushes agree on.
        axes.iter().find_map(|dof| {
            let k = dof.index();
            let up = first.pushes.iter().all(|push| push[k].lo > 0.0);
            let down = first.pushes.iter().all(|push| push[k].up < 0.0);
            let along = (up != down).then(|| Frame::along(axes, &poses, k, up))?;
            self.follow_in(along, &poses, &first, nearby)
        })
    }

    /// The same, beginning in these coordinates.
    fn follow_in(
        &self,
        mut frame: Frame,
        poses: &PoseBox,
        first: &Survey,
        nearby: &mut Nearby<'_>,
    ) -> Option<Label> {
        let mut start = frame.of_box(poses);
        let mut bundle = start.clone();
        let mut at = start[0].lo;
        let mut guess = GUESS;
        let mut ends = first.sudden;
        let mut fresh = true;
        for _ in 0..STEPS {
            let width = bundle[1..].iter().map(|part| part.width()).fold(LEAST_STEP, f64::max);
            if width > WIDEST {
                return None;
            }
            let entered = at >= start[0].up;
            if entered {
                let section = section(&bundle, at, at);
                if let Some(label) = self.label(&frame.hull(&section)) {
                    return (label != Label::Yes || !ends).then_some(label);
                }
            }
            let step = STEP * width;
            let survey = {
                let slab = slab(&bundle, at, step, guess);
                self.look(&frame.hull(&slab), nearby)?
            };
            if survey.height.is_none() {
                ends = true;
                if at + step >= start[0].up {
                    return Some(Label::Leaves);
                }
            }
            ends |= survey.sudden;
            let result = if survey.touches.is_empty() {
                Some(vec![Interval::ZERO; bundle.len() - 1])
            } else {
                slopes(&frame, &survey.pushes)
            };
            let bends = |slopes: &Vec<Interval>| slopes.iter().any(|slope| slope.middle().abs() > BENT);
            let Some(all) = result.filter(|slopes| fresh || !entered || !bends(slopes)) else {
                // Once more, in coordinates of the descent there.
                if fresh || !entered {
                    return None;
                }
                let section = section(&bundle, at, at);
                let here = self.look(&frame.hull(&section), nearby)?;
                let turned = Frame::new(self.bodies, &self.tree.axes, &frame.hull(&section), &here.touches)?;
                start = turned.of_bundle(&frame, &section);
                frame = turned;
                bundle.clone_from(&start);
                at = start[0].lo;
                fresh = true;
                continue;
            };
            let steepest = all.iter().map(|s| s.lo.abs().max(s.up.abs())).fold(0.0, f64::max);
            if steepest > guess {
                if guess > 32.0 {
                    return None;
                }
                guess = 1.5 * steepest;
                continue;
            }
            let (end, mut next) = ((at + step).next_up(), bundle.clone());
            for j in 1..bundle.len() {
                let slope = all[j - 1];
                let reach = step * 1.000_000_1;
                let (mut low, mut high) = (bundle[j], bundle[j]);
                (low.lo, low.up) =
                    (low.lo + (reach * slope.lo).min(0.0), low.lo + (reach * slope.up).max(0.0));
                (high.lo, high.up) =
                    (high.up + (reach * slope.lo).min(0.0), high.up + (reach * slope.up).max(0.0));
                let mut face = slab(&bundle, at, step, guess);
                let mut rate = |side: Interval, face: &mut Bundle| {
                    face[j] = side;
                    let poses = frame.hull(face);
                    let (_, pushes) =
                        Survey::among(self.bodies, &poses, &survey.touches, survey.sudden, nearby);
                    slopes(&frame, &pushes).map_or(slope, |slopes| slopes[j - 1])
                };
                let (falls, rises) = (rate(low, &mut face).lo, rate(high, &mut face).up);
                next[j] =
                    Interval::new(bundle[j].lo + step * falls, bundle[j].up + step * rises).widened(ROUNDING);
                if next[j].lo > next[j].up {
                    return None;
                }
                if !entered {
                    next[j] = next[j].hull(start[j]);
                }
            }
            (bundle, at) = (next, end);
            fresh = false;
            guess = (1.5 * steepest).max(GUESS);
        }
        None
    }

    /// Certified facts over a box within the root; `None` if a wall may be met.
    fn look(&self, poses: &PoseBox, nearby: &mut Nearby<'_>) -> Option<Survey> {
        let span = self.tree.places(poses)?;
        let mut among: Vec<u32> = Vec::new();
        self.tree.visit(&span, |_, cell| {
            among.extend(&cell.among);
            true
        });
        among.sort_unstable();
        among.dedup();
        let survey = Survey::of(self.bodies, poses, &among, nearby);
        (!survey.walled).then_some(survey)
    }

    /// The label of all boxes that a box meets.
    fn label(&self, poses: &PoseBox) -> Option<Label> {
        let span = self.tree.places(poses)?;
        self.tree.common_label(&span)
    }
}

/// The part of a bundle between two values of its first coordinate.
fn section(bundle: &[Interval], from: f64, to: f64) -> Bundle {
    let mut section = bundle.to_vec();
    section[0] = Interval::new(from, to.next_up());
    section
}

/// Slopes of all coordinates but the first per unit of it, between all pushes; `None` if a push may not point
/// along it, or if there are no pushes.
fn slopes(frame: &Frame, pushes: &[PoseBox]) -> Option<Vec<Interval>> {
    let mut slopes: Option<Vec<Interval>> = None;
    for push in pushes {
        let along = combined(&frame.rows[0], push);
        let own: Vec<Interval> =
            frame.rows[1..].iter().map(|row| combined(row, push).over(along)).collect::<Option<_>>()?;
        slopes = Some(match slopes {
            None => own,
            Some(all) => all.into_iter().zip(own).map(|(a, b)| a.hull(b)).collect(),
        });
    }
    slopes
}

/// The slab of a step, as wide as slopes up to `guess` can make it.
fn slab(bundle: &[Interval], at: f64, step: f64, guess: f64) -> Bundle {
    let mut slab = section(bundle, at, at + step);
    slab[1..].iter_mut().for_each(|part| *part = part.widened(1.01 * step * guess));
    slab
}
