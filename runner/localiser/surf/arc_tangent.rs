//! The four-quadrant arc tangent as a polynomial, to 0.01 degrees, the same on every machine and fit for vector units.

/// Odd coefficients of the arc tangent on 0 to 1, in degrees; least squares, as in OpenCV's `fastAtan2`.
const COEFFICIENTS: [f32; 4] =
    [0.999_787_87 * DEGREES, -0.325_808_4 * DEGREES, 0.155_578_66 * DEGREES, -0.044_326_555 * DEGREES];
const DEGREES: f32 = 180.0 / std::f32::consts::PI;

/// The angle of (`x`, `y`), 0 to 360 degrees; 0 for the zero vector.
#[inline(always)]
pub(super) fn angle_deg(y: f32, x: f32) -> f32 {
    let (along, across) = (x.abs(), y.abs());
    let slope = along.min(across) / (along.max(across) + f64::EPSILON as f32);
    let square = slope * slope;
    let [c1, c3, c5, c7] = COEFFICIENTS;
    let octant = (((c7 * square + c5) * square + c3) * square + c1) * slope;
    let quadrant = if along >= across { octant } else { 90.0 - octant };
    let half = if x < 0.0 { 180.0 - quadrant } else { quadrant };
    if y < 0.0 { 360.0 - half } else { half }
}

#[cfg(test)]
mod tests {
    use super::angle_deg;

    #[test]
    fn is_within_a_hundredth_of_a_degree_of_the_arc_tangent() {
        for i in 0..3600 {
            let angle = f64::from(i).mul_add(0.1, 0.05).to_radians();
            let found = f64::from(angle_deg(7.0 * angle.sin() as f32, 7.0 * angle.cos() as f32));
            assert!((found - angle.to_degrees()).abs() < 0.012, "{found} {}", angle.to_degrees());
        }
        assert_eq!(angle_deg(0.0, 0.0), 0.0);
    }
}
