//! Messages of other sensors, collected in Parquet tables of bounded size.

use crate::message::{Imu, NavSatFix, Odometry};
use crate::traversal::error::IngestError;
use furrow_catalog::records::SensorTable;
use furrow_catalog::tables::numbers_to_parquet;
use furrow_catalog::{CatalogError, Staging};
use furrow_model::ObjectId;
use std::collections::BTreeMap;

/// Rows of a table's part: some megabytes.
const PART_ROWS: usize = 65_536;

/// A message as a row of numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SensorRow {
    kind: &'static str,
    columns: &'static [&'static str],
    stamp_ns: i64,
    values: Vec<f64>,
}

const IMU: &[&str] = &[
    "orientation_x",
    "orientation_y",
    "orientation_z",
    "orientation_w",
    "angular_velocity_x_rad_s",
    "angular_velocity_y_rad_s",
    "angular_velocity_z_rad_s",
    "linear_acceleration_x_m_s2",
    "linear_acceleration_y_m_s2",
    "linear_acceleration_z_m_s2",
];
const FIX: &[&str] = &[
    "latitude_deg",
    "longitude_deg",
    "altitude_m",
    "status",
    "covariance_type",
    "east_variance_m2",
    "north_variance_m2",
    "up_variance_m2",
];
const ODOMETRY: &[&str] = &[
    "position_x_m",
    "position_y_m",
    "position_z_m",
    "orientation_x",
    "orientation_y",
    "orientation_z",
    "orientation_w",
    "linear_velocity_x_m_s",
    "linear_velocity_y_m_s",
    "linear_velocity_z_m_s",
    "angular_velocity_x_rad_s",
    "angular_velocity_y_rad_s",
    "angular_velocity_z_rad_s",
];

impl SensorRow {
    /// An inertial measurement.
    pub(crate) fn of_imu(imu: &Imu<'_>) -> Self {
        let values = [&imu.orientation_xyzw[..], &imu.angular_velocity_rad_s, &imu.linear_acceleration_m_s2].concat();
        Self { kind: "imu", columns: IMU, stamp_ns: imu.header.stamp_ns, values }
    }

    /// A satellite fix. The table's variances are NaN where the receiver does not know them.
    pub(crate) fn of_fix(fix: &NavSatFix<'_>) -> Self {
        let known = fix.position_covariance_type != 0;
        let variance = |i: usize| if known { fix.position_covariance_m2[4 * i] } else { f64::NAN };
        let values = vec![
            fix.latitude_deg,
            fix.longitude_deg,
            fix.altitude_m,
            f64::from(fix.status),
            f64::from(fix.position_covariance_type),
            variance(0),
            variance(1),
            variance(2),
        ];
        Self { kind: "nav_sat_fix", columns: FIX, stamp_ns: fix.header.stamp_ns, values }
    }

    /// An inertial measurement of a table, which tells no orientation: turn rates, then accelerations.
    pub(crate) fn imu_of_table(stamp_ns: i64, values: &[f64; 6]) -> Self {
        Self { kind: "imu", columns: IMU, stamp_ns, values: [&[f64::NAN; 4][..], values].concat() }
    }

    /// A fix of a table, which tells no variances: latitude, longitude, altitude.
    pub(crate) fn fix_of_table(stamp_ns: i64, values: &[f64; 3]) -> Self {
        let unknown = [0.0, 0.0, f64::NAN, f64::NAN, f64::NAN];
        Self { kind: "nav_sat_fix", columns: FIX, stamp_ns, values: [&values[..], &unknown].concat() }
    }

    /// A pose from another odometry.
    pub(crate) fn of_odometry(pose: &Odometry<'_>) -> Self {
        let values =
            [&pose.position_m[..], &pose.orientation_xyzw, &pose.linear_velocity_m_s, &pose.angular_velocity_rad_s];
        Self { kind: "odometry", columns: ODOMETRY, stamp_ns: pose.header.stamp_ns, values: values.concat() }
    }
}

/// The tables of one recording, by topic.
#[derive(Debug, Default)]
pub(crate) struct Sensors {
    topics: BTreeMap<String, TopicTable>,
}

#[derive(Debug)]
struct TopicTable {
    kind: &'static str,
    columns: &'static [&'static str],
    stamps: Vec<i64>,
    values: Vec<Vec<f64>>,
    parts: Vec<ObjectId>,
    rows: u64,
}

impl Sensors {
    /// Adds a message.
    pub(crate) fn push(&mut self, topic: String, row: SensorRow, staging: &Staging) -> Result<(), IngestError> {
        let table = self.topics.entry(topic).or_insert_with(|| TopicTable {
            kind: row.kind,
            columns: row.columns,
            stamps: Vec::new(),
            values: vec![Vec::new(); row.columns.len()],
            parts: Vec::new(),
            rows: 0,
        });
        table.stamps.push(row.stamp_ns);
        table.values.iter_mut().zip(row.values).for_each(|(column, value)| column.push(value));
        if table.stamps.len() == PART_ROWS {
            table.write(staging)?;
        }
        Ok(())
    }

    /// The finished tables.
    pub(crate) fn finish(mut self, staging: &Staging) -> Result<Vec<SensorTable>, IngestError> {
        self.topics.values_mut().try_for_each(|table| table.write(staging))?;
        let finished = |(topic, table): (String, TopicTable)| SensorTable {
            topic,
            kind: table.kind.to_owned(),
            rows: table.rows,
            parts: table.parts,
        };
        Ok(self.topics.into_iter().map(finished).collect())
    }
}

impl TopicTable {
    fn write(&mut self, staging: &Staging) -> Result<(), CatalogError> {
        if self.stamps.is_empty() {
            return Ok(());
        }
        self.rows += self.stamps.len() as u64;
        let names: Vec<&str> = self.columns.to_vec();
        let table = numbers_to_parquet(self.kind, &std::mem::take(&mut self.stamps), &names, &self.values)?;
        self.values.iter_mut().for_each(Vec::clear);
        self.parts.push(staging.write(&table)?);
        Ok(())
    }
}
