//! How much memory a run may take.

use bytesize::ByteSize;
use std::fs;

/// Bytes that a run stays within by default: half of what this machine, or this process' share of it,
/// has. Without a bound where the system does not tell.
pub fn usual() -> u64 {
    let total = fs::read_to_string("/proc/meminfo").ok().and_then(|text| total(&text));
    let share = fs::read_to_string("/sys/fs/cgroup/memory.max").ok().and_then(|text| text.trim().parse().ok());
    total.into_iter().chain(share).min().map_or(u64::MAX, |bytes: u64| bytes / 2)
}

/// `MemTotal` of `/proc/meminfo`, bytes.
fn total(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// A size with its unit: `4GB`, `512MB`, `1.5 GiB`.
///
/// # Errors
/// Says what was expected.
pub fn parse_size(text: &str) -> Result<u64, String> {
    let has_unit = text.trim_end().ends_with(|last: char| last.is_ascii_alphabetic());
    let size = text.trim().parse::<ByteSize>().ok().map(|size| size.as_u64());
    let size = size.filter(|bytes| has_unit && (1..u64::MAX).contains(bytes));
    size.ok_or_else(|| format!("'{text}' is no size: expected one as in 4GB, 512MB or 1.5GiB"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_as_users_write_them() {
        assert_eq!(parse_size("4GB"), Ok(4_000_000_000));
        assert_eq!(parse_size(" 512 mb"), Ok(512_000_000));
        assert_eq!(parse_size("1.5GiB"), Ok(1_610_612_736));
        for wrong in ["", "4", "GB", "-1GB", "nanGB", "0MB", "4 tons", "99999999999999GB"] {
            assert!(parse_size(wrong).is_err_and(|error| error.contains("512MB")), "{wrong}");
        }
    }

    #[test]
    fn the_machines_memory_is_found() {
        assert_eq!(total("MemFree: 1 kB\nMemTotal:       16303428 kB\n"), Some(16_694_710_272));
        assert_eq!(total("nothing"), None);
    }
}
