//! The relight stage on a lane between two walls, drawn by rays under known suns: geometry, light and answer are all
//! known.

use crate::{NO_CHANCE, image, largest_difference, moved, trained};
use furrow_generator::quality::{mean_step, switch_ladder};
use furrow_generator::{GenerateError, Generator, Shading, Strengths, Suns, Workspace};
use furrow_model::{ColourImage, GreyImage, StereoRig, SwitchIndex};

const RIG: StereoRig =
    StereoRig { width: 640, height: 360, focal_px: 264.0, cu_px: 319.5, cv_px: 179.5, baseline_m: 0.12 };
/// Unit vectors to suns that stand 45 degrees high: right, left.
const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;
const RIGHT: [f64; 3] = [HALF, -HALF, 0.0];
const LEFT: [f64; 3] = [-HALF, -HALF, 0.0];
/// What the sun sends through 1.41 air masses, 0.7^(1.41^0.678), and what a clear sky adds.
const SUN: f64 = 0.637;
const SKY: f64 = 0.15;

/// The surfaces of the lane: a normal and how far the plane lies from the camera, metres. The ground, a wall on the
/// left, one on the right.
const SURFACES: [([f64; 3], f64); 3] = [([0.0, -1.0, 0.0], 0.75), ([1.0, 0.0, 0.0], 1.6), ([-1.0, 0.0, 0.0], 1.6)];

/// The surface that a camera `x_m` to the right of the left one sees at a pixel, and where.
fn seen(x_m: f64, u: f64, v: f64) -> Option<(usize, [f64; 3])> {
    let ray = [(u - RIG.cu_px) / RIG.focal_px, (v - RIG.cv_px) / RIG.focal_px, 1.0];
    let hit = |(i, (normal, far)): (usize, &([f64; 3], f64))| {
        let towards: f64 = normal.iter().zip(ray).map(|(n, r)| n * r).sum();
        let depth = -(far + normal[0] * x_m) / towards;
        (towards < 0.0 && depth > 0.0).then(|| (i, [x_m + depth * ray[0], depth * ray[1], depth]))
    };
    let hits = SURFACES.iter().enumerate().filter_map(hit);
    hits.min_by(|a, b| a.1[2].total_cmp(&b.1[2])).filter(|(_, at)| at[2] < 9.0)
}

/// What a surface reflects there: blotches of several sizes.
fn albedo([x, y, z]: [f64; 3]) -> f64 {
    let wave = |size: f64, a: f64, b: f64, c: f64| ((a * x + b * y + c * z) / size).sin();
    0.3 + 0.08 * wave(0.11, 1.0, 1.3, 0.7) + 0.07 * wave(0.05, 0.6, -1.0, 1.0) + 0.05 * wave(0.027, 1.0, 0.8, -0.9)
}

fn light_on(surface: usize, sun: [f64; 3]) -> f64 {
    let facing: f64 = SURFACES[surface].0.iter().zip(sun).map(|(n, s)| n * s).sum();
    SKY + SUN * facing.max(0.0)
}

fn drawn(x_m: f64, sun: [f64; 3]) -> ColourImage {
    image(640, 360, |u, v| {
        let light = seen(x_m, u as f64, v as f64).map_or(0.5, |(surface, at)| albedo(at) * light_on(surface, sun));
        [(255.0 * light.min(1.0).powf(1.0 / 2.2)).round() as u8; 3]
    })
}

fn grey(image: &ColourImage) -> GreyImage {
    GreyImage {
        width: image.width,
        height: image.height,
        pixels: image.rgb.as_chunks::<3>().0.iter().map(|pixel| pixel[0]).collect(),
    }
}

/// The lane under the sun on the right, and what moves it to the sun on the left.
fn lane() -> (ColourImage, Shading) {
    let (left, right) = (drawn(0.0, RIGHT), drawn(RIG.baseline_m, RIGHT));
    let suns = Suns { source: RIGHT, target: LEFT };
    let shading = Shading::of([&grey(&left), &grey(&right)], &RIG, suns, (640, 360), Some).unwrap();
    (left, shading)
}

/// A flow that changes nothing but the light.
fn relighting(image: &ColourImage) -> Generator {
    let domain = std::slice::from_ref(image);
    trained(domain, domain, Strengths { relight: 1.0, ..Strengths::default() })
}

fn lit(generator: &Generator, image: &ColourImage, z: f64, shading: &Shading) -> ColourImage {
    generator.apply_lit(image, z, NO_CHANCE, Some(shading), &mut Workspace::default()).unwrap()
}

/// The mean change of a surface's brightness, in logarithms of light, nearer than 5 m and away from the image's edge.
fn change(surface: usize, from: &ColourImage, to: &ColourImage) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (u, v) in (20..340).flat_map(|v| (40..600).map(move |u| (u, v))) {
        if seen(0.0, u as f64, v as f64).is_some_and(|(i, at)| i == surface && at[2] < 5.0) {
            let level = |image: &ColourImage| f64::from(image.rgb[3 * (v * 640 + u)]).max(1.0);
            sum += 2.2 * (level(to) / level(from)).ln();
            count += 1.0;
        }
    }
    sum / count
}

/// The factor of a wall is held to 2 and 1/2: here the light's own is 5 either way. The ground, equally lit, stays as
/// it is; and the image comes nearer to the one that was drawn under the other sun.
#[test]
fn walls_change_as_the_sun_crosses_the_lane() {
    let (image, shading) = lane();
    let generator = relighting(&image);
    let made = lit(&generator, &image, 1.0, &shading);
    let wanted = drawn(0.0, LEFT);
    for (surface, wanted, within) in [(0, 0.0, 0.06), (1, -2.0_f64.ln(), 0.15), (2, 2.0_f64.ln(), 0.15)] {
        let found = change(surface, &image, &made);
        assert!((found - wanted).abs() < within, "surface {surface}: {found}, wanted {wanted}");
    }
    let (before, after) = (mean_step(&image, &wanted), mean_step(&made, &wanted));
    assert!(after < 0.7 * before, "{after} of {before}");
    let back = Suns { source: LEFT, target: LEFT };
    let (left, right) = (grey(&image), grey(&drawn(RIG.baseline_m, RIGHT)));
    let still = Shading::of([&left, &right], &RIG, back, (640, 360), Some).unwrap();
    assert_eq!(lit(&generator, &image, 1.0, &still), moved(&trained_flat(&image), &image, 1.0), "one sun, no change");
}

fn trained_flat(image: &ColourImage) -> Generator {
    trained(std::slice::from_ref(image), std::slice::from_ref(image), Strengths::default())
}

/// A small turn of the sun is told exactly: the factor on both walls is that of the two lights, by the cosine's law.
#[test]
fn the_factor_is_the_ratio_of_the_lights() {
    // Elevation stays; the azimuth turns so that the right wall's cosine falls from 0.707 sin 30 to 0.707 sin 20
    // degrees.
    let sun = |azimuth_deg: f64| {
        let (sin, cos) = azimuth_deg.to_radians().sin_cos();
        [-HALF * sin, -HALF, HALF * cos]
    };
    let (source, target) = (sun(30.0), sun(20.0));
    let pair = [grey(&drawn(0.0, source)), grey(&drawn(RIG.baseline_m, source))];
    let shading = Shading::of([&pair[0], &pair[1]], &RIG, Suns { source, target }, (640, 360), Some).unwrap();
    let wanted = light_on(2, target) / light_on(2, source);
    let found = shading.factor([0.87, 0.45]);
    assert!((found / wanted - 1.0).abs() < 0.05 && wanted < 0.85, "{found} {wanted}");
    assert!((shading.factor([0.13, 0.45]) - 1.0).abs() < 0.05, "the left wall is in shade under both");
}

#[test]
fn at_zero_nothing_is_relit_and_no_step_is_a_jump() {
    let (image, shading) = lane();
    let generator = relighting(&image);
    assert!(largest_difference(&lit(&generator, &image, 0.0, &shading), &image) <= 1);
    let images: Vec<ColourImage> = switch_ladder().iter().map(|z| lit(&generator, &image, *z, &shading)).collect();
    let steps: Vec<f64> = images.windows(2).map(|pair| mean_step(&pair[0], &pair[1])).collect();
    let switch = SwitchIndex::of(&steps).unwrap();
    assert!(switch.kappa < 2.0, "{switch:?}");
}

/// Without texture nothing is known of a surface, so nothing is changed; without a shading a generator that relights
/// says so.
#[test]
fn what_is_not_known_is_left_alone_or_said() {
    let (image, shading) = lane();
    let generator = relighting(&image);
    let blank = GreyImage { width: 640, height: 360, pixels: vec![128; 640 * 360] };
    let suns = Suns { source: RIGHT, target: LEFT };
    let unknown = Shading::of([&blank, &blank], &RIG, suns, (640, 360), Some).unwrap();
    let flat = moved(&trained_flat(&image), &image, 1.0);
    assert_eq!(lit(&generator, &image, 1.0, &unknown), flat);
    assert_eq!(lit(&trained_flat(&image), &image, 1.0, &shading), flat, "not asked to relight");
    let wrong = generator.apply(&image, 1.0, NO_CHANCE, &mut Workspace::default());
    assert_eq!(wrong, Err(GenerateError::NoShading));
    let small = GreyImage { width: 64, height: 36, pixels: vec![0; 64 * 36] };
    let wrong = Shading::of([&small, &small], &RIG, suns, (640, 360), Some);
    assert_eq!(wrong, Err(GenerateError::Pair { expected: (640, 360), found: (64, 36) }));
}

/// A pixel that the stored image has elsewhere is relit there.
#[test]
fn the_field_lies_where_the_stored_image_has_the_surface() {
    let pair = [grey(&drawn(0.0, RIGHT)), grey(&drawn(RIG.baseline_m, RIGHT))];
    let suns = Suns { source: RIGHT, target: LEFT };
    let mirrored = |[u, v]: [f64; 2]| Some([639.0 - u, v]);
    let plain = Shading::of([&pair[0], &pair[1]], &RIG, suns, (640, 360), Some).unwrap();
    let turned = Shading::of([&pair[0], &pair[1]], &RIG, suns, (640, 360), mirrored).unwrap();
    for across in [0.11, 0.31, 0.87] {
        let (a, b) = (plain.factor([across, 0.5]), turned.factor([1.0 - across, 0.5]));
        assert!((a - b).abs() < 1e-6, "{across}: {a} {b}");
    }
    let none = Shading::of([&pair[0], &pair[1]], &RIG, suns, (640, 360), |_| None).unwrap();
    assert!((none.factor([0.87, 0.5]) - 1.0).abs() < 1e-9);
}
