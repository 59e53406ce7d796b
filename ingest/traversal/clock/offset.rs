//! By how much two cameras' clocks are apart, judged by when the recorder received the frames of pairs.

/// The receive times of pairs' frames, beside each other.
#[derive(Debug, Default)]
pub(crate) struct Offsets {
    /// Right minus left, nanoseconds, of every pair.
    apart_ns: Vec<i64>,
}

/// Pairs whose frames were received whole periods apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ClockOffset {
    /// How much the right frame of a pair was received later than the left one, nanoseconds.
    pub(crate) apart_ns: i64,
    /// The same in whole periods; at least one, either way.
    pub(crate) periods: i64,
}

impl Offsets {
    /// Takes the receive times of a pair's frames.
    pub(crate) fn push(&mut self, left_ns: i64, right_ns: i64) {
        self.apart_ns.push(right_ns.saturating_sub(left_ns));
    }

    /// Whether most pairs were received a whole number of periods apart, and always the same: then frames that were
    /// taken together carry stamps of different moments. A side that merely comes late is late by any time.
    pub(crate) fn judge(mut self, period_ns: Option<i64>) -> Option<ClockOffset> {
        let period_ns = period_ns.filter(|period_ns| *period_ns > 0)?;
        let places = [1, 2, 3].map(|quarter| self.apart_ns.len() * quarter / 4);
        if self.apart_ns.len() < 4 {
            return None;
        }
        self.apart_ns.sort_unstable();
        let [low, middle, high] = places.map(|place| self.apart_ns[place]);
        let periods = (middle as f64 / period_ns as f64).round() as i64;
        let rest_ns = middle.saturating_sub(periods.saturating_mul(period_ns)).saturating_abs();
        let is_whole = periods != 0 && rest_ns <= period_ns / 5;
        let is_steady = high.saturating_sub(low) <= period_ns / 4;
        (is_whole && is_steady).then_some(ClockOffset { apart_ns: middle, periods })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judge(apart_ns: impl Iterator<Item = i64>) -> Option<i64> {
        let mut offsets = Offsets::default();
        apart_ns.enumerate().for_each(|(i, apart)| offsets.push(i as i64 * 100, i as i64 * 100 + apart));
        offsets.judge(Some(100)).map(|offset| offset.periods)
    }

    #[test]
    fn whole_periods_that_last_are_an_offset() {
        assert_eq!(judge((0..20).map(|i| 300 + i % 7)), Some(3));
        assert_eq!(judge((0..20).map(|i| -100 - i % 7)), Some(-1));
        for none in [0, 20, 50, 60, 140, -150] {
            assert_eq!(judge((0..20).map(|i| none + i % 7)), None, "{none}");
        }
        // A side whose frames come late by this and that.
        assert_eq!(judge((0..20).map(|i| 300 + 17 * (i % 7))), None);
        assert_eq!(judge([300, 300, 300].into_iter()), None);
    }
}
