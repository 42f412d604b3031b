//! All reproduced results as one text.

use crate::study::claims::{Claim, ClaimCheck, claims};
use crate::study::reproduce::TableComparison;
use crate::study::resolution::ResolutionFigure;
use crate::study::{FIGURE, Reproduction};
use crate::tables::HELD;
use catchment::report::document::{Style, folded};
use std::fmt;

/// The tables, the figure, a line per table and the omissions if there are several tables, and the coverage.
impl fmt::Display for Reproduction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for table in &self.tables {
            writeln!(f, "{table}")?;
        }
        if let Some(found) = &self.figure {
            write_figure(f, found)?;
        }
        if self.tables.len() > 1 {
            write_summary(f, &self.tables)?;
        }
        write_claims(f, &claims(&self.tables))?;
        self.coverage.as_ref().map_or(Ok(()), |coverage| write!(f, "{coverage}"))
    }
}

fn write_claims(f: &mut fmt::Formatter<'_>, claims: &[Claim]) -> fmt::Result {
    if !claims.is_empty() {
        writeln!(f, "\nWhat the text says of these tables: counted in print, in ours, in the exact ones")?;
    }
    for claim in claims {
        let [printed, ours, exact] = claim.shown();
        let quoted = format!("  {} \"{}\"", claim.section, claim.says);
        writeln!(f, "{}", folded(&quoted, Style::default().columns))?;
        writeln!(f, "    {}: {printed}, {ours}, {exact}", claim.counted)?;
    }
    Ok(())
}

impl Claim {
    /// The results for the printed, our and the exact tables.
    pub(super) fn shown(&self) -> [String; 3] {
        let show = |verdict: Option<ClaimCheck>| match verdict {
            Some(ClaimCheck::Count { holds, of }) => format!("{holds} of {of}"),
            Some(ClaimCheck::Number { value }) => format!("{value:.1}"),
            None => "–".to_owned(),
        };
        [Some(self.printed), self.ours, self.exact].map(show)
    }
}

fn write_figure(f: &mut fmt::Formatter<'_>, found: &ResolutionFigure) -> fmt::Result {
    let [lo, hi] = found.exact_ci95;
    writeln!(f, "Figure {FIGURE}: V-Face, H/D 1/4, COR -1/2: Sum in D·rad (seconds) over the resolution")?;
    writeln!(
        f,
        "exact {:.4}, 95 % interval {lo:.4} … {hi:.4}, ρ = {} D",
        found.exact, found.rotation_length
    )?;
    write!(f, "  {:>4}", "N")?;
    for curve in &found.curves {
        write!(f, "{:>20}", curve.name)?;
    }
    writeln!(f)?;
    for resolution in &found.settings.resolutions {
        write!(f, "  {resolution:>4}")?;
        for curve in &found.curves {
            let point = curve.points.iter().find(|point| point.resolution == *resolution);
            let shown = point.map_or_else(String::new, |p| format!("{:.4} ({:.3} s)", p.sum, p.seconds));
            write!(f, "{shown:>20}")?;
        }
        writeln!(f)?;
    }
    writeln!(
        f,
        "note: no point of the published figure is held; its text says that the area starts larger and slowly\n      \
         decreases, and that the time grows like N²"
    )
}

fn write_summary(f: &mut fmt::Formatter<'_>, tables: &[TableComparison]) -> fmt::Result {
    writeln!(f, "Summary")?;
    writeln!(f, "  table   as printed  matching  median error  mean |ln ratio|  by")?;
    for table in tables {
        let s = &table.summary;
        let of = |n: usize| if s.computed == 0 { "–".to_owned() } else { format!("{n}/{}", s.computed) };
        let percent = |v: Option<f64>| v.map_or_else(|| "–".to_owned(), |v| format!("{:.2} %", 100.0 * v));
        let mean = s.mean_log_ratio.map_or_else(|| "–".to_owned(), |mean| format!("{mean:.3}"));
        writeln!(
            f,
            "  {:<6}  {:>10}  {:>8}  {:>12}  {mean:>15}  {}",
            table.table,
            of(s.as_printed),
            if table.tolerance.is_some() { of(s.matching) } else { "–".to_owned() },
            percent(s.median_error),
            table.method,
        )?;
    }
    writeln!(f, "\nHeld or known, and not computed")?;
    for held in HELD {
        writeln!(f, "  {:<10}  {}: {}", held.name, held.title, held.reason)?;
    }
    Ok(())
}
