//! A chain with springs that follows commands: contact, latches, collisions.
//!
//! ```text
//!   joint      torque = clamp(stiffness · (command − angle), ± stall)          slack: no torque
//!   contact    two springs a face, at its two edges, if the faces would overlap
//!   latch      a layer snaps when the pressing force reaches its force; then springs hold the pair
//!
//!   open ──press──▶ one layer ──slack: realigned──▶ one layer, aligned ──press──▶ both layers
//!     └────────────── press, faces centred: both layers at once, twice the force ─────▶
//! ```
//!
//! Quasi-static: commands ramp within a second, and at every sub-step the chain is at the minimum of its
//! energy nearest to its last state. Faces that meet farther off-centre than half the overhang engage a
//! single layer: the other layer's hook rides beside its trench, and the pair rests off-centre by up to the
//! overhang, until a joint between the faces goes slack; then the flexures pull the pair to its aligned pose.
//! The next press latches the second layer.
//!
//! Every step is checked: its commands may not put two modules into the same cell, and module bodies, without
//! their faces, may not overlap during the step; pairs that latch may press.
//!
//! Source: the dissertation, section 6.3.1 (p. 104–105) gives this order of events; 10.9 N·m (p. 103), 9.61 N
//! (p. 101), stiffnesses of the design o = 5.1 mm, t = 3.0 mm in table 6.1. Our own assumptions are: the
//! servo's stiffness, which is not stated; that 9.61 N, the highest force of a test with one dip per layer,
//! is the force of a single layer; the rule for the riding hook. Not promised: friction, the ramps of the
//! X-Face before it latches (the faces are flat here), and times: only their order is meaningful.

mod collision;
mod pair;
mod solve;
#[cfg(test)]
mod tests;

pub use pair::LatchedLayers;

use super::kinematics::{ModuleDimensions, PlanarPose, rotors, wrapped};
use super::sequence::{Command, CommandSequence};
use super::shape::LatchingPair;
use catchment::exec::{Cancelled, Exec};
use pair::Pair;
use serde::{Deserialize, Serialize};
use solve::Chain;

/// Properties of a servo.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Servo {
    /// Stall torque, in N·m.
    pub torque: f64,
    /// Torque per radian of deviation from the command, in N·m/rad.
    pub stiffness: f64,
}

impl Default for Servo {
    /// EX-106+: 10.9 N·m (section 6.3, p. 103). The stiffness is ours: full torque 3.1° off.
    fn default() -> Self {
        Self { torque: 10.9, stiffness: 200.0 }
    }
}

/// Properties of a pair of latching faces.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Hooks {
    /// Pressing force that latches a layer, in N.
    pub force: f64,
    /// Overhang of a hook, in mm.
    pub overhang: f64,
    /// Stiffness of the latched pair, in N/mm.
    pub extension: f64,
    /// Stiffness of faces in compression, in N/mm.
    pub compression: f64,
}

impl Default for Hooks {
    /// The three-sided face, o = 5.1 mm and t = 3.0 mm: section 6.2 (p. 101) and table 6.1.
    fn default() -> Self {
        Self { force: 9.61, overhang: 5.1, extension: 108.0, compression: 26.01 }
    }
}

/// Settings that change the folding of a chain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FoldSettings {
    /// The servos.
    pub servo: Servo,
    /// The faces.
    pub hooks: Hooks,
    /// Sub-steps of a ramp.
    pub substeps: usize,
}

impl Default for FoldSettings {
    fn default() -> Self {
        // Steps of 1.7° at most for table 6.2: a face moves 3 mm, a tenth of the room between two modules.
        Self { servo: Servo::default(), hooks: Hooks::default(), substeps: 60 }
    }
}

/// State of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum State {
    /// Near its command.
    Holding,
    /// At its stall torque.
    Stalled,
    /// Without torque.
    Slack,
}

/// A latching event of one layer or of both.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Event {
    /// Time of the event; commands ramp within a second.
    pub time_s: f64,
    /// The module nearer to the base.
    pub from: usize,
    /// The module farther from the base.
    pub to: usize,
    /// Number of layers that hold from now on.
    pub layers: usize,
    /// Pressing force at that moment, in N.
    pub force_n: f64,
    /// Offset across the face, in mm.
    pub lateral_mm: f64,
    /// Angle between the faces, in radians.
    pub angle_rad: f64,
}

/// The chain at the end of a step's ramp.
#[derive(Debug, Clone, PartialEq)]
pub struct FoldMoment {
    /// Time of the step.
    pub time_s: f64,
    /// Commands to all joints.
    pub commands: Vec<Command>,
    /// Angle of every joint.
    pub angles: Vec<f64>,
    /// States of all joints.
    pub states: Vec<State>,
    /// Rotors.
    pub rotors: Vec<PlanarPose>,
    /// Layers that hold, for each pair of the sequence.
    pub latched: Vec<usize>,
}

/// Result of a sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Folded {
    /// After every step.
    pub moments: Vec<FoldMoment>,
    /// Latching events, in order.
    pub events: Vec<Event>,
    /// Time and joint angles at the start of every ramp and after every sub-step.
    pub track: Vec<(f64, Vec<f64>)>,
    /// Largest pressing force that each pair has seen, in N.
    pub pressed: Vec<f64>,
}

/// Why a sequence cannot be followed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FoldError {
    /// The commands put two modules into the same cell.
    #[error("at {time_s} s module {b} is sent into the cell of module {a}")]
    Cell {
        /// Number of the step, from 0.
        step: usize,
        /// Its time.
        time_s: f64,
        /// Module nearer to the base.
        a: usize,
        /// The other.
        b: usize,
    },
    /// Two modules touch on the way that do not latch with each other.
    #[error("at {time_s} s module {b} hits module {a}")]
    Collision {
        /// Number of the step, from 0.
        step: usize,
        /// Its time.
        time_s: f64,
        /// Module nearer to the base.
        a: usize,
        /// The other.
        b: usize,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Longest time that a ramp takes, in seconds.
const RAMP_S: f64 = 1.0;

/// Follows a sequence.
///
/// # Errors
/// Modules collide, or the computation was cancelled.
pub fn fold(
    body: &ModuleDimensions,
    modules: usize,
    sequence: &CommandSequence,
    settings: &FoldSettings,
    exec: &Exec,
) -> Result<Folded, FoldError> {
    let mut chain = Chain::new(*body, modules, &sequence.latches, settings);
    let mut result =
        Folded { moments: Vec::new(), events: Vec::new(), track: Vec::new(), pressed: Vec::new() };
    let commanded = sequence.commanded(modules);
    let mut before = vec![Command::Angle(0.0); modules];
    let meant = sequence.commanded_angles(modules);
    for (number, (step, commands)) in sequence.steps.iter().zip(&commanded).enumerate() {
        if let Some((a, b)) = collision::in_one_cell(body, &rotors(body, &meant[number]), &sequence.latches) {
            return Err(FoldError::Cell { step: number, time_s: step.time_s, a, b });
        }
        exec.report(number as f64 / commanded.len() as f64, "folding");
        let until = sequence.steps.get(number + 1).map_or(step.time_s + RAMP_S, |next| next.time_s);
        let length = (until - step.time_s).min(RAMP_S);
        let from: Vec<f64> = before.iter().zip(&chain.angles).map(|(b, now)| ramp_start(*b, *now)).collect();
        // Between two ramps nothing moves.
        result.track.push((step.time_s, chain.angles.clone()));
        let mut share = 0.0;
        while share < 1.0 {
            exec.check()?;
            share = advance(&mut chain, commands, &from, share, settings.substeps);
            let time_s = step.time_s + share * length;
            settle(&mut chain, time_s, &mut result.events);
            let hit = collision::first(body, &chain.rotors(), &chain.angles, &sequence.latches);
            if let Some((a, b)) = hit {
                return Err(FoldError::Collision { step: number, time_s: step.time_s, a, b });
            }
            result.track.push((time_s, chain.angles.clone()));
        }
        result.moments.push(FoldMoment {
            time_s: step.time_s,
            commands: commands.clone(),
            angles: chain.angles.clone(),
            states: chain.states(),
            rotors: chain.rotors(),
            latched: chain.pairs.iter().map(Pair::layers).collect(),
        });
        before.clone_from(commands);
    }
    result.pressed = chain.pairs.iter().map(|pair| pair.most).collect();
    Ok(result)
}

/// Ramps the commands by a sub-step, or by a part of it so small that no layer is pressed much harder than it needs; the share of
/// the ramp that is done then.
fn advance(chain: &mut Chain, commands: &[Command], from: &[f64], done: f64, substeps: usize) -> f64 {
    /// Parts of a sub-step at least.
    const FINEST: f64 = 1.0 / 256.0;
    let whole = 1.0 / substeps as f64;
    let before = chain.angles.clone();
    let mut part = 1.0;
    loop {
        // Rounding of the sum must not leave a sliver behind.
        let share =
            if done + 1.5 * part * whole > 1.0 && part == 1.0 { 1.0 } else { (done + part * whole).min(1.0) };
        for ((commanded, to), from) in chain.commanded.iter_mut().zip(commands).zip(from) {
            *commanded = match to {
                Command::Angle(to) => Some(from + share * (to - from)),
                Command::Slack => None,
            };
        }
        chain.rest();
        if part <= FINEST || !chain.is_overpressed() {
            return share;
        }
        chain.angles.clone_from(&before);
        part *= 0.5;
    }
}

/// Start of a ramp: the last command, or the angle of a slack joint.
const fn ramp_start(before: Command, now: f64) -> f64 {
    match before {
        Command::Angle(angle) => angle,
        Command::Slack => now,
    }
}

/// Finds the rest of a chain; every layer that snaps on the way moves it.
fn settle(chain: &mut Chain, time_s: f64, events: &mut Vec<Event>) {
    chain.rest();
    while chain.snap(time_s, events) {
        chain.rest();
    }
}

/// Deviation of the rotors of a chain from those for the wanted angles: the largest distance in mm, the
/// largest rotation in radians.
pub fn off_lattice(body: &ModuleDimensions, angles: &[f64], wanted: &[f64]) -> (f64, f64) {
    let (result, wanted) = (rotors(body, angles), rotors(body, wanted));
    result.iter().zip(&wanted).fold((0.0, 0.0), |(far, turn), (a, b)| {
        let turned = wrapped(a.heading - b.heading).abs();
        (f64::max(far, (a.place() - b.place()).length()), f64::max(turn, turned))
    })
}

/// Pairs of a sequence that do not hold with both layers in the end.
pub fn open_latches<'a>(folded: &Folded, latches: &'a [LatchingPair]) -> Vec<&'a LatchingPair> {
    let Some(last) = folded.moments.last() else { return latches.iter().collect() };
    latches.iter().zip(&last.latched).filter(|(_, layers)| **layers < 2).map(|(latch, _)| latch).collect()
}
