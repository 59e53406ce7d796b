//! Where the sun stands: NOAA's general solar position calculations (Fourier series of Spencer 1971).

use std::f64::consts::PI;

/// A place on the earth and its clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Degrees north.
    pub latitude_deg: f64,
    /// Degrees east.
    pub longitude_deg: f64,
    /// Local time minus UTC.
    pub zone_hours: f64,
}

/// The direction to the sun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunPosition {
    /// Unit vector to the sun: east, north, up.
    pub east_north_up: [f64; 3],
    /// Above the horizon, degrees.
    pub elevation_deg: f64,
    /// From north over east, degrees in [0, 360).
    pub azimuth_deg: f64,
}

/// The sun over `place` on the day `day_of_year` (1 January is 1) at `hour` of local time.
pub fn sun_position(place: Place, day_of_year: u32, hour: f64) -> SunPosition {
    let gamma = 2.0 * PI / 365.0 * (f64::from(day_of_year) - 1.0 + (hour - 12.0) / 24.0);
    let (c, s) = (|k: f64| libm::cos(k * gamma), |k: f64| libm::sin(k * gamma));
    let equation_of_time_min =
        229.18 * (0.000075 + 0.001868 * c(1.0) - 0.032077 * s(1.0) - 0.014615 * c(2.0) - 0.040849 * s(2.0));
    let declination = 0.006918 - 0.399912 * c(1.0) + 0.070257 * s(1.0) - 0.006758 * c(2.0) + 0.000907 * s(2.0)
        - 0.002697 * c(3.0)
        + 0.00148 * s(3.0);
    let solar_time_min = 60.0 * hour + equation_of_time_min + 4.0 * place.longitude_deg - 60.0 * place.zone_hours;
    let hour_angle = (solar_time_min / 4.0 - 180.0).to_radians();
    let latitude = place.latitude_deg.to_radians();
    let (sin_d, cos_d) = (libm::sin(declination), libm::cos(declination));
    let (sin_l, cos_l) = (libm::sin(latitude), libm::cos(latitude));
    let (sin_h, cos_h) = (libm::sin(hour_angle), libm::cos(hour_angle));
    let east_north_up = [-cos_d * sin_h, cos_l * sin_d - sin_l * cos_d * cos_h, sin_l * sin_d + cos_l * cos_d * cos_h];
    let [e, n, u] = east_north_up;
    SunPosition {
        east_north_up,
        elevation_deg: libm::asin(u.clamp(-1.0, 1.0)).to_degrees(),
        azimuth_deg: libm::atan2(e, n).to_degrees().rem_euclid(360.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SITE: Place = Place { latitude_deg: -33.95, longitude_deg: 18.46, zone_hours: 2.0 };

    #[test]
    fn the_sun_of_15_january_stands_where_it_should() {
        let vectors = [
            (4.5, -14.7, 129.0),
            (6.0, 1.2, 115.0),
            (8.0, 24.8, 100.0),
            (10.0, 49.6, 83.0),
            (12.0, 72.5, 47.0),
            (14.0, 70.8, 307.0),
            (16.0, 47.4, 275.0),
        ];
        for (hour, elevation, azimuth) in vectors {
            let sun = sun_position(SITE, 15, hour);
            assert!((sun.elevation_deg - elevation).abs() < 0.06, "{hour}: {sun:?}");
            assert!((sun.azimuth_deg - azimuth).abs() < 0.6, "{hour}: {sun:?}");
        }
    }

    #[test]
    fn the_direction_has_length_one() {
        for day in [1, 100, 200, 365] {
            let [e, n, u] = sun_position(SITE, day, 9.3).east_north_up;
            assert!((e * e + n * n + u * u - 1.0).abs() < 1e-12);
        }
    }
}
