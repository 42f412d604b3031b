//! `catchment zraa`: which offsets contact corrects without any rotation.

use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{FileArgs, to_stdout};
use catchment::method::zraa::{Settings, Square, run as accepted_offsets};
use catchment::report::{ZraaReport, csv, figure};
use clap::Args;

/// The zero-rotation area of acceptance: offsets corrected by sliding alone, exactly
///
/// Rotations are locked whatever the design says; of x and y those that are free count. Both: the accepted
/// offsets are an area. One: they are an interval, which for the planar families has a closed form
/// (s-face D/3, v-face D/2, x-face D to either side). Beside the measure stands the ONAA in D: the edge of the
/// largest axis-parallel square inside, wherever it lies.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment zraa design.toml\n  \
    catchment zraa design.toml --free x             along one axis only\n  \
    catchment zraa design.toml -o region.svg        with a picture (.svg, .png) or the polygons (.csv)\n  \
    catchment zraa design.toml --json | jq .area_d2")]
pub(crate) struct ZraaArgs {
    #[command(flatten)]
    design: DesignArgs,
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
    // Rotations play no part, so whether the mated pose holds against them is of no interest here.
    let problem = args.design.problem()?;
    let (design, pair) = (problem.design(), problem.pair());
    let running = args.exec.start()?;
    if matches!(kind, Some("svg" | "png")) {
        figure::ensure_fits(0, &running.exec)?;
    }
    let zraa = accepted_offsets(pair, &Settings::default(), &running.exec)?;
    let square = Square::of(&zraa, &running.exec)?;
    drop(running);
    let report = ZraaReport::new(design, &zraa, &square);
    match kind {
        Some("svg") => args.file.write(figure::region(design, &zraa, &square).svg().as_bytes())?,
        Some("png") => args.file.write(&figure::region(design, &zraa, &square).png(PNG_SCALE)?)?,
        Some(_) => args.file.write(&csv(&report.records())?)?,
        None => {}
    }
    to_stdout(&if args.json { report.to_json()? } else { report.table() })?;
    Ok(ExitStatus::Done)
}
