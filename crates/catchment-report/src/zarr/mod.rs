//! One run as a Zarr v3 group that xarray opens with named dimensions and coordinates.
//!
//! ```text
//!   out.zarr/          attributes: catchment (layout version), report (the JSON report)
//!   ├── outcome        u8, 0 none · 1 aligned · 2 jammed · 3 missed · 4 undecided; (yaw, pitch, roll, y, x)
//!   ├── height         f32, z of the COR at first contact in D, NaN without contact; same shape, if known
//!   ├── watershed      u32, number of the watershed before merging; 4294967295 for a dam cell; by flooding methods
//!   ├── watershed_merged   u32, the same after merging
//!   └── x, y, …        f64, centres of the cells, in D and rad
//! ```
//!
//! The grid's first axis runs fastest in memory, so in the row-major order of Zarr its dimensions are
//! reversed. The metadata are consolidated. The same run writes the same bytes except for the report's
//! `timing`.

mod outcomes;
mod read;
// Only builds that draw figures write sweep folders.
#[cfg(feature = "figure")]
mod sweep;

pub use read::{read, read_heights};
#[cfg(feature = "figure")]
pub(super) use sweep::fill as fill_sweep;

use super::schema::Report;
use super::write::{self, WriteError};
use catchment_core::acceptance::{Acceptance, Outcome};
use catchment_core::exec::{Cancelled, Exec, OutOfBudget};
use catchment_core::landscape::{Grid, GridAxis};
use catchment_core::merit::MeritError;
use catchment_core::method::flood::{DAM, Watersheds};
use catchment_core::pose::ErrorUnit;
use catchment_core::terminal::shown;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use zarrs::array::codec::GzipCodec;
use zarrs::array::{Array, ArrayBuilder, ArrayMetadataOptions, DataType, Element, FillValue, data_type};
use zarrs::filesystem::FilesystemStore;

/// Version of the group's layout, its attribute `catchment`.
pub const LAYOUT: u32 = 1;

/// The kind of the folder in its manifest, `.catchment.json`, which readers of Zarr pass over.
pub(super) const KIND: &str = "group";

/// Largest number of cells per chunk: a megabyte or a few, read at once.
const CHUNK_CELLS: usize = 1 << 20;

/// Level of compression: outcomes are long runs, more effort gains nothing.
const COMPRESSION: u32 = 5;

/// Why a group could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum ZarrError {
    /// Its files could not.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The outcomes are not over a grid.
    #[error(transparent)]
    Merit(#[from] MeritError),
    /// The heights do not belong to the grid.
    #[error("{heights} values for {cells} cells")]
    Shape {
        /// Number of heights or labels.
        heights: usize,
        /// Number of cells.
        cells: usize,
    },
    /// The path is not a readable group.
    #[error("cannot read {}: {reason}", shown(path))]
    Content {
        /// The group.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The storage library refused.
    #[error("the Zarr group: {reason}")]
    Storage {
        /// Its message.
        reason: String,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<std::io::Error> for ZarrError {
    fn from(error: std::io::Error) -> Self {
        storage(error)
    }
}

fn storage<E: std::error::Error>(error: E) -> ZarrError {
    ZarrError::Storage { reason: error.to_string() }
}

/// Results of a method for every cell besides its outcome, in the order of the grid's cells.
#[derive(Debug, Clone, Copy, Default)]
pub struct CellLayers<'a> {
    /// z of the COR at first contact, in D; values that are not finite stand for no contact.
    pub heights: Option<&'a [f32]>,
    /// The labels of flooding.
    pub watersheds: Option<&'a Watersheds>,
}

/// Writes a run to the folder `path`, which must not exist or be such a group.
///
/// # Errors
/// See [`ZarrError`]. Nothing is left behind and an older result stays as it was.
pub fn write(
    path: &Path,
    report: &Report,
    acceptance: &Acceptance,
    layers: &CellLayers,
    exec: &Exec,
) -> Result<(), ZarrError> {
    let grid = acceptance.grid().ok_or(MeritError::NotAGrid)?;
    let lengths =
        [layers.heights.map(<[f32]>::len), layers.watersheds.map(|watersheds| watersheds.first.len())];
    if let Some(heights) = lengths.into_iter().flatten().find(|length| *length != grid.len()) {
        return Err(ZarrError::Shape { heights, cells: grid.len() });
    }
    let filled = write::folder(path, KIND, exec, |folder| {
        exec.install(|| fill(folder, report, acceptance, grid, layers, exec))
    });
    filled.map_err(|error| match error {
        // The storage library does not report the path.
        ZarrError::Storage { reason } => WriteError::at(path, std::io::Error::other(reason)).into(),
        error => error,
    })
}

fn fill(
    folder: &Path,
    report: &Report,
    acceptance: &Acceptance,
    grid: &Grid,
    layers: &CellLayers,
    exec: &Exec,
) -> Result<(), ZarrError> {
    let store = Arc::new(FilesystemStore::new(folder).map_err(storage)?);
    let mut arrays = Map::new();
    for axis in &grid.axes {
        arrays.insert(axis.dof.name().to_owned(), coordinate(axis, &store, folder, exec)?);
    }
    let dimensions: Vec<(&str, usize)> = grid.axes.iter().map(|axis| (axis.dof.name(), axis.cells)).collect();
    let attributes = outcome_attributes(acceptance.method);
    let plan =
        Plan { name: "outcome", dimensions: &dimensions, kind: data_type::uint8(), fill: 0u8, folder, exec };
    let code = |cell: usize| acceptance.outcomes[cell] as u8;
    arrays.insert(plan.name.to_owned(), plan.write(&store, attributes, code)?);
    if let Some(heights) = layers.heights {
        let finite = |cell: usize| if heights[cell].is_finite() { heights[cell] } else { f32::NAN };
        let attributes = json!({ "long_name": "z of the centre of rotation at first contact", "units": "D" });
        let plan = Plan {
            name: "height",
            dimensions: &dimensions,
            kind: data_type::float32(),
            fill: f32::NAN,
            folder,
            exec,
        };
        arrays.insert(plan.name.to_owned(), plan.write(&store, attributes, finite)?);
    }
    if let Some(watersheds) = layers.watersheds {
        for (name, words, merged) in [
            ("watershed", "number of the watershed before merging", false),
            ("watershed_merged", "number of the watershed after merging", true),
        ] {
            let label = |cell: usize| {
                let last = if merged { watersheds.merged(cell) } else { Some(watersheds.first[cell]) };
                last.unwrap_or(DAM)
            };
            let attributes = json!({ "long_name": words, "outside": watersheds.outside, "dam": DAM });
            let (kind, fill) = (data_type::uint32(), DAM);
            let plan = Plan { name, dimensions: &dimensions, kind, fill, folder, exec };
            arrays.insert(name.to_owned(), plan.write(&store, attributes, label)?);
        }
    }
    finish(folder, &serde_json::to_value(report).map_err(storage)?, &arrays)
}

/// Writes the group's own metadata, with those of all its arrays.
fn finish(folder: &Path, report: &Value, arrays: &Map<String, Value>) -> Result<(), ZarrError> {
    let root = json!({
        "zarr_format": 3,
        "node_type": "group",
        "attributes": { "catchment": LAYOUT, "title": report["design"]["name"], "report": report },
        "consolidated_metadata": { "kind": "inline", "must_understand": false, "metadata": arrays },
    });
    let text = serde_json::to_string_pretty(&root).map_err(storage)?;
    Ok(write::part(folder, "zarr.json", text.as_bytes())?)
}

/// The centres of the cells of an axis.
fn coordinate(
    axis: &GridAxis,
    store: &Arc<FilesystemStore>,
    folder: &Path,
    exec: &Exec,
) -> Result<Value, ZarrError> {
    let attributes = json!({
        "long_name": long_name(axis),
        "units": units(axis),
        "lower_border": axis.lo,
        "upper_border": axis.hi,
    });
    let name = axis.dof.name();
    let dimensions = &[(name, axis.cells)];
    let plan = Plan { name, dimensions, kind: data_type::float64(), fill: f64::NAN, folder, exec };
    plan.write(store, attributes, |k| axis.center(k))
}

fn outcome_attributes(method: &str) -> Value {
    json!({
        "long_name": format!("outcome by {method}"),
        "flag_values": Outcome::ALL.map(|o| o as u8),
        "flag_meanings": Outcome::ALL.map(Outcome::name).join(" "),
    })
}

fn long_name(axis: &GridAxis) -> String {
    match ErrorUnit::of(axis.dof) {
        ErrorUnit::D => format!("lateral offset of the face centre along {}", axis.dof.name()),
        ErrorUnit::Rad => format!("{} error", axis.dof.name()),
    }
}

const fn units(axis: &GridAxis) -> &'static str {
    match ErrorUnit::of(axis.dof) {
        ErrorUnit::D => "D",
        ErrorUnit::Rad => "rad",
    }
}

/// An array to be written: dimensions with the fastest first, as in a grid.
struct Plan<'a, T> {
    name: &'a str,
    dimensions: &'a [(&'a str, usize)],
    kind: DataType,
    fill: T,
    folder: &'a Path,
    exec: &'a Exec,
}

impl<T: Element + Copy + Send + Sync> Plan<'_, T>
where
    FillValue: From<T>,
{
    /// Stores metadata and the chunks, each made of the `value` of its cells when its turn comes; returns the metadata.
    fn write(
        &self,
        store: &Arc<FilesystemStore>,
        attributes: Value,
        value: impl Fn(usize) -> T + Sync,
    ) -> Result<Value, ZarrError> {
        let shape: Vec<usize> = self.dimensions.iter().rev().map(|(_, cells)| *cells).collect();
        let chunk = chunk_shape(&shape);
        let wide = |shape: &[usize]| shape.iter().map(|n| *n as u64).collect::<Vec<u64>>();
        let codec = GzipCodec::new(COMPRESSION).map_err(storage)?;
        let attributes = match attributes {
            Value::Object(map) => map,
            _ => Map::new(),
        };
        let array: Array<FilesystemStore> =
            ArrayBuilder::new(wide(&shape), wide(&chunk), self.kind.clone(), FillValue::from(self.fill))
                .bytes_to_bytes_codecs(vec![Arc::new(codec)])
                .dimension_names(Some(self.dimensions.iter().rev().map(|(name, _)| *name)))
                .attributes(attributes)
                .build(Arc::clone(store), &format!("/{}", self.name))
                .map_err(storage)?;
        // The library's own name and version would change the bytes with every upgrade.
        let options = ArrayMetadataOptions::default().with_include_zarrs_metadata(false);
        stored(self.folder, || array.store_metadata_opt(&options).map_err(storage))?;
        let grid: Vec<usize> = shape.iter().zip(&chunk).map(|(n, c)| n.div_ceil(*c)).collect();
        let chunks: usize = grid.iter().product();
        self.exec.try_map(chunks, |number| {
            let place = unravel(number, &grid);
            let data = gather(&shape, &chunk, &place, self.fill, &value);
            stored(self.folder, || array.store_chunk(&wide(&place), data).map_err(storage))
        })?;
        serde_json::to_value(array.metadata_opt(&options)).map_err(storage)
    }
}

/// Lets the storage library write, when files may be changed.
fn stored(folder: &Path, put: impl FnOnce() -> Result<(), ZarrError>) -> Result<(), ZarrError> {
    write::permit().step(folder, put)
}

/// Whole rows of the fastest dimensions, as many as fit into a chunk.
fn chunk_shape(shape: &[usize]) -> Vec<usize> {
    let mut chunk = shape.to_vec();
    for k in 0..chunk.len() {
        let others: usize = chunk[k + 1..].iter().product();
        if chunk[k] * others <= CHUNK_CELLS {
            break;
        }
        chunk[k] = (CHUNK_CELLS / others.max(1)).clamp(1, chunk[k]);
    }
    chunk
}

/// Row-major position of a number: the last dimension runs fastest.
fn unravel(mut number: usize, shape: &[usize]) -> Vec<usize> {
    let mut place = vec![0; shape.len()];
    for (k, n) in place.iter_mut().zip(shape).rev() {
        *k = number % n;
        number /= n;
    }
    place
}

/// The values of the cells of a chunk, row-major; beyond the array the fill value.
fn gather<T: Copy>(
    shape: &[usize],
    chunk: &[usize],
    place: &[usize],
    fill: T,
    value: impl Fn(usize) -> T,
) -> Vec<T> {
    let (Some((&length, rows)), Some((&along, others))) = (chunk.split_last(), shape.split_last()) else {
        return vec![value(0)];
    };
    let first = place[place.len() - 1] * length;
    let inside = along.saturating_sub(first).min(length);
    let mut data = Vec::with_capacity(chunk.iter().product());
    for number in 0..rows.iter().product() {
        let row = unravel(number, rows).into_iter().zip(rows).zip(place).map(|((k, c), p)| p * c + k);
        let index = row.zip(others).try_fold(0, |index, (k, n)| (k < *n).then_some(index * n + k));
        if let Some(row) = index {
            let start = row * along + first;
            // Tens of millions of cells, in a crate that is not optimised: there an iterator is a call or two for each.
            let mut cell = start;
            while cell < start + inside {
                data.push(value(cell));
                cell += 1;
            }
        }
        data.resize((number + 1) * length, fill);
    }
    data
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::testing::{blob, design};
    use catchment_core::pose::Dof;

    fn run(folder: &Path, cells: usize) -> (Acceptance, Vec<f32>) {
        let design = design([Dof::X, Dof::Y, Dof::Yaw].into_iter().collect());
        let acceptance = blob(&design, cells);
        let heights: Vec<f32> = (0..acceptance.outcomes.len())
            .map(|i| if i == 7 { f32::NEG_INFINITY } else { i as f32 })
            .collect();
        let report = Report::new(&design, &acceptance, Value::Null, None, &Exec::new()).unwrap();
        let first = (0..acceptance.outcomes.len() as u32).map(|k| if k == 9 { DAM } else { k % 5 }).collect();
        let watersheds = Watersheds { first, into: vec![0, 0, 2, 3, 2], outside: Some(3) };
        let layers = CellLayers { heights: Some(&heights), watersheds: Some(&watersheds) };
        write(folder, &report, &acceptance, &layers, &Exec::new()).unwrap();
        (acceptance, heights)
    }

    fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
        let mut result = Vec::new();
        let mut open = vec![folder.to_owned()];
        while let Some(next) = open.pop() {
            for entry in std::fs::read_dir(next).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    open.push(path);
                } else {
                    let name = path.strip_prefix(folder).unwrap().display().to_string();
                    result.push((name, std::fs::read(&path).unwrap()));
                }
            }
        }
        result.sort();
        result
    }

    #[test]
    fn written_arrays_read_back() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("out.zarr");
        let (acceptance, heights) = run(&path, 6);
        let store = Arc::new(FilesystemStore::new(&path).unwrap());
        let outcome = Array::open(Arc::clone(&store), "/outcome").unwrap();
        let codes: Vec<u8> = outcome.retrieve_array_subset(&outcome.subset_all()).unwrap();
        assert_eq!(codes, acceptance.outcomes.iter().map(|o| *o as u8).collect::<Vec<_>>());
        let height = Array::open(Arc::clone(&store), "/height").unwrap();
        let read: Vec<f32> = height.retrieve_array_subset(&height.subset_all()).unwrap();
        assert!(read[7].is_nan() && read[8] == heights[8]);
        let labels = |name: &str| -> Vec<u32> {
            let array = Array::open(Arc::clone(&store), name).unwrap();
            array.retrieve_array_subset(&array.subset_all()).unwrap()
        };
        let (first, merged) = (labels("/watershed"), labels("/watershed_merged"));
        assert_eq!((&first[5..10], &merged[5..10]), (&[0, 1, 2, 3, DAM][..], &[0, 0, 2, 3, DAM][..]));
        let yaw = Array::open(store, "/yaw").unwrap();
        let centers: Vec<f64> = yaw.retrieve_array_subset(&yaw.subset_all()).unwrap();
        assert_eq!(centers[5], acceptance.grid().unwrap().axes[2].center(5));
        let root: Value = serde_json::from_slice(&std::fs::read(path.join("zarr.json")).unwrap()).unwrap();
        assert_eq!(root["attributes"]["report"]["schema"], crate::SCHEMA);
        let names = &root["consolidated_metadata"]["metadata"]["outcome"]["dimension_names"];
        assert_eq!(*names, json!(["yaw", "y", "x"]));
    }

    #[test]
    fn the_same_run_writes_the_same_bytes_in_place_of_the_old() {
        let home = tempfile::tempdir().unwrap();
        let [a, b] = ["a.zarr", "b.zarr"].map(|n| home.path().join(n));
        run(&a, 5);
        run(&b, 6);
        run(&b, 5);
        assert_eq!(files(&a), files(&b));
    }

    #[test]
    fn another_group_is_not_replaced() {
        let home = tempfile::tempdir().unwrap();
        let text = r#"{"zarr_format":3,"node_type":"group","attributes":{"from":"elsewhere"}}"#;
        std::fs::write(home.path().join("zarr.json"), text).unwrap();
        let design = design([Dof::X].into_iter().collect());
        let acceptance = blob(&design, 4);
        let report = Report::new(&design, &acceptance, Value::Null, None, &Exec::new()).unwrap();
        let refused = write(home.path(), &report, &acceptance, &CellLayers::default(), &Exec::new());
        assert!(matches!(refused, Err(ZarrError::Write(WriteError::NotAResult { .. }))));
        let one = CellLayers { heights: Some(&[0.0]), watersheds: None };
        let short = write(&home.path().join("new.zarr"), &report, &acceptance, &one, &Exec::new());
        assert!(matches!(short, Err(ZarrError::Shape { heights: 1, cells: 4 })));
    }

    #[test]
    fn chunks_cover_the_array_and_are_bounded() {
        assert_eq!(chunk_shape(&[30; 5]), [1, 30, 30, 30, 30]);
        assert_eq!(chunk_shape(&[100, 100]), [100, 100]);
        assert_eq!(chunk_shape(&[3 << 20]), [1 << 20]);
        assert_eq!(chunk_shape(&[64; 5]), [1, 4, 64, 64, 64]);
        // The last chunk of a 3 × 5 array in chunks of 2 × 3: a row and two columns are inside.
        assert_eq!(gather(&[3, 5], &[2, 3], &[1, 1], 99, |cell| cell), [13, 14, 99, 99, 99, 99]);
    }
}
