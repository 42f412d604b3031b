//! The names of the stages of a run.

use super::plan::{Afterwards, GRID_PART};
use super::window::WindowError;
use super::{Answer, Over, Run, RunCorrection, RunError, RunPlan, Seating, Upright, jams, window};
use crate::acceptance::{Acceptance, Domain};
use crate::diagnostic::{Diagnostic, Warning};
use crate::exec::{Exec, Stopwatch};
use crate::landscape::{Grid, Landscape};
use crate::merit::Merits;
use crate::merit::success::success;
use crate::merit::tolerance::{Tolerance, followed};
use crate::method::correction::{self, ByFraction, ByNeighbours, CorrectionError, Stop};
use crate::method::{CellFractions, Method, MethodOutput, PoseMethod, descent};
use crate::problem::Problem;

/// Follows sampled poses and ambiguous cells: the method itself if it decides each pose separately
/// (quasi-static motions would miss the friction of a drop test), else exact motion.
pub(super) fn follower(method: &Method) -> ExactFollower<'_> {
    ExactFollower { own: method.follows(), descent: method.motions() }
}

/// Either of the two.
pub(super) struct ExactFollower<'a> {
    own: Option<&'a dyn PoseMethod>,
    descent: descent::DescentSettings,
}

impl ExactFollower<'_> {
    pub(super) fn as_follow(&self) -> &dyn PoseMethod {
        self.own.unwrap_or(&self.descent)
    }

    /// Whether a grid that rests on its motions, or was corrected by them, may use exact descents for more.
    fn is_descent(&self) -> bool {
        self.own.is_none_or(PoseMethod::is_descent)
    }
}

/// Decides every pose of the plan.
pub(super) fn decide(plan: &RunPlan, problem: &Problem, exec: &Exec) -> Result<MethodOutput, RunError> {
    Ok(plan.method.decide(problem, &plan.domain, exec)?)
}

/// Results with roll and pitch locked, if five errors are free and exact motions accompany a grid.
pub(super) fn upright(
    run: &Run,
    plan: &RunPlan,
    problem: &Problem,
    exec: &Exec,
) -> Result<Option<Upright>, RunError> {
    let follower = follower(&plan.method);
    let answers = follower.own.is_some() || matches!(plan.domain, Domain::Grid(_)) && plan.sample.is_some();
    if !(matches!(run.over, Over::Grid(_)) && answers && follower.is_descent()) {
        return Ok(None);
    }
    let Afterwards { steps, random } = plan.afterwards;
    let by = window::Effort { seed: run.seed, random, motions: &plan.method.motions() };
    Upright::of(problem, steps, &by, &exec.part([0.0, 1.0], "roll and pitch locked"))
}

/// Approximate division of the time after the decision: the shares at the end of the Sum, the step-dependence
/// test, limits, boxes and the seat.
const SHARES: [f64; 5] = [0.15, 0.3, 0.5, 0.95, 1.0];

/// All stages after the decision: each stage receives the results of the earlier ones, and returns a value.
pub(super) fn finish(
    run: &Run,
    plan: &RunPlan,
    problem: &Problem,
    (upright, decided): (Option<Upright>, MethodOutput),
    started: Stopwatch,
    exec: &Exec,
) -> Result<Answer, RunError> {
    let part = |from: f64, to: f64| exec.part([from, to], "Sum, limits, windows, seat");
    let [sum, step, limit, boxes, all] = SHARES;
    let stages =
        Stages { run, plan, problem, follower: follower(&plan.method), motions: plan.method.motions() };
    let MethodOutput { mut acceptance, doubts, mut by_products, settings } = decided;
    let doubts = doubts.as_deref();
    if let (true, Domain::Grid(grid), None) = (plan.heights, &plan.domain, &by_products.landscape) {
        by_products.landscape = Some(Landscape::compute(problem.pair(), grid, exec)?);
    }
    let corrected = stages.corrected(&mut acceptance, doubts, started, &part(0.0, sum))?;
    if stages.follower.own.is_some() || corrected.is_some() || doubts.is_some() {
        let result = stages.follower.as_follow().step_warning(problem, run.seed, &part(sum, step))?;
        acceptance.warnings.extend(result.map(Diagnostic::from));
    }
    let of_boxes = part(limit, boxes);
    let window = stages.window(&of_boxes)?;
    let merits = stages.merits(
        &acceptance,
        (corrected.as_ref(), window.as_ref()),
        [&part(step, limit), &of_boxes],
        exec,
    )?;
    let success = run.errors.as_ref().map(|errors| success(&acceptance, errors, exec)).transpose()?;
    let jams =
        run.jams.then(|| jams::by(problem, &run.jams_settings(), &stages.motions, exec)).transpose()?;
    let seating = Seating::of(problem, &acceptance, &stages.motions, run.seed, &part(boxes, all))?;
    Ok(Answer {
        problem: problem.clone(),
        run: run.clone(),
        acceptance,
        settings,
        corrected,
        by_products,
        merits,
        upright,
        success,
        jams,
        window,
        seating,
        seconds: started.seconds(),
        threads: exec.threads(),
    })
}

/// Data for every stage after the decision.
struct Stages<'a> {
    run: &'a Run,
    plan: &'a RunPlan,
    problem: &'a Problem,
    follower: ExactFollower<'a>,
    motions: descent::DescentSettings,
}

/// The window of a run that computes a window, or the reason for its absence.
type WindowOrNot = Result<window::ToleranceWindow, WindowError>;

impl Stages<'_> {
    /// The Sum of a grid, made unbiased by sampled poses, and the grid's ambiguous cells settled by them.
    fn corrected(
        &self,
        acceptance: &mut Acceptance,
        doubts: Option<&dyn CellFractions>,
        started: Stopwatch,
        exec: &Exec,
    ) -> Result<Option<RunCorrection>, RunError> {
        let Self { plan, problem, .. } = self;
        let Domain::Grid(grid) = &plan.domain else { return Ok(None) };
        let sample = plan.sample.map(|settings| left(settings, started));
        let correct = |settings| correct(&plan.method, problem, grid, acceptance, doubts, &settings, exec);
        let corrected = sample.map(correct).transpose()?;
        if let Some(doubts) = doubts {
            // The number of settled cells depends on the number of sampled poses, not on their time.
            let most = corrected.as_ref().map_or(0, |corrected| corrected.estimate.descents);
            settle(&plan.method, problem, grid, doubts, acceptance, most, exec)?;
        }
        Ok(corrected)
    }

    /// The tolerance window, if the run computes one.
    fn window(&self, exec: &Exec) -> Result<Option<WindowOrNot>, RunError> {
        if !self.run.window {
            return Ok(None);
        }
        match window::by(self.problem, &self.run.window_settings(), &self.motions, exec) {
            Err(WindowError::Cancelled(error)) => Err(error.into()),
            result => Ok(Some(result)),
        }
    }

    /// The figures of merit: by exact motions along the axes and about the largest cubes, if the result rests
    /// on the follower's motions.
    fn merits(
        &self,
        acceptance: &Acceptance,
        (corrected, window): (Option<&RunCorrection>, Option<&WindowOrNot>),
        [of_limits, of_boxes]: [&Exec; 2],
        exec: &Exec,
    ) -> Result<Merits, RunError> {
        let Self { run, plan, problem, follower, motions } = self;
        let mut merits = Merits::of(acceptance, problem.alignment(), exec)?;
        if !matches!(run.over, Over::Grid(_)) || corrected.is_none() && follower.own.is_none() {
            return Ok(merits);
        }
        let grid = &match &plan.domain {
            Domain::Grid(grid) => grid.clone(),
            // Its axes are those of the error box.
            Domain::Poses(_) => Grid::over(problem.alignment(), |_| 1),
        };
        let Afterwards { steps, random } = plan.afterwards;
        merits.tolerances = followed(grid, steps, |poses| {
            let decided = follower.as_follow().follow(problem, Domain::Poses(poses), of_limits);
            Ok::<_, RunError>(decided?.0.outcomes)
        })?;
        if let Domain::Poses(_) = &plan.domain {
            let small = small_part(&merits.tolerances, grid);
            merits.warnings.extend(small);
        }
        if follower.is_descent() {
            let centered = window.and_then(|window| window.as_ref().ok()).map(window::ToleranceWindow::cube);
            let drawn = corrected.map_or(random, |corrected| corrected.estimate.descents);
            let random = random.min(drawn);
            let by = window::Effort { seed: run.seed, random, motions };
            window::follow_cubes(&mut merits, centered, problem, grid, &by, of_boxes)?;
        }
        Ok(merits)
    }
}

/// Single-axis limits below this share of the error box leave few sampled poses that dock.
const SMALL: f64 = 0.2;

/// Warning that a small part of the error box docks, for results from samples.
fn small_part(tolerances: &[Tolerance], grid: &Grid) -> Option<Diagnostic> {
    let share = |tolerance: &Tolerance| {
        let axis = grid.axes.iter().find(|axis| axis.dof == tolerance.axis)?;
        let share = tolerance.minus.max(tolerance.plus) / axis.lo.abs().max(axis.hi.abs());
        (share < SMALL).then(|| format!("{} at {:.0} %", tolerance.axis.name(), 100.0 * share))
    };
    let shares: Vec<String> = tolerances.iter().filter_map(share).collect();
    let text = format!(
        "the single-axis limits end early in the error box ({} of its half width), so few of the sampled poses dock: [errors] of about \
         four times the limits make the Sum more precise",
        shares.join(", ")
    );
    (!shares.is_empty()).then(|| Diagnostic::warning("small-part", text))
}

/// Remaining part of a time budget after the grid; samples always have a part.
fn left(settings: correction::CorrectionSettings, started: Stopwatch) -> correction::CorrectionSettings {
    let stop = match settings.stop {
        Stop::Budget(budget) => {
            let least = budget.saturating_sub(budget / GRID_PART);
            Stop::Budget(budget.saturating_sub(started.elapsed()).max(least))
        }
        stop => stop,
    };
    correction::CorrectionSettings { stop, ..settings }
}

/// The Sum, made unbiased by samples, most of them where the method is uncertain.
pub fn correct(
    method: &Method,
    problem: &Problem,
    grid: &Grid,
    acceptance: &Acceptance,
    doubts: Option<&dyn CellFractions>,
    settings: &correction::CorrectionSettings,
    exec: &Exec,
) -> Result<RunCorrection, CorrectionError> {
    let follower = follower(method);
    let follower = follower.as_follow();
    let follow = |poses: Vec<_>, exec: &Exec| {
        let decided = follower.follow(problem, Domain::Poses(poses), exec);
        Ok(decided.map_err(CorrectionError::from)?.0.outcomes)
    };
    let shape = grid.shape();
    let estimate = if let Some(doubts) = doubts {
        let by = ByFraction::new(|cell| doubts.fraction(cell), shape);
        correction::estimate(grid, &by, settings, exec, follow)
    } else {
        let by = ByNeighbours::new(&acceptance.outcomes, shape);
        correction::estimate(grid, &by, settings, exec, follow)
    }?;
    Ok(RunCorrection {
        estimate,
        seed: settings.seed,
        method: follower.info().name,
        settings: follower.settings(),
    })
}

/// Follows the ambiguous cells exactly if they are at most `most`, else warns.
fn settle(
    method: &Method,
    problem: &Problem,
    grid: &Grid,
    doubts: &dyn CellFractions,
    acceptance: &mut Acceptance,
    most: usize,
    exec: &Exec,
) -> Result<(), RunError> {
    let of = acceptance.outcomes.len();
    let (cells, listed) = correction::ambiguous(of, |cell| doubts.is_ambiguous(cell), most, exec)?;
    if cells > most {
        acceptance.warnings.push(Warning::Ambiguous { cells, of }.into());
        return Ok(());
    }
    let follower = follower(method);
    let outcomes = &mut acceptance.outcomes;
    correction::settle(grid, &listed, outcomes, exec, |poses, exec| {
        Ok::<_, RunError>(follower.as_follow().follow(problem, Domain::Poses(poses), exec)?.0.outcomes)
    })
}
