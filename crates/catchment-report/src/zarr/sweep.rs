//! A sweep as a Zarr group: a dimension per axis of the sweep.
//!
//! ```text
//!   sweep.zarr/                     attributes: catchment, report (settings, largest, smallest)
//!   ├── sum, sum_lo, sum_hi         f64, NaN for rejected designs; (axis, axis, …)
//!   ├── fraction, onaa_edge, …      f64
//!   ├── x_minus, x_plus, …          f64, single-axis limits, in D and rad
//!   ├── outcome                     u8, the slice through zero; (axis, …, pitch, x), if all designs have the same error box
//!   └── aspect_ratio, …, x, pitch   f64, the values of the axes (numbers from 0 if they are words: attribute `values`)
//! ```

use super::{Plan, ZarrError, coordinate, finish, outcome_attributes, storage};
use crate::SweepReport;
use crate::write;
use catchment_core::exec::Exec;
use catchment_core::landscape::GridAxis;
use catchment_core::pose::Dof;
use catchment_study::sweep::{Figures, Outline, SweepAxis};
use serde_json::{Map, json};
use std::path::Path;
use std::sync::Arc;
use zarrs::array::data_type;
use zarrs::filesystem::FilesystemStore;

/// Writes the group `sweep.zarr` into a folder that is being filled.
///
/// # Errors
/// Errors of the system or the storage library, or the computation is cancelled.
pub(crate) fn fill(folder: &Path, report: &SweepReport, exec: &Exec) -> Result<(), ZarrError> {
    let folder = &folder.join("sweep.zarr");
    write::permit().step(folder, || std::fs::create_dir_all(folder).map_err(ZarrError::from))?;
    let store = Arc::new(FilesystemStore::new(folder).map_err(storage)?);
    let results = &report.result;
    let (axes, names) = (&results.settings.axes, names(&results.settings.axes));
    let mut arrays = Map::new();
    for (axis, name) in axes.iter().zip(&names) {
        let (values, unit) = axis
            .numbers()
            .unwrap_or_else(|| ((0..axis.values.len()).map(|k| k as f64).collect(), String::new()));
        let attributes = json!({ "long_name": axis.key, "units": unit, "values": axis.values });
        let dimensions = &[(name.as_str(), values.len())];
        let plan = Plan { name, dimensions, kind: data_type::float64(), fill: f64::NAN, folder, exec };
        arrays.insert(name.clone(), plan.write(&store, attributes, |k| values[k])?);
    }
    // The fastest first, as in a grid.
    let designs: Vec<(&str, usize)> =
        names.iter().map(String::as_str).zip(axes.iter().map(|axis| axis.values.len())).rev().collect();
    let figures: Vec<Option<&Figures>> = results.designs.iter().map(|trial| trial.result.figures()).collect();
    for (name, unit, of) in variables(report) {
        let attributes = json!({ "units": unit });
        let plan = Plan {
            name: &name,
            dimensions: &designs,
            kind: data_type::float64(),
            fill: f64::NAN,
            folder,
            exec,
        };
        let value = |k: usize| figures[k].and_then(&of).unwrap_or(f64::NAN);
        arrays.insert(name.clone(), plan.write(&store, attributes, value)?);
    }
    if let Some(outlines) = outlines(&figures) {
        let first = outlines.iter().flatten().next();
        for (k, dof) in first.iter().flat_map(|outline| outline.axes.iter().enumerate()) {
            let (lo, hi, cells) = first.map_or((0.0, 0.0, 0), |o| (o.lo[k], o.hi[k], o.cells[k]));
            let axis = GridAxis { dof: *dof, lo, hi, cells };
            arrays.insert(dof.name().to_owned(), coordinate(&axis, &store, folder, exec)?);
        }
        let mut dimensions: Vec<(&str, usize)> =
            first.iter().flat_map(|o| o.axes.iter().map(|dof| dof.name()).zip(o.cells)).collect();
        dimensions.extend(&designs);
        let cells = first.map_or(1, |o| o.outcomes.len());
        let digit =
            |cell: usize| outlines[cell / cells].map_or(0, |o| o.outcomes.as_bytes()[cell % cells] - b'0');
        let plan = Plan {
            name: "outcome",
            dimensions: &dimensions,
            kind: data_type::uint8(),
            fill: 0u8,
            folder,
            exec,
        };
        let attributes = outcome_attributes(results.settings.run.method.name());
        arrays.insert(plan.name.to_owned(), plan.write(&store, attributes, digit)?);
    }
    // All numbers are arrays; the report contains the rest.
    let head = json!({
        "design": report.design,
        "settings": results.settings,
        "largest": results.largest,
        "smallest": results.smallest,
        "refused": results.designs.iter().filter(|trial| trial.result.figures().is_none()).collect::<Vec<_>>(),
    });
    finish(folder, &head, &arrays)
}

/// The axes as names of dimensions: their last words, or the full path if an error or another axis has that
/// name.
fn names(axes: &[SweepAxis]) -> Vec<String> {
    let taken = |axis: &SweepAxis| {
        let same = |other: &SweepAxis| other.key != axis.key && other.name() == axis.name();
        axis.name().parse::<Dof>().is_ok() || axes.iter().any(same)
    };
    axes.iter()
        .map(|axis| if taken(axis) { axis.key.replace('.', "_") } else { axis.name().to_owned() })
        .collect()
}

type Variable = Box<dyn Fn(&Figures) -> Option<f64> + Sync>;

/// Name, unit and value of every number that designs have.
fn variables(report: &SweepReport) -> Vec<(String, String, Variable)> {
    let mut list: Vec<(String, String, Variable)> = Vec::new();
    let unit = report.unit();
    let mut add = |name: &str, unit: &str, of: Variable| list.push((name.to_owned(), unit.to_owned(), of));
    add("sum", unit, Box::new(|f| Some(f.sum)));
    add("sum_lo", unit, Box::new(|f| f.sum_ci95.map(|[lo, _]| lo)));
    add("sum_hi", unit, Box::new(|f| f.sum_ci95.map(|[_, hi]| hi)));
    add("fraction", "1", Box::new(|f| Some(f.fraction)));
    add("onaa_edge", "1", Box::new(|f| f.onaa_edge));
    add("centered_edge", "1", Box::new(|f| f.centered_edge));
    add("success", "1", Box::new(|f| f.success));
    let first = report.designs.iter().find_map(|trial| trial.result.figures());
    for error in first.into_iter().flat_map(|figures| figures.tolerances.iter().map(|along| along.axis)) {
        let unit = if error.is_rotation() { "rad" } else { "D" };
        let along = move |f: &Figures| f.tolerances.iter().find(|along| along.axis == error).copied();
        add(&format!("{}_minus", error.name()), unit, Box::new(move |f| along(f).map(|a| a.minus)));
        add(&format!("{}_plus", error.name()), unit, Box::new(move |f| along(f).map(|a| a.plus)));
    }
    list
}

/// The slices of all designs, if all slices have the same cells.
fn outlines<'a>(figures: &[Option<&'a Figures>]) -> Option<Vec<Option<&'a Outline>>> {
    let outlines: Vec<Option<&Outline>> =
        figures.iter().map(|f| f.and_then(|f| f.outline.as_ref())).collect();
    let first = outlines.iter().flatten().next()?;
    let same = |o: &&Outline| (o.axes, o.lo, o.hi, o.cells) == (first.axes, first.lo, first.hi, first.cells);
    outlines.iter().flatten().all(same).then_some(outlines)
}
