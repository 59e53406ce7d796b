//! Marks and lines as SVG paths.

use super::scale::rounded;

/// The mark of collectives.
pub(crate) const DIAMOND: usize = 3;
/// The mark of what is known to be wrong.
pub(crate) const CROSS: usize = 6;

/// A mark of radius `r` about a point, as a path: circle, square, triangle, diamond, triangle on its tip, hexagon;
/// [`CROSS`] last.
pub(crate) fn mark_path(mark: usize, x: f64, y: f64, r: f64) -> String {
    let polygon = |corners: &[(f64, f64)]| {
        let corners: Vec<String> =
            corners.iter().map(|(dx, dy)| format!("{} {}", rounded(x + dx * r), rounded(y + dy * r))).collect();
        format!("M{}Z", corners.join("L"))
    };
    match mark {
        CROSS => {
            let (l, t, e, b) = (rounded(x - r), rounded(y - r), rounded(x + r), rounded(y + r));
            format!("M{l} {t}L{e} {b}M{e} {t}L{l} {b}")
        }
        other => match other % 6 {
            0 => format!("M{} {y}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0Z", rounded(x - r), d = 2.0 * r),
            1 => polygon(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
            2 => polygon(&[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)]),
            3 => polygon(&[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)]),
            4 => polygon(&[(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8)]),
            _ => polygon(&[(-1.1, 0.0), (-0.55, -1.0), (0.55, -1.0), (1.1, 0.0), (0.55, 1.0), (-0.55, 1.0)]),
        },
    }
}

/// Straight lines through points.
pub(crate) fn polyline(points: impl IntoIterator<Item = (f64, f64)>) -> String {
    let mut d = String::new();
    for (i, (x, y)) in points.into_iter().enumerate() {
        d.push_str(&format!("{}{x} {y}", if i == 0 { "M" } else { "L" }));
    }
    d
}

/// The points that a line through them needs so that it passes every other within `tolerance` (Ramer, Douglas and
/// Peucker).
pub(crate) fn simplified(points: &[(f64, f64)], tolerance: f64) -> Vec<(f64, f64)> {
    let mut kept = vec![false; points.len()];
    let mut stretches = vec![(0, points.len().saturating_sub(1))];
    while let Some((from, to)) = stretches.pop() {
        for end in [from, to] {
            kept.get_mut(end).into_iter().for_each(|kept| *kept = true);
        }
        let between = (from + 1..to).map(|i| (i, off_line(points[i], points[from], points[to])));
        if let Some((far, _)) = between.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, off)| *off > tolerance) {
            stretches.extend([(from, far), (far, to)]);
        }
    }
    points.iter().zip(kept).filter(|(_, kept)| *kept).map(|(point, _)| *point).collect()
}

/// How far a point is from the line between two others.
fn off_line(point: (f64, f64), from: (f64, f64), to: (f64, f64)) -> f64 {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy);
    let (px, py) = (point.0 - from.0, point.1 - from.1);
    if length > 0.0 { (px * dy - py * dx).abs() / length } else { px.hypot(py) }
}

#[cfg(test)]
mod tests {
    use super::simplified;

    #[test]
    fn a_simplified_line_keeps_its_corners() {
        let points = [(0.0, 0.0), (1.0, 0.1), (2.0, 0.0), (3.0, 5.0), (4.0, 10.0), (5.0, 10.0)];
        assert_eq!(simplified(&points, 0.3), [(0.0, 0.0), (2.0, 0.0), (4.0, 10.0), (5.0, 10.0)]);
        assert_eq!(simplified(&points[..1], 0.3), &points[..1]);
        assert_eq!(simplified(&[], 0.3), []);
    }
}
