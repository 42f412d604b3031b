//! STEP files: `OpenCASCADE` converts curved faces into triangles, in the user's own Python.
//!
//! ```text
//!   bytes of part.step ──stdin──▶ python3 -I -c mesh.py ──stdout──▶ corners and triangles of every solid, in mm
//!                                 (OCP: cadquery-ocp-novtk)
//! ```
//!
//! No heavy library is linked, nothing is downloaded and no file is written. The interpreter is isolated and
//! starts in an empty folder; it uses its own packages, those of the user, and those in the absolute entries
//! of `PYTHONPATH`. Every solid is a separate body; in a file without solids, every closed shell. Corners are
//! merged as the topology prescribes, so that a closed shell is a closed mesh. Facets deviate from the faces
//! by at most the `deflection` of the design, or 0.0002 of the part's largest side, as measured by
//! `OpenCASCADE`: a corner lies on the part, a facet inside convex and outside concave surfaces. Neighbouring
//! facets of a face differ by at most 0.5 rad.
//!
//! Coordinates are read in mm, whatever the unit of the file. The same process never meshes a file twice.
//!
//! Not promised: the same triangles from another version of OCP; the digest of the design covers the result.
//! Surfaces without thickness beside solids, and colours, are skipped.

mod child;
mod reply;

use super::mesh::{MeshProblem, most_read};
use super::source::{FileBytes, FileContent, UnitProblem, scale};
use catchment_base::exec::{Exec, Stopwatch};
use catchment_design::design::{FileSpec, FileUnit, LengthUnit, hex};
use sha2::{Digest, Sha256};
use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// The script of the child process.
const SCRIPT: &str = include_str!("mesh.py");
/// How a STEP file begins.
const BEGINNING: &[u8] = b"ISO-10303-21";
/// Time limit, far longer than any part tried: a hanging process is ended.
const MOST_TIME: Duration = Duration::from_mins(10);
/// Files whose triangles are kept.
const MOST_KEPT: usize = 4;

/// Why a STEP file gives no triangles.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StepProblem {
    /// Its first bytes are not those of a STEP file.
    #[error("this is no STEP file, which begins with ISO-10303-21: export it again")]
    NotStep,
    /// No interpreter.
    #[error(
        "a STEP file holds curved faces, which a Python with OpenCASCADE turns into triangles, and `{program}` cannot be started ({message}): install \
         Python, then `python3 -m pip install cadquery-ocp-novtk`; or name an interpreter that has it in the variable {}; or export the part as STL, \
         OBJ, PLY or 3MF from the CAD program, with a chord tolerance of 0.01 mm",
        child::VARIABLE
    )]
    NoPython {
        /// The interpreter.
        program: String,
        /// Message of the system.
        message: String,
    },
    /// An interpreter without the package.
    #[error(
        "a STEP file holds curved faces, which a Python with OpenCASCADE turns into triangles, and `{program}` has none ({message}): \
         `{program} -m pip install cadquery-ocp-novtk`; or name an interpreter that has it in the variable {}; or export the part as STL, OBJ, PLY or \
         3MF from the CAD program, with a chord tolerance of 0.01 mm",
        child::VARIABLE
    )]
    NoPackage {
        /// The interpreter.
        program: String,
        /// Its message.
        message: String,
    },
    /// `OpenCASCADE` does not understand it.
    #[error("cannot be read as STEP: {message}")]
    Unreadable {
        /// Its message.
        message: String,
    },
    /// No solid in it.
    #[error("the file holds no solid ({message}): export the part as a closed solid")]
    NoSolid {
        /// Its content.
        message: String,
    },
    /// More triangles than are read.
    #[error(
        "its curved faces make {count} triangles or more, and a half may have {most}: let `deflection` be larger, as in \"0.05 mm\", or export the \
         mating faces alone"
    )]
    TooMany {
        /// How many there are, as far as is known.
        count: u64,
        /// How many may be read.
        most: usize,
    },
    /// Something is no face that can be meshed.
    #[error("{message}: repair the part in the CAD program, or export it as STL, OBJ, PLY or 3MF")]
    NotMeshed {
        /// Description.
        message: String,
    },
    /// It takes too long.
    #[error(
        "meshing it took longer than {seconds} s: let `deflection` be larger, or export the mating faces alone"
    )]
    TooLong {
        /// The time that it had.
        seconds: u64,
    },
    /// Out of memory.
    #[error(
        "meshing it takes more memory than there is: let `deflection` be larger, or export the mating faces alone"
    )]
    Memory,
    /// The interpreter ended without an answer.
    #[error("`{program}` did not mesh it: {message}")]
    Died {
        /// The interpreter.
        program: String,
        /// How it ended, and its last words.
        message: String,
    },
    /// The computation was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// Result of `OpenCASCADE` for a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FromCurves {
    /// Largest allowed distance between faces and facets, in mm.
    pub(crate) deflection: f64,
    /// Largest distance between faces and facets as it reports, in mm.
    pub(crate) reached: f64,
    /// The mesher.
    pub(crate) by: String,
    /// SHA-256 of the triangles.
    pub(crate) sha256: String,
}

/// Key of a meshing: the file, the deflection in mm, and the triangle limit.
#[derive(Clone, PartialEq)]
struct MeshingRequest {
    sha256: String,
    deflection: f64,
    most_triangles: usize,
}

/// Files that were meshed, the latest last.
static MESHED: Mutex<VecDeque<(MeshingRequest, FileContent)>> = Mutex::new(VecDeque::new());

/// As the table of formats wants it.
pub(super) fn read(file: &FileBytes, spec: &FileSpec, exec: &Exec) -> Result<FileContent, Vec<MeshProblem>> {
    let beginning = file.bytes.trim_ascii_start();
    if !beginning.strip_prefix(b"\xef\xbb\xbf").unwrap_or(beginning).starts_with(BEGINNING) {
        return Err(vec![StepProblem::NotStep.into()]);
    }
    if let FileUnit::Stated(stated) = spec.unit
        && stated != LengthUnit::Mm
    {
        return Err(vec![UnitProblem::NotMm { stated }.into()]);
    }
    let scale = scale(spec, Some(LengthUnit::Mm.metres())).map_err(|problem| vec![problem.into()])?;
    let requested = MeshingRequest {
        sha256: hex(&Sha256::digest(&file.bytes)),
        // 0 leaves it to the size of the part.
        deflection: spec.treatment.deflection.map_or(0.0, |d| d / scale),
        most_triangles: most_read(spec.treatment),
    };
    let kept = || MESHED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, held)) = kept().iter().find(|(known, _)| *known == requested) {
        return Ok(held.clone());
    }
    let held = meshed(&file.bytes, &requested, spec, exec)?;
    let count: usize = held.bodies.iter().map(Vec::len).sum();
    if count <= super::mesh::MAX_TRIANGLES {
        let mut kept = kept();
        kept.push_back((requested, held.clone()));
        if kept.len() > MOST_KEPT {
            kept.pop_front();
        }
    }
    Ok(held)
}

fn meshed(
    bytes: &[u8],
    requested: &MeshingRequest,
    spec: &FileSpec,
    exec: &Exec,
) -> Result<FileContent, Vec<MeshProblem>> {
    let most_bytes = exec.memory_budget();
    let arguments = [
        // Isolated mode: neither environment variables nor the current folder affect imports. The script adds
        // the packages that the user has installed.
        "-I".to_owned(),
        "-c".to_owned(),
        SCRIPT.to_owned(),
        requested.deflection.to_string(),
        requested.most_triangles.to_string(),
        most_bytes.to_string(),
        MOST_TIME.as_secs().to_string(),
    ];
    let most_reply = reply::most_bytes(requested.most_triangles);
    let job =
        child::Job { program: child::interpreter(), arguments: &arguments, most_reply, most_time: MOST_TIME };
    let program = job.program.to_string_lossy().into_owned();
    let watch = Stopwatch::start();
    let answer = child::run(job, bytes.to_vec(), &watch, exec).map_err(|problem| vec![problem.into()])?;
    reply::read(&answer, &program, spec.treatment)
}

/// The triangles of every body in a reply of the interpreter: for tests and the fuzzer, which have no
/// interpreter.
///
/// # Errors
/// The error that the reply contains, or that it is broken.
#[doc(hidden)]
pub fn bodies_of_answer(answer: &[u8]) -> Result<Vec<Vec<[glam::DVec3; 3]>>, Vec<MeshProblem>> {
    let held = reply::read(answer, "python3", catchment_design::design::MeshPreparation::DEFAULT)?;
    Ok(held.bodies.iter().map(|body| body.iter().map(|triangle| triangle.corners).collect()).collect())
}

#[cfg(test)]
mod tests;
