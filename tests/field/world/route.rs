//! The line that a route follows, measured along it.

use crate::vector::{V3, v3};

/// Distance between the stored points in metres.
const STEP_M: f64 = 0.1;

/// A smooth line on the map, by points 0.1 m apart.
#[derive(Debug, Clone)]
pub struct RouteLine {
    points: Vec<[f64; 2]>,
    closed: bool,
}

/// Where a point of the map lies beside a route.
#[derive(Debug, Clone, Copy)]
pub struct Beside {
    /// Metres along the route.
    pub along_m: f32,
    /// Metres to the left of it.
    pub across_m: f32,
}

impl RouteLine {
    /// A line through `corners` (metres east, north): straight between two, else a Catmull-Rom spline; closed returns
    /// to the first.
    pub fn through(corners: &[[f64; 2]], closed: bool) -> RouteLine {
        let count = corners.len() as i64;
        let corner = |i: i64| {
            let i = if closed { i.rem_euclid(count) } else { i.clamp(0, count - 1) };
            corners[i as usize]
        };
        let spans = if closed { count } else { count - 1 };
        let mut dense = Vec::new();
        for span in 0..spans {
            let p = [-1, 0, 1, 2].map(|k| corner(span + k));
            dense.extend((0..256).map(|k| spline(p, f64::from(k) / 256.0)));
        }
        dense.push(corner(spans));
        RouteLine { points: resample(&dense), closed }
    }

    /// The length in metres.
    pub fn length_m(&self) -> f64 {
        (self.points.len() - 1) as f64 * STEP_M
    }

    /// The point at `along_m` and the unit direction there; an open line goes on straight beyond its ends.
    pub fn at(&self, along_m: f64) -> ([f64; 2], [f64; 2]) {
        let spans = self.points.len() - 1;
        let along = if self.closed { along_m.rem_euclid(self.length_m()) } else { along_m };
        let position = along / STEP_M;
        let i = (position.floor().max(0.0) as usize).min(spans - 1);
        let (a, b) = (self.points[i], self.points[i + 1]);
        let t = position - i as f64;
        // Directions are blended between the stored points, so that the heading has no steps.
        let (from, to) = (self.direction(i), self.direction(i + 1));
        let share = t.clamp(0.0, 1.0);
        let d = [0, 1].map(|k| from[k] + (to[k] - from[k]) * share);
        let length = (d[0] * d[0] + d[1] * d[1]).sqrt();
        ([0, 1].map(|k| a[k] + (b[k] - a[k]) * t), d.map(|v| v / length))
    }

    fn direction(&self, i: usize) -> [f64; 2] {
        let n = self.points.len() - 1;
        let at = |k: i64| {
            if self.closed {
                self.points[k.rem_euclid(n as i64) as usize]
            } else {
                self.points[k.clamp(0, n as i64) as usize]
            }
        };
        let (a, b) = (at(i as i64 - 2), at(i as i64 + 2));
        let d = [b[0] - a[0], b[1] - a[1]];
        let length = (d[0] * d[0] + d[1] * d[1]).sqrt().max(1e-9);
        d.map(|v| v / length)
    }

    /// Where (x, y) lies beside the line, searched within a window round the index `near` of
    /// [`RouteLine::nearest_metre`].
    pub fn beside(&self, x: f32, y: f32, near: usize) -> Beside {
        let count = self.points.len() as i64;
        let distance = |i: i64| {
            let p = self.points[self.wrap(i, count)];
            (p[0] as f32 - x) * (p[0] as f32 - x) + (p[1] as f32 - y) * (p[1] as f32 - y)
        };
        let centre = near as i64 * 10;
        let best = (centre - 16..=centre + 16).fold((centre, f32::INFINITY), |best, i| {
            let d = distance(i);
            if d < best.1 { (i, d) } else { best }
        });
        let i = self.wrap(best.0, count);
        let (p, d) = (self.points[i], self.direction(i));
        let (dx, dy) = (x - p[0] as f32, y - p[1] as f32);
        Beside {
            along_m: (i as f64 * STEP_M) as f32 + dx * d[0] as f32 + dy * d[1] as f32,
            across_m: dy * d[0] as f32 - dx * d[1] as f32,
        }
    }

    fn wrap(&self, i: i64, count: i64) -> usize {
        if self.closed { i.rem_euclid(count - 1) as usize } else { i.clamp(0, count - 1) as usize }
    }

    /// The whole metre of the route that lies nearest to (x, y).
    pub fn nearest_metre(&self, x: f32, y: f32) -> usize {
        let mut best = (0, f32::INFINITY);
        for (metre, p) in self.points.iter().step_by(10).enumerate() {
            let (dx, dy) = (p[0] as f32 - x, p[1] as f32 - y);
            if dx * dx + dy * dy < best.1 {
                best = (metre, dx * dx + dy * dy);
            }
        }
        best.0
    }

    /// How far (x, y) lies from the line, in metres.
    pub fn distance_m(&self, x: f32, y: f32) -> f32 {
        let beside = self.beside(x, y, self.nearest_metre(x, y));
        let foot = self.place(beside.along_m, 0.0);
        let (dx, dy) = (foot.x - x, foot.y - y);
        (dx * dx + dy * dy).sqrt()
    }

    /// The point `across_m` to the left of the route at `along_m`, on the plane z = 0.
    pub fn place(&self, along_m: f32, across_m: f32) -> V3 {
        let (p, d) = self.at(f64::from(along_m));
        v3(p[0] as f32 - across_m * d[1] as f32, p[1] as f32 + across_m * d[0] as f32, 0.0)
    }

    /// The smallest box round the part of the line up to `to_m`: least and greatest east, north.
    pub fn extent(&self, to_m: f64) -> ([f32; 2], [f32; 2]) {
        let count = ((to_m / STEP_M).ceil() as usize + 1).min(self.points.len());
        self.points[..count].iter().fold(([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]), |(low, high), p| {
            ([0, 1].map(|k| low[k].min(p[k] as f32)), [0, 1].map(|k| high[k].max(p[k] as f32)))
        })
    }
}

fn spline(p: [[f64; 2]; 4], t: f64) -> [f64; 2] {
    [0, 1].map(|k| {
        let (a, b, c, d) = (p[0][k], p[1][k], p[2][k], p[3][k]);
        0.5 * (2.0 * b
            + (c - a) * t
            + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t
            + (3.0 * b - a - 3.0 * c + d) * t * t * t)
    })
}

fn resample(dense: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut points = vec![dense[0]];
    let mut carried = 0.0;
    for pair in dense.windows(2) {
        let d = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        let length = (d[0] * d[0] + d[1] * d[1]).sqrt();
        let mut done = STEP_M - carried;
        while done <= length {
            points.push([0, 1].map(|k| pair[0][k] + d[k] * done / length));
            done += STEP_M;
        }
        carried = length - (done - STEP_M);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_keeps_its_length_and_sides() {
        let line = RouteLine::through(&[[0.0, 0.0], [0.0, 50.0]], false);
        assert!((line.length_m() - 50.0).abs() < 0.11);
        let beside = line.beside(-2.0, 20.0, line.nearest_metre(-2.0, 20.0));
        assert!((beside.along_m - 20.0).abs() < 1e-3 && (beside.across_m - 2.0).abs() < 1e-3, "{beside:?}");
        let place = line.place(20.0, 2.0);
        assert!((place.x + 2.0).abs() < 1e-3 && (place.y - 20.0).abs() < 1e-3);
        let (beyond, _) = line.at(60.0);
        assert!((beyond[1] - 60.0).abs() < 1e-6);
    }

    #[test]
    fn a_loop_comes_back() {
        let line = RouteLine::through(&[[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]], true);
        let ((a, _), (b, _)) = (line.at(0.0), line.at(line.length_m()));
        assert!((a[0] - b[0]).abs() < 0.15 && (a[1] - b[1]).abs() < 0.15);
        assert!((80.0..100.0).contains(&line.length_m()));
    }
}
