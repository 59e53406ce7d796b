//! What the stamps of a recording make an ingest say: refusals and notes.

use crate::pairing::{Gap, PairingReport, Side};
use crate::traversal::clock::ClockOffset;
use crate::traversal::error::IngestError;
use crate::traversal::notes::Notes;
use crate::traversal::reader::ReadReport;
use crate::traversal::request::IngestRequest;
use crate::traversal::selection::FrameSelection;
use crate::traversal::stretches::{Step, ranges};
use std::path::Path;

/// The least time between frames of a camera, nanoseconds.
const LEAST_STEP_NS: i64 = 1_000_000;

/// Refuses stamps that nobody ever filled in, and clocks that were set back among the frames that are selected.
pub(crate) fn check_stamps(path: &Path, report: &ReadReport, selection: FrameSelection) -> Result<(), IngestError> {
    let [left, right] = report.images;
    for (side, images) in [(Side::Left, left), (Side::Right, right)] {
        if let Some(stamp_ns) = report.only_stamp_ns[side as usize].filter(|_| images > 1) {
            let cause = if stamp_ns == 0 { ": its driver does not fill them in" } else { "" };
            return Err(IngestError::Request(format!(
                "{}: all header stamps of its {images} {side} images are {stamp_ns} ns{cause}; expected a stamp an \
                 image, by which left and right are paired: mend the driver, or write the stamps from the receive \
                 times into a copy",
                path.display()
            )));
        }
    }
    if report.steps.is_empty() || lies_in_one(&report.stretches, selection) {
        return Ok(());
    }
    let ranges: Vec<String> = ranges(&report.stretches).map(|(from, to)| format!("--frames {from}..{to}")).collect();
    let ingests = if ranges.is_empty() {
        "no stretch between them has a pair".to_owned()
    } else {
        format!("ingest each stretch by itself, with the same command and {}", ranges.join(", then with "))
    };
    Err(IngestError::Request(format!("{}: {}; {ingests}", path.display(), steps_text(&report.steps))))
}

/// Refuses stamps, in order, of which most are less than a millisecond apart: no camera is that fast, so that they
/// are in another unit.
pub(crate) fn check_rate(path: &Path, stamps_ns: &[i64]) -> Result<(), IngestError> {
    let mut steps_ns: Vec<i64> = stamps_ns.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).collect();
    steps_ns.sort_unstable();
    let Some(&middle_ns) = steps_ns.get(steps_ns.len() / 2).filter(|step_ns| **step_ns < LEAST_STEP_NS) else {
        return Ok(());
    };
    Err(IngestError::Request(format!(
        "{}: most frames are {} ms apart by their stamps, and the first is of {} s after 1970; expected at most 1000 \
         frames a second: are the stamps in another unit?",
        path.display(),
        middle_ns as f64 / 1e6,
        seconds(stamps_ns[0])
    )))
}

/// Refuses pairs whose frames were received whole periods apart, or notes them where the user insists.
pub(crate) fn check_offset(
    request: &IngestRequest,
    path: &Path,
    offset: ClockOffset,
    notes: &Notes,
) -> Result<(), IngestError> {
    let (size, periods) = (seconds(offset.apart_ns.saturating_abs()), offset.periods.saturating_abs());
    let (when, ahead) = if offset.apart_ns > 0 { ("after", "behind") } else { ("before", "ahead of") };
    let frames = if periods == 1 { "frame" } else { "frames" };
    let doubt = format!(
        "the right frame of each pair was received {size} s, {periods} {frames}, {when} the left one: by stamp minus \
         receive time the right camera's clock is {size} s {ahead} the left one's, and the pairs are of different moments"
    );
    if request.accept_failed_odometry {
        notes.add(doubt);
        return Ok(());
    }
    let insist = "Set both cameras to one clock and record again, or shift the right stamps in a copy; where the right \
                  images merely come late, insist with --accept-failed-odometry";
    Err(IngestError::Doubtful { path: path.to_owned(), doubt, insist: insist.to_owned() })
}

/// Notes steps of clocks, gaps and frames whose stamps are of no use.
pub(crate) fn note_stamps(notes: &Notes, report: &ReadReport) {
    if !report.steps.is_empty() {
        notes.add(format!("{}: what was selected lies between two steps", steps_text(&report.steps)));
    }
    let PairingReport { gaps, duplicates, .. } = &report.pairing;
    for &Gap { from_ns, to_ns, is_clock } in gaps {
        let length = seconds(to_ns.saturating_sub(from_ns));
        notes.add(if is_clock {
            format!(
                "header stamps jump ahead by {length} s behind the left image stamped {from_ns} ns while receive times \
                 go on: the clock was set; no frames are counted as dropped there"
            )
        } else {
            format!("a gap of {length} s between the left images stamped {from_ns} ns and {to_ns} ns")
        });
    }
    if *duplicates > 0 {
        notes.add(format!("{duplicates} images have the stamp of one before them: the first of each was kept"));
    }
    if report.strays > 0 {
        notes.add(format!(
            "{} images have stamps far from those before and behind them: they are left without a partner",
            report.strays
        ));
    }
}

fn steps_text(steps: &[Step]) -> String {
    let first: Vec<String> = steps
        .iter()
        .take(6)
        .map(|step| format!("at {} image {} by {} s", step.side, step.image, seconds(step.back_ns)))
        .collect();
    format!("header stamps go back while receive times go on, {}: the clock was set back", first.join(", "))
}

/// Nanoseconds as seconds, for people.
fn seconds(ns: i64) -> String {
    let text = format!("{:.3}", ns as f64 / 1e9);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Whether what is selected is a range of pairs of one stretch.
fn lies_in_one(stretches: &[u32], selection: FrameSelection) -> bool {
    let FrameSelection::Range(from, to) = selection else { return false };
    ranges(stretches).any(|(first, end)| first <= from && to <= end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_come_at_most_a_thousand_times_a_second() {
        let at = |step_ns: i64| (0..5).map(|i| 1_700_000_000_000_000_000 / 1000 + i * step_ns).collect::<Vec<_>>();
        let path = Path::new("row");
        for step_ns in [1_000_000, 33_000_000, 3_600_000_000_000] {
            assert!(check_rate(path, &at(step_ns)).is_ok(), "{step_ns}");
        }
        let said = check_rate(path, &at(100_000)).unwrap_err().to_string();
        assert!(said.contains("0.1 ms apart") && said.contains("another unit"), "{said}");
        assert!(check_rate(path, &[5]).is_ok() && check_rate(path, &[]).is_ok());
        // Two frames of one moment among others are no reason.
        assert!(check_rate(path, &[0, 10, 50_000_000, 100_000_000]).is_ok());
    }
}
