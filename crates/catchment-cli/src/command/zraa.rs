//! `catchment zraa`: which offsets contact corrects without any rotation.

use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{FileArgs, to_stdout};
use catchment::exec::Exec;
use catchment::method::zraa::{Nilsson, Settings, Square, Zraa, run as accepted_offsets};
use catchment::problem::{Draft, Problem};
use catchment::report::figure::{self, Face, Picture};
use catchment::report::{FacesError, FacesReport, ZraaBody, ZraaReport, csv};
use clap::Args;
use std::path::PathBuf;

/// The zero-rotation area of acceptance: offsets corrected by sliding alone, exactly
///
/// Rotations are locked whatever the design says; of x and y those that are free count. Both: the accepted
/// offsets are an area. One: they are an interval, which for the planar families has a closed form
/// (s-face D/3, v-face D/2, x-face D to either side). Where the halves meet along one profile, Nilsson's bound
/// for such profiles stands beside it, and the extrema that limit this one. Beside an area stands the ONAA in D: the
/// edge of the largest axis-parallel square inside, wherever it lies.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment zraa design.toml\n  \
    catchment zraa design.toml --free x             along one axis only\n  \
    catchment zraa design.toml -o region.svg        with a picture (.svg, .png) or the polygons (.csv)\n  \
    catchment zraa s-face.toml v-face.toml x-face.toml -o faces.svg\n                                                  side by side, at their largest offsets\n  \
    catchment zraa design.toml --json | jq .area_d2")]
pub(crate) struct ZraaArgs {
    #[command(flatten)]
    design: DesignArgs,
    /// More designs, to stand beside the first; x must be their only free offset
    #[arg(value_name = "MORE", value_hint = clap::ValueHint::FilePath)]
    more: Vec<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    file: FileArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// Pixels per unit of a picture.
const PNG_SCALE: f32 = 2.0;

pub(crate) fn run(args: &ZraaArgs) -> Result<ExitStatus, Failure> {
    let kind = args.file.kind(&["svg", "png", "csv"])?;
    let count = args.more.len() + 1;
    if count > FacesReport::MOST {
        return Err(FacesError::TooMany { count }.into());
    }
    // Rotations play no part, so whether the mated pose holds against them is of no interest here.
    let mut problems = vec![args.design.problem()?];
    for path in &args.more {
        problems.push(args.design.change(Draft::open(path)?)?.build()?);
    }
    let running = args.exec.start()?;
    if matches!(kind, Some("svg" | "png")) {
        figure::ensure_fits(0, &running.exec)?;
    }
    let answers: Vec<Answer> =
        problems.iter().map(|problem| Answer::of(problem, &running.exec)).collect::<Result<_, _>>()?;
    drop(running);
    let (records, picture, told): (_, Result<Picture, _>, _) =
        if let ([problem], [answer]) = (&problems[..], &answers[..]) {
            let Answer { zraa, square, nilsson } = answer;
            let report = ZraaReport::new(problem.design(), zraa, square, nilsson.as_ref());
            let told = if args.json { report.to_json()? } else { report.table() };
            (report.records(), Ok(figure::region(problem.design(), zraa, square)), told)
        } else {
            let report = FacesReport::new(problems.iter().zip(&answers).map(Answer::body).collect())
                .map_err(|error| Failure::with_help(error.to_string(), Some("--free x does".to_owned())))?;
            let told = if args.json { report.to_json()? } else { report.table() };
            let shown: Vec<Face<'_>> = problems.iter().zip(&answers).filter_map(Answer::face).collect();
            (report.records(), figure::faces(&shown), told)
        };
    match kind {
        Some("svg") => args.file.write(picture?.svg().as_bytes())?,
        Some("png") => args.file.write(&picture?.png(PNG_SCALE)?)?,
        Some(_) => args.file.write(&csv(&records)?)?,
        None => {}
    }
    to_stdout(&told)?;
    Ok(ExitStatus::Done)
}

/// What is known of one design.
struct Answer {
    zraa: Zraa,
    square: Square,
    nilsson: Option<Nilsson>,
}

impl Answer {
    fn of(problem: &Problem, exec: &Exec) -> Result<Self, Failure> {
        let zraa = accepted_offsets(problem.pair(), &Settings::default(), exec)?;
        let square = Square::of(&zraa, exec)?;
        let nilsson = Nilsson::beside(&zraa, problem.pair());
        Ok(Self { zraa, square, nilsson })
    }

    fn body((problem, answer): (&Problem, &Self)) -> ZraaBody {
        ZraaBody::new(problem.design(), &answer.zraa, &answer.square, answer.nilsson.as_ref())
    }

    fn face<'a>((problem, answer): (&'a Problem, &'a Self)) -> Option<Face<'a>> {
        let Zraa::Interval { from, to, .. } = answer.zraa else { return None };
        Some(Face {
            design: problem.design(),
            connector: problem.connector(),
            pair: problem.pair(),
            reach: [from, to],
            nilsson: answer.nilsson,
        })
    }
}
