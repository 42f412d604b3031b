//! Finished designs in a temporary folder beside the result, until the result is complete.

use crate::write;
use catchment_study::sweep::{DesignResult, DesignStore};
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Suffix of the result's name.
const ENDING: &str = ".parts";
/// Digits of a key.
const DIGITS: usize = 64;
/// Largest file that is read back.
const LARGEST: u64 = 64 << 20;

/// `OUT.parts`, which holds a JSON file per finished design, named by the digest of all its inputs. An
/// unreadable file counts as missing: the design is computed again.
#[derive(Debug, Clone)]
pub struct FinishedDesigns {
    folder: PathBuf,
}

impl FinishedDesigns {
    /// The parts of a result.
    pub fn beside(result: &Path) -> Self {
        let mut name = result.file_name().unwrap_or_default().to_owned();
        name.push(ENDING);
        Self { folder: result.with_file_name(name) }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn file(&self, key: &str) -> PathBuf {
        self.folder.join(format!("{key}.json"))
    }

    /// How many designs are kept.
    pub fn count(&self) -> usize {
        self.places().iter().filter(|place| place.exists()).count()
    }

    /// Folders in which designs are stored, or were to be stored by a killed process.
    fn places(&self) -> BTreeSet<PathBuf> {
        let Ok(entries) = fs::read_dir(&self.folder) else { return BTreeSet::new() };
        let place = |name: &str| {
            let (key, _) = name.strip_prefix('.').unwrap_or(name).split_once(".json")?;
            let is_key = key.len() == DIGITS && key.bytes().all(|b| b.is_ascii_hexdigit());
            is_key.then(|| self.file(key))
        };
        entries.filter_map(|entry| place(entry.ok()?.file_name().to_str()?)).collect()
    }

    /// Removes them, with the remains of killed processes, and the folder if it is then empty.
    pub fn clear(&self) {
        for place in self.places() {
            // Kept for the next time if it cannot be removed.
            let _ = fs::remove_file(&place);
            let _ = write::sweep(&place);
        }
        let _ = fs::remove_dir(&self.folder);
    }
}

impl DesignStore for FinishedDesigns {
    fn find(&self, key: &str) -> Option<DesignResult> {
        let path = self.file(key);
        let small = fs::metadata(&path).is_ok_and(|of| of.is_file() && of.len() <= LARGEST);
        small.then(|| serde_json::from_slice(&fs::read(path).ok()?).ok())?
    }

    fn keep(&self, key: &str, found: &DesignResult) -> io::Result<()> {
        fs::create_dir_all(&self.folder)?;
        let text = serde_json::to_vec(found)?;
        write::file(&self.file(key), &text, true).map_err(io::Error::other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::faults::{self, Fault};

    #[test]
    fn stored_designs_are_read_and_corrupt_ones_are_ignored() {
        let home = tempfile::tempdir().unwrap();
        let parts = FinishedDesigns::beside(&home.path().join("out"));
        let (key, found) = ("a".repeat(DIGITS), DesignResult::Refused("no".to_owned()));
        assert_eq!(parts.find(&key), None);
        parts.keep(&key, &found).unwrap();
        assert_eq!((parts.find(&key), parts.count()), (Some(found), 1));
        fs::write(parts.file(&key), "{\"figures\":").unwrap();
        assert_eq!(parts.find(&key), None);
        fs::write(parts.folder().join("mine.txt"), "mine").unwrap();
        parts.clear();
        assert_eq!(fs::read_dir(parts.folder()).unwrap().count(), 1, "what is not ours stays");
        fs::remove_file(parts.folder().join("mine.txt")).unwrap();
        parts.clear();
        assert!(!parts.folder().exists());
    }

    #[test]
    fn leftovers_of_a_killed_process_are_cleared() {
        let home = tempfile::tempdir().unwrap();
        let parts = FinishedDesigns::beside(&home.path().join("out"));
        let (key, found) = ("b".repeat(DIGITS), DesignResult::Refused("no".to_owned()));
        for after in 0.. {
            faults::set(home.path(), Fault::Crash, after, true);
            let kept = parts.keep(&key, &found).is_ok();
            if !faults::clear(home.path()) {
                assert!(kept && after > 3);
                break;
            }
            parts.clear();
            assert!(!parts.folder().exists(), "dead after {after} steps");
        }
    }
}
