//! The report of a chain: JSON, text, tables for programs.

use super::accumulation::ChainErrors;
use super::docking::Probability;
use super::fold::{Event, Hooks, Servo, State, off_lattice, open_latches};
use super::kinematics::{ModuleDimensions, rotors};
use super::ring::Corners;
use super::shape::{ChainShape, cells};
use super::study::{ArrivalErrors, Length, Study};
use catchment::design::{Design, DesignParameter};
use catchment::diagnostic::Diagnostic;
use catchment::document::{number, rounded};
use catchment::report::schema::Timing;
use catchment::report::{ReportBody, ReportEnvelope};
use catchment::run::Requirement;
use serde::{Deserialize, Serialize};

mod document;

/// A chain's report, with its head.
pub type ChainReport = ReportEnvelope<ChainBody>;

/// Results for a chain. Millimetres, radians, newtons, seconds; `_d` is in D, the width of a face.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ChainBody {
    /// Its name.
    pub name: String,
    /// Number of modules.
    pub modules: usize,
    /// Dimensions of a module.
    pub body: ModuleDimensions,
    /// Sizes of the errors.
    pub errors: ChainErrors,
    /// Properties of a servo.
    pub servo: Servo,
    /// Properties of a pair of latching faces.
    pub hooks: Hooks,
    /// Number of sampled chains.
    pub chains: u64,
    /// Seed of the samples.
    pub seed: u64,
    /// The connector, if the file names a connector.
    pub connector: Option<ConnectorReport>,
    /// Share of the chains that dock at every latch; null without a connector.
    pub probability: Option<f64>,
    /// Its 95 % interval.
    pub ci95: Option<[f64; 2]>,
    /// The last face of the straight chain.
    pub straight: ArrivalErrors,
    /// Folding of the chain, if it folds.
    pub folding: Option<FoldingReport>,
    /// Choices of corners, for an O.
    pub corners: Vec<Corners>,
    /// The table over numbers of modules.
    pub lengths: Vec<Length>,
    /// Number of modules up to which a requirement is met, for each joint error of the table.
    pub reach: Vec<ChainReach>,
}

/// The connector as the chain uses it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ConnectorReport {
    /// Name of the connector.
    pub name: String,
    /// Distance from the face to the centre of rotation, derived from the chain: the last rotor, in D.
    pub center_of_rotation_d: f64,
    /// Centre of rotation in the design of the connector, which is not used here.
    pub design_center_of_rotation_d: f64,
    /// Characteristic length ρ, in D.
    pub rotation_length_d: f64,
    /// Range of offsets that are corrected without rotation, in D.
    pub offsets_d: Option<[f64; 2]>,
}

/// A sequence of commands, and the folding of the chain by it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FoldingReport {
    /// The shape, if the file names a shape.
    pub shape: Option<ChainShape>,
    /// Our reading of the source in it.
    pub reading: String,
    /// Source of the commands.
    pub commands_from: String,
    /// Joints that rotate on the lattice.
    pub turned: Vec<usize>,
    /// Cells of the rotors.
    pub cells: Vec<[i64; 2]>,
    /// Every latch in the order of the sequence.
    pub latches: Vec<ArrivalErrors>,
    /// The chain after every step.
    pub steps: Vec<FoldStepReport>,
    /// Latching events.
    pub events: Vec<Event>,
    /// Largest pressing force on each pair, in N.
    pub pressed_n: Vec<f64>,
    /// Whether every pair holds with both layers at the end.
    pub latched: bool,
    /// Largest distance of a rotor from its lattice position at the end, in mm.
    pub off_lattice_mm: f64,
    /// Largest heading error at the end, in radians.
    pub off_lattice_rad: f64,
}

/// The chain at the end of a step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FoldStepReport {
    /// Time of the step, in seconds.
    pub time_s: f64,
    /// Number of layers that hold, for each latch.
    pub layers: Vec<usize>,
    /// State of every module.
    pub modules: Vec<ModuleReport>,
}

/// A module at the end of a step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ModuleReport {
    /// Number of the module.
    pub module: usize,
    /// x of its rotor, in mm.
    pub x_mm: f64,
    /// y of its rotor, in mm.
    pub y_mm: f64,
    /// Heading behind its joint, in radians.
    pub heading_rad: f64,
    /// Angle of its joint, in radians.
    pub angle_rad: f64,
    /// The commanded angle; null for a slack joint.
    pub command_rad: Option<f64>,
    /// State of its joint.
    pub state: State,
    /// Position of its rotor by the commands alone; a slack joint counts as if at its nearest quarter turn.
    pub commanded_mm: [f64; 2],
}

/// Number of modules up to which a requirement is met.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ChainReach {
    /// Standard deviation of a joint's angle, in radians.
    pub joint_sigma_rad: f64,
    /// The requirement.
    pub requirement: Requirement,
    /// Largest number of modules of the table up to which every row meets it; null if the first row fails.
    pub modules: Option<usize>,
    /// The same, with both ends of every interval meeting it.
    pub surely: Option<usize>,
}

impl ReportBody for ChainBody {
    const KIND: &'static str = "chain";
}

/// Default requirement of a reach.
const USUAL: &str = "probability>=0.99";

impl FoldingReport {
    fn of(study: &Study) -> Option<Self> {
        let (folding, folded) = (study.file.folding.as_ref()?, study.folded.as_ref()?);
        let body = &study.file.body;
        let commanded = folding.sequence.commanded_angles(study.file.modules);
        let steps = folded.moments.iter().zip(&commanded).map(|(moment, commanded)| FoldStepReport {
            time_s: moment.time_s,
            layers: moment.latched.clone(),
            modules: (0..study.file.modules)
                .zip(rotors(body, commanded))
                .map(|(k, wanted)| ModuleReport {
                    module: k + 1,
                    x_mm: moment.rotors[k].x,
                    y_mm: moment.rotors[k].y,
                    heading_rad: moment.rotors[k].heading,
                    angle_rad: moment.angles[k],
                    command_rad: match moment.commands[k] {
                        super::sequence::Command::Angle(angle) => Some(angle),
                        super::sequence::Command::Slack => None,
                    },
                    state: moment.states[k],
                    commanded_mm: wanted.place().to_array(),
                })
                .collect(),
        });
        let last = folded.moments.last().map_or(&folding.lattice, |moment| &moment.angles);
        let (off_lattice_mm, off_lattice_rad) = off_lattice(body, last, &folding.lattice);
        let turns = folding.lattice.iter().zip(1..).filter(|(angle, _)| angle.abs() > f64::EPSILON);
        Some(Self {
            shape: folding.shape,
            reading: folding.shape.map_or_else(String::new, |shape| shape.reading().to_owned()),
            commands_from: folding.sequence.source.to_owned(),
            turned: turns.map(|(_, joint)| joint).collect(),
            cells: cells(&folding.lattice),
            latches: study.arrivals.clone(),
            steps: steps.collect(),
            events: folded.events.clone(),
            pressed_n: folded.pressed.clone(),
            latched: open_latches(folded, &folding.sequence.latches).is_empty(),
            off_lattice_mm,
            off_lattice_rad,
        })
    }
}

impl ChainBody {
    /// Of a study; the reach is that of every requirement about `probability`, or of 99 %.
    fn of(study: &Study, requirements: &[Requirement]) -> Self {
        let file = &study.file;
        let connector = study.docking.as_ref().map(|docking| ConnectorReport {
            name: untitled(docking.problem.design().clone()).name,
            center_of_rotation_d: docking.problem.alignment().center_of_rotation,
            design_center_of_rotation_d: docking.own_center_of_rotation,
            rotation_length_d: docking.problem.alignment().rotation_length,
            offsets_d: docking.offsets.as_ref().ok().copied(),
        });
        Self {
            name: file.name.clone(),
            modules: file.modules,
            body: file.body,
            errors: file.errors,
            servo: file.servo,
            hooks: file.hooks,
            chains: study.settings.chains,
            seed: study.settings.seed,
            connector,
            probability: study.probability.map(|p| p.probability),
            ci95: study.probability.map(|p| p.ci95),
            straight: study.straight.clone(),
            folding: FoldingReport::of(study),
            corners: study.corners.clone(),
            reach: reach(&study.lengths, requirements),
            lengths: study.lengths.clone(),
        }
    }
}

/// How many modules still meet every requirement about `probability`.
fn reach(lengths: &[Length], requirements: &[Requirement]) -> Vec<ChainReach> {
    let about = |requirement: &&Requirement| requirement.to_string().starts_with("probability ");
    let mut wanted: Vec<Requirement> = requirements.iter().filter(about).cloned().collect();
    if wanted.is_empty() {
        wanted.extend(USUAL.parse::<Requirement>());
    }
    let mut result = Vec::new();
    for rows in lengths.chunk_by(|a, b| a.joint_sigma_rad == b.joint_sigma_rad) {
        let mut rows: Vec<&Length> = rows.iter().filter(|row| row.docking.is_some()).collect();
        rows.sort_by_key(|row| row.modules);
        let Some(first) = rows.first() else { continue };
        for requirement in &wanted {
            let up_to = |met: &dyn Fn(&Probability) -> bool| {
                let meets = |row: &&&Length| row.docking.as_ref().is_some_and(met);
                rows.iter().take_while(meets).last().map(|row| row.modules)
            };
            let met = |value: f64| requirement.is_met_by(value);
            result.push(ChainReach {
                joint_sigma_rad: first.joint_sigma_rad,
                requirement: requirement.clone(),
                modules: up_to(&|docking| met(docking.probability)),
                surely: up_to(&|docking| docking.ci95.into_iter().all(met)),
            });
        }
    }
    result
}

/// The report of a study.
pub fn report(study: &Study, requirements: &[Requirement], timing: Option<Timing>) -> ChainReport {
    let body = ChainBody::of(study, requirements);
    let warnings = warnings(study, &body);
    ReportEnvelope::of(body, warnings, timing)
}

/// A design named without its centre of rotation and characteristic length: the report states those of the chain.
fn untitled(design: Design) -> Design {
    design.untitled(DesignParameter::CenterOfRotation).untitled(DesignParameter::RotationLength)
}

/// The warnings.
fn warnings(study: &Study, body: &ChainBody) -> Vec<Diagnostic> {
    let mut lines = Vec::new();
    if let Some(docking) = &study.docking {
        let (result, own) = (docking.problem.alignment().center_of_rotation, docking.own_center_of_rotation);
        if (result - own).abs() > 1e-9 {
            lines.push(format!(
                "the centre of rotation is the last rotor, {} D behind the face; that of the design, {} D in front of it, is not used",
                rounded(-result),
                rounded(own)
            ));
        }
        if let Err(reason) = &docking.offsets {
            lines.push(format!("no exact offsets without rotation: {reason}"));
        }
        let design = docking.problem.design();
        let width = design.unit.map(|unit| design.width * unit.metres() * 1e3);
        if let Some(width) = width.filter(|width| (width / study.file.body.face - 1.0).abs() > 0.01) {
            let face = rounded(study.file.body.face);
            lines.push(format!(
                "the design is {} mm wide, the chain's faces {face} mm: D is the chain's",
                rounded(width)
            ));
        }
    }
    if let Some(folding) = &body.folding {
        let open = folding.latches.iter().zip(&folding.pressed_n);
        let last = folding.steps.last().map(|step| step.layers.clone()).unwrap_or_default();
        for ((latch, pressed), layers) in open.zip(last) {
            let name = latch.latch.map_or_else(String::new, |latch| latch.name());
            if layers < 2 {
                lines.push(format!(
                    "{name} holds with {layers} of 2 layers: pressed with {pressed:.1} N at most, a layer needs {} N",
                    number(body.hooks.force)
                ));
            }
        }
    }
    lines.into_iter().map(|text| Diagnostic::warning(ChainBody::KIND, text)).collect()
}

#[cfg(test)]
mod tests;
