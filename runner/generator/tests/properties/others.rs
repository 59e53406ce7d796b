//! The invariant image and the placebos.

use crate::{NO_CHANCE, field, image, largest_difference, moved};
use furrow_generator::quality::mean_step;
use furrow_generator::{GenerateError, Generator, Seed, Workspace, placebo_set};
use furrow_model::ColourImage;

/// Surfaces under black bodies of several temperatures, seen by narrow bands at 450, 540 and 610 nm (Wien's law).
fn under_black_body(kelvin: f64) -> ColourImage {
    const HC_OVER_K_NM: f64 = 1.4388e7;
    let light_of = |nm: f64| (nm / 540.0).powi(-5) * (-HC_OVER_K_NM / kelvin * (1.0 / nm - 1.0 / 540.0)).exp();
    image(64, 64, |x, y| {
        let surface =
            [0.15 + 0.3 * x as f64 / 64.0, 0.2 + 0.2 * y as f64 / 64.0, 0.2 + 0.1 * ((x + y) % 7) as f64 / 7.0];
        let lamp = [light_of(610.0), light_of(540.0), light_of(450.0)];
        std::array::from_fn(|c| (255.0 * (0.9 * surface[c] * lamp[c]).min(0.98).powf(1.0 / 2.2)).round() as u8)
    })
}

#[test]
fn the_invariant_image_does_not_change_with_the_lamp() {
    let generator = Generator::named("invariant").unwrap().unwrap();
    let (warm, cold) = (under_black_body(4000.0), under_black_body(6500.0));
    let plain = mean_step(&warm, &cold);
    let invariant = mean_step(&moved(&generator, &warm, 1.0), &moved(&generator, &cold, 1.0));
    assert!(plain > 15.0 && invariant < 3.0, "{plain} {invariant}");
    assert!(largest_difference(&moved(&generator, &warm, 0.0), &warm) <= 1);
    let surfaces = moved(&generator, &warm, 1.0);
    let (least, most) = (surfaces.rgb.iter().min().unwrap(), surfaces.rgb.iter().max().unwrap());
    assert!(most - least > 40, "surfaces still differ: {least} to {most}");
}

#[test]
fn placebos_do_what_their_names_say() {
    let photo = field(200, 120, 4);
    assert_eq!(moved(&Generator::Identity, &photo, 1.0), photo);
    // 255 (128/255)^0.8 = 146.9; the square of 51/255 is 10.2/255.
    let flat = |level: u8| image(4, 4, |_, _| [level; 3]);
    assert_eq!(moved(&Generator::Gamma(0.8), &flat(128), 1.0), flat(147));
    assert_eq!(moved(&Generator::Gamma(2.0), &flat(51), 1.0), flat(10));
    let noisy = moved(&Generator::Noise(3.0), &image(200, 200, |_, _| [128; 3]), 1.0);
    let differences: Vec<f64> = noisy.rgb.iter().map(|value| f64::from(*value) - 128.0).collect();
    let mean = differences.iter().sum::<f64>() / differences.len() as f64;
    let deviation = (differences.iter().map(|d| d * d).sum::<f64>() / differences.len() as f64).sqrt();
    assert!(mean.abs() < 0.05 && (deviation - 3.0).abs() < 0.1, "{mean} {deviation}");
    assert_eq!(moved(&Generator::Blur(3.0), &flat(77), 1.0), flat(77));
    let edge = image(640, 4, |x, _| if x < 320 { [0; 3] } else { [200; 3] });
    let blurred = moved(&Generator::Blur(2.0), &edge, 1.0);
    // 1.75 deviations from an edge, a normal distribution has 4.0 % of the 200 left.
    assert!((7..=9).contains(&blurred.rgb[3 * 316]), "{}", blurred.rgb[3 * 316]);
    for name in ["identity", "gamma:0.8", "noise:3", "blur:0.8"] {
        let placebo = Generator::named(name).unwrap().unwrap();
        assert!(placebo.is_placebo() && placebo.name() == name);
        assert_eq!(moved(&placebo, &photo, 0.0), photo, "{name} at z = 0");
    }
}

#[test]
fn chance_comes_from_the_seed_and_the_stamp_alone() {
    let photo = field(64, 40, 1);
    let with = |seed, stamp_ns| {
        Generator::Noise(5.0).apply(&photo, 1.0, Seed { seed, stamp_ns }, &mut Workspace::default()).unwrap()
    };
    assert_eq!(with(1, 10), with(1, 10));
    assert_ne!(with(1, 10), with(2, 10));
    assert_ne!(with(1, 10), with(1, 11));
}

#[test]
fn a_placebo_set_has_as_many_different_members_as_asked() {
    for n in 0..14 {
        let set = placebo_set(n);
        let names: std::collections::BTreeSet<String> = set.iter().map(Generator::name).collect();
        assert!(set.len() == n && names.len() == n && set.iter().all(Generator::is_placebo), "{names:?}");
        assert!(set.iter().all(|placebo| *placebo == Generator::named(&placebo.name()).unwrap().unwrap()));
    }
    let three: Vec<String> = placebo_set(3).iter().map(Generator::name).collect();
    assert_eq!(three, ["gamma:0.8", "gamma:1.25", "noise:3"]);
}

#[test]
fn nonsense_is_refused_in_words() {
    let photo = field(8, 8, 1);
    for z in [-0.51, 2.01, f64::NAN, f64::INFINITY] {
        let wrong = Generator::Identity.apply(&photo, z, NO_CHANCE, &mut Workspace::default());
        assert!(matches!(wrong, Err(GenerateError::Domainness { .. })), "{z}");
    }
    for (width, height, values) in [(8, 8, 191), (0, 0, 0), (usize::MAX, 2, 6)] {
        let wrong = ColourImage { width, height, rgb: vec![0; values] };
        let error = Generator::Identity.apply(&wrong, 1.0, NO_CHANCE, &mut Workspace::default());
        assert!(matches!(error, Err(GenerateError::Size { .. })), "{width} x {height}");
    }
    for name in ["gamma:0", "gamma:x", "noise:-1", "noise:1e9", "blur:nan"] {
        assert!(matches!(Generator::named(name), Some(Err(GenerateError::Parameter { .. }))), "{name}");
    }
    for name in ["", "otf", "sepia", "identity:3"] {
        assert!(Generator::named(name).is_none(), "{name}");
    }
}
