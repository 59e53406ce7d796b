//! Generators against closed forms, other programs' arithmetic and real photographs.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod flow;
mod others;
mod photographs;
mod quality;
mod relight;
mod transport;

#[path = "../../../../tests/support/golden_data.rs"]
mod golden_data;

use furrow_generator::{Generator, Moments, Otf, Seed, Strengths, Workspace};
use furrow_model::ColourImage;

/// For generators without chance.
pub const NO_CHANCE: Seed = Seed { seed: 0, stamp_ns: 0 };

/// An image of a function of column and row.
pub fn image(width: usize, height: usize, of: impl Fn(usize, usize) -> [u8; 3]) -> ColourImage {
    let rgb = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).flat_map(|(x, y)| of(x, y)).collect();
    ColourImage { width, height, rgb }
}

/// Something like a field: blotches of several sizes in shades of green and brown, no two seeds alike.
pub fn field(width: usize, height: usize, seed: usize) -> ColourImage {
    image(width, height, |x, y| {
        let wave = |period: f64, phase: usize| {
            ((x as f64 + (seed * phase) as f64) / period).sin() * ((y as f64 * 1.3 - seed as f64) / period).cos()
        };
        let grain = ((x * 7919 + y * 104_729 + seed * 31) % 97) as f64 / 97.0;
        let brightness = 0.4 + 0.15 * wave(31.0, 3) + 0.1 * wave(9.0, 5) + 0.15 * grain;
        [0.8, 1.0, 0.5 + 0.2 * wave(47.0, 2)].map(|share| (255.0 * brightness * share).clamp(2.0, 250.0) as u8)
    })
}

/// The sums of several images, merged in their order.
pub fn moments(images: &[ColourImage]) -> Moments {
    let (mut all, mut workspace) = (Moments::default(), Workspace::default());
    images.iter().for_each(|image| all.merge(&Moments::of(image, &mut workspace).unwrap()));
    all
}

/// The flow from one set of images to another.
pub fn trained(source: &[ColourImage], target: &[ColourImage], strengths: Strengths) -> Generator {
    Generator::Otf(Box::new(Otf::train(&moments(source), &moments(target), strengths).unwrap()))
}

/// `image` moved by `z`, without chance.
pub fn moved(generator: &Generator, image: &ColourImage, z: f64) -> ColourImage {
    generator.apply(image, z, NO_CHANCE, &mut Workspace::default()).unwrap()
}

/// The largest difference of any value.
pub fn largest_difference(a: &ColourImage, b: &ColourImage) -> u8 {
    assert_eq!((a.width, a.height, a.rgb.len()), (b.width, b.height, b.rgb.len()));
    a.rgb.iter().zip(&b.rgb).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}
