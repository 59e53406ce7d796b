//! Tables as Parquet bytes, and the stored tables that several stages share. polars, pandas and DuckDB read them
//! without furrow. Nothing here touches a file.

mod chain;
mod columns;
mod frames;
mod parquet;

pub use chain::{chain_from_parquet, chain_to_parquet};
pub use columns::{bools, f32s, f64s, i64s, object_ids, optional_f64s, optional_u32s, u32s};
pub use frames::{Frame, RightImage, frames_from_parquet, frames_to_parquet};
pub use parquet::{from_parquet, numbers_to_parquet, to_parquet};
