//! What SURF looks for, and what it finds: keypoints and their descriptors.

/// What to look for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfParams {
    /// Smallest determinant of the Hessian of a keypoint, in squared grey levels (exclusive).
    pub hessian_threshold: f32,
    /// Octaves, each sampled half as densely as the one before. Octaves that do not fit the image are left out.
    pub octaves: usize,
    /// Filter sizes searched per octave; two more are computed around them.
    pub layers: usize,
    /// Whether keypoints are taken as upright, not turned to a direction of their own.
    pub upright: bool,
}

impl SurfParams {
    /// The settings of the golden numbers, which are OpenCV's usual ones: threshold 400, 4 octaves of 3 layers, with
    /// orientation.
    pub const GOLDEN: Self = Self { hessian_threshold: 400.0, octaves: 4, layers: 3, upright: false };

    /// [`Self::GOLDEN`] for keypoints that are not turned.
    pub const GOLDEN_UPRIGHT: Self = Self { upright: true, ..Self::GOLDEN };
}

/// A blob. Coordinates as in [`GreyImage`](furrow_model::GreyImage): (0, 0) is the centre of the top left pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keypoint {
    /// Column, to a fraction of a pixel.
    pub x_px: f32,
    /// Row, to a fraction of a pixel.
    pub y_px: f32,
    /// Side of the box filter that fits best, a whole number of pixels. The scale s of the paper is 1.2 / 9 of it.
    pub size_px: f32,
    /// Direction, 0 to 360 degrees with y down as OpenCV has it; 270 for upright keypoints.
    pub angle_deg: f32,
    /// Determinant of the Hessian, in squared grey levels.
    pub response: f32,
    /// Octave, from 0.
    pub octave: u8,
    /// Sign of the trace of the Hessian: 1 for dark blobs on bright ground, -1 for bright ones.
    pub laplacian_sign: i8,
}

/// 4 x 4 cells, row by row along the keypoint's direction, of (sum dx, sum dy, sum |dx|, sum |dy|); unit length.
pub type Descriptor = [f32; 64];
