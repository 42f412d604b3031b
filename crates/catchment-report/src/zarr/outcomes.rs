//! Reads the outcomes and heights of a group: only layouts that this program writes, and never more than the
//! report announces.
//!
//! ```text
//!   outcome/zarr.json   must match the written metadata: u8 (heights: f32) over the report's cells, its chunks, gzip
//!   outcome/c/i/j/…     chunks in sequence: whole rows, so each chunk continues the previous one
//! ```
//!
//! A chunk that unpacks to more than its expected size is rejected at the first excess byte.

use super::{CHUNK_CELLS, chunk_shape, unravel};
use crate::bounded;
use catchment_core::acceptance::Outcome;
use catchment_core::exec::{Cancelled, Exec};
use flate2::bufread::GzDecoder;
use serde_json::{Value, json};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Largest size of an array's metadata, in bytes: those of this program take less than one thousand.
const METADATA_BYTES: u64 = 1 << 20;

/// Largest size of a stored chunk, in bytes: incompressible data grows by five bytes in 64 kB, plus a head
/// and a tail.
const CHUNK_BYTES: u64 = (CHUNK_CELLS + CHUNK_CELLS / 1024 + 1024) as u64;

/// Why there are no outcomes.
pub(super) enum OutcomesError {
    /// The file, and its error.
    Content(PathBuf, String),
    Cancelled(Cancelled),
}

impl From<Cancelled> for OutcomesError {
    fn from(cancelled: Cancelled) -> Self {
        Self::Cancelled(cancelled)
    }
}

/// The outcomes over `shape`, row-major; their number has been compared with the memory allowed.
pub(super) fn read(folder: &Path, shape: &[usize], exec: &Exec) -> Result<Vec<Outcome>, OutcomesError> {
    cells(folder, "outcome", "uint8", shape, exec, |[code]: [u8; 1]| {
        let outcome = Outcome::ALL.into_iter().find(|outcome| *outcome as u8 == code);
        outcome.ok_or_else(|| format!("{code} is the code of no outcome"))
    })
}

/// The heights over `shape`, row-major, in D, NaN without contact; `None` for a group without heights.
pub(super) fn heights(
    folder: &Path,
    shape: &[usize],
    exec: &Exec,
) -> Result<Option<Vec<f32>>, OutcomesError> {
    if !folder.join("height").is_dir() {
        return Ok(None);
    }
    cells(folder, "height", "float32", shape, exec, |bytes: [u8; 4]| Ok(f32::from_le_bytes(bytes))).map(Some)
}

/// An array of numbers of `N` bytes over `shape`, each as `value` makes it.
fn cells<T, const N: usize>(
    folder: &Path,
    name: &str,
    kind: &str,
    shape: &[usize],
    exec: &Exec,
    value: impl Fn([u8; N]) -> Result<T, String>,
) -> Result<Vec<T>, OutcomesError> {
    let folder = folder.join(name);
    check_metadata(&folder.join("zarr.json"), shape, kind)?;
    let chunk = chunk_shape(shape);
    let grid: Vec<usize> = shape.iter().zip(&chunk).map(|(n, c)| n.div_ceil(*c)).collect();
    // The dimension along which the last chunk is partial: chunks have a single row in the dimensions before
    // it, and the whole extent behind it.
    let cut = chunk.iter().zip(shape).rposition(|(c, n)| c < n).unwrap_or_default();
    let row: usize = chunk[cut + 1..].iter().product();
    let cells: usize = chunk.iter().product();
    let mut result = Vec::new();
    let most: usize = shape.iter().product();
    if result.try_reserve_exact(most).is_err() {
        return Err(OutcomesError::Content(folder, format!("there is no memory for its {most} cells")));
    }
    for number in 0..grid.iter().product() {
        exec.check()?;
        let place = unravel(number, &grid);
        let path = place.iter().fold(folder.join("c"), |path, k| path.join(k.to_string()));
        let refused = |reason| OutcomesError::Content(path.clone(), reason);
        let bytes = unpacked(&path, cells, N).map_err(refused)?;
        let inside = (shape[cut] - place[cut] * chunk[cut]).min(chunk[cut]) * row;
        for bytes in bytes.as_chunks().0.iter().take(inside) {
            result.push(value(*bytes).map_err(refused)?);
        }
    }
    Ok(result)
}

/// The bytes of a chunk, `width` of every cell.
fn unpacked(path: &Path, cells: usize, width: usize) -> Result<Vec<u8>, String> {
    let packed = bounded::read(path, CHUNK_BYTES * width as u64).map_err(|error| error.to_string())?;
    let mut bytes = Vec::with_capacity(cells * width);
    let unpacking = GzDecoder::new(&packed[..]).take((cells * width) as u64 + 1).read_to_end(&mut bytes);
    unpacking.map_err(|error| format!("it is no gzip stream: {error}"))?;
    match bytes.len() {
        result if result == cells * width => Ok(bytes),
        result if result > cells * width => Err(format!("it unpacks to more than its {cells} cells")),
        result => Err(format!("it unpacks to {} of {cells} cells", result / width)),
    }
}

/// Refuses an array that this program would not have written over these cells.
fn check_metadata(path: &Path, shape: &[usize], kind: &str) -> Result<(), OutcomesError> {
    let bad = |reason: String| OutcomesError::Content(path.to_owned(), reason);
    let bytes = bounded::read(path, METADATA_BYTES).map_err(|error| bad(error.to_string()))?;
    let result: Value = serde_json::from_slice(&bytes).map_err(|error| bad(error.to_string()))?;
    if result["shape"] != json!(shape) {
        let given = short(&result["shape"]);
        return Err(bad(format!("its outcomes are over {given} cells, its report says {shape:?}")));
    }
    let codecs: Option<Vec<&Value>> =
        result["codecs"].as_array().map(|all| all.iter().map(|c| &c["name"]).collect());
    for (what, given, expected) in [
        ("zarr_format", &result["zarr_format"], json!(3)),
        ("node_type", &result["node_type"], json!("array")),
        ("data_type", &result["data_type"], json!(kind)),
        ("chunk_grid", &result["chunk_grid"]["name"], json!("regular")),
        ("chunk_shape", &result["chunk_grid"]["configuration"]["chunk_shape"], json!(chunk_shape(shape))),
        ("chunk_key_encoding", &result["chunk_key_encoding"]["name"], json!("default")),
        ("separator", &result["chunk_key_encoding"]["configuration"]["separator"], json!("/")),
        ("codecs", &json!(codecs), json!(["bytes", "gzip"])),
        ("storage_transformers", result.get("storage_transformers").unwrap_or(&json!([])), json!([])),
    ] {
        if *given != expected {
            let given = short(given);
            return Err(bad(format!("{what} is {given}, this program writes {expected}")));
        }
    }
    Ok(())
}

/// The short form of a value for a message.
fn short(value: &Value) -> String {
    const SHOWN: usize = 60;
    let text = value.to_string();
    let mut short: String = text.chars().take(SHOWN).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}
