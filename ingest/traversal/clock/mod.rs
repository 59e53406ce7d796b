//! Clocks that stamp frames, beside the clock of the recorder: where one is set while it runs, and by how much two
//! cameras' clocks are apart.

mod offset;
mod side;
mod watch;

pub(crate) use offset::{ClockOffset, Offsets};
pub(crate) use side::Verdict;
pub(crate) use watch::ClockWatch;
