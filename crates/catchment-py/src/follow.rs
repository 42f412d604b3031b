//! Motions of single poses and of arrays of poses.

use crate::plan::method;
use crate::problem::Problem;
use crate::refusal::Refusal;
use crate::rendered::Rendered;
use crate::work::{How, work};
use catchment::method::Method;
use catchment::method::descent::{self, Rows};
use catchment::pose::PoseError;
use catchment::poses::{check_rows, parse_pose};
use catchment::report::{TraceReport, figure};
use catchment::run::EndContacts;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

/// Outcome codes, final pose errors, and z of the COR in the final states.
type Ends<'py> = (Bound<'py, PyArray1<u8>>, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>);

/// A contact: the features of the fixed and of the moving half, and the contact point.
type Touching = (String, String, [f64; 3]);

/// The final state of a motion: outcome, pose error, z of the COR, contacts.
type Ended = (&'static str, [f64; 5], Option<f64>, Vec<Touching>);

#[pymethods]
impl Problem {
    /// Parses a pose error; the result is in D and radians.
    fn pose(&self, py: Python<'_>, text: &str) -> PyResult<[f64; 5]> {
        let read = parse_pose(text, self.inner.design());
        read.map(PoseError::to_array)
            .map_err(|diagnostics| Refusal::of_argument("pose", diagnostics).raise(py))
    }

    /// Follows a pose; returns its outcome, and the pose error, z of the COR and contacts of its final state.
    fn follow(
        &self,
        py: Python<'_>,
        pose: [f64; 5],
        name: &str,
        settings: &str,
        how: How,
    ) -> PyResult<Ended> {
        work(py, &how, |exec| {
            check_rows(&[pose], self.inner.design())?;
            let by = method(name, settings)?;
            let (_, ends) = self.inner.follow_by(&by, &[PoseError::from_array(pose)], exec)?;
            let end = ends.first().ok_or_else(|| Refusal::Compute("the pose has no end".to_owned()))?;
            let touching = EndContacts::new(&self.inner, &by).of(end);
            let touching = touching.into_iter().map(|c| (c.fixed, c.moving, c.point_d)).collect();
            Ok((end.outcome.name(), end.error.to_array(), end.height, touching))
        })
    }

    /// Follows every row of an array. Nothing is copied: poses are read in place, and the motions write directly into the three
    /// returned arrays.
    fn follow_many<'py>(
        &self,
        py: Python<'py>,
        poses: PyReadonlyArray2<'py, f64>,
        name: &str,
        settings: &str,
        how: How,
    ) -> PyResult<Ends<'py>> {
        let refused = |message: &str| Refusal::argument("poses", message).raise(py);
        let &[count, 5] = poses.shape() else {
            return Err(refused("an array of shape (n, 5) is wanted: x, y, roll, pitch, yaw of each pose"));
        };
        let numbers = poses.as_slice().map_err(|_| refused("the array is not contiguous"))?;
        let (rows, _) = numbers.as_chunks::<5>();
        let (mut ends, mut heights, mut outcomes) =
            (vec![0.0; numbers.len()], vec![0.0; count], vec![0; count]);
        work(py, &how, |exec| {
            check_rows(rows, self.inner.design())?;
            let by = method(name, settings)?;
            let (into, _) = ends.as_chunks_mut::<5>();
            let into = Rows { poses: rows, ends: into, heights: &mut heights, outcomes: &mut outcomes };
            self.rows(&by, into, exec)
        })?;
        let ends = PyArray1::from_vec(py, ends).reshape([count, 5])?;
        Ok((PyArray1::from_vec(py, outcomes), ends, PyArray1::from_vec(py, heights)))
    }

    /// The trajectory of a pose, from first contact to rest.
    fn trace(&self, py: Python<'_>, pose: [f64; 5], friction: f64, how: How) -> PyResult<Rendered> {
        work(py, &how, |_| {
            let problem = &self.inner;
            check_rows(&[pose], problem.design())?;
            let settings = descent::DescentSettings::with_friction(friction)
                .map_err(|error| Refusal::argument("friction", error))?;
            let error = PoseError::from_array(pose);
            let (path, reason) = problem.trace(&error, &settings);
            let report = TraceReport::new(problem, &settings, error, &path, reason);
            let picture = figure::trajectory(problem.design(), problem.connector(), &path);
            Rendered::of(&report)?.with(picture)
        })
    }
}

impl Problem {
    /// Exact motions write their final states into the rows; the final states of other methods are copied.
    fn rows(&self, by: &Method, rows: Rows<'_>, exec: &catchment::exec::Exec) -> Result<(), Refusal> {
        if by.name() == "descent" {
            return Ok(descent::rests_of_rows(self.inner.pair(), rows, &by.motions(), exec)?);
        }
        let poses: Vec<PoseError> = rows.poses.iter().map(|row| PoseError::from_array(*row)).collect();
        let (_, result) = self.inner.follow_by(by, &poses, exec)?;
        for (((end, height), code), result) in
            rows.ends.iter_mut().zip(rows.heights).zip(rows.outcomes).zip(result)
        {
            (*end, *code) = (result.error.to_array(), result.outcome as u8);
            *height = result.height.unwrap_or(f64::NAN);
        }
        Ok(())
    }
}
