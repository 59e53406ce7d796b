//! Optimal-transport flow on images whose answer is known.

use crate::{field, image, largest_difference, moments, moved, trained};
use furrow_generator::{GenerateError, Generator, Moments, Otf, Strengths, Workspace};
use furrow_model::ColourImage;
use proptest::prelude::*;
use rayon::prelude::*;

fn light(level: u8) -> f64 {
    (f64::from(level) / 255.0).powf(2.2)
}

fn level(light: f64) -> u8 {
    (255.0 * light.clamp(0.0, 1.0).powf(1.0 / 2.2)).round() as u8
}

/// The image under a lamp of these colours.
fn under(image: &ColourImage, lamp: [f64; 3]) -> ColourImage {
    let rgb = image
        .rgb
        .chunks_exact(3)
        .flat_map(|pixel| (0..3).map(|c| level(lamp[c] * light(pixel[c]))).collect::<Vec<_>>());
    ColourImage { rgb: rgb.collect(), ..image.clone() }
}

/// Another lamp is learned as such: the image moved to z = 1 is the image under that lamp.
#[test]
fn another_lamp_is_learned() {
    let day: Vec<ColourImage> = (0..3).map(|seed| field(320, 180, seed)).collect();
    let evening: Vec<ColourImage> = day.iter().map(|image| under(image, [0.8, 0.55, 0.4])).collect();
    let flow = trained(&day, &evening, Strengths::default());
    let unseen = field(320, 180, 9);
    let (found, wanted) = (moved(&flow, &unseen, 1.0), under(&unseen, [0.8, 0.55, 0.4]));
    let mean = furrow_generator::quality::mean_step(&found, &wanted);
    assert!(mean < 1.5 && mean * 4.0 < furrow_generator::quality::mean_step(&unseen, &wanted), "{mean}");
    // Half the way in logarithms is the root of the lamp.
    let half = under(&unseen, [0.8_f64.sqrt(), 0.55_f64.sqrt(), 0.4_f64.sqrt()]);
    assert!(furrow_generator::quality::mean_step(&moved(&flow, &unseen, 0.5), &half) < 1.5);
}

/// Images of one colour each, their logarithms of light from a Gaussian with this mean of red, green and blue, and this
/// mixing.
fn colours(mean: [f64; 3], mix: [[f64; 3]; 3], count: u64) -> Vec<ColourImage> {
    let chance = |i: u64| {
        let bits =
            (0..12).map(|k| (i * 12 + k).wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_mul(i * 12 + k + 77) >> 40);
        bits.map(|bits| bits as f64 / (1 << 24) as f64).sum::<f64>() - 6.0
    };
    let colour = |i: u64| {
        let n = [chance(3 * i), chance(3 * i + 1), chance(3 * i + 2)];
        let pixel = [0, 1, 2].map(|c| level((mean[c] + (0..3).map(|k| mix[c][k] * n[k]).sum::<f64>()).exp()));
        image(48, 30, |_, _| pixel)
    };
    (0..count).map(colour).collect()
}

/// Mean and covariance of the logarithms of light of images of one colour each.
fn gaussian(images: &[ColourImage]) -> ([f64; 3], [[f64; 3]; 3]) {
    let logs: Vec<[f64; 3]> =
        images.iter().map(|image| [0, 1, 2].map(|c| (light(image.rgb[c]) + 7.8e-4).ln())).collect();
    let mean_of = |of: &dyn Fn(&[f64; 3]) -> f64| logs.iter().map(of).sum::<f64>() / logs.len() as f64;
    let mean = [0, 1, 2].map(|c| mean_of(&|log| log[c]));
    let covariance = [0, 1, 2].map(|i| [0, 1, 2].map(|j| mean_of(&|log| (log[i] - mean[i]) * (log[j] - mean[j]))));
    (mean, covariance)
}

/// The Gaussian that is pushed forward to z = 1 is the target's: its mean, and its covariance up to what the ridge of
/// 0.02 takes.
#[test]
fn the_pushed_forward_gaussian_is_that_of_the_target() {
    let source = colours([-2.0, -1.9, -2.4], [[0.45, 0.0, 0.0], [0.4, 0.25, 0.0], [0.3, 0.1, 0.3]], 120);
    let target = colours([-2.6, -2.2, -1.9], [[0.3, 0.2, 0.0], [0.35, 0.0, 0.2], [0.4, 0.0, -0.25]], 120);
    let flow = trained(&source, &target, Strengths::default());
    let made: Vec<ColourImage> = source.iter().map(|image| moved(&flow, image, 1.0)).collect();
    let (before, wanted, found) = (gaussian(&source), gaussian(&target), gaussian(&made));
    for i in 0..3 {
        assert!((found.0[i] - wanted.0[i]).abs() < 0.02, "means {:?} {:?}", found.0, wanted.0);
        for j in 0..3 {
            assert!((found.1[i][j] - wanted.1[i][j]).abs() < 0.025, "{:?} {:?} {:?}", found.1, wanted.1, before.1);
        }
    }
}

/// Where all is blown out there is nothing to learn, and that is said; other empty cells follow the whole image.
#[test]
fn blown_out_pixels_teach_nothing() {
    let white = image(64, 40, |_, _| [255; 3]);
    let half = image(64, 40, |x, _| if x < 20 { [80, 120, 60] } else { [255; 3] });
    let wrong =
        Otf::train(&moments(std::slice::from_ref(&white)), &moments(std::slice::from_ref(&half)), Strengths::default());
    assert_eq!(wrong, Err(GenerateError::NoPixels { domain: "source" }));
    let flow = trained(std::slice::from_ref(&half), &[half.clone(), white], Strengths::default());
    assert!(largest_difference(&moved(&flow, &half, 1.0), &half) <= 1);
}

#[test]
fn any_number_of_threads_and_one_order_give_the_same_bytes() {
    let images: Vec<ColourImage> = (0..12).map(|seed| field(160, 90, seed)).collect();
    let train = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let each: Vec<Moments> = pool.install(|| {
            images
                .par_iter()
                .map_init(Workspace::default, |workspace, image| Moments::of(image, workspace).unwrap())
                .collect()
        });
        let (mut source, mut target) = (Moments::default(), Moments::default());
        each[..6].iter().for_each(|moments| source.merge(moments));
        each[6..].iter().for_each(|moments| target.merge(moments));
        let otf = Otf::train(&source, &target, Strengths { sensor: 1.0, shadow: 1.0, ..Strengths::default() }).unwrap();
        let json = serde_json::to_string(&otf).unwrap();
        let flow = Generator::Otf(Box::new(otf));
        let made: Vec<ColourImage> =
            pool.install(|| images.par_iter().map(|image| moved(&flow, image, 0.66)).collect());
        (json, made)
    };
    let alone = train(1);
    assert_eq!(alone, train(2));
    assert_eq!(alone, train(5));
}

#[test]
fn a_model_is_its_bytes() {
    let flow = trained(
        &[field(80, 50, 1)],
        &[field(80, 50, 2)],
        Strengths { sensor: 0.5, shadow: 0.5, ..Strengths::default() },
    );
    let back: Generator = serde_json::from_str(&serde_json::to_string(&flow).unwrap()).unwrap();
    assert_eq!(back, flow);
    let Generator::Otf(mut otf) = flow else { panic!("trained as otf") };
    otf.cells.pop();
    let wrong = Generator::Otf(otf).apply(&field(8, 8, 1), 1.0, crate::NO_CHANCE, &mut Workspace::default());
    assert!(matches!(wrong, Err(GenerateError::Damaged(_))), "{wrong:?}");
}

#[test]
fn the_shadow_stage_deepens_shadows_where_the_target_has_deeper_ones() {
    let stripes = |dark: u8| {
        image(320, 200, move |x, y| if (x / 40 + y / 40) % 2 == 0 { [150, 160, 120] } else { [dark, dark, dark - 10] })
    };
    let (soft, hard) = (stripes(110), stripes(50));
    let mean_of_dark = |image: &ColourImage| {
        let dark =
            image.rgb.iter().zip(&soft.rgb).filter(|(_, before)| **before < 115).map(|(after, _)| f64::from(*after));
        dark.clone().sum::<f64>() / dark.count() as f64
    };
    let at = |shadow: f64| {
        let flow = trained(
            std::slice::from_ref(&soft),
            std::slice::from_ref(&hard),
            Strengths { sensor: 0.0, shadow, ..Strengths::default() },
        );
        mean_of_dark(&moved(&flow, &soft, 1.0))
    };
    assert!(at(0.5) < at(0.0) - 3.0, "{} {}", at(0.5), at(0.0));
    let flow = trained(
        std::slice::from_ref(&soft),
        std::slice::from_ref(&hard),
        Strengths { sensor: 0.0, shadow: 0.5, ..Strengths::default() },
    );
    assert!(largest_difference(&moved(&flow, &soft, 0.0), &soft) <= 1);
}

#[test]
fn the_sensor_stage_brings_the_noise_of_the_target() {
    let still = image(320, 200, |x, _| [90 + (x / 8) as u8, 110 + (x / 8) as u8, 80]);
    let noisy = moved(&Generator::Noise(8.0), &still, 1.0);
    let strengths = |sensor: f64| Strengths { sensor, shadow: 0.0, ..Strengths::default() };
    let flow = |sensor: f64| trained(std::slice::from_ref(&still), std::slice::from_ref(&noisy), strengths(sensor));
    let Generator::Otf(otf) = flow(1.0) else { panic!("trained as otf") };
    assert!((otf.noise.target - 8.0).abs() < 0.8 && otf.noise.source < 0.5, "{:?}", otf.noise);
    let rms = |a: &ColourImage, b: &ColourImage| {
        let squares: f64 = a.rgb.iter().zip(&b.rgb).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
        (squares / a.rgb.len() as f64).sqrt()
    };
    let added = rms(&moved(&flow(1.0), &still, 1.0), &moved(&flow(0.0), &still, 1.0));
    assert!((added - 8.0).abs() < 1.0, "{added}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// Any image of any size: z = 0 is the image to within a grey level, and no allowed z fails.
    #[test]
    fn nothing_moves_at_zero(width in 1_usize..50, height in 1_usize..40, z in -0.5..2.0, values in proptest::collection::vec(any::<u8>(), 3 * 50 * 40)) {
        let of = |from: usize| ColourImage { width, height, rgb: values.iter().cycle().skip(from).take(3 * width * height).copied().collect() };
        let (a, b) = (of(0), of(1777));
        let sums = (moments(std::slice::from_ref(&a)), moments(std::slice::from_ref(&b)));
        let Ok(otf) = Otf::train(&sums.0, &sums.1, Strengths { sensor: 1.0, shadow: 1.0, ..Strengths::default() }) else { return Ok(()) };
        let flow = Generator::Otf(Box::new(otf));
        prop_assert!(largest_difference(&moved(&flow, &a, 0.0), &a) <= 1);
        prop_assert_eq!(moved(&flow, &a, z).rgb.len(), a.rgb.len());
    }
}
