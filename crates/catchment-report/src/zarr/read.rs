//! Reads a group: the report and the outcomes, checked against each other. A group is untrusted input: files
//! are read up to a limit, numbers are checked before use, and only layouts that this program writes are
//! accepted.

use super::outcomes::{self, OutcomesError};
use super::{LAYOUT, ZarrError};
use crate::{Report, bounded};
use catchment_core::acceptance::{Acceptance, Domain};
use catchment_core::diagnostic::Advice;
use catchment_core::exec::Exec;
use catchment_core::landscape::{Grid, GridAxis};
use catchment_core::method::REGISTRY;
use serde_json::Value;
use std::path::Path;

/// Bytes of memory that a byte of JSON may take while it is read: `[0,0,…` becomes a value for every two bytes.
const BYTES_PER_BYTE: u64 = 40;

/// Reads a group written by [`write()`](super::write()): its report, and the outcomes over the grid. The heights are left.
///
/// # Errors
/// When it is no such group, of another version, too large for the memory allowed, or its parts do not fit together.
pub fn read(path: &Path, exec: &Exec) -> Result<(Report, Acceptance), ZarrError> {
    let at = |path: &Path, reason: String| ZarrError::Content { path: path.to_owned(), reason };
    let bad = |reason: String| at(path, reason);
    let no_group = |error| bad(format!("it holds no zarr.json ({error}); give a result of `run -o`"));
    let text = bounded::read(&path.join("zarr.json"), bounded::REPORT_BYTES).map_err(no_group)?;
    let needed = BYTES_PER_BYTE * text.len() as u64;
    exec.ensure_fits("the report of a stored result", needed, |_| vec![Advice::MoreMemory])?;
    let mut root: Value =
        serde_json::from_slice(&text).map_err(|error| bad(format!("zarr.json: {error}")))?;
    let foreign = || bad("it was not written by this program".to_owned());
    // A value that is not an object has no attributes.
    let attributes = root.get_mut("attributes").ok_or_else(foreign)?;
    match attributes["catchment"].as_u64() {
        Some(layout) if layout == u64::from(LAYOUT) => {}
        Some(layout) => return Err(bad(format!("its layout is {layout}, this program reads {LAYOUT}"))),
        None => return Err(foreign()),
    }
    let report: Report = serde_json::from_value(attributes["report"].take())
        .map_err(|error| bad(format!("its report cannot be read: {error}")))?;
    drop(root);
    report.check().map_err(|error| bad(format!("its report cannot be: {error}")))?;
    let method = REGISTRY.iter().map(|entry| entry.info.name).find(|name| *name == report.method);
    let method = method.ok_or_else(|| bad(format!("its method `{}` is not known", report.method)))?;
    let axes = report.axes.iter().map(|a| GridAxis { dof: a.axis, lo: a.lo, hi: a.hi, cells: a.cells });
    let grid = Grid { axes: axes.collect() };
    if grid.axes.is_empty() {
        return Err(bad("its report is over no grid".to_owned()));
    }
    let cells = grid.checked_len().ok_or_else(|| bad("it has too many cells".to_owned()))?;
    if cells != report.acceptance.cells {
        let counted = report.acceptance.cells;
        return Err(bad(format!("its axes have {cells} cells, its report counts {counted}")));
    }
    exec.ensure_fits("the outcomes of a stored result", cells as u64, |_| vec![Advice::MoreMemory])?;
    let shape: Vec<usize> = grid.axes.iter().rev().map(|axis| axis.cells).collect();
    let outcomes = outcomes::read(path, &shape, exec).map_err(|refused| match refused {
        OutcomesError::Content(path, reason) => at(&path, reason),
        OutcomesError::Cancelled(cancelled) => cancelled.into(),
    })?;
    let warnings = report.warnings.clone();
    let acceptance = Acceptance { method, domain: Domain::Grid(grid), outcomes, warnings };
    let [aligned, jammed, missed, undecided] = acceptance.counts();
    let counted = report.acceptance.outcomes;
    if [aligned, jammed, missed, undecided]
        != [counted.aligned, counted.jammed, counted.missed, counted.undecided]
    {
        return Err(bad("its outcomes are not those that its report counts".to_owned()));
    }
    Ok((report, acceptance))
}

/// The heights of first contact of a group over the grid of its outcomes, in D, NaN without contact; `None`
/// if they were not stored.
///
/// # Errors
/// The content is not an array over this grid as written by this program, or it does not fit into the
/// permitted memory.
pub fn read_heights(path: &Path, grid: &Grid, exec: &Exec) -> Result<Option<Vec<f32>>, ZarrError> {
    let bytes = (size_of::<f32>() as u64).saturating_mul(grid.len() as u64);
    exec.ensure_fits("the heights of a stored result", bytes, |_| vec![Advice::MoreMemory])?;
    let shape: Vec<usize> = grid.axes.iter().rev().map(|axis| axis.cells).collect();
    outcomes::heights(path, &shape, exec).map_err(|refused| match refused {
        OutcomesError::Content(path, reason) => ZarrError::Content { path, reason },
        OutcomesError::Cancelled(cancelled) => cancelled.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::{CellLayers, write};
    use super::*;
    use crate::schema::testing::{blob, design};
    use catchment_core::pose::Dof;

    #[test]
    fn written_groups_read_back() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("out.zarr");
        let design = design([Dof::X, Dof::Y, Dof::Yaw].into_iter().collect());
        let acceptance = blob(&design, 7);
        let report = Report::new(&design, &acceptance, Value::Null, None, &Exec::new()).unwrap();
        write(&path, &report, &acceptance, &CellLayers::default(), &Exec::new()).unwrap();
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
        assert!(
            message("\"cells\": 7", "\"cells\": 8")
                .contains("its axes have 392 cells, its report counts 343")
        );
        let lacking = message("\"acceptance\"", "\"acceptence\"");
        assert!(lacking.contains("its report cannot be read: missing field `acceptance`"), "{lacking}");
        let newer = message("\"schema\": 4", "\"schema\": 5");
        assert!(newer.contains("written by a newer version of catchment: its schema is 5"), "{newer}");
        assert!(message("\"catchment\": 1,", "").contains("not written by this program"));
        let nowhere = read(home.path(), &Exec::new()).unwrap_err().to_string();
        assert!(nowhere.starts_with("cannot read"), "{nowhere}");
    }

    #[test]
    fn heights_that_were_kept_are_read_to_the_bit() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("out.zarr");
        let design = design([Dof::X, Dof::Yaw].into_iter().collect());
        let acceptance = blob(&design, 7);
        let heights: Vec<f32> =
            (0..49).map(|k| if k == 7 { f32::NEG_INFINITY } else { 0.1 * k as f32 }).collect();
        let report = Report::new(&design, &acceptance, Value::Null, None, &Exec::new()).unwrap();
        let layers = CellLayers { heights: Some(&heights), watersheds: None };
        write(&path, &report, &acceptance, &layers, &Exec::new()).unwrap();
        let grid = acceptance.grid().unwrap();
        let read = read_heights(&path, grid, &Exec::new()).unwrap().unwrap();
        assert!(read.iter().zip(&heights).all(|(a, b)| a == b || (a.is_nan() && b.is_infinite())));
        let chunk = path.join("height/c/0/0");
        std::fs::write(&chunk, packed(&[0; 4 * 49 + 1])).unwrap();
        let stated = read_heights(&path, grid, &Exec::new()).unwrap_err().to_string();
        assert!(stated.contains("unpacks to more than its 49 cells"), "{stated}");
        std::fs::remove_dir_all(path.join("height")).unwrap();
        assert!(read_heights(&path, grid, &Exec::new()).unwrap().is_none());
    }

    /// A group of 7 × 7 cells, and the message after replacing a file of it.
    fn spoilt(file: &str, bytes: &[u8]) -> String {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("out.zarr");
        let design = design([Dof::X, Dof::Yaw].into_iter().collect());
        let acceptance = blob(&design, 7);
        let report = Report::new(&design, &acceptance, Value::Null, None, &Exec::new()).unwrap();
        write(&path, &report, &acceptance, &CellLayers::default(), &Exec::new()).unwrap();
        std::fs::write(path.join(file), bytes).unwrap();
        read(&path, &Exec::new()).unwrap_err().to_string()
    }

    fn packed(bytes: &[u8]) -> Vec<u8> {
        use std::io::Write;
        let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        gzip.write_all(bytes).unwrap();
        gzip.finish().unwrap()
    }

    #[test]
    fn a_chunk_that_unpacks_to_more_than_its_cells_is_refused_at_once() {
        let bomb = packed(&vec![1; 64 << 20]);
        assert!(bomb.len() < 100_000);
        assert!(spoilt("outcome/c/0/0", &bomb).contains("unpacks to more than its 49 cells"));
        assert!(spoilt("outcome/c/0/0", &packed(&[1; 48])).contains("unpacks to 48 of 49 cells"));
        assert!(spoilt("outcome/c/0/0", b"no gzip").contains("it is no gzip stream"));
        assert!(spoilt("outcome/c/0/0", &packed(&[9; 49])).contains("9 is the code of no outcome"));
        assert!(spoilt("outcome/c/0/0", &packed(&[1; 49])).contains("not those that its report counts"));
    }

    #[test]
    fn an_array_that_this_program_would_not_have_written_is_refused() {
        let like = |shape: &str, chunk: &str, kind: &str, codecs: &str| {
            let text = format!(
                r#"{{"zarr_format":3,"node_type":"array","shape":{shape},"data_type":"{kind}","fill_value":0,
                "chunk_grid":{{"name":"regular","configuration":{{"chunk_shape":{chunk}}}}},
                "chunk_key_encoding":{{"name":"default","configuration":{{"separator":"/"}}}},"codecs":{codecs}}}"#
            );
            spoilt("outcome/zarr.json", text.as_bytes())
        };
        let codecs = r#"[{"name":"bytes"},{"name":"gzip"}]"#;
        let huge = like("[7,7]", "[1099511627776,1099511627776]", "uint8", codecs);
        assert!(
            huge.contains("chunk_shape is [1099511627776,1099511627776], this program writes [7,7]"),
            "{huge}"
        );
        assert!(like("[7,9]", "[7,7]", "uint8", codecs).contains("over [7,9] cells, its report says [7, 7]"));
        assert!(like("[7,7]", "[0,0]", "uint8", codecs).contains("chunk_shape is [0,0]"));
        assert!(like("[7,7]", "[7,7]", "float64", codecs).contains("data_type is \"float64\""));
        assert!(like("[7,7]", "[7,7]", "uint8", r#"[{"name":"blosc"}]"#).contains("codecs is [\"blosc\"]"));
        assert!(like("[7,7]", "[7,7]", "uint8", "7").contains("codecs is null"));
        assert!(spoilt("outcome/zarr.json", b"[").contains("outcome/zarr.json: EOF"));
    }
}
