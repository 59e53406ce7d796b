//! Tables as Parquet bytes, and the stored tables that several stages share. polars, pandas and DuckDB read them without furrow.

use crate::CatalogError;
use furrow_model::{ObjectId, Se3, Step, StepCovariance, Trajectory};
use polars::prelude::*;
use polars_io::SerReader;
use polars_io::parquet::read::ParquetReader;
use polars_io::parquet::write::{ParquetCompression, ParquetWriter};
use std::io::Cursor;

/// A data frame as Parquet bytes; equal frames give equal bytes.
///
/// # Errors
/// [`CatalogError::Table`] naming `what`.
pub fn to_parquet(what: &str, mut table: DataFrame) -> Result<Vec<u8>, CatalogError> {
    let mut bytes = Vec::new();
    ParquetWriter::new(&mut bytes)
        .with_compression(ParquetCompression::Zstd(None))
        .set_parallel(false)
        .finish(&mut table)
        .map_err(CatalogError::table(what))?;
    Ok(bytes)
}

/// Parquet bytes as a data frame.
///
/// # Errors
/// [`CatalogError::Table`] naming `what`.
pub fn from_parquet(what: &str, bytes: Vec<u8>) -> Result<DataFrame, CatalogError> {
    ParquetReader::new(Cursor::new(bytes)).finish().map_err(CatalogError::table(what))
}

/// A column of numbers without gaps.
///
/// # Errors
/// [`CatalogError::Table`] where the column is missing, of another type, or has gaps.
pub fn i64s(table: &DataFrame, name: &str) -> Result<Vec<i64>, CatalogError> {
    let column = table.column(name).and_then(|column| column.i64()).map_err(CatalogError::table(name))?;
    column.iter().collect::<Option<_>>().ok_or_else(|| gap(name))
}

/// A column of numbers without gaps.
///
/// # Errors
/// As [`i64s`].
pub fn f64s(table: &DataFrame, name: &str) -> Result<Vec<f64>, CatalogError> {
    let column = table.column(name).and_then(|column| column.f64()).map_err(CatalogError::table(name))?;
    column.iter().collect::<Option<_>>().ok_or_else(|| gap(name))
}

/// A column of counts without gaps.
///
/// # Errors
/// As [`i64s`].
pub fn u32s(table: &DataFrame, name: &str) -> Result<Vec<u32>, CatalogError> {
    let column = table.column(name).and_then(|column| column.u32()).map_err(CatalogError::table(name))?;
    column.iter().collect::<Option<_>>().ok_or_else(|| gap(name))
}

/// A column of single-precision numbers without gaps.
///
/// # Errors
/// As [`i64s`].
pub fn f32s(table: &DataFrame, name: &str) -> Result<Vec<f32>, CatalogError> {
    let column = table.column(name).and_then(|column| column.f32()).map_err(CatalogError::table(name))?;
    column.iter().collect::<Option<_>>().ok_or_else(|| gap(name))
}

/// A column of counts that may have gaps.
///
/// # Errors
/// [`CatalogError::Table`] where the column is missing or of another type.
pub fn optional_u32s(table: &DataFrame, name: &str) -> Result<Vec<Option<u32>>, CatalogError> {
    let column = table.column(name).and_then(|column| column.u32()).map_err(CatalogError::table(name))?;
    Ok(column.iter().collect())
}

/// A column of numbers that may have gaps.
///
/// # Errors
/// [`CatalogError::Table`] where the column is missing or of another type.
pub fn optional_f64s(table: &DataFrame, name: &str) -> Result<Vec<Option<f64>>, CatalogError> {
    let column = table.column(name).and_then(|column| column.f64()).map_err(CatalogError::table(name))?;
    Ok(column.iter().collect())
}

/// A column of truths without gaps.
///
/// # Errors
/// As [`i64s`].
pub fn bools(table: &DataFrame, name: &str) -> Result<Vec<bool>, CatalogError> {
    let column = table.column(name).and_then(|column| column.bool()).map_err(CatalogError::table(name))?;
    column.iter().collect::<Option<_>>().ok_or_else(|| gap(name))
}

/// A column of object ids without gaps.
///
/// # Errors
/// As [`i64s`], also where a text is no id.
pub fn object_ids(table: &DataFrame, name: &str) -> Result<Vec<ObjectId>, CatalogError> {
    let column = table.column(name).and_then(|column| column.str()).map_err(CatalogError::table(name))?;
    column.iter().map(|text| text.and_then(|text| text.parse().ok())).collect::<Option<_>>().ok_or_else(|| gap(name))
}

fn gap(name: &str) -> CatalogError {
    CatalogError::Table { what: name.to_owned(), reason: "expected a value in every row, found a gap".to_owned() }
}

/// A moment as stored: a stereo pair, or the image of a single camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    /// The left header stamp; the frame's time.
    pub stamp_ns: i64,
    /// The left image as stored.
    pub left: ObjectId,
    /// The right image; `None` where a single camera recorded.
    pub right: Option<RightImage>,
}

/// The right image of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RightImage {
    /// Its header stamp.
    pub stamp_ns: i64,
    /// As stored.
    pub image: ObjectId,
}

/// The table of a traversal's frames; without the columns of right images where a single camera recorded. Frames of both kinds do not mix.
///
/// # Errors
/// [`CatalogError::Table`].
pub fn frames_to_parquet(frames: &[Frame]) -> Result<Vec<u8>, CatalogError> {
    let stamps: Vec<i64> = frames.iter().map(|f| f.stamp_ns).collect();
    let left: Vec<String> = frames.iter().map(|f| f.left.to_string()).collect();
    let rights: Option<Vec<RightImage>> = frames.iter().map(|f| f.right).collect();
    let table = match rights {
        None => df!("stamp_ns" => stamps, "left" => left),
        Some(rights) => df!(
            "stamp_ns" => stamps,
            "right_stamp_ns" => rights.iter().map(|right| right.stamp_ns).collect::<Vec<_>>(),
            "left" => left,
            "right" => rights.iter().map(|right| right.image.to_string()).collect::<Vec<_>>(),
        ),
    };
    to_parquet("frames", table.map_err(CatalogError::table("frames"))?)
}

/// A traversal's frames.
///
/// # Errors
/// [`CatalogError::Table`].
pub fn frames_from_parquet(bytes: Vec<u8>) -> Result<Vec<Frame>, CatalogError> {
    let table = from_parquet("frames", bytes)?;
    let (stamps, left) = (i64s(&table, "stamp_ns")?, object_ids(&table, "left")?);
    let rights: Vec<Option<RightImage>> = if table.column("right").is_ok() {
        let (stamps, images) = (i64s(&table, "right_stamp_ns")?, object_ids(&table, "right")?);
        stamps.into_iter().zip(images).map(|(stamp_ns, image)| Some(RightImage { stamp_ns, image })).collect()
    } else {
        vec![None; table.height()]
    };
    let frames = stamps.into_iter().zip(left).zip(rights);
    Ok(frames.map(|((stamp_ns, left), right)| Frame { stamp_ns, left, right }).collect())
}

/// Names of the twelve numbers of a step's transform, by rows.
const POSE: [&str; 12] = ["r00", "r01", "r02", "tx_m", "r10", "r11", "r12", "ty_m", "r20", "r21", "r22", "tz_m"];

/// What a small motion of a camera consists of, as the columns of its covariance spell it.
const AXES: [&str; 6] = ["rx", "ry", "rz", "tx", "ty", "tz"];

/// The columns of the covariance's upper triangle, by rows: `cov_rx_rx`, `cov_rx_ry`, …
fn covariance_names() -> impl Iterator<Item = String> {
    AXES.iter().enumerate().flat_map(|(i, row)| AXES[i..].iter().map(move |column| format!("cov_{row}_{column}")))
}

fn covariance_at(entries: &[Vec<Option<f64>>], step: usize) -> Option<StepCovariance> {
    let upper: Option<Vec<f64>> = entries.iter().map(|column| column[step]).collect();
    upper?.try_into().ok().map(StepCovariance)
}

/// The chain as a table: a row per frame. The first has no step: identity from itself.
///
/// # Errors
/// [`CatalogError::Table`].
pub fn chain_to_parquet(chain: &Trajectory) -> Result<Vec<u8>, CatalogError> {
    let start = chain.start_ns.map(|stamp_ns| Step {
        from_ns: stamp_ns,
        to_ns: stamp_ns,
        from_to: Se3::IDENTITY,
        matches: 0,
        inliers: 0,
        valid: true,
        covariance: None,
    });
    let rows: Vec<&Step> = start.iter().chain(&chain.steps).collect();
    let mut columns = vec![
        Column::new("from_ns".into(), rows.iter().map(|s| s.from_ns).collect::<Vec<_>>()),
        Column::new("to_ns".into(), rows.iter().map(|s| s.to_ns).collect::<Vec<_>>()),
    ];
    for (i, name) in POSE.iter().enumerate() {
        let value = |step: &Step| match i % 4 {
            3 => step.from_to.translation_m[i / 4],
            column => step.from_to.rotation[i / 4][column],
        };
        columns.push(Column::new((*name).into(), rows.iter().map(|s| value(s)).collect::<Vec<_>>()));
    }
    columns.push(Column::new("matches".into(), rows.iter().map(|s| s.matches).collect::<Vec<_>>()));
    columns.push(Column::new("inliers".into(), rows.iter().map(|s| s.inliers).collect::<Vec<_>>()));
    columns.push(Column::new("valid".into(), rows.iter().map(|s| s.valid).collect::<Vec<_>>()));
    if chain.steps.iter().any(|step| step.covariance.is_some()) {
        for (i, name) in covariance_names().enumerate() {
            let value = |step: &&Step| step.covariance.map(|covariance| covariance.0[i]);
            columns.push(Column::new(name.into(), rows.iter().map(value).collect::<Vec<_>>()));
        }
    }
    to_parquet("chain", DataFrame::new(rows.len(), columns).map_err(CatalogError::table("chain"))?)
}

/// The chain from its table.
///
/// # Errors
/// [`CatalogError::Table`].
pub fn chain_from_parquet(bytes: Vec<u8>) -> Result<Trajectory, CatalogError> {
    let table = from_parquet("chain", bytes)?;
    let (from, to) = (i64s(&table, "from_ns")?, i64s(&table, "to_ns")?);
    let pose = POSE.iter().map(|name| f64s(&table, name)).collect::<Result<Vec<_>, _>>()?;
    let (matches, inliers, valid) = (u32s(&table, "matches")?, u32s(&table, "inliers")?, bools(&table, "valid")?);
    let first = covariance_names().next().unwrap_or_default();
    // Given chains have none, nor have those that old versions wrote.
    let known = table.column(&first).is_ok();
    let covariances: Option<Vec<Vec<Option<f64>>>> =
        known.then(|| covariance_names().map(|name| optional_f64s(&table, &name)).collect()).transpose()?;
    let step = |i: usize| Step {
        from_ns: from[i],
        to_ns: to[i],
        from_to: Se3 {
            rotation: std::array::from_fn(|r| std::array::from_fn(|c| pose[4 * r + c][i])),
            translation_m: std::array::from_fn(|r| pose[4 * r + 3][i]),
        },
        matches: matches[i],
        inliers: inliers[i],
        valid: valid[i],
        covariance: covariances.as_ref().and_then(|entries| covariance_at(entries, i)),
    };
    Ok(Trajectory { start_ns: from.first().copied(), steps: (1..table.height()).map(step).collect() })
}

/// A table of `stamp_ns` and columns of numbers, all of one length.
///
/// # Errors
/// [`CatalogError::Table`].
pub fn numbers_to_parquet(
    what: &str,
    stamps_ns: &[i64],
    names: &[&str],
    values: &[Vec<f64>],
) -> Result<Vec<u8>, CatalogError> {
    let mut columns = vec![Column::new("stamp_ns".into(), stamps_ns)];
    columns.extend(names.iter().zip(values).map(|(name, values)| Column::new((*name).into(), values.as_slice())));
    to_parquet(what, DataFrame::new(stamps_ns.len(), columns).map_err(CatalogError::table(what))?)
}
