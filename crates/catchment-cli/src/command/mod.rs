//! One file per subcommand.

mod catalog;
mod chain;
mod check;
mod classify;
mod compare;
mod completions;
mod compose;
mod dynamics;
mod export;
mod friction;
mod hold;
mod invert;
mod jams;
mod latch;
mod man;
mod new;
mod next;
mod outcome;
mod place;
mod plan;
mod report;
mod reproduce;
mod rests;
mod run;
mod schema;
mod slices;
mod solids;
mod success;
mod sweep;
mod trace;
mod validate;
mod view;
mod window;
mod zraa;

pub(crate) use place::unit;
pub(crate) use view::admitted;

use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::groups::Group;
use clap::Subcommand;

/// The groups, with every subcommand that the help lists.
pub(crate) const GROUPS: [Group; 6] = [
    Group {
        heading: "Every day",
        names: &[
            "new", "place", "check", "run", "window", "success", "trace", "rests", "compare", "sweep",
            "report", "export", "view",
        ],
    },
    Group { heading: "Forces", names: &["friction", "hold", "dynamics"] },
    Group { heading: "Bench tests", names: &["plan", "validate"] },
    Group {
        heading: "Sections, planar and published connectors",
        names: &["slices", "zraa", "catalog", "classify", "reproduce"],
    },
    Group { heading: "Systems", names: &["compose", "latch", "chain", "invert"] },
    Group { heading: "Tools", names: &["schema", "completions", "man", "solids", "help"] },
];

/// The subcommands, in the order of [`GROUPS`].
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    New(new::NewArgs),
    Place(place::PlaceArgs),
    Check(check::CheckArgs),
    Run(Box<run::RunArgs>),
    Window(Box<window::WindowArgs>),
    Success(Box<success::SuccessArgs>),
    Trace(Box<trace::TraceArgs>),
    Rests(Box<rests::RestsArgs>),
    Compare(compare::CompareArgs),
    Sweep(Box<sweep::SweepArgs>),
    Report(Box<report::ReportArgs>),
    Export(Box<export::ExportArgs>),
    View(Box<view::ViewArgs>),
    Friction(friction::FrictionArgs),
    Hold(Box<hold::HoldArgs>),
    #[command(alias = "chance")]
    Dynamics(Box<dynamics::DynamicsArgs>),
    Plan(Box<plan::PlanArgs>),
    Validate(Box<validate::ValidateArgs>),
    Slices(Box<slices::SlicesArgs>),
    Zraa(Box<zraa::ZraaArgs>),
    Catalog(Box<catalog::CatalogArgs>),
    Classify(classify::ClassifyArgs),
    Reproduce(reproduce::ReproduceArgs),
    Compose(Box<compose::ComposeArgs>),
    Latch(latch::LatchArgs),
    Chain(Box<chain::ChainArgs>),
    Invert(invert::InvertArgs),
    Schema(schema::SchemaArgs),
    Completions(completions::CompletionsArgs),
    Man(man::ManArgs),
    Solids(solids::SolidsArgs),
    #[command(hide = true)]
    Outcome(Box<outcome::OutcomeArgs>),
    #[command(hide = true)]
    Jams(Box<jams::JamsArgs>),
}

impl Command {
    /// Runs the subcommand.
    pub(crate) fn run(self) -> Result<ExitStatus, Failure> {
        match self {
            Self::New(args) => new::run(&args),
            Self::Place(args) => place::run(&args),
            Self::Check(args) => check::run(&args),
            Self::Run(args) => run::run(&args),
            Self::Window(args) => window::run(&args),
            Self::Success(args) => success::run(&args),
            Self::Trace(args) => trace::run(&args),
            Self::Outcome(args) => outcome::run(&args),
            Self::Rests(args) => rests::run(&args),
            Self::Jams(args) => jams::run(&args),
            Self::Compare(args) => compare::run(&args),
            Self::Sweep(args) => sweep::run(&args),
            Self::Report(args) => report::run(&args),
            Self::Export(args) => export::run(&args),
            Self::View(args) => view::run(&args),
            Self::Friction(args) => friction::run(&args),
            Self::Hold(args) => hold::run(&args),
            Self::Dynamics(args) => dynamics::run(&args),
            Self::Plan(args) => plan::run(&args),
            Self::Validate(args) => validate::run(&args),
            Self::Slices(args) => slices::run(&args),
            Self::Zraa(args) => zraa::run(&args),
            Self::Catalog(args) => catalog::run(&args),
            Self::Classify(args) => classify::run(&args),
            Self::Reproduce(args) => reproduce::run(&args),
            Self::Compose(args) => compose::run(&args),
            Self::Latch(args) => latch::run(&args),
            Self::Chain(args) => chain::run(&args),
            Self::Invert(args) => invert::run(&args),
            Self::Schema(args) => schema::run(&args),
            Self::Completions(args) => completions::run(&args),
            Self::Man(args) => man::run(&args),
            Self::Solids(args) => solids::run(&args),
        }
    }
}
