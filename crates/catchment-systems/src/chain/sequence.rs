//! Commands over time, for every joint.
//!
//! ```text
//!   t (s)   joint 4    joint 5         the dissertation's table 6.2, for the P
//!     0       0          0             straight
//!     1     −1.67        0             an L, 5.7° past the right angle
//!     3     −1.67      −1.74           presses module 6 against module 3: the first layer latches
//!     4     slack      slack           the connectors realign themselves
//!     5     slack      −1.74           the second layer latches
//!     6     slack      slack           realigned, no power
//! ```
//!
//! Seconds, radians. A joint that is not named keeps its command; at first all hold 0. The row for 2 s does
//! not exist. The text calls the L "slightly less than π/2", which is true of its inner angle, 84.3°: the
//! command is 95.7°. The text gives no numbers for "the same sequence was repeated" for the Block and "a
//! similar procedure" for the O: their commands here are ours.

use super::kinematics::nearest_quarter;
use super::shape::{ChainShape, LatchingPair, Reading, latches};
use catchment::design::SourceText;
use catchment::diagnostic::{Diagnostic, DiagnosticCollector, Diagnostics};
use catchment::suggest::number_help;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// Command to a joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Command {
    /// Go to this angle and hold it, in radians.
    Angle(f64),
    /// Apply no torque.
    Slack,
}

impl Command {
    /// `−1.67`, or `slack`.
    pub fn text(self) -> String {
        match self {
            Self::Angle(angle) => catchment::document::number(angle),
            Self::Slack => "slack".to_owned(),
        }
    }
}

/// Commands to joints at one time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CommandStep {
    /// Time, in seconds.
    pub time_s: f64,
    /// Joints, numbered from 1, and their commands.
    pub commands: Vec<(usize, Command)>,
}

/// Commands over time, and the pairs of faces that may latch on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct CommandSequence {
    /// In the order of time.
    pub steps: Vec<CommandStep>,
    /// Pairs that may latch.
    pub latches: Vec<LatchingPair>,
    /// Source of the commands.
    pub source: &'static str,
}

const TABLE_6_2: &str = include_str!("../../data/table-6.2-latching-sequence.csv");
/// The commands of table 6.2: the first joint makes the L, the second presses.
const L: Command = Command::Angle(-1.67);
const PRESS: Command = Command::Angle(-1.74);
/// Ours: as far past straight as [`PRESS`] is past the right angle.
const PUSH: Command = Command::Angle(-0.17);
const STRAIGHT: Command = Command::Angle(0.0);
/// Ours, for the O: open enough that nothing touches.
const OPEN: Command = Command::Angle(-1.3);
const SQUARE: Command = Command::Angle(-FRAC_PI_2);

impl CommandSequence {
    /// The sequence of a shape.
    ///
    /// # Errors
    /// Never at present: a test reads the stored table.
    pub fn of(shape: ChainShape) -> Result<Self, Diagnostics> {
        let steps = match shape {
            ChainShape::P => table(&SourceText::new("table-6.2-latching-sequence.csv", TABLE_6_2))?,
            // The fold presses 5 against 2, and brings 6 to 1; joint 2 presses those.
            ChainShape::Block { reading: Reading::Middle } => {
                let mut steps = lattice_step(0.0, 3, 4);
                steps.extend([
                    CommandStep { time_s: 7.0, commands: vec![(2, PUSH)] },
                    CommandStep { time_s: 8.0, commands: vec![(2, Command::Slack)] },
                ]);
                steps
            }
            ChainShape::Block { reading: Reading::Tail } => {
                let fold = |time_s, command| CommandStep { time_s, commands: vec![(2, command)] };
                let mut steps = lattice_step(0.0, 4, 5);
                steps.extend([
                    fold(7.0, PRESS),
                    fold(8.0, Command::Slack),
                    fold(9.0, PRESS),
                    fold(10.0, Command::Slack),
                ]);
                steps
            }
            ChainShape::O { .. } => ring(&shape.turned()),
        };
        let source = match shape {
            ChainShape::P => "the dissertation's table 6.2",
            _ => "ours, after table 6.2: the dissertation does not tabulate them",
        };
        Ok(Self { steps, latches: latches(&shape.angles()), source })
    }

    /// Commands to all joints of a chain at the end of every step; joint k is at k − 1.
    pub fn commanded(&self, modules: usize) -> Vec<Vec<Command>> {
        let mut now = vec![STRAIGHT; modules];
        let mut result = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            for (joint, command) in &step.commands {
                if let Some(commanded) = now.get_mut(joint - 1) {
                    *commanded = *command;
                }
            }
            result.push(now.clone());
        }
        result
    }

    /// Angles for the commands of every step; a slack joint is assumed at the quarter turn nearest to its
    /// last angle, to which the latched faces pull it.
    pub fn commanded_angles(&self, modules: usize) -> Vec<Vec<f64>> {
        let mut now = vec![0.0; modules];
        let commanded = self.commanded(modules);
        let mut result = Vec::with_capacity(commanded.len());
        for commands in commanded {
            for (angle, command) in now.iter_mut().zip(commands) {
                *angle = match command {
                    Command::Angle(angle) => angle,
                    Command::Slack => nearest_quarter(*angle),
                };
            }
            result.push(now.clone());
        }
        result
    }
}

/// Table 6.2 for another pair of joints.
fn lattice_step(start_s: f64, bend: usize, press: usize) -> Vec<CommandStep> {
    let rows = [
        (0.0, STRAIGHT, STRAIGHT),
        (1.0, L, STRAIGHT),
        (3.0, L, PRESS),
        (4.0, Command::Slack, Command::Slack),
        (5.0, Command::Slack, PRESS),
        (6.0, Command::Slack, Command::Slack),
    ];
    rows.map(|(time, a, b)| CommandStep { time_s: start_s + time, commands: vec![(bend, a), (press, b)] })
        .to_vec()
}

/// All corners fold together; then the two far corners press the last face onto the first, twice. Four slack
/// corners would shear the ring, so the first holds.
fn ring(corners: &[usize]) -> Vec<CommandStep> {
    let [first, far, farther, last] = corners else { return Vec::new() };
    let all = |command| corners.iter().map(|k| (*k, command)).collect::<Vec<_>>();
    let press = || vec![(*far, PRESS), (*farther, PRESS)];
    let near = || vec![(*first, SQUARE), (*last, L)];
    let loose = || [far, farther, last].map(|joint| (*joint, Command::Slack)).to_vec();
    let rows = [
        (0.0, all(STRAIGHT)),
        (1.0, all(OPEN)),
        (3.0, near()),
        (5.0, press()),
        (6.0, loose()),
        (7.0, press()),
        (8.0, loose()),
    ];
    rows.map(|(time_s, commands)| CommandStep { time_s, commands }).to_vec()
}

/// Reads a table of commands: `time_s,module_4,module_5`, angles in radians or `slack`.
///
/// # Errors
/// Everything that is wrong with it, each in its place.
pub fn table(source: &SourceText) -> Result<Vec<CommandStep>, Diagnostics> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(source.text.as_bytes());
    let mut wrong = DiagnosticCollector::default();
    let joints: Vec<Option<usize>> = match reader.headers() {
        Ok(names) => names.iter().skip(1).map(joint_of).collect(),
        Err(error) => {
            wrong.push(Diagnostic::error("chain", error.to_string(), None));
            return Err(wrong.of(source.clone()));
        }
    };
    if joints.is_empty() || joints.contains(&None) {
        let help = "the header is time_s and a column module_N for each joint".to_owned();
        wrong.push(
            Diagnostic::error("chain", "a column is of no module", Some(help))
                .at(Some(0..first_line(source))),
        );
    }
    let mut steps: Vec<CommandStep> = Vec::new();
    for record in reader.records() {
        let record = match record {
            Ok(record) => record,
            Err(error) => {
                wrong.push(Diagnostic::error("chain", error.to_string(), None));
                continue;
            }
        };
        let start = record.position().map_or(0, |p| p.byte() as usize);
        let end = source.text[start..].find('\n').map_or(source.text.len(), |at| start + at);
        let mut refuse =
            |what: String, help| wrong.push(Diagnostic::error("chain", what, help).at(Some(start..end)));
        let time_s = match record.get(0).unwrap_or_default().parse::<f64>() {
            Ok(time) if time.is_finite() => time,
            _ => {
                let cell = record.get(0).unwrap_or_default();
                refuse(format!("`{cell}` is no time in seconds"), number_help(cell));
                continue;
            }
        };
        if steps.last().is_some_and(|before| before.time_s >= time_s) {
            refuse(format!("{time_s} s does not come after the row before"), None);
        }
        let mut commands = Vec::new();
        for (joint, cell) in joints.iter().flatten().zip(record.iter().skip(1)) {
            match (cell, cell.parse::<f64>()) {
                ("slack", _) => commands.push((*joint, Command::Slack)),
                (_, Ok(angle)) if angle.is_finite() => commands.push((*joint, Command::Angle(angle))),
                _ => refuse(format!("`{cell}` is neither an angle in radians nor slack"), number_help(cell)),
            }
        }
        steps.push(CommandStep { time_s, commands });
    }
    if wrong.is_empty() { Ok(steps) } else { Err(wrong.of(source.clone())) }
}

fn joint_of(name: &str) -> Option<usize> {
    name.strip_prefix("module_")?.parse().ok().filter(|joint| *joint > 0)
}

fn first_line(source: &SourceText) -> usize {
    source.text.find('\n').unwrap_or(source.text.len())
}

#[cfg(test)]
mod tests {
    use super::super::kinematics::{ModuleDimensions, PlanarPose, rotors, wrapped};
    use super::*;
    use std::f64::consts::PI;

    /// Rotors 5 and 6 with rotor 3 at the origin and the link behind it along x.
    fn seen_from_3(angles: &[f64]) -> [PlanarPose; 2] {
        let rotors = rotors(&ModuleDimensions::default(), angles);
        [4, 5].map(|k: usize| PlanarPose {
            x: rotors[k].x - rotors[2].x,
            y: rotors[k].y - rotors[2].y,
            ..rotors[k]
        })
    }

    fn near(result: PlanarPose, x: f64, y: f64) {
        assert!((result.x - x).abs() < 0.006 && (result.y - y).abs() < 0.006, "{result:?} for {x} {y}");
    }

    #[test]
    fn table_6_2_is_the_sequence_of_the_p() {
        let sequence = CommandSequence::of(ChainShape::P).unwrap();
        assert_eq!(sequence.steps, lattice_step(0.0, 4, 5));
        assert_eq!(
            sequence.steps.iter().map(|s| s.time_s).collect::<Vec<_>>(),
            [0.0, 1.0, 3.0, 4.0, 5.0, 6.0]
        );
        let commanded = sequence.commanded(6);
        assert_eq!(commanded[1][3], Command::Angle(-1.67));
        assert_eq!((commanded[4][3], commanded[4][4]), (Command::Slack, Command::Angle(-1.74)));
        // 5.68° and 9.69° past the right angle.
        assert!(((1.67 - FRAC_PI_2).to_degrees() - 5.68).abs() < 0.005);
        assert!(((1.74 - FRAC_PI_2).to_degrees() - 9.69).abs() < 0.005);
    }

    /// The states of table 6.2 to 0.01 mm: rotors 5 and 6, and the heading's error.
    #[test]
    fn the_commanded_states_are_the_published_ones() {
        let q = -FRAC_PI_2;
        let [five, six] = seen_from_3(&[0.0, 0.0, 0.0, q, q, 0.0]);
        near(five, 95.0, -95.0);
        near(six, 0.0, -95.0);
        let [five, six] = seen_from_3(&[0.0, 0.0, 0.0, -1.67, 1.67 - PI, 0.0]);
        near(five, 85.59, -94.53);
        near(six, -9.41, -94.53);
        let angles = CommandSequence::of(ChainShape::P).unwrap().commanded_angles(6);
        let [five, six] = seen_from_3(&angles[2]);
        near(five, 85.59, -94.53);
        near(six, -6.01, -69.34);
        assert!((wrapped(six.heading + PI).to_degrees() + 15.38).abs() < 0.006, "{}", six.heading);
        let [five, six] = seen_from_3(&angles[4]);
        near(five, 95.0, -95.0);
        near(six, 1.36, -79.0);
        assert!((wrapped(six.heading + PI).to_degrees() + 9.69).abs() < 0.006);
    }

    #[test]
    fn table_defects_are_reported_in_their_places() {
        let read = |text: &str| table(&SourceText::new("t.csv", text));
        assert_eq!(read("time_s,module_2\n0,0\n1,slack\n").unwrap().len(), 2);
        let commanded = |text: &str| read(text).unwrap_err().to_string();
        assert!(commanded("time_s,modul_2\n0,0\n").starts_with("t.csv:1:1: a column is of no module"));
        let all = commanded("time_s,module_2\n1,0\n1,slakc\nx,0\n");
        assert!(
            all.contains("t.csv:3:1: 1 s does not come after")
                && all.contains("t.csv:3:1: `slakc` is neither")
        );
        assert!(all.contains("t.csv:4:1: `x` is no time"), "{all}");
        assert!(commanded("time_s,module_1\n0,0,0\n").contains("record"), "a row of another length");
    }

    #[test]
    fn commands_end_slack() {
        let shapes = [
            ChainShape::P,
            ChainShape::Block { reading: Reading::Middle },
            ChainShape::Block { reading: Reading::Tail },
        ];
        for shape in shapes.into_iter().chain([ChainShape::O { first_corner: 2 }]) {
            let commanded = CommandSequence::of(shape).unwrap().commanded(shape.modules());
            let last = commanded.last().unwrap();
            // The first corner of a ring holds its shape.
            let holds = usize::from(matches!(shape, ChainShape::O { .. }));
            for joint in shape.turned().into_iter().skip(holds) {
                assert_eq!(last[joint - 1], Command::Slack, "{shape:?} {joint}");
            }
        }
    }
}
