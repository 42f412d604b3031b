//! The coverage of intervals as aligned text.

use crate::study::coverage::{Coverage, CoverageSettings};
use std::fmt;

impl fmt::Display for Coverage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let CoverageSettings { repeats, descents, exact } = self.settings;
        writeln!(
            f,
            "Coverage: {repeats} intervals of {descents} descents each, against {exact} plain descents"
        )?;
        writeln!(
            f,
            "  design                        strata      accepted          held    bias   ± of Sum  worth"
        )?;
        for r in &self.rows {
            writeln!(
                f,
                "  {:<28}  {:<10}  {:.4} ± {:.4}  {:>4.0} %  {:+.2} %  {:>7.2} %  {:>5.1}",
                r.design,
                r.strata,
                r.exact,
                r.exact_error,
                100.0 * r.held,
                100.0 * r.bias,
                100.0 * r.half_width,
                r.worth,
            )?;
        }
        Ok(())
    }
}
