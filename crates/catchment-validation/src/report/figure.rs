//! Pictures: published tables in colours, and figure 5.13 recomputed.

use crate::study::reproduce::{ReproducedEntry, TableComparison};
use crate::study::resolution::{self, ResolutionFigure};
use crate::study::{FIGURE, Reproduction};
use catchment::report::figure::draw::layout::Layout;
use catchment::report::figure::{
    Colouring, Curve, CurveChart, CurvePoint, Digits, FigureError, NumberMap, Picture, curves, number_maps,
};

/// Every picture with its file name, without extension.
///
/// # Errors
/// If a table has no entry.
pub fn pictures(result: &Reproduction) -> Result<Vec<(String, Picture)>, FigureError> {
    let mut drawn = Vec::new();
    for table in &result.tables {
        drawn.push((format!("table-{}", table.table), published(table)?));
    }
    drawn.extend(result.figure.as_ref().map(|result| (figure_name(), resolution(result))));
    Ok(drawn)
}

/// File name of the figure, without extension.
pub fn figure_name() -> String {
    format!("figure-{FIGURE}")
}

/// Draws a published table, ours, and the ratio of the two; the first two share a colour scale.
///
/// # Errors
/// If there is no entry.
pub fn published(table: &TableComparison) -> Result<Picture, FigureError> {
    let values = |of: &dyn Fn(&ReproducedEntry) -> Option<f64>| -> Vec<Vec<f64>> {
        let value = |entry: &ReproducedEntry| of(entry).unwrap_or(f64::NAN);
        table.entries.iter().map(|row| row.iter().map(value).collect()).collect()
    };
    let (printed, ours) = (values(&|e| Some(e.published)), values(&|e| e.ours));
    let exact = values(&|e| e.exact.map(|exact| exact.value));
    let all = || printed.iter().chain(&ours).chain(&exact).flatten().copied().filter(|v| v.is_finite());
    let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    if low > high {
        return Err(FigureError::Empty { what: "the table has no entry" });
    }
    let height = Colouring::Sequential([low, high]);
    // A factor of two has the full colour.
    let beside = Colouring::Ratio { full: 2.0 };
    let ratio = |of: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let divided = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| a / b).collect();
        of.iter().zip(&printed).map(divided).collect()
    };
    let (rows, columns) = (&table.rows[..], &table.columns[..]);
    let map = |title, values, colouring| NumberMap {
        marks: Vec::new(),
        title,
        rows,
        columns,
        values,
        digits: Digits::Short,
        colouring,
    };
    let mut maps = vec![map("published", printed.clone(), height)];
    for (name, of, name_of_ratio) in
        [(table.method, &ours, "by the same method / published"), ("exact", &exact, "exact / published")]
    {
        if of.iter().flatten().any(|value| value.is_finite()) {
            maps.push(map(name, of.clone(), height));
            maps.push(map(name_of_ratio, ratio(of), beside));
        }
    }
    let head = Layout::titled(format!("Table {}: {}", table.table, table.title))
        .story(format!("rows: {}  ·  columns: {}", table.row_name, table.column_name))
        .story(format!("values in {}", table.unit));
    let cell = [if columns.len() > 8 { 40.0 } else { 56.0 }, 26.0];
    Ok(number_maps(head, cell, &maps))
}

/// Draws the Sums of every method over N with the exact Sum and its interval, and beside them the computing times.
pub fn resolution(result: &ResolutionFigure) -> Picture {
    let [lo, hi] = result.exact_ci95;
    let story = format!(
        "exact {:.4} D·rad, 95 % interval {lo:.4} … {hi:.4}  ·  the published figure is lost; its text: larger at first, slowly \
         decreasing",
        result.exact
    );
    let of = |y: fn(f64, f64) -> f64| -> Vec<Curve> {
        let curve = |curve: &resolution::MethodCurve| Curve {
            name: curve.name.to_owned(),
            points: curve
                .points
                .iter()
                .map(|p| CurvePoint { x: p.resolution as f64, y: y(p.sum, p.seconds), interval: None })
                .collect(),
            is_reference: false,
        };
        result.curves.iter().map(curve).collect()
    };
    let mut sums = of(|sum, _| sum);
    let ends = result.settings.resolutions.first().into_iter().chain(result.settings.resolutions.last());
    let exact = |n: &usize| CurvePoint { x: *n as f64, y: result.exact, interval: Some(result.exact_ci95) };
    sums.push(Curve { name: "exact".to_owned(), points: ends.map(exact).collect(), is_reference: true });
    let seconds = of(|_, seconds| seconds.max(1e-6).log10());
    let chart = |y_label, curves| CurveChart { x_label: "samples or cells per axis", y_label, curves };
    curves(
        &format!("Figure {FIGURE}: V-Face, H/D 1/4, COR −1/2"),
        &story,
        &[chart("Sum [D·rad]", sums), chart("log₁₀ of seconds", seconds)],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::resolution::{MethodCurve, MethodPoint, ResolutionStudySettings};

    #[test]
    fn every_method_is_drawn_in_both_charts_and_the_exact_value_in_one() {
        let settings =
            ResolutionStudySettings { resolutions: vec![25, 50, 100], ..ResolutionStudySettings::default() };
        let curve = |name: &'static str, off: f64| MethodCurve {
            name,
            points: settings
                .resolutions
                .iter()
                .map(|n| MethodPoint {
                    resolution: *n,
                    sum: 0.5 + off / *n as f64,
                    seconds: 1e-6 * (n * n) as f64,
                })
                .collect(),
        };
        let curves = vec![curve("dissertation's", 3.0), curve("transport", 1.0), curve("descent", -1.0)];
        let result =
            ResolutionFigure { exact: 0.5, exact_ci95: [0.49, 0.51], rotation_length: 0.5, curves, settings };
        let picture = resolution(&result);
        assert!(picture.png(1.0).unwrap().starts_with(b"\x89PNG"));
        assert_eq!(picture.svg().matches("<circle").count(), 2 * 9 + 2);
        assert!(!picture.svg().contains("NaN"));
    }
}
