//! The chain of odometry transforms, stored apart from the nodes that sit on it (Church 2023, section 4.4), and
//! keyframing on it.

use crate::Se3;
use serde::{Deserialize, Serialize};

/// One link of the chain: the motion of the left camera between two consecutive frames.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Header stamp of the earlier frame.
    pub from_ns: i64,
    /// Header stamp of the later frame.
    pub to_ns: i64,
    /// The later frame's pose in the earlier frame.
    pub earlier_from_later: Se3,
    /// Matches that entered the motion fit.
    pub matches: u32,
    /// Matches that agreed with the motion.
    pub inliers: u32,
    /// False where odometry failed: `earlier_from_later` then repeats the last motion, and no keyframe may rest on it.
    pub valid: bool,
    /// How uncertain the step is; none where odometry failed, or the step was given and not measured.
    pub covariance: Option<StepCovariance>,
}

/// Covariance of a small motion of the later camera in its own frame, in the order rotation x y z (rad), translation x
/// y z (m): the true step is `earlier_from_later` times that motion. The upper triangle by rows; the matrix is
/// symmetric.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StepCovariance(pub [f64; 21]);

impl StepCovariance {
    /// Of a symmetric 6x6 matrix.
    pub fn of(matrix: &[[f64; 6]; 6]) -> Self {
        let mut upper = [0.0; 21];
        let entries = (0..6).flat_map(|row| &matrix[row][row..]);
        upper.iter_mut().zip(entries).for_each(|(entry, value)| *entry = *value);
        Self(upper)
    }

    /// The standard deviation of each of the six.
    pub fn stds(&self) -> [f64; 6] {
        // Row i of an upper triangle begins behind 6 + 5 + … entries.
        std::array::from_fn(|i| self.0[i * 6 - i * i.saturating_sub(1) / 2].max(0.0).sqrt())
    }
}

/// An unbroken chain: step i ends where step i + 1 begins.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Trajectory {
    /// The stamp of the first frame; `None` in an empty recording.
    pub start_ns: Option<i64>,
    /// The steps in order; one fewer than the frames.
    pub steps: Vec<Step>,
}

/// A frame's place on the chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainPose {
    /// Header stamp.
    pub stamp_ns: i64,
    /// The left camera's pose in the first frame (first_from_here).
    pub start_from_here: Se3,
    /// Distance travelled so far, along the chain, in metres.
    pub travelled_m: f64,
    /// Whether the step that leads here is valid.
    pub valid: bool,
}

impl Trajectory {
    /// Frames on the chain.
    pub fn frames(&self) -> usize {
        self.start_ns.map_or(0, |_| self.steps.len() + 1)
    }

    /// The path's length in metres.
    pub fn length_m(&self) -> f64 {
        self.steps.iter().map(|step| step.earlier_from_later.distance_m()).sum()
    }

    /// Steps where odometry failed.
    pub fn failed_steps(&self) -> usize {
        self.steps.iter().filter(|step| !step.valid).count()
    }

    /// Every frame's pose, T13 = T12 T23 (Church 2023, Fig. 4.4).
    pub fn poses(&self) -> Vec<ChainPose> {
        let Some(stamp_ns) = self.start_ns else { return Vec::new() };
        let mut pose = ChainPose { stamp_ns, start_from_here: Se3::IDENTITY, travelled_m: 0.0, valid: true };
        let mut poses = Vec::with_capacity(self.frames());
        poses.push(pose);
        for step in &self.steps {
            pose = ChainPose {
                stamp_ns: step.to_ns,
                start_from_here: pose.start_from_here.compose(&step.earlier_from_later),
                travelled_m: pose.travelled_m + step.earlier_from_later.distance_m(),
                valid: step.valid,
            };
            poses.push(pose);
        }
        poses
    }
}

/// When a new keyframe is due: path length or turn since the last one, whichever comes first.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeyframePolicy {
    /// Path length in metres.
    pub distance_m: f64,
    /// Turn about the vertical axis in radians.
    pub yaw_rad: f64,
}

impl KeyframePolicy {
    /// 2.0 m and 0.2536 rad (Church 2023, section 7.4.3).
    pub const THESIS: KeyframePolicy = KeyframePolicy { distance_m: 2.0, yaw_rad: 0.2536 };

    /// The indices of the frames of `trajectory` that are keyframes: the first, each that is due, and the last. A frame
    /// whose step failed is passed over.
    pub fn keyframes(&self, trajectory: &Trajectory) -> Vec<usize> {
        if trajectory.frames() == 0 {
            return Vec::new();
        }
        let mut keyframes = vec![0];
        let (mut path_m, mut key_from_here) = (0.0, Se3::IDENTITY);
        for (i, step) in trajectory.steps.iter().enumerate() {
            path_m += step.earlier_from_later.distance_m();
            key_from_here = key_from_here.compose(&step.earlier_from_later);
            let last = i + 1 == trajectory.steps.len();
            let due = path_m >= self.distance_m - SLACK || key_from_here.yaw_rad().abs() >= self.yaw_rad - SLACK;
            if step.valid && (due || last) {
                keyframes.push(i + 1);
                (path_m, key_from_here) = (0.0, Se3::IDENTITY);
            }
        }
        keyframes
    }
}

/// Rounding allowed when sums of steps meet a threshold exactly: four steps of 0.5 m make 2 m.
const SLACK: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;

    fn straight(steps: usize, motion: Se3) -> Trajectory {
        let step = |i: usize| Step {
            from_ns: i as i64,
            to_ns: i as i64 + 1,
            earlier_from_later: motion,
            matches: 100,
            inliers: 50,
            valid: true,
            covariance: None,
        };
        Trajectory { start_ns: Some(0), steps: (0..steps).map(step).collect() }
    }

    #[test]
    fn the_diagonal_of_an_upper_triangle_is_found() {
        let matrix =
            std::array::from_fn(|i| std::array::from_fn(|j| if i == j { ((i + 1) * (i + 1)) as f64 } else { -1.0 }));
        assert_eq!(StepCovariance::of(&matrix).stds(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }

    #[test]
    fn half_metre_steps_give_every_fourth_frame() {
        let chain = straight(13, Se3 { translation_m: [0.0, 0.0, 0.5], ..Se3::IDENTITY });
        assert_eq!(KeyframePolicy::THESIS.keyframes(&chain), [0, 4, 8, 12, 13]);
    }

    #[test]
    fn turning_on_the_spot_gives_every_third_frame() {
        let turn = Se3::from_quaternion([0.0, 0.05_f64.sin(), 0.0, 0.05_f64.cos()], [0.0; 3]);
        assert_eq!(KeyframePolicy::THESIS.keyframes(&straight(9, turn)), [0, 3, 6, 9]);
    }

    #[test]
    fn no_keyframe_rests_on_a_failed_step() {
        let mut chain = straight(6, Se3 { translation_m: [0.0, 0.0, 1.0], ..Se3::IDENTITY });
        chain.steps[1].valid = false;
        assert_eq!(KeyframePolicy::THESIS.keyframes(&chain), [0, 3, 5, 6]);
        assert_eq!(chain.failed_steps(), 1);
    }

    #[test]
    fn poses_compose_along_the_chain() {
        let chain = straight(4, Se3 { translation_m: [0.0, 0.0, 0.5], ..Se3::IDENTITY });
        let last = chain.poses()[4];
        assert_eq!((last.start_from_here.translation_m, last.travelled_m, last.stamp_ns), ([0.0, 0.0, 2.0], 2.0, 4));
    }
}
