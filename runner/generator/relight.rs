//! The optional `relight` stage (Lambert): surfaces that face the target's sun brighten, those that turn away from it
//! darken.
//!
//! Where a surface faces comes from the parent's stereo pair: planes are fitted to its disparities. What falls on it is
//! the light of the sky, the same for all, and of the sun, by the angle; level ground is taken as the measure in both
//! lights, since exposure levels the rest and the flow itself carries the means. A surface that the pair does not tell
//! stays as it is.

use crate::GenerateError;
use crate::cells::between;
use crate::planes::Planes;
use crate::stereo::Disparities;
use furrow_model::{GreyImage, StereoRig};
use nalgebra::{Matrix3, Vector3};

/// Columns and rows of the field: about 16 pixels each of an image 640 wide.
const GRID: [usize; 2] = [40, 22];
/// A plane is fitted to so many disparities each way, so many small pixels apart.
const SAMPLES: isize = 3;
const STEP: isize = 3;
/// The least number of samples with a known factor.
const LEAST_SAMPLES: f64 = 16.0;
/// How much a disparity errs at the least, in small pixels: errors of neighbours in one window are alike, and count
/// little on their own.
const LEAST_ERROR_PX: f64 = 0.25;
/// The factor by which a surface changes is held between 1/2 and 2.
const MOST: f64 = std::f64::consts::LN_2;
/// The nearest that a surface may be, in metres: what disparities are looked for.
const NEAREST_M: f64 = 0.8;
/// A clear sky's light on any surface, as a share of what the sun sends through clear air where it stands overhead.
const SKY: f64 = 0.15;
/// The sun's share of it that one passage of air lets through, and how it falls with more air (Meinel and Meinel 1976).
const CLEAR: f64 = 0.7;
const MORE_AIR: f64 = 0.678;

/// Where the sun stands before and after, as unit vectors in the rectified left camera's frame: x right, y down, z
/// forward; and how high.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Suns {
    /// To the sun under which the image was taken.
    pub source: [f64; 3],
    /// To the target's.
    pub target: [f64; 3],
}

/// What relights one image: the logarithm of the factor at z = 1 and strength 1, on a coarse grid over the stored
/// image.
#[derive(Debug, Clone, PartialEq)]
pub struct Shading(Vec<f32>);

impl Shading {
    /// Of a rectified pair under these suns. `stored` tells where the stored image has a rectified pixel; none where it
    /// does not see it.
    ///
    /// # Errors
    /// [`GenerateError::Pair`] where the images are not those of the rig.
    pub fn of(
        [left, right]: [&GreyImage; 2],
        rig: &StereoRig,
        suns: Suns,
        stored_size: (usize, usize),
        stored: impl Fn([f64; 2]) -> Option<[f64; 2]>,
    ) -> Result<Self, GenerateError> {
        let size = (rig.width as usize, rig.height as usize);
        if !rig.is_pair() || [left, right].iter().any(|image| (image.width, image.height) != size) {
            return Err(GenerateError::Pair { expected: size, found: (right.width, right.height) });
        }
        let disparities = Disparities::of(left, right, rig.focal_px * rig.baseline_m / NEAREST_M);
        let mut sums = vec![[0.0_f64; 2]; GRID[0] * GRID[1]];
        for row in 0..GRID[1] {
            for column in 0..GRID[0] {
                let at = [
                    (column as f64 + 0.5) * size.0 as f64 / GRID[0] as f64 - 0.5,
                    (row as f64 + 0.5) * size.1 as f64 / GRID[1] as f64 - 0.5,
                ];
                let (Some((normal, certainty)), Some(place)) = (normal_at(&disparities, rig, at), stored(at)) else {
                    continue;
                };
                spread(&mut sums, place, stored_size, certainty, suns.log_ratio(normal));
            }
        }
        // A sample without a known factor counts as unchanged, with weight by the missing certainty.
        Ok(Self(sums.iter().map(|[weight, sum]| (sum / weight.max(1.0)) as f32).collect()))
    }

    /// Adds to `planes.lift` what this image's brightness changes by at `reach`, z times strength.
    pub(crate) fn lift(&self, reach: f64, planes: &mut Planes, height: usize) {
        let width = planes.width;
        planes.lift.resize(width * height, 0.0);
        let reach = reach as f32;
        let held = |value: f32| (reach * value).clamp(-MOST as f32, MOST as f32);
        let across: Vec<(usize, f32)> = (0..width).map(|x| between(x, width, GRID[0])).collect();
        let mut line = [0.0_f32; GRID[0]];
        for (y, lift) in planes.lift.chunks_exact_mut(width).enumerate() {
            let (row, down) = between(y, height, GRID[1]);
            let [above, below] = [row, row + 1].map(|row| &self.0[row * GRID[0]..(row + 1) * GRID[0]]);
            for ((value, above), below) in line.iter_mut().zip(above).zip(below) {
                *value = held(above + down * (below - above));
            }
            for (lift, (column, share)) in lift.iter_mut().zip(&across) {
                *lift += line[*column] + share * (line[column + 1] - line[*column]);
            }
        }
    }

    /// The factor at a place of the image, each way from 0 to 1, at z = 1 and strength 1.
    pub fn factor(&self, [across, down]: [f64; 2]) -> f64 {
        let cell = |share: f64, cells: usize| ((share * cells as f64) as usize).min(cells - 1);
        libm::exp(f64::from(self.0[cell(down, GRID[1]) * GRID[0] + cell(across, GRID[0])]))
    }
}

impl Suns {
    /// The logarithm of how much more light falls on a surface than before, measured by what falls on level ground.
    fn log_ratio(&self, normal: [f64; 3]) -> f64 {
        let of = |sun: [f64; 3]| {
            let on = |normal: [f64; 3]| {
                let facing: f64 = normal.iter().zip(sun).map(|(n, s)| n * s).sum();
                SKY + through_air(-sun[1]) * facing.max(0.0)
            };
            libm::log(on(normal) / on([0.0, -1.0, 0.0]))
        };
        (of(self.target) - of(self.source)).clamp(-MOST, MOST)
    }
}

/// The sun's share that the air lets through, by the sine of its elevation (Kasten and Young 1989); nothing below the
/// horizon.
fn through_air(sine: f64) -> f64 {
    if sine <= 0.0 {
        return 0.0;
    }
    let elevation_deg = libm::asin(sine.min(1.0)).to_degrees();
    let air = 1.0 / (sine + 0.50572 * libm::pow(elevation_deg + 6.07995, -1.6364));
    libm::pow(CLEAR, libm::pow(air, MORE_AIR))
}

/// Shares a value among the four cells around a place of the stored image.
fn spread(sums: &mut [[f64; 2]], [x, y]: [f64; 2], (width, height): (usize, usize), certainty: f64, value: f64) {
    let place = |at: f64, pixels: usize, cells: usize| (at + 0.5) * cells as f64 / pixels as f64 - 0.5;
    let (x, y) = (place(x, width, GRID[0]), place(y, height, GRID[1]));
    for row in [y.floor(), y.floor() + 1.0] {
        for column in [x.floor(), x.floor() + 1.0] {
            let weight = (1.0 - (x - column).abs()) * (1.0 - (y - row).abs());
            let inside = (0.0..GRID[0] as f64).contains(&column) && (0.0..GRID[1] as f64).contains(&row);
            if inside && weight > 1e-9 {
                let cell = &mut sums[row as usize * GRID[0] + column as usize];
                cell[0] += weight;
                cell[1] += weight * certainty * value;
            }
        }
    }
}

/// Where the surface around a rectified pixel faces, a unit vector towards the camera's side, and how certain that is,
/// 0 to 1.
///
/// On a plane the disparity is linear over the image: d = a (u - u0) + b (v - v0) + c, and the plane's normal lies
/// along (a f, b f, c + a (cu - u0) + b (cv - v0)).
fn normal_at(disparities: &Disparities, rig: &StereoRig, at: [f64; 2]) -> Option<([f64; 3], f64)> {
    let scale = disparities.scale as f64;
    let [u0, v0] = at.map(|px| ((px + 0.5) / scale - 0.5).round());
    let mut samples = Vec::with_capacity((2 * SAMPLES as usize + 1).pow(2));
    for row in -SAMPLES..=SAMPLES {
        for column in -SAMPLES..=SAMPLES {
            let (x, y) = (u0 as isize + STEP * column, v0 as isize + STEP * row);
            let inside = (0..disparities.width as isize).contains(&x) && (0..disparities.height as isize).contains(&y);
            let d = if inside { disparities.px[y as usize * disparities.width + x as usize] } else { f32::NAN };
            if d.is_finite() {
                samples.push((Vector3::new((STEP * column) as f64, (STEP * row) as f64, 1.0), f64::from(d)));
            }
        }
    }
    // Twice: what lies far off the first plane belongs to another surface.
    let mut off_px = f64::INFINITY;
    let (mut plane, mut inverse, mut error_px) = (Vector3::zeros(), Matrix3::zeros(), 0.0);
    for _ in 0..2 {
        let near: Vec<_> =
            samples.iter().filter(|(place, d)| (plane.dot(place) - d).abs() < off_px || off_px.is_infinite()).collect();
        if (near.len() as f64) < LEAST_SAMPLES {
            return None;
        }
        let square: Matrix3<f64> = near.iter().map(|(place, _)| place * place.transpose()).sum();
        inverse = square.try_inverse()?;
        plane = inverse * near.iter().map(|(place, d)| place * *d).sum::<Vector3<f64>>();
        let squares: f64 = near.iter().map(|(place, d)| (plane.dot(place) - d).powi(2)).sum();
        error_px = (squares / (near.len() as f64 - 3.0)).sqrt().max(LEAST_ERROR_PX);
        off_px = 2.0 * error_px;
    }
    let focal = rig.focal_px / scale;
    let [cu, cv] = [rig.cu_px, rig.cv_px].map(|px| (px + 0.5) / scale - 0.5);
    let inward = Vector3::new(focal * plane.x, focal * plane.y, plane.z + plane.x * (cu - u0) + plane.y * (cv - v0));
    // How much the normal's direction errs, squared: what the slopes err against its length.
    let slopes = focal * focal * error_px * error_px * (inverse[(0, 0)] + inverse[(1, 1)]);
    let length = inward.norm_squared();
    let normal = -inward / length.sqrt();
    (length > 0.0).then(|| ([normal.x, normal.y, normal.z], length / (length + 4.0 * slopes)))
}
