//! Export of a stored result.

use super::ExportArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{check_place, print, write_file};
use crate::source::is_stream;
use catchment::exec::Exec;
use catchment::pose::PoseError;
use catchment::poses::parse_pose;
use catchment::report::compare::group;
use catchment::report::set::{ENDINGS, SetFileKind};
use catchment::report::vtk::View;
use catchment::report::zarr;
use catchment::terminal::shown;

pub(super) fn run(args: &ExportArgs, exec: &Exec) -> Result<ExitStatus, Failure> {
    // Only the table is a text format.
    let is_printed = is_stream(&args.output);
    let Some(kind) = SetFileKind::of(&args.output).or(is_printed.then_some(SetFileKind::Table)) else {
        let message = format!("cannot tell what to write into {}", shown(&args.output));
        return Err(Failure::with_help(
            message,
            Some(format!("let its name end in .{}", ENDINGS.join(", ."))),
        ));
    };
    if let Some(option) = of_a_design(args) {
        let help = "name a design file, or leave the option out".to_owned();
        return Err(Failure::with_help(
            format!("{option} is about a design, and this is a result"),
            Some(help),
        ));
    }
    if kind == SetFileKind::Table && (args.axes.is_some() || args.at.is_some()) {
        let help = "leave --axes and --at out, or write .vti".to_owned();
        return Err(Failure::with_help("a table has every axis of the result".to_owned(), Some(help)));
    }
    if !is_printed {
        check_place(&args.output, args.force)?;
    }
    let path = group(&args.design.path);
    let (report, acceptance) = zarr::read(&path, exec)?;
    let at = match &args.at {
        Some(text) => parse_pose(text, &report.design)
            .map_err(|diagnostics| Failure::of_option("--at", text, diagnostics))?,
        None => PoseError::default(),
    };
    let heights = match acceptance.grid() {
        Some(grid) => zarr::read_heights(&path, grid, exec)?,
        None => None,
    };
    let view = View::new(&acceptance, heights.as_deref(), args.axes, &at)?;
    let bytes = kind.bytes(&view, &acceptance, heights.as_deref(), exec)?;
    if is_printed {
        return print(&String::from_utf8_lossy(&bytes), &[]);
    }
    write_file(&args.output, &bytes, args.force)?;
    let words = if kind == SetFileKind::Table { String::new() } else { view.table() };
    print(&words, &[format!("wrote {}", shown(&args.output))])
}

/// The first option given that applies only to a drop test.
fn of_a_design(args: &ExportArgs) -> Option<&'static str> {
    let own = [("--pose", args.pose.is_some()), ("--json", args.print.json)];
    own.into_iter()
        .find_map(|(option, given)| given.then_some(option))
        .or_else(|| args.design.changed().next().map(|(option, _)| option))
        .or_else(|| args.drop.first_given())
}
