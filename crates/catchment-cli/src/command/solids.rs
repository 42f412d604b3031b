//! `catchment solids`: the shapes behind the contact space, as files.

use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::ResultArgs;
use catchment::method::partition::{PartitionSettings, SolidShape, shapes};
use catchment::report::{ReportBody, SolidsBody, SolidsReport, figure, solids};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser, ValueParser};

/// Write the solids of the contact space for ParaView
///
/// The halves as unions of convex pieces (P-collections), the solid that the moving half sweeps over its angle (C-full), and the offsets at
/// which the halves overlap (the configuration space obstacle), whose upper side is the height of first contact. At most three dimensions: x
/// and y, a single offset, or a single offset and a single angle may be free.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment solids design.toml --shape halves -o halves.vtp
  catchment solids design.toml --free x -o shape.svg
      a planar design without rotation: polygons
  catchment solids design.toml --free x,y -o shape.obj
      a spatial design without rotation
  catchment solids design.toml --free x,pitch --slices 15 -o shape.vtp
  catchment solids design.toml --shape swept --cor \"-0.1\" -o swept.png
  catchment solids design.toml --free x,y --json | jq .bodies

-o also writes .vtp (VTK PolyData with the piece and the slice of every face)
and .obj (a group per body). Lengths are in D and angles in radians; z is the
approach, and an angle is drawn along the axis that no free offset uses.")]
pub(crate) struct SolidsArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Solid to write
    #[arg(long, value_name = "SHAPE", default_value = "collision", value_parser = shape_parser())]
    shape: SolidShape,
    /// Rotation slices across the error box of the angle
    #[arg(long, value_name = "COUNT", default_value_t = DEFAULT.slices)]
    slices: usize,
    /// Strips per D of the moving half before its slices are joined; 1 is the method of the dissertation
    #[arg(long, value_name = "COUNT", default_value_t = DEFAULT.strips)]
    strips: usize,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// The settings of figure 5.6 of the dissertation.
const DEFAULT: PartitionSettings = PartitionSettings { slices: 15, strips: 1 };

fn shape_parser() -> ValueParser {
    let shapes = [
        ("halves", "both halves as convex pieces, docked", SolidShape::Halves),
        ("swept", "the moving half, reflected and turned through its slices", SolidShape::Swept),
        (
            "collision",
            "positions of the centre of rotation at which the halves overlap",
            SolidShape::Collision,
        ),
    ];
    PossibleValuesParser::new(shapes.map(|(name, help, _)| PossibleValue::new(name).help(help)))
        .map(move |name| {
            shapes.iter().find(|shape| shape.0 == name).map_or(SolidShape::Collision, |shape| shape.2)
        })
        .into()
}

pub(crate) fn run(args: &SolidsArgs) -> Result<ExitStatus, Failure> {
    let output = args.result.check_with(SolidsBody::KIND, true, &["vtp", "obj"])?;
    let problem = args.design.halves()?;
    let running = args.exec.start()?;
    if output.wants_picture() {
        figure::ensure_fits(0, &running.exec)?;
    }
    let settings = PartitionSettings { slices: args.slices, strips: args.strips };
    let shape = shapes(problem.pair(), args.shape, &settings, &running.exec)?;
    drop(running);
    match output.own() {
        Some("vtp") => output.write_own(solids::vtp(&shape).as_bytes())?,
        Some(_) => output.write_own(solids::obj(&shape).as_bytes())?,
        None => {}
    }
    let report = SolidsReport::new(problem.design(), &shape, problem.warnings());
    output.finish(&report, || Ok(figure::bodies(problem.design(), &shape)?))
}
