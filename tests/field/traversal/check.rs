//! Which traversals can be simulated.

use super::request::Traversal;

/// Why a traversal cannot be simulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BadTraversal {
    /// The image size, columns and rows.
    #[error(
        "cannot render images of {0}x{1}: expected even numbers from 64x36 to 2560x1440; choose 640x360 for the \
         field's usual size"
    )]
    Size(u32, u32),
    /// The length in metres.
    #[error("cannot drive {0} m: expected a length from 1 m on")]
    Length(f64),
    /// The camera's rate in Hz.
    #[error("cannot take {0} stereo pairs per second: expected 1 to 60; a ZED takes 15")]
    Rate(f64),
    /// The share of pairs that lose images.
    #[error("cannot lose images of {0} of the pairs: expected a share from 0 to 0.5")]
    Dropped(f64),
    /// The camera clock's skew in parts per million.
    #[error("cannot run the camera's clock {0} ppm fast: expected -1000 to 1000")]
    Skew(f64),
    /// The offset between the stamps of a pair in milliseconds.
    #[error(
        "cannot stamp the right images {found} ms later than the left: expected -{most} to {most}, two fifths of the \
         time between frames"
    )]
    Offset {
        /// What was asked for.
        found: f64,
        /// What the camera's rate allows.
        most: f64,
    },
}

impl Traversal {
    /// Whether it can be simulated.
    ///
    /// # Errors
    /// The first number that is out of its range.
    pub fn check(&self) -> Result<(), BadTraversal> {
        let (width, height) = self.size;
        let sound = |n: u32, least: u32, most: u32| n.is_multiple_of(2) && (least..=most).contains(&n);
        if !sound(width, 64, 2560) || !sound(height, 36, 1440) {
            return Err(BadTraversal::Size(width, height));
        }
        if !(self.length_m >= 1.0 && self.length_m.is_finite()) {
            return Err(BadTraversal::Length(self.length_m));
        }
        let camera = &self.camera;
        if !(1.0..=60.0).contains(&camera.rate_hz) {
            return Err(BadTraversal::Rate(camera.rate_hz));
        }
        if !(0.0..=0.5).contains(&camera.dropped) {
            return Err(BadTraversal::Dropped(camera.dropped));
        }
        if !(-1000.0..=1000.0).contains(&camera.clock_skew_ppm) {
            return Err(BadTraversal::Skew(camera.clock_skew_ppm));
        }
        let most = camera.greatest_offset_ms();
        if !(-most..=most).contains(&camera.clock_offset_ms) {
            return Err(BadTraversal::Offset { found: camera.clock_offset_ms, most });
        }
        Ok(())
    }
}
