//! SURF from an image to its keypoints and their descriptors.

use super::descriptor::Describer;
use super::detect::{find_maxima, strongest_first};
use super::integral::Integral;
use super::keypoint::{Descriptor, Keypoint, SurfParams};
use furrow_model::GreyImage;
use rayon::prelude::*;

/// Keypoints in falling order of response, and the descriptor of each.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Features {
    /// The keypoints.
    pub keypoints: Vec<Keypoint>,
    /// As many descriptors as keypoints, in the same order.
    pub descriptors: Vec<Descriptor>,
}

/// Keypoints that one task describes: enough to be worth its start, few enough for many cores.
const KEYPOINTS_PER_TASK: usize = 32;

/// Keypoints and descriptors of `image`: sums, maxima, orientation, description. An image too small for a filter has
/// none.
pub fn surf(image: &GreyImage, params: &SurfParams) -> Features {
    let described = on_keypoints(image, params, |describer, keypoint| describer.describe(keypoint));
    let (keypoints, descriptors) = described.into_iter().unzip();
    Features { keypoints, descriptors }
}

/// The keypoints of [`surf`] alone, their angles included.
pub fn detect(image: &GreyImage, params: &SurfParams) -> Vec<Keypoint> {
    on_keypoints(image, params, |_, _| ()).into_iter().map(|(keypoint, ())| keypoint).collect()
}

/// The keypoints of `image` with their angles and the result of `work` on each, in falling order of response.
fn on_keypoints<T: Send>(
    image: &GreyImage,
    params: &SurfParams,
    work: impl Fn(&Describer<'_>, &Keypoint) -> T + Sync,
) -> Vec<(Keypoint, T)> {
    in_pool(|| {
        let (integral, describer) = rayon::join(|| Integral::of(image), || Describer::new(image, params.upright));
        let one = |keypoint: &Keypoint| {
            let keypoint = describer.orient(&integral, *keypoint)?;
            Some((keypoint, work(&describer, &keypoint)))
        };
        let maxima = find_maxima(&integral, params);
        let tasks = maxima.par_chunks(KEYPOINTS_PER_TASK).map(|task| task.iter().filter_map(one).collect());
        let done: Vec<Vec<(Keypoint, T)>> = tasks.collect();
        let mut done: Vec<(Keypoint, T)> = done.into_iter().flatten().collect();
        done.sort_by(|a, b| strongest_first(&a.0, &b.0));
        done
    })
}

/// The descriptors of `keypoints`, wherever they come from, in `image`. With `upright` the keypoints' angles are not
/// looked at. Windows reach over the image's edge by repeating its outermost pixels. An empty image gives zero
/// descriptors.
pub fn describe(image: &GreyImage, keypoints: &[Keypoint], upright: bool) -> Vec<Descriptor> {
    in_pool(|| {
        let describer = Describer::new(image, upright);
        let by_task = keypoints.par_iter().with_min_len(KEYPOINTS_PER_TASK);
        by_task.map(|keypoint| describer.describe(keypoint)).collect()
    })
}

/// Runs `work` on a thread of the pool, so that its parallel parts need not each be handed over to the pool and waited
/// for.
fn in_pool<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    rayon::scope(|_| work())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(width: usize, height: usize) -> GreyImage {
        let wave = |i: usize, of: f32| ((i as f32 / of).sin() * 50.0) as i32;
        let grey = |i: usize| 128 + wave(i % width, 5.3) + wave(i / width, 4.1) + (i * i / 7 % 23) as i32;
        GreyImage::new(width, height, (0..width * height).map(|i| grey(i) as u8).collect()).unwrap()
    }

    #[test]
    fn images_of_any_size_and_parameters_do_not_panic() {
        for (width, height) in [(0, 0), (1, 1), (9, 9), (1, 300), (40, 12), (33, 33), (64, 47)] {
            let image = noise(width, height);
            for (octaves, layers) in [(0, 3), (1, 0), (1, 1), (4, 3), (300, 9)] {
                for upright in [false, true] {
                    let params = SurfParams { hessian_threshold: 0.0, octaves, layers, upright };
                    let features = surf(&image, &params);
                    assert_eq!(features.keypoints, detect(&image, &params));
                    assert_eq!(features.descriptors, describe(&image, &features.keypoints, upright));
                    assert!(width.min(height) > 15 || features.keypoints.is_empty());
                }
            }
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let image = noise(200, 150);
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| surf(&image, &SurfParams::GOLDEN))
        };
        let alone = on(1);
        assert!(alone.keypoints.len() > 20, "{}", alone.keypoints.len());
        assert_eq!(alone, on(3));
    }

    /// A dark disc: one keypoint in its middle, as large as the disc, with a positive trace.
    #[test]
    fn a_dark_disc_is_found_where_it_is() {
        let inside = |x: i32, y: i32| (x - 60) * (x - 60) + (y - 50) * (y - 50) <= 64;
        let pixels = (0..100).flat_map(|y| (0..120).map(move |x| if inside(x, y) { 40 } else { 200 })).collect();
        let keypoints = detect(&GreyImage::new(120, 100, pixels).unwrap(), &SurfParams::GOLDEN);
        let strongest = keypoints[0];
        assert!((strongest.x_px - 60.0).abs() < 0.5 && (strongest.y_px - 50.0).abs() < 0.5, "{strongest:?}");
        assert_eq!(strongest.laplacian_sign, 1);
    }
}
