//! Candidates for contact near a moving half that moves in small steps.
//!
//! ```text
//!   collect about (R₀, c₀)          turn to (R, c): only the candidates are tried
//!        ╭───────────╮              valid while   |R − R₀| ≤ skin                        (chord)
//!        │   · ·     │                            |c − c₀| + radius·|R − R₀| ≤ shift     (any point of the half)
//!        │  ·   R,c  │
//!        ╰───────────╯              if not, collected again about (R, c)
//! ```
//!
//! The results are bit for bit those of a list that is collected anew at every pose: see
//! [`super::candidates`].

use super::brute::SEAM;
use super::candidates::{Candidates, Counts, FLUSH, ROUNDING, Sieve, Window};
use super::element::Meeting;
use super::search::Gaps;
use super::turned::Turned;
use super::{Contact, Pair};
use crate::pose::{CorPose, PoseError};
use crate::tolerance::TOUCHING;
use glam::{DMat3, DVec2, DVec3};

/// Contacts that pull down are searched up to this slope (sine, 30°): a tilted plug hooks under the lip of a
/// slot. Facets that lean further back belong to the undersides of the halves, which only motions that hook
/// under them search ([`Nearby::look_under`]).
const OVERHANG: f64 = 0.5;
/// The same with undersides: all normals, and their rounding.
const ANY: f64 = 2.0;

/// Possible contacts are reported to a motion of halves with many facets within [`TOUCHING`], and within this
/// share of the reach of its step.
const SHARE_MET: f64 = 0.01;

/// Skin and shift in units of the widest slack and reach: longer lists against more collecting. Flat around its optimum.
const SKIN: f64 = 1.0;

/// The pair near a pose: the features that can touch, including walls and features that a small rotation may
/// bring into contact.
#[derive(Debug, Clone)]
pub struct Nearby<'a> {
    turned: Turned<'a>,
    candidates: Candidates,
    /// Usual slack and reach of queries: the minimum for a collection.
    slack: f64,
    reach: f64,
    /// Largest distance of a moving vertex from the COR.
    radius: f64,
    /// Largest downward inclination of contact normals: minus their z-component.
    overhang: f64,
    collected: Option<Collected>,
}

/// Pose and queries for which the candidates were collected.
#[derive(Debug, Clone, Copy)]
struct Collected {
    rotation: DMat3,
    lateral: DVec2,
    slack: f64,
    reach: f64,
}

impl<'a> Nearby<'a> {
    /// For questions with up to this slack and reach; see [`Nearby::turn`].
    pub(super) fn new(pair: &'a Pair, slack: f64, reach: f64) -> Self {
        let vertices = pair.moving_shapes.iter().flat_map(|s| &s.vertices);
        let radius = vertices.map(|v| v.length()).fold(0.0, f64::max);
        let (turned, candidates) = (Turned::new(pair), Candidates::default());
        Self { turned, candidates, slack, reach, radius, overhang: OVERHANG, collected: None }
    }

    /// Discards the current pose: later results do not depend on earlier ones.
    pub fn leave(&mut self) {
        (self.overhang, self.collected) = (OVERHANG, None);
    }

    /// Also searches contacts with undersides, until [`Nearby::leave`]; returns whether this is new. The
    /// results at a pose are renewed by the next [`Nearby::turn`].
    pub fn look_under(&mut self) -> bool {
        let is_new = self.overhang < ANY;
        (self.overhang, self.collected) = (ANY, self.collected.filter(|_| !is_new));
        is_new
    }

    /// Moves to a rotation, for queries with the COR at `lateral`: keeps the features within `reach` of
    /// contact in plan view, including walls and features that support a normal only within `slack` radians:
    /// the possible contacts of a motion that rotates by up to `slack`.
    pub fn turn(&mut self, rotation: &DMat3, lateral: DVec2, slack: f64, reach: f64) {
        let slack = slack.max(ROUNDING);
        let counts = Counts { slack, lowest: -self.overhang };
        if let Some(trees) = &self.turned.pair.trees {
            return self.turned.turn_trees(rotation, trees, counts);
        }
        let holds = self.collected.is_some_and(|c| {
            let turn = chord(&c.rotation, rotation);
            slack <= c.slack
                && turn <= SKIN * c.slack
                && reach + lateral.distance(c.lateral) + self.radius * turn <= (1.0 + SKIN) * c.reach
        });
        if !holds {
            let (slack, reach) = (slack.max(self.slack), reach.max(self.reach));
            // Both features may overshoot their borders by a seam.
            let window = Window { lateral, reach: (1.0 + SKIN) * reach + 2.0 * SEAM };
            let sieve = Sieve { slack, lowest: -self.overhang, skin: SKIN * slack, window: Some(window) };
            self.candidates.collect(self.turned.pair, rotation, &sieve);
            self.collected = Some(Collected { rotation: *rotation, lateral, slack, reach });
        }
        self.turned.turn(rotation, &self.candidates, counts);
    }

    /// Height at which a half lowered from `ceiling`, not from far above, is stopped; and whether something
    /// above the ceiling would have stopped it earlier. This is the case for a half that has slid under an
    /// overhang, or beside a wall.
    pub fn height_below(&mut self, lateral: DVec2, ceiling: f64) -> (Option<f64>, bool) {
        self.turned.height_below(lateral, ceiling)
    }

    /// The same, faster if it is above `expected`.
    pub(crate) fn height_about(
        &mut self,
        lateral: DVec2,
        ceiling: f64,
        expected: f64,
    ) -> (Option<f64>, bool) {
        self.turned.height_about(lateral, ceiling, expected)
    }

    /// The height of first contact at a pose error, in D; `None` if the halves pass each other by. Fast if
    /// the last pose was near.
    pub fn height(&mut self, error: &PoseError) -> Option<f64> {
        let lateral = self.go_to(error).lateral;
        self.height_below(lateral, f64::INFINITY).0
    }

    /// The potential energy at first contact at a pose error, in D; `None` if the halves pass each other by.
    pub fn energy(&mut self, error: &PoseError) -> Option<f64> {
        let pose = self.go_to(error);
        let height = self.height_below(pose.lateral, f64::INFINITY).0?;
        Some(self.turned.pair.energy(&pose, height))
    }

    /// Whether the potential energy at first contact at a pose error is above `level`, in D: faster than the
    /// energy if it is.
    pub fn is_above(&mut self, error: &PoseError, level: f64) -> bool {
        let pose = self.go_to(error);
        let height = self.turned.pair.height_at(&pose, level);
        self.turned.is_stopped_above(pose.lateral, height)
    }

    /// Whether the halves touch at a pose error, however deep, and do not pass each other by: cheaper than the height.
    pub fn touches(&mut self, error: &PoseError) -> bool {
        let lateral = self.go_to(error).lateral;
        self.turned.is_stopped_above(lateral, f64::NEG_INFINITY)
    }

    /// Moves to a pose error, for heights.
    fn go_to(&mut self, error: &PoseError) -> CorPose {
        let pose = self.turned.pair.pose(error);
        self.turn(&pose.rotation, pose.lateral, FLUSH, 0.0);
        pose
    }

    /// All contacts, and all features closer than `reach` along their normals, with the COR at `position`.
    /// For halves with many facets, of which the reach of a step contains thousands, only those closer than
    /// 10⁻⁴ D, or a hundredth of the reach, count: the others are detected during the step.
    pub fn contacts(&mut self, position: DVec3, reach: f64, out: &mut Vec<(Contact, Meeting)>) {
        let reach = if self.turned.pair.trees.is_some() {
            reach.min((SHARE_MET * reach).max(TOUCHING))
        } else {
            reach
        };
        out.clear();
        self.turned.contacts(position, Gaps::within(reach), SEAM, |contact| out.push(contact));
    }

    /// As [`Nearby::contacts`], including contacts beyond the border of their feature by up to `seam`, in D.
    pub fn contacts_within(
        &mut self,
        position: DVec3,
        reach: f64,
        seam: f64,
        out: &mut Vec<(Contact, Meeting)>,
    ) {
        out.clear();
        self.turned.contacts(position, Gaps::within(reach), seam, |contact| out.push(contact));
    }

    /// As [`Nearby::contacts_within`], only overlaps of more than `touching`, and up to `reach`.
    pub(crate) fn overlaps_within(
        &mut self,
        position: DVec3,
        [touching, reach]: [f64; 2],
        seam: f64,
        out: &mut Vec<(Contact, Meeting)>,
    ) {
        out.clear();
        let gaps = Gaps { deep: reach, front: -touching };
        self.turned.contacts(position, gaps, seam, |contact| out.push(contact));
    }

    /// Whether the halves overlap with the COR at `position`, by more than touching.
    pub fn overlaps(&mut self, position: DVec3) -> bool {
        let rotation = self.turned.rotation;
        self.turned.overlaps(&rotation, position)
    }

    /// The same with the moving half at another rotation.
    pub(crate) fn overlaps_at(&mut self, rotation: &DMat3, position: DVec3) -> bool {
        self.turned.overlaps(rotation, position)
    }

    /// Estimated cost of all tree searches so far: counted, in nanoseconds.
    pub(crate) const fn took(&self) -> u64 {
        self.turned.took()
    }
}

/// Furthest that a unit vector is apart after the two rotations: 2 sin(θ/2).
pub(crate) fn chord(a: &DMat3, b: &DMat3) -> f64 {
    let d = *a - *b;
    let squares = d.x_axis.length_squared() + d.y_axis.length_squared() + d.z_axis.length_squared();
    (0.5 * squares).sqrt()
}
