//! The cells of a decided grid, or listed poses, as a table for pandas, a spreadsheet or a database.

use super::vtk::ViewError;
use catchment_core::acceptance::Acceptance;
use catchment_core::diagnostic::Advice;
use catchment_core::document::number;
use catchment_core::exec::Exec;
use catchment_core::pose::Dof;
use std::fmt::Write;

/// Bytes of a line, about: seven numbers.
const LINE_BYTES: u64 = 128;

/// Cells between two checks for cancellation.
const AT_ONCE: usize = 1 << 16;

/// A CSV line for every cell: its centre (D, rad), its outcome, and z of the centre of rotation at first
/// contact (D; empty without contact) if the heights are known. The first axis runs fastest. For listed poses
/// a line for each, with all five errors.
///
/// # Errors
/// The table does not fit into memory, or the computation is cancelled.
pub fn cells(acceptance: &Acceptance, heights: Option<&[f32]>, exec: &Exec) -> Result<Vec<u8>, ViewError> {
    let Some(grid) = acceptance.grid() else { return listed(acceptance, exec) };
    exec.ensure_fits("a table of all cells", LINE_BYTES.saturating_mul(grid.len() as u64), |_| {
        vec![Advice::MoreMemory]
    })?;
    let heights = heights.filter(|heights| heights.len() == grid.len());
    let mut head: Vec<&str> = grid.axes.iter().map(|axis| axis.dof.name()).collect();
    head.push("outcome");
    head.extend(heights.map(|_| "height"));
    let mut text = head.join(",") + "\n";
    // Centres are written many times.
    let centres: Vec<Vec<String>> = grid
        .axes
        .iter()
        .map(|axis| (0..axis.cells).map(|k| number(axis.center(k)) + ",").collect())
        .collect();
    for (k, outcome) in acceptance.outcomes.iter().enumerate() {
        if k % AT_ONCE == 0 {
            exec.check()?;
        }
        for (axis, cell) in centres.iter().zip(grid.cell(k)) {
            text.push_str(&axis[cell]);
        }
        text.push_str(outcome.name());
        match heights.map(|heights| heights[k]) {
            // Writing to a String cannot fail.
            Some(height) if height.is_finite() => {
                let _ = write!(text, ",{height}");
            }
            Some(_) => text.push(','),
            None => {}
        }
        text.push('\n');
    }
    Ok(text.into_bytes())
}

/// A line for every listed pose.
fn listed(acceptance: &Acceptance, exec: &Exec) -> Result<Vec<u8>, ViewError> {
    let poses = acceptance.outcomes.len();
    exec.ensure_fits("a table of all poses", LINE_BYTES.saturating_mul(poses as u64), |_| {
        vec![Advice::MoreMemory]
    })?;
    let names = Dof::ALL.map(Dof::name);
    let mut text = names.join(",") + ",outcome\n";
    for (k, outcome) in acceptance.outcomes.iter().enumerate() {
        if k % AT_ONCE == 0 {
            exec.check()?;
        }
        for value in acceptance.domain.pose(k).to_array() {
            text.push_str(&number(value));
            text.push(',');
        }
        text.push_str(outcome.name());
        text.push('\n');
    }
    Ok(text.into_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::testing::{blob, design};
    use catchment_core::acceptance::Domain;

    #[test]
    fn every_cell_has_a_line_that_reads_back() {
        let acceptance = blob(&design([Dof::X, Dof::Yaw].into_iter().collect()), 5);
        let grid = acceptance.grid().unwrap();
        let heights: Vec<f32> =
            (0..25).map(|k| if k == 3 { f32::NEG_INFINITY } else { 0.1 * k as f32 }).collect();
        let table = cells(&acceptance, Some(&heights), &Exec::new()).unwrap();
        let mut reader = csv::Reader::from_reader(&table[..]);
        assert_eq!(reader.headers().unwrap().iter().collect::<Vec<_>>(), ["x", "yaw", "outcome", "height"]);
        let records: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        assert_eq!(records.len(), 25);
        for (k, record) in records.iter().enumerate() {
            let pose = grid.pose(k);
            assert_eq!([pose.x, pose.yaw], [0, 1].map(|c| record[c].parse::<f64>().unwrap()));
            assert_eq!(&record[2], acceptance.outcomes[k].name());
            assert_eq!(record[3].parse().ok(), heights[k].is_finite().then_some(heights[k]));
        }
        let bare = cells(&acceptance, None, &Exec::new()).unwrap();
        assert!(bare.starts_with(b"x,yaw,outcome\n"));
        let small = Exec::new().with_memory_budget(100);
        assert!(matches!(cells(&acceptance, None, &small), Err(ViewError::OutOfBudget(_))));
    }

    #[test]
    fn every_listed_pose_has_a_line() {
        let cells = blob(&design([Dof::X, Dof::Yaw].into_iter().collect()), 3);
        let poses = (0..9).map(|k| cells.domain.pose(k)).collect();
        let listed = Acceptance { domain: Domain::Poses(poses), ..cells.clone() };
        let table = super::cells(&listed, None, &Exec::new()).unwrap();
        let mut reader = csv::Reader::from_reader(&table[..]);
        let head: Vec<String> = reader.headers().unwrap().iter().map(ToOwned::to_owned).collect();
        assert_eq!(head, ["x", "y", "roll", "pitch", "yaw", "outcome"]);
        let records: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        assert_eq!(records.len(), 9);
        for (k, record) in records.iter().enumerate() {
            assert_eq!(record[0].parse::<f64>().unwrap(), cells.domain.pose(k).x);
            assert_eq!(&record[5], cells.outcomes[k].name());
        }
    }
}
