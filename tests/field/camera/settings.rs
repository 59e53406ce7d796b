//! What a camera can be asked for, and what can be wrong with it.

use serde::Serialize;

/// How the stereo camera of a traversal takes, stamps and delivers its images. The default is a camera without faults
/// of that kind: rectified, eight pairs per second, nothing lost, the true time in every stamp.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CameraSettings {
    /// Stereo pairs per second of true time, 1 to 60.
    pub rate_hz: f64,
    /// Whether the images are those of the raw lenses, distorted and unrectified, instead of rectified ones.
    pub distorted: bool,
    /// Share of the pairs, 0 to 0.5, of which one or both images never reach the recording; the first pair always does.
    pub dropped: f64,
    /// How much the camera's clock runs fast against the true time, in parts per million, -1000 to 1000. It is right
    /// when the traversal begins.
    pub clock_skew_ppm: f64,
    /// How much later the right images are stamped than the left ones taken with them, in milliseconds, within two
    /// fifths of the time between frames. Where it is not 0, the two are stamped apart and the right stamps tremble by
    /// up to 0.7 ms.
    pub clock_offset_ms: f64,
}

impl Default for CameraSettings {
    fn default() -> Self {
        CameraSettings { rate_hz: 8.0, distorted: false, dropped: 0.0, clock_skew_ppm: 0.0, clock_offset_ms: 0.0 }
    }
}

impl CameraSettings {
    /// The greatest offset between the stamps of two images taken together, in milliseconds: two fifths of the time
    /// between frames, so that an image's nearest neighbour stays its partner.
    pub fn greatest_offset_ms(&self) -> f64 {
        400.0 / self.rate_hz
    }
}
