//! Descriptors: 32 Sobel bytes around a feature (Geiger et al. 2011, section III-A and Fig. 3).

use super::filter_rows::MASK_RADIUS;
use super::filters::Responses;

/// Pixels at the border where a descriptor does not fit: its farthest sample, and the mask that computed that sample.
pub(super) const MARGIN: usize = 5 + MASK_RADIUS;

/// Sixteen places (du, dv) in the 11x11 block around a feature, denser near its centre.
const SAMPLES: [(i32, i32); 16] = [
    (-1, -1),
    (1, -1),
    (-1, 1),
    (1, 1),
    (-5, -1),
    (5, -1),
    (-5, 1),
    (5, 1),
    (-1, -5),
    (1, -5),
    (-1, 5),
    (1, 5),
    (-3, -3),
    (3, -3),
    (-3, 3),
    (3, 3),
];

/// The horizontal Sobel responses of the sixteen samples around (u, v), then the vertical ones.
pub(super) fn describe(responses: &Responses, u: usize, v: usize) -> [u8; 32] {
    let centre = (v * responses.width + u) as isize;
    let mut bytes = [0; 32];
    for (i, (du, dv)) in SAMPLES.into_iter().enumerate() {
        let at = (centre + dv as isize * responses.width as isize + du as isize) as usize;
        bytes[i] = responses.sobel_u[at];
        bytes[16 + i] = responses.sobel_v[at];
    }
    bytes
}
