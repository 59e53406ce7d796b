//! Satellite fixes: which rows of a receiver are one.

/// Whether a receiver's row tells a place on the globe: it says that it has a fix (`sensor_msgs/NavSatStatus`: 0 and
/// above), in degrees. A receiver without one says NaN, or 0 for both.
pub fn is_satellite_fix(status: f64, latitude_deg: f64, longitude_deg: f64) -> bool {
    status >= 0.0
        && latitude_deg.abs() <= 90.0
        && longitude_deg.abs() <= 180.0
        && (latitude_deg, longitude_deg) != (0.0, 0.0)
}

#[cfg(test)]
mod tests {
    use super::is_satellite_fix;

    #[test]
    fn what_a_receiver_says_without_a_fix_is_none() {
        assert!(
            is_satellite_fix(0.0, -33.9, 18.8)
                && is_satellite_fix(2.0, 0.0, 18.8)
                && is_satellite_fix(1.0, 90.0, -180.0)
        );
        for (status, latitude_deg, longitude_deg) in [
            (-1.0, -33.9, 18.8),
            (0.0, 0.0, 0.0),
            (0.0, f64::NAN, 18.8),
            (0.0, 47.0, f64::INFINITY),
            (0.0, 90.1, 0.0),
            (f64::NAN, 47.0, 8.0),
        ] {
            assert!(!is_satellite_fix(status, latitude_deg, longitude_deg), "{status} {latitude_deg} {longitude_deg}");
        }
    }
}
