//! Storage and decoding give back the pixels that went in.

use super::{rows, scene};
use crate::images::{
    BayerPattern, ColourImage, Picture, RawImage, RawPixels, decode_colour, decode_grey, encode_jpeg, inspect,
    store_raw,
};
use furrow_model::GreyImage;
use opencv::core::{MatTraitConst, MatTraitConstManual};

const WIDTH: usize = 37;
const HEIGHT: usize = 23;

fn raw<'a>(encoding: &'a str, step: usize, data: &'a [u8]) -> RawImage<'a> {
    RawImage { width: WIDTH, height: HEIGHT, step, encoding, big_endian: false, data }
}

#[test]
fn colour_encodings_agree() {
    let expected = rows(WIDTH, HEIGHT, 0, scene);
    let mut stored = Vec::new();
    for padding in [0, 5] {
        let three = WIDTH * 3 + padding;
        let four = WIDTH * 4 + padding;
        let reverse = |x, y| {
            let [r, g, b] = scene(x, y);
            [b, g, r]
        };
        let bgra = rows(WIDTH, HEIGHT, padding, |x, y| {
            let [r, g, b] = scene(x, y);
            [b, g, r, 7]
        });
        let rgba = rows(WIDTH, HEIGHT, padding, |x, y| {
            let [r, g, b] = scene(x, y);
            [r, g, b, 200]
        });
        let bgr = rows(WIDTH, HEIGHT, padding, reverse);
        stored.push(store_raw(&raw("rgb8", three, &rows(WIDTH, HEIGHT, padding, scene))).unwrap());
        stored.push(store_raw(&raw("bgr8", three, &bgr)).unwrap());
        stored.push(store_raw(&raw("8UC3", three, &bgr)).unwrap());
        stored.push(store_raw(&raw("rgba8", four, &rgba)).unwrap());
        stored.push(store_raw(&raw("bgra8", four, &bgra)).unwrap());
        stored.push(store_raw(&raw("8UC4", four, &bgra)).unwrap());
    }
    for image in &stored {
        assert_eq!(image, &stored[0], "one scene, one object");
    }
    assert_eq!(
        decode_colour(&stored[0].bytes, None).unwrap(),
        ColourImage { width: WIDTH, height: HEIGHT, rgb: expected }
    );
}

#[test]
fn grey_encodings_keep_their_values() {
    let grey = |x: usize, y: usize| [scene(x, y)[1]];
    let expected = GreyImage::new(WIDTH, HEIGHT, rows(WIDTH, HEIGHT, 0, grey)).unwrap();
    let padded = rows(WIDTH, HEIGHT, 3, grey);
    let without_last_padding = &padded[..padded.len() - 3];
    for encoding in ["mono8", "8UC1"] {
        for data in [&padded[..], without_last_padding] {
            let stored = store_raw(&raw(encoding, WIDTH + 3, data)).unwrap();
            assert_eq!(decode_grey(&stored.bytes, None).unwrap(), expected);
            assert_eq!(inspect(&stored.bytes).map(|header| (header.width, header.colour)).unwrap(), (WIDTH, false));
        }
    }
    let little = rows(WIDTH, HEIGHT, 0, |x, y| [99, grey(x, y)[0]]);
    let big = rows(WIDTH, HEIGHT, 0, |x, y| [grey(x, y)[0], 99]);
    for (data, big_endian) in [(little, false), (big, true)] {
        let stored = store_raw(&RawImage { big_endian, ..raw("mono16", WIDTH * 2, &data) }).unwrap();
        assert_eq!(decode_grey(&stored.bytes, None).unwrap(), expected);
    }
}

#[test]
fn another_decoder_reads_the_same_pixels() {
    let stored = store_raw(&raw("rgb8", WIDTH * 3, &rows(WIDTH, HEIGHT, 0, scene))).unwrap();
    let input = opencv::core::Mat::from_slice(&stored.bytes).unwrap();
    let bgr = opencv::imgcodecs::imdecode(&input, opencv::imgcodecs::IMREAD_COLOR).unwrap();
    let mut pixels = bgr.data_bytes().unwrap().to_vec();
    pixels.chunks_exact_mut(3).for_each(|pixel| pixel.swap(0, 2));
    assert_eq!((bgr.cols(), bgr.rows()), (WIDTH as i32, HEIGHT as i32));
    assert_eq!(pixels, rows(WIDTH, HEIGHT, 0, scene));

    let mut grey = opencv::core::Mat::default();
    opencv::imgproc::cvt_color_def(&bgr, &mut grey, opencv::imgproc::COLOR_BGR2GRAY).unwrap();
    assert_eq!(decode_grey(&stored.bytes, None).unwrap().pixels, grey.data_bytes().unwrap());
}

#[test]
fn mosaics_get_their_colours_when_loaded() {
    let colour = [200u8, 120, 30];
    for (encoding, pattern, letters) in [
        ("bayer_rggb8", BayerPattern::Rggb, [0, 1, 1, 2]),
        ("bayer_bggr8", BayerPattern::Bggr, [2, 1, 1, 0]),
        ("bayer_gbrg8", BayerPattern::Gbrg, [1, 2, 0, 1]),
        ("bayer_grbg8", BayerPattern::Grbg, [1, 0, 2, 1]),
    ] {
        let mosaic = rows(WIDTH, HEIGHT, 0, |x, y| [colour[letters[y % 2 * 2 + x % 2]]]);
        let stored = store_raw(&raw(encoding, WIDTH, &mosaic)).unwrap();
        assert_eq!(stored.bayer, Some(pattern));
        assert_eq!(decode_grey(&stored.bytes, None).unwrap().pixels, mosaic, "the archive holds the mosaic");
        let image = decode_colour(&stored.bytes, stored.bayer).unwrap();
        assert!(image.rgb.chunks_exact(3).all(|pixel| pixel == colour), "{encoding}");
        // 0.299 * 200 + 0.587 * 120 + 0.114 * 30 = 133.66
        assert!(decode_grey(&stored.bytes, stored.bayer).unwrap().pixels.iter().all(|&value| value == 134));
    }
}

#[test]
fn pixels_before_storage_look_as_the_stored_file_does() {
    let colour: Vec<u8> = rows(WIDTH, HEIGHT, 5, scene);
    let mosaic: Vec<u8> = (0..WIDTH * HEIGHT).map(|i| (i * 37 % 251) as u8).collect();
    let grey16: Vec<u8> = (0..2 * WIDTH * HEIGHT).map(|i| (i * 41 % 253) as u8).collect();
    let images = [
        raw("rgb8", WIDTH * 3 + 5, &colour),
        raw("bgr8", WIDTH * 3 + 5, &colour),
        raw("mono8", WIDTH, &mosaic),
        raw("bayer_rggb8", WIDTH, &mosaic),
        raw("mono16", WIDTH * 2, &grey16),
    ];
    for image in &images {
        let pixels = RawPixels::of(image).unwrap();
        let stored = pixels.store().unwrap();
        assert_eq!(stored.bytes, store_raw(image).unwrap().bytes, "{}", image.encoding);
        for bayer in [stored.bayer, None, Some(BayerPattern::Gbrg)] {
            let later = decode_grey(&stored.bytes, bayer).unwrap();
            assert_eq!(pixels.grey(bayer).unwrap(), later, "{} {bayer:?}", image.encoding);
        }
    }
}

#[test]
fn a_jpeg_as_grey_is_its_luma() {
    let rgb = rows(64, 48, 0, |x, y| [(x * 3) as u8, (y * 4) as u8, 90]);
    let image = ColourImage { width: 64, height: 48, rgb };
    let jpeg = encode_jpeg(Picture::Colour(&image), 64, 92).unwrap();
    let grey = decode_grey(&jpeg, None).unwrap();
    for (luma, pixel) in grey.pixels.iter().zip(image.rgb.chunks_exact(3)) {
        let [r, g, b] = [0, 1, 2].map(|channel| f64::from(pixel[channel]));
        let expected = 0.299 * r + 0.587 * g + 0.114 * b;
        assert!((f64::from(*luma) - expected).abs() < 6.0, "Y {luma}, expected {expected}");
    }
    let colour = decode_colour(&jpeg, None).unwrap();
    let error: i64 = colour.rgb.iter().zip(&image.rgb).map(|(&a, &b)| (i64::from(a) - i64::from(b)).abs()).sum();
    assert!(error < 4 * image.rgb.len() as i64, "mean error of {}", error as f64 / image.rgb.len() as f64);
}

#[test]
fn tiles_shrink_but_never_grow() {
    let grey = GreyImage::new(200, 100, vec![77; 20_000]).unwrap();
    for (max_width, expected) in [(50, (50, 25)), (200, (200, 100)), (4000, (200, 100)), (0, (1, 1))] {
        let header = inspect(&encode_jpeg(Picture::Grey(&grey), max_width, 80).unwrap()).unwrap();
        assert_eq!((header.width, header.height, header.colour), (expected.0, expected.1, false));
    }
    let tile = decode_grey(&encode_jpeg(Picture::Grey(&grey), 50, 90).unwrap(), None).unwrap();
    assert!(tile.pixels.iter().all(|value| value.abs_diff(77) <= 1));
}
