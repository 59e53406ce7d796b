//! Workers on a cluster, who submitted them, and the daemon of their node: whoever is killed.

use crate::support::matrix::Matrix;
use crate::support::recordings::{ingested, ran};
use crate::support::slurm::{Slurm, result};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

#[test]
fn whoever_is_killed_the_same_command_ends_with_the_same_ids() {
    let Some(mut slurm) = Slurm::start() else { return };
    let (store, expected) = (ingested(), &ran().run);
    Matrix::small().write(store.path());
    let worker = format!("worker --store {}", std::fs::canonicalize(store.path()).unwrap().display());
    let kill_workers =
        || Command::new("pkill").args(["-9", "-f", &worker]).status().is_ok_and(|status| status.success());
    let (mut submitters, mut workers) = (0, 0);
    for round in 0..3 {
        let mut submitter = slurm.run(&store, "").into_command();
        let mut submitter = submitter.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        // Until a worker computes; then it, the submitter or the node's daemon dies.
        let began = Instant::now();
        let mut hit = false;
        while !hit && submitter.try_wait().unwrap().is_none() && began.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(150 + 100 * round));
            hit = kill_workers();
        }
        workers += u32::from(hit);
        if round == 1 {
            slurm.kill_node();
            slurm.start_node();
        }
        submitters += u32::from(submitter.try_wait().unwrap().is_none());
        let _ = submitter.kill();
        submitter.wait().unwrap();
        store.assert_intact();
    }
    assert!(submitters >= 1 && workers >= 1, "killed {submitters} submitters and {workers} workers");
    assert_eq!(result(&slurm.run(&store, "--keep-going").json()), result(expected));
}
