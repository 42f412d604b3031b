//! `catchment invert`: derives the moving half from contact heights and the fixed half.

use crate::args::DesignArgs;
use crate::args::{quantity, with_advice};
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::ResultArgs;
use crate::setting::number;
use crate::source::read_table;
use catchment::design::{Design, Quantity};
use catchment::document::Subject;
use catchment::problem::Problem;
use catchment::report::figure::ensure_fits;
use catchment::terminal::shown;
use catchment_systems::invert::{
    Heights, InvertBody, InvertSettings, MAX_PIECES, ManufacturingLimits, design_file, figure, heights_of,
    invert, list_of_angles, report, wanted_from_table,
};
use clap::Args;
use glam::DMat3;
use std::path::{Path, PathBuf};

/// Derive the moving half from wanted contact heights
///
/// Inverts the Minkowski sum and keeps the fixed half of DESIGN. The wanted heights of first contact over lateral offsets are those of DESIGN
/// itself, of another design, or of a table. The result is the lowest moving half that never stops higher than wanted. The command lists the
/// places at which it stops lower, because no half reaches the wanted height on this fixed half.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment invert design.toml
      the moving half of the design itself
  catchment invert design.toml --heights other.toml -o new.toml
  catchment invert design.toml --heights wanted.csv
      a grid: x,y,height, in D
  catchment invert design.toml --pitch \"-10..10 deg/21\" --yaw 0,\"20 deg\"
  catchment run new.toml

-o FILE.toml writes the pair as a design file, its halves as convex pieces.")]
pub(crate) struct InvertArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Wanted heights: a design (.toml) or a table x,y,height in D (.csv) [default: those of DESIGN]
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    heights: Option<PathBuf>,
    /// Roll angles with wanted heights, such as -10..10 deg/21 or 5 deg,10 deg; combined with every pitch and yaw
    #[arg(long, value_name = "ANGLES", value_parser = angles, allow_hyphen_values = true)]
    roll: Vec<Angles>,
    /// Pitch angles with wanted heights: those of --heights FILE.toml, or of DESIGN
    #[arg(long, value_name = "ANGLES", value_parser = angles, allow_hyphen_values = true)]
    pitch: Vec<Angles>,
    /// Yaw angles with wanted heights; all three may be repeated
    #[arg(long, value_name = "ANGLES", value_parser = angles, allow_hyphen_values = true)]
    yaw: Vec<Angles>,
    /// Material behind the deepest point of the new half, in D
    #[arg(long, value_name = "D", value_parser = number, default_value_t = 0.25)]
    backing: f64,
    /// Smallest width of a facet that can be made, in D or with a unit
    #[arg(long, value_name = "LENGTH", default_value = "0.01", value_parser = quantity)]
    min_feature: Quantity,
    /// Smallest draft angle between the surface and the direction of pull
    #[arg(long, value_name = "ANGLE", default_value = "3 deg", value_parser = angle)]
    min_draft: f64,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

pub(crate) fn run(args: &InvertArgs) -> Result<ExitStatus, Failure> {
    let output = args.result.check_with(InvertBody::KIND, true, &["toml"])?;
    if !(0.0..=100.0).contains(&args.backing) || args.backing == 0.0 {
        let help = "a half needs material: give a number above 0".to_owned();
        return Err(Failure::with_help(format!("--backing {} is no thickness", args.backing), Some(help)));
    }
    let problem = args.design.halves()?;
    let (design, connector) = (problem.design(), problem.connector());
    let feature_d = args
        .min_feature
        .length_d(&design.scale())
        .map_err(|defect| Failure::with_help(format!("--min-feature: {defect}"), defect.help()))?;
    let running = args.exec.start()?;
    running.may_be_left();
    let exec = &running.exec;
    if output.wants_picture() {
        ensure_fits(0, exec)?;
    }
    let of_design =
        |problem: &Problem| heights_of(problem.design(), problem.connector(), DMat3::IDENTITY, exec);
    let Wanted { level, turned } =
        args.heights.as_deref().map_or(Ok(Wanted::default()), |path| wanted(path, design))?;
    let other = turned.as_ref().unwrap_or(&problem);
    let level = level.map_or_else(|| of_design(other), Ok)?;
    let all = |angles: &[Angles]| angles.iter().flat_map(|Angles(angles)| angles.clone()).collect();
    let settings = InvertSettings {
        roll: all(&args.roll),
        pitch: all(&args.pitch),
        yaw: all(&args.yaw),
        backing: args.backing,
    };
    let results = invert(design, connector, level, other.connector(), &settings, exec)?;
    drop(running);
    let report = report(design, &results, ManufacturingLimits { feature_d, draft_rad: args.min_draft });
    if output.own().is_some() {
        if report.pieces_d.len() > MAX_PIECES {
            let help = "want heights on a coarser grid".to_owned();
            let count = report.pieces_d.len();
            let message = format!("the new half has {count} convex pieces, and a design takes {MAX_PIECES}");
            return Err(Failure::with_help(message, Some(help)).ends(ExitStatus::NotComputed));
        }
        output.write_own(design_file(design, &results).as_bytes())?;
    }
    output.finish(&report, || Ok(figure(design, &results)?))
}

/// Contact heights of a file: a table without rotation, or a design that gives heights at every rotation.
#[derive(Default)]
struct Wanted {
    level: Option<Heights>,
    turned: Option<Problem>,
}

fn wanted(path: &Path, design: &Design) -> Result<Wanted, Failure> {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    match ending.as_str() {
        "csv" => Ok(Wanted { level: Some(wanted_from_table(read_table(path)?)?), turned: None }),
        "toml" => {
            let other = Problem::open(path)?;
            if other.design().alignment.free.contains(catchment::pose::Dof::Y)
                != design.alignment.free.contains(catchment::pose::Dof::Y)
            {
                let message = "a planar design and a spatial one have no heights in common".to_owned();
                return Err(Failure::with_help(message, Some("free y in both, or in neither".to_owned())));
            }
            Ok(Wanted { level: None, turned: Some(other) })
        }
        _ => {
            let help = "heights are read from a design (.toml) or a table (.csv)".to_owned();
            Err(Failure::with_help(format!("cannot tell what is in {}", shown(path)), Some(help)))
        }
    }
}

fn angle(text: &str) -> Result<f64, String> {
    quantity(text)?.angle_rad().map_err(|defect| with_advice(&defect))
}

/// Angles of a list or a range, in radians.
#[derive(Debug, Clone)]
struct Angles(Vec<f64>);

fn angles(text: &str) -> Result<Angles, String> {
    list_of_angles(text).map(Angles)
}
