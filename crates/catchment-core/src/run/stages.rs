//! The stages of a run, each once.

use super::plan::{Afterwards, GRID_PART};
use super::window::WindowError;
use super::{Answer, Corrected, Over, Plan, Run, RunError, Seating, Upright, jams, window};
use crate::acceptance::{Acceptance, Domain, Warning};
use crate::exec::{Exec, Stopwatch};
use crate::landscape::{Grid, Landscape};
use crate::merit::Merits;
use crate::merit::success::success;
use crate::merit::tolerance::{Tolerance, followed};
use crate::method::correction::{self, ByFraction, ByNeighbours, CorrectionError, Stop};
use crate::method::{Decided, Doubts, Follow, Method, descent};
use crate::problem::Problem;

/// What follows random poses and doubtful cells exactly: the method itself where it decides each pose by itself (descents would know
/// nothing of the friction of a drop test), else exact descent.
pub(super) fn judge(method: &Method) -> Judge<'_> {
    Judge { own: method.follows(), descent: method.motions() }
}

/// Either of the two.
pub(super) struct Judge<'a> {
    own: Option<&'a dyn Follow>,
    descent: descent::Settings,
}

impl Judge<'_> {
    pub(super) fn as_follow(&self) -> &dyn Follow {
        self.own.unwrap_or(&self.descent)
    }

    /// Whether it follows exact motions, which a grid that rests on them, or was corrected by them, may ask for more.
    fn is_descent(&self) -> bool {
        self.own.is_none_or(|own| own.info().name == "descent")
    }
}

/// Decides every pose of the plan.
pub(super) fn decide(plan: &Plan, problem: &Problem, exec: &Exec) -> Result<Decided, RunError> {
    Ok(plan.method.decide(problem, &plan.domain, exec)?)
}

/// What the connector tolerates with roll and pitch locked, where five errors are free and exact motions answer beside a grid.
pub(super) fn upright(
    run: &Run,
    plan: &Plan,
    problem: &Problem,
    exec: &Exec,
) -> Result<Option<Upright>, RunError> {
    let judge = judge(&plan.method);
    let answers = judge.own.is_some() || matches!(plan.domain, Domain::Grid(_)) && plan.sample.is_some();
    if !(matches!(run.over, Over::Grid(_)) && answers && judge.is_descent()) {
        return Ok(None);
    }
    let Afterwards { steps, random } = plan.afterwards;
    let by = window::Effort { seed: run.seed, random, motions: &plan.method.motions() };
    Upright::of(problem, steps, &by, &exec.part([0.0, 1.0], "roll and pitch locked"))
}

/// How the time after the decision is divided, about: up to which share the Sum, what depends on the step, limits, boxes and the seat reach.
const SHARES: [f64; 5] = [0.15, 0.3, 0.5, 0.95, 1.0];

/// Everything after the decision.
pub(super) fn finish(
    run: &Run,
    plan: &Plan,
    problem: &Problem,
    (upright, decided): (Option<Upright>, Decided),
    started: Stopwatch,
    exec: &Exec,
) -> Result<Answer, RunError> {
    let Decided { mut acceptance, doubts, mut by_products, settings } = decided;
    let part = |from: f64, to: f64| exec.part([from, to], "Sum, limits, windows, seat");
    let [sum, step, limit, boxes, all] = SHARES;
    let [of_sum, of_step, of_limits, of_boxes, of_seat] =
        [part(0.0, sum), part(sum, step), part(step, limit), part(limit, boxes), part(boxes, all)];
    let mut corrected = None;
    if let Domain::Grid(grid) = &plan.domain {
        if plan.heights && by_products.landscape.is_none() {
            by_products.landscape = Some(Landscape::compute(problem.pair(), grid, exec)?);
        }
        if let Some(settings) = plan.sample.map(|settings| left(settings, started)) {
            let doubts = doubts.as_deref();
            corrected = Some(correct(&plan.method, problem, grid, &acceptance, doubts, &settings, &of_sum)?);
        }
        if let Some(doubts) = &doubts {
            // Which cells are settled depends on the number of random poses, not on the time they took.
            let most = corrected.as_ref().map_or(0, |corrected| corrected.found.descents);
            settle(&plan.method, problem, grid, &**doubts, &mut acceptance, most, &of_sum)?;
        }
    }
    let judge = judge(&plan.method);
    if judge.own.is_some() || corrected.is_some() || doubts.is_some() {
        acceptance.warnings.extend(judge.as_follow().doubt(problem, run.seed, &of_step)?);
    }
    let motions = plan.method.motions();
    let window = if run.window {
        Some(window::by(problem, &run.window_settings(), &motions, &of_boxes))
    } else {
        None
    };
    if let Some(Err(WindowError::Cancelled(error))) = window {
        return Err(error.into());
    }
    let mut merits = Merits::of(&acceptance, problem.alignment(), exec)?;
    if matches!(run.over, Over::Grid(_)) && (corrected.is_some() || judge.own.is_some()) {
        let grid = &match &plan.domain {
            Domain::Grid(grid) => grid.clone(),
            // Its axes say no more than the error box.
            Domain::Poses(_) => Grid::over(problem.alignment(), |_| 1),
        };
        // What follows random poses exactly can follow some along the axes, and about the largest cubes.
        let Afterwards { steps, random } = plan.afterwards;
        merits.tolerances = followed(grid, steps, |poses| {
            let decided = judge.as_follow().follow(problem, Domain::Poses(poses), &of_limits);
            Ok::<_, RunError>(decided?.0.outcomes)
        })?;
        if let Domain::Poses(_) = &plan.domain {
            let small = small_part(&merits.tolerances, grid);
            merits.warnings.extend(small);
        }
        if judge.is_descent() {
            let centered = window.as_ref().and_then(|window| window.as_ref().ok()).map(window::Window::cube);
            let drawn = corrected.as_ref().map_or(random, |corrected| corrected.found.descents);
            let random = random.min(drawn);
            let by = window::Effort { seed: run.seed, random, motions: &motions };
            window::follow_cubes(&mut merits, centered, problem, grid, &by, &of_boxes)?;
        }
    }
    let success = match &run.errors {
        Some(distribution) => Some(success(&acceptance, distribution, exec)?),
        None => None,
    };
    let jams = if run.jams { Some(jams::by(problem, &run.jams_settings(), &motions, exec)?) } else { None };
    let seating = Seating::of(problem, &acceptance, &motions, run.seed, &of_seat)?;
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

/// Single-axis limits below this share of the error box leave few random poses that dock.
const SMALL: f64 = 0.2;

/// That little of the error box can dock, where random poses answer.
fn small_part(tolerances: &[Tolerance], grid: &Grid) -> Option<Warning> {
    let share = |tolerance: &Tolerance| {
        let axis = grid.axes.iter().find(|axis| axis.dof == tolerance.dof)?;
        let share = tolerance.minus.max(tolerance.plus) / axis.lo.abs().max(axis.hi.abs());
        (share < SMALL).then(|| format!("{} at {:.0} %", tolerance.dof.name(), 100.0 * share))
    };
    let shares: Vec<String> = tolerances.iter().filter_map(share).collect();
    let text = format!(
        "the single-axis limits end early in the error box ({} of its half width), so few of the sampled poses dock: [errors] of about \
         four times the limits make the Sum more precise",
        shares.join(", ")
    );
    (!shares.is_empty()).then_some(Warning::Note { text })
}

/// What the grid has left of a budget of time, of which random poses have their part in any case.
fn left(settings: correction::Settings, started: Stopwatch) -> correction::Settings {
    let stop = match settings.stop {
        Stop::Budget(budget) => {
            let least = budget.saturating_sub(budget / GRID_PART);
            Stop::Budget(budget.saturating_sub(started.elapsed()).max(least))
        }
        stop => stop,
    };
    correction::Settings { stop, ..settings }
}

/// The Sum, made unbiased by random poses, most of them where the method is in doubt.
pub fn correct(
    method: &Method,
    problem: &Problem,
    grid: &Grid,
    acceptance: &Acceptance,
    doubts: Option<&dyn Doubts>,
    settings: &correction::Settings,
    exec: &Exec,
) -> Result<Corrected, CorrectionError> {
    let judge = judge(method);
    let judge = judge.as_follow();
    let follow = |poses: Vec<_>, exec: &Exec| {
        let decided = judge.follow(problem, Domain::Poses(poses), exec);
        Ok(decided.map_err(CorrectionError::from)?.0.outcomes)
    };
    let shape = grid.shape();
    let found = if let Some(doubts) = doubts {
        let by = ByFraction::new(|cell| doubts.fraction(cell), shape);
        correction::estimate(grid, &by, settings, exec, follow)
    } else {
        let by = ByNeighbours::new(&acceptance.outcomes, shape);
        correction::estimate(grid, &by, settings, exec, follow)
    }?;
    Ok(Corrected { found, seed: settings.seed, method: judge.info().name, settings: judge.settings() })
}

/// Follows the ambiguous cells exactly if they are at most `most`, else warns.
fn settle(
    method: &Method,
    problem: &Problem,
    grid: &Grid,
    doubts: &dyn Doubts,
    acceptance: &mut Acceptance,
    most: usize,
    exec: &Exec,
) -> Result<(), RunError> {
    let of = acceptance.outcomes.len();
    let (cells, listed) = correction::ambiguous(of, |cell| doubts.is_ambiguous(cell), most, exec)?;
    if cells > most {
        acceptance.warnings.push(Warning::Ambiguous { cells, of });
        return Ok(());
    }
    let judge = judge(method);
    let outcomes = &mut acceptance.outcomes;
    correction::settle(grid, &listed, outcomes, exec, |poses, exec| {
        Ok::<_, RunError>(judge.as_follow().follow(problem, Domain::Poses(poses), exec)?.0.outcomes)
    })
}
