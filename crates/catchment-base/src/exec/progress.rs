//! Progress of a run: a fraction per stage that never decreases.

use std::sync::{Arc, Mutex, PoisonError};

/// Called with the finished fraction, in [0, 1], and the stage's name. Within a run a stage's fractions never
/// decrease, whatever threads and parts report; calls are sequential. It must not report by itself.
pub type Progress = Arc<dyn Fn(f64, &'static str) + Send + Sync>;

/// The reports of a run, shared by its clones and parts.
struct Run {
    consumer: Progress,
    /// The greatest fraction reported for every stage.
    reports: Mutex<Vec<(&'static str, f64)>>,
}

/// Target of reports: the run, or a part of one of its stages.
#[derive(Clone)]
pub(super) struct Reporter {
    run: Arc<Run>,
    /// The span of [0, 1] within the stage of the run.
    span: [f64; 2],
    /// The stage that this is a part of.
    stage: Option<&'static str>,
}

impl Reporter {
    pub(super) fn new(consumer: Progress) -> Self {
        let run = Run { consumer, reports: Mutex::new(Vec::new()) };
        Self { run: Arc::new(run), span: [0.0, 1.0], stage: None }
    }

    /// For another run with the same consumer; a part stays a part of its run.
    pub(super) fn anew(&self) -> Self {
        if self.stage.is_some() { self.clone() } else { Self::new(Arc::clone(&self.run.consumer)) }
    }

    fn at(&self, fraction: f64) -> f64 {
        let [from, to] = self.span;
        (from + (to - from) * fraction.clamp(0.0, 1.0)).clamp(0.0, 1.0)
    }

    pub(super) fn part(&self, [from, to]: [f64; 2], stage: &'static str) -> Self {
        Self {
            run: Arc::clone(&self.run),
            span: [self.at(from), self.at(to)],
            stage: Some(self.stage.unwrap_or(stage)),
        }
    }

    pub(super) fn report(&self, fraction: f64, stage: &'static str) {
        let (fraction, stage) = (self.at(fraction), self.stage.unwrap_or(stage));
        // Held while the consumer is called, so that it hears in the order of the fractions.
        let mut reports = self.run.reports.lock().unwrap_or_else(PoisonError::into_inner);
        let known = reports.iter().position(|(name, _)| *name == stage);
        let greatest = known.map_or(0.0, |k| reports[k].1);
        // A fraction of zero items is not a number; it fails this comparison and is not reported.
        if fraction >= greatest {
            match known {
                Some(k) => reports[k].1 = fraction,
                None => reports.push((stage, fraction)),
            }
            (self.run.consumer)(fraction, stage);
        }
    }
}
