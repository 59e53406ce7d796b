//! Where the sun stands over a place at a moment: the series of NOAA's solar calculator (Spencer 1971), good to some
//! hundredths of a degree in this century.

use chrono::{DateTime, Datelike, Timelike, Utc};
use std::f64::consts::TAU;

/// The direction to the sun, a unit vector: east, north, up. `stamp_ns` counts from 1970, UTC.
pub(crate) fn sun(latitude_deg: f64, longitude_deg: f64, stamp_ns: i64) -> [f64; 3] {
    let time = DateTime::<Utc>::from_timestamp_nanos(stamp_ns);
    let hour = f64::from(time.num_seconds_from_midnight()) / 3600.0;
    let gamma = TAU / 365.0 * (f64::from(time.ordinal0()) + (hour - 12.0) / 24.0);
    let (c, s) = (|k: f64| libm::cos(k * gamma), |k: f64| libm::sin(k * gamma));
    let equation_min =
        229.18 * (0.000075 + 0.001868 * c(1.0) - 0.032077 * s(1.0) - 0.014615 * c(2.0) - 0.040849 * s(2.0));
    let declination = 0.006918 - 0.399912 * c(1.0) + 0.070257 * s(1.0) - 0.006758 * c(2.0) + 0.000907 * s(2.0)
        - 0.002697 * c(3.0)
        + 0.00148 * s(3.0);
    let hour_angle = ((60.0 * hour + equation_min + 4.0 * longitude_deg) / 4.0 - 180.0).to_radians();
    let latitude = latitude_deg.to_radians();
    let (sin_d, cos_d) = (libm::sin(declination), libm::cos(declination));
    let (sin_l, cos_l) = (libm::sin(latitude), libm::cos(latitude));
    let (sin_h, cos_h) = (libm::sin(hour_angle), libm::cos(hour_angle));
    [-cos_d * sin_h, cos_l * sin_d - sin_l * cos_d * cos_h, sin_l * sin_d + cos_l * cos_d * cos_h]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Elevations and azimuths by NOAA's solar calculator on 15 January 2026 at 33.95 S, 18.46 E, two hours ahead of
    /// UTC.
    #[test]
    fn the_sun_stands_where_the_specification_says() {
        let midnight_s = 1_768_428_000; // 14 January 2026, 22:00 UTC
        for (hour, elevation, azimuth) in [
            (4.5, -14.7, 129.0),
            (6.0, 1.2, 115.0),
            (8.0, 24.8, 100.0),
            (10.0, 49.6, 83.0),
            (12.0, 72.5, 47.0),
            (14.0, 70.8, 307.0),
            (16.0, 47.4, 275.0),
        ] {
            let [e, n, u] = sun(-33.95, 18.46, (midnight_s + (3600.0 * hour) as i64) * 1_000_000_000);
            assert!((e * e + n * n + u * u - 1.0).abs() < 1e-12);
            assert!((u.asin().to_degrees() - elevation).abs() < 0.1, "{hour}");
            assert!((e.atan2(n).to_degrees().rem_euclid(360.0) - azimuth).abs() < 0.7, "{hour}");
        }
    }
}
