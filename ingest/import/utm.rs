//! Latitude and longitude in the universal transverse Mercator grid, by Krüger's series (as in Karney 2011, "Transverse
//! Mercator with an accuracy of a few nanometers", to the fourth power of n: below a millimetre within a zone).

/// WGS 84: half the longer axis, metres, and the flattening.
const SEMI_MAJOR_M: f64 = 6_378_137.0;
const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// A place in the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Utm {
    /// Metres east, 500 km on the zone's middle meridian.
    pub east_m: f64,
    /// Metres north of the equator; 10000 km are added south of it.
    pub north_m: f64,
    /// The zone, 1 to 60.
    pub zone: u8,
    /// The band of latitude, C to X.
    pub letter: char,
    /// How far the grid's north lies clockwise from true north, radians.
    pub convergence_rad: f64,
}

const SCALE: f64 = 0.9996;
const BANDS: &[u8] = b"CDEFGHJKLMNPQRSTUVWXX";

/// The place of a latitude and longitude in degrees, in the zone of its longitude; `None` where the grid does not
/// reach: beyond 84 degrees north and 80 degrees south. The exceptions of Norway and Svalbard are not made.
pub fn utm_of(latitude_deg: f64, longitude_deg: f64) -> Option<Utm> {
    utm_in_zone(latitude_deg, longitude_deg, None)
}

/// As [`utm_of`], in a zone that is given: a track does not jump where it crosses from one into the next.
pub(super) fn utm_in_zone(latitude_deg: f64, longitude_deg: f64, zone: Option<u8>) -> Option<Utm> {
    if !(-80.0..=84.0).contains(&latitude_deg) || !(-180.0..=180.0).contains(&longitude_deg) {
        return None;
    }
    let zone = zone.unwrap_or((((longitude_deg + 180.0) / 6.0).floor() as u8).min(59) + 1);
    let middle_deg = f64::from(zone) * 6.0 - 183.0;
    let n = FLATTENING / (2.0 - FLATTENING);
    let (n2, n3, n4) = (n * n, n * n * n, n * n * n * n);
    let radius = SEMI_MAJOR_M / (1.0 + n) * (1.0 + n2 / 4.0 + n4 / 64.0);
    let alpha = [
        n / 2.0 - 2.0 / 3.0 * n2 + 5.0 / 16.0 * n3 + 41.0 / 180.0 * n4,
        13.0 / 48.0 * n2 - 3.0 / 5.0 * n3 + 557.0 / 1440.0 * n4,
        61.0 / 240.0 * n3 - 103.0 / 140.0 * n4,
        49_561.0 / 161_280.0 * n4,
    ];
    let eccentricity = (FLATTENING * (2.0 - FLATTENING)).sqrt();
    let sin_lat = libm::sin(latitude_deg.to_radians());
    let t = libm::sinh(libm::atanh(sin_lat) - eccentricity * libm::atanh(eccentricity * sin_lat));
    let (sin_lon, cos_lon) = libm::sincos((longitude_deg - middle_deg).to_radians());
    let xi = libm::atan2(t, cos_lon);
    let eta = libm::asinh(sin_lon / libm::sqrt(t * t + cos_lon * cos_lon));
    let (mut north, mut east) = (xi, eta);
    for (order, alpha) in (1..).zip(alpha) {
        let twice = 2.0 * f64::from(order);
        north += alpha * libm::sin(twice * xi) * libm::cosh(twice * eta);
        east += alpha * libm::cos(twice * xi) * libm::sinh(twice * eta);
    }
    let south_m = if latitude_deg < 0.0 { 10_000_000.0 } else { 0.0 };
    let band = ((latitude_deg + 80.0) / 8.0).floor() as usize;
    Some(Utm {
        east_m: 500_000.0 + SCALE * radius * east,
        north_m: south_m + SCALE * radius * north,
        zone,
        letter: char::from(*BANDS.get(band)?),
        // On the sphere, which is off by a thousandth of it.
        convergence_rad: libm::atan2(sin_lon * sin_lat, cos_lon),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Places whose grid coordinates are published: the CN Tower (Wikipedia's article on the grid), and the middle
    /// meridian at the equator, by definition.
    #[test]
    fn known_places_stand_where_they_are_known_to() {
        for (latitude, longitude, east, north, zone, letter) in
            [(43.642_566_7, -79.387_138_9, 630_084.0, 4_833_438.0, 17, 'T'), (0.0, 3.0, 500_000.0, 0.0, 31, 'N')]
        {
            let found = utm_of(latitude, longitude).unwrap();
            assert!((found.east_m - east).abs() < 1.0 && (found.north_m - north).abs() < 1.0, "{found:?}");
            assert_eq!((found.zone, found.letter), (zone, letter));
        }
        // A small step to true north goes to the left of the grid's north, east of the middle meridian.
        let (here, north) = (utm_of(45.0, 5.0).unwrap(), utm_of(45.0001, 5.0).unwrap());
        let left_rad = libm::atan2(here.east_m - north.east_m, north.north_m - here.north_m);
        assert!(left_rad > 0.02 && (left_rad - here.convergence_rad).abs() < 1e-4, "{left_rad} {here:?}");
        let jump = utm_in_zone(45.0, 6.0, Some(31)).unwrap().east_m - utm_of(45.0, 5.999_999).unwrap().east_m;
        assert!(jump.abs() < 0.1, "{jump}");
        assert_eq!(utm_of(85.0, 0.0), None);
        assert_eq!(utm_of(f64::NAN, 0.0), None);
        assert_eq!(utm_of(-33.0, 180.0).unwrap().zone, 60);
    }
}
