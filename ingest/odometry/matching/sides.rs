//! Whether the left image is the left one: points of the right camera lie farther left, never farther right.

use super::mutual::match_mutually;
use super::stereo::StereoFrame;
use crate::features::Window;
use crate::params::StereoParams;
use furrow_model::StereoRig;
use std::ops::Add;

/// Lowe's ratio: what looks alike in several places says nothing.
const RATIO: f64 = 0.8;
/// Rows that exchanged cameras' rectification may be off by, in matching px.
const ROWS: i32 = 3;
/// Nearer to 0 than this, in image px, a disparity is a far point's and tells no side.
const FAR_PX: f64 = 3.0;

/// Distinct matches of left and right images by the sign of their disparity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SideVotes {
    /// Matches with the disparity of a point before the cameras.
    pub straight: u32,
    /// Matches with a negative disparity: no point before the cameras has one.
    pub crossed: u32,
    /// Matches without a disparity to speak of.
    pub far: u32,
}

impl SideVotes {
    /// Of one frame: both signs are searched alike, as far as the nearest depth of `rig` and `params`.
    pub fn of(frame: &StereoFrame, rig: &StereoRig, params: &StereoParams) -> Self {
        let scale = frame.left.scale as f64;
        let farthest_px = (rig.focal_px * rig.baseline_m / params.near_m).min(params.max_disparity_px);
        let reach = (farthest_px / scale).ceil() as i32;
        let index = &frame.left.index;
        let matches = match_mutually(index, &frame.right.index, RATIO, |i| {
            let (u, v) = (i32::from(index.u[i]), i32::from(index.v[i]));
            Some(Window { u: (u - reach, u + reach), v: (v - ROWS, v + ROWS) })
        });
        let mut votes = Self::default();
        for found in matches {
            let [a, b] = [frame.left.position_px(found.a as usize), frame.right.position_px(found.b as usize)];
            match f64::from(a[0] - b[0]) {
                disparity_px if disparity_px > FAR_PX => votes.straight += 1,
                disparity_px if disparity_px < -FAR_PX => votes.crossed += 1,
                _ => votes.far += 1,
            }
        }
        votes
    }
}

impl Add for SideVotes {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            straight: self.straight + other.straight,
            crossed: self.crossed + other.crossed,
            far: self.far + other.far,
        }
    }
}
