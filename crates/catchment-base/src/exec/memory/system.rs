//! Memory information from Linux, in files.
//!
//! ```text
//!   /proc/meminfo               free memory of the machine
//!   /proc/self/limits, status   the limit of the address space (`ulimit -v`), and its current use
//!   /proc/self/cgroup           control groups of this process; for each and its ancestors:
//!     /sys/fs/cgroup/…            memory.max, memory.current, memory.stat                              (version 2)
//!     /sys/fs/cgroup/memory/…     memory.limit_in_bytes, memory.usage_in_bytes, memory.stat            (version 1)
//! ```
//!
//! File pages that a group has read count as used there, but the kernel frees them on demand: they are
//! subtracted.

use std::path::{Path, PathBuf};

/// Root of the files; tests have their own.
pub(super) const ROOT: &str = "/";

/// Bytes free on the machine.
pub(super) fn free(root: impl AsRef<Path>) -> Option<u64> {
    kib(&text(&root.as_ref().join("proc/meminfo"))?, "MemAvailable:")
}

/// Bytes that the limits on this process leave; `None` without a limit.
pub(super) fn limit(root: impl AsRef<Path>) -> Option<u64> {
    let root = root.as_ref();
    [address_space(root), groups(root)].into_iter().flatten().min()
}

fn text(path: &Path) -> Option<String> {
    std::fs::read_to_string(path).ok()
}

/// The number after a name, if it is in kB.
fn kib(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().trim_end_matches("kB").trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// Remaining address space.
fn address_space(root: &Path) -> Option<u64> {
    let limits = text(&root.join("proc/self/limits"))?;
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    // Without a limit there is a word in the place of the number.
    let limit: u64 = line.split_whitespace().next()?.parse().ok()?;
    let taken = text(&root.join("proc/self/status")).and_then(|status| kib(&status, "VmSize:"));
    Some(limit.saturating_sub(taken.unwrap_or(0)))
}

/// Memory remaining in the control groups: the minimum over those of this process.
fn groups(root: &Path) -> Option<u64> {
    let mounted = root.join("sys/fs/cgroup");
    let groups = text(&root.join("proc/self/cgroup"))?;
    groups
        .lines()
        .filter_map(|line| {
            // Number, controllers, path: `0::/a/b` in version 2, `5:memory:/a/b` in version 1.
            let mut parts = line.splitn(3, ':').skip(1);
            let (controllers, path) = (parts.next()?, parts.next()?);
            let path = path.trim_start_matches('/');
            if controllers.is_empty() {
                least(&mounted, path, &Names::V2)
            } else if controllers.split(',').any(|name| name == "memory") {
                least(&mounted.join("memory"), path, &Names::V1)
            } else {
                None
            }
        })
        .min()
}

/// The files of a group.
struct Names {
    limit: &'static str,
    taken: &'static str,
    /// In `memory.stat`: pages of files that are given up first.
    given_up: &'static str,
}

impl Names {
    const V2: Self = Self { limit: "memory.max", taken: "memory.current", given_up: "inactive_file " };
    const V1: Self = Self {
        limit: "memory.limit_in_bytes",
        taken: "memory.usage_in_bytes",
        given_up: "total_inactive_file ",
    };
}

/// The minimum remaining in a group and its ancestors. In a container the path may belong to the host, and
/// not exist here: then the top group counts.
fn least(top: &Path, path: &str, names: &Names) -> Option<u64> {
    let group: PathBuf = top.join(path);
    group.ancestors().take_while(|above| above.starts_with(top)).filter_map(|above| left(above, names)).min()
}

/// Memory remaining in a group.
fn left(group: &Path, names: &Names) -> Option<u64> {
    /// Value in version 1 for no limit, rounded to pages.
    const NO_LIMIT: u64 = 1 << 62;
    let number = |name: &str| text(&group.join(name))?.trim().parse::<u64>().ok();
    let limit = number(names.limit).filter(|limit| *limit < NO_LIMIT)?;
    let given_up = text(&group.join("memory.stat"))
        .and_then(|stat| stat.lines().find_map(|line| line.strip_prefix(names.given_up)?.trim().parse().ok()))
        .unwrap_or(0);
    Some(limit.saturating_sub(number(names.taken).unwrap_or(0).saturating_sub(given_up)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A system with these file contents.
    fn system(files: &[(&str, &str)]) -> tempfile::TempDir {
        let home = tempfile::tempdir().unwrap();
        for (path, text) in files {
            let path = home.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        home
    }

    #[test]
    fn a_system_without_limits_has_no_limit() {
        let home = system(&[]);
        assert_eq!((free(home.path()), limit(home.path())), (None, None));
        let home = system(&[
            ("proc/meminfo", "MemTotal:  9 kB\nMemAvailable:       7 kB\n"),
            (
                "proc/self/limits",
                "Max address space         unlimited            unlimited            bytes\n",
            ),
            ("proc/self/cgroup", "0::/\n"),
            ("sys/fs/cgroup/memory.max", "max\n"),
        ]);
        assert_eq!((free(home.path()), limit(home.path())), (Some(7 * 1024), None));
    }

    #[test]
    fn the_address_space_limits_the_memory() {
        let limits = ("proc/self/limits", "Limit   Soft  Hard\nMax address space   10240   20480  bytes\n");
        assert_eq!(limit(system(&[limits]).path()), Some(10240));
        let taken = |size| system(&[limits, ("proc/self/status", size)]);
        assert_eq!(limit(taken("Name: a\nVmSize:\t       4 kB\n").path()), Some(6144));
        assert_eq!(limit(taken("VmSize: 99 kB\n").path()), Some(0));
    }

    #[test]
    fn control_groups_of_version_2_limit_the_memory() {
        let home = system(&[
            ("proc/self/cgroup", "0::/a/b\n"),
            ("sys/fs/cgroup/a/memory.max", "1000\n"),
            ("sys/fs/cgroup/a/memory.current", "700\n"),
            ("sys/fs/cgroup/a/memory.stat", "anon 500\ninactive_file 200\n"),
            ("sys/fs/cgroup/a/b/memory.max", "max\n"),
            ("sys/fs/cgroup/a/b/memory.current", "600\n"),
        ]);
        assert_eq!(limit(home.path()), Some(500));
        let inner = home.path().join("sys/fs/cgroup/a/b/memory.max");
        std::fs::write(inner, "650").unwrap();
        assert_eq!(limit(home.path()), Some(50));
    }

    #[test]
    fn control_groups_of_version_1_limit_the_memory() {
        let home = system(&[
            ("proc/self/cgroup", "7:cpu,cpuacct:/x\n5:memory:/docker/not-seen-from-inside\n"),
            ("sys/fs/cgroup/memory/memory.limit_in_bytes", "4000\n"),
            ("sys/fs/cgroup/memory/memory.usage_in_bytes", "1500\n"),
            ("sys/fs/cgroup/memory/memory.stat", "inactive_file 1\ntotal_inactive_file 500\n"),
        ]);
        assert_eq!(limit(home.path()), Some(3000));
        let unlimited = home.path().join("sys/fs/cgroup/memory/memory.limit_in_bytes");
        std::fs::write(unlimited, "9223372036854771712\n").unwrap();
        assert_eq!(limit(home.path()), None);
    }
}
