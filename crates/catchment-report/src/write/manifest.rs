//! The manifest of a folder: its program, and its exact content.
//!
//! ```text
//!   out/.catchment.json   { "catchment": "0.1.0", "kind": "run", "files": { "report.json": "<SHA-256>", … } }
//! ```
//!
//! It is written last, so a folder without it is incomplete or not ours. Files that are not in the manifest,
//! or differ from it, belong to others. Missing files are ignored.

use super::disk::{Permit, is_exhausted, open_up};
use catchment_core::design::hex;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::{Component, Path, PathBuf};

/// The name of the manifest in its folder.
pub const MANIFEST: &str = ".catchment.json";

/// A larger manifest is not read: at some hundred bytes per file this is more than a hundred thousand files.
const LARGEST: u64 = 32 << 20;

/// Content of a folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct Manifest {
    /// Version of the program that wrote it.
    catchment: String,
    /// Kind of the content, such as `run`.
    pub kind: String,
    /// SHA-256 by path below the folder, with `/` between names.
    files: BTreeMap<String, String>,
}

/// Something in a folder that would be lost with it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ForeignFile {
    /// Its path below the folder.
    pub name: PathBuf,
    /// It was written with the folder, and changed since.
    pub changed: bool,
}

impl Manifest {
    /// Of all that is in a folder.
    pub(super) fn of(folder: &Path, kind: &str) -> io::Result<Self> {
        let mut files = BTreeMap::new();
        for (name, is_folder) in walk(folder)? {
            if !is_folder {
                let word = word(&name).ok_or_else(|| io::Error::other("a name that is not UTF-8"))?;
                files.insert(word, digest(&folder.join(&name))?);
            }
        }
        Ok(Self { catchment: env!("CARGO_PKG_VERSION").to_owned(), kind: kind.to_owned(), files })
    }

    /// The manifest of the folder, if it has a readable one.
    ///
    /// # Errors
    /// The system refuses another open file, so that this cannot be determined.
    pub(super) fn read(folder: &Path) -> io::Result<Option<Self>> {
        let path = folder.join(MANIFEST);
        // Nothing else, such as a pipe, is opened.
        let meta = fs::symlink_metadata(&path).ok().filter(|meta| meta.is_file() && meta.len() <= LARGEST);
        let Some(meta) = meta else { return Ok(None) };
        let mut text = Vec::with_capacity(meta.len() as usize);
        match File::open(&path).and_then(|file| file.take(LARGEST).read_to_end(&mut text)) {
            Err(error) if is_exhausted(&error) => Err(error),
            Err(_) => Ok(None),
            Ok(_) => Ok(Self::parse(&text)),
        }
    }

    fn parse(text: &[u8]) -> Option<Self> {
        let manifest: Self = serde_json::from_slice(text).ok()?;
        // The listed files will be removed one day, so no path may leave the folder.
        let inside =
            |name: &str| Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        manifest.files.keys().all(|name| inside(name)).then_some(manifest)
    }

    pub(super) fn to_json(&self) -> io::Result<Vec<u8>> {
        let mut text = serde_json::to_vec_pretty(self)?;
        text.push(b'\n');
        Ok(text)
    }

    /// The first thing in the folder that is not from here.
    pub(super) fn strange(&self, folder: &Path) -> io::Result<Option<ForeignFile>> {
        let folders: BTreeSet<&Path> =
            self.files.keys().flat_map(|name| Path::new(name).ancestors().skip(1)).collect();
        for (name, is_folder) in walk(folder)? {
            if is_folder {
                if !folders.contains(name.as_path()) {
                    return Ok(Some(ForeignFile { name, changed: false }));
                }
                continue;
            }
            if name == Path::new(MANIFEST) {
                continue;
            }
            let known = word(&name).and_then(|word| self.files.get(&word));
            let changed = known.is_some();
            let there = match digest(&folder.join(&name)) {
                Err(error) if is_exhausted(&error) => return Err(error),
                there => there.ok(),
            };
            if !changed || known != there.as_ref() {
                return Ok(Some(ForeignFile { name, changed }));
            }
        }
        Ok(None)
    }

    /// Whether all that is listed is there and nothing else.
    #[cfg(test)]
    pub(super) fn is_whole(&self, folder: &Path) -> bool {
        let there = |name: &String| folder.join(name).is_file();
        matches!(self.strange(folder), Ok(None)) && self.files.keys().all(there)
    }

    /// Removes the listed files, the manifest and the folder; nothing else, even if it was added a moment
    /// ago.
    pub(super) fn remove(&self, folder: &Path, permit: &Permit) -> io::Result<()> {
        open_up(folder);
        let mut folders = BTreeSet::new();
        for name in self.files.keys() {
            permit.remove_file(&folder.join(name))?;
            folders.extend(Path::new(name).ancestors().skip(1).filter(|name| !name.as_os_str().is_empty()));
        }
        // In reverse order, so that a folder is removed after its content.
        for name in folders.into_iter().rev() {
            permit.remove_dir(&folder.join(name))?;
        }
        permit.remove_file(&folder.join(MANIFEST))?;
        permit.remove_dir(folder)
    }
}

/// The form of a path in the manifest.
fn word(name: &Path) -> Option<String> {
    let words: Option<Vec<&str>> = name.iter().map(|word| word.to_str()).collect();
    words.map(|words| words.join("/"))
}

/// Everything below a folder by its path there, sorted, and whether it is a folder. Links are not followed.
fn walk(folder: &Path) -> io::Result<Vec<(PathBuf, bool)>> {
    let mut result = Vec::new();
    let mut open = vec![PathBuf::new()];
    while let Some(inner) = open.pop() {
        for entry in fs::read_dir(folder.join(&inner))? {
            let entry = entry?;
            let (name, is_folder) = (inner.join(entry.file_name()), entry.file_type()?.is_dir());
            if is_folder {
                open.push(name.clone());
            }
            result.push((name, is_folder));
        }
    }
    result.sort();
    Ok(result)
}

/// SHA-256 of an ordinary file, in hexadecimal digits.
fn digest(path: &Path) -> io::Result<String> {
    /// Read at a time.
    const PIECE: usize = 1 << 16;
    if !fs::symlink_metadata(path)?.is_file() {
        return Err(ErrorKind::InvalidInput.into());
    }
    let mut file = File::open(path)?;
    let mut hash = Sha256::new();
    let mut piece = vec![0; PIECE];
    loop {
        match file.read(&mut piece)? {
            0 => break,
            count => hash.update(&piece[..count]),
        }
    }
    Ok(hex(&hash.finalize()))
}
