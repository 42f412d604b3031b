//! Validity of the parts that only some methods have: basins, a partition, a sample.

use super::{UnsoundError, hold, not_negative, share};
use crate::schema::{BasinsReport, RunBody, WindowSection};
use catchment_core::method::certified::BoxCertificate;
use catchment_core::method::flood::ToleranceReason;
use catchment_core::run::jams::Jams;

impl RunBody {
    /// Checks the parts that are present.
    pub(super) fn check_parts(&self) -> Result<(), UnsoundError> {
        if let Some(basins) = &self.basins {
            check_basins(basins, self.acceptance.cells)?;
        }
        if let Some(watersheds) = &self.watersheds {
            share(watersheds.moved_share, "watersheds.moved_share")?;
        }
        if let Some(partition) = &self.partition {
            not_negative(partition.sum, "partition.sum")?;
        }
        if let Some(certificate) = &self.certificate {
            check_certificate(certificate)?;
        }
        if let Some(inherited) = &self.inherited {
            hold(
                inherited.inherited <= inherited.cells,
                "inherited.inherited",
                "must be at most inherited.cells",
            )?;
            hold(inherited.wrong <= inherited.tried, "inherited.wrong", "must be at most inherited.tried")?;
            interval(inherited.wrong_ci95, "inherited.wrong_ci95")?;
        }
        if let Some(window) = &self.window {
            check_window(window)?;
        }
        if let Some(jams) = &self.jams {
            check_jams(jams)?;
        }
        self.check_sample()
    }

    fn check_sample(&self) -> Result<(), UnsoundError> {
        let Some(sample) = &self.acceptance.sample else { return Ok(()) };
        let name = |what: &str| format!("acceptance.sample.{what}");
        let mut descents = 0usize;
        for stratum in &sample.strata {
            share(stratum.share, &name("strata.share"))?;
            share(stratum.accepted, &name("strata.accepted"))?;
            let decided = stratum.aligned.checked_add(stratum.undecided);
            let sound = decided.is_some_and(|decided| decided <= stratum.descents);
            hold(sound, name("strata.descents"), "must be at least those that aligned and those undecided")?;
            descents = descents.saturating_add(stratum.descents);
        }
        let whole: f64 = sample.strata.iter().map(|stratum| stratum.share).sum();
        share(sample.misclassified, &name("misclassified"))?;
        interval(sample.misclassified_ci95, &name("misclassified_ci95"))?;
        // Shares are counts of cells over all cells: their sum is 1 but for rounding.
        let is_whole = sample.strata.is_empty() || (whole - 1.0).abs() <= 1e-9;
        hold(is_whole, name("strata.share"), "must add up to 1")?;
        hold(descents == sample.descents, name("descents"), "must be those of the strata")
    }
}

fn check_certificate(result: &BoxCertificate) -> Result<(), UnsoundError> {
    let shares =
        [(result.yes, "yes"), (result.no, "no"), (result.undecided, "undecided"), (result.window, "window")];
    for (value, name) in shares {
        share(value, &format!("certificate.{name}"))?;
    }
    // Shares are sums over boxes: they make 1 but for rounding.
    let whole = result.yes + result.no + result.undecided;
    hold((whole - 1.0).abs() <= 1e-9, "certificate.undecided", "must make 1 with yes and no")?;
    for measure in result.measures {
        not_negative(measure, "certificate.measures")?;
    }
    not_negative(result.retention_at_least, "certificate.retention_at_least")?;
    let ordered = result.retention_at_most.is_none_or(|most| most >= result.retention_at_least);
    hold(ordered, "certificate.retention_at_most", "must be no less than retention_at_least")
}

fn check_window(result: &WindowSection) -> Result<(), UnsoundError> {
    let widths = result.half_widths.0.values().copied();
    let reaches = result.details.sides.iter().flat_map(|side| [side.half_width, side.alone, side.beside]);
    for width in widths.chain(reaches) {
        not_negative(width, "window: a half-width")?;
    }
    share(result.details.certificate.failing_at_most, "window.certificate.failing_at_most")
}

fn check_jams(result: &Jams) -> Result<(), UnsoundError> {
    let followed: Option<usize> =
        result.outcomes.values().try_fold(0usize, |sum, share| sum.checked_add(share.count));
    hold(followed == Some(result.motions), "jams.motions", "must be those of jams.outcomes")?;
    let drawn = result.outcomes.values().chain(result.expected.iter().flat_map(|of| of.values()));
    for of in drawn.chain(result.jams.iter().map(|jam| &jam.of_box)) {
        share(of.share, "jams: a share")?;
        interval(of.ci95, "jams: an interval")?;
    }
    let shares = result.jams.iter().flat_map(|jam| [jam.of_jams, jam.of_failures]);
    for of in shares.chain(result.features.iter().flat_map(|pair| [pair.of_jams, pair.of_failures])) {
        share(of, "jams: a share")?;
    }
    for jam in &result.jams {
        let ordered = jam.extent.iter().all(|extent| extent.from <= extent.to);
        hold(ordered, "jams.jams.extent", "must be in order")?;
    }
    Ok(())
}

/// An interval of a share.
fn interval([lo, hi]: [f64; 2], name: &str) -> Result<(), UnsoundError> {
    share(lo, name)?;
    share(hi, name)?;
    hold(lo <= hi, name, "must be in order")
}

fn check_basins(basins: &BasinsReport, cells: usize) -> Result<(), UnsoundError> {
    not_negative(basins.tolerance.depth, "basins.tolerance.depth")?;
    if let ToleranceReason::WidestGap { between: [lo, hi], height_step } = basins.tolerance.reason {
        hold(lo <= hi, "basins.tolerance.between", "must be in order")?;
        not_negative(height_step, "basins.tolerance.height_step")?;
    }
    hold(basins.merged <= basins.minima, "basins.merged", "must be at most basins.minima")?;
    hold(basins.largest.len() <= basins.merged, "basins.largest", "must be at most basins.merged")?;
    let sorted = basins.largest.is_sorted_by(|a, b| a.cells >= b.cells);
    hold(sorted, "basins.largest", "must be in order, the largest first")?;
    let all = basins.largest.iter().try_fold(0usize, |sum, basin| sum.checked_add(basin.cells));
    hold(
        all.is_some_and(|all| all <= cells),
        "basins.largest.cells",
        "must add up to no more than there are",
    )?;
    for basin in &basins.largest {
        share(basin.fraction, "basins.largest.fraction")?;
        let finite = basin.minimum.to_array().iter().all(|v| v.is_finite());
        hold(finite, "basins.largest.minimum", "must be finite")?;
        for (value, name) in [(basin.depth, "depth"), (basin.escape, "escape")] {
            not_negative(value.unwrap_or(0.0), &format!("basins.largest.{name}"))?;
        }
    }
    let rising = basins.staircase.is_sorted_by(|a, b| a.above <= b.above);
    hold(rising, "basins.staircase.above", "must be in order")?;
    for step in &basins.staircase {
        not_negative(step.above, "basins.staircase.above")?;
        not_negative(step.sum, "basins.staircase.sum")?;
        share(step.fraction, "basins.staircase.fraction")?;
        hold(step.cells <= cells, "basins.staircase.cells", "must be no more than there are")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::Report;
    use crate::schema::{PartitionReport, RunBody, SampleReport, WindowSection, basins};
    use catchment_core::exec::Exec;
    use catchment_core::method::certified::BoxCertificate;
    use catchment_core::method::confluence::InheritedLabels;
    use catchment_core::method::correction::Stratum;
    use catchment_core::problem::Problem;
    use catchment_core::run::{jams, window};

    type Spoil = fn(&mut RunBody);

    /// A run with every part that a report may have.
    fn body() -> RunBody {
        let (design, result) = basins::tests::flooded();
        let null = serde_json::Value::Null;
        let report = Report::new(&design, &result.acceptance, null.clone(), None, &Exec::new()).unwrap();
        let mut body = report.with_basins(&result.acceptance, &result.hierarchy).body;
        body.partition = Some(PartitionReport::default());
        body.certificate =
            Some(BoxCertificate { yes: 0.3, no: 0.6, undecided: 0.1, ..BoxCertificate::default() });
        body.inherited =
            Some(InheritedLabels { cells: 9, inherited: 7, tried: 5, ..InheritedLabels::default() });
        let problem = Problem::of(design.clone()).unwrap();
        let requested = jams::JamsSettings { motions: Some(300), ..jams::JamsSettings::default() };
        let result = jams::run(&problem, &requested, &Exec::new()).unwrap();
        body.jams = Some(result);
        let requested = window::WindowSettings { motions: Some(100), ..window::WindowSettings::default() };
        let result = window::run(&problem, &requested, &Exec::new()).unwrap();
        body.window = Some(WindowSection::from(&result));
        let stratum = |share| Stratum {
            name: "all".to_owned(),
            share,
            descents: 10,
            aligned: 4,
            undecided: 1,
            accepted: 0.4,
        };
        let strata = vec![stratum(0.25), stratum(0.75)];
        body.acceptance.sample = Some(SampleReport {
            method: "descent".to_owned(),
            settings: null,
            seed: 1,
            descents: 20,
            misclassified: 0.1,
            misclassified_ci95: [0.05, 0.2],
            strata,
        });
        body
    }

    #[test]
    fn parts_that_cannot_be_are_named() {
        let whole = body();
        whole.check().unwrap();
        let read: RunBody = serde_json::from_value(serde_json::to_value(&whole).unwrap()).unwrap();
        assert_eq!(read, whole);
        let spoils: [(&str, Spoil); 25] = [
            ("basins.tolerance.depth must", |b| b.basins.as_mut().unwrap().tolerance.depth = -1.0),
            ("basins.merged must", |b| b.basins.as_mut().unwrap().minima = 0),
            ("basins.largest must be at most", |b| {
                let basins = b.basins.as_mut().unwrap();
                (basins.merged, basins.minima) = (0, 0);
            }),
            ("basins.largest must be in order", |b| b.basins.as_mut().unwrap().largest.reverse()),
            ("basins.largest.cells must", |b| b.basins.as_mut().unwrap().largest[0].cells = usize::MAX),
            ("basins.largest.fraction must", |b| b.basins.as_mut().unwrap().largest[0].fraction = 1.5),
            ("basins.largest.depth must", |b| b.basins.as_mut().unwrap().largest[0].depth = Some(-0.1)),
            ("basins.staircase.above must", |b| b.basins.as_mut().unwrap().staircase[0].above = 1e300),
            ("basins.staircase.cells must", |b| {
                b.basins.as_mut().unwrap().staircase[0].cells = usize::MAX;
            }),
            ("partition.sum must", |b| b.partition.as_mut().unwrap().sum = f64::NAN),
            ("certificate.undecided must", |b| b.certificate.as_mut().unwrap().yes = 0.4),
            ("certificate.retention_at_most must", |b| {
                b.certificate.as_mut().unwrap().retention_at_most = Some(-0.1);
            }),
            ("inherited.inherited must", |b| b.inherited.as_mut().unwrap().inherited = 10),
            ("inherited.wrong must", |b| b.inherited.as_mut().unwrap().wrong = 6),
            ("inherited.wrong_ci95 must", |b| b.inherited.as_mut().unwrap().wrong_ci95 = [0.2, 0.1]),
            ("jams.motions must", |b| b.jams.as_mut().unwrap().motions = 7),
            ("jams: a share must", |b| b.jams.as_mut().unwrap().jams[0].of_failures = 7.0),
            ("jams: an interval must", |b| b.jams.as_mut().unwrap().jams[0].of_box.ci95.reverse()),
            ("window: a half-width must", |b| b.window.as_mut().unwrap().details.sides[0].alone = -1.0),
            ("window.certificate.failing_at_most must", |b| {
                b.window.as_mut().unwrap().details.certificate.failing_at_most = f64::NAN;
            }),
            ("acceptance.sample.misclassified must", |b| sample(b).misclassified = 1.5),
            ("acceptance.sample.strata.share must lie", |b| sample(b).strata[0].share = -0.25),
            ("acceptance.sample.strata.share must add", |b| sample(b).strata[0].share = 0.5),
            ("acceptance.sample.strata.descents must", |b| sample(b).strata[1].aligned = usize::MAX),
            ("acceptance.sample.descents must", |b| sample(b).descents = 7),
        ];
        for (message, spoil) in spoils {
            let mut body = whole.clone();
            spoil(&mut body);
            let refusal = body.check().unwrap_err().to_string();
            assert!(refusal.starts_with(message), "{refusal} instead of {message}");
        }
    }

    fn sample(body: &mut RunBody) -> &mut SampleReport {
        body.acceptance.sample.as_mut().unwrap()
    }
}
