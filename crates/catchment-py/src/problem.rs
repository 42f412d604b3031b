//! A problem built from the text of a design, with its files on disk or in memory.

use crate::refusal::{Fields, Refusal, fields};
use crate::work::{How, work};
use catchment::design::{ConnectorSpec, FileSpec, HalfSpec, Quantity, SourceText, load, parse_dofs};
use catchment::problem::{Draft, ProblemError};
use catchment::report::figure;
use pyo3::prelude::*;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The text of a design file.
///
/// # Errors
/// `DesignError` if the file cannot be read.
#[pyfunction]
pub(crate) fn read_text(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    load(&path).map_err(|error| Refusal::from(ProblemError::from(error)).raise(py))
}

/// Values that override those of a design, as the options of the command line do.
#[derive(FromPyObject, Clone, Default)]
pub(crate) struct Changes {
    #[pyo3(item)]
    free: Option<String>,
    #[pyo3(item)]
    cor: Option<String>,
    #[pyo3(item)]
    aspect_ratio: Option<f64>,
    #[pyo3(item)]
    rotation_length: Option<String>,
}

impl Changes {
    /// The overridden values: name of the argument, and key of the design file.
    pub(crate) fn keys(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        [
            ("free", "alignment.free", self.free.is_some()),
            ("cor", "alignment.center_of_rotation", self.cor.is_some()),
            ("aspect_ratio", "connector.aspect_ratio", self.aspect_ratio.is_some()),
            ("rotation_length", "alignment.rotation_length", self.rotation_length.is_some()),
        ]
        .into_iter()
        .filter_map(|(name, key, is_given)| is_given.then_some((name, key)))
    }

    /// The draft with these values.
    pub(crate) fn apply(&self, mut draft: Draft) -> Result<Draft, ProblemError> {
        if let Some(free) = &self.free {
            draft = draft.change("free", |design| design.with_free(parse_dofs(free)?))?;
        }
        if let Some(cor) = &self.cor {
            draft = draft.change("cor", |design| design.with_center_of_rotation(cor.parse::<Quantity>()?))?;
        }
        if let Some(ratio) = self.aspect_ratio {
            draft = draft.change("aspect_ratio", |design| design.with_aspect_ratio(ratio))?;
        }
        if let Some(rho) = &self.rotation_length {
            draft = draft
                .change("rotation_length", |design| design.with_rotation_length(rho.parse::<Quantity>()?))?;
        }
        Ok(draft)
    }
}

/// An alignment problem, with its geometry built and its mated pose checked.
#[pyclass(frozen, module = "catchment._catchment")]
pub(crate) struct Problem {
    pub(crate) inner: catchment::problem::Problem,
    pub(crate) source: SourceText,
    pub(crate) changes: Changes,
}

#[pymethods]
impl Problem {
    #[new]
    fn new(
        py: Python<'_>,
        path: PathBuf,
        text: String,
        files: Vec<(PathBuf, Vec<u8>)>,
        changes: Changes,
        how: How,
    ) -> PyResult<Self> {
        let source = SourceText::new(path, text).with_files(files);
        let inner = work(py, &how, |exec| {
            let draft = changes.apply(Draft::read_on(source.clone(), exec)?)?;
            draft.build_on(exec).and_then(catchment::prelude::Problem::checked).map_err(Refusal::of_geometry)
        })?;
        Ok(Self { inner, source, changes })
    }

    /// Name of the design.
    fn name(&self) -> &str {
        &self.inner.design().name
    }

    /// SHA-256 of everything that can change a result.
    fn digest(&self) -> &str {
        self.inner.digest()
    }

    /// The resolved design as JSON: lengths in D, angles in radians.
    fn design(&self, py: Python<'_>) -> PyResult<String> {
        serde_json::to_string(self.inner.design()).map_err(|error| Refusal::from(error).raise(py))
    }

    /// Warnings about the mated pose.
    fn diagnostics(&self) -> Vec<Fields> {
        self.inner.warnings().iter().map(|warning| fields(warning, None)).collect()
    }

    /// Names of the free errors, with the half-widths of the error box, in D and radians.
    fn error_box(&self) -> Vec<(&'static str, f64)> {
        let alignment = self.inner.alignment();
        alignment.free.iter().map(|dof| (dof.name(), alignment.half_range(dof))).collect()
    }

    /// Every source file of the halves: its path relative to the folder of the design, and its content.
    fn files(&self, py: Python<'_>) -> PyResult<Vec<(PathBuf, Vec<u8>)>> {
        let read = |path: &Path| match self.source.files.get(path) {
            Some(bytes) => Ok(bytes.clone()),
            None => std::fs::read(path),
        };
        let folder = self.source.path.parent().unwrap_or_else(|| Path::new(""));
        let from_folder = |path: &Path| path.strip_prefix(folder).unwrap_or(path).to_owned();
        let files = self.paths().into_iter().map(|path| Ok((from_folder(&path), read(&path)?)));
        files.collect::<Result<_, std::io::Error>>().map_err(|error| Refusal::from(error).raise(py))
    }

    /// Both halves, separated in space and mated in section, as SVG and PNG.
    fn picture(&self, py: Python<'_>) -> PyResult<(String, Vec<u8>)> {
        let drawn = py.detach(|| {
            let picture = figure::pair(&self.inner)?;
            let png = picture.png(crate::rendered::PNG_SCALE)?;
            Ok::<_, figure::FigureError>((picture.svg().to_owned(), png))
        });
        drawn.map_err(|error| Refusal::from(error).raise(py))
    }
}

impl Problem {
    /// The source files of the halves.
    fn paths(&self) -> BTreeSet<PathBuf> {
        let ConnectorSpec::Own(own) = &self.inner.design().connector else { return BTreeSet::new() };
        let of = |half: &HalfSpec| -> Vec<PathBuf> {
            let path = |file: &FileSpec| file.path.clone();
            match half {
                HalfSpec::Mesh(file) => vec![path(file)],
                HalfSpec::Parts(parts) => {
                    parts.iter().filter_map(|part| part.shape.file().map(path)).collect()
                }
                HalfSpec::Pieces(_) | HalfSpec::Memory { .. } => Vec::new(),
            }
        };
        [&own.fixed, &own.moving].into_iter().flat_map(of).collect()
    }
}
