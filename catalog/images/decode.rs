//! Stored bytes into pixels.

use crate::images::header::{Format, Header, inspect};
use crate::images::{BayerPattern, ColourImage, ImageError, png_codec};
use furrow_model::GreyImage;
use opencv::core::{Mat, MatTraitConst, MatTraitConstManual};
use opencv::{imgcodecs, imgproc};

/// Decodes a stored image as grey. A JPEG gives exactly the Y channel that it holds; the colours of a PNG or of a
/// mosaic are weighted 0.299 R + 0.587 G + 0.114 B (ITU-R BT.601), rounded. An orientation noted by the camera's
/// firmware is not applied: calibrations speak of the sensor's pixels.
///
/// A JPEG whose end is there but whose inside is damaged decodes with wrong blocks; libjpeg says so on stderr and
/// nowhere else.
///
/// # Errors
/// Those of [`inspect`], and data that does not decode.
pub fn decode_grey(bytes: &[u8], bayer: Option<BayerPattern>) -> Result<GreyImage, ImageError> {
    if bayer.is_some() {
        return Ok(grey_of(&decode_colour(bytes, bayer)?));
    }
    let header = inspect(bytes)?;
    let (width, height) = (header.width, header.height);
    let pixels = match header.format {
        Format::Jpeg => decode_jpeg(bytes, &header, imgcodecs::IMREAD_GRAYSCALE, 1)?,
        Format::Png => {
            let decoded = decode_png(bytes, &header)?;
            match decoded.channels {
                1 => decoded.pixels,
                2 => decoded.pixels.chunks_exact(2).map(|pixel| pixel[0]).collect(),
                3 => luma_of(&decoded.pixels),
                channels => {
                    decoded.pixels.chunks_exact(channels).map(|pixel| luma(pixel[0], pixel[1], pixel[2])).collect()
                }
            }
        }
    };
    Ok(GreyImage { width, height, pixels })
}

/// Decodes a stored image as colour; a grey one gives equal channels.
///
/// # Errors
/// Those of [`inspect`], and data that does not decode.
pub fn decode_colour(bytes: &[u8], bayer: Option<BayerPattern>) -> Result<ColourImage, ImageError> {
    if let Some(pattern) = bayer {
        return demosaic(decode_grey(bytes, None)?, pattern);
    }
    let header = inspect(bytes)?;
    let (width, height) = (header.width, header.height);
    let rgb = match header.format {
        Format::Jpeg => {
            let mut pixels = decode_jpeg(bytes, &header, imgcodecs::IMREAD_COLOR, 3)?;
            pixels.chunks_exact_mut(3).for_each(|pixel| pixel.swap(0, 2));
            pixels
        }
        Format::Png => {
            let decoded = decode_png(bytes, &header)?;
            match decoded.channels {
                1 | 2 => decoded.pixels.chunks_exact(decoded.channels).flat_map(|pixel| [pixel[0]; 3]).collect(),
                3 => decoded.pixels,
                channels => {
                    decoded.pixels.chunks_exact(channels).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
                }
            }
        }
    };
    Ok(ColourImage { width, height, rgb })
}

/// The grey of a colour image, by the weights of [`decode_grey`].
pub fn grey_of(image: &ColourImage) -> GreyImage {
    GreyImage { width: image.width, height: image.height, pixels: luma_of(&image.rgb) }
}

/// The luma of red-green-blue pixels.
pub(crate) fn luma_of(rgb: &[u8]) -> Vec<u8> {
    rgb.as_chunks::<3>().0.iter().map(|&[r, g, b]| luma(r, g, b)).collect()
}

/// BT.601 luma in 15-bit fixed point, as OpenCV's `COLOR_RGB2GRAY` has it.
fn luma(r: u8, g: u8, b: u8) -> u8 {
    ((u32::from(r) * 9798 + u32::from(g) * 19235 + u32::from(b) * 3735 + (1 << 14)) >> 15) as u8
}

fn decode_jpeg(bytes: &[u8], header: &Header, colours: i32, channels: usize) -> Result<Vec<u8>, ImageError> {
    let opencv_error = |source| ImageError::OpenCv { doing: "decode a JPEG", source };
    let input = Mat::from_slice(bytes).map_err(opencv_error)?;
    let flags = colours | imgcodecs::IMREAD_IGNORE_ORIENTATION;
    let decoded = imgcodecs::imdecode(&input, flags).map_err(opencv_error)?;
    let damaged = |fault: String| ImageError::Damaged { format: "JPEG", length: bytes.len(), fault };
    // imdecode reports a failure as an empty image, not as an error.
    if decoded.empty() {
        return Err(damaged("the decoder gave no picture".to_owned()));
    }
    let (width, height) = (decoded.cols() as usize, decoded.rows() as usize);
    let pixels = decoded.data_bytes().map_err(opencv_error)?;
    if (width, height) != (header.width, header.height) || pixels.len() != width * height * channels {
        return Err(damaged(format!(
            "its header says {} x {}, the decoder gave {width} x {height}",
            header.width, header.height
        )));
    }
    Ok(pixels.to_vec())
}

fn decode_png(bytes: &[u8], header: &Header) -> Result<png_codec::Decoded, ImageError> {
    let decoded = png_codec::decode(bytes)?;
    if decoded.pixels.len() == header.width * header.height * decoded.channels {
        return Ok(decoded);
    }
    let fault = format!("its pixels do not fill {} x {}", header.width, header.height);
    Err(ImageError::Damaged { format: "PNG", length: bytes.len(), fault })
}

/// Bilinear demosaicing. OpenCV names a pattern by its second row's second and third pixels: `BayerBG` is ROS' `rggb`.
pub(crate) fn demosaic(mosaic: GreyImage, pattern: BayerPattern) -> Result<ColourImage, ImageError> {
    let (width, height) = (mosaic.width, mosaic.height);
    if width < 4 || height < 4 {
        return Err(ImageError::SmallMosaic { width, height });
    }
    let code = match pattern {
        BayerPattern::Rggb => imgproc::COLOR_BayerBG2RGB,
        BayerPattern::Bggr => imgproc::COLOR_BayerRG2RGB,
        BayerPattern::Gbrg => imgproc::COLOR_BayerGR2RGB,
        BayerPattern::Grbg => imgproc::COLOR_BayerGB2RGB,
    };
    let convert = || -> opencv::Result<Vec<u8>> {
        let input = Mat::new_rows_cols_with_data(height as i32, width as i32, &mosaic.pixels)?;
        let mut output = Mat::default();
        imgproc::cvt_color_def(&input, &mut output, code)?;
        Ok(output.data_bytes()?.to_vec())
    };
    let rgb = convert().map_err(|source| ImageError::OpenCv { doing: "resolve a Bayer mosaic", source })?;
    Ok(ColourImage { width, height, rgb })
}
