//! Live frames, and what became of them.

pub const THRESHOLD: u32 = 15;
pub const STEP_M: f64 = 0.5;

/// What became of one live frame.
#[derive(Clone, Copy)]
pub enum Frame {
    NewPlace,
    /// Verified with so many inliers; whether the place is right, where that is known.
    Verified(u32, Option<bool>),
}

pub fn accepted(frame: &Frame) -> bool {
    matches!(frame, Frame::Verified(inliers, _) if *inliers >= THRESHOLD)
}

pub fn digest(seed: usize) -> [u8; 32] {
    std::array::from_fn(|i| (seed * 37 + i * 11 + seed / 7 * i) as u8)
}
