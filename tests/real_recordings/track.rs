//! A GPS track and a trajectory, held against each other by means of their own.

/// `2011-09-26 14:05:35.500923136` on the clock that the bag's stamps count on.
pub fn nanoseconds(text: &str) -> i64 {
    let (date, time) = text.split_once(' ').unwrap();
    let date: Vec<i64> = date.split('-').map(|part| part.parse().unwrap()).collect();
    let (clock, fraction) = time.split_once('.').unwrap();
    let clock: Vec<i64> = clock.split(':').map(|part| part.parse().unwrap()).collect();
    // Days since 1970 by the civil calendar (Fliegel and Van Flandern 1968).
    let (y, m, d) = (date[0], date[1], date[2]);
    let julian = (1461 * (y + 4800 + (m - 14) / 12)) / 4 + (367 * (m - 2 - 12 * ((m - 14) / 12))) / 12
        - (3 * ((y + 4900 + (m - 14) / 12) / 100)) / 4
        + d
        - 32075;
    let seconds = (julian - 2_440_588) * 86_400 + clock[0] * 3600 + clock[1] * 60 + clock[2];
    seconds * 1_000_000_000 + format!("{fraction:0<9}").parse::<i64>().unwrap()
}

/// Root mean square distance after the best rigid motion in the plane (Horn's closed form in two dimensions).
pub fn aligned_rmse(a: &[(f64, f64)], b: &[(f64, f64)]) -> f64 {
    let n = a.len() as f64;
    let mean = |p: &[(f64, f64)]| (p.iter().map(|v| v.0).sum::<f64>() / n, p.iter().map(|v| v.1).sum::<f64>() / n);
    let (ma, mb) = (mean(a), mean(b));
    let (mut dot, mut cross) = (0.0, 0.0);
    for (p, q) in a.iter().zip(b) {
        let (p, q) = ((p.0 - ma.0, p.1 - ma.1), (q.0 - mb.0, q.1 - mb.1));
        dot += p.0 * q.0 + p.1 * q.1;
        cross += p.0 * q.1 - p.1 * q.0;
    }
    let angle = cross.atan2(dot);
    let error = |(p, q): (&(f64, f64), &(f64, f64))| {
        let (x, y) = (p.0 - ma.0, p.1 - ma.1);
        let moved = (x * angle.cos() - y * angle.sin() + mb.0, x * angle.sin() + y * angle.cos() + mb.1);
        (moved.0 - q.0).powi(2) + (moved.1 - q.1).powi(2)
    };
    (a.iter().zip(b).map(error).sum::<f64>() / n).sqrt()
}

/// East and north of the GPS track at `time_s` after frame 0, linearly interpolated; `None` outside.
pub fn gps_at(track: &[(f64, f64, f64)], time_s: f64) -> Option<(f64, f64)> {
    let after = track.iter().position(|fix| fix.0 >= time_s)?;
    let (a, b) = (track.get(after.checked_sub(1)?)?, track[after]);
    let share = (time_s - a.0) / (b.0 - a.0);
    Some((a.1 + share * (b.1 - a.1), a.2 + share * (b.2 - a.2)))
}
