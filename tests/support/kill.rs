//! kill -9 at chosen moments.

use super::command::Furrow;
use std::process::Stdio;
use std::time::Duration;

/// Runs a command and kills it after `delay`; whether it was still running.
pub fn killed_after(command: Furrow, delay: Duration) -> bool {
    let mut child = command.into_command().stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    std::thread::sleep(delay);
    let running = child.try_wait().unwrap().is_none();
    // SIGKILL on Unix: the process gets no chance to tidy up.
    let _ = child.kill();
    child.wait().unwrap();
    running
}

/// Delays that look random and are the same every time, spread over the command's whole length.
pub fn moments(whole: Duration, count: u32) -> impl Iterator<Item = Duration> {
    (0..count).map(move |i| whole.mul_f64((f64::from(i) + f64::from(i * 7919 % 13) / 13.0) / f64::from(count)))
}
