//! Parsing of the number of sampled poses that correct the Sum.

use catchment::method::correction::Stop;
use catchment::run::Sample;
use clap::Args;
use std::time::Duration;

/// When the sampling stops, and what it starts from.
#[derive(Debug, Clone, Args)]
pub(crate) struct SampleArgs {
    /// Number of sampled poses; 0 leaves the Sum uncorrected [default: 4000, fewer for round halves; 0 with flood]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=100_000_000), help_heading = SUM)]
    pub(super) samples: Option<u32>,
    /// Sample for this time instead, such as "20s" or "2 min"
    ///
    /// The grid takes up to half of it; cells that confluence does not decide in that time stay undecided. The report states the number of
    /// samples.
    #[arg(long, value_name = "TIME", value_parser = duration, conflicts_with_all = ["samples", "tolerance"], help_heading = SUM)]
    budget: Option<Duration>,
    /// Sample until the 95 % interval is ± this share of the Sum, such as 1% or 0.01
    #[arg(long, hide_short_help = true, value_name = "SHARE", value_parser = share, conflicts_with = "samples", help_heading = SUM)]
    pub(super) tolerance: Option<f64>,
    /// Seed of the sampled poses
    #[arg(long, hide_short_help = true, value_name = "SEED", default_value_t = SEED, help_heading = SUM)]
    pub(crate) seed: u64,
}

const SUM: &str = "Sampling";
const SEED: u64 = 1;

impl SampleArgs {
    /// The given options.
    pub(crate) fn requested(&self) -> impl Iterator<Item = &'static str> {
        [
            ("--samples", self.samples.is_some()),
            ("--budget", self.budget.is_some()),
            ("--tolerance", self.tolerance.is_some()),
            ("--seed", self.seed != SEED),
        ]
        .into_iter()
        .filter_map(|(option, given)| given.then_some(option))
    }

    /// The requested sample.
    pub(crate) fn sample(&self) -> Sample {
        match (self.samples, self.budget, self.tolerance) {
            (_, Some(budget), _) => Sample::Until(Stop::Budget(budget)),
            (_, _, Some(share)) => Sample::Until(Stop::Tolerance(share)),
            (Some(0), None, None) => Sample::None,
            (Some(samples), None, None) => Sample::Until(Stop::Samples(samples as usize)),
            (None, None, None) => Sample::ByMethod,
        }
    }
}

/// Parses a time such as `20s`, `2 min`, `0.5 h`.
pub(super) fn duration(text: &str) -> Result<Duration, String> {
    const UNITS: [(&str, f64); 4] = [("ms", 1e-3), ("s", 1.0), ("min", 60.0), ("h", 3600.0)];
    const LONGEST_S: f64 = 1e7;
    let number = text.trim().trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = &text.trim()[number.len()..];
    let factor = UNITS.iter().find(|(name, _)| *name == unit).map(|(_, factor)| factor);
    let value: Option<f64> = number.trim().parse().ok();
    match value.zip(factor).map(|(value, factor)| value * factor) {
        Some(seconds) if seconds > 0.0 && seconds <= LONGEST_S => Ok(Duration::from_secs_f64(seconds)),
        _ => Err("a time is a positive number and one of ms, s, min, h, such as 20s".to_owned()),
    }
}

/// Parses a share such as `1%`, `0.5 %`, `0.01`.
fn share(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.trim().strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    match number.trim().parse::<f64>().map(|value| value * unit) {
        Ok(share) if (SMALLEST_SHARE..1.0).contains(&share) => Ok(share),
        _ => {
            Err("a tolerance is a share of the Sum between 0.001 % and 100 %, such as 1% or 0.01".to_owned())
        }
    }
}

/// The smallest tolerance: 10¹⁰ descents would not reach it.
const SMALLEST_SHARE: f64 = 1e-5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_shares_are_read() {
        assert_eq!(duration("20s"), Ok(Duration::from_secs(20)));
        assert_eq!(duration("2 min"), Ok(Duration::from_mins(2)));
        assert_eq!(duration(" 250 ms"), Ok(Duration::from_millis(250)));
        for wrong in ["", "20", "s", "-1s", "nan s", "inf h", "20 sec", "1e9 h", "0s"] {
            assert!(duration(wrong).is_err(), "{wrong}");
        }
        assert_eq!(share("1%"), Ok(0.01));
        assert_eq!(share("0.02"), Ok(0.02));
        assert!((share("0.5 %").unwrap() - 0.005).abs() < 1e-15);
        for wrong in ["", "%", "-1%", "0", "100%", "1", "nan", "one"] {
            assert!(share(wrong).is_err(), "{wrong}");
        }
    }
}
