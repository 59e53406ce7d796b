//! Latitude, longitude and altitude as metres east, north and up of a first place: WGS 84 through earth-centred
//! coordinates, so that no map projection's scale enters.

/// WGS 84: half the longer axis, metres, and the flattening.
pub(super) const SEMI_MAJOR_M: f64 = 6_378_137.0;
pub(super) const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// A place from which others are measured.
#[derive(Debug, Clone, Copy)]
pub(super) struct Origin {
    latitude_rad: f64,
    longitude_rad: f64,
    centred_m: [f64; 3],
}

impl Origin {
    /// At latitude and longitude in degrees and altitude in metres.
    pub(super) fn new(geodetic: [f64; 3]) -> Self {
        let [latitude, longitude, _] = geodetic;
        Self {
            latitude_rad: latitude.to_radians(),
            longitude_rad: longitude.to_radians(),
            centred_m: earth_centred(geodetic),
        }
    }

    /// Metres east, north and up from here.
    pub(super) fn east_north_up(&self, geodetic: [f64; 3]) -> [f64; 3] {
        let centred = earth_centred(geodetic);
        let [x, y, z] = std::array::from_fn(|i| centred[i] - self.centred_m[i]);
        let (sin_lat, cos_lat) = libm::sincos(self.latitude_rad);
        let (sin_lon, cos_lon) = libm::sincos(self.longitude_rad);
        [
            -sin_lon * x + cos_lon * y,
            -sin_lat * cos_lon * x - sin_lat * sin_lon * y + cos_lat * z,
            cos_lat * cos_lon * x + cos_lat * sin_lon * y + sin_lat * z,
        ]
    }
}

fn earth_centred([latitude_deg, longitude_deg, altitude_m]: [f64; 3]) -> [f64; 3] {
    let (sin_lat, cos_lat) = libm::sincos(latitude_deg.to_radians());
    let (sin_lon, cos_lon) = libm::sincos(longitude_deg.to_radians());
    let eccentricity2 = FLATTENING * (2.0 - FLATTENING);
    let normal = SEMI_MAJOR_M / (1.0 - eccentricity2 * sin_lat * sin_lat).sqrt();
    [
        (normal + altitude_m) * cos_lat * cos_lon,
        (normal + altitude_m) * cos_lat * sin_lon,
        (normal * (1.0 - eccentricity2) + altitude_m) * sin_lat,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_minute_of_latitude_is_a_nautical_mile_and_up_is_up() {
        let origin = Origin::new([45.0, 8.0, 100.0]);
        let [east, north, up] = origin.east_north_up([45.0 + 1.0 / 60.0, 8.0, 100.0]);
        // A minute of the meridian at 45 degrees is 1852.2 m; the earth falls away by its square over twice the radius.
        assert!(east.abs() < 1e-6 && (north - 1852.2).abs() < 0.5 && (up + 0.27).abs() < 0.01, "{east} {north} {up}");
        let [east, north, up] = origin.east_north_up([45.0, 8.0, 103.5]);
        assert!(east.abs() < 1e-6 && north.abs() < 1e-6 && (up - 3.5).abs() < 1e-6);
    }
}
