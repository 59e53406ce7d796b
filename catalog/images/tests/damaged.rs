//! Hostile and damaged input is refused by name; nothing panics or asks for absurd memory.

use super::{rows, scene};
use crate::images::{
    ColourImage, ImageError, Picture, RawImage, decode_colour, decode_grey, encode_jpeg, inspect, store_raw,
};

fn jpeg() -> Vec<u8> {
    let image = ColourImage { width: 64, height: 48, rgb: rows(64, 48, 0, scene) };
    encode_jpeg(Picture::Colour(&image), 64, 90).unwrap()
}

fn png() -> Vec<u8> {
    let data = rows(64, 48, 0, scene);
    let image = RawImage { width: 64, height: 48, step: 192, encoding: "rgb8", big_endian: false, data: &data };
    store_raw(&image).unwrap().bytes
}

#[test]
fn raw_messages_that_lie() {
    let data = vec![0; 300];
    let good = RawImage { width: 10, height: 10, step: 30, encoding: "rgb8", big_endian: false, data: &data };
    assert!(store_raw(&good).is_ok());
    let message = |image: RawImage<'_>| store_raw(&image).unwrap_err().to_string();
    assert!(message(RawImage { width: 0, ..good }).contains("empty"));
    assert!(message(RawImage { height: 0, ..good }).contains("empty"));
    assert!(message(RawImage { step: 0, ..good }).contains("needs 30 bytes"));
    assert!(message(RawImage { step: 29, ..good }).contains("a row has 29"));
    assert!(message(RawImage { step: 31, ..good }).contains("needs 310 bytes, found 300"));
    assert!(message(RawImage { height: 9, ..good }).contains("needs 270 bytes, found 300"));
    assert!(message(RawImage { height: 11, ..good }).contains("needs 330 bytes, found 300"));
    assert!(message(RawImage { step: usize::MAX, ..good }).contains("damaged"));
    assert!(message(RawImage { width: 100_000, height: 100_000, ..good }).contains("100000 x 100000"));
    assert!(message(RawImage { width: usize::MAX, ..good }).contains("at most 12000"));
    let unknown = message(RawImage { encoding: "h264", ..good });
    assert!(unknown.contains("'h264'") && unknown.contains("mono8") && unknown.contains("bayer_grbg16"));
}

#[test]
fn cut_files_are_refused() {
    let jpeg = jpeg();
    for length in 0..jpeg.len() {
        assert!(decode_grey(&jpeg[..length], None).is_err(), "JPEG cut to {length} of {}", jpeg.len());
    }
    let png = png();
    let pixels_end = png.windows(4).position(|window| window == b"IEND").unwrap() - 8;
    for length in 0..pixels_end {
        assert!(decode_grey(&png[..length], None).is_err(), "PNG cut to {length} of {}", png.len());
    }
}

#[test]
fn garbage_is_refused() {
    for bytes in [&b""[..], b"\xff", b"\xff\xd8", b"\xff\xd8\xff\xd9", b"GIF89a trailing", &[0; 1000], &[0xff; 1000]] {
        assert!(decode_grey(bytes, None).is_err());
    }
    let error = inspect(b"GIF89a").unwrap_err().to_string();
    assert!(error.contains("JPEG or PNG") && error.contains("47 49 46"), "{error}");
    let no_scan_data = [&jpeg()[..200], &[0xff, 0xd9]].concat();
    assert!(decode_grey(&no_scan_data, None).is_err());
}

#[test]
fn flipped_bytes_never_panic() {
    for original in [jpeg(), png()] {
        for at in 0..original.len() {
            let mut bytes = original.clone();
            bytes[at] ^= 0x55;
            if let Ok(image) = decode_colour(&bytes, None) {
                assert_eq!(image.rgb.len(), image.width * image.height * 3);
            }
            let _ = decode_grey(&bytes, None);
        }
    }
}

#[test]
fn bombs_are_refused_by_their_headers() {
    let mut bomb = png();
    bomb[16..24].copy_from_slice(&[0, 1, 0x86, 0xa0, 0, 1, 0x86, 0xa0]);
    for result in [inspect(&bomb).map(|_| ()), decode_grey(&bomb, None).map(|_| ())] {
        assert!(matches!(result, Err(ImageError::TooLarge { width: 100_000, height: 100_000 })));
    }
    let mut bomb = jpeg();
    let frame = bomb.windows(2).position(|window| window == [0xff, 0xc0]).unwrap();
    bomb[frame + 5..frame + 9].copy_from_slice(&[0x2e, 0xe0, 0x2e, 0xe0]);
    assert!(matches!(inspect(&bomb), Err(ImageError::TooLarge { width: 12_000, height: 12_000 })));
    bomb[frame + 5..frame + 9].copy_from_slice(&[0, 0, 0, 64]);
    assert!(matches!(inspect(&bomb), Err(ImageError::Empty { .. })));
}

#[test]
fn other_varieties_are_refused() {
    let mut deep = Vec::new();
    let mut encoder = png::Encoder::new(&mut deep, 4, 4);
    encoder.set_depth(png::BitDepth::Sixteen);
    encoder.write_header().unwrap().write_image_data(&[0; 32]).unwrap();
    let error = decode_grey(&deep, None).unwrap_err().to_string();
    assert!(error.contains("16 bits"), "{error}");

    let original = jpeg();
    let frame = original.windows(2).position(|window| window == [0xff, 0xc0]).unwrap();
    for (at, value, says) in [(1, 0xc3, "SOF3"), (4, 12, "12 bits"), (9, 4, "4 channels")] {
        let mut bytes = original.clone();
        bytes[frame + at] = value;
        let error = inspect(&bytes).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}

#[test]
fn tiny_mosaics_have_no_colours() {
    let data = [1, 2, 3, 4, 5, 6, 7, 8, 9];
    let image = RawImage { width: 3, height: 3, step: 3, encoding: "bayer_rggb8", big_endian: false, data: &data };
    let stored = store_raw(&image).unwrap();
    assert!(matches!(decode_colour(&stored.bytes, stored.bayer), Err(ImageError::SmallMosaic { .. })));
}
