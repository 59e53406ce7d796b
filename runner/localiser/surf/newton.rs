//! Refinement of a maximum by one Newton step (Brown and Lowe 2002, section 3).

/// A 3 x 3 x 3 neighbourhood: `[layer][row][column]`, the maximum in the middle.
pub(super) type Neighbourhood = [[[f32; 3]; 3]; 3];

/// The offset (column, row, layer) of the maximum of the quadratic through `n`, in samples; `None` where the quadratic
/// has no single extremum, where the offset exceeds one sample or is exactly nothing.
pub(super) fn newton_step(n: &Neighbourhood) -> Option<[f32; 3]> {
    let centre = n[1][1][1];
    let downhill =
        [-(n[1][1][2] - n[1][1][0]) / 2.0, -(n[1][2][1] - n[1][0][1]) / 2.0, -(n[2][1][1] - n[0][1][1]) / 2.0];
    let xx = n[1][1][0] - 2.0 * centre + n[1][1][2];
    let yy = n[1][0][1] - 2.0 * centre + n[1][2][1];
    let ss = n[0][1][1] - 2.0 * centre + n[2][1][1];
    let xy = (n[1][2][2] - n[1][2][0] - n[1][0][2] + n[1][0][0]) / 4.0;
    let xs = (n[2][1][2] - n[2][1][0] - n[0][1][2] + n[0][1][0]) / 4.0;
    let ys = (n[2][2][1] - n[2][0][1] - n[0][2][1] + n[0][0][1]) / 4.0;
    let offset = solve([[xx, xy, xs], [xy, yy, ys], [xs, ys, ss]], downhill)?;
    let refined = offset != [0.0; 3] && offset.iter().all(|step| step.abs() <= 1.0);
    refined.then_some(offset)
}

/// The solution of a x = b by Cramer's rule; `None` where `a` is singular.
fn solve(a: [[f32; 3]; 3], b: [f32; 3]) -> Option<[f32; 3]> {
    let minor = |p: f32, q: f32, r: f32, s: f32| p * s - q * r;
    let [[a00, a01, a02], [a10, a11, a12], [a20, a21, a22]] = a;
    let [b0, b1, b2] = b;
    let determinant =
        a00 * minor(a11, a12, a21, a22) - a01 * minor(a10, a12, a20, a22) + a02 * minor(a10, a11, a20, a21);
    if determinant == 0.0 {
        return None;
    }
    let scale = 1.0 / determinant;
    Some([
        scale * (b0 * minor(a11, a12, a21, a22) - a01 * minor(b1, a12, b2, a22) + a02 * minor(b1, a11, b2, a21)),
        scale * (a00 * minor(b1, a12, b2, a22) - b0 * minor(a10, a12, a20, a22) + a02 * minor(a10, b1, a20, b2)),
        scale * (a00 * minor(a11, b1, a21, b2) - a01 * minor(a10, b1, a20, b2) + b0 * minor(a10, a11, a20, a21)),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of a known quadratic: its extremum is where it was put.
    #[test]
    fn finds_the_top_of_a_quadratic() {
        let top = [0.3_f32, -0.25, 0.4];
        let value = |x: f32, y: f32, s: f32| {
            let (x, y, s) = (x - top[0], y - top[1], s - top[2]);
            100.0 - 3.0 * x * x - 4.0 * y * y - 2.0 * s * s + x * y + 0.5 * y * s - 0.3 * x * s
        };
        let n = std::array::from_fn(|s| {
            std::array::from_fn(|y| std::array::from_fn(|x| value(x as f32 - 1.0, y as f32 - 1.0, s as f32 - 1.0)))
        });
        let step = newton_step(&n).unwrap();
        for (found, put) in step.iter().zip(top) {
            assert!((found - put).abs() < 1e-4, "{step:?}");
        }
        assert_eq!(newton_step(&[[[1.0; 3]; 3]; 3]), None);
    }
}
