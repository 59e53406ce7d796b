//! A cell of a run as a recording for players: what is in it is what was decided, on the recording's stamps, in types
//! that players know.

mod bytes;
mod messages;
mod placed;
mod python;
mod refused;
mod run;
mod wire;
