//! Sweeps: the statements of chapter 5 of the dissertation, checked by exact motion; and the guarantees of a sweep about threads and stored
//! results.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use catchment::connector::Connector;
use catchment::contact::Pair;
use catchment::design::{Alignment, Family, FamilySpec, SourceText};
use catchment::exec::OutOfBudget;
use catchment::landscape::Grid;
use catchment::method::confluence::{self, ConfluenceSettings};
use catchment::pose::Dof;
use catchment::prelude::*;
use catchment::report::SweepReport;
use catchment::study::sweep::{
    DesignResult, DesignStore, NoStore, Sweep, SweepError, SweepPlan, SweepSettings,
};
use std::collections::BTreeMap;
use std::io;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Enough memory for the result of a sweep of two designs, too little for a grid.
const FIGURES: u64 = 2 * 2048;

const RATIOS: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];

fn plan(text: &str, axes: &[&str], cells: &str, samples: usize) -> Result<SweepPlan, SweepError> {
    use catchment::method::correction::Stop;
    let run = Run {
        over: Over::Grid(cells.parse().unwrap()),
        sample: Sample::Until(Stop::Samples(samples)),
        ..Run::default()
    };
    let axes = axes.iter().map(|axis| axis.parse().unwrap()).collect();
    SweepPlan::new(&SourceText::new("d.toml", text), SweepSettings { axes, run }, Ok)
}

fn family(name: &str, free: &str) -> String {
    format!("[connector]\nfamily = '{name}'\n[alignment]\nfree = {free}\n")
}

/// Sums by aspect ratio (rows) and centre of rotation −1, −0.5, 0, 0.5, 1 (columns): the cells whose centre docks by exact motion.
fn table(family: Family, free: &[Dof], cells: usize) -> Vec<Vec<f64>> {
    let sum = |aspect_ratio: f64, cor: f64| {
        let mut alignment = Alignment::default_for(Some(family));
        alignment.free = free.iter().copied().collect();
        alignment.center_of_rotation = cor;
        let spec = FamilySpec::new(family).with_aspect_ratio(aspect_ratio);
        let pair = Pair::new(&Connector::of_family(&spec, alignment.mount).unwrap(), &alignment);
        let grid = Grid::over(&alignment, |_| cells);
        let labels = confluence::run(&pair, &grid, &ConfluenceSettings::default(), &Exec::new()).unwrap();
        labels.acceptance(&Exec::new()).counts()[0] as f64 * grid.cell_measure()
    };
    RATIOS.map(|ratio| [-1.0, -0.5, 0.0, 0.5, 1.0].map(|cor| sum(ratio, cor)).to_vec()).to_vec()
}

/// Kendall's count: rising pairs minus falling pairs, as a share of all pairs.
fn tendency(values: &[f64]) -> f64 {
    let pairs = (0..values.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let signs: Vec<f64> = pairs.map(|(i, j)| (values[j] - values[i]).signum()).collect();
    signs.iter().sum::<f64>() / signs.len() as f64
}

/// Section 5.2 of the dissertation, by exact motion and with the centre of rotation measured from the face: "more remote COR tends to correspond
/// to larger AA" holds for both faces at every ratio. "As does smaller aspect ratio" holds for the V-Face if the centre does not lie behind the
/// face. It does not hold for the X-Face, whose acceptance is largest in between. "Most of the areas of acceptance for the X-Face are larger
/// than the V-Face by a factor of up to two" holds, except for the flattest.
#[test]
fn the_trends_of_the_planar_faces() {
    let v = table(Family::VFace, &[Dof::X, Dof::Pitch], 22);
    let x = table(Family::XFace, &[Dof::X, Dof::Pitch], 22);
    for (name, sums) in [("V", &v), ("X", &x)] {
        for (ratio, row) in RATIOS.iter().zip(sums) {
            assert!(row[4] > row[0] && tendency(row) > 0.0, "{name}-Face, AR {ratio}: {row:?}");
        }
    }
    let over_ratio = |sums: &[Vec<f64>], k: usize| sums.iter().map(|row| row[k]).collect::<Vec<_>>();
    assert!((2..5).all(|k| tendency(&over_ratio(&v, k)) < 0.0), "{v:?}");
    assert!(
        (0..2).all(|k| v[4][k] > v[0][k]),
        "behind the face the steepest accept more than the flattest: {v:?}"
    );
    for k in 2..5 {
        let column = over_ratio(&x, k);
        let inner = column[1..4].iter().fold(0.0f64, |a, b| a.max(*b));
        assert!(inner > column[0] && inner > column[4], "{x:?}");
    }
    let ratios: Vec<f64> = x.iter().flatten().zip(v.iter().flatten()).map(|(x, v)| x / v).collect();
    let larger = ratios.iter().filter(|ratio| **ratio > 1.0).count();
    assert!(larger > 20 && ratios.iter().all(|ratio| *ratio < 3.0), "{larger} of 25: {ratios:?}");
}

/// Section 5.3.2, of the pyramid in (x, y, pitch), likewise: a remote centre accepts more at every ratio. "Lower AR values yield AA that vary
/// less with COR" does not hold for centres measured in D from the face: a pyramid of four widths is so steep that a width more or less
/// changes nothing. This shows most clearly where its acceptance is small.
#[test]
fn the_trends_of_the_pyramid() {
    let sums = table(Family::Pyramid, &[Dof::X, Dof::Y, Dof::Pitch], 14);
    for (ratio, row) in RATIOS.iter().zip(&sums) {
        assert!(row[4] > row[0] && tendency(row) >= 0.0, "AR {ratio}: {row:?}");
    }
    let gain = |row: &[f64]| row[4] / row[0];
    let gains: Vec<f64> = sums.iter().map(|row| gain(row)).collect();
    assert!(gains.is_sorted_by(|a, b| a > b), "the flatter, the more the centre matters: {gains:?}");
    let behind = sums.iter().map(|row| row[0]).collect::<Vec<_>>();
    assert!(tendency(&behind) > 0.0, "centres behind the face want steep pyramids: {behind:?}");
}

/// Keeps everything in memory, and counts look-ups and hits.
#[derive(Default)]
struct Memory {
    kept: Mutex<BTreeMap<String, DesignResult>>,
    found: AtomicUsize,
}

impl DesignStore for Memory {
    fn find(&self, key: &str) -> Option<DesignResult> {
        let found = self.kept.lock().unwrap().get(key).cloned();
        self.found.fetch_add(usize::from(found.is_some()), Ordering::Relaxed);
        found
    }

    fn keep(&self, key: &str, found: &DesignResult) -> io::Result<()> {
        let text = serde_json::to_string(found)?;
        self.kept.lock().unwrap().insert(key.to_owned(), serde_json::from_str(&text)?);
        Ok(())
    }
}

fn small(axes: &[&str]) -> SweepPlan {
    plan(&family("x-face", "['x', 'pitch']"), axes, "9", 50).unwrap()
}

fn run(plan: SweepPlan, keep: &dyn DesignStore, threads: usize) -> Sweep {
    plan.run(keep, &Exec::new().with_threads(threads).unwrap()).unwrap()
}

#[test]
fn threads_and_stored_results_change_nothing() {
    let axes = ["aspect_ratio=0.5,1,2", "cor=-1,0,1"];
    let memory = Memory::default();
    let whole = run(small(&axes), &memory, 1);
    assert_eq!(memory.kept.lock().unwrap().len(), 9);
    assert_eq!(run(small(&axes), &NoStore, 3), whole);
    // Half of the results are lost: the sweep does not recompute the other half.
    memory.kept.lock().unwrap().retain(|key, _| key.as_bytes()[0].is_multiple_of(2));
    let left = memory.kept.lock().unwrap().len();
    assert_eq!(run(small(&axes), &memory, 2), whole);
    assert_eq!(memory.found.load(Ordering::Relaxed), left);
    // Another run or another design hits no stored result.
    memory.found.store(0, Ordering::Relaxed);
    plan(&family("x-face", "['x', 'pitch']"), &axes, "10", 50).unwrap().run(&memory, &Exec::new()).unwrap();
    assert_eq!(memory.found.load(Ordering::Relaxed), 0);
    // A sweep with fewer values hits the stored ones.
    let fewer = run(small(&["aspect_ratio=1", "cor=-1,1"]), &memory, 1);
    assert_eq!(memory.found.load(Ordering::Relaxed), 2);
    assert_eq!(fewer.designs[1].result, whole.designs[5].result);
}

/// One design of a sweep equals a run of that design.
#[test]
fn a_design_of_a_sweep_is_a_run() {
    let sweep = run(small(&["cor=-1,0.5"]), &NoStore, 1);
    let text = family("x-face", "['x', 'pitch']") + "center_of_rotation = 0.5\n";
    let problem = Draft::read(SourceText::new("d.toml", text)).unwrap().build().unwrap();
    let answer = sweep.settings.run.on(&problem, &Exec::new()).unwrap();
    let figures = sweep.designs[1].result.figures().unwrap();
    assert_eq!((figures.sum, figures.sum_ci95), (answer.sum(), answer.sum_ci95()));
    assert_eq!(figures.onaa_edge, answer.onaa().map(|onaa| onaa.edge));
    let outline = figures.outline.as_ref().unwrap();
    let digits: String = answer.acceptance.outcomes.iter().map(|o| (*o as u8).to_string()).collect();
    assert_eq!(outline.outcomes, digits);
}

/// This memory holds one design, but not two together. A design that does not fit at all is an error, not a refused design.
#[test]
fn designs_that_do_not_fit_together_run_alone() {
    let fine = || plan(&family("x-face", "['x', 'pitch']"), &["cor=-1,0.5"], "40", 50).unwrap();
    let ample = run(fine(), &NoStore, 1);
    let within = |bytes: u64, threads: usize| {
        let exec = Exec::new().with_threads(threads).unwrap().with_memory_budget(bytes);
        fine().run(&NoStore, &exec)
    };
    let refused = within(FIGURES, 1).unwrap_err();
    let SweepError::Run(RunError::OutOfBudget(OutOfBudget { needed, .. })) = refused else {
        panic!("{refused}")
    };
    assert_eq!(within(needed * 3 / 2, 2).unwrap(), ample);
    assert!(matches!(within(needed - 1, 2), Err(SweepError::Run(RunError::OutOfBudget(_)))));
}

#[test]
fn an_unbuildable_design_is_reported_and_skipped() {
    let text = family("pyramid", "['x', 'yaw']");
    let plan = plan(&text, &["family=pyramid,cone"], "5", 10).unwrap();
    let base = plan.base().clone();
    let sweep = run(plan, &NoStore, 2);
    assert!(sweep.designs[0].result.figures().is_some());
    let DesignResult::Refused(reason) = &sweep.designs[1].result else { panic!("{:?}", sweep.designs[1]) };
    let alone = Draft::read(SourceText::new("d.toml", text.replace("pyramid", "cone")));
    let Err(ProblemError::Diagnostics(diagnostics)) = alone.unwrap().build() else { panic!("it builds") };
    assert_eq!(*reason, diagnostics.list[0].to_string(), "what is wrong, and what helps");
    assert_eq!((sweep.largest, sweep.smallest), (Some(0), Some(0)));
    let report = SweepReport::new(&base, sweep.clone(), Vec::new(), None);
    let flat = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(flat(&report.table()).contains(&flat(&format!("family cone: {reason}"))), "{}", report.table());
    assert_eq!(report.records()[2].last(), Some(reason));
    assert!(report.records().iter().all(|record| record.len() == report.records()[0].len()));
}

#[test]
fn impossible_sweeps_are_refused() {
    let text = family("v-face", "['x']");
    let refused = |axes: &[&str]| plan(&text, axes, "5", 10).unwrap_err().to_string();
    assert!(
        refused(&["aspect_ratio=1,-1"]).contains("d.toml with aspect_ratio = -1:"),
        "{}",
        refused(&["aspect_ratio=1,-1"])
    );
    assert!(refused(&["cor=1", "center_of_rotation=2"]).contains("two lists"));
    assert!(refused(&["cor=0..1/1000", "rho=1..2/1000"]).contains("1000000 designs"));
    assert!(refused(&["pins=1,2"]).contains("pins"), "not a parameter of the family");
    let nothing = plan(&family("pin-hole", "['x']"), &["pin_radius=0.8,0.9"], "5", 10).unwrap();
    assert!(matches!(nothing.run(&NoStore, &Exec::new()), Err(SweepError::AllRefused { designs: 2, .. })));
}
