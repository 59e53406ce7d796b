//! Measures of generated images (thesis 5.3 to 5.7), and the verdict on a generator. Matching is the caller's: features
//! are not known here.

use furrow_model::{ColourImage, GreyImage, Measures, SwitchIndex};

/// The domainnesses over which the switch index is taken: 0, 0.05 to 1.
pub fn switch_ladder() -> [f64; 21] {
    std::array::from_fn(|i| i as f64 / 20.0)
}

/// The mean difference of two images of one size in grey levels, over all channels.
pub fn mean_step(a: &ColourImage, b: &ColourImage) -> f64 {
    let sum: u64 = a.rgb.iter().zip(&b.rgb).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / a.rgb.len().max(1) as f64
}

/// The mean square of the 4-neighbour Laplacian, in squared grey levels: how much fine detail there is. 0 for images
/// below 3 x 3.
pub fn laplacian_energy(image: &GreyImage) -> f64 {
    let (width, height) = (image.width, image.height);
    if width < 3 || height < 3 {
        return 0.0;
    }
    let mut sum = 0_u64;
    for y in 1..height - 1 {
        let (above, row, below) = (image.row(y - 1), image.row(y), image.row(y + 1));
        for x in 1..width - 1 {
            let of = |value: u8| i64::from(value);
            let value = of(above[x]) + of(below[x]) + of(row[x - 1]) + of(row[x + 1]) - 4 * of(row[x]);
            sum += (value * value).unsigned_abs();
        }
    }
    sum as f64 / ((width - 2) * (height - 2)) as f64
}

/// The share of clipped pixels: a channel at 0 or at 255.
pub fn clipped(image: &ColourImage) -> f64 {
    let pixels = image.rgb.as_chunks::<3>().0;
    let count = pixels.iter().filter(|pixel| pixel.contains(&255) || pixel.contains(&0)).count();
    count as f64 / pixels.len().max(1) as f64
}

/// Standard deviation below which a patch of the source shows nothing, in grey levels.
const EMPTY: f64 = 2.0;
/// Pixels from the middle of a patch to its side.
const REACH: i64 = 7;

/// The share of a generated image's keypoints that lie where the source shows nothing (thesis Fig 5.7): (x, y) in
/// pixels. `None` without keypoints.
pub fn hallucinated(source: &GreyImage, keypoints: &[(f32, f32)]) -> Option<f64> {
    let empty = keypoints.iter().filter(|(x, y)| deviation(source, *x as i64, *y as i64) < EMPTY).count();
    (!keypoints.is_empty()).then(|| empty as f64 / keypoints.len() as f64)
}

/// The standard deviation of the patch around a pixel.
fn deviation(image: &GreyImage, x: i64, y: i64) -> f64 {
    let clamped = |value: i64, size: usize| value.clamp(0, size as i64 - 1) as usize;
    let (columns, rows) = (
        clamped(x - REACH, image.width)..=clamped(x + REACH, image.width),
        clamped(y - REACH, image.height)..=clamped(y + REACH, image.height),
    );
    let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for value in rows.flat_map(|y| image.row(y)[columns.clone()].iter()) {
        let value = f64::from(*value);
        (count, sum, squares) = (count + 1.0, sum + value, squares + value * value);
    }
    (squares / count - sum * sum / (count * count)).max(0.0).sqrt()
}

/// Ratios of Laplacian energy within which detail is neither smoothed away nor made up.
const DETAIL: [f64; 2] = [0.5, 2.0];
/// So many more pixels than in the source or in what is mimicked may be clipped, as a share: a dark hour has black
/// shadows of its own.
const CLIPPED: f64 = 0.1;
/// A larger share of keypoints on empty ground is invention.
const INVENTED: f64 = 0.1;
/// The good-match curve dips where the middle has less than this share of what the end still has.
const DIP: f64 = 0.5;

/// Why a generator is to be doubted; empty where it passes.
pub fn doubts(switch: Option<&SwitchIndex>, curve: &[Measures]) -> Vec<String> {
    let mut doubts = Vec::new();
    if let Some(switch) = switch.filter(|switch| switch.switches()) {
        doubts.push(format!(
            "it switches at z = {:.3}: its largest step is {:.1} times the median one, expected at most {}",
            switch.at,
            switch.kappa,
            SwitchIndex::KAPPA_LIMIT
        ));
    }
    let at_least = |from: f64, to: f64| {
        let inside = curve.iter().filter(|m| m.z >= from && m.z <= to);
        inside.map(|m| m.good_matches).min_by(f64::total_cmp)
    };
    if let (Some(middle), Some(end)) = (at_least(SwitchIndex::MIDDLE[0], SwitchIndex::MIDDLE[1]), at_least(0.9, 1.0))
        && middle < DIP * end
    {
        doubts.push(format!("good matches dip in the middle of the way: {middle:.0}, at its end {end:.0}"));
    }
    for m in curve {
        if !(DETAIL[0]..=DETAIL[1]).contains(&m.laplacian_ratio) {
            doubts.push(format!(
                "at z = {} the Laplacian has {:.2} times the source's energy, expected 0.5 to 2",
                m.z, m.laplacian_ratio
            ));
        }
        if m.clipped - m.clipped_target.map_or(m.clipped_source, |target| target.max(m.clipped_source)) > CLIPPED {
            let target = m.clipped_target.map(|target| format!(", {:.0} % in what it mimics", 100.0 * target));
            doubts.push(format!(
                "at z = {} {:.0} % of the pixels are clipped, {:.0} % in the source{}",
                m.z,
                100.0 * m.clipped,
                100.0 * m.clipped_source,
                target.unwrap_or_default()
            ));
        }
        if m.hallucinated > INVENTED {
            doubts.push(format!(
                "at z = {} {:.0} % of the keypoints lie where the source shows nothing",
                m.z,
                100.0 * m.hallucinated
            ));
        }
    }
    doubts
}
