//! `furrow browse`: pages that show what the store holds, to this machine alone, and change nothing.

mod access;
mod contents;
mod hostile_names;
mod seen;
mod shown;
