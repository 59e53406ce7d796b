//! rosbag2's SQLite files, opened read-only: nothing is ever written beside them. Nothing outside this folder of ingest
//! knows SQL.

mod connection;
mod database;
mod header;
mod messages;

pub(crate) use database::Db3;
pub(crate) use header::MAGIC;
