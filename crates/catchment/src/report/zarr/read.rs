//! Reading a group back: the report and the outcomes, checked against each other.

use super::{LAYOUT, ZarrError, storage};
use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::exec::Exec;
use crate::landscape::{Grid, GridAxis};
use crate::method::REGISTRY;
use crate::report::Report;
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;
use zarrs::array::Array;
use zarrs::filesystem::FilesystemStore;

/// Reads a group written by [`write()`](super::write()): its report, and the outcomes over the grid. The heights are left.
///
/// # Errors
/// When it is no such group, of another version, too large for the memory allowed, or its parts do not fit together.
pub fn read(path: &Path, exec: &Exec) -> Result<(Report, Acceptance), ZarrError> {
    let bad = |reason: String| ZarrError::Content { path: path.to_owned(), reason };
    let no_group = |error| bad(format!("it holds no zarr.json ({error}); give a result of `run -o`"));
    let text = std::fs::read_to_string(path.join("zarr.json")).map_err(no_group)?;
    let mut root: Value = serde_json::from_str(&text).map_err(|error| bad(error.to_string()))?;
    let attributes = &mut root["attributes"];
    match attributes["catchment"].as_u64() {
        Some(layout) if layout == u64::from(LAYOUT) => {}
        Some(layout) => return Err(bad(format!("its layout is {layout}, this program reads {LAYOUT}"))),
        None => return Err(bad("it was not written by this program".to_owned())),
    }
    let report: Report = serde_json::from_value(attributes["report"].take())
        .map_err(|error| bad(format!("its report is of another version of this program: {error}")))?;
    let method = REGISTRY.iter().map(|entry| entry.info.name).find(|name| *name == report.method);
    let method = method.ok_or_else(|| bad(format!("its method `{}` is not known", report.method)))?;
    let axes = report.axes.iter().map(|a| GridAxis { dof: a.axis, lo: a.lo, hi: a.hi, cells: a.cells });
    let grid = Grid { axes: axes.collect() };
    let store = Arc::new(FilesystemStore::new(path).map_err(|error| bad(error.to_string()))?);
    let array = Array::open(store, "/outcome").map_err(|error| bad(error.to_string()))?;
    let shape: Vec<u64> = grid.axes.iter().rev().map(|axis| axis.cells as u64).collect();
    if array.shape() != shape {
        return Err(bad(format!(
            "its outcomes are over {:?} cells, its report says {shape:?}",
            array.shape()
        )));
    }
    let cells = grid.checked_len().ok_or_else(|| bad("it has too many cells".to_owned()))?;
    // The codes as they are stored, and the outcomes that they become.
    exec.ensure_fits("the outcomes of a stored result", 2 * cells as u64, |_| {
        "allow more with --memory".to_owned()
    })?;
    exec.check()?;
    let codes: Vec<u8> = array.retrieve_array_subset(&array.subset_all()).map_err(storage)?;
    exec.check()?;
    let outcome = |code: u8| Outcome::ALL.into_iter().find(|outcome| *outcome as u8 == code);
    let outcomes: Option<Vec<Outcome>> = codes.into_iter().map(outcome).collect();
    let outcomes = outcomes.ok_or_else(|| bad("some of its cells have no outcome".to_owned()))?;
    let warnings = report.warnings.iter().map(|doubt| doubt.warning.clone()).collect();
    Ok((report, Acceptance { method, domain: Domain::Grid(grid), outcomes, warnings }))
}

#[cfg(test)]
mod tests {
    use super::super::write;
    use super::*;
    use crate::pose::Dof;
    use crate::report::schema::testing::{blob, design};

    #[test]
    fn what_was_written_is_read() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("out.zarr");
        let design = design([Dof::X, Dof::Y, Dof::Yaw].into_iter().collect());
        let acceptance = blob(&design, 7);
        let report = Report::new(&design, &acceptance, Value::Null, None, &Exec::new()).unwrap();
        write(&path, &report, &acceptance, None, &Exec::new()).unwrap();
        let (read_report, read_acceptance) = read(&path, &Exec::new()).unwrap();
        assert_eq!(read_report, report);
        assert_eq!(
            (&read_acceptance.outcomes, &read_acceptance.domain),
            (&acceptance.outcomes, &acceptance.domain)
        );
        let small = Exec::new().with_memory_budget(100);
        assert!(matches!(read(&path, &small), Err(ZarrError::OutOfBudget(_))));

        let root = path.join("zarr.json");
        let text = std::fs::read_to_string(&root).unwrap();
        let message = |from: &str, to: &str| {
            assert!(text.contains(from), "{from}");
            std::fs::write(&root, text.replacen(from, to, 1)).unwrap();
            read(&path, &Exec::new()).unwrap_err().to_string()
        };
        assert!(
            message("\"catchment\": 1,", "\"catchment\": 9,")
                .contains("its layout is 9, this program reads 1")
        );
        assert!(message("\"method\": \"flood\"", "\"method\": \"guess\"").contains("`guess` is not known"));
        assert!(message("\"cells\": 7", "\"cells\": 8").contains("its outcomes are over [7, 7, 7] cells"));
        assert!(message("\"onaa\"", "\"onna\"").contains("another version"));
        assert!(message("\"catchment\": 1,", "").contains("not written by this program"));
        let nowhere = read(home.path(), &Exec::new()).unwrap_err().to_string();
        assert!(nowhere.starts_with("cannot read"), "{nowhere}");
    }
}
