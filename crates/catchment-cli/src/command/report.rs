//! `catchment report`: a result as one interactive page.

use super::run::{SampleArgs, refused, resolution};
use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::method_args::method_parser;
use crate::output::{OutputArgs, to_stderr};
use crate::setting::number;
use crate::setting::{Change, with_changes};
use catchment::exec::Exec;
use catchment::landscape::Resolution;
use catchment::method::Method;
use catchment::problem::Problem;
use catchment::report::page::{PageParts, Studies};
use catchment::run::{Over, Run};
use catchment::terminal::shown;
use clap::{Args, ValueEnum};
use serde_json::Value;

/// Write a result as one interactive HTML page
///
/// The page works offline and needs no program. It shows the two halves in space, with a section and a slider for every error; the accepted
/// set as linked slices and as a surface; jams, tolerance window and figures of merit. Click a pose to follow its exact motion.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment report design.toml -o page.html
  catchment report out -o page.html
      from a result of `run -o`, with everything that it holds
  catchment run design.toml --window --jams -o out
      a result that holds jams and tolerance window
  catchment report design.toml -o page.html --leave-out window,jams
  catchment report design.toml --free x,y,yaw --resolution 24 -o page.html
  catchment report design.toml --friction 0.2 --samples 500 -o page.html

For a design, the command computes slices, jams and tolerance window too. A
stored result shows the jams and the window that it holds. If its mesh files
are missing or changed, the page has no halves and no motions, and states that.
`catchment view` serves the same page and recomputes on demand.",
    mut_arg("path", |path| path.value_name("RESULT_OR_DESIGN")
        .help("Design, folder written by `run -o`, or its NAME.zarr")
        .value_hint(clap::ValueHint::AnyPath)))]
pub(crate) struct ReportArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    #[command(flatten)]
    made: MadeArgs,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// How the result of a page is made.
#[derive(Debug, Clone, Args)]
pub(super) struct MadeArgs {
    /// Method that decides the outcomes of a design [default: confluence]
    #[arg(long, value_name = "METHOD", value_parser = method_parser())]
    method: Option<Method>,
    /// Cells per axis of the error grid, such as 30 or x=40,yaw=24 [default: by method and number of axes]
    #[arg(long, value_name = "CELLS", value_parser = resolution)]
    resolution: Option<Resolution>,
    /// Coefficient of friction between the halves [default: 0]
    #[arg(long, value_name = "MU", value_parser = number, allow_negative_numbers = true)]
    friction: Option<f64>,
    #[command(flatten)]
    sample: SampleArgs,
    /// Leave these parts out of the page
    #[arg(long, value_name = "PARTS", value_enum, value_delimiter = ',')]
    leave_out: Vec<Study>,
}

/// What is computed beside a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Study {
    /// Outcomes over every pair of errors with the others exactly 0, by exact motions; slices at 0 then show cells of the grid
    Slices,
    /// The most frequent jams
    Jams,
    /// The tolerance window
    Window,
}

impl MadeArgs {
    /// The same settings with another resolution, if one is given.
    pub(super) fn over(&self, resolution: Option<Resolution>) -> Self {
        Self { resolution: resolution.or(self.resolution), ..self.clone() }
    }

    /// The given options that determine the outcomes of a design.
    fn requested(&self) -> impl Iterator<Item = &'static str> {
        [
            ("--method", self.method.is_some()),
            ("--resolution", self.resolution.is_some()),
            ("--friction", self.friction.is_some()),
        ]
        .into_iter()
        .filter_map(|(option, given)| given.then_some(option))
        .chain(self.sample.requested())
    }

    /// The run settings for a design.
    fn run(&self) -> Result<Run, Failure> {
        let over = Over::Grid(self.resolution.unwrap_or_default());
        let change = |value| Change { option: "--friction", setting: "friction", value: Value::from(value) };
        let changes: Vec<Change> = self.friction.map(change).into_iter().collect();
        let method = with_changes(&self.method.clone().unwrap_or_default(), &changes)?;
        Ok(Run { over, sample: self.sample.sample(), seed: self.sample.seed, ..Run::by(method) })
    }

    /// Removes deselected parts from the page of a stored result, and notes requested parts that the result
    /// lacks.
    fn of_stored(&self, parts: &mut PageParts) {
        let Studies { jams, window, .. } = self.studies();
        parts.jams.take_if(|_| !jams);
        parts.window.take_if(|_| !window);
        let missing =
            [(jams && parts.jams.is_none(), "--jams"), (window && parts.window.is_none(), "--window")];
        let missing: Vec<&str> =
            missing.into_iter().filter(|(is, _)| *is).map(|(_, option)| option).collect();
        if !missing.is_empty() {
            parts.notes.push(format!(
                "the page has what the result holds; `catchment run` with {} stores more",
                missing.join(" ")
            ));
        }
    }

    /// The studies that the page adds.
    fn studies(&self) -> Studies {
        let wanted = |study| !self.leave_out.contains(&study);
        Studies { planes: wanted(Study::Slices), jams: wanted(Study::Jams), window: wanted(Study::Window) }
    }

    /// Computes the parts of a problem's page.
    pub(super) fn parts(&self, problem: &Problem, exec: &Exec) -> Result<PageParts, Failure> {
        let answer = self.run()?.on(problem, exec).map_err(|error| refused(problem, error))?;
        let mut parts = PageParts::of(&answer);
        parts.study(self.studies(), exec)?;
        Ok(parts)
    }
}

pub(crate) fn run(args: &ReportArgs) -> Result<ExitStatus, Failure> {
    if args.output.is_printed() && !args.output.names_stdout() {
        let help = "name the file: -o page.html, or -o - for stdout".to_owned();
        return Err(Failure::with_help("a page is a file to open in a browser".to_owned(), Some(help)));
    }
    args.output.check()?;
    let path = &args.design.path;
    let parts = if path.is_dir() {
        let requested = args.design.changed().map(|(option, _)| option).chain(args.made.requested()).next();
        if let Some(option) = requested {
            let message = format!("{option}: {} is a result, which has been decided", shown(path));
            return Err(Failure::with_help(message, Some("give the design instead".to_owned())));
        }
        let running = args.exec.start()?;
        let mut parts = PageParts::stored(path, &running.exec)?;
        args.made.of_stored(&mut parts);
        // Slices at zero are exact motions, which a stored result does not contain.
        let planes = args.made.studies().planes;
        parts.study(Studies { planes, jams: false, window: false }, &running.exec)?;
        args.output.write(&parts.page().html(&running.exec)?)?;
        parts
    } else {
        let problem = args.design.problem()?;
        let running = args.exec.start()?;
        let parts = args.made.parts(&problem, &running.exec)?;
        args.output.write(&parts.page().html(&running.exec)?)?;
        parts
    };
    to_stderr(&parts.notes);
    Ok(ExitStatus::Done)
}
