//! Says what the machine has.

use lme_mpm::scene::Budget;
use std::fs::read_to_string;
use std::path::Path;

/// A run may take this share of the memory that is there.
const SHARE: f64 = 0.9;

/// Gives the budget of a run on this machine, as far as it tells: of the memory that is free, that
/// which the process's control group leaves, and its limit of addresses, the least. Its work is
/// that of [`Budget::default`], or without a `bound` any.
pub fn budget(bound: bool) -> Budget {
    let standard = Budget::default();
    let work = if bound { standard.work } else { f64::INFINITY };
    let there = [free(), group(), addresses()].into_iter().flatten().reduce(f64::min);
    Budget { memory: there.map_or(standard.memory, |bytes| SHARE * bytes), work }
}

/// Finds the number that follows `name` in a file (as it is written there).
fn number(path: impl AsRef<Path>, name: &str) -> Option<f64> {
    let text = read_to_string(path).ok()?;
    let rest = text.lines().find_map(|line| line.strip_prefix(name))?;
    rest.split_whitespace().next()?.parse().ok()
}

/// Gives the memory that can be had without swapping (bytes).
fn free() -> Option<f64> {
    Some(1024.0 * number("/proc/meminfo", "MemAvailable:")?)
}

/// Gives what the groups of the process leave of their limits (bytes); what they hold of files
/// counts as free.
fn group() -> Option<f64> {
    let groups = read_to_string("/proc/self/cgroup").ok()?;
    let mut least = None;
    for (before, root, limit, usage, of_files) in [
        ("0::", "/sys/fs/cgroup", "memory.max", "memory.current", "inactive_file "),
        (
            "memory:",
            "/sys/fs/cgroup/memory",
            "memory.limit_in_bytes",
            "memory.usage_in_bytes",
            "total_inactive_file ",
        ),
    ] {
        let found = groups.lines().find_map(|line| line.split_once(before));
        let Some((_, own)) = found else { continue };
        // Inside a container the path may be one that is not seen there.
        for folder in Path::new(own.trim_start_matches('/')).ancestors() {
            let folder = Path::new(root).join(folder);
            let left = || {
                let files = number(folder.join("memory.stat"), of_files).unwrap_or(0.0);
                Some(number(folder.join(limit), "")? - number(folder.join(usage), "")? + files)
            };
            least = left().into_iter().chain(least).reduce(f64::min);
        }
    }
    least
}

/// Gives the limit of addresses of this process (bytes).
fn addresses() -> Option<f64> {
    number("/proc/self/limits", "Max address space")
}
