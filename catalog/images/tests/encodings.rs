//! Every encoding brings back the picture that was put into it, within what the encoding itself loses. The other
//! direction is written here by the published formulas, in floating point.

use crate::images::encoding::readable_encodings;
use crate::images::{Depth, LoosePixels, RawImage, RawPixels, SeenPixels, decode_colour, decode_grey, store_raw};
use proptest::prelude::*;

const WIDTH: usize = 12;
const HEIGHT: usize = 6;

/// A picture whose colours are equal in blocks of 2 x 2, so that shared colour differences lose nothing.
#[derive(Debug, Clone)]
struct Blocks(Vec<[u8; 3]>);

impl Blocks {
    fn at(&self, x: usize, y: usize) -> [u8; 3] {
        self.0[y / 2 * (WIDTH / 2) + x / 2]
    }

    fn rgb(&self) -> Vec<u8> {
        (0..WIDTH * HEIGHT).flat_map(|i| self.at(i % WIDTH, i / WIDTH)).collect()
    }
}

fn blocks() -> impl Strategy<Value = Blocks> {
    prop::collection::vec(any::<[u8; 3]>(), WIDTH / 2 * HEIGHT / 2).prop_map(Blocks)
}

/// JFIF 1.02: luma and colour differences of the full range.
fn yuv([r, g, b]: [u8; 3]) -> [u8; 3] {
    let [r, g, b] = [r, g, b].map(f64::from);
    let y = 0.299 * r + 0.587 * g + 0.114 * b;
    [y, (b - y) / 1.772 + 128.0, (r - y) / 1.402 + 128.0].map(|value| value.round().clamp(0.0, 255.0) as u8)
}

/// The picture's bytes in a YUV encoding, each row of the first plane followed by `padding` bytes.
fn yuv_bytes(encoding: &str, picture: &Blocks, padding: usize) -> (usize, Vec<u8>) {
    let at = |x: usize, y: usize| yuv(picture.at(x, y));
    let mut data = Vec::new();
    let packed = |order: [(usize, usize); 4]| {
        let mut data = Vec::new();
        for y in 0..HEIGHT {
            for x in (0..WIDTH).step_by(2) {
                data.extend(order.map(|(pixel, part)| at(x + pixel, y)[part]));
            }
            data.extend(vec![7; padding]);
        }
        (2 * WIDTH + padding, data)
    };
    match encoding {
        "yuv422" | "uyvy" => return packed([(0, 1), (0, 0), (0, 2), (1, 0)]),
        "yuv422_yuy2" | "yuyv" | "yuy2" => return packed([(0, 0), (0, 1), (1, 0), (0, 2)]),
        _ => {}
    }
    for y in 0..HEIGHT {
        data.extend((0..WIDTH).map(|x| at(x, y)[0]));
        data.extend(vec![7; padding]);
    }
    let (columns, rows) = match encoding {
        "nv24" => (1, 1),
        "nv16" => (2, 1),
        _ => (2, 2),
    };
    let mut plane = |parts: &[usize], padding: usize| {
        for y in (0..HEIGHT).step_by(rows) {
            for x in (0..WIDTH).step_by(columns) {
                data.extend(parts.iter().map(|&part| at(x, y)[part]));
            }
            data.extend(vec![7; padding]);
        }
    };
    match encoding {
        "nv21" => plane(&[2, 1], padding),
        "nv24" => plane(&[1, 2], 2 * padding),
        "nv12" | "nv16" => plane(&[1, 2], padding),
        "yv12" => [2, 1].into_iter().for_each(|part| plane(&[part], padding / 2)),
        _ => [1, 2].into_iter().for_each(|part| plane(&[part], padding / 2)),
    }
    (WIDTH + padding, data)
}

fn is_yuv(encoding: &&str) -> bool {
    encoding.starts_with("nv") || ["yuv", "yuy", "uyvy", "i420", "iyuv", "yv12"].iter().any(|y| encoding.contains(y))
}

fn raw<'a>(encoding: &'a str, step: usize, data: &'a [u8]) -> RawImage<'a> {
    RawImage { width: WIDTH, height: HEIGHT, step, encoding, big_endian: false, data }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn luma_and_colour_differences_give_the_colours_back(picture in blocks(), padding in 0..4_usize) {
        for encoding in readable_encodings().filter(is_yuv) {
            let (step, data) = yuv_bytes(encoding, &picture, 2 * padding);
            let stored = store_raw(&raw(encoding, step, &data)).unwrap();
            let found = decode_colour(&stored.bytes, None).unwrap().rgb;
            // Half a level of luma, and 1.772 times half a level of a colour difference, and one more for rounding.
            let worst = found.iter().zip(picture.rgb()).map(|(&a, b)| a.abs_diff(b)).max();
            prop_assert!(worst <= Some(2), "{encoding}: {worst:?}");
        }
    }

    #[test]
    fn a_picture_without_colour_comes_back_exactly(greys in prop::collection::vec(any::<u8>(), WIDTH / 2 * HEIGHT / 2)) {
        let picture = Blocks(greys.iter().map(|&grey| [grey; 3]).collect());
        let expected: Vec<u8> = picture.rgb().chunks_exact(3).map(|pixel| pixel[0]).collect();
        for encoding in readable_encodings().filter(is_yuv) {
            let (step, data) = yuv_bytes(encoding, &picture, 0);
            let stored = store_raw(&raw(encoding, step, &data)).unwrap();
            prop_assert_eq!(&decode_grey(&stored.bytes, None).unwrap().pixels, &expected, "{}", encoding);
        }
    }

    #[test]
    fn values_of_two_bytes_are_scaled_by_the_bits_in_use(
        pixels in prop::collection::vec(any::<u8>(), WIDTH * HEIGHT), bits in 0..5_u32, big_endian: bool,
    ) {
        let bits = 8 + 2 * bits;
        // The bits below those that are kept are all set: they change nothing.
        let deep = |values: &[u8]| -> Vec<u8> {
            let value = |&v: &u8| (u16::from(v) << (bits - 8)) | ((1_u32 << (bits - 8)) - 1) as u16;
            let bytes = |v: u16| if big_endian { v.to_be_bytes() } else { v.to_le_bytes() };
            values.iter().flat_map(|v| bytes(value(v))).collect()
        };
        let white: Vec<u8> = pixels.iter().map(|&value| value | 0x80).collect();
        for channels in [1, 3, 4] {
            let narrow: Vec<u8> = white.iter().flat_map(|&v| vec![v; channels]).collect();
            let names: &[(&str, &str)] = match channels {
                1 => &[("mono8", "mono16"), ("8UC1", "16UC1"), ("bayer_rggb8", "bayer_rggb16"),
                    ("bayer_bggr8", "bayer_bggr16"), ("bayer_gbrg8", "bayer_gbrg16"), ("bayer_grbg8", "bayer_grbg16")],
                3 => &[("rgb8", "rgb16"), ("bgr8", "bgr16"), ("8UC3", "16UC3")],
                _ => &[("rgba8", "rgba16"), ("bgra8", "bgra16"), ("8UC4", "16UC4")],
            };
            let data = deep(&narrow);
            for (shallow_name, deep_name) in names {
                let expected = store_raw(&raw(shallow_name, channels * WIDTH, &narrow)).unwrap();
                let image = RawImage { big_endian, ..raw(deep_name, 2 * channels * WIDTH, &data) };
                let mut seen = SeenPixels::default();
                seen.add_image(&image);
                prop_assert_eq!(seen.depth().bits(), bits);
                let found = RawPixels::of_depth(&image, seen.depth()).unwrap().store().unwrap();
                prop_assert_eq!(&found, &expected, "{} of {} bits", deep_name, bits);
            }
        }
    }

    #[test]
    fn no_length_or_step_is_read_out_of_bounds(
        length in 0..600_usize, step in 0..80_usize, width in 0..14_usize, height in 0..8_usize,
    ) {
        let data = vec![128; length];
        for encoding in readable_encodings() {
            let image = RawImage { width, height, step, encoding, big_endian: false, data: &data };
            if let Ok(stored) = store_raw(&image) {
                prop_assert_eq!((stored.width, stored.height), (width, height));
            }
            let _ = store_raw(&RawImage { step: usize::MAX - step, ..image });
        }
    }

    #[test]
    fn loose_files_hold_what_was_put_in(pixels in prop::collection::vec(any::<u16>(), WIDTH * HEIGHT), white in 1..=65_535_u16) {
        let values: Vec<u16> = pixels.iter().map(|&value| (u32::from(value) % (u32::from(white) + 1)) as u16).collect();
        let header = format!("P5 # a comment\n{WIDTH}\t{HEIGHT}\n# another\n{white}\n");
        let deep = white > 255;
        let bytes = |v: &u16| if deep { v.to_be_bytes().to_vec() } else { vec![*v as u8] };
        let file: Vec<u8> = header.bytes().chain(values.iter().flat_map(bytes)).collect();
        prop_assert_eq!(LoosePixels::size_of_file(&file).unwrap(), (WIDTH as u32, HEIGHT as u32));
        let loose = LoosePixels::of_file(&file).unwrap().unwrap();
        let found = store_raw(&loose.as_raw()).unwrap();
        let grey = |&v: &u16| if deep { v.to_be_bytes()[0] } else { (f64::from(v) * 255.0 / f64::from(white)).round() as u8 };
        let expected: Vec<u8> = values.iter().map(grey).collect();
        prop_assert_eq!(decode_grey(&found.bytes, None).unwrap().pixels, expected);
        for cut in [file.len() - 1, header.len(), 3] {
            prop_assert!(LoosePixels::of_file(&file[..cut]).is_err(), "cut to {}", cut);
        }
    }
}

#[test]
fn a_png_of_16_bits_is_read_as_raw_pixels_of_16_bits() {
    for (colour, channels) in [
        (png::ColorType::Grayscale, 1),
        (png::ColorType::GrayscaleAlpha, 2),
        (png::ColorType::Rgb, 3),
        (png::ColorType::Rgba, 4),
    ] {
        let values: Vec<u8> = (0..WIDTH * HEIGHT * channels * 2).map(|i| (i * 41 % 253) as u8).collect();
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, WIDTH as u32, HEIGHT as u32);
        encoder.set_color(colour);
        encoder.set_depth(png::BitDepth::Sixteen);
        encoder.write_header().unwrap().write_image_data(&values).unwrap();
        let loose = LoosePixels::of_file(&file).unwrap().unwrap();
        let stored = RawPixels::of_depth(&loose.as_raw(), Depth::FULL).unwrap().store().unwrap();
        let rgb = decode_colour(&stored.bytes, None).unwrap().rgb;
        let top: Vec<u8> = values.chunks_exact(2).map(|value| value[0]).collect();
        let pixel = |pixel: &[u8]| if channels < 3 { [pixel[0]; 3] } else { [pixel[0], pixel[1], pixel[2]] };
        let expected: Vec<u8> = top.chunks_exact(channels).flat_map(pixel).collect();
        assert_eq!(rgb, expected, "{channels} channels");
        assert!(LoosePixels::of_file(&file[..file.len() / 2]).is_err());
    }
    let shallow = store_raw(&raw("mono8", WIDTH, &[9; WIDTH * HEIGHT])).unwrap().bytes;
    assert_eq!(LoosePixels::of_file(&shallow).unwrap(), None);
    assert_eq!(LoosePixels::of_file(b"no image").unwrap(), None);
    assert!(LoosePixels::of_file(b"P2 3 3 255 1 2 3").unwrap_err().to_string().contains("P5 or P6"));
    assert!(LoosePixels::of_file(b"P5 99999 99999 255 ").unwrap_err().to_string().contains("99999 x 99999"));
}
