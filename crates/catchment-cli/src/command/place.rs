//! `catchment place`: proposes a docking design for two CAD parts.

use crate::advice::flags;
use crate::defaults;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{check_apart, check_place, file, image, lines, to_stderr, to_stdout, write_file};
use catchment::design::{DesignDefect, LengthScale, LengthUnit, Quantity, QuantityUnit, parse_dofs};
use catchment::diagnostic::Diagnostic;
use catchment::pose::DofSet;
use catchment::problem::ProblemError;
use catchment::proposal::{
    AxisDirection, PartDetail, PartFile, PartFrames, Proposal, ProposalError, ProposalSettings, propose,
    shown_length,
};
use catchment::report::figure;
use catchment::terminal::shown;
use clap::{Args, ValueEnum};
use std::path::{Component, Path, PathBuf};

/// Propose how two CAD parts dock, and write the design file
///
/// Reads two parts (STL, OBJ, PLY, 3MF, STEP) in any position and orientation: each in its own file, or both docked in an assembly. Tries
/// every direction along their axes and proposes the steepest seat: approach, width D and free errors. Prints the choice and the runners-up
/// on stderr. The design passes `catchment check`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment place socket.stl plug.stl --unit mm -o design.toml --figure pair.png
  catchment place both.stl --unit mm -o design.toml
      both halves in one file
  catchment place base.obj tool.obj --unit m --drawn assembled --approach=-z \\
      -o design.toml
  catchment place plate.3mf plate.3mf --facing-fixed +y
      the same part twice; the design goes to stdout
  catchment place block.stl plate.stl --unit mm \\
      --with-moving 'sphere = { radius = 6 }, at = [21, 0, 8]'
  catchment check design.toml
  catchment run design.toml -o out")]
pub(crate) struct PlaceArgs {
    /// Fixed half: a mesh file or a STEP file, which Python meshes (docs/parts.md)
    #[arg(value_name = "FIXED", value_hint = clap::ValueHint::FilePath)]
    fixed: PathBuf,
    /// Moving half; without it the first file holds both halves as separate bodies, and the larger is fixed
    #[arg(value_name = "MOVING", value_hint = clap::ValueHint::FilePath)]
    moving: Option<PathBuf>,
    /// Unit of files that do not state theirs: um, mm, cm, m or in [default: `CATCHMENT_UNIT`]
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    unit: Option<LengthUnit>,
    /// Add another part to the fixed half: a file, or a bought part as in a design; may be repeated
    ///
    /// A bought part is written as 'sphere = { radius = 6 }, at = [21, 0, 8]' (docs/parts.md), in the coordinates of the half's file.
    #[arg(long, hide_short_help = true, value_name = "PART")]
    with_fixed: Vec<String>,
    /// Add another part to the moving half
    #[arg(long, hide_short_help = true, value_name = "PART")]
    with_moving: Vec<String>,
    /// Simplify meshes: largest distance by which a surface may move, such as '0.01 mm'; for 200 000 triangles and more
    #[arg(long, hide_short_help = true, value_name = "LENGTH", conflicts_with_all = ["with_fixed", "with_moving"])]
    simplify: Option<String>,
    /// Frames in which the parts are drawn
    #[arg(long, hide_short_help = true, value_enum, default_value_t = Drawn::Auto, help_heading = FOUND)]
    drawn: Drawn,
    /// Approach direction of the moving half, for parts drawn docked: +x, -x, +y, -y, +z, -z, or half way between two, such as +y+z
    #[arg(long, value_name = "WAY", allow_hyphen_values = true, help_heading = FOUND)]
    approach: Option<AxisDirection>,
    /// Where the fixed half faces in its file
    #[arg(
        long,
        value_name = "WAY",
        allow_hyphen_values = true,
        conflicts_with = "approach",
        hide_short_help = true,
        help_heading = FOUND
    )]
    facing_fixed: Option<AxisDirection>,
    /// Direction in which the moving half faces in its file
    #[arg(
        long,
        value_name = "WAY",
        allow_hyphen_values = true,
        conflicts_with = "approach",
        hide_short_help = true,
        help_heading = FOUND
    )]
    facing_moving: Option<AxisDirection>,
    /// Free pose errors, such as x,y,yaw [default: those that the seat constrains]
    #[arg(long, value_name = "ERRORS", value_parser = dofs, help_heading = FOUND)]
    free: Option<DofSet>,
    /// Name of the design
    #[arg(long, hide_short_help = true, help_heading = FOUND)]
    name: Option<String>,
    /// Write the design to this file instead of stdout (-); paths in it are relative to its folder
    #[arg(short, long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Also draw the halves, apart and mated (.svg, .png)
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    figure: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    exec: ExecArgs,
}

/// Heading of the options that override the proposal.
const FOUND: &str = "Overrides";

/// In which frames parts are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Drawn {
    /// As an assembly if the parts meet as drawn and hold, else each in its own frame
    Auto,
    /// Both in one frame, docked
    Assembled,
    /// Each in a frame of its own
    Facing,
}

impl PlaceArgs {
    /// The design file to write; `None` if the design is printed.
    pub(super) fn output(&self) -> Option<&Path> {
        file(self.output.as_deref())
    }

    /// The files of the fixed and the moving half.
    fn files(&self) -> [&Path; 2] {
        [&self.fixed, self.moving.as_ref().unwrap_or(&self.fixed)]
    }
}

/// Number of candidates in the summary.
const MOST_ROWS: usize = 3;
/// Smallest score that the summary lists.
const WORTH: f64 = 0.01;

pub(crate) fn run(args: &PlaceArgs) -> Result<ExitStatus, Failure> {
    let kind = files(args)?;
    let mut settings = settings(args, args.unit)?;
    let running = args.exec.start()?;
    if kind.is_some() {
        figure::ensure_fits(0, &running.exec)?;
    }
    let place = args.output().unwrap_or_else(|| Path::new("design.toml"));
    let files = args.files();
    let mut absent: Vec<String> =
        files.iter().filter(|path| !path.exists()).map(|path| shown(path).to_string()).collect();
    absent.dedup();
    if !absent.is_empty() {
        let help = "name two files: STL, OBJ, PLY, 3MF or STEP".to_owned();
        let failure = Failure::with_help(format!("there is no file {}", absent.join(", nor ")), Some(help));
        return Err(failure.ends(ExitStatus::NoSuchFile));
    }
    let mut parts = [part(files[0], place)?, part(files[1], place)?];
    if args.moving.is_none() {
        // The larger body is fixed.
        parts[0].body = Some(1);
        parts[1].body = Some(2);
    }
    settings.with = [beside(&args.with_fixed, place)?, beside(&args.with_moving, place)?];
    running.may_be_left();
    let mut result = propose(&parts, &settings, place, &running.exec);
    // The default unit applies only if the files need a unit: it never changes a proposal that exists without
    // it.
    if let (Err(ProposalError::NoUnit { .. }), Some((unit, source))) = (&result, defaults::get().unit) {
        running.beside_bar(|| to_stderr(&[format!("note: unit {}, from {source}", unit.symbol())]));
        let with = std::mem::take(&mut settings.with);
        settings = ProposalSettings { with, ..self::settings(args, Some(unit))? };
        result = propose(&parts, &settings, place, &running.exec);
    }
    let result = result.map_err(refused)?;
    // Compute everything before writing anything.
    let picture = match kind {
        Some(kind) => Some(image(&figure::pair(&result.problem)?, kind)?),
        None => None,
    };
    running.exec.check()?;
    drop(running);
    if let Some((path, bytes)) = args.figure.as_deref().zip(picture) {
        write_file(path, &bytes, args.force)?;
    }
    match args.output() {
        Some(path) => write_file(path, result.text.as_bytes(), args.force)?,
        None => to_stdout(&result.text)?,
    }
    to_stderr(&summary(&result, args.moving.as_deref()));
    Ok(ExitStatus::Done)
}

/// Rejects unwritable outputs; returns the format of the picture, if any.
fn files(args: &PlaceArgs) -> Result<Option<&'static str>, Failure> {
    const KINDS: [&str; 2] = ["svg", "png"];
    check_apart(args.output(), args.figure.as_deref())?;
    for path in args.output().into_iter().chain(args.figure.as_deref()) {
        for part in args.files() {
            check_apart(Some(path), Some(part))?;
        }
        for stated in args.with_fixed.iter().chain(&args.with_moving).filter(|stated| is_file(stated)) {
            check_apart(Some(path), Some(Path::new(stated)))?;
        }
        check_place(path, args.force)?;
    }
    let Some(path) = &args.figure else { return Ok(None) };
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("");
    let kind = KINDS.into_iter().find(|kind| kind.eq_ignore_ascii_case(ending));
    kind.map(Some).ok_or_else(|| {
        let help = format!("let its name end in .{}", KINDS.join(", ."));
        Failure::with_help(format!("cannot tell what to write into {}", shown(path)), Some(help))
    })
}

fn settings(args: &PlaceArgs, unit: Option<LengthUnit>) -> Result<ProposalSettings, Failure> {
    let frames = match args.drawn {
        Drawn::Auto => PartFrames::Any,
        Drawn::Assembled => PartFrames::Assembled,
        Drawn::Facing => PartFrames::Facing,
    };
    let facing = [args.facing_fixed, args.facing_moving];
    let help = |text: &str| Some(text.to_owned());
    if frames == PartFrames::Facing && args.approach.is_some() {
        return Err(Failure::with_help(
            "--approach is of parts that are drawn docked".to_owned(),
            help("--drawn assembled; parts in frames of their own have --facing-fixed and --facing-moving"),
        ));
    }
    if frames == PartFrames::Assembled && facing.iter().any(Option::is_some) {
        return Err(Failure::with_help(
            "--facing-fixed and --facing-moving are of parts in frames of their own".to_owned(),
            help("--drawn facing; parts that are drawn docked have --approach"),
        ));
    }
    Ok(ProposalSettings {
        frames,
        approach: args.approach,
        facing,
        unit,
        free: args.free,
        name: args.name.clone(),
        simplify: args.simplify.as_deref().map(|text| simplify(text, unit)).transpose()?,
        with: [Vec::new(), Vec::new()],
    })
}

/// Parts beside a half's file: each a file, or an element of a design's list of parts.
fn beside(stated: &[String], place: &Path) -> Result<Vec<PartDetail>, Failure> {
    let one = |text: &String| {
        if is_file(text) {
            let path = Path::new(text);
            if !path.exists() {
                let help = "name a file, or write a part as a design has it: 'sphere = { radius = 6 }, at = [21, 0, 8]'";
                let failure = Failure::with_help(format!("there is no file {text}"), Some(help.to_owned()));
                return Err(failure.ends(ExitStatus::NoSuchFile));
            }
            return Ok(PartDetail::File(part(path, place)?));
        }
        if text.trim().lines().count() > 1 {
            let help = "write it in one line, as an inline table".to_owned();
            return Err(Failure::with_help("a part of several lines".to_owned(), Some(help)));
        }
        let text = text.trim();
        Ok(PartDetail::Part(if text.starts_with('{') { text.to_owned() } else { format!("{{ {text} }}") }))
    };
    stated.iter().map(one).collect()
}

/// Whether the text names a file rather than a part.
fn is_file(stated: &str) -> bool {
    !stated.trim_start().starts_with('{') && (!stated.contains('=') || Path::new(stated).exists())
}

/// The choice, the runners-up and points to check.
fn summary(result: &Proposal, moving: Option<&Path>) -> Vec<String> {
    let design = result.problem.design();
    let unit = design.unit.unwrap_or(LengthUnit::Mm);
    let head = format!(
        "width D {}, the larger lateral extent of the facets that can touch",
        shown_length(design.width, unit)
    );
    let (moving, other) = match moving {
        Some(path) => (shown(path).to_string(), "swap the files"),
        None => ("the smaller body".to_owned(), "give each half a file of its own"),
    };
    let halves = format!(
        "moving {moving} (pose errors and the centre of rotation are those of this half; if the other half moves, {other})"
    );
    let rows: Vec<_> =
        result.candidates.iter().filter(|one| one.score >= WORTH).take(MOST_ROWS).cloned().collect();
    let ranking = rows.iter().enumerate().map(|(k, one)| {
        format!("{} {}", if k == 0 { "chosen, score" } else { "       score" }, one.in_words(&rows, unit))
    });
    let notes: Vec<Diagnostic> = result.notes.iter().map(|note| note.worded(flags)).collect();
    [head, halves].into_iter().chain(ranking).chain(lines(&notes)).collect()
}

/// The error, with the advice of the command line.
fn refused(error: ProposalError) -> Failure {
    let help = match &error {
        ProposalError::NoUnit { guess, .. } => format!("--unit {}?", guess.symbol()),
        ProposalError::NoSeat { remedy, advice, .. } => {
            let remedy = remedy.iter().cloned().chain(advice.iter().filter_map(flags));
            remedy.map(|one| one + "; or ").collect::<String>()
                + "name the directions (WAY: +x … -z): --drawn assembled --approach WAY, or --facing-fixed WAY --facing-moving WAY; free only what the seat holds: \
             --free x,y; parts at an angle to their axes: write the design file by hand (docs/parts.md)"
        }
        ProposalError::Problem(_) | ProposalError::Cancelled(_) => return error_of(error),
    };
    let failure = Failure::with_help(error.to_string(), Some(help));
    // A missing unit is a missing option.
    let is_usage = matches!(error, ProposalError::NoUnit { .. });
    failure.ends(if is_usage { ExitStatus::Usage } else { ExitStatus::NotComputed })
}

fn error_of(error: ProposalError) -> Failure {
    match error {
        // No design exists yet that could hold the key.
        ProposalError::Problem(ProblemError::Diagnostics(mut diagnostics)) => {
            for diagnostic in &mut diagnostics.list {
                diagnostic.message =
                    diagnostic.message.replace(IN_THE_DESIGN, "give --simplify \"0.01 mm\", which");
            }
            ProblemError::from(diagnostics).into()
        }
        ProposalError::Problem(problem) => problem.into(),
        other => other.into(),
    }
}

/// The design's advice for a file with too many triangles; replaced here.
const IN_THE_DESIGN: &str = "write simplify = \"0.01 mm\" beside the file, which";

/// A part with its path relative to a design at `place`.
fn part(path: &Path, place: &Path) -> Result<PartFile, Failure> {
    let real = std::fs::canonicalize::<&Path>;
    let folder =
        place.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
    let written = relative(&real(path)?, &real(folder)?);
    let Some(written) = written.to_str() else {
        let help = "rename it: a design file is UTF-8".to_owned();
        return Err(Failure::with_help(
            format!("{} cannot be written into a design", shown(path)),
            Some(help),
        ));
    };
    Ok(PartFile {
        path: path.to_owned(),
        written: written.replace(std::path::MAIN_SEPARATOR, "/"),
        body: None,
    })
}

/// The relative path from a folder to a file.
fn relative(file: &Path, folder: &Path) -> PathBuf {
    let (file, folder): (Vec<_>, Vec<_>) = (file.components().collect(), folder.components().collect());
    let same = file.iter().zip(&folder).take_while(|(a, b)| a == b).count();
    if same == 0 {
        // On another drive.
        return file.iter().collect();
    }
    let up = std::iter::repeat_n(Component::ParentDir, folder.len() - same);
    up.chain(file[same..].iter().copied()).collect()
}

pub(crate) fn unit(text: &str) -> Result<LengthUnit, String> {
    LengthUnit::ALL
        .into_iter()
        .find(|unit| unit.symbol() == text)
        .ok_or_else(|| format!("a unit is one of {}", LengthUnit::ALL.map(LengthUnit::symbol).join(", ")))
}

/// Parses the largest surface displacement, in the unit of the files.
fn simplify(text: &str, unit: Option<LengthUnit>) -> Result<f64, Failure> {
    let scale = LengthScale { width: 1.0, unit: Some(unit.unwrap_or(LengthUnit::Mm)) };
    let refusal =
        |defect: DesignDefect| Failure::with_help(format!("--simplify {text:?}: {defect}"), defect.help());
    let quantity: Quantity = text.parse().map_err(refusal)?;
    let help = || Some("say how far the surface may move, such as '0.01 mm'".to_owned());
    if quantity.unit == QuantityUnit::D {
        return Err(Failure::with_help(format!("--simplify {text:?}: D is not known yet"), help()));
    }
    let most = quantity.drawn_length_d(&scale).map_err(refusal)?;
    if most > 0.0 {
        Ok(most)
    } else {
        Err(Failure::with_help(format!("--simplify {text:?} is no distance"), help()))
    }
}

fn dofs(text: &str) -> Result<DofSet, String> {
    parse_dofs(text).map_err(|defect| defect.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_named_from_the_folder_of_the_design() {
        let from = |file: &str, folder: &str| relative(Path::new(file), Path::new(folder));
        assert_eq!(from("/a/b/c.stl", "/a/b"), Path::new("c.stl"));
        assert_eq!(from("/a/b/c.stl", "/a/d/e"), Path::new("../../b/c.stl"));
        assert_eq!(from("/a/b/c.stl", "/a"), Path::new("b/c.stl"));
    }
}
