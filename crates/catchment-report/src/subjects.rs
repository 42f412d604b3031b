//! The reported results of a design, a line each: from it come the type of the report and its JSON schema.

use crate::ReportOf;

macro_rules! subjects {
    ($($(#[doc = $doc:literal])+ $(#[cfg $on:tt])? $report:ident = $result:ty;)+) => {
        $($(#[doc = $doc])+ $(#[cfg $on])? pub type $report = ReportOf<$result>;)+

        /// Adds the JSON schemas of these reports to a generator.
        #[cfg(feature = "schema")]
        pub(crate) fn add_json_schemas(generator: &mut schemars::SchemaGenerator) {
            $($(#[cfg $on])? let _ = generator.subschema_for::<$report>();)+
        }
    };
}

subjects! {
    /// All methods on a common grid.
    AgreementReport = catchment_study::agreement::Agreement;
    /// The probability that drop tests dock.
    #[cfg(feature = "drop")]
    ChanceReport = catchment_study::chance::Chance;
    /// Refinement of the grid, with every method.
    ConvergenceReport = catchment_study::convergence::Convergence;
    /// The effect of friction.
    FrictionReport = catchment_study::friction::Friction;
    /// Holding forces of a half.
    HoldReport = catchment_study::hold::HoldingForces;
    /// Jams: rests outside the seat.
    JamsReport = catchment_core::run::jams::Jams;
    /// The first contact as the kinematic method sees it.
    LeverReport = crate::FirstContact;
    /// A plan of trials.
    PlanReport = catchment_study::plan::TrialPlan;
    /// Rests of the halves.
    RestsReport = catchment_core::run::rests::Rests;
    /// The Sum against ρ, the centre of rotation and the aspect ratio.
    SensitivityReport = catchment_study::sensitivity::Sensitivity;
    /// Slices of the area of acceptance.
    SlicesReport = crate::SlicesResult;
    /// The probability that robots dock.
    SuccessesReport = catchment_study::success::Success;
    /// Every combination of values of a sweep.
    SweepReport = catchment_study::sweep::Sweep;
    /// Trials beside the exact region.
    TrialsReport = catchment_study::trials::Trials;
    /// A prediction beside the trials of a robot.
    ValidationReport = catchment_study::validate::Validation;
    /// The largest box of errors that all dock.
    WindowReport = catchment_core::run::window::ToleranceWindow;
    /// Offsets that are corrected without rotation.
    ZraaReport = crate::AcceptedOffsets;
}
