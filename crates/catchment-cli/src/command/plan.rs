//! `catchment plan`: the poses of a robot trial.

use super::outcome::Point;
use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::ResultArgs;
use crate::setting::number;
use catchment::diagnostic::Diagnostics;
use catchment::document::Subject;
use catchment::method::descent;
use catchment::pose::{Dof, PoseError};
use catchment::poses::{parse_angles, parse_counts, parse_length, parse_sizes};
use catchment::problem::Problem;
use catchment::report::schema::Timing;
use catchment::report::{PlanReport, figure};
use catchment::study::plan::{Pattern, TrialPlan, TrialPlanError, TrialPlanSettings, panels, run as make};
use clap::{Args, ValueEnum};
use std::time::Instant;

/// Choose the poses of a robot trial
///
/// Follows every pose of a pattern by exact motion and finds the border of the accepted set near it. Poses nearer to the border than the
/// repeatability of the robot are marked `either`: they may dock or not, and never count against the prediction. Writes a table with an empty
/// column `outcome`; fill it with aligned, jammed, missed or aligned-elsewhere and give it to `catchment validate`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment plan design.toml --pattern bracket --trials 60 \\
      --repeatability 'x=1 mm,y=1 mm,yaw=1 deg' -o plan.csv
      both sides of the border, along lines from zero
  catchment plan design.toml --pattern grid --steps x=5,y=5,yaw=6 \\
      --max 'x=1 in,y=1 in,yaw=30 deg' --symmetric \\
      --repeatability 'x=0.1 mm,y=0.1 mm'
  catchment plan design.toml --pattern lattice --step '5 mm' --along-border \\
      --symmetric --repeatability 'x=1 mm,y=1 mm' --figure plan.png
  catchment plan design.toml --pattern arc --lever '72.9 mm' \\
      --pitch '0..45:2.25 deg' --yaw '0,20 deg' --repeatability 'x=1.2 mm'
      a joint of the robot turns the face: x and pitch together
  catchment plan design.toml --pattern bracket --trials 40 \\
      --repeatability x=0.01 --require 'plan.deciding>=30'
  catchment plan out --pattern bracket --trials 60 --repeatability x=0.01
      of a result of `run -o`, with its friction

--csv prints the table for the robot, and -o writes it into a .csv file. Lengths
are in D and angles in radians unless they have a unit; in JSON always.",
    mut_arg("path", |path| path.value_name("DESIGN_OR_RESULT")
        .help("Design file, or folder written by `run -o`")
        .value_hint(clap::ValueHint::AnyPath)))]
pub(crate) struct PlanArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    #[command(flatten)]
    pattern: PatternArgs,
    /// Repeatability of the robot: standard deviation of each error, such as "x=0.1 mm,yaw=0.2 deg"; errors that are not named are exact
    #[arg(long, alias = "accuracy", value_name = "AXIS=SIZE,…")]
    repeatability: String,
    /// Trials per pose
    #[arg(long, value_name = "N", default_value_t = 1)]
    repeats: u32,
    /// Number of blocks, such as operators or days
    #[arg(long, value_name = "N", default_value_t = 1)]
    blocks: u32,
    /// Keep the trials in the order of the pattern; the default is a random order
    #[arg(long)]
    in_order: bool,
    /// End every line at its first predicted failure
    #[arg(long)]
    stop_at_first_failure: bool,
    /// Point of the moving half at which the table gives x and y
    #[arg(long, value_enum, default_value_t = Point::Face)]
    offsets_at: Point,
    /// Coefficient of friction between the halves [default: 0, or that of the result]
    #[arg(long, value_name = "MU", value_parser = number, allow_negative_numbers = true)]
    friction: Option<f64>,
    /// Seed of the order, the lines and the search for the border
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// Which poses.
#[derive(Debug, Args)]
struct PatternArgs {
    /// Pattern of the poses
    #[arg(long, value_enum, help_heading = "Poses")]
    pattern: Kind,
    /// grid: number of points along each error, such as x=5,y=5,yaw=6
    #[arg(long, value_name = "AXIS=N,…", help_heading = "Poses")]
    steps: Option<String>,
    /// lattice: step of all offsets, such as "5 mm", or of each error, such as "x=5 mm,yaw=6 deg"
    #[arg(long, value_name = "LENGTH|AXIS=SIZE,…", help_heading = "Poses")]
    step: Option<String>,
    /// grid, lattice: largest errors [default: the error box]
    #[arg(long, value_name = "AXIS=SIZE,…", help_heading = "Poses")]
    max: Option<String>,
    /// lattice: only poses within one step of the predicted border
    #[arg(long, help_heading = "Poses")]
    along_border: bool,
    /// arc: distance from the joint of the robot to the face centre
    #[arg(long, value_name = "LENGTH", help_heading = "Poses")]
    lever: Option<String>,
    /// arc: angles of the joint, such as "0..45:2.25 deg"
    #[arg(long, value_name = "ANGLES", allow_hyphen_values = true, help_heading = "Poses")]
    pitch: Option<String>,
    /// arc: yaw angles of the arcs, such as "0,20 deg" [default: 0]
    #[arg(long, value_name = "ANGLES", allow_hyphen_values = true, help_heading = "Poses")]
    yaw: Option<String>,
    /// bracket: total number of trials
    #[arg(long, value_name = "N", help_heading = "Poses")]
    trials: Option<u32>,
    /// bracket: number of lines from zero [default: as many as possible]
    #[arg(long, value_name = "N", help_heading = "Poses")]
    lines: Option<u32>,
    /// bracket: smallest distance from the border, such as "x=2 mm,y=2 mm" [default: twice the repeatability]
    #[arg(long, alias = "resolution", value_name = "AXIS=SIZE,…", help_heading = "Poses")]
    margin: Option<String>,
    /// grid, lattice, bracket: positive errors only, for symmetric halves
    #[arg(long, help_heading = "Poses")]
    symmetric: bool,
}

/// How the poses lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Points along each error
    Grid,
    /// Multiples of a step
    Lattice,
    /// A joint of the robot turns the face
    Arc,
    /// Both sides of the border, along lines from zero
    Bracket,
}

pub(crate) fn run(args: &PlanArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let output = args.result.check(TrialPlan::KIND, true)?;
    let running = args.exec.start()?;
    running.may_be_left();
    let (problem, decided_with) = args.design.decided(&running.exec)?;
    let settings = args.settings(&problem, decided_with)?;
    let plan = make(&problem, &settings, &running.exec).map_err(refused)?;
    let plan = TrialPlan { offsets_at: args.offsets_at.into(), ..plan };
    let slices = if output.wants_picture() {
        let poses: Vec<PoseError> = plan.points.iter().map(|point| point.error).collect();
        let motions = descent::DescentSettings::with_friction(settings.friction)?;
        panels(&problem, &poses, &settings.accuracy, &motions, &running.exec)?
    } else {
        Vec::new()
    };
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    drop(running);
    let report = PlanReport::new(problem.design(), plan, problem.warnings(), Some(timing));
    output.finish(&report, || Ok(figure::plan(&report, &slices)))
}

/// Parses the sizes of errors from an option.
pub(super) fn sizes(option: &str, text: &str, problem: &Problem) -> Result<[Option<f64>; 5], Failure> {
    parse_sizes(text, problem.design()).map_err(|refusal| Failure::of_option(option, text, refusal))
}

/// Parses a repeatability (ISO 9283: accuracy is a bias); errors that are not named are exact.
pub(super) fn repeatability(text: &str, problem: &Problem) -> Result<PoseError, Failure> {
    Ok(PoseError::from_array(sizes("--repeatability", text, problem)?.map(Option::unwrap_or_default)))
}

impl PlanArgs {
    fn settings(&self, problem: &Problem, decided_with: f64) -> Result<TrialPlanSettings, Failure> {
        let pattern = self.pattern.of(problem)?;
        Ok(TrialPlanSettings {
            symmetric: self.pattern.symmetric,
            repeats: self.repeats as usize,
            blocks: self.blocks as usize,
            shuffled: !self.in_order,
            stop_at_first_failure: self.stop_at_first_failure,
            seed: self.seed,
            friction: self.friction.unwrap_or(decided_with),
            ..TrialPlanSettings::new(pattern, repeatability(&self.repeatability, problem)?)
        })
    }
}

impl PatternArgs {
    fn of(&self, problem: &Problem) -> Result<Pattern, Failure> {
        self.refuse_others()?;
        let design = problem.design();
        let needed = |option: &'static str, value: &Option<String>, why: &str| {
            value.clone().ok_or_else(|| {
                let name = self.pattern.name();
                Failure::with_help(format!("--pattern {name} needs {option}"), Some(why.to_owned()))
            })
        };
        let max = self.max.as_deref().map_or(Ok([None; 5]), |text| sizes("--max", text, problem))?;
        match self.pattern {
            Kind::Grid => {
                let text =
                    needed("--steps", &self.steps, "how many points along each error, such as x=5,yaw=6")?;
                let read = parse_counts(&text, design);
                let steps = read.map_err(|refusal| Failure::of_option("--steps", &text, refusal))?;
                Ok(Pattern::Grid { steps, max })
            }
            Kind::Lattice => {
                let text = needed("--step", &self.step, "between neighbouring poses, such as \"5 mm\"")?;
                Ok(Pattern::Lattice { step: step(&text, problem)?, max, along_border: self.along_border })
            }
            Kind::Arc => {
                let why = "from the joint of the robot to the face centre, such as \"72.9 mm\": measure it, no file states it";
                let lever = needed("--lever", &self.lever, why)?;
                let pitch =
                    needed("--pitch", &self.pitch, "angles of the joint, such as \"0..45:2.25 deg\"")?;
                let refused = |option: &str, text: &str, refusal: Diagnostics| {
                    Failure::of_option(option, text, refusal)
                };
                Ok(Pattern::Arc {
                    lever: parse_length(&lever, design)
                        .map_err(|refusal| refused("--lever", &lever, refusal))?,
                    pitch: parse_angles(&pitch).map_err(|refusal| refused("--pitch", &pitch, refusal))?,
                    yaw: match &self.yaw {
                        Some(text) => {
                            parse_angles(text).map_err(|refusal| refused("--yaw", text, refusal))?
                        }
                        None => vec![0.0],
                    },
                })
            }
            Kind::Bracket => {
                let Some(trials) = self.trials else {
                    let why = "how many the robot has time for, such as 60".to_owned();
                    return Err(Failure::with_help("--pattern bracket needs --trials".to_owned(), Some(why)));
                };
                let margin = self.margin.as_deref();
                Ok(Pattern::Bracket {
                    trials: trials as usize,
                    lines: self.lines.map(|lines| lines as usize),
                    resolution: margin.map_or(Ok([None; 5]), |text| sizes("--margin", text, problem))?,
                })
            }
        }
    }

    /// Rejects options of other patterns, which would have no effect.
    fn refuse_others(&self) -> Result<(), Failure> {
        use Kind::{Arc, Bracket, Grid, Lattice};
        let given: [(&str, bool, &[Kind]); 10] = [
            ("--steps", self.steps.is_some(), &[Grid]),
            ("--step", self.step.is_some(), &[Lattice]),
            ("--max", self.max.is_some(), &[Grid, Lattice]),
            ("--along-border", self.along_border, &[Lattice]),
            ("--lever", self.lever.is_some(), &[Arc]),
            ("--pitch", self.pitch.is_some(), &[Arc]),
            ("--yaw", self.yaw.is_some(), &[Arc]),
            ("--trials", self.trials.is_some(), &[Bracket]),
            ("--lines", self.lines.is_some(), &[Bracket]),
            ("--margin", self.margin.is_some(), &[Bracket]),
        ];
        let symmetric = ("--symmetric", self.symmetric, &[Grid, Lattice, Bracket][..]);
        let other =
            given.into_iter().chain([symmetric]).find(|(_, given, of)| *given && !of.contains(&self.pattern));
        let Some((option, _, of)) = other else { return Ok(()) };
        let names: Vec<&str> = of.iter().map(|kind| kind.name()).collect();
        let message = format!("{option} has no effect with --pattern {}", self.pattern.name());
        Err(Failure::with_help(message, Some(format!("it is for --pattern {}", names.join(" and ")))))
    }
}

impl Kind {
    const fn name(self) -> &'static str {
        match self {
            Self::Grid => "grid",
            Self::Lattice => "lattice",
            Self::Arc => "arc",
            Self::Bracket => "bracket",
        }
    }
}

/// Parses one length for every free offset, or sizes by name.
fn step(text: &str, problem: &Problem) -> Result<[Option<f64>; 5], Failure> {
    if text.contains('=') {
        return sizes("--step", text, problem);
    }
    let design = problem.design();
    let length = parse_length(text, design).map_err(|refusal| Failure::of_option("--step", text, refusal))?;
    if length < 0.0 {
        return Err(Failure::with_help("--step: a size cannot be negative".to_owned(), None));
    }
    let free = problem.alignment().free;
    Ok(Dof::ALL.map(|axis| (free.contains(axis) && !axis.is_rotation()).then_some(length)))
}

/// The error of the plan, with advice.
fn refused(error: TrialPlanError) -> Failure {
    let help = match &error {
        TrialPlanError::NotDocked => Some("catchment check says where it settles instead"),
        TrialPlanError::JointElsewhere { .. } => {
            Some("--cor puts the centre of rotation, --free frees an error")
        }
        TrialPlanError::Locked { .. } => Some("--free frees it"),
        _ => None,
    };
    match help {
        Some(help) => Failure::explained(&error, Some(help.to_owned())),
        None => error.into(),
    }
}
