//! A traversal's frames and chain as an experience.

use furrow_catalog::records::TraversalRecord;
use furrow_catalog::tables::Frame;
use furrow_model::{Experience, ExperienceKind, KeyframePolicy, Node, Trajectory};

/// The frames of a traversal that are keyframes under `policy`, as nodes.
fn keyframe_nodes(frames: &[Frame], chain: &Trajectory, policy: KeyframePolicy) -> Vec<Node> {
    let node = |i: usize| frames.get(i).map(|frame| Node { stamp_ns: frame.stamp_ns, left: frame.left });
    policy.keyframes(chain).into_iter().filter_map(node).collect()
}

/// The recorded experience of a traversal under a keyframe policy. Other policies give other versions on the same
/// chain, without running odometry again.
pub fn experience_of(
    traversal: &TraversalRecord,
    frames: &[Frame],
    chain: &Trajectory,
    keyframes: KeyframePolicy,
) -> Experience {
    Experience {
        site: traversal.site.clone(),
        route: traversal.route.clone(),
        slot: traversal.slot,
        kind: ExperienceKind::Recorded,
        rig: traversal.rig,
        calibration: traversal.calibration,
        chain: traversal.chain,
        keyframes,
        nodes: keyframe_nodes(frames, chain, keyframes),
    }
}
