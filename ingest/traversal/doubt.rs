//! Whether what odometry made of a recording should enter: not where the cameras are exchanged, nor where most steps
//! failed, unless the user insists.

use crate::traversal::error::IngestError;
use crate::traversal::motion::MotionSource;
use crate::traversal::notes::Notes;
use crate::traversal::request::IngestRequest;
use crate::traversal::source::ImageSource;
use crate::traversal::stages::SIDES_EVERY;
use crate::traversal::stream::FrameStream;
use furrow_catalog::tables::Frame;
use furrow_model::{Step, Trajectory};
use furrow_odometry::SideVotes;

/// Crossed matches that a verdict needs, and how many times the straight ones they must be.
const CROSSED_AT_LEAST: u32 = 30;
const CROSSED_TIMES: u32 = 3;
/// Where steps are as few as this, one that succeeded speaks for the recording.
const FEW_STEPS: usize = 3;
/// Fewer matches of left and right a frame than this say that they hardly show the same.
const COMMON_POINTS: u32 = 20;
/// Fewer matches between two frames than this say that they hardly show the same.
const COMMON_MATCHES: u32 = 20;

/// Refuses a chain of odometry that most likely says nothing of the robot's motion. Where the user insists, notes it.
pub(crate) fn check_odometry(
    request: &IngestRequest,
    source: &dyn ImageSource,
    stream: &FrameStream,
    notes: &Notes,
) -> Result<(), IngestError> {
    if request.motion != MotionSource::Odometry {
        return Ok(());
    }
    let (doubt, insist) = if let Some(doubt) = crossed(&stream.sides) {
        (doubt, exchange(source))
    } else if let Some(doubt) = crossed_in_part(&stream.sides) {
        (doubt, "Ingest the frames of the other part with --frames A..B".to_owned())
    } else if let Some(doubt) = failed(stream) {
        (doubt, "Mend that".to_owned())
    } else {
        return Ok(());
    };
    if request.accept_failed_odometry {
        notes.add(doubt);
        return Ok(());
    }
    let insist = format!("{insist}, or enter the recording as it is with --accept-failed-odometry");
    Err(IngestError::Doubtful { path: source.path().to_owned(), doubt, insist })
}

/// How the images are exchanged while each calibration stays on its side: it told which camera is the right one.
fn exchange(source: &dyn ImageSource) -> String {
    let by_topic = "where the cables were exchanged, exchange the images and leave each CameraInfo on its side";
    match source.right_name().filter(|right| right.starts_with('/')) {
        Some(right) => format!(
            "Mostly the images are exchanged and the calibration is not: {by_topic} (--left {right} --right {} \
             --left-info LEFT_INFO --right-info RIGHT_INFO)",
            source.left_name()
        ),
        None => "Exchange the names of the folders of images; where the calibration is exchanged, that of the cameras"
            .to_owned(),
    }
}

/// What speaks for exchanged cameras in the whole recording.
fn crossed(sides: &[(usize, SideVotes)]) -> Option<String> {
    let all = sum(sides);
    is_crossed(all).then(|| {
        format!(
            "negative disparities: of {} points near the cameras {} lie on the wrong side, so the left and the right \
             camera seem to be swapped (cables, topics, folders or calibration)",
            all.crossed + all.straight,
            all.crossed
        )
    })
}

/// What speaks for exchanged cameras in a part of the recording: two frames looked at, one after the other, agree.
fn crossed_in_part(sides: &[(usize, SideVotes)]) -> Option<String> {
    let stretches = sides.chunk_by(|(_, one), (_, next)| is_crossed(*one) == is_crossed(*next));
    let crossed = stretches.filter(|stretch| stretch.iter().all(|(_, votes)| is_crossed(*votes)));
    let long = |stretch: &&[(usize, SideVotes)]| stretch[stretch.len() - 1].0 - stretch[0].0 >= SIDES_EVERY;
    crossed.filter(long).max_by_key(|stretch| stretch.len()).map(|stretch| {
        let (first, last, votes) = (stretch[0].0, stretch[stretch.len() - 1].0, sum(stretch));
        format!(
            "negative disparities from about frame {first} to about frame {last}: of {} points near the cameras {} lie \
             on the wrong side there, so the left and the right camera seem to be swapped in that part of the recording",
            votes.crossed + votes.straight,
            votes.crossed
        )
    })
}

fn is_crossed(votes: SideVotes) -> bool {
    votes.crossed >= CROSSED_AT_LEAST && votes.crossed > CROSSED_TIMES * votes.straight
}

fn sum(sides: &[(usize, SideVotes)]) -> SideVotes {
    sides.iter().fold(SideVotes::default(), |sum, (_, votes)| sum + *votes)
}

/// What speaks against a chain by its failed steps, with the likely cause.
fn failed(stream: &FrameStream) -> Option<String> {
    let (failed, steps) = (stream.chain.failed_steps(), stream.chain.steps.len());
    let is_doubtful = failed > 0 && (failed == steps || steps > FEW_STEPS && 2 * failed > steps);
    is_doubtful.then(|| {
        let cause = cause_of_failure(&stream.frames, &stream.chain, &stream.sides);
        format!("odometry failed on {failed} of {steps} steps: {cause}")
    })
}

fn cause_of_failure(frames: &[Frame], chain: &Trajectory, sides: &[(usize, SideVotes)]) -> String {
    let (votes, counted) = (sum(sides), sides.len() as u32);
    if frames.iter().all(|frame| frame.right.is_some_and(|right| right.image == frame.left)) {
        return "left and right are the same images".to_owned();
    }
    if votes.straight + votes.far < COMMON_POINTS * counted {
        return "left and right images hardly show the same: do they belong together (one moment, this calibration), \
                and are they sharp and bright?"
            .to_owned();
    }
    let failed: Vec<&Step> = chain.steps.iter().filter(|step| !step.valid).collect();
    let matches = middle(failed.iter().map(|step| i64::from(step.matches)));
    let apart_s = middle(failed.iter().map(|step| step.to_ns.saturating_sub(step.from_ns))) as f64 / 1e9;
    if matches < i64::from(COMMON_MATCHES) {
        return format!(
            "frames {apart_s:.2} s apart hardly show the same: are they too far apart, out of order, dark or blurred?"
        );
    }
    format!(
        "{matches} matches between frames {apart_s:.2} s apart agree on no motion: is the calibration (focal length, \
         baseline) that of these images?"
    )
}

/// The upper median; 0 of nothing.
fn middle(values: impl Iterator<Item = i64>) -> i64 {
    let mut sorted: Vec<i64> = values.collect();
    sorted.sort_unstable();
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_count_as_exchanged_only_by_many_points_and_a_clear_majority() {
        let said = |straight, crossed| crossed_votes(straight, crossed).is_some();
        assert!(said(0, 30) && said(99, 300));
        assert!(!said(0, 29) && !said(0, 0) && !said(100, 300) && !said(500, 20));
    }

    #[test]
    fn cameras_exchanged_in_a_part_of_a_recording_are_told_with_the_frames() {
        let votes = |is_crossed: bool| match is_crossed {
            true => SideVotes { straight: 4, crossed: 90, far: 100 },
            false => SideVotes { straight: 300, crossed: 8, far: 100 },
        };
        let of = |crossed: std::ops::RangeInclusive<usize>| {
            let frames = (0..8).chain((32..640).step_by(SIDES_EVERY));
            super::crossed_in_part(&frames.map(|frame| (frame, votes(crossed.contains(&frame)))).collect::<Vec<_>>())
        };
        let said = of(100..=300).unwrap();
        assert!(said.contains("from about frame 128 to about frame 288"), "{said}");
        assert!(of(400..=1000).unwrap().contains("from about frame 416 to about frame 608"));
        // A single frame looked at, or a moment at the beginning, is no part of a recording.
        assert!(of(64..=64).is_none() && of(0..=7).is_none() && of(5000..=5001).is_none());
    }

    fn crossed_votes(straight: u32, crossed: u32) -> Option<String> {
        super::crossed(&[(0, SideVotes { straight, crossed, far: 1000 })])
    }
}
