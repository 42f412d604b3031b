//! Exit codes.
//!
//! ```text
//!     0  done                          4  bad input: a file that was read has a defect
//!     1  a requirement is not met      5  could not compute, or could not write
//!     2  usage: the command line     130  interrupted (Ctrl-C)
//!     3  no such file                143  terminated
//! ```

use catchment::design::LoadError;
use catchment::exec::ThreadsError;
use catchment::landscape::ResolutionError;
use catchment::merit::comparison::ComparisonError;
use catchment::method::descent::FrictionOutOfRange;
use catchment::method::drop::DropError;
use catchment::method::drop::export::ExportError;
use catchment::method::kinematic::UnsuitableDesign;
use catchment::method::partition::{PartitionError, SolidError};
use catchment::method::zraa::ZraaError;
use catchment::method::{DecideError, MethodError, NotApplicable};
use catchment::report::FacesError;
use catchment::report::compare::CompareError;
use catchment::report::folder::SaveError;
use catchment::report::vtk::ViewError;
use catchment::report::write::WriteError;
use catchment::report::zarr::ZarrError;
use catchment::run::jams::{DepthError, JamsError};
use catchment::run::rests::RestsError;
use catchment::run::window::WindowError;
use catchment::run::{RequirementError, RunError};
use catchment::study::chance::ChanceError;
use catchment::study::convergence::ConvergenceError;
use catchment::study::friction::FrictionError;
use catchment::study::hold::HoldError;
use catchment::study::plan::TrialPlanError;
use catchment::study::slices::SlicesError;
use catchment::study::success::SuccessError;
use catchment::study::trials::TrialsError;
use catchment::study::validate::ValidateError;
use catchment_systems::catalog::ClassifyError;
use catchment_systems::chain::study::ChainError;
use catchment_systems::compose::ComposeError;
use catchment_systems::invert::InvertError;
use catchment_systems::latch::GeometryError;
use std::error::Error;
use std::io;
use std::process::ExitCode;

/// The exit status of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExitStatus {
    /// Done; every requirement is met.
    Done,
    /// Done, but a requirement is not met.
    RequirementNotMet,
    /// An unusable command line: unknown, contradictory or impossible options, or an output that must not be
    /// overwritten.
    Usage,
    /// A file on the command line cannot be opened.
    NoSuchFile,
    /// A file was read and has a defect.
    BadInput,
    /// No result: out of memory, output not writable, no solution; or a bug.
    NotComputed,
    /// Stopped by Ctrl-C.
    Interrupted,
    /// Terminated by the system, or because the terminal closed.
    Terminated,
}

impl ExitStatus {
    /// Every status, for the help.
    pub(crate) const ALL: [(Self, &'static str); 8] = [
        (Self::Done, "done"),
        (Self::RequirementNotMet, "done, but a --require is not met"),
        (Self::Usage, "usage: an option, or a place that exists"),
        (Self::NoSuchFile, "no such file"),
        (Self::BadInput, "bad input: a defect in a file"),
        (Self::NotComputed, "could not compute, or could not write"),
        (Self::Interrupted, "interrupted (Ctrl-C)"),
        (Self::Terminated, "terminated (SIGTERM, SIGHUP)"),
    ];

    /// The exit code.
    pub const fn code(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::RequirementNotMet => 1,
            Self::Usage => 2,
            Self::NoSuchFile => 3,
            Self::BadInput => 4,
            Self::NotComputed => 5,
            // 128 plus the signal number, as shells expect.
            Self::Interrupted => 130,
            Self::Terminated => 143,
        }
    }

    /// The exit status for an error of the library.
    pub(crate) fn of(error: &(dyn Error + 'static)) -> Self {
        if is_usage(error) {
            Self::Usage
        } else if is(error, |error: &LoadError| matches!(error, LoadError::Io { .. }))
            || is(error, |error: &io::Error| error.kind() == io::ErrorKind::NotFound)
        {
            Self::NoSuchFile
        } else if is_bad_input(error) {
            Self::BadInput
        } else {
            Self::NotComputed
        }
    }
}

impl From<ExitStatus> for ExitCode {
    fn from(status: ExitStatus) -> Self {
        Self::from(status.code())
    }
}

/// Whether an error is a `T` with this property.
fn is<T: Error + 'static>(error: &(dyn Error + 'static), has: impl Fn(&T) -> bool) -> bool {
    error.downcast_ref::<T>().is_some_and(has)
}

/// Whether the command line requests the impossible, independent of the files.
fn is_usage(error: &(dyn Error + 'static)) -> bool {
    let of_any_kind = error.is::<MethodError>()
        || error.is::<NotApplicable>()
        || error.is::<ResolutionError>()
        || error.is::<RequirementError>()
        || error.is::<FrictionOutOfRange>()
        || error.is::<FacesError>()
        || error.is::<ComparisonError>()
        || error.is::<UnsuitableDesign>()
        || is(error, |error: &ThreadsError| matches!(error, ThreadsError::Environment { .. }));
    of_any_kind || is(error, in_the_way) || is_setting_of_run(error) || is_setting_of_study(error)
}

/// Whether an existing file or folder blocks the output.
fn in_the_way(error: &WriteError) -> bool {
    use WriteError::{
        Exists, IsFolder, MountPoint, NameTooLong, NoFolder, NotAFile, NotAResult, NotUtf8, OtherKind,
        Strange,
    };
    matches!(
        error,
        Exists { .. }
            | IsFolder { .. }
            | MountPoint { .. }
            | NameTooLong { .. }
            | NoFolder { .. }
            | NotAFile { .. }
            | NotAResult { .. }
            | NotUtf8 { .. }
            | OtherKind { .. }
            | Strange { .. }
    )
}

/// Whether a run, an export or a comparison rejects its settings.
fn is_setting_of_run(error: &(dyn Error + 'static)) -> bool {
    let of_method = |error: &DecideError| match error {
        DecideError::NotApplicable(_) | DecideError::NeedsGrid { .. } => true,
        DecideError::Method(error) => is(&**error, is_setting_of_partition),
        _ => false,
    };
    let of_run = |error: &RunError| match error {
        RunError::NotApplicable(_) | RunError::Resolution(_) => true,
        RunError::Decide(error) => of_method(error),
        _ => false,
    };
    is(error, of_run)
        || is(error, of_method)
        || is(error, |error: &DropError| matches!(error, DropError::Setting(_) | DropError::OffCenter { .. }))
        || is(error, |error: &ExportError| {
            matches!(error, ExportError::Setting(_) | ExportError::Ground | ExportError::Launch)
        })
        || is(error, |error: &ViewError| {
            !matches!(error, ViewError::OutOfBudget(_) | ViewError::Cancelled(_))
        })
        || is(error, |error: &CompareError| match error {
            CompareError::Resolution { .. } | CompareError::Apart { .. } | CompareError::Comparison(_) => {
                true
            }
            CompareError::Run(error) => of_run(error),
            _ => false,
        })
        || is(error, |error: &SolidError| match error {
            SolidError::Dimensions { .. } | SolidError::NothingMoves | SolidError::NothingTurns => true,
            SolidError::Partition(error) => is_setting_of_partition(error),
        })
        || is(error, |error: &SaveError| match error {
            SaveError::Write(error) | SaveError::Zarr(ZarrError::Write(error)) => in_the_way(error),
            _ => false,
        })
        || is(error, |error: &ZarrError| matches!(error, ZarrError::Write(error) if in_the_way(error)))
}

/// Whether a partition rejects its settings.
fn is_setting_of_partition(error: &PartitionError) -> bool {
    matches!(error, PartitionError::Setting { .. })
}

/// Whether a study rejects its settings.
fn is_setting_of_study(error: &(dyn Error + 'static)) -> bool {
    let of_depth = |error: &DepthError| matches!(error, DepthError::Resolution(_) | DepthError::Friction);
    is(error, |error: &WindowError| {
        use WindowError::{BeyondBox, Friction, Locked, NoSize, Nothing};
        matches!(error, BeyondBox { .. } | Friction(_) | Locked { .. } | NoSize { .. } | Nothing)
    }) || is(error, |error: &SuccessError| {
        !matches!(error, SuccessError::Decide(_) | SuccessError::Cancelled(_))
    }) || is(error, |error: &ChanceError| {
        !matches!(error, ChanceError::Drop(_) | ChanceError::Decide(_) | ChanceError::Cancelled(_))
    }) || is(error, |error: &FrictionError| !matches!(error, FrictionError::Cancelled(_)))
        || is(error, |error: &HoldError| {
            matches!(error, HoldError::Friction(_) | HoldError::Directions { .. } | HoldError::Length { .. })
        })
        || is(error, |error: &RestsError| match error {
            RestsError::Depth(error) => of_depth(error),
            RestsError::Nothing => true,
            RestsError::Cancelled(_) => false,
        })
        || is(error, |error: &JamsError| match error {
            JamsError::Depth(error) => of_depth(error),
            JamsError::Cancelled(_) => false,
            _ => true,
        })
        || is(error, |error: &TrialPlanError| {
            use TrialPlanError::{Cancelled, FarFromBorder, NoBorder, NotDocked};
            !matches!(error, Cancelled(_) | FarFromBorder | NoBorder | NotDocked)
        })
        || is(error, |error: &ValidateError| {
            !matches!(error, ValidateError::NothingMade | ValidateError::Cancelled(_))
        })
        || is(error, |error: &TrialsError| {
            use TrialsError::{Cancelled, Decide, OutOfBudget, Zraa};
            !matches!(error, Cancelled(_) | Decide(_) | OutOfBudget(_) | Zraa(_))
        })
        || is(error, |error: &SlicesError| {
            use SlicesError::{Cancelled, Decide, Merit, OutOfBudget};
            !matches!(error, Cancelled(_) | Decide(_) | Merit(_) | OutOfBudget(_))
        })
        || is(error, |error: &ConvergenceError| matches!(error, ConvergenceError::Tolerance { .. }))
        || is(error, |error: &InvertError| {
            matches!(
                error,
                InvertError::Planar | InvertError::TooManyTurns { .. } | InvertError::TooFar { .. }
            )
        })
}

/// Whether a file was read and has a defect; defects with a place in a text take another path.
fn is_bad_input(error: &(dyn Error + 'static)) -> bool {
    error.is::<LoadError>()
        || error.is::<GeometryError>()
        || is(error, |error: &ZarrError| matches!(error, ZarrError::Content { .. }))
        || is(error, |error: &CompareError| matches!(error, CompareError::Zarr(ZarrError::Content { .. })))
        || is(error, |error: &ValidateError| matches!(error, ValidateError::NothingMade))
        || is(error, |error: &ChainError| !matches!(error, ChainError::Cancelled(_)))
        || is(error, is_of_design)
        || is(
            error,
            |error: &ClassifyError| matches!(error, ClassifyError::Zraa(error) if is_of_design(error)),
        )
        || is(error, |error: &ComposeError| matches!(error, ComposeError::MixedUnits { .. }))
        || is(error, |error: &InvertError| matches!(error, InvertError::NothingWanted))
}

/// Whether a design has no offsets to correct.
fn is_of_design(error: &ZraaError) -> bool {
    matches!(error, ZraaError::NoMatedPose | ZraaError::NoTranslation | ZraaError::NotHeld(_))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_status_has_a_code_of_its_own() {
        let mut codes = ExitStatus::ALL.map(|(status, _)| status.code());
        codes.sort_unstable();
        assert_eq!(codes, [0, 1, 2, 3, 4, 5, 130, 143]);
    }

    #[test]
    fn errors_of_the_library_have_their_status() {
        let gone = io::Error::from(io::ErrorKind::NotFound);
        assert_eq!(ExitStatus::of(&gone), ExitStatus::NoSuchFile);
        assert_eq!(ExitStatus::of(&io::Error::other("a wire")), ExitStatus::NotComputed);
        assert_eq!(ExitStatus::of(&WriteError::Exists { path: "a".into() }), ExitStatus::Usage);
        assert_eq!(ExitStatus::of(&WriteError::DiskFull { path: "a".into() }), ExitStatus::NotComputed);
        let content = ZarrError::Content { path: "a".into(), reason: "torn".to_owned() };
        assert_eq!(ExitStatus::of(&CompareError::Zarr(content)), ExitStatus::BadInput);
        assert_eq!(ExitStatus::of(&SuccessError::TooFew { motions: 1 }), ExitStatus::Usage);
        assert_eq!(ExitStatus::of(&HoldError::NotHeld), ExitStatus::NotComputed);
    }
}
