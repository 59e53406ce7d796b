//! `make bench`: how fast images are moved to another hour, and how fast that is learned. One thread.

use crate::row::{Row, cpu_ms, row};
use furrow_model::{ColourImage, GreyImage, StereoRig};
use furrow_runner::generator::{Generator, Moments, Otf, Seed, Shading, Strengths, Suns, Workspace};

/// What is wanted of one image on one core (issue 6).
const SIZES: [(usize, usize, &str, f64); 2] =
    [(640, 360, "optimal-transport flow, 640x360", 15.0), (1280, 720, "optimal-transport flow, 1280x720", 60.0)];

/// Something with detail at all scales, no two seeds alike.
fn image(width: usize, height: usize, seed: usize) -> ColourImage {
    let value = |i: usize| {
        let (x, y) = (i / 3 % width, i / 3 / width);
        let wave = (x as f32 / 37.0 + seed as f32).sin() * (y as f32 / 23.0).cos() + (x as f32 / 5.0).sin() * 0.5;
        (110.0 + 50.0 * wave + ((x * 7919 + y * 104_729 + seed) % 41) as f32 - 20.0).clamp(1.0, 250.0) as u8
    };
    ColourImage { width, height, rgb: (0..3 * width * height).map(value).collect() }
}

/// A flow between two images.
fn flow(a: &ColourImage, b: &ColourImage, strengths: Strengths) -> Option<Generator> {
    let mut workspace = Workspace::default();
    let (source, target) = (Moments::of(a, &mut workspace).ok()?, Moments::of(b, &mut workspace).ok()?);
    Some(Generator::Otf(Box::new(Otf::train(&source, &target, strengths).ok()?)))
}

/// What relighting adds: the shading of a pair, which is the same for every domainness, and its application.
fn relighting(rows: &mut Vec<Row>, a: &ColourImage, b: &ColourImage) {
    let rig = StereoRig { width: 640, height: 360, focal_px: 264.0, cu_px: 319.5, cv_px: 179.5, baseline_m: 0.12 };
    let grey = |shift: usize| {
        let pixel = |i: usize| a.rgb[3 * (i - i % 640 + (i % 640 + shift).min(639))];
        GreyImage { width: 640, height: 360, pixels: (0..640 * 360).map(pixel).collect() }
    };
    let (left, right) = (grey(0), grey(12));
    let suns = Suns { source: [0.7, -0.7, 0.14], target: [-0.7, -0.7, 0.14] };
    let shading = || Shading::of([&left, &right], &rig, suns, (640, 360), Some);
    rows.push(row("the shading of a pair, 640x360", cpu_ms(9, |_| shading().is_ok()), "ms", "none known", None));
    let (Ok(shading), Some(generator)) = (shading(), flow(a, b, Strengths { relight: 1.0, ..Strengths::default() }))
    else {
        return;
    };
    let (mut workspace, seed) = (Workspace::default(), Seed { seed: 1, stamp_ns: 1 });
    let time = cpu_ms(9, |_| generator.apply_lit(a, 0.66, seed, Some(&shading), &mut workspace).is_ok());
    rows.push(row("the flow with the relight stage, 640x360", time, "ms", "wanted: at most", Some(15.0)));
}

pub fn generators(rows: &mut Vec<Row>) {
    let mut workspace = Workspace::default();
    let seed = Seed { seed: 1, stamp_ns: 1 };
    for (width, height, name, wanted) in SIZES {
        let (a, b) = (image(width, height, 1), image(width, height, 2));
        let Some(generator) = flow(&a, &b, Strengths::default()) else { return };
        let time = cpu_ms(19, |_| generator.apply(&a, 0.66, seed, &mut workspace).is_ok());
        rows.push(row(name, time, "ms", "wanted: at most", Some(wanted)));
    }
    let images: Vec<ColourImage> = (0..10).map(|seed| image(640, 360, seed)).collect();
    let Some(staged) = flow(&images[0], &images[1], Strengths { sensor: 1.0, shadow: 1.0, relight: 0.0 }) else {
        return;
    };
    let time = cpu_ms(9, |i| staged.apply(&images[i], 0.66, seed, &mut workspace).is_ok());
    rows.push(row("the same with sensor and shadow stages, 640x360", time, "ms", "none known", None));
    relighting(rows, &images[0], &images[1]);
    let train = |_| {
        let mut all = Moments::default();
        for image in images.iter().cycle().take(100) {
            if let Ok(moments) = Moments::of(image, &mut workspace) {
                all.merge(&moments);
            }
        }
        Otf::train(&all, &all, Strengths::default()).is_ok()
    };
    rows.push(row("its training, 100 images of 640x360", cpu_ms(1, train), "ms", "none known", None));
}
