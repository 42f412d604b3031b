//! `catchment catalog`: published docking systems.

use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{FileArgs, OutputArgs, style, to_stdout};
use crate::result_args::{ResultArgs, no_picture};
use crate::source::open_design;
use catchment::problem::Problem;
use catchment::report::document::text;
use catchment::report::{ReportBody, csv, figure as figures};
use catchment_systems::catalog::report::{CatalogBody, SystemBody};
use catchment_systems::catalog::{
    Catalog, Condition, DESIGNS, DesignText, PublishedTable, RowOrder, UnknownError, classify, figure,
};
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{ArgGroup, Args, Subcommand, ValueEnum};
use std::path::PathBuf;

/// List published connectors and their areas of acceptance
///
/// 27 systems with eleven attributes each, eleven published zero-rotation areas, and the 3-D X-Face. Values are shown as printed in the
/// source; a value that the source does not define also has its normal form. --csv, --json and --markdown have every attribute.
#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    group = ArgGroup::new("form").args(["json", "csv", "markdown", "as_printed"]),
    after_long_help = "\
Examples:
  catchment catalog
  catchment catalog --where gendering=Ungendered --where degree=High
  catchment catalog --sort zraa --append mine.toml
      your design among them
  catchment catalog --as-printed 1.1
      the table of the source, byte for byte
  catchment catalog show DRAGON
      every number with its source
  catchment catalog design polybot -o polybot.toml
      a design file to run
  catchment catalog -o figure.svg
      the published figure of areas, drawn again

--where takes a printed value or a normal form. Conditions on different
attributes must all hold; values of the same attribute are alternatives."
)]
pub(crate) struct CatalogArgs {
    #[command(subcommand)]
    command: Option<CatalogCommand>,
    /// List only systems with this value of an attribute, such as gendering=Ungendered; may be repeated
    #[arg(long = "where", value_name = "ATTRIBUTE=VALUE")]
    conditions: Vec<String>,
    /// Sort by date, or by area with the largest first
    #[arg(long, value_name = "BY", value_enum)]
    sort: Option<Sort>,
    /// Add your design as a row, classified by its geometry; may be repeated
    #[arg(long, value_name = "DESIGN", value_hint = clap::ValueHint::FilePath)]
    append: Vec<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Print CSV, every attribute as printed and in its normal form
    #[arg(long)]
    csv: bool,
    /// Print a table in Markdown
    #[arg(long)]
    markdown: bool,
    /// Print a table of the source as CSV, byte for byte
    #[arg(long, value_name = "TABLE", value_enum, conflicts_with_all = ["conditions", "sort", "append"])]
    as_printed: Option<Printed>,
    /// Figure that -o draws
    #[arg(long, alias = "figure", value_name = "NUMBER", value_enum, requires = "output")]
    plot: Option<Figure>,
    #[command(flatten)]
    file: FileArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

#[derive(Debug, Subcommand)]
enum CatalogCommand {
    /// Print a system: every attribute, every number with its source
    Show(ShowArgs),
    /// Write the design file of a published geometry
    Design(CatalogDesignArgs),
}

#[derive(Debug, Args)]
struct ShowArgs {
    /// Name of the system in either table
    #[arg(value_name = "NAME")]
    name: String,
    #[command(flatten)]
    result: ResultArgs,
}

#[derive(Debug, Args)]
struct CatalogDesignArgs {
    /// Name of the geometry
    #[arg(value_name = "NAME", value_parser = PossibleValuesParser::new(
        DESIGNS.map(|design| PossibleValue::new(design.name).help(design.summary))
    ))]
    name: String,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Sort {
    Introduced,
    Zraa,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Printed {
    #[value(name = "1.1")]
    Connectors,
    #[value(name = "2.1")]
    Zraa,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Figure {
    /// Geometry, cross-section and area of each, on the same scale
    #[value(name = "2.1")]
    Comparison,
    /// The cone, around and inside the unit square, over the 3-D X-Face
    #[value(name = "4.2")]
    Cone,
}

pub(crate) fn run(args: &CatalogArgs) -> Result<ExitStatus, Failure> {
    match &args.command {
        None => list(args),
        Some(CatalogCommand::Show(show)) => {
            let output = show.result.check(SystemBody::KIND, false)?;
            let catalog = Catalog::published()?;
            let report = SystemBody::report(catalog.named(&show.name).map_err(|error| unknown(&error))?);
            output.finish(&report, || Err(no_picture()))
        }
        Some(CatalogCommand::Design(design)) => {
            let text = DesignText::named(&design.name).map_or("", |design| design.text);
            design.output.write(text)?;
            Ok(ExitStatus::Done)
        }
    }
}

fn list(args: &CatalogArgs) -> Result<ExitStatus, Failure> {
    let kind = args.file.kind(&["svg", "png"])?;
    let mut catalog = Catalog::published()?;
    let conditions: Result<Vec<Condition>, UnknownError> =
        args.conditions.iter().map(|text| catalog.condition(text)).collect();
    let conditions = conditions.map_err(|error| unknown(&error))?;
    let problems: Result<Vec<Problem>, _> = args.append.iter().map(|path| open_design(path)).collect();
    let problems = problems?;
    if kind.is_some() || !problems.is_empty() {
        let running = args.exec.start()?;
        for problem in &problems {
            catalog.append(&classify(problem, &running.exec)?);
        }
        if let Some(kind) = kind {
            figures::ensure_fits(0, &running.exec)?;
            let picture = match args.plot.unwrap_or(Figure::Comparison) {
                Figure::Comparison => figure::comparison(&catalog, &running.exec)?,
                Figure::Cone => figure::cone_over_x_face(),
            };
            drop(running);
            args.file.draw(kind, &picture)?;
        }
    }
    if let Some(table) = args.as_printed {
        let table = match table {
            Printed::Connectors => PublishedTable::Connectors,
            Printed::Zraa => PublishedTable::Zraa,
        };
        to_stdout(&String::from_utf8_lossy(&catalog.as_printed(table)?))?;
        return Ok(ExitStatus::Done);
    }
    let catalog = catalog.filtered(&conditions);
    let catalog = match args.sort {
        None => catalog,
        Some(Sort::Introduced) => catalog.sorted(RowOrder::Introduced),
        Some(Sort::Zraa) => catalog.sorted(RowOrder::Zraa),
    };
    let report = CatalogBody::report(&catalog);
    let printed = if args.json {
        report.to_json()?
    } else if args.csv {
        String::from_utf8_lossy(&csv(&report.records())?).into_owned()
    } else if args.markdown {
        report.markdown()
    } else {
        text(&report.described(), style(true))
    };
    to_stdout(&printed)?;
    Ok(ExitStatus::Done)
}

/// An unknown name, with the known names as advice.
fn unknown(error: &UnknownError) -> Failure {
    Failure::with_help(error.to_string(), error.help())
}
