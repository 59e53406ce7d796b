//! Datasets of others through the whole ingest, laid out by a script that knows only their documentation
//! (`layouts.py`, `bags.py`): what is right of each comes from there. And what is refused, with which words.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod layouts;
mod refused;
mod trees;
