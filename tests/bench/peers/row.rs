//! A measured figure, and how it is measured.

use crate::cpu_time::cpu_ns;
use serde::Serialize;
use std::hint::black_box;
use std::time::Instant;

/// A measured figure beside the peer's.
#[derive(Serialize)]
pub struct Row {
    name: &'static str,
    value: f64,
    unit: &'static str,
    peer: &'static str,
    peer_value: Option<f64>,
    /// Ours over the peer's; below 1 is faster.
    ratio: Option<f64>,
}

/// Makes a row and prints it.
pub fn row(name: &'static str, value: f64, unit: &'static str, peer: &'static str, peer_value: Option<f64>) -> Row {
    let row = Row { name, value, unit, peer, peer_value, ratio: peer_value.map(|peer| value / peer) };
    let beside = row
        .peer_value
        .map_or(String::new(), |value| format!("{peer} {value} {unit}, ratio {:.2}", row.ratio.unwrap_or(0.0)));
    println!("{:<58} {:>10.3} {:<9} {beside}", row.name, row.value, row.unit);
    row
}

/// CPU time of a round in milliseconds: the mean over `rounds`, after one that warms up. What other programs do
/// meanwhile does not count.
pub fn cpu_ms<T>(rounds: usize, mut work: impl FnMut(usize) -> T) -> f64 {
    black_box(work(0));
    let before = cpu_ns();
    (0..rounds).for_each(|round| drop(black_box(work(round))));
    (cpu_ns() - before) as f64 / 1e6 / rounds as f64
}

/// Wall time of a round on two threads in milliseconds: the shortest of `rounds`, which other programs disturbed least.
pub fn wall_ms_on_two<T: Send>(rounds: usize, work: impl Fn() -> T + Sync) -> f64 {
    let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(2).build() else { return f64::NAN };
    let round = || {
        let start = Instant::now();
        black_box(pool.install(&work));
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..rounds).map(|_| round()).fold(f64::INFINITY, f64::min)
}
