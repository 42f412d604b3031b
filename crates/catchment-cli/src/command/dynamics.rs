//! `catchment dynamics`: docking probability with speed, mass and bounce. Alias `chance`, which remains the
//! kind of its reports.

use crate::args::DesignArgs;
use crate::drop_args::DropArgs;
use crate::error_args::SpreadArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::to_stderr;
use crate::result_args::{Draw, ResultArgs, study};
use crate::setting::number;
use crate::source::read_table;
use catchment::design::{Design, SourceText, load, parse_dofs};
use catchment::document::Subject;
use catchment::pose::Dof;
use catchment::poses::{Circumstance, Dynamics, OffsetsAt, PoseTable, parse_draw, parse_pose, read_dynamics};
use catchment::problem::Problem;
use catchment::report::figure;
use catchment::study::chance::{Chance, ChanceSettings, Question, run as fall};
use clap::Args;
use std::path::PathBuf;

/// Compute the docking probability with speed, mass and bounce
///
/// Simulates trials in a rigid-body engine, each with its own speed, drift, spin, mass, friction, restitution and height, sampled from the
/// distributions that you declare. Prints the probability for single poses, or for the expected errors (the whole error box if you name no
/// errors), the same with all speeds multiplied, and beside it the quasi-static limit from exact motions.
#[derive(Debug, Args)]
#[command(
    mut_arg("trials", |arg| arg.help("Trials per pose, and per cell of a map [default: 100]")),
    mut_arg("trial_seed", |arg| arg.help("Seed of all samples [default: 1]")),
    mut_arg("error_sigma", |arg| arg.help("Normal errors with these standard deviations, such as \"x=1 mm,yaw=2 deg\"")),
    mut_arg("error_uniform", |arg| arg.help("Uniform errors within ± these bounds, such as \"x=1 mm,yaw=2 deg\"")),
    mut_arg("damping", |arg| arg.help("Viscous damping rate in 1/s: force -mass·damping·v [default: 10]")),
    mut_arg("push", |arg| arg.help("Force along the approach, in kg·D/s² [default: the damping force at the approach speed]")),
    after_long_help = "\
Examples:
  catchment dynamics design.toml --draw 'speed=50 ± 10 mm/s' \\
      --draw 'drift_x=0 ± 20 mm/s'
  catchment dynamics design.toml --dynamics laws.toml \\
      --error-sigma 'x=1 mm,yaw=2 deg'
  catchment dynamics design.toml --dynamics laws.toml \\
      --pose x=0.4 --pose 'x=0.4,pitch=5 deg' --trials 1000
  catchment dynamics design.toml --dynamics laws.toml --map x,pitch -o map.png
  catchment dynamics design.toml --draw speed=1 --times 0.01,0.1,1,10 \\
      -o speeds.svg
      against speed, down to quasi-static
  catchment dynamics design.toml --dynamics laws.toml \\
      --require 'overall.probability>=0.95'
  catchment dynamics design.toml --preset gazebo-2014 --pose x=0.3 --trials 999

A file of distributions:

  [dynamics]
  speed = { mean = \"50 mm/s\", sigma = \"10 mm/s\" }    # or \"50 ± 10 mm/s\"
  friction = { from = 0.1, to = 0.3 }                # or \"0.1..0.3\"
  mass = { median = 2, factor = 1.1 }                # or \"2 */ 1.1\", kg
  restitution = { measured = [0.1, 0.15, 0.3] }

and drift_x, drift_y, spin_roll, spin_pitch, spin_yaw, height. Lengths are in D,
angles in radians, times in s unless they have a unit; in JSON always."
)]
pub(crate) struct DynamicsArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// File of distributions (TOML), under [dynamics]
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath, help_heading = DRAWN)]
    dynamics: Option<PathBuf>,
    /// Distribution of a quantity, such as "friction=0.1..0.3" or "speed=50 ± 10 mm/s"; overrides the file; may be repeated
    #[arg(long, value_name = "NAME=LAW", allow_hyphen_values = true, help_heading = DRAWN)]
    draw: Vec<String>,
    /// Pose error to simulate, such as "x=0.2,pitch=10 deg"; may be repeated
    #[arg(long, value_name = "ERRORS", allow_hyphen_values = true, help_heading = ASKED)]
    pose: Vec<String>,
    /// Table of pose errors to simulate (CSV); - reads stdin
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath, help_heading = ASKED)]
    poses: Option<PathBuf>,
    /// Map over two errors across the error box, all others 0
    #[arg(long, value_name = "AXIS,AXIS", value_parser = two, help_heading = ASKED)]
    map: Option<[Dof; 2]>,
    /// Cells along each axis of the map
    #[arg(long, alias = "cells", value_name = "N", default_value_t = 15, value_parser = clap::value_parser!(u16).range(2..=500), help_heading = ASKED)]
    resolution: u16,
    /// Compute the probability with all velocities multiplied by each of these factors, such as "0.01,0.1,1,10"
    #[arg(long, value_name = "FACTOR,…", value_parser = number, value_delimiter = ',', help_heading = ASKED)]
    times: Vec<f64>,
    /// Sampled poses of the probability under expected errors, and of each speed
    #[arg(long, alias = "overall", value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=10_000_000), help_heading = ASKED)]
    samples: u32,
    #[command(flatten)]
    errors: SpreadArgs,
    #[command(flatten)]
    drop: DropArgs,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

const DRAWN: &str = "Random variables of every trial";
const ASKED: &str = "Poses and speeds";

pub(crate) fn run(args: &DynamicsArgs) -> Result<ExitStatus, Failure> {
    if args.drop.changes().iter().any(|change| change.option == "--slope-threshold") {
        return Err(Failure::with_help(
            "--slope-threshold ends exact motions, and dynamics follows drop tests".to_owned(),
            Some("they have friction itself: --friction, or --draw 'friction=0.2 ± 0.05'".to_owned()),
        ));
    }
    let draw: Option<Draw<Chance>> = if args.map.is_some() || !args.times.is_empty() {
        Some(|report, _| Ok(figure::chance(report)?))
    } else if args.result.names_picture() {
        return Err(Failure::with_help(
            "there is nothing to draw: neither a map nor a curve against speed".to_owned(),
            Some("add --map or --times".to_owned()),
        ));
    } else {
        None
    };
    study(&args.design, &args.result, &args.exec, draw, |problem, exec| {
        let settings = args.settings(problem.design())?;
        let question = args.question(problem)?;
        let absent = [("overall", question.errors.is_none()), ("map", question.map.is_empty())];
        let absent: Vec<&str> =
            absent.into_iter().filter_map(|(place, is_null)| is_null.then_some(place)).collect();
        args.result.check_requirements(Chance::KIND, &absent)?;
        let long = question.doubt(&settings, exec.threads());
        to_stderr(&long.into_iter().collect::<Vec<_>>());
        Ok(fall(problem, &question, &settings, exec)?)
    })
}

impl DynamicsArgs {
    fn settings(&self, design: &Design) -> Result<ChanceSettings, Failure> {
        let default = ChanceSettings::default();
        Ok(ChanceSettings {
            drop: self.drop.on(default.drop)?,
            dynamics: self.declared(design)?,
            held: !self.drop.pushes(),
            trials: self.drop.trials().unwrap_or(default.trials),
            overall: self.samples as usize,
            seed: self.drop.seed().unwrap_or(default.seed),
        })
    }

    /// The distributions of the file, overridden by those of the options.
    fn declared(&self, design: &Design) -> Result<Dynamics, Failure> {
        let mut dynamics = match &self.dynamics {
            Some(path) => read_dynamics(&SourceText::new(path, load(path)?), design)?,
            None => Dynamics::default(),
        };
        let mut drawn: Vec<Circumstance> = Vec::new();
        for text in &self.draw {
            let (of, law) = parse_draw(text, design)
                .map_err(|diagnostics| Failure::of_option("--draw", text, diagnostics))?;
            if drawn.contains(&of) {
                let message = format!("--draw says twice how {} is drawn", of.name());
                return Err(Failure::with_help(message, Some("name it once".to_owned())));
            }
            drawn.push(of);
            dynamics = dynamics.with(of, law);
        }
        if let Some((of, option)) = dynamics.declared().find_map(|(of, _)| Some((of, self.drop.fixes(of)?))) {
            let message = format!("{} is drawn from a law, and {option} gives it too", of.name());
            return Err(Failure::with_help(message, Some(format!("leave out {option}, or the law"))));
        }
        Ok(dynamics)
    }

    fn question(&self, problem: &Problem) -> Result<Question, Failure> {
        let design = problem.design();
        let mut requested = Question { times: self.times.clone(), ..Question::default() };
        for text in &self.pose {
            let pose = parse_pose(text, design)
                .map_err(|diagnostics| Failure::of_option("--pose", text, diagnostics))?;
            requested.poses.push(pose);
        }
        if let Some(path) = &self.poses {
            let source = read_table(path)?;
            let table = PoseTable::parse(&source.text, design, OffsetsAt::Face)
                .map_err(|diagnostics| diagnostics.of(source.clone()))?;
            requested.poses.extend_from_slice(table.errors());
        }
        requested.errors = self.errors.spread(design)?;
        if let Some(axes) = self.map {
            requested = requested.with_map(problem, axes, usize::from(self.resolution));
        }
        Ok(requested.or_box(problem))
    }
}

/// Parses two different errors.
fn two(text: &str) -> Result<[Dof; 2], String> {
    parse_dofs(text).map_err(|defect| defect.to_string())?;
    let named: Result<Vec<Dof>, _> = text.split(',').map(|name| name.trim().parse::<Dof>()).collect();
    match named.map_err(|unknown| unknown.to_string())?[..] {
        [first, second] if first != second => Ok([first, second]),
        _ => Err("a map has two errors, such as x,pitch".to_owned()),
    }
}
