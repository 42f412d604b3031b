//! `catchment zraa`: the offsets that contact corrects without rotation.

use crate::args::DesignArgs;
use crate::drop_args::DropArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::method_args::pose_method_parser;
use crate::result_args::ResultArgs;
use crate::setting::{Change, with_changes};
use crate::source::read_design;
use catchment::design::Design;
use catchment::document::Subject;
use catchment::exec::Exec;
use catchment::method::Method;
use catchment::method::zraa::{AcceptedSquare, Nilsson, Zraa, ZraaSettings, run as accepted_offsets};
use catchment::problem::{Draft, Problem};
use catchment::report::figure::{self, PicturedDesign};
use catchment::report::schema::Timing;
use catchment::report::{
    AcceptedOffsets, FacesBody, FacesError, FacesReport, ReportBody, TrialsReport, ZraaBody, ZraaReport,
};
use catchment::study::trials::{self, Trials};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;

/// Compute the offsets corrected without rotation, exactly
///
/// The zero-rotation area of acceptance: all rotations are locked, whatever the design frees. With x and y free the accepted offsets are an
/// area, with a single free offset an interval. The planar families have closed forms (s-face D/3, v-face D/2, x-face D to either side). For
/// halves with a common profile the command also prints Nilsson's bound and the extrema that limit the interval; for an area, the edge of the
/// largest axis-parallel square inside (ONAA), in D. 600 exact motions check every area; if any of them disagrees, the command refuses.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment zraa design.toml
  catchment zraa design.toml --free x
      along a single axis
  catchment zraa design.toml -o region.svg
  catchment zraa s-face.toml v-face.toml x-face.toml -o faces.svg
      side by side, at their largest offsets
  catchment zraa design.toml --json | jq .area_d2
  catchment zraa design.toml --beside drop --resolution 11,21,41 -o beside.svg
      drop simulations beside it, and their disagreements
  catchment zraa design.toml --beside drop --resolution 21 --halvings 2
      again with half the time step, and a quarter

--beside locks all rotations and drops a half at a random place of every cell.
The share of the error box on the wrong side of the exact border has its 95 %
interval. CSV lists the trials of the last round.")]
pub(crate) struct ZraaArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// More designs to compare with the first; x must be their only free offset
    #[arg(value_name = "MORE", value_hint = clap::ValueHint::FilePath)]
    more: Vec<PathBuf>,
    /// Compare with trials by this method
    #[arg(long, value_name = "METHOD", value_parser = pose_method_parser(), conflicts_with = "more", help_heading = BESIDE)]
    beside: Option<Method>,
    /// Trials along every free offset; several values run in turn
    #[arg(long, value_name = "N[,N…]", value_delimiter = ',', default_value = "21", requires = "beside",
          help_heading = BESIDE)]
    resolution: Vec<usize>,
    /// Number of times that the time step of drop simulations is halved, at the finest resolution
    #[arg(long, value_name = "TIMES", default_value_t = 0, requires = "beside", help_heading = BESIDE)]
    halvings: u32,
    /// Seed of the positions inside the cells
    #[arg(long, value_name = "SEED", default_value_t = 1, requires = "beside", help_heading = BESIDE)]
    seed: u64,
    #[command(flatten)]
    drop: DropArgs,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

const BESIDE: &str = "Comparison with trials";

pub(crate) fn run(args: &ZraaArgs) -> Result<ExitStatus, Failure> {
    let count = args.more.len() + 1;
    if count > FacesReport::MOST {
        return Err(FacesError::TooMany { count }.into());
    }
    let changes = args.drop.changes();
    match &args.beside {
        Some(method) => return beside(args, with_changes(method, &changes)?),
        None => {
            if let Some(Change { option, .. }) = changes.first() {
                let message = format!("{option} is a setting of drop, and no trials were requested");
                return Err(Failure::with_help(
                    message,
                    Some("add --beside drop, or leave it out".to_owned()),
                ));
            }
        }
    }
    let kind = if args.more.is_empty() { AcceptedOffsets::KIND } else { FacesBody::KIND };
    let output = args.result.check(kind, true)?;
    // Rotations are locked, so the stability of the mated pose against them is irrelevant here.
    let mut problems = vec![args.design.halves()?];
    for path in &args.more {
        problems.push(args.design.change(Draft::read(read_design(path)?)?)?.build()?);
    }
    let running = args.exec.start()?;
    if output.wants_picture() {
        figure::ensure_fits(0, &running.exec)?;
    }
    let corrections: Vec<Correction> =
        problems.iter().map(|problem| Correction::of(problem, &running.exec)).collect::<Result<_, _>>()?;
    drop(running);
    if let ([problem], [correction]) = (&problems[..], &corrections[..]) {
        let report = ZraaReport::new(problem.design(), correction.offsets(problem), Vec::new(), None);
        let Correction { zraa, square, .. } = correction;
        return output.finish(&report, || Ok(figure::region(problem.design(), zraa, square)));
    }
    let both = || problems.iter().zip(&corrections);
    let body = |(problem, correction): (&Problem, &Correction)| ZraaBody {
        design: problem.design().clone(),
        result: correction.offsets(problem),
    };
    let report = FacesReport::new(both().map(body).collect())
        .map_err(|error| Failure::with_help(error.to_string(), Some("--free x does".to_owned())))?;
    output.finish(&report, || {
        let shown: Vec<PicturedDesign<'_>> = both().filter_map(Correction::face).collect();
        Ok(figure::faces(&shown)?)
    })
}

/// The offsets that a design corrects without rotation.
struct Correction {
    zraa: Zraa,
    square: AcceptedSquare,
    nilsson: Option<Nilsson>,
}

impl Correction {
    fn of(problem: &Problem, exec: &Exec) -> Result<Self, Failure> {
        let zraa = accepted_offsets(problem.pair(), &ZraaSettings::default(), exec)?;
        let square = AcceptedSquare::of(&zraa, exec)?;
        let nilsson = Nilsson::beside(&zraa, problem.pair());
        Ok(Self { zraa, square, nilsson })
    }

    fn offsets(&self, problem: &Problem) -> AcceptedOffsets {
        AcceptedOffsets::new(problem.design(), &self.zraa, &self.square, self.nilsson.as_ref())
    }

    fn face<'a>((problem, correction): (&'a Problem, &'a Self)) -> Option<PicturedDesign<'a>> {
        let Zraa::Interval { from, to, .. } = correction.zraa else { return None };
        Some(PicturedDesign {
            design: problem.design(),
            connector: problem.connector(),
            pair: problem.pair(),
            reach: [from, to],
            nilsson: correction.nilsson,
        })
    }
}

/// Compares trials with the exact region, all rotations locked.
fn beside(args: &ZraaArgs, method: Method) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let output = args.result.check(Trials::KIND, true)?;
    let sliding = |design: Design| {
        let free = design.alignment.free.iter().filter(|dof| !dof.is_rotation()).collect();
        design.with_free(free)
    };
    let problem = args.design.draft()?.change("--beside", sliding)?.build()?;
    let running = args.exec.start()?;
    if output.wants_picture() {
        figure::ensure_fits(0, &running.exec)?;
    }
    let resolutions = args.resolution.clone();
    let settings = trials::TrialsSettings { method, resolutions, halvings: args.halvings, seed: args.seed };
    let results = trials::run(&problem, &settings, &running.exec)?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    drop(running);
    let report = TrialsReport::new(problem.design(), results, problem.warnings(), Some(timing));
    output.finish(&report, || Ok(figure::trials(&report)))
}
