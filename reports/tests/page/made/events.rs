//! Tables of events.

use super::frame::{Frame, STEP_M, accepted, digest};
use furrow_model::outcome::event;
use furrow_model::{Member, ObjectId};
use polars::prelude::{DataFrame, IntoColumn, NamedFrom, Series};

/// The table that a run would write.
pub fn events(frames: &[Frame], members: &[Member]) -> DataFrame {
    let verified = |frame: &Frame| matches!(frame, Frame::Verified(..));
    let n = frames.len();
    let id = |seed: usize| ObjectId(digest(seed)).to_string();
    let experience = |i: usize| members.get(i % members.len().max(1)).map(|m| m.id.to_string());
    let correct: Vec<Option<bool>> =
        frames.iter().map(|f| if let Frame::Verified(_, correct) = f { *correct } else { None }).collect();
    let error = |right: &Option<bool>| right.map(|right| if right { 0.4 } else { 31.5 });
    let decision = |frame: &Frame| match frame {
        Frame::NewPlace => event::NEW_PLACE,
        frame if accepted(frame) => event::ACCEPTED,
        _ => event::REJECTED,
    };
    let inliers = |f: &Frame| if let Frame::Verified(inliers, _) = f { Some(*inliers) } else { None };
    let columns = [
        Series::new(
            event::LIVE_STAMP_NS.into(),
            (0..n).map(|i| 1_700_000_000_000_000_000 + i as i64 * 125_000_000).collect::<Vec<_>>(),
        ),
        Series::new(event::TRAVELLED_M.into(), (0..n).map(|i| i as f64 * STEP_M).collect::<Vec<_>>()),
        Series::new(event::LIVE_IMAGE.into(), (0..n).map(|i| id(9000 + i)).collect::<Vec<_>>()),
        Series::new(event::EXPERIENCE.into(), (0..n).map(experience).collect::<Vec<_>>()),
        Series::new(
            event::NODE_STAMP_NS.into(),
            frames.iter().enumerate().map(|(i, f)| verified(f).then_some(i as i64)).collect::<Vec<_>>(),
        ),
        Series::new(
            event::NODE_IMAGE.into(),
            frames.iter().enumerate().map(|(i, f)| verified(f).then(|| id(i))).collect::<Vec<_>>(),
        ),
        Series::new(event::INLIERS.into(), frames.iter().map(inliers).collect::<Vec<_>>()),
        Series::new(event::DECISION.into(), frames.iter().map(decision).collect::<Vec<_>>()),
        Series::new(event::CORRECT.into(), correct.clone()),
        Series::new(event::ERROR_M.into(), correct.iter().map(error).collect::<Vec<_>>()),
    ];
    DataFrame::new(n, columns.into_iter().map(|s| s.into_column()).collect()).unwrap()
}
