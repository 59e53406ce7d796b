//! The table of a traversal's chain.

use super::columns::{bools, f64s, i64s, optional_f64s, u32s};
use super::parquet::{from_parquet, to_parquet};
use crate::CatalogError;
use furrow_model::{Se3, Step, StepCovariance, Trajectory};
use polars::prelude::{Column, DataFrame};

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
        earlier_from_later: Se3::IDENTITY,
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
            3 => step.earlier_from_later.translation_m[i / 4],
            column => step.earlier_from_later.rotation[i / 4][column],
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
    let first = format!("cov_{0}_{0}", AXES[0]);
    // Given chains have none, nor have those that old versions wrote.
    let known = table.column(&first).is_ok();
    let covariances: Option<Vec<Vec<Option<f64>>>> =
        known.then(|| covariance_names().map(|name| optional_f64s(&table, &name)).collect()).transpose()?;
    let step = |i: usize| Step {
        from_ns: from[i],
        to_ns: to[i],
        earlier_from_later: Se3 {
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
