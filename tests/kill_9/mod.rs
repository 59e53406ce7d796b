//! kill -9 at any moment: the store opens, the same command ends with the same ids, and nothing is half there.
//! `thesis_script` kills a whole script of commands.

mod cluster;
mod export;
mod generation;
mod ingest;
mod run;
