//! Why the stamps of true poses and of frames do not meet.

/// A first and a last stamp, nanoseconds.
type Span = [i64; 2];

/// Three years of seconds: no clock that counts from 1970 shows less, and no recording is longer.
const SINCE_1970_NS: i64 = 100_000_000 * 1_000_000_000;
/// GPS counts from 6 January 1980 and has no leap seconds.
const GPS_EPOCH_S: i128 = 315_964_800;
/// Leap seconds since then, and some to come.
const LEAP_S: i128 = 60;
const SECOND_NS: i128 = 1_000_000_000;
/// No recording is longer.
const WEEK_NS: i128 = 7 * 86_400 * SECOND_NS;

/// What most likely keeps the poses of one span from the frames of another, as a question and what to do.
pub(crate) fn likely_cause(poses: Span, frames: Span) -> String {
    let scaled = |by: i64| poses.map(|stamp_ns| stamp_ns / by);
    let units = [("nanoseconds", 1_000_000_000), ("microseconds", 1_000_000), ("milliseconds", 1_000)];
    let length = |span: Span| i128::from(span[1]) - i128::from(span[0]);
    let meeting = units.into_iter().filter(|(_, by)| meet(scaled(*by), frames));
    // From 0, several units meet: the one that makes the recording as long as its frames say.
    let unit = meeting.min_by_key(|(_, by)| (length(scaled(*by)) - length(frames)).abs());
    let by_unit = unit.map(|(unit, by)| format!("are its stamps {unit}? TUM's are seconds: divide them by {by}"));
    let is_long = length(poses) > WEEK_NS;
    match by_unit.as_ref().filter(|_| is_long) {
        Some(by_unit) => return by_unit.clone(),
        None if meet(poses, frames) => {
            return "poses more than a second apart are not interpolated: give one for each frame".to_owned();
        }
        None => {}
    }
    let counts = |span: Span| span[0].unsigned_abs() < SINCE_1970_NS.unsigned_abs();
    match (counts(poses), counts(frames)) {
        (true, false) => {
            return "are its stamps counted from 0? Add the moment at which they began, by the frames' clock"
                .to_owned();
        }
        (false, true) => {
            return "are the frames' stamps counted from 0? Give the poses' as seconds since the first frame, or the \
                    frames' by times.txt or names in nanoseconds"
                .to_owned();
        }
        _ => {}
    }
    if let Some(by_unit) = by_unit {
        return by_unit;
    }
    let apart_s = (i128::from(poses[0]) - i128::from(frames[0])) / SECOND_NS;
    if (apart_s.abs() - GPS_EPOCH_S).abs() <= LEAP_S {
        return "is one of them GPS time, which counts from 1980? Add 315964800 s, less the leap seconds".to_owned();
    }
    let quarters = (apart_s as f64 / 900.0).round();
    if quarters != 0.0 && quarters.abs() <= 56.0 && (apart_s as f64 - quarters * 900.0).abs() <= 300.0 {
        return format!("they are {} h apart: is one of them local time? Stamps count in UTC", quarters / 4.0);
    }
    "are they of another recording, or of another clock?".to_owned()
}

/// Whether two spans have a moment in common, give or take a second.
fn meet(a: Span, b: Span) -> bool {
    let slack = 1_000_000_000;
    a[0].saturating_sub(slack) <= b[1] && b[0].saturating_sub(slack) <= a[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_usual_faults_are_named() {
        let began = 1_700_000_000_000_000_000_i64;
        let span = |from: i64| [from, from + 12_000_000_000];
        let frames = span(began);
        let later = |s: i64| likely_cause(span(began + s * 1_000_000_000), frames);
        assert!(likely_cause(span(0), frames).contains("counted from 0"));
        assert!(likely_cause(span(40_000_000_000), frames).contains("counted from 0"));
        assert!(likely_cause(frames, span(0)).contains("frames' stamps counted from 0"));
        // Nanoseconds since the start, read as seconds.
        assert!(likely_cause([0, i64::MAX], span(0)).contains("nanoseconds"));
        assert!(likely_cause([0, 12_000_000 * 1_000_000_000], span(0)).contains("microseconds"));
        assert!(likely_cause([0, 60_000_000_000], span(0)).contains("more than a second"));
        assert!(likely_cause([2_000_000_000_000_000_000, 9_000_000_000_000_000_000], span(0)).contains("nanoseconds"));
        assert!(later(-7 * 3600).contains("-7 h"));
        assert!(later(5 * 3600 + 1800).contains("5.5 h"));
        assert!(later(-315_964_782).contains("GPS"));
        assert!(later(86_400 * 40).contains("another recording"));
        assert!(likely_cause([i64::MIN, i64::MIN], [i64::MAX, i64::MAX]).contains("another"));
    }
}
