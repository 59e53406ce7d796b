//! The most memory that a process held. Included by the benchmarks with `#[path]`.

use std::process::Child;
use std::time::Duration;

/// Waits for the end of a process; the most memory that it held, as Linux counts it. `None` where it failed.
pub fn peak_mib(child: &mut Child) -> Option<f64> {
    let status = format!("/proc/{}/status", child.id());
    let mut peak_kib = None;
    loop {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        peak_kib = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok()).or(peak_kib);
        if let Some(ended) = child.try_wait().ok()? {
            return peak_kib.filter(|_| ended.success()).map(|kib| kib / 1024.0);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}
