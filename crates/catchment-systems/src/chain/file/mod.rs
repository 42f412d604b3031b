//! The chain file: modules, errors, commands, and the connector at the faces.
//!
//! ```toml
//! name = "CKBot P"
//! [chain]
//! modules = 6              # from the shape, where one is named
//! joint_sigma = "1 deg"
//! [sequence]
//! name = "P"               # "Block" with reading = "A" or "B"; "O" with first_corner = 1, 2, 3
//! [[step]]                 # own commands, instead of the shape's
//! time = 1
//! joint = 4
//! command = "-95.7 deg"    # or "slack"
//! [connector]
//! design = "x-face.toml"   # beside this file
//! ```
//!
//! `[chain]` also takes `pitch`, `face`, `overhang`, `length`, and the optional errors `encoder_step`, `link_sigma`, `base_sigma`,
//! `base_offset_sigma`, `compliance` (rad/(N·m)) with `side_force` (N). `[servo]` takes `torque` and `stiffness`, `[latch]` `force`,
//! `overhang`, `extension` and `compression` (N/mm). Lengths are in mm and angles in radians unless they have a unit.

use super::accumulation::ChainErrors;
use super::fold::{Hooks, Servo};
use super::kinematics::{ModuleDimensions, nearest_quarter};
use super::sequence::{Command, CommandSequence, CommandStep};
use super::shape::{ChainShape, FIRST_CORNERS, LatchingPair, Reading, latches};
use crate::form::{Form, FormTable};
use catchment::design::SourceText;
use catchment::diagnostic::{Diagnostic, Diagnostics};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;
use std::path::PathBuf;

/// A chain file, read.
#[derive(Debug, Clone)]
pub struct ChainFile {
    /// Name given by the user.
    pub name: String,
    /// Dimensions of a module.
    pub body: ModuleDimensions,
    /// Modules of the chain.
    pub modules: usize,
    /// How large the errors are.
    pub errors: ChainErrors,
    /// Properties of a servo.
    pub servo: Servo,
    /// Properties of a pair of latching faces.
    pub hooks: Hooks,
    /// Folding of the chain, if it folds.
    pub folding: Option<Folding>,
    /// The connector at its faces, if named.
    pub connector: Option<ConnectorLine>,
    source: SourceText,
}

/// The commands of a chain, and its final lattice.
#[derive(Debug, Clone)]
pub struct Folding {
    /// The named shape.
    pub shape: Option<ChainShape>,
    /// The commands.
    pub sequence: CommandSequence,
    /// Angles of the lattice that they end on.
    pub lattice: Vec<f64>,
    /// Place of each step in the file.
    places: Vec<Range<usize>>,
}

/// The `[connector]` of a chain file.
#[derive(Debug, Clone)]
pub struct ConnectorLine {
    /// The design file, found from the folder of the chain file.
    pub path: PathBuf,
    /// ρ in D, in place of the design's.
    pub rotation_length: Option<f64>,
    place: Range<usize>,
}

/// Default number of modules: the dissertation's longest.
const DEFAULT_MODULES: i64 = 12;
/// Most modules: the work of a fold grows with their cube.
pub const MOST_MODULES: i64 = 100;
/// Most steps.
const MOST_STEPS: usize = 1000;

impl ChainFile {
    /// Reads the text of a chain file; touches no other file.
    ///
    /// # Errors
    /// Everything that is wrong with it, each in its place.
    pub fn read(source: SourceText) -> Result<Self, Diagnostics> {
        let folder = source.path.parent().map_or_else(PathBuf::new, std::path::Path::to_path_buf);
        let kept = source.clone();
        Form::read(source, |form, root| {
            let name =
                form.word(root, "name").map_or_else(|| "chain".to_owned(), |word| word.text.to_owned());
            let (chain, named) = (form.table(root, "chain"), form.table(root, "sequence"));
            let shape = shape(form, &named);
            let default = shape.map_or(DEFAULT_MODULES, |shape| whole(shape.modules()));
            let modules = form.integer(&chain, "modules", 1..=MOST_MODULES, Some(default)) as usize;
            if let Some(shape) = shape.filter(|shape| shape.modules() != modules) {
                let message =
                    format!("{} is folded from {} modules, not {modules}", shape.name(), shape.modules());
                form.refuse(chain.span_of("modules"), message, Some("leave `modules` out"));
            }
            let body = body(form, &chain);
            let errors = errors(form, &chain);
            let (servo, hooks) = (servo(form, root), hooks(form, root));
            let folding = folding(form, root, &named, shape, modules);
            let connector = connector(form, root, &folder);
            form.close(&chain);
            form.close(&named);
            form.close(root);
            Self { name, body, modules, errors, servo, hooks, folding, connector, source: kept }
        })
    }

    /// The file, rejected for an error of a step that a later module found.
    pub fn refuse_step(&self, step: usize, message: String) -> Diagnostics {
        let place = self.folding.as_ref().and_then(|folding| folding.places.get(step).cloned());
        let help = "change the order of the steps, or their angles".to_owned();
        self.refused(place, message, Some(help))
    }

    /// The file, rejected for an error of its connector that a later module found.
    pub fn refuse_connector(&self, message: String, help: Option<String>) -> Diagnostics {
        self.refused(self.connector.as_ref().map(|line| line.place.clone()), message, help)
    }

    fn refused(&self, place: Option<Range<usize>>, message: String, help: Option<String>) -> Diagnostics {
        Diagnostics::from(Diagnostic::error("chain", message, help).at(place)).of(self.source.clone())
    }
}

/// A small count as the reader of forms has it.
fn whole(count: usize) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

fn body(form: &mut Form<'_>, chain: &FormTable<'_>) -> ModuleDimensions {
    let own = ModuleDimensions::default();
    let pitch = form.length(chain, "pitch", 1.0..=10_000.0, Some(own.pitch));
    let face = form.length(chain, "face", 1.0..=10_000.0, Some(own.face));
    // The published module's face lies half a pitch beyond its rotor, and its shell is a little shorter than the pitch.
    let overhang = form.length(chain, "overhang", 0.0..=10_000.0, Some(0.5 * pitch));
    let length = form.length(chain, "length", 1.0..=10_000.0, Some(own.length / own.pitch * pitch));
    if length > pitch {
        let message = format!("modules {length} mm long do not fit a pitch of {pitch} mm");
        form.refuse(
            chain.span_of("length"),
            message,
            Some("`length` is that of the shell, without its faces"),
        );
    }
    if face > pitch {
        let message = format!("faces {face} mm wide do not fit a lattice of {pitch} mm");
        form.refuse(chain.span_of("face"), message, None);
    }
    ModuleDimensions { pitch, face, overhang, length }
}

fn errors(form: &mut Form<'_>, chain: &FormTable<'_>) -> ChainErrors {
    const LARGE: f64 = 0.5;
    ChainErrors {
        joint_sigma: form.angle(chain, "joint_sigma", 0.0..=LARGE, Some(0.0)),
        encoder_step: form.angle(chain, "encoder_step", 0.0..=LARGE, Some(0.0)),
        link_sigma: form.length(chain, "link_sigma", 0.0..=1000.0, Some(0.0)),
        base_sigma: form.angle(chain, "base_sigma", 0.0..=LARGE, Some(0.0)),
        base_offset_sigma: form.length(chain, "base_offset_sigma", 0.0..=1000.0, Some(0.0)),
        compliance: form.number(chain, "compliance", 0.0..=1.0, Some(0.0)),
        side_force: form.number(chain, "side_force", -1000.0..=1000.0, Some(0.0)),
    }
}

fn servo(form: &mut Form<'_>, root: &FormTable<'_>) -> Servo {
    let (table, own) = (form.table(root, "servo"), Servo::default());
    let torque = form.number(&table, "torque", 1e-3..=1e4, Some(own.torque));
    let stiffness = form.number(&table, "stiffness", 1e-1..=1e6, Some(own.stiffness));
    form.close(&table);
    Servo { torque, stiffness }
}

fn hooks(form: &mut Form<'_>, root: &FormTable<'_>) -> Hooks {
    let (table, own) = (form.table(root, "latch"), Hooks::default());
    let hooks = Hooks {
        force: form.number(&table, "force", 1e-2..=1e5, Some(own.force)),
        overhang: form.length(&table, "overhang", 0.1..=100.0, Some(own.overhang)),
        extension: form.number(&table, "extension", 1e-1..=1e6, Some(own.extension)),
        compression: form.number(&table, "compression", 1e-1..=1e6, Some(own.compression)),
    };
    form.close(&table);
    hooks
}

#[derive(Clone, Copy, PartialEq)]
enum Named {
    P,
    Block,
    O,
}

fn shape(form: &mut Form<'_>, section: &FormTable<'_>) -> Option<ChainShape> {
    let named = section
        .has("name")
        .then(|| form.choice(section, "name", &[("P", Named::P), ("Block", Named::Block), ("O", Named::O)]));
    let reading = form.choice(section, "reading", &[("A", Reading::Middle), ("B", Reading::Tail)]);
    let corners = whole(*FIRST_CORNERS.start())..=whole(*FIRST_CORNERS.end());
    let first_corner = form.integer(section, "first_corner", corners, Some(2)) as usize;
    for (key, owner, belongs) in [("reading", Named::Block, "Block"), ("first_corner", Named::O, "O")] {
        if section.has(key) && named != Some(owner) {
            form.refuse(
                section.span_of(key),
                format!("`sequence.{key}` is for name = \"{belongs}\" alone"),
                None,
            );
        }
    }
    Some(match named? {
        Named::P => ChainShape::P,
        Named::Block => ChainShape::Block { reading },
        Named::O => ChainShape::O { first_corner },
    })
}

fn folding(
    form: &mut Form<'_>,
    root: &FormTable<'_>,
    named: &FormTable<'_>,
    shape: Option<ChainShape>,
    modules: usize,
) -> Option<Folding> {
    let (steps, places) = steps(form, root, modules);
    // Read here, so that the key is known even if it does not apply.
    let pairs = form.word(named, "latches");
    if let (Some(_), Some(pairs)) = (shape, &pairs) {
        form.refuse(
            pairs.span.clone(),
            "the latches of a named shape are known",
            Some("leave `latches` out"),
        );
    }
    if form.is_refused() {
        return None;
    }
    let own = !steps.is_empty();
    let sequence = match shape {
        Some(shape) => match CommandSequence::of(shape) {
            Ok(known) if own => CommandSequence { steps, latches: known.latches, source: OWN },
            Ok(known) => known,
            Err(diagnostics) => {
                form.refuse(named.span(), diagnostics.to_string(), None);
                return None;
            }
        },
        None if own => CommandSequence { steps, latches: Vec::new(), source: OWN },
        None if named.is_written() => {
            let message = "[sequence] names no shape, and there is no [[step]]";
            form.refuse(named.span(), message, Some("write name = \"P\", \"Block\" or \"O\", or the steps"));
            return None;
        }
        None => return None,
    };
    let lattice = shape.map_or_else(
        || {
            let last = sequence.commanded_angles(modules).pop().unwrap_or_default();
            last.into_iter().map(nearest_quarter).collect()
        },
        ChainShape::angles,
    );
    let places = if own { places } else { vec![named.span_of("name"); sequence.steps.len()] };
    let mut folding = Folding { shape, sequence, lattice, places };
    if let Some(pairs) = pairs {
        folding.sequence.latches = own_latches(form, pairs.text, &pairs.span, &folding.lattice);
    }
    Some(folding)
}

/// Source of the commands of a file.
const OWN: &str = "the chain file";

/// `3-6, 1-6`, each of which must be two faces opposite each other on the lattice.
fn own_latches(form: &mut Form<'_>, text: &str, span: &Range<usize>, lattice: &[f64]) -> Vec<LatchingPair> {
    let possible = latches(lattice);
    let mut result = Vec::new();
    for pair in text.split(',').map(str::trim) {
        let numbers: Vec<usize> = pair.split(['-', '–']).filter_map(|n| n.trim().parse().ok()).collect();
        if let Some(latch) = possible.iter().find(|latch| numbers == [latch.from, latch.to]) {
            result.push(*latch);
            continue;
        }
        let names: Vec<String> = possible.iter().map(|l| format!("{}-{}", l.from, l.to)).collect();
        let there = if names.is_empty() { "there are none".to_owned() } else { names.join(", ") };
        let shown: String = catchment::terminal::printable(pair).chars().take(40).collect();
        let message =
            format!("`{shown}` are no two modules whose faces meet on the lattice of the last step");
        form.refuse(span.clone(), message, Some(&format!("those that do: {there}")));
    }
    result
}

fn steps(form: &mut Form<'_>, root: &FormTable<'_>, modules: usize) -> (Vec<CommandStep>, Vec<Range<usize>>) {
    let (mut steps, mut places): (Vec<CommandStep>, Vec<Range<usize>>) = (Vec::new(), Vec::new());
    let mut commanded = vec![false; modules];
    let written = form.tables(root, "step");
    if let Some(beyond) = written.get(MOST_STEPS) {
        form.refuse(beyond.span(), format!("more than {MOST_STEPS} steps"), None);
    }
    for entry in written.iter().take(MOST_STEPS) {
        let time_s = form.number(entry, "time", 0.0..=1e6, None);
        let joint = form.integer(entry, "joint", i64::MIN..=i64::MAX, None);
        let command = command(form, entry);
        form.close(entry);
        let Some(known) = usize::try_from(joint).ok().filter(|joint| (1..=modules).contains(joint)) else {
            if entry.has("joint") {
                let message = format!("joint {joint} does not exist");
                form.refuse(
                    entry.span_of("joint"),
                    message,
                    Some(&format!("the chain has joints 1 to {modules}")),
                );
            }
            continue;
        };
        let Some(command) = command else { continue };
        if command == Command::Slack && !commanded[known - 1] {
            let message = format!("joint {known} goes slack without an earlier command");
            form.refuse(entry.span_of("command"), message, Some("command an angle first, such as 0"));
        }
        commanded[known - 1] = true;
        match steps.last_mut() {
            Some(before) if before.time_s == time_s => before.commands.push((known, command)),
            Some(before) if before.time_s > time_s => {
                let message = format!("time goes back from {} s to {time_s} s", before.time_s);
                form.refuse(entry.span_of("time"), message, Some("write the steps in the order of time"));
            }
            _ => {
                steps.push(CommandStep { time_s, commands: vec![(known, command)] });
                places.push(entry.span());
            }
        }
    }
    (steps, places)
}

/// An angle, or `"slack"`.
fn command(form: &mut Form<'_>, entry: &FormTable<'_>) -> Option<Command> {
    if !entry.has("command") {
        // Reports that the key is missing.
        form.angle(entry, "command", -PI..=PI, None);
        return None;
    }
    let written = form.text(entry.span_of("command")).trim_matches(['"', '\'']);
    if written.trim() == "slack" {
        form.word(entry, "command")?;
        return Some(Command::Slack);
    }
    if written.trim().starts_with(|c: char| c.is_alphabetic()) {
        let word = form.word(entry, "command")?;
        let shown: String = catchment::terminal::printable(word.text).chars().take(40).collect();
        let message = format!("`{shown}` is neither an angle nor \"slack\"");
        form.refuse(word.span, message, Some("write an angle such as \"-95.7 deg\", or \"slack\""));
        return None;
    }
    // Beyond a half turn a module would lie in its neighbour.
    Some(Command::Angle(form.angle(entry, "command", -2.0 * FRAC_PI_2..=2.0 * FRAC_PI_2, None)))
}

fn connector(form: &mut Form<'_>, root: &FormTable<'_>, folder: &std::path::Path) -> Option<ConnectorLine> {
    let table = form.table(root, "connector");
    let design = form.word(&table, "design");
    let rotation_length =
        table.has("rotation_length").then(|| form.number(&table, "rotation_length", 1e-3..=1e3, None));
    if table.is_written() && !table.has("design") {
        let help = "write design = \"x-face.toml\", a connector design beside this file";
        form.refuse(table.span(), "`connector.design` is missing: a path", Some(help));
    }
    form.close(&table);
    let design = design?;
    Some(ConnectorLine { path: folder.join(design.text), rotation_length, place: design.span })
}

#[cfg(test)]
mod tests;
