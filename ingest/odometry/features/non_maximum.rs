//! Non-maximum suppression: the pixels that are the maximum, or the minimum, of a square window around them.

use std::cmp::{max, min};

/// Rows processed at a time, so that their window extremes stay in the cache.
const STRIP_ROWS: usize = 32;

/// For every pixel the greatest (`MAX`) or least value of the square of `side` pixels whose upper left corner it is,
/// written to `found`. Where the square does not fit, the value is undefined. Windows are doubled (1, 2, 4, ...
/// pixels), so the cost grows with the logarithm of the side. `scratch` is a work buffer.
#[inline(always)]
fn window_extremes<const MAX: bool>(
    values: &[i16],
    width: usize,
    side: usize,
    found: &mut Vec<i16>,
    scratch: &mut Vec<i16>,
) {
    found.clear();
    found.extend_from_slice(values);
    scratch.resize(values.len(), 0);
    for stride in [1, width] {
        let mut span = 1;
        while span < side {
            let step = min(span, side - span) * stride;
            let len = found.len().saturating_sub(step);
            for ((out, &a), &b) in scratch[..len].iter_mut().zip(&found[..len]).zip(&found[step..]) {
                *out = if MAX { max(a, b) } else { min(a, b) };
            }
            std::mem::swap(found, scratch);
            span += step / stride;
        }
    }
}

/// Settings of the suppression.
pub(crate) struct Suppression {
    /// Pixels from the centre of a window to its sides.
    pub radius: usize,
    /// Least magnitude of the value.
    pub threshold: i16,
    /// Pixels at the border that are left out.
    pub margin: usize,
}

/// The pixels (u, v) inside the margin, in raster order, that hold the greatest (`MAX`) or least value of their window,
/// at least the threshold in magnitude. Of equal values in one window only the first in raster order is kept.
pub(crate) fn suppress_non_maxima<const MAX: bool>(
    values: &[i16],
    width: usize,
    settings: &Suppression,
) -> Vec<(usize, usize)> {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has AVX2.
        return unsafe { suppress_avx2::<MAX>(values, width, settings) };
    }
    suppress_portable::<MAX>(values, width, settings)
}

/// The same code, compiled for sixteen values at a time.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn suppress_avx2<const MAX: bool>(values: &[i16], width: usize, settings: &Suppression) -> Vec<(usize, usize)> {
    suppress_portable::<MAX>(values, width, settings)
}

#[inline(always)]
fn suppress_portable<const MAX: bool>(values: &[i16], width: usize, settings: &Suppression) -> Vec<(usize, usize)> {
    let &Suppression { radius, threshold, margin } = settings;
    let mut found = Vec::new();
    let margin = margin.max(radius);
    let height = values.len().checked_div(width).unwrap_or(0);
    if width <= 2 * margin || height <= 2 * margin {
        return found;
    }
    let (mut windows, mut scratch) = (Vec::new(), Vec::new());
    let strong = |value: i16| if MAX { value >= threshold } else { value <= -threshold };
    for v in margin..height - margin {
        let in_strip = (v - margin) % STRIP_ROWS;
        if in_strip == 0 {
            let rows = v - radius..min(v + STRIP_ROWS, height - margin) + radius;
            let strip = &values[rows.start * width..rows.end * width];
            window_extremes::<MAX>(strip, width, 2 * radius + 1, &mut windows, &mut scratch);
        }
        let row = &values[v * width + margin..(v + 1) * width - margin];
        let corner = in_strip * width + margin - radius;
        let row_windows = &windows[corner..corner + row.len()];
        for (chunk, (values_here, windows_here)) in row.chunks(CHUNK).zip(row_windows.chunks(CHUNK)).enumerate() {
            let hits = values_here
                .iter()
                .zip(windows_here)
                .fold(0_u8, |any, (&value, &window)| any | (u8::from(value == window) & u8::from(strong(value))));
            if hits == 0 {
                continue;
            }
            for (i, (&value, &window)) in values_here.iter().zip(windows_here).enumerate() {
                let u = margin + chunk * CHUNK + i;
                if value == window && strong(value) && first_of_equals(values, width, radius, u, v) {
                    found.push((u, v));
                }
            }
        }
    }
    found
}

/// Pixels tested at once: most chunks hold no extreme.
const CHUNK: usize = 16;

/// Whether no earlier pixel of the window has the same value.
fn first_of_equals(values: &[i16], width: usize, radius: usize, u: usize, v: usize) -> bool {
    let value = values[v * width + u];
    let columns = u - radius..u + radius + 1;
    let above =
        (v - radius..v).all(|row| !values[row * width + columns.start..row * width + columns.end].contains(&value));
    above && !values[v * width + columns.start..v * width + u].contains(&value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::noise_image;

    fn brute<const MAX: bool>(values: &[i16], width: usize, radius: usize, margin: usize) -> Vec<(usize, usize)> {
        let height = values.len() / width;
        let mut found = Vec::new();
        for v in margin..height - margin {
            for u in margin..width - margin {
                let here = v * width + u;
                let beaten = (v - radius..=v + radius).any(|y| {
                    (u - radius..=u + radius).any(|x| {
                        let other = y * width + x;
                        let (a, b) = if MAX { (values[other], values[here]) } else { (values[here], values[other]) };
                        a > b || (a == b && other < here)
                    })
                });
                if !beaten && (if MAX { values[here] >= 50 } else { values[here] <= -50 }) {
                    found.push((u, v));
                }
            }
        }
        found
    }

    #[test]
    fn windows_equal_brute_force() {
        for (seed, radius, margin) in [(1, 3, 3), (2, 1, 4), (3, 5, 8)] {
            // Few grey levels, so that windows hold equal values.
            let image = noise_image(61, 43, seed);
            let values: Vec<i16> = image.pixels.iter().map(|&p| (i16::from(p) - 128) / 16 * 16).collect();
            let settings = Suppression { radius, threshold: 50, margin };
            assert_eq!(suppress_non_maxima::<true>(&values, 61, &settings), brute::<true>(&values, 61, radius, margin));
            assert_eq!(
                suppress_non_maxima::<false>(&values, 61, &settings),
                brute::<false>(&values, 61, radius, margin)
            );
        }
    }

    #[test]
    fn small_images_have_none() {
        let settings = Suppression { radius: 3, threshold: 50, margin: 8 };
        assert!(suppress_non_maxima::<true>(&[], 0, &settings).is_empty());
        assert!(suppress_non_maxima::<true>(&[100; 49], 7, &settings).is_empty());
    }
}
